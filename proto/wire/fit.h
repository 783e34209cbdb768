// Converts fits, their requests and responses to their protos and back. An enum that this build does not know becomes
// kUnspecified.

#ifndef RICOCHET_PROTO_WIRE_FIT_H_
#define RICOCHET_PROTO_WIRE_FIT_H_

#include "proto/wire/enums.h"
#include "ricochet/fit.h"
#include "ricochet/v1/fit.pb.h"

namespace ricochet {

v1::FitRequest ToProto(const FitRequest& request);
FitRequest FromProto(const v1::FitRequest& proto);
v1::FitResponse ToProto(const FitResponse& response);
FitResponse FromProto(const v1::FitResponse& proto);

// A number without a name is handed on, so that the fit refuses it: that of no loss asks for least squares.
template <>
struct EnumPair<FitLoss> {
  using Other = v1::FitLoss;

  static int Known(int number) { return number; }
};
template <>
struct EnumPair<FitEndKind> : SameNumbers<v1::FitEnd::Kind, v1::FitEnd::Kind_IsValid> {};
template <>
struct EnumPair<AuditLimit> : SameNumbers<v1::AuditLimit, v1::AuditLimit_IsValid> {};

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_FIT_H_
