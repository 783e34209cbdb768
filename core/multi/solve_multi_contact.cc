#include "core/multi/solve_multi_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "core/base/decimal.h"
#include "core/models/impact_errors.h"
#include "core/multi/energy.h"
#include "core/multi/mirror.h"
#include "core/multi/orders.h"
#include "core/multi/outputs.h"
#include "core/multi/possible.h"
#include "core/multi/springs.h"
#include "core/multi/stiffness_curve.h"
#include "core/numerics/elementary.h"
#include "core/scene/validate_multi.h"
#include "ricochet/error.h"

namespace ricochet {
namespace multi {
namespace {

constexpr char kSpringsName[] = "springs";
// A width or a difference below this part of its scale is rounding alone.
constexpr double kNoWidth = 1e-11;
constexpr double kPi = 3.141592653589793;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Sum adds products with a single rounding. Terms that cancel leave exactly 0, in whatever order they are added.
class Sum {
 public:
  void Add(double x, double y) {
    const double product = x * y;
    size_ += std::abs(product);
    error_ += std::fma(x, y, -product);
    const double sum = value_ + product;
    const double part = sum - value_;
    error_ += (value_ - (sum - part)) + (product - part);
    value_ = sum;
  }
  double value() const {
    const double value = value_ + error_;
    return std::abs(value) <= 16.0 * kEpsilon * kEpsilon * size_ ? 0.0 : value;
  }

 private:
  double value_ = 0.0, error_ = 0.0, size_ = 0.0;
};

// The power of two above the size of a number, or the largest that there is.
double PowerAbove(double size) { return size > 0.0 ? std::scalbn(1.0, std::min(std::ilogb(size) + 1, 1023)) : 1.0; }

// The power of four at or below the size of a number > 0, whose root is a power of two.
double PowerOfFourBelow(double size) { return std::scalbn(1.0, std::ilogb(size) & ~1); }

// Returns the order as text, cut after as many impacts as somebody may still read.
std::string OrderText(const std::vector<int>& order, int repeats_from, const SortedProblem& sorted) {
  constexpr size_t kMostInText = 64;
  std::string text;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i == kMostInText) return text + "-...";
    if (i > 0) text += '-';
    if (static_cast<int>(i) == repeats_from) text += '(';
    absl::StrAppend(&text, sorted.from[At(order[i])] + 1);
  }
  if (repeats_from >= 0) text += ')';
  return text.empty() ? "none" : text;
}

// Answerer computes the answer for one state.
class Answerer {
 public:
  Answerer(const MultiContactRequest& request, const MultiReduction& reduction, Eigen::VectorXd velocity,
           absl::FunctionRef<bool()> stopped)
      : request_(request), reduction_(reduction), velocity_(std::move(velocity)), stopped_(stopped) {
    Problem problem = {.d = reduction.directions, .k = static_cast<int>(request.scene.contacts.size())};
    const Eigen::VectorXd v = reduction.ContactVelocity(velocity_);
    w_scale_ = PowerAbove(reduction.w.diagonal().maxCoeff());
    v_scale_ = PowerAbove(v.cwiseAbs().maxCoeff());
    problem.w = reduction.w / w_scale_;
    problem.v = v / v_scale_;
    for (const MultiContactPoint& contact : request.scene.contacts) {
      problem.laws.push_back(
          {.mu = contact.friction, .e = *contact.energetic, .stiffness = contact.relative_stiffness.value_or(1.0)});
    }
    const auto stiffest =
        std::max_element(problem.laws.begin(), problem.laws.end(),
                         [](const ContactLaw& x, const ContactLaw& y) { return x.stiffness < y.stiffness; });
    stiffness_scale_ = PowerOfFourBelow(stiffest->stiffness);
    for (ContactLaw& law : problem.laws) law.stiffness /= stiffness_scale_;
    sorted_ = Sort(problem);
    metric_ = MetricOf(sorted_.problem);
  }

  MultiContactAnswer Answer() {
    const Eigen::VectorXd v = reduction_.ContactVelocity(velocity_);
    answer_.contact_velocity_before_m_s.assign(v.data(), v.data() + v.size());
    answer_.energy_before_j = 0.5 * metric_.y.squaredNorm() * EnergyScale();
    const Eigen::VectorXd apart = PushApart(sorted_.problem, metric_);
    answer_.jams = apart.size() == 0;
    AddPairs();
    const bool orders = Wanted(MultiContactMethod::kOrders);
    const bool springs = Wanted(MultiContactMethod::kSprings);
    const bool possible = Wanted(MultiContactMethod::kPossible);
    if (orders) AddOrders();
    if (springs) AddSprings();
    if (possible) AddPossible(apart);
    Judge(springs);
    return std::move(answer_);
  }

