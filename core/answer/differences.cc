#include "core/answer/differences.h"

#include <array>
#include <cmath>
#include <limits>

#include "core/answer/derivative_sides.h"
#include "core/answer/scene_line.h"

namespace ricochet {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr int kNeighbours = 6;                    // On each side.
constexpr std::array<size_t, 2> kSides = {0, 1};  // Below, above.
// A scene at this distance, relative to the size of the number, tells the course and whether the outcome jumps.
constexpr double kBeside = 0x1p-44;
constexpr double kJump = 0x1p-24;
// The claimed error is this many times the estimate, because the least of many estimates may be small by chance.
constexpr double kMargin = 16.0;
// A derivative with an error above this part of it is not known.
constexpr double kVague = 0.1;
// Two estimates that differ by this many errors contradict each other.
constexpr double kContradiction = 4.0;
// The steps over the size of the number, as negative powers of two.
constexpr int kFirstStep = 4;
constexpr int kLastStep = 30;

// --- Formulas ---

struct Estimate {
  double rate = 0.0;
  double error = kUnknown;
  bool is_cut_off = false;  // Most of the error is cut off by the formula: a shorter step may be better.
};

// The weights of the values in 1 ... count steps for the derivative at 0, in which a constant has no part.
std::array<double, kNeighbours> OneSidedWeights(int count) {
  std::array<double, kNeighbours> weights = {};
  double binomial = 1.0;
  for (int j = 1; j <= count; ++j) {
    binomial *= static_cast<double>(count - j + 1) / j;
    weights[static_cast<size_t>(j - 1)] = (j % 2 == 1 ? binomial : -binomial) / j;
  }
  return weights;
}

// The weights of half the differences between both sides.
std::array<double, kNeighbours> CentralWeights(int count) {
  std::array<double, kNeighbours> weights = {};
  double ratio = 1.0;  // (count!)^2 / ((count - j)! (count + j)!)
  for (int j = 1; j <= count; ++j) {
    ratio *= static_cast<double>(count - j + 1) / (count + j);
    weights[static_cast<size_t>(j - 1)] = (j % 2 == 1 ? 2.0 : -2.0) * ratio / j;
  }
  return weights;
}

// The weights for all neighbours, for all but the farthest, and for all but the two farthest.
using Weights = std::array<std::array<double, kNeighbours>, 3>;

Weights WeightsBy(std::array<double, kNeighbours> (*weights)(int count)) {
  return {weights(kNeighbours), weights(kNeighbours - 1), weights(kNeighbours - 2)};
}

// `unit` is the size of the number that changes, `noise` the error of each outcome.
Estimate EstimateOf(const std::array<double, kNeighbours>& changes, const Weights& weights, double noise, double step,
                    double unit) {
  std::array<double, 3> sum = {};
  double rounding = 0.0;
  for (size_t j = 0; j < changes.size(); ++j) {
    for (size_t k = 0; k < sum.size(); ++k) sum[k] += weights[k][j] * changes[j];
    rounding += 2.0 * noise * std::fabs(weights[0][j]);
  }
  // The place of a neighbour is rounded, too.
  rounding += 0x1p-51 * unit * std::fabs(sum[0] / step);
  const double cut_off = std::fabs(sum[0] - sum[1]) + std::fabs(sum[1] - sum[2]);
  return {.rate = sum[0] / step, .error = (cut_off + rounding) / std::fabs(step), .is_cut_off = cut_off > rounding};
}

bool IsBetter(const Estimate& next, const Estimate& best) {
  return next.error < best.error && std::isfinite(next.rate);
}

// True if an estimate over a shorter step contradicts the one so far, which then has stepped over a bend.
bool Contradicts(const Estimate& shorter, const Estimate& best) {
  return std::fabs(shorter.rate - best.rate) > kContradiction * (best.error + shorter.error) &&
         std::isfinite(shorter.rate);
}

bool Agree(const Estimate& x, const Estimate& y, double errors) {
  const double rounding = 0x1p-40 * (std::fabs(x.rate) + std::fabs(y.rate));
  return std::isfinite(x.error + y.error) && std::fabs(x.rate - y.rate) <= errors * (x.error + y.error) + rounding;
}

const Estimate& BetterOf(const Estimate& x, const Estimate& y) { return IsBetter(x, y) ? x : y; }

// --- Both sides of a number ---

// The derivative of a number that does not exist, as where an impact has no end.
constexpr OneSided kNoNumber = {.why_none = "there is no such number"};

class Sides {
 public:
  Sides(const SampleSource& source, SceneLine& line, size_t count)
      : source_(source),
        line_(line),
        one_sided_{std::vector<Estimate>(count), std::vector<Estimate>(count)},
        central_(count),
        steps_(count) {}

