// Converts a Certificate to its proto and back.

#ifndef RICOCHET_PROTO_WIRE_CERTIFICATE_H_
#define RICOCHET_PROTO_WIRE_CERTIFICATE_H_

#include "ricochet/certificate.h"
#include "ricochet/v1/outcome.pb.h"

namespace ricochet {

v1::Certificate ToProto(const Certificate& certificate);
Certificate FromProto(const v1::Certificate& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_CERTIFICATE_H_
