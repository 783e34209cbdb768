// Credentials: how a server proves who it is, and whom it lets in.

#ifndef RICOCHET_SERVER_SECURITY_CREDENTIALS_H_
#define RICOCHET_SERVER_SECURITY_CREDENTIALS_H_

#include <grpcpp/security/server_credentials.h>

#include <memory>

#include "absl/status/statusor.h"
#include "server/base/log.h"
#include "server/security/auth.h"
#include "server/security/tls_files.h"

namespace ricochet::server {

// Returns the credentials of one port: gRPC asks for the certificates of each port once, so that two ports need two.
// They encrypt by TLS if `paths` name a certificate, and not otherwise. With client authorities a client without a
// certificate of theirs is cut off before it can send anything. With `auth`, which may be null, every call is checked
// before its message is read.
//
// The files are looked at before each handshake. Changed ones are used from then on; if they cannot be read or do not
// fit together, the server goes on with the old ones and an error stands in the log. `log` must outlive the
// credentials.
//
// Errors: those of TlsFiles::Read.
absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> MakeCredentials(const TlsPaths& paths,
                                                                         std::shared_ptr<Auth> auth, const Log& log);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_SECURITY_CREDENTIALS_H_
