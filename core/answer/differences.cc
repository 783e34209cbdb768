#include "core/answer/differences.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/answer/derivative_sides.h"
#include "core/answer/scene_outcome.h"
#include "core/contact/scene_contact.h"
#include "core/numerics/elementary.h"
#include "core/plan/number_demand.h"
#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"
#include "ricochet/outcome_numbers.h"

namespace ricochet {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr int kNeighbours = 6;                    // On each side.
constexpr std::array<size_t, 2> kSides = {0, 1};  // Below, above.
// A scene next to this one, over the size of the number: it tells the course and whether the outcome jumps.
constexpr double kBeside = 0x1p-44;
constexpr double kJump = 0x1p-24;
// The steps over the size of the number, as negative powers of two.
constexpr int kFirstStep = 4;
constexpr int kLastStep = 30;

// A path without its last index, and the name at its end.
absl::string_view HeadOf(absl::string_view path) { return path.substr(0, path.rfind('[')); }
absl::string_view NameOf(absl::string_view path) { return path.substr(path.rfind('.') + 1); }

// --- An outcome ---

// What tells the pieces of an outcome from each other.
struct Course {
  Regime regime = Regime::kUnspecified;
  bool slips_before = false;
  std::vector<EventKind> events;
  size_t alternatives = 0;
  friend bool operator==(const Course&, const Course&) = default;

  bool Has(EventKind kind) const { return std::find(events.begin(), events.end(), kind) != events.end(); }
};

Course CourseOf(const Outcome& outcome) {
  Course course = {.regime = outcome.regime, .alternatives = outcome.alternatives.size()};
  for (const Event& event : outcome.timeline) course.events.push_back(event.kind);
  if (!outcome.timeline.empty()) {
    const Components& slip = outcome.timeline.front().state.contact_velocity.tangential_m_s;
    course.slips_before = std::any_of(slip.begin(), slip.end(), [](double u) { return u != 0.0; });
  }
  return course;
}

struct Sample {
  Course course;
  std::vector<double> value, error;  // One for each path of `of`; NaN if the outcome leaves it unset.
  double relative_error = kUnknown;  // Of a number without an error of its own, over its scale.
};

// Solves scenes of one form.
class Solver {
 public:
  Solver(const Demand& demand, absl::FunctionRef<bool()> stopped) : demand_(demand), stopped_(stopped) {
    demand_.relative_tolerance = 0.0;
  }

  // Solves the scene itself, which tells the places of the numbers and their scales.
  absl::Status Begin(const Scene& scene, const std::vector<std::string>& of) {
    std::optional<SceneContact> contact;
    Outcome outcome;
    absl::Status solved = SolveScene(scene, contact, demand_, {}, stopped_, outcome);
    if (!solved.ok()) return solved;
    FindPlaces(outcome, of);
    here_ = SampleOf(outcome);
    if (!contact.has_value()) contact.emplace(scene);
    const double speed = std::visit([](const auto& reduction) { return SpeedOf(reduction); }, contact->reduction);
    for (size_t i = 0; i < of.size(); ++i) {
      const double size = std::isnan(here_.value[i]) ? 0.0 : std::fabs(here_.value[i]);
      scales_.push_back(std::max(
          {size, ScaleOf(of[i], speed, outcome.impulse.normal_total_n_s), std::numeric_limits<double>::min()}));
    }
    return absl::OkStatus();
  }

  const Sample& here() const { return here_; }
  double scale(size_t i) const { return scales_[i]; }
  double ErrorOf(const Sample& sample, size_t i) const {
    if (std::isnan(sample.error[i])) return sample.relative_error * scales_[i];
    return std::max(sample.error[i], 0x1p-52 * std::fabs(sample.value[i]));
  }

  // Sets the sample to nothing if the scene breaks a rule or has no outcome. Returns false once it is stopped.
  bool At(const Scene& scene, std::optional<Sample>& sample) const {
    sample.reset();
    if (stopped_()) return false;
    std::optional<SceneContact> contact;
    if (!Validate(scene, RestitutionIs::kRequired, contact).empty()) return true;
    Outcome outcome;
    const absl::Status solved = SolveScene(scene, contact, demand_, {}, stopped_, outcome);
    if (solved.ok()) sample = SampleOf(outcome);
    return !absl::IsCancelled(solved);
  }

