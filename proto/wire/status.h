// absl::Status <-> grpc::Status: the one place where errors are mapped.
//
// Code and message are kept. Reason, violations and retry delay (ricochet/error.h) travel as google.rpc.ErrorInfo
// {reason, domain "ricochet"}, BadRequest and RetryInfo in grpc-status-details-bin; a status without any of them
// travels without details.
//
// gRPC clients drop a call whose trailers exceed 8 KiB, so a status that does not fit is cut: the details stay within
// 4 KiB and the message, percent-encoded, within 2 KiB. Violations are dropped from the end, the last one kept says how
// many, and the message lists those kept; any other message ends with the number of bytes that were cut.

#ifndef RICOCHET_PROTO_WIRE_STATUS_H_
#define RICOCHET_PROTO_WIRE_STATUS_H_

#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace ricochet {

grpc::Status ToGrpcStatus(const absl::Status& status);

// Reads what ToGrpcStatus wrote, and plain statuses of gRPC itself or of other services. A reason that this build does
// not know becomes ErrorReason::kUnspecified; violations without a reason mean kInvalidRequest.
absl::Status FromGrpcStatus(const grpc::Status& status);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_STATUS_H_
