// Map: the fields of a message beside the members of the struct that it carries. Each pair is stated once, and both
// conversions read it:
//
//   template <>
//   struct Map<PowerLaw> : Between<PowerLaw, v1::PowerLaw> {
//     using Fields = Entries<Entry(&T::alpha, &P::alpha, &P::set_alpha),
//                            Entry(&T::exponent, &P::exponent, &P::set_exponent)>;
//   };
//
// The file that states the map then has ToProto(const PowerLaw&, v1::PowerLaw&) and FromProto(const v1::PowerLaw&,
// PowerLaw&); where other files need them, its header declares them. A map is a constant, so that the compiler makes of
// it what it would make of assignments.
//
// ToProto writes to a message without fields, FromProto to a struct as its constructor leaves it.

#ifndef RICOCHET_PROTO_WIRE_MAP_H_
#define RICOCHET_PROTO_WIRE_MAP_H_

#include <google/protobuf/repeated_field.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "proto/wire/enums.h"

namespace ricochet {

template <typename Struct>
struct Map;

template <typename Struct, typename Message>
struct Between {
  using T = Struct;
  using P = Message;
};

// Entries that are known when the program is compiled, so that no pointer to a member is left in it.
template <auto... kEntry>
struct Entries {
  template <typename Value, typename Message>
  static void Write(const Value& value, Message& message) {
    (kEntry.Write(value, message), ...);
  }
  template <typename Message, typename Value>
  static void Read(const Message& message, Value& value) {
    (kEntry.Read(message, value), ...);
  }
};

template <typename Struct>
void ToProto(const Struct& value, typename Map<Struct>::P& proto) {
  Map<Struct>::Fields::Write(value, proto);
}

template <typename Struct>
void FromProto(const typename Map<Struct>::P& proto, Struct& value) {
  Map<Struct>::Fields::Read(proto, value);
}

// The message of a struct, and the struct of a message.
template <typename Struct>
typename Map<Struct>::P Sent(const Struct& value) {
  typename Map<Struct>::P proto;
  Map<Struct>::Fields::Write(value, proto);
  return proto;
}

template <typename Struct>
Struct Received(const typename Map<Struct>::P& proto) {
  Struct value;
  Map<Struct>::Fields::Read(proto, value);
  return value;
}

inline void ToProto(const std::string& text, std::string& proto) { proto = text; }
inline void FromProto(const std::string& proto, std::string& text) { text = proto; }

// Lists of numbers and of enums.
template <typename List, typename Number>
void ToProto(const List& list, google::protobuf::RepeatedField<Number>& proto) {
  if constexpr (std::is_enum_v<typename List::value_type>) {
    for (const auto value : list) proto.Add(ToProto(value));
  } else {
    proto.Assign(list.begin(), list.end());
  }
}

template <typename List, typename Number>
void FromProto(const google::protobuf::RepeatedField<Number>& proto, List& list) {
  using Value = typename List::value_type;
  if constexpr (std::is_enum_v<Value>) {
    using Other = typename EnumPair<Value>::Other;
    for (const int number : proto) list.push_back(FromProto<Value>(static_cast<Other>(number)));
  } else {
    // The pointers make the copy a memcpy, which the library's iterators prevent.
    list.assign(proto.data(), proto.data() + proto.size());
  }
}

// Reads a list of tangential entries; missing ones are 0, further ones are ignored.
inline void FromProto(const google::protobuf::RepeatedField<double>& proto, std::array<double, 2>& values) {
  std::copy_n(proto.data(), std::min<size_t>(values.size(), static_cast<size_t>(proto.size())), values.begin());
}

// Lists of messages and of texts.
template <typename List, typename Message>
void ToProto(const List& list, google::protobuf::RepeatedPtrField<Message>& proto) {
  for (const auto& value : list) ToProto(value, *proto.Add());
}

template <typename List, typename Message>
void FromProto(const google::protobuf::RepeatedPtrField<Message>& proto, List& list) {
  list.reserve(static_cast<size_t>(proto.size()));
  for (const Message& message : proto) FromProto(message, list.emplace_back());
}

// A number, a flag or an enum.
template <typename Struct, typename Value, typename Message, typename Number>
struct NumberField {
  Value Struct::*member;
  Number (Message::*get)() const;
  void (Message::*set)(Number);

  static Number Sent(Value value) {
    if constexpr (std::is_enum_v<Value>)
      return ToProto(value);
    else
      return value;
  }
  static Value Received(Number number) {
    if constexpr (std::is_enum_v<Value>)
      return FromProto<Value>(number);
    else
      return number;
  }
  void Write(const Struct& value, Message& message) const { (message.*set)(Sent(value.*member)); }
  void Read(const Message& message, Struct& value) const { value.*member = Received((message.*get)()); }
};

template <typename Struct, typename Number, typename Message>
struct OptionalNumberField {
  std::optional<Number> Struct::*member;
  bool (Message::*has)() const;
  Number (Message::*get)() const;
  void (Message::*set)(Number);

  void Write(const Struct& value, Message& message) const {
    if ((value.*member).has_value()) (message.*set)(*(value.*member));
  }
  void Read(const Message& message, Struct& value) const {
    value.*member = (message.*has)() ? std::optional<Number>((message.*get)()) : std::nullopt;
  }
};

// A text, a list or a message.
template <typename Struct, typename Value, typename Message, typename Part>
struct PartField {
  Value Struct::*member;
  const Part& (Message::*get)() const;
  Part* (Message::*edit)();

  void Write(const Struct& value, Message& message) const { ToProto(value.*member, *(message.*edit)()); }
  void Read(const Message& message, Struct& value) const { FromProto((message.*get)(), value.*member); }
};

template <typename Struct, typename Value, typename Message, typename Part>
struct OptionalPartField {
  std::optional<Value> Struct::*member;
  bool (Message::*has)() const;
  const Part& (Message::*get)() const;
  Part* (Message::*edit)();

