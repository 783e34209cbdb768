// The protos stay compatible with tests/data/ricochet.v1.textproto, the descriptors agreed on last: nothing is removed,
// renumbered, renamed or retyped, so that clients of any language and age go on working.
//
// RICOCHET_UPDATE_API=1 writes the file anew: after an addition, or for a break on purpose.

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "api_files.h"
#include "tests/support/paths.h"

namespace ricochet {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::DescriptorPool;
using google::protobuf::DescriptorProto;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::FieldDescriptorProto;
using google::protobuf::FileDescriptor;
using google::protobuf::FileDescriptorProto;
using google::protobuf::FileDescriptorSet;
using google::protobuf::MethodDescriptor;
using google::protobuf::ServiceDescriptor;
using testing::ElementsAre;
using testing::IsEmpty;

// Lists what of an older pool is missing or different in a newer one.
class Comparison {
 public:
  explicit Comparison(const DescriptorPool& now) : now_(now) {}

  void Compare(const FileDescriptor& file) {
    for (int i = 0; i < file.message_type_count(); ++i) Compare(*file.message_type(i));
    for (int i = 0; i < file.enum_type_count(); ++i) Compare(*file.enum_type(i));
    for (int i = 0; i < file.service_count(); ++i) Compare(*file.service(i));
  }

  const std::vector<std::string>& breaks() const { return breaks_; }

 private:
  void Compare(const Descriptor& before) {
    for (int i = 0; i < before.nested_type_count(); ++i) Compare(*before.nested_type(i));
    for (int i = 0; i < before.enum_type_count(); ++i) Compare(*before.enum_type(i));
    const Descriptor* now = now_.FindMessageTypeByName(before.full_name());
    if (now == nullptr) return breaks_.push_back(absl::StrCat(before.full_name(), " is gone"));
    for (int i = 0; i < before.field_count(); ++i) {
      const FieldDescriptor& field = *before.field(i);
      const FieldDescriptor* same = now->FindFieldByNumber(field.number());
      CompareText(field.full_name(), Signature(field), same == nullptr ? "" : Signature(*same));
    }
  }

  void Compare(const EnumDescriptor& before) {
    const EnumDescriptor* now = now_.FindEnumTypeByName(before.full_name());
    if (now == nullptr) return breaks_.push_back(absl::StrCat(before.full_name(), " is gone"));
    for (int i = 0; i < before.value_count(); ++i) {
      const auto* same = now->FindValueByNumber(before.value(i)->number());
      CompareText(before.value(i)->full_name(), before.value(i)->name(), same == nullptr ? "" : same->name());
    }
  }

  void Compare(const ServiceDescriptor& before) {
    for (int i = 0; i < before.method_count(); ++i) {
      const MethodDescriptor& method = *before.method(i);
      const MethodDescriptor* same = now_.FindMethodByName(method.full_name());
      CompareText(method.full_name(), Signature(method), same == nullptr ? "" : Signature(*same));
    }
  }

  // Returns all properties of a field that old code relies on, including numbers, names in JSON and the oneof.
  static std::string Signature(const FieldDescriptor& field) {
    const std::string type = field.message_type() != nullptr ? field.message_type()->full_name()
                             : field.enum_type() != nullptr  ? field.enum_type()->full_name()
                                                             : field.type_name();
    const auto* oneof = field.real_containing_oneof();
    return absl::StrCat(field.is_repeated()    ? "repeated "
                        : field.has_presence() ? "optional "
                                               : "",
                        type, " ", field.name(), oneof == nullptr ? "" : absl::StrCat(" in ", oneof->name()));
  }

  static std::string Signature(const MethodDescriptor& method) {
    return absl::StrCat(method.client_streaming() ? "stream " : "", method.input_type()->full_name(), " to ",
                        method.server_streaming() ? "stream " : "", method.output_type()->full_name());
  }

  void CompareText(const std::string& name, const std::string& before, const std::string& now) {
    if (now.empty()) breaks_.push_back(absl::StrCat(name, " is gone"));
    if (!now.empty() && now != before) breaks_.push_back(absl::StrCat(name, " was ", before, " and is ", now));
  }

