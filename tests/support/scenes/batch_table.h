// BatchTable: a batch with room for its answer, and the checks that every row has the bits of Solve and of a sweep.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_BATCH_TABLE_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_BATCH_TABLE_H_

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "absl/functional/function_ref.h"
#include "core/rows/column.h"
#include "ricochet/solver.h"

namespace ricochet {

struct BatchTable {
  // Adds a row: a number for each field of the setup.
  void Add(const std::vector<double>& row) {
    in.resize(row.size());
    for (size_t k = 0; k < in.size(); ++k) in[k].push_back(row[k]);
  }

  size_t size() const { return in[0].size(); }

  absl::StatusOr<BatchResponse> Solve() {
    out.assign(setup.columns.size(), std::vector<double>(size(), -7.0));
    regimes.resize(size());
    statuses.resize(size());
    BatchRows rows = {.regimes = absl::MakeSpan(regimes), .statuses = absl::MakeSpan(statuses)};
    for (const auto& column : in) rows.inputs.emplace_back(column);
    for (auto& column : out) rows.outputs.push_back(absl::MakeSpan(column));
    return LocalSolver().SolveBatch(setup, rows);
  }

  BatchSetup setup;
  std::vector<std::vector<double>> in, out;
  std::vector<Regime> regimes;
  std::vector<RowStatus> statuses;
};

// The rows that a scene of their own answers.
struct RowCounts {
  std::map<Model, int64_t> models;
  int64_t invalid = 0;
};

// Solves every row of a table that has been solved by its scene once more, and expects the same bits.
inline RowCounts ExpectBitsOfSolve(const BatchTable& table, absl::FunctionRef<Scene(size_t row)> scene_of) {
  const ColumnReader reader(table.setup.scene, table.setup.columns);
  std::vector<double> numbers;
  RowCounts counts;
  for (size_t i = 0; i < table.size(); ++i) {
    const auto solved = LocalSolver().Solve({.scene = scene_of(i), .demand = table.setup.demand});
    if (solved.status().code() == absl::StatusCode::kInvalidArgument) {
      ++counts.invalid;
      EXPECT_EQ(table.statuses[i], RowStatus::kInvalid) << i << solved.status();
      EXPECT_TRUE(std::isnan(table.out[0][i]));
      continue;
    }
    if (!solved.ok()) continue;  // A number that is not among the columns may exceed the largest double.
    ++counts.models[solved->outcome.plan.model];
    EXPECT_EQ(table.statuses[i], reader.Read(solved->outcome, numbers).status) << i;
    EXPECT_EQ(table.regimes[i], solved->outcome.regime) << i;
    for (size_t c = 0; c < table.out.size(); ++c) {
      const double number = numbers[c];
      EXPECT_EQ(std::bit_cast<uint64_t>(table.out[c][i]), std::bit_cast<uint64_t>(number))
          << table.setup.columns[c] << " of row " << i << ": " << table.out[c][i] << " and " << number;
    }
  }
  return counts;
}

// Expects the bits of a table that has been solved in a sweep whose axes are the columns of its inputs.
inline void ExpectBitsOfTheRowsInASweep(const BatchTable& table) {
  SweepRequest request = {.grid = {.scene = table.setup.scene, .combination = Combination::kZip},
                          .columns = table.setup.columns,
                          .demand = table.setup.demand};
  for (size_t k = 0; k < table.in.size(); ++k)
    request.grid.axes.push_back({table.setup.fields[k], ListValues{table.in[k]}});
  size_t first = 0;
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(request)) {
    ASSERT_TRUE(chunk.ok()) << chunk.status();
    const auto count = static_cast<size_t>(chunk->count);
    for (size_t c = 0; c < table.out.size(); ++c) {
      for (size_t i = 0; i < count; ++i) {
        ASSERT_EQ(std::bit_cast<uint64_t>(chunk->values[c * count + i]),
                  std::bit_cast<uint64_t>(table.out[c][first + i]))
            << table.setup.columns[c] << " of point " << first + i;
      }
    }
    first += count;
  }
  EXPECT_EQ(first, table.size());
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_BATCH_TABLE_H_
