// Converts the requests and responses about several contacts to their protos and back.

#ifndef RICOCHET_PROTO_WIRE_MULTI_CONTACT_H_
#define RICOCHET_PROTO_WIRE_MULTI_CONTACT_H_

#include "proto/wire/enums.h"
#include "ricochet/multi_contact.h"
#include "ricochet/v1/multi_contact.pb.h"

namespace ricochet {

template <>
struct EnumPair<MultiContactMethod>
    : SameNumbers<v1::MultiContactRequest::Method, v1::MultiContactRequest::Method_IsValid> {};
template <>
struct EnumPair<MultiContactEnd> : SameNumbers<v1::AttainedOutcome::End, v1::AttainedOutcome::End_IsValid> {};
template <>
struct EnumPair<MultiContactVerdict>
    : SameNumbers<v1::MultiContactAnswer::Verdict, v1::MultiContactAnswer::Verdict_IsValid> {};

v1::MultiContactScene ToProto(const MultiContactScene& scene);
MultiContactScene FromProto(const v1::MultiContactScene& proto);
void ToProto(const MultiContactScene& scene, v1::MultiContactScene& proto);
void FromProto(const v1::MultiContactScene& proto, MultiContactScene& scene);
v1::MultiContactRequest ToProto(const MultiContactRequest& request);
MultiContactRequest FromProto(const v1::MultiContactRequest& proto);
v1::MultiContactResponse ToProto(const MultiContactResponse& response);
MultiContactResponse FromProto(const v1::MultiContactResponse& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_MULTI_CONTACT_H_