 private:
  // The outputs are computed when they are first needed.
  const std::vector<Output>& Outputs() {
    if (outputs_.empty()) outputs_ = OutputsOf(request_, reduction_, velocity_, sorted_, metric_, w_scale_);
    return outputs_;
  }

  double ImpulseScale() const { return v_scale_ / w_scale_; }
  double EnergyScale() const { return v_scale_ / w_scale_ * v_scale_; }

  // True if the method was asked for, or everything was and the scene allows it. What it does not allow is named.
  bool Wanted(MultiContactMethod method) {
    const auto& methods = request_.methods;
    if (!methods.empty()) return std::find(methods.begin(), methods.end(), method) != methods.end();
    std::string why_not = WhyNot(method, sorted_.problem.d, sorted_.problem.k);
    if (why_not.empty()) return true;
    answer_.refused.push_back({.method = method, .reason = std::move(why_not)});
    return false;
  }

  void AddPairs() {
    const int d = reduction_.directions;
    for (int i = 0; i < sorted_.problem.k; ++i) {
      for (int j = i + 1; j < sorted_.problem.k; ++j) {
        const double own = std::sqrt(reduction_.w(d * i + d - 1, d * i + d - 1));
        const double other = std::sqrt(reduction_.w(d * j + d - 1, d * j + d - 1));
        ContactPair& pair = answer_.pairs.emplace_back(ContactPair{.contact_1 = i + 1, .contact_2 = j + 1});
        if (!(own > 0.0 && other > 0.0)) continue;
        pair.cosine = std::clamp(-reduction_.w(d * i + d - 1, d * j + d - 1) / own / other, -1.0, 1.0) + 0.0;
        SetDivisor(pair);
      }
    }
  }

  static void SetDivisor(ContactPair& pair) {
    if (pair.cosine <= -1.0 + kEpsilon) pair.divisor = 1;
    if (!(pair.cosine >= 0.0 && pair.cosine < 1.0)) return;
    // cos(theta) = 1 - theta^2/2 + ..., so that this is m or next to it.
    const double near = std::min(kPi / std::sqrt(2.0 * (1.0 - pair.cosine)), 1e6);
    for (auto m = static_cast<int32_t>(std::max(near, 2.0)); m <= near + 2.0; ++m) {
      const double exact = m == 2 ? 0.0 : m == 3 ? 0.5 : Cos(kPi / m);
      if (std::abs(pair.cosine - exact) <= kEpsilon * std::max(exact, 0.5)) pair.divisor = m;
    }
  }

  // --- Outcomes ---

  AttainedOutcome OutcomeOf(const Attained& attained) const {
    const Problem& problem = sorted_.problem;
    AttainedOutcome outcome = {.end = attained.end,
                               .events = attained.events,
                               .friction_split_is_unique = attained.split_is_unique,
                               .work_error_j = attained.work_error * EnergyScale(),
                               .error_is_proved = attained.error_is_proved};
    Vector error(attained.v.size());
    // An error larger than the whole energy or impulse tells nothing, so it counts as unknown.
    if (!(outcome.work_error_j <= answer_.energy_before_j)) outcome.work_error_j = kInfinity;
    for (int j = 0; j < error.size(); ++j) error(j) = KnownError(attained.ErrorOf(problem, j) * v_scale_);
    // Adding 0 makes -0 positive.
    Vector in_scene = (sorted_.InScene(attained.v) * v_scale_).array() + 0.0;
    outcome.contact_velocity_m_s.assign(in_scene.begin(), in_scene.end());
    in_scene = sorted_.InScene(error).cwiseAbs();
    outcome.contact_velocity_error_m_s.assign(in_scene.begin(), in_scene.end());
    if (!std::holds_alternative<ContactMatrix>(request_.scene.system)) AddVelocities(attained, outcome);
    if (attained.end == MultiContactEnd::kWedged) {
      // The impulse grows without end, so that the change of energy is taken from the velocity.
      Problem after = problem;
      after.v = attained.v;
      outcome.energy_change_j = 0.5 * (MetricOf(after).y.squaredNorm() - metric_.y.squaredNorm()) * EnergyScale();
      outcome.work_error_j = kInfinity;
      return outcome;
    }
    in_scene = (sorted_.InScene(attained.p) * ImpulseScale()).array() + 0.0;
    outcome.impulse_n_s.assign(in_scene.begin(), in_scene.end());
    outcome.normal_impulse_error_n_s.resize(static_cast<size_t>(problem.k));
    outcome.contacts.resize(static_cast<size_t>(problem.k));
    for (int i = 0; i < problem.k; ++i) {
      const size_t place = At(sorted_.from[At(i)]);
      outcome.normal_impulse_error_n_s[place] = attained.ErrorOfNormalImpulse(problem, i) * ImpulseScale();
      outcome.contacts[place] = LedgerOf(attained, i);
    }
    const auto& errors = outcome.normal_impulse_error_n_s;
    const double largest = in_scene.cwiseAbs().maxCoeff();
    if (std::any_of(errors.begin(), errors.end(), [largest](double one) { return !(one <= largest); })) {
      outcome.normal_impulse_error_n_s.clear();
    }
    Sum change;
    for (int j = 0; j < attained.p.size(); ++j) change.Add(attained.p(j), problem.v(j) + attained.v(j));
    outcome.energy_change_j = 0.5 * change.value() * EnergyScale();
    return outcome;
  }

