#include "proto/wire/message_content.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format.h>
#include <google/protobuf/wire_format_lite.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormat;
using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

// Walks through the bytes of a message to the first thing that is wrong in it. It goes as deep as the types of messages
// do, none of which contains itself (tests/proto/style_test.cc).
class Walk {
 public:
  Walk(absl::string_view bytes, int64_t most)
      : in_(reinterpret_cast<const uint8_t*>(bytes.data()), static_cast<int>(bytes.size())), most_(most) {}

  // Reads the fields of one message to their end. Returns false where something is wrong, or the bytes are no message.
  bool Read(const Descriptor& type) {
    std::vector<Step> next;  // The entry that comes next in each list.
    while (const uint32_t tag = in_.ReadTag()) {
      const int number = WireFormatLite::GetTagFieldNumber(tag);
      const FieldDescriptor* const field = type.FindFieldByNumber(number);
      if (field == nullptr || !HasWireType(*field, WireFormatLite::GetTagWireType(tag))) {
        return Refuse(InvalidRequest(
            {{path_.empty() ? "request" : Path(),
              absl::StrCat("has a field of number ", number, " that the ", type.full_name(),
                           " of this version does not have: must be left out, or be sent to a newer server")}}));
      }
      path_.push_back(field->is_repeated() && IsMessage(*field) ? TakeNext(*field, next) : Step{field});
      if (!ReadValue(*field, tag)) return false;
      path_.pop_back();
    }
    return true;
  }

  // Says what is wrong.
  const absl::Status& status() const { return status_; }

  // Returns the number of messages and texts that were read.
  int64_t elements() const { return elements_; }

 private:
  struct Step {
    const FieldDescriptor* field;
    std::optional<int> index = std::nullopt;  // Only an entry of a list of messages has it.
  };

  static Step TakeNext(const FieldDescriptor& list, std::vector<Step>& next) {
    auto found = std::find_if(next.begin(), next.end(), [&list](const Step& step) { return step.field == &list; });
    if (found == next.end()) found = next.insert(found, {&list, 0});
    const Step taken = *found;
    ++*found->index;
    return taken;
  }

  static bool IsMessage(const FieldDescriptor& field) { return field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE; }

  static bool HasWireType(const FieldDescriptor& field, WireFormatLite::WireType wire_type) {
    return wire_type == WireFormat::WireTypeForFieldType(field.type()) ||
           (field.is_packable() && wire_type == WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
  }

  bool Refuse(absl::Status status) {
    status_ = std::move(status);
    return false;
  }

  std::string Path() const {
    return absl::StrJoin(path_, ".", [](std::string* out, const Step& step) {
      *out += step.field->name();
      if (step.index.has_value()) absl::StrAppend(out, "[", *step.index, "]");
    });
  }

  bool ReadValue(const FieldDescriptor& field, uint32_t tag) {
    const bool is_message = IsMessage(field);
    if ((is_message || field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) && ++elements_ > most_) {
      return Refuse(MakeError(absl::StatusCode::kResourceExhausted, ErrorReason::kLimitExceeded,
                              absl::StrCat("the request holds more than ", most_,
                                           " messages and texts, which no request within the limits does; the first "
                                           "one too many is ",
                                           field.full_name())));
    }
    const bool is_enum = field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM;
    if (!is_message && !is_enum) return WireFormatLite::SkipField(&in_, tag);
    if (WireFormatLite::GetTagWireType(tag) == WireFormatLite::WIRETYPE_VARINT) return ReadEnum(field);
    int length = 0;
    if (!in_.ReadVarintSizeAsInt(&length)) return false;
    const CodedInputStream::Limit end = in_.PushLimit(length);
    if (is_message && !Read(*field.message_type())) return false;
    while (is_enum && in_.BytesUntilLimit() > 0) {
      if (!ReadEnum(field)) return false;
    }
    in_.PopLimit(end);
    return true;
  }

  bool ReadEnum(const FieldDescriptor& field) {
    uint64_t bits = 0;
    if (!in_.ReadVarint64(&bits)) return false;
    const auto value = static_cast<int>(bits);
    if (field.enum_type()->FindValueByNumber(value) != nullptr) return true;
    return Refuse(InvalidRequest(
        {{Path(), absl::StrCat("= ", value, ": must be a number of ", field.enum_type()->full_name())}}));
  }

  CodedInputStream in_;
  const int64_t most_;
  int64_t elements_ = 0;
  std::vector<Step> path_;
  absl::Status status_;
};

}  // namespace

absl::StatusOr<int64_t> CheckContent(absl::string_view bytes, const Descriptor& type, int64_t most) {
  Walk walk(bytes, most);
  walk.Read(type);
  if (!walk.status().ok()) return walk.status();
  return walk.elements();
}

}  // namespace ricochet
