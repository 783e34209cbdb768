// Compares every output of the closed-form models, in bulk, with the accuracy that their headers promise.
//
//   ricochet_ulp POINTS
//
// Half of the points are pendulums, half planar impacts, held against the formulas in ball arithmetic. A hundredth of
// all lies near each sign change, within 2^-20 to 2^-52 of it; the others are drawn from all doubles, from everyday
// sizes and from the neighbourhood of thresholds. Prints the errors of each output. Fails if an output exceeds its
// promise, is infinite though its exact value is not, or goes unnamed where it is. The points, and so all that is
// printed, depend on POINTS alone.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/synchronization/mutex.h"
#include "core/answer/model_outcomes.h"
#include "core/contact/reduction.h"
#include "core/models/planar/columns.h"
#include "tests/support/oracles/pendulum_oracle.h"
#include "tests/support/oracles/planar_oracle.h"
#include "tests/support/scenes/made_outcome.h"
#include "tests/support/scenes/pendulum_scenes.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/ulp/error_table.h"

namespace ricochet {
namespace {

constexpr double kPromisedUlps = 1.0;  // core/models/pendulum/pendulum.h, core/models/planar/planar.h
constexpr int64_t kPointsPerBlock = 2000;
constexpr double kWrong = std::numeric_limits<double>::infinity();

bool IsRefusedByName(const absl::StatusOr<Outcome>& outcome) {
  return absl::IsOutOfRange(outcome.status()) && absl::StrContains(outcome.status().message(), "outcome.");
}

struct PendulumModel {
  using Problem = pendulum::Problem;
  using Source = pendulum::SceneSource;
  static constexpr const char* kName = "pendulum";
  static constexpr int kSignChanges = Source::kSignChanges;
  static constexpr size_t kOutputs = pendulum::kOutputCount;
  // Among the points that are not near a sign change, one in this many may have any exponent of a double.
  static constexpr uint64_t kOverAllDoubles = 2;

  static const std::array<const char*, kOutputs>& Names() { return pendulum::OutputNames(); }

  static std::array<double, kOutputs> Errors(const Problem& problem) {
    const pendulum::ExactImpact exact = pendulum::SolveExactly(problem);
    const pendulum::Impact impact = pendulum::Solve(problem);
    std::array<double, kOutputs> errors;
    errors.fill(kWrong);
    if (impact.regime != exact.regime) return errors;
    bool overflows = false;
    for (size_t i = 0; i < kOutputs; ++i) {
      errors[i] = pendulum::OutputError(exact, i, impact.values[i]);
      const bool is_told = *pendulum::kOutputPaths[i] != '\0';
      overflows = overflows || (is_told && std::isinf(impact.values[i]));
    }
    const auto outcome = Made([&problem](Outcome& made) { return pendulum::MakeOutcome(problem, 0.0, {}, made); });
    if (overflows && !IsRefusedByName(outcome)) errors.fill(kWrong);
    return errors;
  }
};

struct PlanarModel {
  using Problem = planar::Problem;
  using Source = planar::SceneSource;
  static constexpr const char* kName = "planar";
  static constexpr int kSignChanges = Source::kSignChanges;
  static constexpr size_t kOutputs = planar::kOutputNames.size();
  // There are few of these, because the oracle takes a hundred times longer for them.
  static constexpr uint64_t kOverAllDoubles = 64;

  static const std::array<const char*, kOutputs>& Names() { return planar::kOutputNames; }

  static std::array<double, kOutputs> Errors(const Problem& problem) {
    const planar::ExactImpact exact = planar::SolveExactly(problem);
    const planar::Impact impact = planar::Solve(problem);
    std::array<double, kOutputs> errors;
    errors.fill(kWrong);
    if (impact.regime != exact.regime || static_cast<size_t>(impact.event_count) != exact.events.size()) return errors;
    errors = planar::ErrorsOf(problem, impact, exact);
    if (Overflows(impact) && !IsRefused(problem)) errors.fill(kWrong);
    return errors;
  }