  void Write(const Struct& value, Message& message) const {
    if ((value.*member).has_value()) ToProto(*(value.*member), *(message.*edit)());
  }
  void Read(const Message& message, Struct& value) const {
    (value.*member).reset();
    if ((message.*has)()) FromProto((message.*get)(), (value.*member).emplace());
  }
};

template <typename Struct, typename Value, typename Message, typename Number>
constexpr auto Entry(Value Struct::*member, Number (Message::*get)() const, void (Message::*set)(Number)) {
  return NumberField<Struct, Value, Message, Number>{member, get, set};
}
template <typename Struct, typename Number, typename Message>
constexpr auto Entry(std::optional<Number> Struct::*member, bool (Message::*has)() const,
                     Number (Message::*get)() const, void (Message::*set)(Number)) {
  return OptionalNumberField<Struct, Number, Message>{member, has, get, set};
}
template <typename Struct, typename Value, typename Message, typename Part>
constexpr auto Entry(Value Struct::*member, const Part& (Message::*get)() const, Part* (Message::*edit)()) {
  return PartField<Struct, Value, Message, Part>{member, get, edit};
}
template <typename Struct, typename Value, typename Message, typename Part>
constexpr auto Entry(std::optional<Value> Struct::*member, bool (Message::*has)() const,
                     const Part& (Message::*get)() const, Part* (Message::*edit)()) {
  return OptionalPartField<Struct, Value, Message, Part>{member, has, get, edit};
}

// A part that is always sent, and that keeps the value of its constructor if a message lacks it.
template <typename Struct, typename Value, typename Message, typename Part>
struct DefaultedField {
  PartField<Struct, Value, Message, Part> field;
  bool (Message::*has)() const;

  void Write(const Struct& value, Message& message) const { field.Write(value, message); }
  void Read(const Message& message, Struct& value) const {
    if ((message.*has)()) field.Read(message, value);
  }
};
template <typename Struct, typename Value, typename Message, typename Part>
constexpr auto Defaulted(Value Struct::*member, bool (Message::*has)() const, const Part& (Message::*get)() const,
                         Part* (Message::*edit)()) {
  return DefaultedField<Struct, Value, Message, Part>{{member, get, edit}, has};
}

// The fields of a member, which stand in the message of its struct.
template <auto kMember, typename Fields>
struct Flat {
  template <typename Struct, typename Message>
  static void Write(const Struct& value, Message& message) {
    Fields::Write(value.*kMember, message);
  }
  template <typename Message, typename Struct>
  static void Read(const Message& message, Struct& value) {
    Fields::Read(message, value.*kMember);
  }
};

// Members of a struct that stand in a message of their own, which is always sent.
template <auto kGet, auto kEdit, typename Fields>
struct Nested {
  template <typename Struct, typename Message>
  static void Write(const Struct& value, Message& message) {
    Fields::Write(value, *(message.*kEdit)());
  }
  template <typename Message, typename Struct>
  static void Read(const Message& message, Struct& value) {
    Fields::Read((message.*kGet)(), value);
  }
};

// A member of a oneof: a message, or a number that is the only member of its alternative.
template <typename Message, typename Part>
struct PartCase {
  bool (Message::*has)() const;
  const Part& (Message::*get)() const;
  Part* (Message::*edit)();

  template <typename Value>
  void Write(const Value& value, Message& message) const {
    ToProto(value, *(message.*edit)());
  }
  template <typename Value>
  void Read(const Message& message, Value& value) const {
    FromProto((message.*get)(), value);
  }
};
template <typename Message, typename Value>
struct NumberCase : NumberField<Value, double, Message, double> {
  bool (Message::*has)() const;
};
template <typename Message, typename Part>
constexpr auto Case(bool (Message::*has)() const, const Part& (Message::*get)() const, Part* (Message::*edit)()) {
  return PartCase<Message, Part>{has, get, edit};
}
template <typename Message, typename Value>
constexpr auto Case(double Value::*member, bool (Message::*has)() const, double (Message::*get)() const,
                    void (Message::*set)(double)) {
  return NumberCase<Message, Value>{{member, get, set}, has};
}

// A oneof, whose members are the alternatives of a variant in their order, after the one that says that none is set.
template <auto... kCase>
struct OneOf {
  template <typename Variant, typename Message>
  static void Write(const Variant& variant, Message& message) {
    static_assert(std::variant_size_v<Variant> == sizeof...(kCase) + 1);
    WriteOne(variant, message, std::index_sequence_for<decltype(kCase)...>());
  }
  template <typename Message, typename Variant>
  static void Read(const Message& message, Variant& variant) {
    static_assert(std::variant_size_v<Variant> == sizeof...(kCase) + 1);
    ReadOne(message, variant, std::index_sequence_for<decltype(kCase)...>());
  }

 private:
  template <typename Variant, typename Message, size_t... kIndex>
  static void WriteOne(const Variant& variant, Message& message, std::index_sequence<kIndex...> /*indices*/) {
    static_cast<void>(
        ((variant.index() == kIndex + 1 && (kCase.Write(*std::get_if<kIndex + 1>(&variant), message), true)) || ...));
  }
  template <typename Message, typename Variant, size_t... kIndex>
  static void ReadOne(const Message& message, Variant& variant, std::index_sequence<kIndex...> /*indices*/) {
    static_cast<void>(
        (((message.*kCase.has)() && (kCase.Read(message, variant.template emplace<kIndex + 1>()), true)) || ...));
  }
};

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_MAP_H_