  // Returns false once the source is stopped.
  bool Explore() {
    for (const size_t side : kSides) {
      if (!line_.At(source_, Sign(side) * kBeside * line_.unit(), beside_[side])) return false;
    }
    bool goes_on = true;
    for (int k = kFirstStep; k <= kLastStep && goes_on; k += 2) {
      const double step = std::ldexp(line_.unit(), -k);
      std::array<bool, 2> is_one_course = {};
      for (const size_t side : kSides) {
        if (!SetNeighbours(side, step, is_one_course[side])) return false;
      }
      goes_on = Refine(step, is_one_course);
    }
    return true;
  }

  Derivative At(size_t i) const {
    const OneSided below = LimitOf(0, i), above = LimitOf(1, i);
    const bool have_both = below.rate.has_value() && above.rate.has_value();
    const std::optional<Estimate> common = have_both ? CommonOf(i) : std::nullopt;
    Derivative derivative = Join(below, above, common.has_value(), ThresholdHere());
    if (common.has_value()) {
      derivative.value = derivative.from_below = derivative.from_above = common->rate + 0.0;
      derivative.error = kMargin * common->error;
    } else if (derivative.kind == DerivativeKind::kOneSided) {
      derivative.error = kMargin * std::max(below.error.value_or(0.0), above.error.value_or(0.0));
    }
    return derivative;
  }

 private:
  static double Sign(size_t side) { return side == 0 ? -1.0 : 1.0; }

  // True if no threshold is at the number itself, as far as courses tell: both sides have one derivative then.
  bool IsInside() const {
    const auto is_here = [this](const auto& beside) { return beside && beside->course == source_.here().course; };
    return std::all_of(beside_.begin(), beside_.end(), is_here);
  }

  // True if the estimate is exact enough to be an answer.
  bool Tells(const Estimate& estimate, size_t i) const {
    constexpr double kNegligible = 1e-4;
    const double negligible = kNegligible * source_.scale(i) / line_.unit();
    // A number that no neighbour changes is constant, however large its error is.
    const bool stays = estimate.rate == 0.0 && std::isfinite(estimate.error);
    return estimate.error <= std::max(kVague * std::fabs(estimate.rate), negligible) || stays;
  }

  // A threshold may be so near that no useful step fits before it. The estimate of the other side then serves for both
  // sides.
  const Estimate& EstimateOn(size_t side, size_t i) const {
    const Estimate &own = one_sided_[side][i], &other = one_sided_[1 - side][i];
    return IsInside() && !Tells(own, i) && Tells(other, i) ? other : own;
  }

  // The derivative on both sides, unless each has its own.
  std::optional<Estimate> CommonOf(size_t i) const {
    const Estimate &below = EstimateOn(0, i), &above = EstimateOn(1, i);
    if (Agree(below, above, kContradiction)) return BetterOf(central_[i], BetterOf(below, above));
    // One of the two estimates may come from steps over a bend that the course does not show.
    Estimate best;
    for (const auto& [x, y] : steps_[i]) {
      if (Tells(x, i) && Tells(y, i) && Agree(x, y, kContradiction)) best = BetterOf(best, x.error > y.error ? x : y);
    }
    if (std::isfinite(best.error)) return best;
    if (!Agree(below, above, kMargin)) return std::nullopt;
    best = BetterOf(below, above);
    best.error = std::max(best.error, std::fabs(below.rate - above.rate) / kMargin);
    return kMargin * best.error <= kVague * std::fabs(best.rate) ? std::optional<Estimate>(best) : std::nullopt;
  }

