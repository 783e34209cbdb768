// ToProto and FromProto for enums: each enum of the core has a proto with the same numbers, which
// tests/proto/enums_test.cc compares. A number that the proto does not know becomes 0: "unspecified" on both sides.

#ifndef RICOCHET_PROTO_WIRE_ENUMS_H_
#define RICOCHET_PROTO_WIRE_ENUMS_H_

namespace ricochet {

// The enum on the other side of the wire. Each header of this folder states the pairs of its proto.
template <typename Enum>
struct EnumPair;

template <typename OtherEnum, bool (*kIsValid)(int)>
struct SameNumbers {
  using Other = OtherEnum;

  template <typename Enum>
  static Other Of(Enum value) {
    const int number = static_cast<int>(value);
    return static_cast<Other>(kIsValid(number) ? number : 0);
  }
};

template <typename Enum>
typename EnumPair<Enum>::Other ToProto(Enum value) {
  return EnumPair<Enum>::Of(value);
}

template <typename Enum>
typename EnumPair<Enum>::Other FromProto(Enum proto) {
  return EnumPair<Enum>::Of(proto);
}

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_ENUMS_H_
