// ConnectionInput: which server a subcommand asks and how it proves who it is, from flags, the environment and a file.
//
// The value of an option is taken from the first of these that sets it: its flag (--tls-ca FILE), the environment
// (RICOCHET_TLS_CA=FILE; an empty variable counts as unset), the file of --config or RICOCHET_CONFIG (a line
// tls-ca = "FILE", TOML or INI).

#ifndef RICOCHET_CLIENT_CLI_INPUT_CONNECTION_INPUT_H_
#define RICOCHET_CLIENT_CLI_INPUT_CONNECTION_INPUT_H_

#include <string>

#include "absl/status/statusor.h"
#include "ricochet/client_options.h"

namespace CLI {
class App;
}

namespace ricochet::cli {

// The texts of the options; an empty one is not set.
struct ConnectionInput {
  std::string server;  // Empty: this process computes the answer.
  std::string deadline;
  std::string max_receive;  // Bytes.
  std::string tls;          // "true" or "false".
  std::string tls_ca;
  std::string tls_cert;
  std::string tls_key;
  std::string server_name;
  std::string token_file;
  std::string token;  // Never a flag, because every user of the machine can read those.
  std::string config;
};

// Returns how a user states this field of ClientOptions: "--tls-ca" for "security.tls_ca", RICOCHET_TOKEN for the
// token. Empty for any other field.
std::string FlagOfConnection(const std::string& field);

void AddConnectionOptions(CLI::App& app, ConnectionInput& input);

// Returns the input with what the environment and the file add to the flags.
// Errors: INVALID_ARGUMENT for a file that cannot be read or has an unknown line, and for a flag that needs --server if
// no server is named.
absl::StatusOr<ConnectionInput> Resolve(ConnectionInput input);

// Returns the options of a client of the server that is named. `input` must have been resolved.
// Errors: INVALID_ARGUMENT for a bad deadline or number of bytes, or a value of --tls that is neither true nor false.
absl::StatusOr<ClientOptions> ClientOptionsOf(const ConnectionInput& input);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_CONNECTION_INPUT_H_