 private:
  static bool Overflows(const planar::Impact& impact) {
    const auto told = planar::NumbersOf(impact, 0.0);
    return std::any_of(std::begin(told), std::end(told), [](double value) { return std::isinf(value); });
  }

  static bool IsRefused(const Problem& problem) {
    const Scene scene = {.system = PlanarContact{problem.w.tt, problem.w.tn, problem.w.nn, problem.u0, problem.v0}};
    const auto reduction = std::get<PlanarReduction>(Reduce(scene));
    return IsRefusedByName(Made([&](Outcome& made) { return planar::MakeOutcome(problem, reduction, 0.0, {}, made); }));
  }
};

// Points that are drawn from one seed.
struct Block {
  int sign_change;  // -1 means no particular sign change.
  int64_t points;
};

template <typename Model>
typename Model::Problem Draw(typename Model::Source& source, const Block& block) {
  if (block.sign_change >= 0) {
    return source.NearSignChange(static_cast<typename Model::Source::SignChange>(block.sign_change),
                                 source.NearlyOne());
  }
  return source.Below(Model::kOverAllDoubles) == 0 ? source.OverAllDoubles() : source.Any();
}

std::vector<Block> BlocksOf(int64_t points, int64_t near_each, int sign_changes) {
  std::vector<Block> blocks;
  const auto add = [&blocks](int sign_change, int64_t count) {
    for (; count > 0; count -= kPointsPerBlock) blocks.push_back({sign_change, std::min(count, kPointsPerBlock)});
  };
  for (int i = 0; i < sign_changes; ++i) add(i, near_each);
  add(-1, points - near_each * sign_changes);
  return blocks;
}

template <typename Model>
bool Audit(int64_t points, int64_t near_each) {
  const std::vector<Block> blocks = BlocksOf(points, near_each, Model::kSignChanges);
  ErrorTable<typename Model::Problem, Model::kOutputs> table;
  std::mutex table_mutex;
  std::atomic<size_t> next = 0;
  const auto work = [&] {
    ErrorTable<typename Model::Problem, Model::kOutputs> mine;
    for (size_t i = next++; i < blocks.size(); i = next++) {
      typename Model::Source source(i);
      for (int64_t k = 0; k < blocks[i].points; ++k) {
        const typename Model::Problem problem = Draw<Model>(source, blocks[i]);
        mine.Add(Model::Errors(problem), problem, static_cast<int64_t>(i) * kPointsPerBlock + k);
      }
    }
    flint_cleanup();
    const std::lock_guard lock(table_mutex);
    table.Merge(mine);
  };
  std::vector<std::thread> threads(std::max(1U, std::thread::hardware_concurrency()));
  for (std::thread& thread : threads) thread = std::thread(work);
  for (std::thread& thread : threads) thread.join();
  std::printf("%s: %lld points, of them %lld near each of %d sign changes\n%s\n", Model::kName,
              static_cast<long long>(table.points()), static_cast<long long>(near_each), Model::kSignChanges,
              table.Text(Model::Names()).c_str());
  bool kept = true;
  for (size_t i = 0; i < Model::kOutputs; ++i) kept = kept && table.Worst(i) <= kPromisedUlps;
  if (!kept) std::printf("FAILED: %s promises %g ulp\n", Model::kName, kPromisedUlps);
  return kept;
}

int Main(const std::vector<std::string>& arguments) {
  constexpr int64_t kLeastPoints = 1000;
  int64_t points = 0;
  if (arguments.size() != 1 || !absl::SimpleAtoi(arguments[0], &points) || points < kLeastPoints) {
    std::fprintf(stderr, "usage: ricochet_ulp POINTS, at least %lld\n", static_cast<long long>(kLeastPoints));
    return 2;
  }
  const int64_t near_each = points / 100;
  const bool pendulum = Audit<PendulumModel>(points / 2, near_each);
  const bool planar = Audit<PlanarModel>(points - points / 2, near_each);
  return pendulum && planar ? 0 : 1;
}

}  // namespace
}  // namespace ricochet

int main(int argc, char** argv) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  return ricochet::Main({argv + 1, argv + argc});
}
