// absl::Status <-> grpc::Status: the one place where errors are mapped.
//
// Code and message are kept. Reason, violations and retry delay (core/error.h) travel as google.rpc.ErrorInfo
// {reason, domain "ricochet"}, BadRequest and RetryInfo in grpc-status-details-bin, together below 4 KiB: violations
// beyond that are dropped from the end and the last one kept says how many there were.

#ifndef RICOCHET_PROTO_WIRE_STATUS_H_
#define RICOCHET_PROTO_WIRE_STATUS_H_

#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace ricochet {

grpc::Status ToGrpcStatus(const absl::Status& status);

// Reads what ToGrpcStatus wrote, and plain statuses of gRPC itself or of other services.
absl::Status FromGrpcStatus(const grpc::Status& status);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_STATUS_H_
