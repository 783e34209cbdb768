// A request that would unfold to more than any request needs is refused before it is parsed; all others are answered.

#include "server/calls/bounded_service.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "proto/wire/status.h"
#include "ricochet/error.h"

namespace ricochet::server {
namespace {

using testing::HasSubstr;

TEST(MostElements, AreEnoughForTheLargestRequestWithinTheLimits) {
  EXPECT_EQ(MostElements(Limits()), 16'384);
  Limits limits;
  limits.max_columns = 100'000;
  EXPECT_GE(MostElements(limits), 100'000);
  limits = {.max_contact_states = 100'000};
  EXPECT_GE(MostElements(limits), 100'000);
}

class AnsweringService final : public v1::ImpactService::Service {
 public:
  grpc::Status SolveBatch(grpc::ServerContext* /*context*/, const v1::SolveBatchRequest* request,
                          v1::SolveBatchResponse* response) override {
    response->set_regimes(std::to_string(request->inputs_size()));
    return grpc::Status::OK;
  }
  grpc::Status Solve(grpc::ServerContext* /*context*/, const v1::SolveRequest* request,
                     v1::SolveResponse* response) override {
    response->mutable_outcome()->set_w_rank(request->scene().linkage().links_size());
    return grpc::Status::OK;
  }
  grpc::Status Sweep(grpc::ServerContext* /*context*/, const v1::SweepRequest* request,
                     grpc::ServerWriter<v1::SweepResponse>* writer) override {
    v1::SweepResponse response;
    response.set_count(request->columns_size());
    writer->Write(response);
    return grpc::Status::OK;
  }
};

// Answers each batch by the number of its columns.
grpc::Status AnswerBatches(grpc::ServerContext& /*context*/, BoundedBatches& batches) {
  while (batches.Receive()) {
    const absl::StatusOr<Parsed<v1::SolveBatchRequest>> request = batches.Parse();
    if (!request.ok()) return ToGrpcStatus(request.status());
    v1::SolveBatchResponse response;
    response.set_regimes(std::to_string(request->message.inputs_size()));
    batches.Write(response);
  }
  return grpc::Status::OK;
}

class BoundedServiceTest : public testing::Test {
 protected:
  BoundedServiceTest() {
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.SetMaxReceiveMessageSize(64 << 20);
    builder.RegisterService(&bounded_);
    server_ = builder.BuildAndStart();
    channel_ = grpc::CreateChannel("127.0.0.1:" + std::to_string(port), grpc::InsecureChannelCredentials());
    stub_ = v1::ImpactService::NewStub(channel_);
  }
  ~BoundedServiceTest() override { server_->Shutdown(std::chrono::system_clock::now()); }

  AnsweringService service_;
  UnreadWatch unread_{std::chrono::seconds(30)};
  CallMemory memory_{int64_t{512} << 20};
  BoundedService bounded_{service_, AnswerBatches, Limits(), {.unread = unread_, .memory = memory_}};
  std::unique_ptr<grpc::Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::ImpactService::Stub> stub_;
};

TEST_F(BoundedServiceTest, PassesUnaryCallsAndStreamsOn) {
  grpc::ClientContext solve;
  v1::SolveRequest request;
  for (int i = 0; i < 10'000; ++i) request.mutable_scene()->mutable_linkage()->add_links();
  v1::SolveResponse response;
  ASSERT_TRUE(stub_->Solve(&solve, request, &response).ok());
  EXPECT_EQ(response.outcome().w_rank(), 10'000);
  grpc::ClientContext sweep;
  v1::SweepRequest columns;
  columns.add_columns("x");
  const auto reader = stub_->Sweep(&sweep, columns);
  v1::SweepResponse chunk;
  ASSERT_TRUE(reader->Read(&chunk));
  EXPECT_EQ(chunk.count(), 1);
  EXPECT_TRUE(reader->Finish().ok());
}

TEST_F(BoundedServiceTest, RefusesWhatWouldUnfold) {
  grpc::ClientContext solve;
  v1::SolveRequest request;
  for (int i = 0; i < 200'000; ++i) request.mutable_scene()->mutable_linkage()->add_links();
  v1::SolveResponse response;
  const absl::Status refused = FromGrpcStatus(stub_->Solve(&solve, request, &response));
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(refused), ErrorReason::kLimitExceeded);
  grpc::ClientContext sweep;
  v1::SweepRequest columns;
  for (int i = 0; i < 200'000; ++i) columns.add_columns();
  const auto reader = stub_->Sweep(&sweep, columns);
  v1::SweepResponse chunk;
  EXPECT_FALSE(reader->Read(&chunk));
  EXPECT_EQ(ReasonOf(FromGrpcStatus(reader->Finish())), ErrorReason::kLimitExceeded);
}

// A batch with one column of so many bytes.
v1::SolveBatchRequest BatchOf(size_t bytes) {
  v1::SolveBatchRequest request;
  request.add_inputs(std::string(bytes, '\0'));
  return request;
}

TEST_F(BoundedServiceTest, TakesABatchOfMoreBytesThanAnyOtherRequestAndNoMoreThanItsLimit) {
  v1::SolveBatchResponse response;
  grpc::ClientContext fitting;
  EXPECT_TRUE(stub_->SolveBatch(&fitting, BatchOf(15 << 20), &response).ok());
  grpc::ClientContext large;
  const absl::Status refused = FromGrpcStatus(stub_->SolveBatch(&large, BatchOf(17 << 20), &response));
  EXPECT_EQ(ReasonOf(refused), ErrorReason::kLimitExceeded);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("must have at most 16777216, the limit max_request_bytes"));
  grpc::ClientContext solve;
  v1::SolveRequest history;
  for (int i = 0; i < 150'000; ++i) history.add_history_at_n_s(1.0);
  v1::SolveResponse solved;
  const absl::Status too_long = FromGrpcStatus(stub_->Solve(&solve, history, &solved));
  EXPECT_THAT(std::string(too_long.message()), HasSubstr("must have at most 1048576"));
}

TEST_F(BoundedServiceTest, BoundsEachRequestOfAStreamOfBatches) {
  grpc::ClientContext context;
  const auto stream = stub_->SolveBatches(&context);
  v1::SolveBatchResponse response;
  for (const size_t bytes : {size_t{8}, size_t{15} << 20}) {
    ASSERT_TRUE(stream->Write(BatchOf(bytes)));
    ASSERT_TRUE(stream->Read(&response));
    EXPECT_EQ(response.regimes(), "1");
  }
  v1::SolveBatchRequest many;
  for (int i = 0; i < 200'000; ++i) many.add_inputs();
  stream->Write(many);
  EXPECT_FALSE(stream->Read(&response));
  EXPECT_EQ(ReasonOf(FromGrpcStatus(stream->Finish())), ErrorReason::kLimitExceeded);
}

// Calls a method with a message of these bytes.
grpc::Status Call(const std::shared_ptr<grpc::Channel>& channel, const std::string& path, const std::string& bytes) {
  const grpc::Slice slice(bytes);
  const grpc::ByteBuffer request(&slice, 1);
  grpc::GenericStub stub(channel);
  grpc::CompletionQueue queue;
  grpc::ClientContext context;
  const auto call = stub.PrepareUnaryCall(&context, path, request, &queue);
  call->StartCall();
  grpc::ByteBuffer response;
  grpc::Status status;
  call->Finish(&response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  return status;
}

// A method that is new in the proto needs a line in BoundedService; without it gRPC answers UNIMPLEMENTED.
TEST_F(BoundedServiceTest, HasEveryMethodOfTheProtoAndRefusesAFieldThatItDoesNotKnow) {
  const auto* const service =
      google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(v1::ImpactService::service_full_name());
  ASSERT_NE(service, nullptr);
  for (int i = 0; i < service->method_count(); ++i) {
    const std::string path = "/" + service->full_name() + "/" + service->method(i)->name();
    const std::string unknown("\xf8\x07\x00", 3);  // Field 127.
    const absl::Status refused = FromGrpcStatus(Call(channel_, path, unknown));
    EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument) << path;
    ASSERT_EQ(ViolationsOf(refused).size(), 1) << path;
    EXPECT_EQ(ViolationsOf(refused)[0].field, "request") << path;
    EXPECT_THAT(ViolationsOf(refused)[0].description, HasSubstr("has a field of number 127 ")) << path;
  }
}

}  // namespace
}  // namespace ricochet::server