 private:
  template <typename Reduction>
  static double SpeedOf(const Reduction& reduction) {
    double speed = std::fabs(reduction.v0);
    if constexpr (requires { reduction.u0.size(); }) {
      for (const double u : reduction.u0) speed = std::max(speed, std::fabs(u));
    } else {
      speed = std::max(speed, std::fabs(reduction.u0));
    }
    return speed;
  }

  // All outcomes of scenes of one form have the same places in the same order. Components may share an error.
  void FindPlaces(const Outcome& outcome, const std::vector<std::string>& of) {
    std::vector<std::string> paths;
    VisitOutcomeFields(outcome,
                       [&](const NumberPath& path, const double* /*number*/) { paths.push_back(path.Text()); });
    const auto place_of = [&paths](const std::string& path) {
      return static_cast<size_t>(std::find(paths.begin(), paths.end(), path) - paths.begin());
    };
    for (const std::string& path : of) {
      const absl::string_view name = NameOf(path);
      const size_t own = place_of(absl::StrCat("errors.", name));
      places_.push_back(place_of(path));
      error_places_.push_back(own < paths.size() ? own : place_of(absl::StrCat("errors.", HeadOf(name))));
    }
  }

  Sample SampleOf(const Outcome& outcome) const {
    Sample sample = {.course = CourseOf(outcome), .relative_error = std::max(outcome.accuracy.relative_error, 0x1p-51)};
    std::vector<double> numbers;
    VisitOutcomeFields(outcome, [&](const NumberPath& /*path*/, const double* number) {
      numbers.push_back(number == nullptr ? kNone : *number);
    });
    const auto at = [&numbers](size_t place) { return place < numbers.size() ? numbers[place] : kNone; };
    for (const size_t place : places_) sample.value.push_back(at(place));
    for (const size_t place : error_places_) sample.error.push_back(at(place));
    return sample;
  }

  Demand demand_;
  absl::FunctionRef<bool()> stopped_;
  // Among all numbers of an outcome, of each number asked for and of its error; behind the last one if there is none.
  std::vector<size_t> places_, error_places_;
  std::vector<double> scales_;
  Sample here_;
};

// --- A number of the scene ---

// arctan(a/b) in (0, pi): the distance that is left becomes itself less its sine.
double AngleOf(const Pendulum& pendulum) {
  const double radius = Hypot(pendulum.a_m, pendulum.b_m);
  double angle = 1.5;
  constexpr int kEnough = 10;
  for (int i = 0; i < kEnough; ++i) {
    angle -= (pendulum.b_m * Sin(angle) - pendulum.a_m * Cos(angle)) / radius;
  }
  return angle;
}

// The scenes in which one number differs.
class Line {
 public:
  Line(Scene scene, const std::string& by) : scene_(std::move(scene)), field_(*ResolveField(by, scene_)) {
    if (const std::optional<double> number = NumberAt(scene_, by)) {
      number_ = *number;
    } else {  // The angle of a pendulum.
      number_ = AngleOf(std::get<Pendulum>(scene_.system));
    }
    double size = std::fabs(number_);
    // A number that is 0 has the size of its neighbours in a list.
    if (size == 0.0) {
      VisitNumbers(scene_, [&](const NumberPath& path, double value, NumberRule /*rule*/) {
        if (HeadOf(path.Text()) == HeadOf(by)) size = std::max(size, std::fabs(value));
      });
    }
    unit_ = size == 0.0 ? 1.0 : std::ldexp(1.0, std::ilogb(size));
  }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  double unit() const { return unit_; }
  // Returns false once the solver is stopped.
  bool At(const Solver& solver, double step, std::optional<Sample>& sample) {
    sample.reset();
    if (!field_.Set(number_ + step)) return true;
    return solver.At(scene_, sample);
  }

