// ToProto and FromProto for enums: each enum of the core has a proto with the same numbers, which
// tests/proto/enums_test.cc compares. A number that the proto does not know becomes 0: "unspecified" on both sides.

#ifndef RICOCHET_PROTO_WIRE_ENUMS_H_
#define RICOCHET_PROTO_WIRE_ENUMS_H_

#include <google/protobuf/descriptor.h>

#include <string>

#include "absl/strings/strip.h"

namespace ricochet {

// Returns the words with which every name of an enum of the service begins: "REGIME_" of REGIME_UNSPECIFIED.
inline std::string EnumPrefix(const google::protobuf::EnumDescriptor& type) {
  return std::string(absl::StripSuffix(type.value(0)->name(), "UNSPECIFIED"));
}

// The enum on the other side of the wire. Each header of this folder states the pairs of its proto.
template <typename Enum>
struct EnumPair;

template <typename OtherEnum, bool (*kIsValid)(int)>
struct SameNumbers {
  using Other = OtherEnum;

  static int Known(int number) { return kIsValid(number) ? number : 0; }
};

template <typename Enum>
typename EnumPair<Enum>::Other ToProto(Enum value) {
  return static_cast<typename EnumPair<Enum>::Other>(EnumPair<Enum>::Known(static_cast<int>(value)));
}

template <typename Enum>
Enum FromProto(typename EnumPair<Enum>::Other proto) {
  return static_cast<Enum>(EnumPair<Enum>::Known(static_cast<int>(proto)));
}

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_ENUMS_H_
