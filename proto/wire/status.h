// Converts absl::Status to grpc::Status and back. This is the only place where errors are mapped.
//
// Code and message are kept. Reason, violations and retry delay (ricochet/error.h) travel as google.rpc.ErrorInfo
// {reason, domain "ricochet"}, BadRequest and RetryInfo in grpc-status-details-bin; a status without any of them
// travels without details.
//
// gRPC clients drop a call whose trailers exceed 8 KiB, so a status that does not fit is cut: the details stay within
// 4 KiB and the percent-encoded message within 2 KiB. Violations are dropped from the end, and the last one kept says
// that there are more; the message lists the violations kept. Any other message ends with the number of bytes that were
// cut.

#ifndef RICOCHET_PROTO_WIRE_STATUS_H_
#define RICOCHET_PROTO_WIRE_STATUS_H_

#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace ricochet {

grpc::Status ToGrpcStatus(const absl::Status& status);

// Reads a status that ToGrpcStatus wrote, or a plain status of gRPC itself or of another service. A reason that this
// build does not know becomes ErrorReason::kUnspecified; violations without a reason mean kInvalidRequest.
absl::Status FromGrpcStatus(const grpc::Status& status);

// Adds to a status what another one carries besides its code and message.
void CopyPayloads(const absl::Status& from, absl::Status& to);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_STATUS_H_
