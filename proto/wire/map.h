// Map: the fields of a message beside the members of the struct that it carries. Each pair is stated once, and both
// conversions read it:
//
//   RICOCHET_MAP(PowerLaw, alpha, exponent);
//
// A map with a part of another kind than a field and a member of one name is spelled out:
//
//   template <>
//   struct Map<FitInput> : Between<FitInput, v1::FitInput> {
//     static constexpr auto kFields = Entries(RICOCHET_FIELD(path), RICOCHET_FIELD_AS(values, numbers));
//   };
//
// The file that states the map then has ToProto(const PowerLaw&, v1::PowerLaw&) and FromProto(const v1::PowerLaw&,
// PowerLaw&). Where other files need them, its header declares them, and RICOCHET_CONVERT_IN_PLACE(PowerLaw) defines
// them; RICOCHET_CONVERT(PowerLaw) defines those that return what they make.
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
#include <tuple>
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

// Entries are a constant, so that the compiler makes of them what it would make of assignments.
template <typename... Parts>
struct Entries {
  std::tuple<Parts...> parts;

  explicit constexpr Entries(Parts... its_parts) : parts(its_parts...) {}

  template <typename Value, typename Message>
  void Write(const Value& value, Message& message) const {
    std::apply([&](const auto&... part) { (part.Write(value, message), ...); }, parts);
  }
  template <typename Message, typename Value>
  void Read(const Message& message, Value& value) const {
    std::apply([&](const auto&... part) { (part.Read(message, value), ...); }, parts);
  }
};

template <typename Value>
inline constexpr bool kIsOptional = false;
template <typename Value>
inline constexpr bool kIsOptional<std::optional<Value>> = true;

template <typename Struct>
void ToProto(const Struct& value, typename Map<Struct>::P& proto) {
  Map<Struct>::kFields.Write(value, proto);
}

template <typename Struct>
void FromProto(const typename Map<Struct>::P& proto, Struct& value) {
  Map<Struct>::kFields.Read(proto, value);
}

// The message of a struct, and the struct of a message.
template <typename Struct>
typename Map<Struct>::P Sent(const Struct& value) {
  typename Map<Struct>::P proto;
  Map<Struct>::kFields.Write(value, proto);
  return proto;
}

