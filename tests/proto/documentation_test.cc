// Every element of every proto file of this project has a comment.

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "api_files.h"

namespace ricochet {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::DescriptorPool;
using google::protobuf::EnumDescriptor;
using google::protobuf::FileDescriptor;
using google::protobuf::FileDescriptorProto;
using google::protobuf::FileDescriptorSet;
using google::protobuf::ServiceDescriptor;
using google::protobuf::SourceLocation;
using testing::IsEmpty;

// Counts the elements of files, and lists those without a comment above them.
class Census {
 public:
  void Count(const FileDescriptor& file) {
    for (int i = 0; i < file.message_type_count(); ++i) Count(*file.message_type(i));
    for (int i = 0; i < file.enum_type_count(); ++i) Count(*file.enum_type(i));
    for (int i = 0; i < file.service_count(); ++i) Count(*file.service(i));
  }

  int elements() const { return elements_; }
  const std::vector<std::string>& silent() const { return silent_; }

 private:
  void Count(const Descriptor& message) {
    CountOne(message);
    for (int i = 0; i < message.field_count(); ++i) CountOne(*message.field(i));
    for (int i = 0; i < message.real_oneof_decl_count(); ++i) CountOne(*message.oneof_decl(i));
    for (int i = 0; i < message.nested_type_count(); ++i) Count(*message.nested_type(i));
    for (int i = 0; i < message.enum_type_count(); ++i) Count(*message.enum_type(i));
  }

  void Count(const EnumDescriptor& type) {
    CountOne(type);
    for (int i = 0; i < type.value_count(); ++i) CountOne(*type.value(i));
  }

  void Count(const ServiceDescriptor& service) {
    CountOne(service);
    for (int i = 0; i < service.method_count(); ++i) CountOne(*service.method(i));
  }

  template <typename Element>
  void CountOne(const Element& element) {
    SourceLocation location;
    ++elements_;
    if (!element.GetSourceLocation(&location) || location.leading_comments.empty()) {
      silent_.push_back(element.full_name());
    }
  }

  int elements_ = 0;
  std::vector<std::string> silent_;
};

TEST(DocumentationTest, EveryElementHasAComment) {
  const FileDescriptorSet files = ProtosWithComments();
  ASSERT_GE(files.file_size(), 7);
  DescriptorPool pool;
  Census census;
  for (const FileDescriptorProto& proto : files.file()) {
    const FileDescriptor* file = pool.BuildFile(proto);
    ASSERT_NE(file, nullptr) << proto.name();
    EXPECT_EQ(file->package(), "ricochet.v1");
    census.Count(*file);
  }
  EXPECT_THAT(census.silent(), IsEmpty());
  EXPECT_GT(census.elements(), 150);
}

TEST(DocumentationTest, EveryFileOpensWithAComment) {
  const FileDescriptorSet files = ProtosWithComments();
  for (const FileDescriptorProto& proto : files.file()) {
    bool opens_with_comment = false;
    for (const auto& location : proto.source_code_info().location()) {
      const bool is_syntax = location.path_size() == 1 && location.path(0) == FileDescriptorProto::kSyntaxFieldNumber;
      if (is_syntax) opens_with_comment = !location.leading_comments().empty();
    }
    EXPECT_TRUE(opens_with_comment) << proto.name();
  }
}

TEST(DocumentationTest, MissingCommentIsFound) {
  FileDescriptorProto proto;
  proto.set_name("silent.proto");
  proto.add_message_type()->set_name("Silent");
  DescriptorPool pool;
  Census census;
  census.Count(*pool.BuildFile(proto));
  EXPECT_THAT(census.silent(), testing::ElementsAre("Silent"));
}

}  // namespace
}  // namespace ricochet