  const DescriptorPool& now_;
  std::vector<std::string> breaks_;
};

std::vector<std::string> Breaks(const FileDescriptorSet& before, const FileDescriptorSet& now) {
  DescriptorPool old_pool;
  DescriptorPool new_pool;
  Build(now, new_pool);
  Comparison comparison(new_pool);
  for (const FileDescriptor* file : Build(before, old_pool)) comparison.Compare(*file);
  return comparison.breaks();
}

// The file leaves out what a pool adds by itself: the default name in JSON, that a field is not repeated, and whether a
// named type is a message or an enum.
void ClearDefaults(DescriptorProto& message) {
  for (FieldDescriptorProto& field : *message.mutable_field()) {
    field.clear_json_name();
    if (field.label() == FieldDescriptorProto::LABEL_OPTIONAL) field.clear_label();
    if (field.has_type_name()) field.clear_type();
  }
  for (DescriptorProto& nested : *message.mutable_nested_type()) ClearDefaults(nested);
}

FileDescriptorSet Protos() {
  FileDescriptorSet files = ProtosWithComments();
  for (FileDescriptorProto& file : *files.mutable_file()) {
    file.clear_source_code_info();
    for (DescriptorProto& message : *file.mutable_message_type()) ClearDefaults(message);
  }
  return files;
}

std::string CommittedPath() { return TestDataPath("ricochet.v1.textproto"); }

FileDescriptorSet Committed() {
  std::ostringstream text;
  text << std::ifstream(CommittedPath()).rdbuf();
  FileDescriptorSet files;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text.str(), &files));
  return files;
}

TEST(CompatibilityTest, NothingIsRemovedRenumberedRenamedOrRetyped) {
  if (std::getenv("RICOCHET_UPDATE_API") != nullptr) {
    std::string text;
    ASSERT_TRUE(google::protobuf::TextFormat::PrintToString(Protos(), &text));
    std::ofstream(CommittedPath()) << text;
  }
  EXPECT_THAT(Breaks(Committed(), Protos()), IsEmpty());
}

// Otherwise what was added since could be broken unseen.
TEST(CompatibilityTest, TheCommittedDescriptorsHaveAllAdditions) {
  EXPECT_THAT(Breaks(Protos(), Committed()), IsEmpty()) << "run proto_test with RICOCHET_UPDATE_API=1";
}

// --- Each kind of break is seen ---

FileDescriptorSet Small() {
  FileDescriptorSet files;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(
      R"pb(
        file {
          name: "a.proto"
          package: "a"
          syntax: "proto3"
          message_type {
            name: "M"
            field { name: "x_m" number: 1 type: TYPE_DOUBLE label: LABEL_OPTIONAL }
            field { name: "e" number: 2 type: TYPE_ENUM type_name: ".a.E" label: LABEL_OPTIONAL }
          }
          enum_type {
            name: "E"
            value { name: "E_UNSPECIFIED" number: 0 }
            value { name: "E_ONE" number: 1 }
          }
          service {
            name: "S"
            method { name: "Ask" input_type: ".a.M" output_type: ".a.M" }
          }
        })pb",
      &files));
  return files;
}

std::vector<std::string> BreaksAfter(void (*change)(FileDescriptorProto&)) {
  FileDescriptorSet changed = Small();
  change(*changed.mutable_file(0));
  return Breaks(Small(), changed);
}

TEST(CompatibilityTest, SeesEachKindOfBreak) {
  using File = FileDescriptorProto;
  EXPECT_THAT(Breaks(Small(), Small()), IsEmpty());
  EXPECT_THAT(BreaksAfter([](File& file) { file.mutable_message_type(0)->mutable_field(0)->set_name("y_m"); }),
              ElementsAre("a.M.x_m was double x_m and is double y_m"));
  EXPECT_THAT(BreaksAfter([](File& file) { file.mutable_message_type(0)->mutable_field(0)->set_number(3); }),
              ElementsAre("a.M.x_m is gone"));
  EXPECT_THAT(BreaksAfter([](File& file) {
                auto& field = *file.mutable_message_type(0)->mutable_field(0);
                field.set_label(FieldDescriptorProto::LABEL_REPEATED);
              }),
              ElementsAre("a.M.x_m was double x_m and is repeated double x_m"));
  EXPECT_THAT(BreaksAfter([](File& file) { file.mutable_enum_type(0)->mutable_value()->RemoveLast(); }),
              ElementsAre("a.E_ONE is gone"));
  EXPECT_THAT(BreaksAfter([](File& file) { file.mutable_enum_type(0)->mutable_value(1)->set_name("E_TWO"); }),
              ElementsAre("a.E_ONE was E_ONE and is E_TWO"));
  EXPECT_THAT(BreaksAfter([](File& file) { file.mutable_service(0)->mutable_method(0)->set_server_streaming(true); }),
              ElementsAre("a.S.Ask was a.M to a.M and is a.M to stream a.M"));
  EXPECT_THAT(BreaksAfter([](File& file) { file.clear_service(); }), ElementsAre("a.S.Ask is gone"));
}

}  // namespace
}  // namespace ricochet
