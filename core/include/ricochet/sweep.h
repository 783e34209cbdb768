// Sweep: a grid solved point by point, columns by name, answered in chunks.
//
// The structs mirror ricochet.v1.SweepRequest and SweepResponse.

#ifndef RICOCHET_SWEEP_H_
#define RICOCHET_SWEEP_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/demand.h"
#include "ricochet/engine_info.h"
#include "ricochet/grid.h"
#include "ricochet/outcome.h"

namespace ricochet {

// The result of one point of a sweep, or of one row of a batch. The numbers are those of ricochet.v1.RowStatus.
enum class RowStatus : uint8_t {
  kUnspecified = 0,
  kOk = 1,                // The row has all its numbers.
  kInadmissible = 2,      // The row has its numbers, but its outcome breaks a limit. One that is unset is quiet NaN.
  kInvalid = 3,           // The row breaks a rule of its scene, or needs an effect that the call excludes.
  kNotRepresentable = 4,  // A number asked for exceeds the largest double.
  kIncomplete = 5,        // The row has its numbers, but for those that its outcome leaves unset: they are quiet NaN.
  // The row has its numbers, but the termination of its outcome is not kConverged: the stated error,
  // accuracy.relative_error, exceeds the tolerance asked for, or the impact did not come to its end.
  kNotConverged = 6,
};
inline constexpr int kRowStatusCount = 7;

struct SweepRequest {
  Grid grid = {};
  // Paths into the outcome, at least one, no two equal, as `ricochet scene columns` lists them. Asking for a number is
  // asking for the effects that make it: "contact.duration_s" requires Effect::kFiniteDuration at every point.
  // "d(OF)/d(BY)" is Derivative::value of a number OF of the outcome by a number BY of the scene.
  std::vector<std::string> columns = {};
  bool with_regime = false;  // If true, every chunk has the regimes and the statuses of its points.
  // The request covers the points [first_index, end_index) of the grid; an absent end means all to the end. A point has
  // the same bits in every range.
  int64_t first_index = 0;
  std::optional<int64_t> end_index = {};
  DemandFields demand = {};  // Demand on every point; each point gets its own plan.
  friend bool operator==(const SweepRequest&, const SweepRequest&) = default;
};

// A Tally counts the points of one kind and has the grid index of the first.
struct Tally {
  int64_t count = 0;
  int64_t first_index = -1;  // -1 if count is 0.
  friend bool operator==(const Tally&, const Tally&) = default;
};

// Returns the tally of two sets of points that have none in common. The result wraps round if the counts overflow.
Tally Joined(const Tally& a, const Tally& b);

struct SweepSummary {
  int64_t points = 0;
  std::array<Tally, kRegimeCount> by_regime = {};  // Indexed by the number of the regime.
  std::array<Tally, kModelCount> by_model = {};    // Indexed by the number of the model; counts valid points only.
  Tally inadmissible;                              // Points whose outcome breaks a limit.
  Tally not_converged;                             // Points whose status is RowStatus::kNotConverged.
  std::optional<double> elapsed_s;                 // The server or the command line fills it in, not the core.
  friend bool operator==(const SweepSummary&, const SweepSummary&) = default;
};

// Returns the counts of two parts of a sweep that have no point in common, without their times.
SweepSummary Joined(const SweepSummary& a, const SweepSummary& b);

struct SweepChunk {
  int64_t first_index = 0;              // Grid index of the chunk's first point.
  int64_t count = 0;                    // Points in this chunk.
  std::vector<double> values;           // Column after column, `count` values each; quiet NaN for an invalid point.
  std::vector<Regime> regimes;          // One for each point if asked for, else empty.
  std::vector<RowStatus> statuses;      // One for each point if asked for, else empty.
  int64_t points_done = 0;              // Number of points computed so far, this chunk included.
  int64_t points_total = 0;             // Number of points of the range asked for.
  SweepSummary tallies;                 // Counts of the points computed so far, this chunk included; no time.
  std::optional<SweepSummary> summary;  // Present in the last chunk only: its tallies, and the time if it is known.
  EngineInfo engine;
  friend bool operator==(const SweepChunk&, const SweepChunk&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_SWEEP_H_
