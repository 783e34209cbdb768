// Measurements on a noisy machine: medians of several repeats, and ratios of two things timed in turn.

#ifndef RICOCHET_TESTS_BENCHMARK_MEASURE_H_
#define RICOCHET_TESTS_BENCHMARK_MEASURE_H_

#include <string>
#include <vector>

#include "absl/functional/function_ref.h"

namespace ricochet::bench {

// The middle value, or the lower one of both if their number is even. `values` must not be empty.
double Median(std::vector<double> values);

// Value at the quantile 0 <= q <= 1.
double Quantile(std::vector<double> values, double q);

// Seconds that `run` takes by the wall clock.
double Seconds(absl::FunctionRef<void()> run);

// The times of two things that run in turn, A B A B ..., after one round that is not counted.
struct Comparison {
  double seconds_a = 0.0;  // Medians.
  double seconds_b = 0.0;
  double ratio = 0.0;  // Median of the rounds' A/B.
};
Comparison Compare(int rounds, absl::FunctionRef<void()> a, absl::FunctionRef<void()> b);

// Prints a line of a report: the name, the value with its unit, and the comparison.
void Print(const std::string& what, const std::string& value, const std::string& note);

// Keeps the compiler from dropping the computation of `value`.
void DoNotOptimize(double value);

}  // namespace ricochet::bench

#endif  // RICOCHET_TESTS_BENCHMARK_MEASURE_H_