  void AddVelocities(const Attained& attained, AttainedOutcome& outcome) const {
    for (Eigen::Index i = 0; i < velocity_.size(); ++i) {
      const Vector row = sorted_.FromScene(Vector(reduction_.response.row(i)));
      Sum change;
      double size = std::abs(velocity_(i));
      for (int j = 0; j < row.size(); ++j) {
        change.Add(row(j), attained.p(j));
        size += std::abs(row(j) * attained.p(j)) * ImpulseScale();
      }
      outcome.velocity.push_back(velocity_(i) + change.value() * ImpulseScale());
      const double of_state = attained.ErrorOfRow(row, reduction_.mobility(i) * w_scale_) * ImpulseScale();
      outcome.velocity_error.push_back(KnownError(of_state + 4.0 * kEpsilon * size));
    }
  }

  ContactLedger LedgerOf(const Attained& attained, int i) const {
    const Problem& problem = sorted_.problem;
    const ContactWorks& works = attained.works[At(i)];
    ContactLedger ledger = {.work_compression_j = works.compression * EnergyScale(),
                            .work_restitution_j = works.restitution * EnergyScale(),
                            .work_friction_j = works.friction * EnergyScale()};
    const double before = problem.v(problem.N(i));
    if (before < 0.0) ledger.newton = -attained.v(problem.N(i)) / before;
    const double compression = works.compression_impulse;
    if (compression > 0.0) ledger.poisson = (attained.p(problem.N(i)) - compression) / compression;
    return ledger;
  }

  void AddOrders() {
    const Orders orders = FindOrders(sorted_.problem, stopped_);
    orders_complete_ = orders.complete;
    if (orders.sampled) {
      answer_.refused.push_back(
          {.method = MultiContactMethod::kOrders,
           .reason = absl::StrCat("orders beyond those that ", kOrdersBudget, " impacts can follow to their ends")});
    }
    if (orders.left_out) {
      answer_.refused.push_back(
          {.method = MultiContactMethod::kOrders,
           .reason = absl::StrCat("outcomes of orders beyond the ", kMostOutcomes, " with the fewest impacts")});
    }
    for (const DistinctOutcome& distinct : orders.outcomes) {
      AttainedOutcome& outcome = answer_.orders.emplace_back(OutcomeOf(distinct.attained));
      outcome.order_count = distinct.order_count;
      for (size_t i = 0; i < distinct.orders.size(); ++i) {
        outcome.orders.push_back(OrderText(distinct.orders[i], distinct.repeats_from[i], sorted_));
      }
    }
    // Outcomes of orders that have ended come first.
    std::sort(answer_.orders.begin(), answer_.orders.end(), [](const AttainedOutcome& x, const AttainedOutcome& y) {
      return IsAttained(x) != IsAttained(y) ? IsAttained(x) : x.orders < y.orders;
    });
  }

