#include "core/cost/stopwatch.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace ricochet {
namespace {

// Some hundred times what reading the clock takes.
constexpr double kLeastSampleS = 20e-6;

// The quantile of sorted samples, between the two nearest ones.
double Quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(place);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  const double part = place - static_cast<double>(below);
  return sorted[below] + part * (sorted[above] - sorted[below]);
}

// Adds the quartiles of `samples`, times `scale`.
void AddQuartiles(std::vector<double> samples, double scale, CostTime& time) {
  std::sort(samples.begin(), samples.end());
  time.median_s += scale * Quantile(samples, 0.5);
  time.lower_quartile_s += scale * Quantile(samples, 0.25);
  time.upper_quartile_s += scale * Quantile(samples, 0.75);
}

// Calls `take()` for each sample until it fails, and gives the number of samples; none if it failed.
std::optional<int32_t> Sample(absl::FunctionRef<bool()> take, const Sampling& sampling) {
  const Stopwatch total;
  int32_t taken = 0;
  do {
    if (!take()) return std::nullopt;
    ++taken;
  } while (taken < sampling.samples && total.elapsed_s() < sampling.budget_s);
  return taken;
}

}  // namespace

double Stopwatch::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::optional<CostTime> TimeOf(absl::FunctionRef<void(int64_t)> work, const Sampling& sampling,
                               absl::FunctionRef<bool()> stopped) {
  Stopwatch watch;
  const auto time = [&](int64_t units) {
    watch.Restart();
    work(units);
    return watch.elapsed_s();
  };
  int64_t units = 1;
  while (time(units) < kLeastSampleS) {
    if (stopped()) return std::nullopt;
    units *= 2;
  }
  std::vector<double> samples;
  const auto take = [&] {
    if (stopped()) return false;
    samples.push_back(time(units));
    return true;
  };
  const std::optional<int32_t> taken = Sample(take, sampling);
  if (!taken.has_value()) return std::nullopt;
  CostTime result = {.samples = *taken, .per_sample = units};
  AddQuartiles(std::move(samples), 1.0 / static_cast<double>(units), result);
  return result;
}

std::optional<CostTime> TimeOfList(absl::FunctionRef<void(int64_t, int64_t)> work, int64_t size, int64_t part,
                                   const Sampling& sampling, absl::FunctionRef<bool()> stopped) {
  Stopwatch watch;
  std::vector<std::vector<double>> parts(static_cast<size_t>((size + part - 1) / part));
  const auto take = [&] {
    int64_t first = 0;
    for (std::vector<double>& samples : parts) {
      if (stopped()) return false;
      watch.Restart();
      work(first, std::min(part, size - first));
      samples.push_back(watch.elapsed_s());
      first += part;
    }
    return true;
  };
  if (!take()) return std::nullopt;
  for (std::vector<double>& samples : parts) samples.clear();  // This pass only warmed the caches.
  const std::optional<int32_t> taken = Sample(take, sampling);
  if (!taken.has_value()) return std::nullopt;
  CostTime result = {.samples = *taken, .per_sample = size};
  for (std::vector<double>& samples : parts) AddQuartiles(std::move(samples), 1.0 / static_cast<double>(size), result);
  return result;
}

}  // namespace ricochet
