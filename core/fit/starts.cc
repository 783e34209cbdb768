#include "core/fit/starts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/fit/search.h"
#include "core/numerics/elementary.h"

namespace ricochet::fit {
namespace {

// A slow model is looked at in this many times fewer places, of which at most kMostSlow are returned.
constexpr int kFewer = 16;
constexpr size_t kMostSlow = 2;
// Places are solved in groups that have at most this many rows together, or in groups of one.
constexpr size_t kRowsAtOnce = size_t{1} << 18;
// Places whose objectives differ by at most this part fit alike.
constexpr double kAlike = 1e-9;

// The root of ratio^(unknowns + 1) = 1 + ratio: the golden ratio for one unknown.
double GoldenRatio(size_t unknowns) {
  double ratio = 2.0;
  for (int i = 0; i < 40; ++i) ratio = Pow(1.0 + ratio, 1.0 / (static_cast<double>(unknowns) + 1.0));
  return ratio;
}

// Fractional parts of multiples of the powers of 1 / `ratio`, one for each unknown: the points of all numbers fill the
// cube evenly, and number 0 is its centre.
std::vector<double> PartsOf(int number, size_t unknowns, double ratio) {
  std::vector<double> parts(unknowns);
  double step = 1.0;
  for (double& part : parts) {
    step /= ratio;
    const double place = 0.5 + number * step;
    part = place - std::floor(place);
  }
  return parts;
}

bool HasBounds(const Problem& problem, size_t k) { return std::isfinite(problem.high[k] - problem.low[k]); }

// Returns the place that lies `part`, from -1 to 1, of the way from the centre to the end of its range.
double Beside(const Problem& problem, double centre, double part, size_t k) {
  const double low = problem.low[k], high = problem.high[k];
  if (HasBounds(problem, k)) return std::clamp(centre + part * (part < 0.0 ? centre - low : high - centre), low, high);
  const double place = centre != 0.0 ? centre * Exp(4.0 * part * std::numbers::ln2) : 4.0 * part * problem.scale[k];
  return std::clamp(place, low, high);
}

}  // namespace

std::vector<double> StartOf(const Problem& problem, int number) {
  std::vector<double> start = problem.start;
  if (number == 0) return start;
  const std::vector<double> parts = PartsOf(number, start.size(), GoldenRatio(start.size()));
  for (size_t k = 0; k < start.size(); ++k) {
    const double low = problem.low[k], high = problem.high[k];
    if (HasBounds(problem, k)) {
      start[k] = low + parts[k] * (high - low);
    } else {
      const double spread = 2.0 * parts[k] - 1.0;
      start[k] = std::clamp(start[k] != 0.0 ? start[k] * Exp(2.0 * spread * std::numbers::ln2) : spread, low, high);
    }
  }
  return start;
}

std::vector<std::vector<double>> BestPlaces(const std::vector<double>& centre, const std::vector<bool>& is_free,
                                            int count, size_t most, Model& model) {
  const Problem& problem = model.problem();
  if (problem.is_slow) {
    count /= kFewer;
    most = std::min(most, kMostSlow);
  }
  const double ratio = GoldenRatio(centre.size());
  std::vector<std::vector<double>> places;
  for (int number = 1; number <= count; ++number) {
    std::vector<double>& place = places.emplace_back(centre);
    const std::vector<double> parts = PartsOf(number, centre.size(), ratio);
    for (size_t k = 0; k < place.size(); ++k) {
      const double side = 2.0 * parts[k] - 1.0;
      if (is_free[k]) place[k] = Beside(problem, centre[k], number % 2 == 0 ? side : side * side * side, k);
    }
  }
  std::vector<double> objectives;
  const size_t at_once = std::max<size_t>(1, kRowsAtOnce / problem.rows);
  for (size_t first = 0; first < places.size(); first += at_once) {
    const auto begin = places.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(std::min(at_once, places.size() - first));
    const std::vector<double> of_these = ObjectivesAt({begin, end}, model);
    objectives.insert(objectives.end(), of_these.begin(), of_these.end());
  }
  std::vector<size_t> order(places.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return objectives[a] < objectives[b]; });
  std::vector<std::vector<double>> best;
  double last = -std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < order.size() && best.size() < most; ++i) {
    const double objective = objectives[order[i]];
    if (!std::isfinite(objective)) break;
    // If unknowns change nothing, many places fit alike, and one of them is enough.
    if (objective - last <= kAlike * std::fabs(objective)) continue;
    last = objective;
    best.push_back(places[order[i]]);
  }
  return best;
}

}  // namespace ricochet::fit
