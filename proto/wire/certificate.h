// Converts a Certificate to its proto and back.

#ifndef RICOCHET_PROTO_WIRE_CERTIFICATE_H_
#define RICOCHET_PROTO_WIRE_CERTIFICATE_H_

#include "ricochet/certificate.h"
#include "ricochet/v1/outcome.pb.h"

namespace ricochet {

void ToProto(const Certificate& certificate, v1::Certificate& proto);
void FromProto(const v1::Certificate& proto, Certificate& certificate);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_CERTIFICATE_H_