template <typename Struct>
Struct Received(const typename Map<Struct>::P& proto) {
  Struct value;
  Map<Struct>::kFields.Read(proto, value);
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

// Access calls the accessors that protobuf makes for a field. Each is a generic lambda, so that a field needs only
// those of its kind: get and set for a number, a flag or an enum, get and edit for a text, a list or a message, and has
// for what can be absent.
template <typename Get, typename Set, typename Edit, typename Has>
struct Access {
  Get get;
  Set set;
  Edit edit;
  Has has;

  template <typename Value, typename Message>
  void Write(const Value& value, Message& message) const {
    if constexpr (std::is_enum_v<Value>) {
      set(message, ToProto(value));
    } else if constexpr (std::is_arithmetic_v<Value>) {
      static_assert(std::is_same_v<Value, decltype(get(message))>);
      set(message, value);
    } else {
      ToProto(value, edit(message));
    }
  }
  template <typename Message, typename Value>
  void Read(const Message& message, Value& value) const {
    if constexpr (std::is_enum_v<Value>) {
      value = FromProto<Value>(get(message));
    } else if constexpr (std::is_arithmetic_v<Value>) {
      value = get(message);
    } else {
      FromProto(get(message), value);
    }
  }
};

template <typename Get, typename Set, typename Edit, typename Has>
constexpr auto MakeAccess(Get get, Set set, Edit edit, Has has) {
  return Access<Get, Set, Edit, Has>{get, set, edit, has};
}

#define RICOCHET_ACCESS(name)                                                                     \
  ricochet::MakeAccess([](const auto& message) -> decltype(auto) { return message.name(); },      \
                       [](auto& message, const auto& value) { message.set_##name(value); },       \
                       [](auto& message) -> decltype(auto) { return *message.mutable_##name(); }, \
                       [](const auto& message) { return message.has_##name(); })

// Pairs a member of a struct with a field. An optional member is unset where the field is absent.
template <typename Member, typename Access>
struct Field {
  Member member;
  Access access;

  template <typename Message>
  bool has(const Message& message) const {
    return access.has(message);
  }
  template <typename Struct, typename Message>
  void Write(const Struct& value, Message& message) const {
    const auto& number = member(value);
    if constexpr (kIsOptional<std::remove_cvref_t<decltype(number)>>) {
      if (number.has_value()) access.Write(*number, message);
    } else {
      access.Write(number, message);
    }
  }
  template <typename Message, typename Struct>
  void Read(const Message& message, Struct& value) const {
    auto& number = member(value);
    if constexpr (kIsOptional<std::remove_cvref_t<decltype(number)>>) {
      number.reset();
      if (access.has(message)) access.Read(message, number.emplace());
    } else {
      access.Read(message, number);
    }
  }
};

template <typename Member, typename Access>
constexpr auto MakeField(Member member, Access access) {
  return Field<Member, Access>{member, access};
}

#define RICOCHET_FIELD(name) RICOCHET_FIELD_AS(name, name)
#define RICOCHET_FIELD_AS(member, field) \
  ricochet::MakeField(                   \
      [](auto& value) -> auto& { return value.member; }, RICOCHET_ACCESS(field))

// RICOCHET_FIELDS(a, b, ...) lists RICOCHET_FIELD(a), RICOCHET_FIELD(b), ... for up to 32 names: each RICOCHET_EXPAND
// replaces what the one inside it has left, a call of RICOCHET_NEXT.
#define RICOCHET_FIELDS(...) RICOCHET_EXPAND(RICOCHET_FIRST(__VA_ARGS__))
#define RICOCHET_FIRST(name, ...) RICOCHET_FIELD(name) __VA_OPT__(, RICOCHET_NEXT RICOCHET_NONE(__VA_ARGS__))
#define RICOCHET_NEXT() RICOCHET_FIRST
#define RICOCHET_NONE ()
#define RICOCHET_EXPAND(...) RICOCHET_EXPAND4(RICOCHET_EXPAND4(RICOCHET_EXPAND4(RICOCHET_EXPAND4(__VA_ARGS__))))
#define RICOCHET_EXPAND4(...) RICOCHET_EXPAND2(RICOCHET_EXPAND2(RICOCHET_EXPAND2(RICOCHET_EXPAND2(__VA_ARGS__))))
#define RICOCHET_EXPAND2(...) RICOCHET_EXPAND1(RICOCHET_EXPAND1(__VA_ARGS__))
#define RICOCHET_EXPAND1(...) __VA_ARGS__

#define RICOCHET_MAP_AS(Struct, Message, ...)                              \
  template <>                                                              \
  struct Map<Struct> : Between<Struct, Message> {                          \
    static constexpr auto kFields = Entries(RICOCHET_FIELDS(__VA_ARGS__)); \
  }
#define RICOCHET_MAP(Struct, ...) RICOCHET_MAP_AS(Struct, v1::Struct, __VA_ARGS__)

#define RICOCHET_CONVERT_IN_PLACE(Struct)                                                                 \
  void ToProto(const Struct& value, Map<Struct>::P& proto) { Map<Struct>::kFields.Write(value, proto); }  \
  void FromProto(const Map<Struct>::P& proto, Struct& value) { Map<Struct>::kFields.Read(proto, value); } \
  static_assert(true)
#define RICOCHET_CONVERT(Struct)                                                    \
  Map<Struct>::P ToProto(const Struct& value) { return Sent(value); }               \
  Struct FromProto(const Map<Struct>::P& proto) { return Received<Struct>(proto); } \
  static_assert(true)

// A part that is always sent, and that keeps the value of its constructor if a message lacks it.
template <typename Field>
struct Defaulted {
  Field field;

  explicit constexpr Defaulted(Field its_field) : field(its_field) {}

  template <typename Struct, typename Message>
  void Write(const Struct& value, Message& message) const {
    field.Write(value, message);
  }
  template <typename Message, typename Struct>
  void Read(const Message& message, Struct& value) const {
    if (field.has(message)) field.Read(message, value);
  }
};

// The fields of a member, which stand in the message of its struct.
template <typename Value, typename Struct, typename Fields>
struct Flat {
  Value Struct::*member;
  Fields fields;

  constexpr Flat(Value Struct::*its_member, Fields its_fields) : member(its_member), fields(std::move(its_fields)) {}

  template <typename Message>
  void Write(const Struct& value, Message& message) const {
    fields.Write(value.*member, message);
  }
  template <typename Message>
  void Read(const Message& message, Struct& value) const {
    fields.Read(message, value.*member);
  }
};

// Members of a struct that stand in a message of their own, which is always sent.
template <typename Access, typename Fields>
struct Nested {
  Access access;
  Fields fields;

  constexpr Nested(Access its_access, Fields its_fields)
      : access(std::move(its_access)), fields(std::move(its_fields)) {}

  template <typename Struct, typename Message>
  void Write(const Struct& value, Message& message) const {
    fields.Write(value, access.edit(message));
  }
  template <typename Message, typename Struct>
  void Read(const Message& message, Struct& value) const {
    fields.Read(access.get(message), value);
  }
};

// A oneof: its members stand for the alternatives of a variant in their order, after that for none.
// A member is the Access of a message, or the Field of a number that is the only member of its alternative.
template <typename... Cases>
struct OneOf {
  std::tuple<Cases...> cases;

  explicit constexpr OneOf(Cases... its_cases) : cases(its_cases...) {}

  template <typename Variant, typename Message>
  void Write(const Variant& variant, Message& message) const {
    static_assert(std::variant_size_v<Variant> == sizeof...(Cases) + 1);
    WriteOne(variant, message, std::index_sequence_for<Cases...>());
  }
  template <typename Message, typename Variant>
  void Read(const Message& message, Variant& variant) const {
    static_assert(std::variant_size_v<Variant> == sizeof...(Cases) + 1);
    ReadOne(message, variant, std::index_sequence_for<Cases...>());
  }

 private:
  template <typename Variant, typename Message, size_t... kIndex>
  void WriteOne(const Variant& variant, Message& message, std::index_sequence<kIndex...> /*indices*/) const {
    static_cast<void>(((variant.index() == kIndex + 1 &&
                        (std::get<kIndex>(cases).Write(*std::get_if<kIndex + 1>(&variant), message), true)) ||
                       ...));
  }
  template <typename Message, typename Variant, size_t... kIndex>
  void ReadOne(const Message& message, Variant& variant, std::index_sequence<kIndex...> /*indices*/) const {
    static_cast<void>(((std::get<kIndex>(cases).has(message) &&
                        (std::get<kIndex>(cases).Read(message, variant.template emplace<kIndex + 1>()), true)) ||
                       ...));
  }
};

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_MAP_H_
