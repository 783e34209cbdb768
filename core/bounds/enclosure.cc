#include "core/bounds/enclosure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>
#include <vector>

#include "core/bounds/pendulum_bounds.h"
#include "core/bounds/planar_ends.h"

namespace ricochet {
namespace {

constexpr double kInfinity = rounding::kInfinity;

using Box = std::vector<Interval>;

Range ToRange(const Interval& x) { return {x.lower, x.upper}; }

// Returns by how much `outer` is wider than `attained`, relative to the latter. A few ulp count as rounding.
double ExcessOf(const Range& outer, const Range& attained) {
  const double excess = std::max(attained.lower - outer.lower, 0.0) + std::max(outer.upper - attained.upper, 0.0);
  if (outer.lower > outer.upper) return 0.0;
  if (std::isinf(outer.lower) || std::isinf(outer.upper)) return kInfinity;
  const double rounding = 0x1p-40 * std::max(std::fabs(outer.lower), std::fabs(outer.upper));
  if (excess <= rounding) return 0.0;
  return attained.lower > attained.upper ? kInfinity : excess / (attained.upper - attained.lower);
}

double ExcessOf(const CoefficientBounds& outer, const CoefficientBounds& attained) {
  return std::max({ExcessOf(outer.newton, attained.newton), ExcessOf(outer.poisson, attained.poisson),
                   ExcessOf(outer.tangential, attained.tangential),
                   ExcessOf(outer.normal_total_n_s, attained.normal_total_n_s)});
}

// Leaves out scenes whose static friction is below kinetic friction, because they are not valid.
void KeepValidFriction(Interval& mu, std::optional<Interval>& mu_static) {
  if (!mu_static) return;
  mu = AtMost(mu, mu_static->upper);
  mu_static = AtLeast(*mu_static, mu.lower);
}

// ---- Branch and bound ----

// An end of a range that depends on the scene. The search makes each as large as possible.
enum class Goal { kNewton, kPoisson, kTangentialLow, kTangentialHigh, kNormalLow, kNormalHigh };
constexpr std::array kGoals = {Goal::kNewton,         Goal::kPoisson,   Goal::kTangentialLow,
                               Goal::kTangentialHigh, Goal::kNormalLow, Goal::kNormalHigh};

size_t Index(Goal goal) { return static_cast<size_t>(goal); }

// Returns the range of the goal over the scenes that `ends` describe.
Interval RangeOf(const PlanarEnds& ends, Goal goal) {
  const auto larger = [](const Interval& x, const Interval& y) {
    return Interval(std::max(x.lower, y.lower), std::max(x.upper, y.upper));
  };
  switch (goal) {
    case Goal::kNewton:
      return ends.newton;
    case Goal::kPoisson:
      return ends.poisson;
    case Goal::kTangentialLow:
      return larger(-ends.tangential_plastic, -ends.tangential_elastic);
    case Goal::kTangentialHigh:
      return larger(ends.tangential_plastic, ends.tangential_elastic);
    case Goal::kNormalLow:
      return -ends.normal_plastic;
    case Goal::kNormalHigh:
      return ends.normal_elastic;
  }
  return kNothing;
}

bool Reaches(const PlanarEnds& ends, Goal goal) {
  return !IsEmpty(goal == Goal::kNormalLow || goal == Goal::kNormalHigh ? ends.normal_plastic : ends.newton);
}

struct Part {
  double bound;  // The goal is nowhere larger in this part.
  Box box;
  friend bool operator<(const Part& x, const Part& y) { return x.bound < y.bound; }
};

class BranchAndBound {
 public:
  BranchAndBound(absl::Span<const Interval> ranges, ToBox to_box, const EnclosureOptions& options, Stopped stopped)
      : whole_(ranges.begin(), ranges.end()), to_box_(to_box), options_(options), stopped_(stopped) {
    attained_.fill(-kInfinity);
    bounds_.fill(-kInfinity);
  }

