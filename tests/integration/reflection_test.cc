// Reflection: what a real ricochetd tells clients that have no proto files.

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "grpc/reflection/v1/reflection.pb.h"
#include "tests/support/processes/server_process.h"
#include "tests/support/processes/service_calls.h"

namespace ricochet {
namespace {

using google::protobuf::DescriptorPool;
using google::protobuf::FileDescriptorProto;
using google::protobuf::ServiceDescriptor;
using grpc::reflection::v1::ServerReflectionRequest;
using grpc::reflection::v1::ServerReflectionResponse;

// Asks the reflection service of one version of the protocol; the messages of both have the same bytes.
class Reflection : public testing::TestWithParam<std::string> {
 protected:
  ServerReflectionResponse Ask(const ServerReflectionRequest& request) {
    const std::string method = absl::StrCat("/grpc.reflection.", GetParam(), ".ServerReflection/ServerReflectionInfo");
    grpc::TemplatedGenericStub<ServerReflectionRequest, ServerReflectionResponse> stub(channel_);
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
    grpc::CompletionQueue queue;
    ServerReflectionResponse response;
    grpc::Status status;
    auto call = stub.PrepareCall(&context, method, &queue);
    void* tag = nullptr;
    bool ok = false;
    call->StartCall(nullptr);
    queue.Next(&tag, &ok);
    call->Write(request, nullptr);
    queue.Next(&tag, &ok);
    call->Read(&response, nullptr);
    queue.Next(&tag, &ok);
    call->WritesDone(nullptr);
    queue.Next(&tag, &ok);
    call->Finish(&status, nullptr);
    queue.Next(&tag, &ok);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response;
  }

  std::vector<std::string> Services() {
    ServerReflectionRequest request;
    request.set_list_services("");
    std::vector<std::string> names;
    const ServerReflectionResponse response = Ask(request);
    for (const auto& service : response.list_services_response().service()) names.push_back(service.name());
    return names;
  }

  // Adds the file that declares `symbol`, and all that it imports, to `pool`.
  void Load(const std::string& symbol, DescriptorPool& pool) {
    ServerReflectionRequest request;
    request.set_file_containing_symbol(symbol);
    const ServerReflectionResponse response = Ask(request);
    const auto& files = response.file_descriptor_response().file_descriptor_proto();
    // Imports come after the files that import them, and a pool takes them first.
    for (int pass = 0; pass < files.size(); ++pass) {
      for (const std::string& bytes : files) {
        FileDescriptorProto file;
        ASSERT_TRUE(file.ParseFromString(bytes));
        const auto& imports = file.dependency();
        const bool ready = std::all_of(imports.begin(), imports.end(),
                                       [&](const std::string& name) { return pool.FindFileByName(name) != nullptr; });
        if (ready && pool.FindFileByName(file.name()) == nullptr) pool.BuildFile(file);
      }
    }
  }

  const ServerProcess server_{{"--reflection", "127.0.0.1:0"}};
  const std::shared_ptr<grpc::Channel> channel_ = MakeChannel(server_.LoggedAddress("reflection"));
};

TEST_P(Reflection, DescribesEveryServiceThatItLists) {
  const std::vector<std::string> services = Services();
  EXPECT_THAT(services, testing::UnorderedElementsAre("ricochet.v1.ImpactService", "grpc.health.v1.Health",
                                                      "grpc.reflection.v1.ServerReflection",
                                                      "grpc.reflection.v1alpha.ServerReflection"));
  for (const std::string& name : services) {
    DescriptorPool pool;
    Load(name, pool);
    const ServiceDescriptor* const service = pool.FindServiceByName(name);
    ASSERT_NE(service, nullptr) << name;
    EXPECT_GE(service->method_count(), 1) << name;
  }
}

TEST_P(Reflection, KnowsTheMethodsOfHealth) {
  DescriptorPool pool;
  Load("grpc.health.v1.Health", pool);
  EXPECT_NE(pool.FindMethodByName("grpc.health.v1.Health.Check"), nullptr);
  EXPECT_NE(pool.FindMethodByName("grpc.health.v1.Health.Watch"), nullptr);
}

TEST_P(Reflection, KnowsTheDetailsOfErrors) {
  DescriptorPool pool;
  Load("google.rpc.BadRequest", pool);
  EXPECT_NE(pool.FindMessageTypeByName("google.rpc.ErrorInfo"), nullptr);
}

TEST_P(Reflection, FindsAFileByItsName) {
  ServerReflectionRequest request;
  request.set_file_by_filename("ricochet/v1/scene.proto");
  FileDescriptorProto file;
  ASSERT_TRUE(file.ParseFromString(Ask(request).file_descriptor_response().file_descriptor_proto(0)));
  EXPECT_EQ(file.package(), "ricochet.v1");
}

TEST_P(Reflection, AnswersThatASymbolIsUnknown) {
  ServerReflectionRequest request;
  request.set_file_containing_symbol("ricochet.v1.Nothing");
  EXPECT_EQ(Ask(request).error_response().error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_P(Reflection, HasNoExtensionsOfAScene) {
  ServerReflectionRequest request;
  request.set_all_extension_numbers_of_type("ricochet.v1.Scene");
  const auto numbers = Ask(request).all_extension_numbers_response();
  EXPECT_EQ(numbers.base_type_name(), "ricochet.v1.Scene");
  EXPECT_TRUE(numbers.extension_number().empty());
}

INSTANTIATE_TEST_SUITE_P(Versions, Reflection, testing::Values("v1", "v1alpha"),
                         [](const auto& version) { return version.param; });

}  // namespace
}  // namespace ricochet