  void AddSprings() {
    answer_.springs = OutcomeOf(FindSprings(sorted_.problem, sorted_.mirror, stopped_));
    if (answer_.springs->end == MultiContactEnd::kBudgetUsedUp) {
      answer_.refused.push_back({.method = MultiContactMethod::kSprings,
                                 .reason = absl::StrCat("the motion on springs after its first ",
                                                        answer_.springs->events, " events, which found no end")});
    }
    if (!request_.stiffness_range.has_value()) return;
    const auto at = [&](double stiffness) {
      Problem problem = sorted_.problem;
      for (int i = 0; i < problem.k; ++i) {
        const bool is_driven = sorted_.from[At(i)] + 1 == request_.stiffness_range->contact;
        if (is_driven) problem.laws[At(i)].stiffness = stiffness / stiffness_scale_;
      }
      return OutcomeOf(FindSprings(problem, MirrorOf(problem), stopped_));
    };
    // A state before the end tells nothing about the outcome.
    const auto difference = [&](const AttainedOutcome& x, const AttainedOutcome& y) {
      return IsAttained(x) && IsAttained(y) && Differ(x, y) ? Largest(x, y).over_scale : 0.0;
    };
    StiffnessCurve curve = SampleStiffness(*request_.stiffness_range, at, difference, stopped_);
    answer_.stiffness_samples = std::move(curve.samples);
    answer_.stiffness_jumps = std::move(curve.jumps);
  }

  // The part of the velocity that rounding of W leaves beside its range; 0 where it is no more than rounding itself.
  Eigen::VectorXd BesideRange() const {
    const Problem& problem = sorted_.problem;
    Eigen::VectorXd beside = (problem.v - metric_.g * metric_.y).cwiseAbs();
    const double rounding = 64.0 * static_cast<double>(beside.size()) * kEpsilon * problem.v.cwiseAbs().maxCoeff();
    if (beside.maxCoeff() <= rounding) return Eigen::VectorXd::Zero(beside.size());
    return beside;
  }

  void AddPossible(const Eigen::VectorXd& apart) {
    std::vector<Eigen::VectorXd> gammas;
    for (const Output& output : Outputs()) gammas.push_back(output.gamma);
    const Eigen::VectorXd beside = BesideRange();
    const std::vector<Range> ranges = FindPossible(sorted_.problem, metric_, apart, gammas, stopped_);
    for (size_t i = 0; i < ranges.size(); ++i) {
      const Output& output = outputs_[i];
      const double before = output.gamma.dot(sorted_.problem.v);
      const double aside = output.gamma.cwiseAbs().dot(beside);
      const double slack = output.slack * metric_.root_energy + aside +
                           8.0 * kEpsilon * output.gamma.cwiseAbs().dot(sorted_.problem.v.cwiseAbs());
      const auto end = [&](double bound, double sign) {
        const double value = output.before + v_scale_ * (bound - before + sign * slack);
        return value + sign * 4.0 * kEpsilon * (std::abs(output.before) + std::abs(value));
      };
      // Scaling is exact but for subnormal results, which are moved outwards by the step that they may have lost.
      const auto scaled = [&](double bound, double outwards) {
        const double value = v_scale_ * (aside == 0.0 ? bound : bound + std::copysign(aside, outwards));
        const bool is_exact = bound == 0.0 || std::abs(value) >= std::numeric_limits<double>::min();
        return is_exact ? value : std::nextafter(value, outwards);
      };
      const bool is_contact = i < static_cast<size_t>(sorted_.problem.v.size());
      PossibleRange& range = answer_.possible.emplace_back(PossibleRange{.output = output.name});
      range.lower = is_contact ? scaled(ranges[i].lower, -kInfinity) : end(ranges[i].lower, -1.0);
      range.upper = is_contact ? scaled(ranges[i].upper, kInfinity) : end(ranges[i].upper, 1.0);
    }
  }

  // --- The verdict ---

  struct Difference {
    size_t output = 0;
    double value = 0.0;
    double over_scale = 0.0;
  };

  double ValueOf(const AttainedOutcome& outcome, size_t output) const {
    const auto contacts = outcome.contact_velocity_m_s.size();
    if (output < contacts) return outcome.contact_velocity_m_s[output];
    if (output < contacts + outcome.velocity.size()) return outcome.velocity[output - contacts];
    const size_t place = outputs_.size() - output;
    const std::vector<double>& coefficients = request_.outputs[request_.outputs.size() - place].coefficients;
    const std::vector<double>& velocity = outcome.velocity.empty() ? outcome.contact_velocity_m_s : outcome.velocity;
    Sum sum;
    for (size_t i = 0; i < coefficients.size(); ++i) sum.Add(coefficients[i], velocity[i]);
    return sum.value();
  }

