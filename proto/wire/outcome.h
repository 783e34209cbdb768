// Converts an Outcome to its proto and back. An enum number that this build does not know becomes kUnspecified.

#ifndef RICOCHET_PROTO_WIRE_OUTCOME_H_
#define RICOCHET_PROTO_WIRE_OUTCOME_H_

#include "proto/wire/enums.h"
#include "ricochet/certificate.h"
#include "ricochet/outcome.h"
#include "ricochet/v1/outcome.pb.h"

namespace ricochet {

v1::Outcome ToProto(const Outcome& outcome);
Outcome FromProto(const v1::Outcome& proto);
void ToProto(const Outcome& outcome, v1::Outcome& proto);
void FromProto(const v1::Outcome& proto, Outcome& outcome);

void ToProto(const Coefficients& coefficients, v1::Coefficients& proto);
void FromProto(const v1::Coefficients& proto, Coefficients& coefficients);

void ToProto(const ContactVelocity& velocity, v1::ContactVelocity& proto);
void FromProto(const v1::ContactVelocity& proto, ContactVelocity& velocity);

void ToProto(const Certificate& certificate, v1::Certificate& proto);
void FromProto(const v1::Certificate& proto, Certificate& certificate);

void ToProto(const Derivative& derivative, v1::Derivative& proto);
void FromProto(const v1::Derivative& proto, Derivative& derivative);

template <>
struct EnumPair<Regime> : SameNumbers<v1::Regime, v1::Regime_IsValid> {};

template <>
struct EnumPair<Termination> : SameNumbers<v1::Termination, v1::Termination_IsValid> {};

template <>
struct EnumPair<EventKind> : SameNumbers<v1::Event::Kind, v1::Event::Kind_IsValid> {};

template <>
struct EnumPair<AccuracyKind> : SameNumbers<v1::Accuracy::Kind, v1::Accuracy::Kind_IsValid> {};

template <>
struct EnumPair<LimitKind> : SameNumbers<v1::BrokenLimit::Kind, v1::BrokenLimit::Kind_IsValid> {};

template <>
struct EnumPair<DerivativeKind> : SameNumbers<v1::Derivative::Kind, v1::Derivative::Kind_IsValid> {};

template <>
struct EnumPair<Threshold> : SameNumbers<v1::Derivative::Threshold, v1::Derivative::Threshold_IsValid> {};

template <>
struct EnumPair<NoteKind> : SameNumbers<v1::Note::Kind, v1::Note::Kind_IsValid> {};

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_OUTCOME_H_
