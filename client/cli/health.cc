#include "ricochet/health.h"

#include <CLI/App.hpp>
#include <cstdio>

#include "absl/strings/str_cat.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/program.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] = R"(Example: the health probe of a container.
  $ ricochet health --server 127.0.0.1:50051
  SERVING
Exit codes: 0 serving, 75 any other state or no answer, 42 a server that no retry reaches, 2 wrong input.)";

struct HealthOptions {
  CommonOptions common;
  std::string service = "ricochet.v1.ImpactService";
};

const char* Name(Health health) {
  switch (health) {
    case Health::kServing:
      return "SERVING";
    case Health::kNotServing:
      return "NOT_SERVING";
    case Health::kUnknown:
      break;
  }
  return "UNKNOWN";
}

absl::Status RunHealth(const HealthOptions& options) {
  RICOCHET_TRY(const ClientOptions client_options, MakeClientOptions(options.common));
  const absl::StatusOr<Health> health = CheckHealth(client_options, options.service);
  // A service that is missing may still be starting.
  if (absl::IsNotFound(health.status())) {
    return absl::UnavailableError(absl::StrCat(options.service, ": ", health.status().message()));
  }
  if (!health.ok()) return health.status();
  std::printf("%s\n", Name(*health));
  if (*health == Health::kServing) return absl::OkStatus();
  return absl::UnavailableError(absl::StrCat(options.service, " is ", Name(*health)));
}

}  // namespace

void AddHealth(CLI::App& app, Command& command) {
  const auto [sub, options] =
      AddCommand<HealthOptions>(app, "health", "Ask whether a server takes calls", kExample, RunHealth, command);
  AddConnectionOptions(*sub, options->common.connection);
  sub->get_option("--server")->description("Ask the ricochetd at this address, or the first that answers; needed");
  sub->add_option("--service", options->service, "Full name of the service; empty for the server as a whole")
      ->type_name("NAME");
}

}  // namespace ricochet::cli
