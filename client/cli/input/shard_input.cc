#include "client/cli/input/shard_input.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "absl/strings/str_cat.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

constexpr const char* kFlags[] = {"--shard", "--shard-index", "--shard-count"};

constexpr char kSlurmStep[] = "SLURM_ARRAY_TASK_STEP";

// The variables by which a system tells a task its place. A null pointer stands for what a system does not tell.
struct Launcher {
  const char* name;
  const char* index;
  const char* count;
  const char* first;  // The index of the first task, if that is not 0.
};

constexpr Launcher kLaunchers[] = {
    {"Slurm", "SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN"},
    {"Kubernetes", "JOB_COMPLETION_INDEX", nullptr, nullptr},
    {"Open MPI", "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr},
};

bool IsSet(const char* variable) { return std::getenv(variable) != nullptr; }

absl::StatusOr<int64_t> FromEnvironment(const char* variable) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) return absl::InvalidArgumentError(absl::StrCat("the environment lacks ", variable));
  return ParseCount(text, variable);
}

// Returns the system that started this run, or null if it is none of them.
absl::StatusOr<const Launcher*> FindLauncher() {
  const Launcher* found = nullptr;
  for (const Launcher& launcher : kLaunchers) {
    if (!IsSet(launcher.index)) continue;
    if (found != nullptr) {
      return absl::InvalidArgumentError(absl::StrCat("both ", found->index, " and ", launcher.index,
                                                     " are in the environment: say which shard by --shard-index I "
                                                     "--shard-count N"));
    }
    found = &launcher;
  }
  return found;
}

// Returns the place of this task among all, which start at `first` and are a step apart.
absl::StatusOr<int64_t> PlaceOf(const Launcher& launcher) {
  const absl::StatusOr<int64_t> index = FromEnvironment(launcher.index);
  if (!index.ok() || launcher.first == nullptr) return index;
  RICOCHET_TRY(const int64_t first, FromEnvironment(launcher.first));
  RICOCHET_TRY(const int64_t step, IsSet(kSlurmStep) ? FromEnvironment(kSlurmStep) : 1);
  if (*index < first || step < 1 || (*index - first) % step != 0) {
    return InputError(launcher.index, absl::StrCat(*index),
                      absl::StrCat("be ", first, " or a number of steps of ", step, " above it"));
  }
  return (*index - first) / step;
}

absl::StatusOr<int64_t> FindCount(const ShardInput& input, const Launcher* launcher) {
  if (!input.count.empty()) return ParseCount(input.count, "--shard-count");
  if (launcher != nullptr && launcher->count != nullptr) return FromEnvironment(launcher->count);
  return absl::InvalidArgumentError(absl::StrCat(
      "--shard-count is missing: ",
      launcher == nullptr ? "no Slurm array, Indexed Job or mpirun started this run"
                          : absl::StrCat(launcher->name, " tells a task its number, not how many there are")));
}

absl::StatusOr<int64_t> FindIndex(const ShardInput& input, const Launcher* launcher) {
  if (!input.index.empty()) return ParseCount(input.index, "--shard-index");
  if (launcher == nullptr) {
    return absl::InvalidArgumentError(
        "--shard-index is missing: no Slurm array, Indexed Job or mpirun started this run");
  }
  return input.count.empty() ? PlaceOf(*launcher) : FromEnvironment(launcher->index);
}

}  // namespace

void AddShardOptions(CLI::App& app, ShardInput& input) {
  const auto add = [&app](CLI::Option* option) {
    option->group("Shards")->excludes(app.get_option("--format"))->excludes(app.get_option("--summary-only"));
    option->excludes(app.get_option("--plot"));
  };
  add(app.add_flag("--shard", input.from_environment,
                   "Compute the part of this task of a Slurm array, an Indexed Job of Kubernetes or an mpirun of Open "
                   "MPI, into FILE.shard-I-of-N; ricochet merge FILE puts them together"));
  add(app.add_option("--shard-index", input.index, "Compute part I of N, counted from 0")->type_name("I"));
  add(app.add_option("--shard-count", input.count, "The number of parts; needed where the environment does not say it")
          ->type_name("N"));
}

bool WritesShard(const CLI::App& app) {
  return std::any_of(std::begin(kFlags), std::end(kFlags), [&app](const char* flag) {
    const CLI::Option* option = app.get_option_no_throw(flag);
    return option != nullptr && option->count() > 0;
  });
}

absl::StatusOr<ShardNumber> FindShard(const ShardInput& input) {
  const bool is_explicit = !input.index.empty() && !input.count.empty();
  RICOCHET_TRY(const Launcher* launcher, is_explicit ? nullptr : FindLauncher());
  RICOCHET_TRY(const int64_t count, FindCount(input, launcher));
  if (count < 1) return InputError("--shard-count", absl::StrCat(count), "be at least 1");
  RICOCHET_TRY(const int64_t index, FindIndex(input, launcher));
  if (index >= 0 && index < count) return ShardNumber{.index = index, .count = count};
  if (!input.index.empty()) {
    return InputError("--shard-index", input.index, absl::StrCat("be in [0, ", count - 1, "], for ", count, " shards"));
  }
  return absl::InvalidArgumentError(absl::StrCat(launcher->index, " = ", std::getenv(launcher->index), " is shard ",
                                                 index, ", counted from 0, but there are only ", count, " shards"));
}

}  // namespace ricochet::cli
