// libFuzzer's mutator of targets whose input is a message in bytes. Changes of bytes seldom keep a message whole, and
// hardly ever put two numbers an ulp from where a regime changes; these do: one change of one field at a time, every
// fourth left to libFuzzer. It takes the part that libprotobuf-mutator would have, which Debian has not.

#include "tests/fuzz/mutate_message.h"

#include <google/protobuf/message.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace ricochet {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

// A number of a message, set or not.
struct Number {
  Message* message;
  const FieldDescriptor* field;
  int entry;

  double Get() const {
    const Reflection& reflection = *message->GetReflection();
    return field->is_repeated() ? reflection.GetRepeatedDouble(*message, field, entry)
                                : reflection.GetDouble(*message, field);
  }
  void Set(double value) const {
    const Reflection& reflection = *message->GetReflection();
    if (field->is_repeated()) return reflection.SetRepeatedDouble(message, field, entry, value);
    reflection.SetDouble(message, field, value);
  }
};

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  void Mutate(Message& message) {
    std::vector<Message*> messages;
    CollectMessages(message, messages);
    if (Below(4) != 0 && ChangeNumber(messages)) return;
    ChangeShape(*messages[Below(messages.size())]);
  }

  size_t Below(size_t end) { return std::uniform_int_distribution<size_t>(0, end - 1)(random_); }

 private:
  static void CollectMessages(Message& message, std::vector<Message*>& messages) {
    messages.push_back(&message);
    const Reflection& reflection = *message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    reflection.ListFields(message, &fields);
    for (const FieldDescriptor* field : fields) {
      if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
      if (!field->is_repeated()) {
        CollectMessages(*reflection.MutableMessage(&message, field), messages);
        continue;
      }
      for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
        CollectMessages(*reflection.MutableRepeatedMessage(&message, field, i), messages);
      }
    }
  }

  // A number in a oneof counts only where it is the one that is set.
  static std::vector<Number> NumbersOf(const std::vector<Message*>& messages) {
    std::vector<Number> numbers;
    for (Message* message : messages) {
      const Reflection& reflection = *message->GetReflection();
      for (int i = 0; i < message->GetDescriptor()->field_count(); ++i) {
        const FieldDescriptor* field = message->GetDescriptor()->field(i);
        if (field->cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE) continue;
        const bool optional = field->containing_oneof() != nullptr;
        const int entries = field->is_repeated()                                ? reflection.FieldSize(*message, field)
                            : optional && !reflection.HasField(*message, field) ? 0
                                                                                : 1;
        for (int entry = 0; entry < entries; ++entry) numbers.push_back({message, field, entry});
      }
    }
    return numbers;
  }

  bool ChangeNumber(const std::vector<Message*>& messages) {
    const std::vector<Number> numbers = NumbersOf(messages);
    if (numbers.empty()) return false;
    const Number& number = numbers[Below(numbers.size())];
    const double a = numbers[Below(numbers.size())].Get();
    const double b = numbers[Below(numbers.size())].Get();
    number.Set(Changed(number.Get(), a, b));
    return true;
  }

  double Changed(double value, double a, double b) {
    using Limits = std::numeric_limits<double>;
    static constexpr double kSpecial[] = {0.0,
                                          -0.0,
                                          1.0,
                                          0.5,
                                          Limits::denorm_min(),
                                          Limits::min(),
                                          Limits::max(),
                                          Limits::epsilon(),
                                          Limits::infinity(),
                                          Limits::quiet_NaN(),
                                          1e-300,
                                          1e300};
    const auto random_bits = [this] { return std::uniform_int_distribution<uint64_t>()(random_); };
    switch (Below(10)) {
      case 0:
        return kSpecial[Below(std::size(kSpecial))];
      case 1:
        return std::bit_cast<double>(random_bits());
      case 2:  // A few ulp off.
        return std::bit_cast<double>(std::bit_cast<uint64_t>(value) + Below(9) - 4);
      case 3:
        return -value;
      case 4:
        return std::ldexp(value, static_cast<int>(Below(129)) - 64);
      case 5:
        return a;
      case 6:
        return a / b;
      case 7:
        return a * b;
      case 8:
        return std::ldexp(static_cast<double>(random_bits() >> 11), -53);
      default:
        return value + a;
    }
  }

  // Sets, adds or takes away a field that is no number, or an entry of a list.
  void ChangeShape(Message& message) {
    const Reflection& reflection = *message.GetReflection();
    const FieldDescriptor* field = message.GetDescriptor()->field(
        static_cast<int>(Below(static_cast<size_t>(message.GetDescriptor()->field_count()))));
    if (field->is_repeated()) return ChangeLength(message, field);
    if (reflection.HasField(message, field) && Below(2) == 0) return reflection.ClearField(&message, field);
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        reflection.MutableMessage(&message, field);
        return;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return reflection.SetDouble(&message, field, Changed(0.5, 1.0, 3.0));
      case FieldDescriptor::CPPTYPE_BOOL:
        return reflection.SetBool(&message, field, true);
      case FieldDescriptor::CPPTYPE_INT64:
        return reflection.SetInt64(&message, field, static_cast<int64_t>(Below(20)) - 1);
      case FieldDescriptor::CPPTYPE_ENUM:
        return reflection.SetEnumValue(&message, field, static_cast<int>(Below(10)));
      case FieldDescriptor::CPPTYPE_STRING:
        return reflection.SetString(&message, field, SomeText());
      default:
        return;
    }
  }

  std::string SomeText() {
    static const std::vector<std::string>& texts = *new std::vector<std::string>(InputTexts());
    return texts.empty() ? "" : texts[Below(texts.size())];
  }

  void ChangeLength(Message& message, const FieldDescriptor* field) {
    const Reflection& reflection = *message.GetReflection();
    if (reflection.FieldSize(message, field) > 0 && Below(2) == 0) return reflection.RemoveLast(&message, field);
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        reflection.AddMessage(&message, field);
        return;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return reflection.AddDouble(&message, field, Changed(0.5, 1.0, 3.0));
      case FieldDescriptor::CPPTYPE_ENUM:
        return reflection.AddEnumValue(&message, field, static_cast<int>(Below(10)));
      case FieldDescriptor::CPPTYPE_STRING:
        return reflection.AddString(&message, field, SomeText());
      default:
        return;
    }
  }

  std::minstd_rand random_;
};

}  // namespace
}  // namespace ricochet

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  ricochet::Mutator mutator(seed);
  const std::unique_ptr<google::protobuf::Message> input = ricochet::NewInput();
  if (mutator.Below(4) == 0 || !input->ParseFromArray(data, static_cast<int>(size))) {
    return LLVMFuzzerMutate(data, size, max_size);
  }
  mutator.Mutate(*input);
  if (input->ByteSizeLong() > max_size) return size;
  input->SerializeToArray(data, static_cast<int>(max_size));
  return input->ByteSizeLong();
}