  Enclosure Run() {
    const PlanarEnds ends = Evaluate(whole_);
    energetic_ = ends.energetic;
    if (!IsEmpty(ends.normal_plastic) && IsEmpty(ends.newton)) return {.boxes = boxes_};  // All scenes separate.
    AttainAtCorners(0, whole_);
    AttainAt(CentreOf(whole_));
    for (const Goal goal : kGoals) {
      if (Reaches(ends, goal)) parts_[Index(goal)].push({RangeOf(ends, goal).upper, whole_});
    }
    UpdateBounds();
    const int64_t boxes_of_split = 2 * static_cast<int64_t>(whole_.size()) + 2;
    while (boxes_ + boxes_of_split <= options_.budget && !IsStopped()) {
      const std::optional<Goal> goal = WorstGoal();
      if (!goal) break;
      if (!Split(*goal)) given_up_[Index(*goal)] = true;
      UpdateBounds();
    }
    Enclosure enclosure = {.outer = ToBounds(bounds_), .attained = ToBounds(attained_), .boxes = boxes_};
    // If no values are attained, all scenes reach one value, which is known to rounding.
    Range& tangential = enclosure.attained.tangential;
    if (tangential.lower > tangential.upper && !std::isinf(tangential.lower)) tangential = enclosure.outer.tangential;
    enclosure.excess = ExcessOf(enclosure.outer, enclosure.attained);
    return enclosure;
  }

 private:
  using Values = std::array<double, kGoals.size()>;
  // The cut that helps most at once may help little in the end, so no part gets thinner than this, relative to its
  // longest side.
  static constexpr double kThinnest = 0x1p-3;
  static constexpr size_t kCornerDimensions = 10;  // The dimensions of which every corner is tried.

  PlanarEnds Evaluate(const Box& box) {
    ++boxes_;
    return std::visit([](const auto& one) { return EncloseEnds(one); }, to_box_(box));
  }

  bool IsStopped() {
    is_stopped_ = is_stopped_ || stopped_();
    return is_stopped_;
  }

  static Box CentreOf(Box box) {
    for (Interval& range : box) range = Midpoint(range);
    return box;
  }

  // Raises the attained values to those that the scene at `point` reaches for certain.
  void AttainAt(const Box& point) {
    if (boxes_ >= options_.budget || IsStopped()) return;
    const PlanarEnds ends = Evaluate(point);
    for (const Goal goal : kGoals) {
      if (!Reaches(ends, goal)) continue;
      attained_[Index(goal)] = std::max(attained_[Index(goal)], RangeOf(ends, goal).lower);
    }
  }

  void AttainAtCorners(size_t dimension, Box box) {
    if (dimension == box.size() || dimension == kCornerDimensions) return AttainAt(CentreOf(std::move(box)));
    const Interval range = box[dimension];
    box[dimension] = range.lower;
    AttainAtCorners(dimension + 1, box);
    if (IsPoint(range)) return;
    box[dimension] = range.upper;
    AttainAtCorners(dimension + 1, std::move(box));
  }

  void UpdateBounds() {
    for (size_t i = 0; i < kGoals.size(); ++i) {
      // Every part that was cut off lies below what is attained.
      bounds_[i] = parts_[i].empty() ? attained_[i] : std::max(parts_[i].top().bound, attained_[i]);
    }
  }

  // Returns the goal whose bound lies farthest above the attained value, among those for which that is too far. An
  // infinite bound may be the truth, so it comes last.
  std::optional<Goal> WorstGoal() const {
    const CoefficientBounds reached = ToBounds(attained_);
    std::optional<Goal> worst;
    double worst_gap = 0.0;
    for (const Goal goal : kGoals) {
      const double bound = bounds_[Index(goal)];
      const double gap = (bound - attained_[Index(goal)]) / AllowedGap(reached, goal, bound);
      if (given_up_[Index(goal)] || !(gap > 1.0)) continue;
      if (worst && (std::isinf(gap) || (gap <= worst_gap && !std::isinf(worst_gap)))) continue;
      worst = goal;
      worst_gap = gap;
    }
    return worst;
  }

