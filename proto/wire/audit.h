// Converts audits, their requests and responses to their protos and back. A verdict that this build does not know
// becomes kUnspecified.

#ifndef RICOCHET_PROTO_WIRE_AUDIT_H_
#define RICOCHET_PROTO_WIRE_AUDIT_H_

#include "proto/wire/enums.h"
#include "ricochet/solver.h"
#include "ricochet/v1/impact_service.pb.h"

namespace ricochet {

v1::AuditRequest ToProto(const AuditRequest& request);
AuditRequest FromProto(const v1::AuditRequest& proto);
v1::AuditResponse ToProto(const AuditResponse& response);
AuditResponse FromProto(const v1::AuditResponse& proto);

v1::AuditBatchRequest ToProto(const AuditBatchRequest& request);
AuditBatchRequest FromProto(const v1::AuditBatchRequest& proto);
v1::AuditBatchResponse ToProto(const AuditBatchResponse& response);
AuditBatchResponse FromProto(const v1::AuditBatchResponse& proto);

void ToProto(const InputColumn& column, v1::InputColumn& proto);
void FromProto(const v1::InputColumn& proto, InputColumn& column);

v1::AuditReport ToProto(const AuditReport& report);

template <>
struct EnumPair<Verdict> : SameNumbers<v1::LimitCheck::Verdict, v1::LimitCheck::Verdict_IsValid> {};

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_AUDIT_H_
