#include "tests/benchmark/measure.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace ricochet::bench {
namespace {

volatile double sink = 0.0;

}  // namespace

double Quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(q * static_cast<double>(values.size() - 1))];
}

double Median(std::vector<double> values) { return Quantile(std::move(values), 0.5); }

double Seconds(absl::FunctionRef<void()> run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Comparison Compare(int rounds, absl::FunctionRef<void()> a, absl::FunctionRef<void()> b) {
  std::vector<double> seconds_a;
  std::vector<double> seconds_b;
  std::vector<double> ratios;
  for (int i = -1; i < rounds; ++i) {
    const double of_a = Seconds(a);
    const double of_b = Seconds(b);
    if (i < 0) continue;
    seconds_a.push_back(of_a);
    seconds_b.push_back(of_b);
    ratios.push_back(of_a / of_b);
  }
  return {Median(seconds_a), Median(seconds_b), Median(ratios)};
}

void Print(const std::string& what, const std::string& value, const std::string& note) {
  std::printf("  %-46s %16s   %s\n", what.c_str(), value.c_str(), note.c_str());
  std::fflush(stdout);
}

void DoNotOptimize(double value) { sink = value; }

}  // namespace ricochet::bench
