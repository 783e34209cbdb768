// Converts an Outcome to its proto and back. An enum number that this build does not know becomes kUnspecified.

#ifndef RICOCHET_PROTO_WIRE_OUTCOME_H_
#define RICOCHET_PROTO_WIRE_OUTCOME_H_

#include "ricochet/outcome.h"
#include "ricochet/v1/outcome.pb.h"

namespace ricochet {

v1::Outcome ToProto(const Outcome& outcome);
Outcome FromProto(const v1::Outcome& proto);

v1::Coefficients ToProto(const Coefficients& coefficients);
Coefficients FromProto(const v1::Coefficients& proto);

v1::ContactVelocity ToProto(const ContactVelocity& velocity);
ContactVelocity FromProto(const v1::ContactVelocity& proto);

v1::Regime ToProto(Regime regime);
Regime FromProto(v1::Regime proto);

v1::Termination ToProto(Termination termination);
Termination FromProto(v1::Termination proto);

v1::Event::Kind ToProto(EventKind kind);
EventKind FromProto(v1::Event::Kind proto);

v1::Accuracy::Kind ToProto(AccuracyKind kind);
AccuracyKind FromProto(v1::Accuracy::Kind proto);

v1::BrokenLimit::Kind ToProto(LimitKind kind);
LimitKind FromProto(v1::BrokenLimit::Kind proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_OUTCOME_H_
