// MakeChannelCredentials: TLS and tokens of a channel, as SecurityOptions ask for them.

#ifndef RICOCHET_CLIENT_CREDENTIALS_H_
#define RICOCHET_CLIENT_CREDENTIALS_H_

#include <grpcpp/security/credentials.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "ricochet/error.h"
#include "ricochet/security_options.h"

namespace ricochet {

// Returns the rules that the options break, with the names of ClientOptions ("security.tls_key"). A token without TLS
// is refused unless `target` is a Unix socket or a loopback address.
std::vector<Violation> SecurityViolations(const SecurityOptions& options, const std::string& target);

// Makes the credentials. The options must be valid.
// Errors: INVALID_ARGUMENT that names each option whose file cannot be read or does not hold what it should.
absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> MakeChannelCredentials(const SecurityOptions& options,
                                                                                 const std::string& target);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_CREDENTIALS_H_
