#include "client/cli/input/make_solver.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"
#include "ricochet/client.h"
#include "ricochet/engine_info.h"

namespace ricochet::cli {

absl::StatusOr<ClientOptions> MakeClientOptions(const CommonOptions& options) {
  RICOCHET_TRY(const ConnectionInput connection, Resolve(options.connection));
  if (connection.server.empty()) return absl::InvalidArgumentError("--server is required");
  return ClientOptionsOf(connection);
}

absl::StatusOr<std::unique_ptr<Solver>> MakeSolver(const CommonOptions& options, std::optional<int> threads,
                                                   const Limits& limits, bool fan_out) {
  RICOCHET_TRY(const ConnectionInput connection, Resolve(options.connection));
  const std::string& server = connection.server;
  if (fan_out && server.empty()) return absl::InvalidArgumentError("--fan-out needs --server A,B,...");
  if (server.empty()) {
    // The fingerprint is made here, so that no time that a command reports holds it.
    static_cast<void>(ThisEngine());
    return std::make_unique<LocalSolver>(limits, threads.value_or(AvailableCores()));
  }
  if (fan_out && !absl::StrContains(server, ',')) {
    return InputError("--server", server, "name at least two servers, separated by commas, for --fan-out");
  }
  if (threads.has_value()) {
    return InputError(
        "--threads", absl::StrCat(*threads),
        absl::StrCat("not be given with the server ", server, ", which computes with threads of its own"));
  }
  RICOCHET_TRY(ClientOptions client_options, ClientOptionsOf(connection));
  if (fan_out) client_options.fan_out.emplace();
  RICOCHET_TRY(Client client, Client::Connect(client_options));
  return std::make_unique<Client>(std::move(client));
}

}  // namespace ricochet::cli
