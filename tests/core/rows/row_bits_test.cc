// Every column of every kind of scene has the same bits, status and regime by Solve, in a batch and in a sweep.
//
// Each row states all numbers of its scene. Some rows break a rule or hold a number of an extreme size.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/rows/column.h"
#include "core/rows/scene_lanes.h"
#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/drivable_numbers.h"
#include "tests/support/scenes/random_scenes.h"

namespace ricochet {
namespace {

// More than one block of SIMD lanes, and a part of one.
constexpr size_t kRows = 300;
// Rows of scenes whose impacts are integrated over time.
constexpr size_t kSlowRows = 6;

std::vector<std::string> NumberPaths(const Scene& scene) {
  std::vector<std::string> paths;
  VisitNumbers(scene,
               [&](const NumberPath& path, double /*number*/, NumberRule /*rule*/) { paths.push_back(path.Text()); });
  return paths;
}

// The numbers that can be driven alone.
std::vector<std::string> DrivablePaths(const Scene& scene) {
  std::vector<std::string> paths;
  VisitDrivableNumbers(scene, [&](std::string path, double /*number*/) { paths.push_back(std::move(path)); });
  return paths;
}

std::vector<double*> NumbersOf(Scene& scene) {
  std::vector<double*> numbers;
  VisitNumbers(scene,
               [&](const NumberPath& /*path*/, double& number, NumberRule /*rule*/) { numbers.push_back(&number); });
  return numbers;
}

// Scenes of one kind, and the columns that their numbers are.
struct Rows {
  std::vector<Scene> scenes;
  std::vector<std::string> fields;
  std::vector<std::vector<double>> in;
};

Rows RowsOf(const SceneKind& kind, size_t count, uint64_t seed) {
  constexpr double kOdd[] = {0.0, -0.0, -1.0, 1e-320, 1e-200, 1e-20, 1e160, 1e308};
  RandomScenes random(seed);
  Rows rows;
  for (size_t i = 0; i < count; ++i) {
    Scene scene = kind.make(random);
    const std::vector<double*> numbers = NumbersOf(scene);
    if (i == 0) rows.fields = NumberPaths(scene);
    const auto below = [&](size_t bound) {
      return static_cast<size_t>(random.Uniform(0.0, 1.0) * static_cast<double>(bound));
    };
    if (i % 9 == 8) {
      const std::vector<std::string> paths = DrivablePaths(scene);
      ResolveField(paths[below(paths.size())], scene)->Set(kOdd[below(std::size(kOdd))]);
    }
    rows.in.resize(numbers.size());
    for (size_t k = 0; k < numbers.size(); ++k) rows.in[k].push_back(*numbers[k]);
    rows.scenes.push_back(std::move(scene));
  }
  return rows;
}

// Fixes the fields that no driver may drive, or that go along with another one.
void KeepFields(Rows& rows) {
  const std::vector<std::string> drivable = DrivablePaths(rows.scenes[0]);
  for (size_t k = rows.fields.size(); k-- > 0;) {
    if (std::find(drivable.begin(), drivable.end(), rows.fields[k]) != drivable.end()) continue;
    rows.fields.erase(rows.fields.begin() + static_cast<ptrdiff_t>(k));
    rows.in.erase(rows.in.begin() + static_cast<ptrdiff_t>(k));
  }
}

struct Bits {
  std::vector<std::vector<uint64_t>> numbers;  // Each row has a list.
  std::vector<Regime> regimes;
  std::vector<RowStatus> statuses;
  friend bool operator==(const Bits&, const Bits&) = default;
};

// Puts row after row what stands column after column.
void Put(const std::vector<std::vector<double>>& columns, Bits& bits) {
  for (size_t i = 0; i < bits.statuses.size(); ++i) {
    std::vector<uint64_t>& row = bits.numbers.emplace_back();
    for (const auto& column : columns) row.push_back(std::bit_cast<uint64_t>(column[i]));
  }
}

// Expects what Solve gives for the scene of each row.
void ExpectBitsOfSolve(const Rows& rows, const std::vector<std::string>& columns, const DemandFields& demand,
                       const Bits& bits) {
  const ColumnReader reader(rows.scenes[0], columns);
  std::vector<double> numbers;
  size_t wrong = 0;
  for (size_t i = 0; i < rows.scenes.size(); ++i) {
    const auto solved = LocalSolver().Solve(
        {.scene = rows.scenes[i], .demand = demand, .both_ends = HoldsCoordinates(rows.scenes[i].system)});
    if (solved.status().code() == absl::StatusCode::kInvalidArgument) {
      wrong += bits.statuses[i] != RowStatus::kInvalid ? 1u : 0u;
    }
    // A number that is not among the columns may exceed the largest double.
    if (!solved.ok()) continue;
    bool is_same = bits.statuses[i] == reader.Read(solved->outcome, numbers).status;
    if (bits.statuses[i] != RowStatus::kNotRepresentable) {
      is_same = is_same && bits.regimes[i] == solved->outcome.regime;
      for (size_t c = 0; c < columns.size(); ++c) {
        is_same = is_same && bits.numbers[i][c] == std::bit_cast<uint64_t>(numbers[c]);
      }
    }
    wrong += is_same ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0);
}

Bits ByBatch(const Rows& rows, const std::vector<std::string>& columns, const DemandFields& demand,
             SweepSummary& counts) {
  Bits bits;
  bits.regimes.resize(rows.scenes.size());
  bits.statuses.resize(rows.scenes.size());
  std::vector<std::vector<double>> out(columns.size(), std::vector<double>(rows.scenes.size()));
  BatchRows places = {.regimes = absl::MakeSpan(bits.regimes), .statuses = absl::MakeSpan(bits.statuses)};
  for (const auto& column : rows.in) places.inputs.emplace_back(column);
  for (auto& column : out) places.outputs.push_back(absl::MakeSpan(column));
  const auto response = LocalSolver().SolveBatch(
      {.scene = rows.scenes[0], .fields = rows.fields, .columns = columns, .demand = demand}, places);
  EXPECT_TRUE(response.ok()) << response.status();
  if (!response.ok()) return bits;
  Put(out, bits);
  counts = response->summary.counts;
  return bits;
}

Bits BySweep(const Rows& rows, const std::vector<std::string>& columns, const DemandFields& demand,
             SweepSummary& counts) {
  SweepRequest request = {.grid = {.scene = rows.scenes[0], .combination = Combination::kZip},
                          .columns = columns,
                          .with_regime = true,
                          .demand = demand};
  for (size_t k = 0; k < rows.fields.size(); ++k) request.grid.axes.push_back({rows.fields[k], ListValues{rows.in[k]}});
  Bits bits;
  std::vector<std::vector<double>> out(columns.size());
  for (const auto& chunk : LocalSolver().Sweep(request)) {
    EXPECT_TRUE(chunk.ok()) << chunk.status();
    if (!chunk.ok()) return bits;
    const auto count = static_cast<size_t>(chunk->count);
    for (size_t c = 0; c < columns.size(); ++c) {
      const auto from = chunk->values.begin() + static_cast<ptrdiff_t>(c * count);
      out[c].insert(out[c].end(), from, from + static_cast<ptrdiff_t>(count));
    }
    bits.regimes.insert(bits.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
    bits.statuses.insert(bits.statuses.end(), chunk->statuses.begin(), chunk->statuses.end());
    counts = chunk->tallies;
  }
  Put(out, bits);
  return bits;
}

// The columns that SIMD lanes give; none if they give none.
std::vector<std::string> LaneColumns(const Scene& scene, const std::vector<std::string>& columns) {
  std::vector<std::string> in_lanes;
  for (const std::string& column : columns) {
    if (SceneLanes::Make(scene, {column}, {}) != nullptr) in_lanes.push_back(column);
  }
  return in_lanes;
}

void ExpectSameBits(const SceneKind& kind) {
  Rows rows = RowsOf(kind, kind.takes_time ? kSlowRows : kRows, 1);
  KeepFields(rows);
  std::vector<std::string> all = Columns(rows.scenes[0]);
  // To ask for a number of the contact is to ask for its duration, which the demands below do not name.
  std::erase_if(all, [](const std::string& path) { return path.starts_with("contact."); });
  const std::vector<std::string> in_lanes = LaneColumns(rows.scenes[0], all);
  for (const auto& columns : {all, in_lanes}) {
    if (columns.empty()) continue;
    for (const double tolerance : {0.0, 1e-6, 0.1}) {
      const DemandFields demand = {.relative_tolerance = tolerance};
      SweepSummary batch_counts, sweep_counts;
      const Bits by_batch = ByBatch(rows, columns, demand, batch_counts);
      SCOPED_TRACE(absl::StrCat(kind.name, " within ", tolerance, ", ", columns.size(), " columns"));
      ExpectBitsOfSolve(rows, columns, demand, by_batch);
      EXPECT_TRUE(BySweep(rows, columns, demand, sweep_counts) == by_batch);
      EXPECT_TRUE(batch_counts == sweep_counts);
    }
  }
}

TEST(RowBitsTest, AreThoseOfSolveInBatchesAndSweeps) {
  for (const RandomSystem& system : RandomSystems()) {
    for (const SceneKind& kind : SceneKinds(system)) ExpectSameBits(kind);
  }
}

}  // namespace
}  // namespace ricochet
