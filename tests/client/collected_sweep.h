// CollectedSweep: all that a sweep of one column answers, so that two sweeps can be compared.

#ifndef RICOCHET_TESTS_CLIENT_COLLECTED_SWEEP_H_
#define RICOCHET_TESTS_CLIENT_COLLECTED_SWEEP_H_

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ricochet/solver.h"

namespace ricochet {

// A sweep over points of several regimes, some of them invalid.
inline SweepRequest MixedSweep(int64_t points) {
  SweepRequest request;
  request.grid.scene.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  request.grid.scene.restitution = EnergeticCoefficient{1.0};
  request.grid.axes = {{"friction.kinetic_coefficient", Linspace{-0.1, 0.4, points}}};
  request.columns = {"coefficients.newton"};
  request.with_regime = true;
  return request;
}

// The time is left out. A comparison that fails would print megabytes, so compare by EXPECT_TRUE(a == b).
struct CollectedSweep {
  std::string values;  // Their bytes.
  std::vector<Regime> regimes;
  SweepSummary summary;
  absl::Status end;
  friend bool operator==(const CollectedSweep&, const CollectedSweep&) = default;
};

// Adds a chunk or an error, and checks that the counts of the chunk are those of all points so far.
inline void AddTo(CollectedSweep& sweep, const absl::StatusOr<SweepChunk>& chunk) {
  sweep.end = chunk.status();
  if (!chunk.ok()) return;
  EXPECT_EQ(chunk->points_done, static_cast<int64_t>(sweep.regimes.size()) + chunk->count);
  EXPECT_EQ(chunk->tallies.points, chunk->points_done);
  EXPECT_EQ(chunk->summary.has_value(), chunk->points_done == chunk->points_total);
  sweep.values.append(reinterpret_cast<const char*>(chunk->values.data()), chunk->values.size() * sizeof(double));
  sweep.regimes.insert(sweep.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
  if (chunk->summary.has_value()) sweep.summary = Joined(*chunk->summary, {});
}

// Reads a sweep to its end. `before_chunk` is told the number of each chunk, from 0 on.
inline CollectedSweep Collect(
    SweepStream stream, const std::function<void(int)>& before_chunk = [](int /*number*/) {}) {
  CollectedSweep sweep;
  int number = 0;
  for (const absl::StatusOr<SweepChunk>& chunk : stream) {
    if (chunk.ok()) before_chunk(number++);
    AddTo(sweep, chunk);
  }
  return sweep;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_CLIENT_COLLECTED_SWEEP_H_
