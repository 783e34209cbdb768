// ErrorTable: the largest error and the 99.9th percentile of each output, with the input that was worst.

#ifndef RICOCHET_TESTS_ULP_ERROR_TABLE_H_
#define RICOCHET_TESTS_ULP_ERROR_TABLE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"

namespace ricochet {

template <typename Problem, size_t kOutputs>
class ErrorTable {
 public:
  // Errors of one point in ulp. `order` is the point's, so that merged tables do not depend on which was filled first.
  void Add(const std::array<double, kOutputs>& errors, const Problem& problem, int64_t order) {
    for (size_t i = 0; i < kOutputs; ++i) {
      ++counts_[i][BinOf(errors[i])];
      RaiseWorst(i, {errors[i], problem, order});
    }
    ++points_;
  }

  void Merge(const ErrorTable& other) {
    for (size_t i = 0; i < kOutputs; ++i) {
      for (size_t bin = 0; bin < kBins; ++bin) counts_[i][bin] += other.counts_[i][bin];
      RaiseWorst(i, other.worst_[i]);
    }
    points_ += other.points_;
  }

  int64_t points() const { return points_; }
  double Worst(size_t output) const { return worst_[output].error; }
  const Problem& WorstInput(size_t output) const { return worst_[output].problem; }

  // The result is not below the percentile, and above it by less than 2^-12 ulp if the percentile is below 2 ulp.
  double Percentile999(size_t output) const {
    const int64_t needed = points_ - points_ / 1000;
    int64_t seen = 0;
    for (size_t bin = 0; bin + 1 < kBins; ++bin) {
      seen += counts_[output][bin];
      if (seen >= needed) return static_cast<double>(bin + 1) / kBinsPerUlp;
    }
    return Worst(output);
  }

  std::string Text(const std::array<const char*, kOutputs>& names) const {
    std::string text = absl::StrFormat("  %-20s %10s %10s   %s\n", "output", "max ulp", "p99.9 ulp", "worst input");
    for (size_t i = 0; i < kOutputs; ++i) {
      text += absl::StrFormat("  %-20s %10.6f %10.4f   %s\n", names[i], Worst(i), Percentile999(i),
                              ToString(WorstInput(i)));
    }
    return text;
  }

 private:
  static constexpr int kBinsPerUlp = 4096;
  static constexpr size_t kBins = 2 * kBinsPerUlp + 1;  // The last bin holds all larger errors.

  struct Extreme {
    double error = -1.0;
    Problem problem;
    int64_t order = 0;
  };

  static size_t BinOf(double error) { return error < 2.0 ? static_cast<size_t>(error * kBinsPerUlp) : kBins - 1; }

  void RaiseWorst(size_t output, const Extreme& found) {
    Extreme& worst = worst_[output];
    if (found.error > worst.error || (found.error == worst.error && found.order < worst.order)) worst = found;
  }

  std::vector<std::array<int64_t, kBins>> counts_ = std::vector<std::array<int64_t, kBins>>(kOutputs);
  std::array<Extreme, kOutputs> worst_;
  int64_t points_ = 0;
};

}  // namespace ricochet

#endif  // RICOCHET_TESTS_ULP_ERROR_TABLE_H_
