// MakeChannels: the gRPC channels that ClientOptions describe, one for each server.

#ifndef RICOCHET_CLIENT_CHANNEL_H_
#define RICOCHET_CLIENT_CHANNEL_H_

#include <grpcpp/channel.h>

#include <chrono>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "ricochet/client_options.h"

namespace ricochet {

// Makes channels that connect at their first call, at least one, with the security that the options ask for.
// Errors: INVALID_ARGUMENT for invalid options.
absl::StatusOr<std::vector<std::shared_ptr<grpc::Channel>>> MakeChannels(const ClientOptions& options);

// Gives a channel whose last attempt to connect failed a moment to connect, but not beyond the deadline of a call.
// While no call waits, gRPC looks only every five seconds whether a connection has come about.
void AwaitReconnection(grpc::Channel& channel, std::chrono::system_clock::time_point deadline);

// Waits until gRPC has destroyed every channel of MakeChannels, with its calls: a thread of gRPC may still be at it
// after the last pointer to a channel is gone. Returns false if they are not destroyed within `longest`.
bool AllChannelsEnd(std::chrono::milliseconds longest);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_CHANNEL_H_
