// SecurityOptions: how a Client proves who it is and makes sure of its server.

#ifndef RICOCHET_SECURITY_OPTIONS_H_
#define RICOCHET_SECURITY_OPTIONS_H_

#include <string>

namespace ricochet {

// All paths are those of files in PEM form, read when the client is made. Default: no TLS, no token.
struct SecurityOptions {
  bool tls = false;              // Encrypt, and make sure of the server. Needed beyond this host if there is a token.
  std::string tls_ca = {};       // The authorities that may have issued the server's certificate; empty: the system's.
  std::string tls_cert = {};     // This client's certificate chain; empty: none. Needs tls_key.
  std::string tls_key = {};      // The private key of tls_cert, without a pass phrase.
  std::string server_name = {};  // The name that the server's certificate must have; empty: the host of the target.
  std::string token = {};        // Sent with every call; empty: none. At most one of token and token_file.
  std::string token_file = {};   // A file that holds the token, read again for every call, so that tokens can change.
};

}  // namespace ricochet

#endif  // RICOCHET_SECURITY_OPTIONS_H_