  // The size of a velocity with this mobility in the states asked for.
  double ScaleOf(double mobility) const { return metric_.root_energy * std::sqrt(mobility) * v_scale_; }

  // Returns the output in which two outcomes differ most, over its scale.
  Difference Largest(const AttainedOutcome& x, const AttainedOutcome& y) {
    Difference largest;
    for (size_t i = 0; i < Outputs().size(); ++i) {
      const double scale = ScaleOf(outputs_[i].mobility);
      const double value = std::abs(ValueOf(x, i) - ValueOf(y, i));
      if (scale > 0.0 && value / scale > largest.over_scale) largest = {i, value, value / scale};
    }
    return largest;
  }

  // True if a contact velocity differs by more than both errors.
  static bool Differ(const AttainedOutcome& x, const AttainedOutcome& y) {
    for (size_t j = 0; j < x.contact_velocity_m_s.size(); ++j) {
      const double error = x.contact_velocity_error_m_s[j] + y.contact_velocity_error_m_s[j];
      if (std::abs(x.contact_velocity_m_s[j] - y.contact_velocity_m_s[j]) > error) return true;
    }
    return false;
  }

  static bool IsAttained(const AttainedOutcome& outcome) {
    return outcome.end == MultiContactEnd::kSeparated || outcome.end == MultiContactEnd::kEndless ||
           outcome.end == MultiContactEnd::kEndlessEstimate;
  }

  // True if the error of a contact velocity is so large that outcomes which differ may seem alike.
  bool IsVague(const AttainedOutcome* outcome) const {
    constexpr double kMostError = 1e-3;
    const double most = kMostError * ScaleOf(sorted_.problem.w.diagonal().maxCoeff());
    return std::any_of(outcome->contact_velocity_error_m_s.begin(), outcome->contact_velocity_error_m_s.end(),
                       [most](double error) { return !(error <= most); });
  }

  std::string NameOf(const AttainedOutcome& outcome) const {
    if (!outcome.orders.empty()) return outcome.orders.front();
    for (const StiffnessSample& sample : answer_.stiffness_samples) {
      if (&sample.outcome != &outcome) continue;
      return absl::StrCat(kSpringsName, " at the relative stiffness ", ShortestDecimal(sample.relative_stiffness));
    }
    return kSpringsName;
  }

  // Names the two outcomes of `x` and `y` that differ most, and returns whether any two do.
  bool Compare(const std::vector<const AttainedOutcome*>& x, const std::vector<const AttainedOutcome*>& y) {
    double most = kNoWidth;
    for (const AttainedOutcome* const one : x) {
      for (const AttainedOutcome* const other : y) {
        if (one == other || !Differ(*one, *other)) continue;
        const Difference difference = Largest(*one, *other);
        if (!(difference.over_scale > most)) continue;
        most = difference.over_scale;
        answer_.differing_output = outputs_[difference.output].name;
        answer_.difference = difference.value;
        answer_.outcome_1 = NameOf(*one);
        answer_.outcome_2 = NameOf(*other);
      }
    }
    return most > kNoWidth;
  }

  // True if two contacts give all energy back: as in a slot, an impact may then go on for ever.
  bool MayHaveNoEnd() const {
    const std::vector<ContactLaw>& laws = sorted_.problem.laws;
    return std::count_if(laws.begin(), laws.end(), [](const ContactLaw& law) { return law.e == 1.0; }) > 1;
  }

  // True if no contact affects another, none approaches, or all possible outcomes of an impact that ends are one.
  bool IsSingle(bool ends) const {
    const Problem& problem = sorted_.problem;
    bool is_alone = true, approaches = false;
    for (int i = 0; i < problem.k; ++i) {
      approaches = approaches || problem.v(problem.N(i)) < 0.0;
      for (int j = 0; j < i; ++j) is_alone = is_alone && !problem.AreCoupled(i, j);
    }
    if (is_alone || !approaches) return true;
    if (!ends) return false;
    for (size_t i = 0; i < answer_.possible.size(); ++i) {
      const double scale = ScaleOf(outputs_[i].mobility);
      if (answer_.possible[i].upper - answer_.possible[i].lower > kNoWidth * scale) return false;
    }
    return !answer_.possible.empty();
  }

