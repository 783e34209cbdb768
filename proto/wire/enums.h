// SameNumber: converts an enum of the vocabulary to its proto and back. Both have the same numbers, as
// tests/proto/enums_test.cc holds them to.

#ifndef RICOCHET_PROTO_WIRE_ENUMS_H_
#define RICOCHET_PROTO_WIRE_ENUMS_H_

namespace ricochet {

// `is_valid` tells the numbers of the proto. Any other becomes 0, which is "unspecified" on both sides.
template <typename To, typename From>
To SameNumber(From from, bool (*is_valid)(int)) {
  const int number = static_cast<int>(from);
  return static_cast<To>(is_valid(number) ? number : 0);
}

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_ENUMS_H_
