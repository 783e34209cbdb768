#include "client/cli/flag_names.h"

#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "ricochet/error.h"

namespace ricochet::cli {
namespace {

constexpr std::pair<const char*, const char*> kConnectionFlags[] = {
    {"target", "--server"},
    {"security.tls_ca", "--tls-ca"},
    {"security.tls_cert", "--tls-cert"},
    {"security.tls_key", "--tls-key"},
    {"security.server_name", "--server-name"},
    {"security.token_file", "--token-file"},
    {"security.token", "RICOCHET_TOKEN"},
};

constexpr std::pair<const char*, const char*> kSceneFlags[] = {
    {"pendulum.a_m", "--a"},
    {"pendulum.b_m", "--b"},
    {"pendulum.inertia_kg_m2", "--inertia"},
    {"pendulum.omega_minus_rad_s", "--omega"},
    {"friction.kinetic_coefficient", "--mu"},
    {"friction.static_coefficient", "--mu-static"},
    {"restitution.newton", "--newton"},
    {"restitution.poisson", "--poisson"},
    {"restitution.energetic", "--energetic"},
};

bool IsGiven(const CLI::App& command, const char* flag) {
  const CLI::Option* option = command.get_option_no_throw(flag);
  return option != nullptr && option->count() > 0;
}

// True if the flags of a pendulum stand for the scene of the command.
bool HasFlagsForScene(const CLI::App& command) {
  return command.get_option_no_throw("--a") != nullptr && !IsGiven(command, "--scene") &&
         !IsGiven(command, "--request");
}

void NameFlag(const CLI::App& command, Violation& violation) {
  for (const auto& [field, flag] : kConnectionFlags) {
    if (violation.field == field) violation.field = absl::StrCat(flag, ": ", field);
  }
  for (const auto& [field, flag] : kSceneFlags) {
    if (violation.field != field || !HasFlagsForScene(command)) continue;
    const absl::string_view rule = violation.description;
    if (!IsGiven(command, flag) && absl::StartsWith(rule, "= 0: ")) {
      violation.description = absl::StrCat("is missing: ", rule.substr(5));
    }
    violation.field = absl::StrCat(flag, ": ", field);
    return;
  }
}

}  // namespace

absl::Status NameFlags(const CLI::App& app, const absl::Status& error) {
  std::vector<Violation> violations = ViolationsOf(error);
  if (error.code() != absl::StatusCode::kInvalidArgument || violations.empty()) return error;
  for (const CLI::App* command : app.get_subcommands()) {
    for (Violation& violation : violations) NameFlag(*command, violation);
    return InvalidRequest(violations);
  }
  return error;
}

}  // namespace ricochet::cli