  void Judge(bool has_springs) {
    std::vector<const AttainedOutcome*> orders, springs;
    bool all_end = true;
    const auto add = [&](const AttainedOutcome& outcome, std::vector<const AttainedOutcome*>& attained) {
      if (IsAttained(outcome)) attained.push_back(&outcome);
      all_end = all_end && IsAttained(outcome);
    };
    for (const AttainedOutcome& outcome : answer_.orders) add(outcome, orders);
    if (answer_.springs.has_value()) add(*answer_.springs, springs);
    for (const StiffnessSample& sample : answer_.stiffness_samples) add(sample.outcome, springs);
    const bool ends = !MayHaveNoEnd() || (all_end && orders.size() + springs.size() > 0);
    const auto is_vague = [this](const AttainedOutcome* outcome) { return IsVague(outcome); };
    const bool are_known = std::none_of(orders.begin(), orders.end(), is_vague);
    if (IsSingle(ends)) {
      answer_.verdict = MultiContactVerdict::kSingle;
    } else if (Compare(orders, orders)) {
      answer_.verdict = MultiContactVerdict::kOrderMatters;
    } else if (Compare(orders, springs)) {
      if (are_known && orders_complete_) answer_.verdict = MultiContactVerdict::kOrdersAgreeSpringsDiffer;
    } else if (are_known && !orders.empty() && orders_complete_ && (!has_springs || !springs.empty()) &&
               std::none_of(springs.begin(), springs.end(), is_vague)) {
      answer_.verdict = MultiContactVerdict::kOrdersAgree;
    }
  }

  const MultiContactRequest& request_;
  const MultiReduction& reduction_;
  const Eigen::VectorXd velocity_;
  absl::FunctionRef<bool()> stopped_;
  double w_scale_ = 1.0, v_scale_ = 1.0, stiffness_scale_ = 1.0;  // They divide the numbers of the problem.
  SortedProblem sorted_;
  EnergyMetric metric_;
  std::vector<Output> outputs_;
  bool orders_complete_ = true;
  MultiContactAnswer answer_;
};

bool IsFinite(const AttainedOutcome& outcome) {
  const auto all = [](const std::vector<double>& list) {
    return std::all_of(list.begin(), list.end(), [](double x) { return std::isfinite(x); });
  };
  return all(outcome.contact_velocity_m_s) && all(outcome.velocity) && all(outcome.impulse_n_s) &&
         std::isfinite(outcome.energy_change_j);
}

// Returns the path of a list of the answer that has a number too large for a double, or nullptr.
const char* WhatOverflows(const MultiContactAnswer& answer) {
  const auto is_finite = [](const PossibleRange& range) {
    return std::isfinite(range.lower) && std::isfinite(range.upper);
  };
  const auto has_finite_outcome = [](const StiffnessSample& sample) { return IsFinite(sample.outcome); };
  if (!std::isfinite(answer.energy_before_j)) return "answers.energy_before_j";
  if (!std::all_of(answer.orders.begin(), answer.orders.end(), IsFinite)) return "answers.orders";
  if (answer.springs.has_value() && !IsFinite(*answer.springs)) return "answers.springs";
  if (!std::all_of(answer.stiffness_samples.begin(), answer.stiffness_samples.end(), has_finite_outcome)) {
    return "answers.stiffness_samples";
  }
  if (!std::all_of(answer.possible.begin(), answer.possible.end(), is_finite)) return "answers.possible";
  return nullptr;
}

}  // namespace
}  // namespace multi

absl::StatusOr<std::vector<MultiContactAnswer>> SolveMultiContact(const MultiContactRequest& request,
                                                                  const MultiReduction& reduction,
                                                                  absl::FunctionRef<bool()> stopped) {
  if (!reduction.w.allFinite() || !reduction.response.allFinite()) return OutputOverflow("contact_matrix");
  std::vector<Eigen::VectorXd> velocities;
  for (const MultiContactState& state : request.states) {
    velocities.emplace_back(Eigen::Map<const Eigen::VectorXd>(state.velocity.data(), reduction.velocity.size()));
  }
  if (velocities.empty()) velocities.push_back(reduction.velocity);
  std::vector<MultiContactAnswer> answers;
  for (const Eigen::VectorXd& velocity : velocities) {
    if (!reduction.ContactVelocity(velocity).allFinite()) return OutputOverflow("contact_velocity_before_m_s");
    MultiContactAnswer& answer = answers.emplace_back(multi::Answerer(request, reduction, velocity, stopped).Answer());
    if (stopped()) return absl::CancelledError("stopped");
    if (const char* const path = multi::WhatOverflows(answer)) return OutputOverflow(path);
  }
  return answers;
}

}  // namespace ricochet
