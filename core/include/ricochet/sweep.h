// Sweep: a grid solved point by point, columns by name, answered in chunks.
//
// Mirrors ricochet.v1.SweepRequest and SweepResponse.

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

struct SweepRequest {
  Grid grid;
  std::vector<std::string>
      columns;               // Paths into the outcome, core/sweep/column.h lists them. At least one, no doubles.
  bool with_regime = false;  // Send every point's regime too.
  int64_t first_index = 0;   // Points [first_index, end_index) of the grid, with the same bits as in
  std::optional<int64_t> end_index;  // the whole; absent means all to the end.
  DemandFields demand;               // Of every point: each gets its own plan.
  friend bool operator==(const SweepRequest&, const SweepRequest&) = default;
};

// How many points of a kind there were and the grid index of the first.
struct Tally {
  int64_t count = 0;
  int64_t first_index = -1;  // -1 where count is 0.
  friend bool operator==(const Tally&, const Tally&) = default;
};

struct SweepSummary {
  int64_t points = 0;
  std::array<Tally, kRegimeCount> by_regime = {};  // By the number of the regime.
  std::array<Tally, kModelCount> by_model = {};    // By the number of the model; points that are valid.
  Tally inadmissible;                              // Points whose outcome breaks a limit.
  std::optional<double> elapsed_s;                 // Filled in by the server or the command line, not by the core.
  friend bool operator==(const SweepSummary&, const SweepSummary&) = default;
};

struct SweepChunk {
  int64_t first_index = 0;              // Grid index of the chunk's first point.
  int64_t count = 0;                    // Points in this chunk.
  std::vector<double> values;           // Column after column, `count` values each; quiet NaN for an INVALID point.
  std::vector<Regime> regimes;          // One a point if asked for, else empty.
  int64_t points_done = 0;              // Progress, this chunk included,
  int64_t points_total = 0;             // of the range asked for.
  std::optional<SweepSummary> summary;  // In the last chunk only.
  EngineInfo engine;
  friend bool operator==(const SweepChunk&, const SweepChunk&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_SWEEP_H_
