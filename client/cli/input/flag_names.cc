#include "client/cli/input/flag_names.h"

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "client/cli/input/connection_input.h"
#include "client/cli/input/scene_input.h"
#include "core/base/utf8.h"
#include "ricochet/error.h"

namespace ricochet::cli {
namespace {

bool IsGiven(const CLI::App& command, const char* flag) {
  const CLI::Option* option = command.get_option_no_throw(flag);
  return option != nullptr && option->count() > 0;
}

// True if the flags of a pendulum stand for the scene of the command.
bool HasFlagsForScene(const CLI::App& command) {
  return command.get_option_no_throw("--a") != nullptr && !IsGiven(command, "--scene") &&
         !IsGiven(command, "--request");
}

// The flags that set fields of requests, by how their paths begin. Where that ends with "[", the index that follows is
// that of the text, too. "coefficients.*" stands for several columns, so that theirs is not.
constexpr std::pair<const char*, const char*> kRequestFlags[] = {{"relative_tolerance", "--tolerance"},
                                                                 {"required[", "--require"},
                                                                 {"excluded[", "--exclude"},
                                                                 {"first_index", "--range"},
                                                                 {"end_index", "--range"},
                                                                 {"time_limit_s", "--time-limit"},
                                                                 {"velocity_uncertainty_m_s", "--uncertainty"},
                                                                 {"states[", "--state"},
                                                                 {"outputs[", "--function"},
                                                                 {"axes[", "--axis"},
                                                                 {"ranges[", "--range"},
                                                                 {"columns", "--column"},
                                                                 {"derivatives.of[", "--derivatives"},
                                                                 {"derivatives.by[", "--by"},
                                                                 {"unknowns[", "--unknown"},
                                                                 {"loss", "--loss"},
                                                                 {"force_intervals", "--force-history"},
                                                                 {"history_intervals", "--history"},
                                                                 {"certified_digits", "--certified"},
                                                                 {"both_ends", "--both-ends"},
                                                                 {"rates", "--observed-rate"},
                                                                 {"stiffness_range.", "--stiffness-ratio"},
                                                                 {"contact_velocity.", "--observed-velocity"}};

// Returns the flag as it was given, with its text if the path says which of several texts is meant: for "axes[1].list"
// that is the second, "--axis mu=0,1".
std::string AsGiven(const CLI::App& command, const std::string& flag, const std::string& beginning,
                    absl::string_view path) {
  const std::vector<std::string> texts = command.get_option(flag)->results();
  size_t place = 0;
  const bool is_one_of_several = absl::EndsWith(beginning, "[") && absl::ConsumePrefix(&path, beginning) &&
                                 absl::SimpleAtoi(path.substr(0, path.find(']')), &place);
  // A list of values may be longer than a screen.
  return is_one_of_several && place < texts.size() ? absl::StrCat(flag, " ", Excerpt(texts[place])) : flag;
}

void NameFlag(const CLI::App& command, Violation& violation) {
  const std::string field = violation.field;
  for (const auto& [beginning, flag] : kRequestFlags) {
    if (!absl::StartsWith(field, beginning) || !IsGiven(command, flag)) continue;
    violation.field = absl::StrCat(AsGiven(command, flag, beginning, field), ": ", field);
    return;
  }
  if (const std::string flag = FlagOfConnection(field); !flag.empty())
    violation.field = absl::StrCat(flag, ": ", field);
  for (const SceneFlag& flag : SceneFlags()) {
    if (field != flag.field || !HasFlagsForScene(command)) continue;
    violation.field = absl::StrCat(flag.name, IsGiven(command, flag.name) ? ": " : " (not given): ", field);
    return;
  }
}

}  // namespace

absl::Status NameFlags(const CLI::App& app, const absl::Status& error) {
  std::vector<Violation> violations = ViolationsOf(error);
  if (violations.empty()) return error;
  for (const CLI::App* command : app.get_subcommands()) {
    for (Violation& violation : violations) NameFlag(*command, violation);
    return WithViolations(error, violations);
  }
  return error;
}

}  // namespace ricochet::cli
