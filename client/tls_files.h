// TlsFiles: the files of TLS that a client names, checked before the first call.
//
// gRPC says of a file that holds no key only that a server is unavailable, so that a program would try again for ever.

#ifndef RICOCHET_CLIENT_TLS_FILES_H_
#define RICOCHET_CLIENT_TLS_FILES_H_

#include <string>

#include "absl/status/statusor.h"
#include "ricochet/security_options.h"

namespace ricochet {

// The contents of the files, in PEM form; empty for a file that is not named.
struct TlsFiles {
  std::string ca;
  std::string cert;
  std::string key;
};

// Reads a file of the option `option`. An empty path gives an empty text.
// Errors: INVALID_ARGUMENT that names the option, if the file cannot be read or is empty.
absl::StatusOr<std::string> ReadSecurityFile(const std::string& path, const char* option);

// Reads the files and checks that they hold certificates and the key of the client's certificate, and that this
// certificate has not ended. Errors: INVALID_ARGUMENT with a violation for each option whose file is wrong.
absl::StatusOr<TlsFiles> ReadTlsFiles(const SecurityOptions& options);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_TLS_FILES_H_