  // Returns the tolerance on a range's width, which its ends share if both depend on the scene.
  double AllowedGap(const CoefficientBounds& reached, Goal goal, double bound) const {
    const auto width = [](const Range& range) { return std::max(range.upper - range.lower, 0.0); };
    const double rounding = std::isinf(bound) ? 0.0 : 0x1p-42 * std::fabs(bound);
    double share = 0.0;
    switch (goal) {
      case Goal::kNewton:
        share = width(reached.newton);
        break;
      case Goal::kPoisson:
        share = width(reached.poisson);
        break;
      case Goal::kTangentialLow:
      case Goal::kTangentialHigh:
        share = 0.5 * width(reached.tangential);
        break;
      case Goal::kNormalLow:
      case Goal::kNormalHigh:
        share = 0.5 * width(reached.normal_total_n_s);
        break;
    }
    return std::max(options_.tolerance * share, rounding);
  }

  // Returns the length of `box` along dimension i as a share of the whole box's.
  double ShareOf(const Box& box, size_t i) const {
    return IsPoint(whole_[i]) ? 0.0 : (box[i].upper - box[i].lower) / (whole_[i].upper - whole_[i].lower);
  }

  double LongestShare(const Box& box) const {
    double longest = 0.0;
    for (size_t i = 0; i < box.size(); ++i) longest = std::max(longest, ShareOf(box, i));
    return longest;
  }

  // Replaces the goal's worst part by two halves of it. Returns false if that part is a point, or once stopped.
  bool Split(Goal goal) {
    std::priority_queue<Part>& parts = parts_[Index(goal)];
    const Part worst = parts.top();
    std::array<Part, 2> best;
    std::pair<double, double> best_score(kInfinity, kInfinity);
    bool any = false;
    const double longest = LongestShare(worst.box);
    for (size_t i = 0; i < worst.box.size(); ++i) {
      const double middle = Midpoint(worst.box[i]);
      if (middle == worst.box[i].lower || middle == worst.box[i].upper) continue;
      if (ShareOf(worst.box, i) < kThinnest * longest) continue;
      if (IsStopped()) return false;
      std::array<Part, 2> halves = {Half(goal, worst, i, {worst.box[i].lower, middle}),
                                    Half(goal, worst, i, {middle, worst.box[i].upper})};
      const double high = std::max(halves[0].bound, halves[1].bound);
      const double low = std::min(halves[0].bound, halves[1].bound);
      // If no cut helps, the longest side is cut.
      const std::pair<double, double> score = {high, high < worst.bound ? low : -ShareOf(worst.box, i)};
      if (any && !(score < best_score)) continue;
      any = true;
      best_score = score;
      best = std::move(halves);
    }
    if (!any) return false;
    parts.pop();
    for (Part& half : best) {
      if (half.bound <= attained_[Index(goal)]) continue;
      AttainAt(CentreOf(half.box));
      parts.push(std::move(half));
    }
    return true;
  }

  Part Half(Goal goal, const Part& whole, size_t dimension, const Interval& range) {
    Part half = whole;
    half.box[dimension] = range;
    const PlanarEnds ends = Evaluate(half.box);
    // A half contains only scenes of the whole, so the bound of the whole holds for it, too.
    half.bound = Reaches(ends, goal) ? std::min(RangeOf(ends, goal).upper, whole.bound) : -kInfinity;
    return half;
  }

  CoefficientBounds ToBounds(const Values& values) const {
    CoefficientBounds bounds;
    bounds.newton.upper = values[Index(Goal::kNewton)];
    bounds.poisson.upper = values[Index(Goal::kPoisson)];
    bounds.energetic.upper = energetic_.upper;
    bounds.tangential = {-values[Index(Goal::kTangentialLow)], values[Index(Goal::kTangentialHigh)]};
    bounds.normal_total_n_s = {-values[Index(Goal::kNormalLow)], values[Index(Goal::kNormalHigh)]};
    return bounds;
  }

