// Problem: a request for a fit that has passed all checks.

#ifndef RICOCHET_CORE_FIT_PROBLEM_H_
#define RICOCHET_CORE_FIT_PROBLEM_H_

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "core/rows/checked_rows.h"
#include "ricochet/fit.h"

namespace ricochet::fit {

// A measured number.
struct Number {
  size_t row = 0;
  size_t column = 0;
  double value = 0.0;
  double sigma = 0.0;

  double Residual(double predicted) const { return (value - predicted) / sigma; }
};

struct Problem {
  CheckedBatch batch;  // Its fields are the unknowns and then the inputs, its columns the measured ones.
  size_t rows = 0;
  std::vector<std::vector<double>> inputs;  // A column for each input, with a value for each row.
  // The standard deviation of the error of each of these, 0 for none; an empty column for an input without errors.
  std::vector<std::vector<double>> input_sigmas;
  std::vector<std::pair<double, double>> input_ranges;  // In which each keeps its rule.
  std::vector<Number> numbers;                          // Row by row.
  std::vector<size_t> first_number;                     // That of each row, and behind the last row their count.
  // These have an entry for each unknown. Bounds may be infinite; a scale is > 0 and of the size of the unknown.
  std::vector<double> start, low, high, scale;
  std::vector<bool> is_angle;
  FitLoss loss = FitLoss::kSquares;
  double loss_scale = 1.0;
  int32_t starts = kFitStarts;
  int32_t max_iterations = kFitIterations;
  std::vector<size_t> region;   // The unknowns whose region is wanted: none or two.
  std::string why_differences;  // Why there are no exact derivatives; empty if there are.
  bool is_slow = false;         // An impact, or a row of several, may take milliseconds.

  size_t unknowns() const { return start.size(); }
  size_t columns() const { return batch.columns.size(); }
  bool has_uncertain_inputs() const { return uncertain_inputs() > 0; }
  size_t uncertain_inputs() const {
    return static_cast<size_t>(
        std::count_if(input_sigmas.begin(), input_sigmas.end(), [](const auto& column) { return !column.empty(); }));
  }
  // Counts the residuals of all numbers and, behind them, row by row, of uncertain inputs that cannot move.
  size_t residuals() const { return numbers.size() + rows * uncertain_inputs(); }
  std::vector<std::string> unknown_paths() const {
    return {batch.fields.begin(), batch.fields.begin() + static_cast<std::ptrdiff_t>(unknowns())};
  }
};

// Errors: INVALID_ARGUMENT with every violation.
absl::StatusOr<Problem> CheckFit(const FitRequest& request);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_PROBLEM_H_