  // `is_one_course` says that all neighbours follow the course beside the scene.
  bool SetNeighbours(size_t side, double step, bool& is_one_course) {
    is_one_course = beside_[side].has_value();
    for (size_t j = 0; j < kNeighbours && is_one_course; ++j) {
      std::optional<Sample>& sample = neighbours_[side][j];
      if (!line_.At(source_, Sign(side) * static_cast<double>(j + 1) * step, sample)) return false;
      is_one_course = sample.has_value() && sample->course == beside_[side]->course;
    }
    return true;
  }

  // Returns false once every side that exists has an estimate, this step has made none better, and shorter ones cannot.
  bool Refine(double step, const std::array<bool, 2>& is_one_course) {
    static const Weights one_sided = WeightsBy(OneSidedWeights);
    static const Weights central = WeightsBy(CentralWeights);
    const Sample& here = source_.here();
    const bool is_smooth = is_one_course[0] && is_one_course[1] && IsInside();
    bool goes_on = false;
    const auto improve = [&goes_on](Estimate& best, const Estimate& next) {
      const bool replaces = IsBetter(next, best) || Contradicts(next, best);
      if (replaces) best = next;
      goes_on |= replaces || next.is_cut_off;
    };
    for (size_t i = 0; i < central_.size(); ++i) {
      std::array<double, kNeighbours> changes;
      std::array<Estimate, 2> pair;
      for (const size_t side : kSides) {
        if (!is_one_course[side]) continue;
        for (size_t j = 0; j < kNeighbours; ++j) changes[j] = neighbours_[side][j]->value[i] - here.value[i];
        const Estimate next = EstimateOf(changes, one_sided, Noise(side, i), Sign(side) * step, line_.unit());
        improve(one_sided_[side][i], next);
        has_neighbours_[side] = true;
        pair[side] = next;
      }
      if (!is_smooth) continue;
      steps_[i].push_back(pair);
      goes_on |= !Agree(one_sided_[0][i], one_sided_[1][i], kContradiction);
      for (size_t j = 0; j < kNeighbours; ++j) {
        changes[j] = 0.5 * (neighbours_[1][j]->value[i] - neighbours_[0][j]->value[i]);
      }
      improve(central_[i], EstimateOf(changes, central, std::max(Noise(0, i), Noise(1, i)), step, line_.unit()));
    }
    const bool waits = (beside_[0].has_value() && !is_one_course[0]) || (beside_[1].has_value() && !is_one_course[1]);
    return goes_on || waits;
  }

  double Noise(size_t side, size_t i) const {
    double error = source_.here().error[i];
    for (const std::optional<Sample>& sample : neighbours_[side]) error = std::max(error, sample->error[i]);
    return error;
  }

  OneSided LimitOf(size_t side, size_t i) const {
    if (!beside_[side].has_value()) return {.why_none = "the scene would break a rule"};
    const double here = source_.here().value[i], beside = beside_[side]->value[i];
    if (std::isnan(here) || std::isnan(beside)) return kNoNumber;
    const Estimate& estimate = EstimateOn(side, i);
    const double change = std::fabs(beside - here);
    // A number that is 0 here may change by more than its size, at the rate of its neighbours.
    const bool goes_on = change <= 2.0 * (std::fabs(estimate.rate) + estimate.error) * kBeside * line_.unit() &&
                         std::isfinite(estimate.error);
    if (change > kJump * std::max(std::fabs(beside), source_.scale(i)) && !goes_on) {
      return {.why_none = "the number jumps"};
    }
    if (!std::isfinite(estimate.error) && !has_neighbours_[side]) {
      return {.why_none = "a threshold lies too near to tell the derivative"};
    }
    if (!Tells(estimate, i)) {
      return {.why_none = "the number changes infinitely fast, or too fast to tell how fast"};
    }
    return {.rate = estimate.rate + 0.0, .error = estimate.error};
  }

