// MakeChannel: the gRPC channel that ClientOptions describe.

#ifndef RICOCHET_CLIENT_CHANNEL_H_
#define RICOCHET_CLIENT_CHANNEL_H_

#include <grpcpp/channel.h>

#include <memory>

#include "absl/status/statusor.h"
#include "ricochet/client_options.h"

namespace ricochet {

// Makes a channel that connects at its first call, with the security that the options ask for.
// Errors: INVALID_ARGUMENT for invalid options.
absl::StatusOr<std::shared_ptr<grpc::Channel>> MakeChannel(const ClientOptions& options);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_CHANNEL_H_