 private:
  Scene scene_;
  Field field_;
  double number_ = 0.0;
  double unit_ = 1.0;
};

// --- Formulas ---

struct Estimate {
  double rate = 0.0;
  double error = kUnknown;
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

// Of all neighbours, of all but the farthest, and of all but the two farthest.
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
  const double cut_off = std::fabs(sum[0] - sum[1]) + 0.125 * std::fabs(sum[1] - sum[2]);
  return {.rate = sum[0] / step, .error = (cut_off + rounding) / std::fabs(step)};
}

// Keeps the better estimate. Returns true if it is the new one.
bool Improve(Estimate& best, const Estimate& next) {
  if (!(next.error < best.error) || !std::isfinite(next.rate)) return false;
  best = next;
  return true;
}

// --- Both sides of a number ---

class Sides {
 public:
  Sides(const Solver& solver, Line& line, size_t count)
      : solver_(solver),
        line_(line),
        one_sided_{std::vector<Estimate>(count), std::vector<Estimate>(count)},
        central_(count) {}

  // Returns false once the solver is stopped.
  bool Explore() {
    for (const size_t side : kSides) {
      if (!line_.At(solver_, Sign(side) * kBeside * line_.unit(), beside_[side])) return false;
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
    bool agree = false;
    if (below.rate.has_value() && above.rate.has_value()) {
      const double rounding = 0x1p-40 * (std::fabs(*below.rate) + std::fabs(*above.rate));
      agree = std::fabs(*below.rate - *above.rate) <= 4.0 * (*below.error + *above.error) + rounding;
    }
    Derivative derivative = Join(below, above, agree, ThresholdBetween());
    if (!agree) {
      if (derivative.kind == DerivativeKind::kOneSided) {
        derivative.error = std::max(below.error.value_or(0.0), above.error.value_or(0.0));
      }
      return derivative;
    }
    Estimate best = central_[i];
    for (const auto& side : one_sided_) Improve(best, side[i]);
    derivative.value = derivative.from_below = derivative.from_above = best.rate + 0.0;
    derivative.error = best.error;
    return derivative;
  }

 private:
  static double Sign(size_t side) { return side == 0 ? -1.0 : 1.0; }

  // `is_one_course` says that all neighbours follow the course beside the scene.
  bool SetNeighbours(size_t side, double step, bool& is_one_course) {
    is_one_course = beside_[side].has_value();
    for (size_t j = 0; j < kNeighbours && is_one_course; ++j) {
      std::optional<Sample>& sample = neighbours_[side][j];
      if (!line_.At(solver_, Sign(side) * static_cast<double>(j + 1) * step, sample)) return false;
      is_one_course = sample.has_value() && sample->course == beside_[side]->course;
    }
    return true;
  }

  // Returns false once every side that exists has an estimate and this step has made none better.
  bool Refine(double step, const std::array<bool, 2>& is_one_course) {
    static const Weights one_sided = WeightsBy(OneSidedWeights);
    static const Weights central = WeightsBy(CentralWeights);
    const Sample& here = solver_.here();
    const bool is_smooth =
        is_one_course[0] && is_one_course[1] && beside_[0]->course == here.course && beside_[1]->course == here.course;
    bool has_improved = false;
    for (size_t i = 0; i < central_.size(); ++i) {
      std::array<double, kNeighbours> changes;
      for (const size_t side : kSides) {
        if (!is_one_course[side]) continue;
        for (size_t j = 0; j < kNeighbours; ++j) changes[j] = neighbours_[side][j]->value[i] - here.value[i];
        const Estimate next = EstimateOf(changes, one_sided, Noise(side, i), Sign(side) * step, line_.unit());
        has_improved |= Improve(one_sided_[side][i], next);
      }
      if (!is_smooth) continue;
      for (size_t j = 0; j < kNeighbours; ++j) {
        changes[j] = 0.5 * (neighbours_[1][j]->value[i] - neighbours_[0][j]->value[i]);
      }
      has_improved |=
          Improve(central_[i], EstimateOf(changes, central, std::max(Noise(0, i), Noise(1, i)), step, line_.unit()));
    }
    const bool waits = (beside_[0].has_value() && !is_one_course[0]) || (beside_[1].has_value() && !is_one_course[1]);
    return has_improved || waits;
  }

  double Noise(size_t side, size_t i) const {
    double error = solver_.ErrorOf(solver_.here(), i);
    for (const std::optional<Sample>& sample : neighbours_[side]) error = std::max(error, solver_.ErrorOf(*sample, i));
    return error;
  }

  OneSided LimitOf(size_t side, size_t i) const {
    if (!beside_[side].has_value()) return {.why_none = "the scene would break a rule"};
    const double here = solver_.here().value[i], beside = beside_[side]->value[i];
    if (std::isnan(here) || std::isnan(beside)) return {.why_none = "the outcome has no such number"};
    if (std::fabs(beside - here) > kJump * std::max(std::fabs(beside), solver_.scale(i))) {
      return {.why_none = "the number jumps"};
    }
    const auto& [rate, error] = one_sided_[side][i];
    constexpr double kVague = 0.1;
    constexpr double kNegligible = 1e-6;
    const double negligible = kNegligible * solver_.scale(i) / line_.unit();
    if (!(error <= std::max(kVague * std::fabs(rate), negligible))) {
      return {.why_none = "the number changes infinitely fast, or too fast to tell how fast"};
    }
    return {.rate = rate + 0.0, .error = error};
  }

  Threshold ThresholdBetween() const {
    if (!beside_[0].has_value() || !beside_[1].has_value()) return Threshold::kDomain;
    const Course& x = beside_[0]->course;
    const Course& y = beside_[1]->course;
    const Course& here = solver_.here().course;
    const auto differ = [&x, &y, &here](const auto& of) { return of(x) != of(y) || of(here) != of(x); };
    const auto is = [](Regime a, Regime b) {
      return [a, b](const Course& course) { return course.regime == a || course.regime == b; };
    };
    if (differ(is(Regime::kSeparating, Regime::kSeparating))) return Threshold::kApproach;
    if (differ(is(Regime::kLocked, Regime::kWedged))) return Threshold::kJamming;
    if (differ([](const Course& course) { return course.slips_before; })) return Threshold::kSlipStart;
    if (differ([](const Course& course) { return course.Has(EventKind::kSlipStops); })) return Threshold::kImpactEnd;
    if (differ(is(Regime::kStickInCompression, Regime::kStickInRestitution))) return Threshold::kFrictionLimit;
    if (differ(is(Regime::kStickInCompression, Regime::kReversalInCompression))) return Threshold::kCompressionEnd;
    // Courses that are alike on both sides differ in what the approach speed makes of the coefficients.
    return x == y ? Threshold::kSpeedTable : Threshold::kUnspecified;
  }

  const Solver& solver_;
  Line& line_;
  std::array<std::optional<Sample>, 2> beside_;  // Below, above.
  std::array<std::array<std::optional<Sample>, kNeighbours>, 2> neighbours_;
  std::array<std::vector<Estimate>, 2> one_sided_;
  std::vector<Estimate> central_;
};

}  // namespace

absl::StatusOr<std::vector<Derivative>> DifferencesOf(const Scene& scene, const Demand& demand,
                                                      const DerivativePaths& paths, absl::FunctionRef<bool()> stopped) {
  Solver solver(WithNumbers(demand, paths.of), stopped);
  if (const absl::Status begun = solver.Begin(scene, paths.of); !begun.ok()) return begun;
  std::vector<Derivative> derivatives(paths.of.size() * paths.by.size());
  for (size_t k = 0; k < paths.by.size(); ++k) {
    Line line(scene, paths.by[k]);
    Sides sides(solver, line, paths.of.size());
    if (!sides.Explore()) return absl::CancelledError("the call was stopped");
    for (size_t i = 0; i < paths.of.size(); ++i) {
      Derivative& derivative = derivatives[i * paths.by.size() + k];
      derivative = sides.At(i);
      derivative.of = paths.of[i];
      derivative.by = paths.by[k];
    }
  }
  return derivatives;
}

}  // namespace ricochet