  Threshold ThresholdHere() const {
    if (!beside_[0].has_value() || !beside_[1].has_value()) return Threshold::kDomain;
    return ThresholdBetween(beside_[0]->course, beside_[1]->course, source_.here().course);
  }

  const SampleSource& source_;
  SceneLine& line_;
  std::array<std::optional<Sample>, 2> beside_;  // Below, above.
  std::array<std::array<std::optional<Sample>, kNeighbours>, 2> neighbours_;
  std::array<std::vector<Estimate>, 2> one_sided_;
  std::array<bool, 2> has_neighbours_ = {};  // Some step stayed on the course of the side.
  std::vector<Estimate> central_;
  std::vector<std::vector<std::array<Estimate, 2>>> steps_;  // Of each step that leaves no side's course.
};

}  // namespace

Threshold ThresholdBetween(const Course& x, const Course& y, const Course& here) {
  const auto differ = [&x, &y, &here](const auto& of) { return of(x) != of(y) || of(here) != of(x); };
  const auto is = [](Regime a, Regime b) {
    return [a, b](const Course& course) { return course.regime == a || course.regime == b; };
  };
  if (differ(is(Regime::kSeparating, Regime::kSeparating))) return Threshold::kApproach;
  if (differ(is(Regime::kLocked, Regime::kWedged))) return Threshold::kJamming;
  if (differ([](const Course& course) { return course.slip_before; })) return Threshold::kSlipStart;
  if (differ([](const Course& course) { return course.Has(EventKind::kEndRecedes); })) return Threshold::kEndRecedes;
  if (differ([](const Course& course) { return course.Has(EventKind::kSlipStops); })) return Threshold::kImpactEnd;
  if (differ(is(Regime::kStickInCompression, Regime::kStickInRestitution))) return Threshold::kFrictionLimit;
  if (differ([](const Course& course) { return course.slip_started; })) return Threshold::kFrictionLimit;
  if (differ(is(Regime::kStickInCompression, Regime::kReversalInCompression))) return Threshold::kCompressionEnd;
  // Slip that stops just where compression ends counts as stopped in restitution, but comes first.
  if (differ(
          [](const Course& course) { return course.IsBefore(EventKind::kSlipStops, EventKind::kCompressionEnds); })) {
    return Threshold::kCompressionEnd;
  }
  if (differ([](const Course& course) { return course.speeds_passed; })) return Threshold::kSpeedTable;
  return Threshold::kUnspecified;
}

absl::StatusOr<std::vector<Derivative>> DifferencesOf(const SampleSource& source, const Scene& scene,
                                                      const DerivativePaths& paths) {
  std::vector<Derivative> derivatives(paths.of.size() * paths.by.size());
  const std::vector<double>& here = source.here().value;
  const bool has_numbers = !std::all_of(here.begin(), here.end(), [](double value) { return std::isnan(value); });
  for (size_t k = 0; k < paths.by.size(); ++k) {
    SceneLine line(scene, paths.by[k]);
    Sides sides(source, line, paths.of.size());
    // Neighbours of a scene without an end may each take all of a model's budget.
    if (has_numbers && !sides.Explore()) return absl::CancelledError("the call was stopped");
    for (size_t i = 0; i < paths.of.size(); ++i) {
      Derivative& derivative = derivatives[i * paths.by.size() + k];
      derivative = has_numbers ? sides.At(i) : Join(kNoNumber, kNoNumber, false, Threshold::kUnspecified);
      derivative.of = paths.of[i];
      derivative.by = paths.by[k];
    }
  }
  return derivatives;
}

}  // namespace ricochet
