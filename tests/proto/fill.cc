#include "fill.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/strings/str_cat.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::OneofDescriptor;
using google::protobuf::Reflection;

class Filler {
 public:
  explicit Filler(int choice) : choice_(choice) {}

  void FillMessage(Message& message) {
    const Descriptor& type = *message.GetDescriptor();
    for (int i = 0; i < type.field_count(); ++i) {
      const FieldDescriptor& field = *type.field(i);
      if (IsWanted(field)) FillField(field, message);
    }
  }

 private:
  bool IsWanted(const FieldDescriptor& field) const {
    const OneofDescriptor* oneof = field.real_containing_oneof();
    return oneof == nullptr || field.index_in_oneof() == choice_ % oneof->field_count();
  }

  void FillField(const FieldDescriptor& field, Message& message) {
    if (!field.is_repeated()) return SetSingular(field, message);
    AddEntry(field, message);
    AddEntry(field, message);
  }

  void SetSingular(const FieldDescriptor& field, Message& message) {
    const Reflection& reflection = *message.GetReflection();
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return reflection.SetDouble(&message, &field, NextNumber() + 0.5);
      case FieldDescriptor::CPPTYPE_INT32:
        return reflection.SetInt32(&message, &field, NextNumber());
      case FieldDescriptor::CPPTYPE_INT64:
        return reflection.SetInt64(&message, &field, (int64_t{1} << 40) + NextNumber());
      case FieldDescriptor::CPPTYPE_BOOL:
        return reflection.SetBool(&message, &field, true);
      case FieldDescriptor::CPPTYPE_STRING:
        return reflection.SetString(&message, &field, NextText(field));
      case FieldDescriptor::CPPTYPE_ENUM:
        return reflection.SetEnumValue(&message, &field, NextValue(*field.enum_type()));
      case FieldDescriptor::CPPTYPE_MESSAGE:
        return FillMessage(*reflection.MutableMessage(&message, &field));
      default:
        ADD_FAILURE() << field.full_name() << ": Fill has no value of this type";
    }
  }

  void AddEntry(const FieldDescriptor& field, Message& message) {
    const Reflection& reflection = *message.GetReflection();
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return reflection.AddDouble(&message, &field, NextNumber() + 0.5);
      case FieldDescriptor::CPPTYPE_INT32:
        return reflection.AddInt32(&message, &field, (1 << 20) + NextNumber());
      case FieldDescriptor::CPPTYPE_INT64:
        return reflection.AddInt64(&message, &field, (int64_t{1} << 40) + NextNumber());
      case FieldDescriptor::CPPTYPE_STRING:
        return reflection.AddString(&message, &field, absl::StrCat("text ", NextNumber()));
      case FieldDescriptor::CPPTYPE_ENUM:
        return reflection.AddEnumValue(&message, &field, NextValue(*field.enum_type()));
      case FieldDescriptor::CPPTYPE_MESSAGE:
        return FillMessage(*reflection.AddMessage(&message, &field));
      default:
        ADD_FAILURE() << field.full_name() << ": Fill has no list of this type";
    }
  }

  int NextNumber() { return ++number_; }

  // Bytes are those of whole doubles, and each is the number of a regime and of a status.
  std::string NextText(const FieldDescriptor& field) {
    if (field.type() != FieldDescriptor::TYPE_BYTES) return absl::StrCat("text ", NextNumber());
    return std::string(2 * sizeof(double), static_cast<char>(NextNumber() % v1::RowStatus_MAX + 1));
  }

  int NextValue(const EnumDescriptor& type) {
    int& index = values_[type.full_name()];
    index = index % (type.value_count() - 1) + 1;
    return type.value(index)->number();
  }

  const int choice_;
  int number_ = 0;
  std::map<std::string, int> values_;
};

// Calls visit(field, message) for each number of a message and of its parts that may be absent.
void VisitOptionalNumbers(Message& message, absl::FunctionRef<void(const FieldDescriptor&, Message&)> visit) {
  const Reflection& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const bool is_message = field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    if (!is_message && field->has_presence()) visit(*field, message);
    if (!is_message) continue;
    if (!field->is_repeated()) VisitOptionalNumbers(*reflection.MutableMessage(&message, field), visit);
    for (int i = 0; field->is_repeated() && i < reflection.FieldSize(message, field); ++i) {
      VisitOptionalNumbers(*reflection.MutableRepeatedMessage(&message, field, i), visit);
    }
  }
}

}  // namespace

void Fill(int choice, google::protobuf::Message& message) { Filler(choice).FillMessage(message); }

void SetToZero(google::protobuf::Message& message) {
  VisitOptionalNumbers(message, [](const FieldDescriptor& field, Message& owner) {
    const Reflection& reflection = *owner.GetReflection();
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return reflection.SetDouble(&owner, &field, 0.0);
      case FieldDescriptor::CPPTYPE_INT32:
        return reflection.SetInt32(&owner, &field, 0);
      case FieldDescriptor::CPPTYPE_INT64:
        return reflection.SetInt64(&owner, &field, 0);
      default:
        ADD_FAILURE() << field.full_name() << ": SetToZero does not know this type";
    }
  });
}

void MakeAbsent(google::protobuf::Message& message) {
  VisitOptionalNumbers(
      message, [](const FieldDescriptor& field, Message& owner) { owner.GetReflection()->ClearField(&owner, &field); });
}

}  // namespace ricochet