  const Box whole_;
  const ToBox to_box_;
  const EnclosureOptions options_;
  const Stopped stopped_;
  std::array<std::priority_queue<Part>, kGoals.size()> parts_;  // The parts that may exceed the attained value.
  std::array<bool, kGoals.size()> given_up_ = {};               // The goal's worst part is a point.
  Values attained_;
  Values bounds_;
  Interval energetic_;
  int64_t boxes_ = 0;
  bool is_stopped_ = false;
};

// ---- Pendulum ----

struct Pendulums {
  Interval inertia, a, arm;  // arm = |b|
  Interval speed;            // |w-|
  Interval mu, mu_static;
  bool may_slip, may_lock;
};

Pendulums MakePendulums(const PendulumBox& box) {
  Pendulums all = {.inertia = box.inertia,
                   .a = box.a,
                   .arm = Abs(box.b),
                   .speed = AtLeast(-box.omega_minus, 0.0),
                   .mu = box.mu,
                   .mu_static = box.mu_static.value_or(box.mu)};
  const Interval hold = all.mu_static * all.arm - all.a;
  all.may_slip = hold.lower < 0.0;
  all.may_lock = hold.upper >= 0.0;
  return all;
}

// MostSlipping holds the largest values of the scenes that slip, for which x = mu |b|/a < mu/mu_s.
struct MostSlipping {
  Interval x, mu;
};

MostSlipping MostSlip(const Pendulums& all) {
  const Interval slope = all.arm / all.a;
  // mu |b| < a
  const Interval free = slope.lower > 0.0 ? Interval(1.0) / Interval(slope.lower) : Interval(kInfinity);
  const double mu = std::min(all.mu.upper, free.upper);
  const double held = std::max(all.mu_static.lower, mu);
  Interval most = mu * Interval(all.arm.upper) / Interval(all.a.lower);
  if (!all.may_lock) return {most, mu};
  const double cap = held > 0.0 ? std::min((Interval(mu) / Interval(held)).upper, 1.0) : 0.0;
  if (most.upper > cap) most = cap;
  return {most, mu};
}

// Returns an upper bound of J |w-| (1/(a + q) + 1/sqrt((a - q)(a + q))), which is convex in q.
double MostNormalImpulse(const Pendulums& all, const MostSlipping& slipping) {
  const Interval a(all.a.lower);
  const auto at = [&](const Interval& q) {
    const Interval sum = a + q;
    return (Interval(1.0) / sum + Interval(1.0) / Sqrt(AtLeast(a - q, 0.0) * sum)).upper;
  };
  const Interval least = Interval(all.mu.lower) * Interval(all.arm.lower);
  const Interval most = all.may_lock ? slipping.x * a : Interval(slipping.mu.upper) * Interval(all.arm.upper);
  const double h = std::max(at(Interval(std::min(least.upper, most.upper))), at(most));
  return (Interval(all.inertia.upper) * Interval(all.speed.upper) * Interval(h)).upper;
}

// Returns the bounds of the scenes that slip, for b > 0.
CoefficientBounds BoundsOfSlip(const Pendulums& all) {
  const Interval one(1.0);
  const MostSlipping slipping = MostSlip(all);
  const Interval least_q = Interval(all.mu.lower) * Interval(all.arm.lower);
  const Interval a_high(all.a.upper);
  const Interval a_low(all.a.lower);
  const Interval most_q = all.may_lock ? slipping.x * a_low : slipping.mu * Interval(all.arm.upper);
  const Interval cosine = Sqrt(AtLeast((a_low - most_q) * (a_low + most_q), 0.0)) / a_low;
  CoefficientBounds bounds;
  bounds.newton.upper = Sqrt(AtLeast((a_high - least_q) / (a_high + least_q), 0.0)).upper;
  bounds.poisson.upper = Sqrt((a_low + most_q) / AtLeast(a_low - most_q, 0.0)).upper;
  bounds.energetic.upper = 1.0;
  bounds.tangential = {-(slipping.mu * slipping.x / (one + cosine)).upper, all.mu.upper};
  bounds.normal_total_n_s = {0.0, MostNormalImpulse(all, slipping)};
  return bounds;
}

CoefficientBounds OuterBounds(const PendulumBox& box) {
  const Pendulums all = MakePendulums(box);
  const Interval plastic = all.inertia * all.speed / (all.a + all.mu * all.arm);
  CoefficientBounds outer;
  outer.tangential = {all.mu.lower, all.mu.upper};
  outer.normal_total_n_s = {plastic.lower, plastic.upper};
  if (all.may_slip) {
    const CoefficientBounds slip = BoundsOfSlip(all);
    outer.newton = slip.newton;
    outer.poisson = slip.poisson;
    outer.energetic = slip.energetic;
    outer.tangential.lower = slip.tangential.lower;
    outer.normal_total_n_s.upper = std::max(plastic.upper, slip.normal_total_n_s.upper);
  }
  outer.tangential = ToRange(OnItsSide({outer.tangential.lower, outer.tangential.upper}, box.b));
  if (box.omega_minus.upper >= 0.0) outer.normal_total_n_s.lower = 0.0;
  if (box.omega_minus.lower >= 0.0) outer.normal_total_n_s.upper = 0.0;
  return outer;
}

Range Join(const Range& x, const Range& y) { return {std::min(x.lower, y.lower), std::max(x.upper, y.upper)}; }

CoefficientBounds Join(const CoefficientBounds& x, const CoefficientBounds& y) {
  return {.newton = Join(x.newton, y.newton),
          .poisson = Join(x.poisson, y.poisson),
          .energetic = Join(x.energetic, y.energetic),
          .tangential = Join(x.tangential, y.tangential),
          .normal_total_n_s = Join(x.normal_total_n_s, y.normal_total_n_s)};
}

std::vector<double> Ends(const Interval& x) {
  return IsPoint(x) ? std::vector<double>{x.lower} : std::vector<double>{x.lower, x.upper};
}

std::vector<pendulum::Problem> CornersOf(const PendulumBox& box) {
  std::vector<double> b_ends = Ends(box.b);
  if (box.b.lower < 0.0 && box.b.upper > 0.0) b_ends.push_back(0.0);
  const std::vector<double> static_ends = box.mu_static ? Ends(*box.mu_static) : std::vector<double>{0.0};
  std::vector<pendulum::Problem> corners;
  for (const double inertia : Ends(box.inertia)) {
    for (const double a : Ends(box.a)) {
      for (const double b : b_ends) {
        for (const double omega : Ends(box.omega_minus)) {
          for (const double mu : Ends(box.mu)) {
            for (const double mu_static : static_ends) {
              corners.push_back({.inertia = inertia,
                                 .a = a,
                                 .b = b,
                                 .omega_minus = omega,
                                 .mu = mu,
                                 .mu_static = std::max(mu, mu_static)});
            }
          }
        }
      }
    }
  }
  return corners;
}

}  // namespace

Enclosure Enclose(const PendulumBox& whole) {
  Enclosure enclosure;
  PendulumBox box = whole;
  KeepValidFriction(box.mu, box.mu_static);
  if (IsEmpty(box.mu)) {
    const Range none = ToRange(kNothing);
    enclosure.outer = enclosure.attained = {none, none, none, none, none};
    return enclosure;
  }
  enclosure.outer = OuterBounds(box);
  const std::vector<pendulum::Problem> corners = CornersOf(box);
  enclosure.attained = pendulum::SolveBounds(corners.front()).sharp;
  for (const pendulum::Problem& corner : corners) {
    enclosure.attained = Join(enclosure.attained, pendulum::SolveBounds(corner).sharp);
  }
  enclosure.boxes = static_cast<int64_t>(corners.size());
  enclosure.excess = ExcessOf(enclosure.outer, enclosure.attained);
  return enclosure;
}

Enclosure Enclose(absl::Span<const Interval> ranges, ToBox to_box, const EnclosureOptions& options, Stopped stopped) {
  return BranchAndBound(ranges, to_box, options, stopped).Run();
}

}  // namespace ricochet
