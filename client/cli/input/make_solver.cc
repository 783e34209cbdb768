#include "client/cli/input/make_solver.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/cli/text/number_input.h"
#include "ricochet/client.h"

namespace ricochet::cli {
namespace {

absl::Status CheckThreads(const ConnectionInput& connection, std::optional<int> threads) {
  if (!threads.has_value()) return absl::OkStatus();
  return InputError(
      "--threads", absl::StrCat(*threads),
      absl::StrCat("not be given with the server ", connection.server, ", which computes with threads of its own"));
}

absl::StatusOr<std::unique_ptr<Solver>> Connect(const ClientOptions& options) {
  absl::StatusOr<Client> client = Client::Connect(options);
  if (!client.ok()) return client.status();
  return std::make_unique<Client>(*std::move(client));
}

}  // namespace

absl::StatusOr<ClientOptions> MakeClientOptions(const CommonOptions& options) {
  const absl::StatusOr<ConnectionInput> connection = Resolve(options.connection);
  if (!connection.ok()) return connection.status();
  if (connection->server.empty()) return absl::InvalidArgumentError("--server is required");
  return ClientOptionsOf(*connection);
}

absl::StatusOr<std::unique_ptr<Solver>> MakeSolver(const CommonOptions& options, std::optional<int> threads,
                                                   const Limits& limits) {
  const absl::StatusOr<ConnectionInput> connection = Resolve(options.connection);
  if (!connection.ok()) return connection.status();
  if (connection->server.empty()) {
    return std::make_unique<LocalSolver>(limits, threads.value_or(AvailableCores()));
  }
  if (absl::Status status = CheckThreads(*connection, threads); !status.ok()) return status;
  const absl::StatusOr<ClientOptions> client = ClientOptionsOf(*connection);
  if (!client.ok()) return client.status();
  return Connect(*client);
}

absl::StatusOr<std::unique_ptr<Solver>> MakeFanOut(const CommonOptions& options, std::optional<int> threads) {
  const absl::StatusOr<ConnectionInput> connection = Resolve(options.connection);
  if (!connection.ok()) return connection.status();
  if (connection->server.empty()) return absl::InvalidArgumentError("--fan-out needs --server A,B,...");
  if (!absl::StrContains(connection->server, ',')) {
    return InputError("--server", connection->server, "name at least two servers, separated by commas, for --fan-out");
  }
  if (absl::Status status = CheckThreads(*connection, threads); !status.ok()) return status;
  absl::StatusOr<ClientOptions> client = ClientOptionsOf(*connection);
  if (!client.ok()) return client.status();
  client->fan_out.emplace();
  return Connect(*client);
}

}  // namespace ricochet::cli
