// AnswerSolve, AnswerBounds: the numbers of an answer with their paths, in a fixed order, over a number type N
// (core/certified/branches.h).

#ifndef RICOCHET_CORE_CERTIFIED_ANSWERS_H_
#define RICOCHET_CORE_CERTIFIED_ANSWERS_H_

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/certified/contact_path.h"
#include "core/certified/system.h"
#include "core/contact/critical_friction.h"
#include "core/models/restitution_law.h"

namespace ricochet::certified {

template <typename N>
struct NamedNumber {
  std::string path;
  std::optional<Number<N>> number;  // Absent if no coefficient of friction is critical in this way.
};

template <typename N>
struct Answer {
  Regime regime = Regime::kUnspecified;
  std::vector<NamedNumber<N>> numbers;

  void Add(std::string path, N value) { numbers.push_back({std::move(path), Number<N>{std::move(value)}}); }
  void Add(std::string path, Number<N> number) { numbers.push_back({std::move(path), std::move(number)}); }
};

// The regimes of a pendulum have names of their own.
inline Regime PendulumRegime(Regime regime) {
  const bool shared = regime == Regime::kLocked || regime == Regime::kFrictionless || regime == Regime::kSeparating;
  return shared ? regime : Regime::kRebound;
}

// Adds the system's own velocities after the impact.
template <typename N>
void AddVelocities(const SystemContact<N>& system, const Impact<N>& impact, Answer<N>& answer) {
  std::vector<N> after;
  for (size_t i = 0; i < system.before.size(); ++i) {
    after.push_back(system.before[i] + system.response[i][0] * impact.f1 + system.response[i][1] * impact.tau1);
  }
  if (system.lever.has_value()) after = {impact.v1 / *system.lever};
  if (system.velocities == Velocities::kRates) {
    for (size_t i = 0; i < after.size(); ++i) answer.Add(absl::StrCat("rates_after_rad_s[", i, "]"), after[i]);
  }
  if (system.velocities != Velocities::kBodies) return;
  for (size_t body = 0; 3 * body < after.size(); ++body) {
    const std::string path = absl::StrCat("bodies_after[", body, "].");
    answer.Add(absl::StrCat(path, "linear_m_s[0]"), after[3 * body]);
    answer.Add(absl::StrCat(path, "linear_m_s[1]"), after[3 * body + 1]);
    answer.Add(absl::StrCat(path, "angular_rad_s[0]"), after[3 * body + 2]);
  }
}

// A contact that separates has no impact: nothing changes, and all other numbers are 0.
template <typename N>
Impact<N> SeparatingImpact(const Contact<N>& contact) {
  return {.regime = Regime::kSeparating, .u1 = contact.u0, .v1 = contact.v0};
}

// Gives the numbers of Outcome that the impact alone decides, in the order of VisitOutcomeNumbers.
template <typename N>
Answer<N> AnswerSolve(SystemContact<N> system, Branches& branches) {
  Contact<N>& contact = system.contact;
  const bool separating = !IsNegative(contact.v0, branches);
  if (!separating) contact.v0 = AtMostZero(contact.v0);
  const Impact<N> impact = separating ? SeparatingImpact(contact)
                                      : ContactPath<N>(contact, branches).Solve(contact.law, contact.coefficient);
  const N tangential_total = impact.tangential_compression + impact.tangential_restitution;
  Answer<N> answer;
  answer.regime = system.is_pendulum ? PendulumRegime(impact.regime) : impact.regime;
  answer.Add("coefficients.newton", impact.newton);
  answer.Add("coefficients.poisson", impact.poisson);
  answer.Add("coefficients.energetic", impact.energetic);
  answer.Add("coefficients.tangential", impact.tangential);
  AddVelocities(system, impact, answer);
  answer.Add("contact_velocity_after.tangential_m_s[0]", impact.u1);
  answer.Add("contact_velocity_after.normal_m_s", impact.v1);
  answer.Add("impulse.normal_compression_n_s", impact.tau_compression);
  answer.Add("impulse.normal_total_n_s", impact.tau1);
  answer.Add("impulse.tangential_n_s[0]", impact.f1);
  answer.Add("work.normal_compression_j", impact.normal_compression);
  answer.Add("work.normal_restitution_j", impact.normal_restitution);
  answer.Add("work.tangential_compression_j", impact.tangential_compression);
  answer.Add("work.tangential_restitution_j", impact.tangential_restitution);
  answer.Add("work.normal_total_j", impact.normal_total);
  answer.Add("work.tangential_total_j", tangential_total);
  answer.Add("work.friction_dissipation_j", -tangential_total);
  answer.Add("work.tangential_spring_j", N(0.0));
  answer.Add("energy_change_j", impact.normal_total + tangential_total);
  return answer;
}

template <typename N>
struct NumberRange {
  Number<N> lower, upper;
};

template <typename N>
struct RangesOfCoefficients {
  NumberRange<N> newton, poisson, energetic, tangential, normal_total;
};

template <typename N>
NumberRange<N> UpTo(Number<N> upper) {
  return {{N(0.0)}, std::move(upper)};
}

template <typename N>
NumberRange<N> Between(const N& x, const N& y) {
  return {{Min(x, y)}, {Max(x, y)}};
}

template <typename N>
void AddRanges(const std::string& prefix, const RangesOfCoefficients<N>& ranges, Answer<N>& answer) {
  const std::pair<const char*, const NumberRange<N>&> named[] = {{"newton", ranges.newton},
                                                                 {"poisson", ranges.poisson},
                                                                 {"energetic", ranges.energetic},
                                                                 {"tangential", ranges.tangential},
                                                                 {"normal_total_n_s", ranges.normal_total}};
  for (const auto& [name, range] : named) {
    answer.Add(absl::StrCat(prefix, name, ".lower"), range.lower);
    answer.Add(absl::StrCat(prefix, name, ".upper"), range.upper);
  }
}

template <typename N>
struct CriticalFrictionOf {
  std::optional<N> stick, stop_compression, stop, reversal, jam;
};

template <typename N>
CriticalFrictionOf<N> FindCriticalFriction(const Contact<N>& contact, Branches& branches) {
  if (!contact.rank_one) {
    return ricochet::FindCriticalFriction<CriticalFrictionOf<N>>(contact.wtt, contact.wtn, contact.wnn, contact.u0,
                                                                 contact.v0, true,
                                                                 [&](const N& x) { return IsPositive(x, branches); });
  }
  CriticalFrictionOf<N> critical;
  if (!IsPositive(Abs(contact.rho), branches)) return critical;
  critical.stick = N(1.0) / Abs(contact.rho);
  critical.stop = critical.reversal = N(0.0);
  return critical;
}

template <typename N>
void AddCriticalFriction(const CriticalFrictionOf<N>& critical, Answer<N>& answer) {
  const auto add = [&](const char* path, const std::optional<N>& friction) {
    answer.numbers.push_back({path, std::nullopt});
    if (friction.has_value()) answer.numbers.back().number = Number<N>{*friction};
  };
  add("critical.stick", critical.stick);
  add("critical.stop_compression", critical.stop_compression);
  add("critical.stop", critical.stop);
  add("critical.reversal", critical.reversal);
  add("critical.jam", critical.jam);
}

// Adds the pendulum's x = mu |b|/a and r = (1 - x)/(1 + x).
template <typename N>
void AddRatios(const Contact<N>& contact, Answer<N>& answer) {
  const N x = contact.mu * Abs(contact.rho);
  answer.Add("friction_ratio", x);
  answer.Add("slope_ratio", N(2.0) / (N(1.0) + x) - N(1.0));
}

template <typename N>
struct BothRanges {
  Regime regime = Regime::kUnspecified;
  RangesOfCoefficients<N> sharp, energy_only;
};

// Gives the ranges for a contact that approaches.
template <typename N>
BothRanges<N> RangesOf(const Contact<N>& contact, Branches& branches) {
  const N one(1.0);
  ContactPath<N> path(contact, branches);
  const Impact<N> plastic = path.Solve(RestitutionLaw::kEnergetic, N(0.0));
  const Impact<N> elastic = path.Solve(RestitutionLaw::kEnergetic, one);
  BothRanges<N> ranges = {.regime = elastic.regime};
  ranges.sharp = {.newton = UpTo<N>({elastic.newton}),
                  .poisson = UpTo<N>({elastic.poisson}),
                  .energetic = UpTo<N>({path.locked() ? N(0.0) : one}),
                  .tangential = Between(plastic.tangential, elastic.tangential),
                  .normal_total = {{plastic.tau1}, {elastic.tau1}}};
  ranges.energy_only = ranges.sharp;
  if (path.locked()) return ranges;
  const EnergyEnd<N> end = path.FindEnergyEnd();
  ranges.energy_only = {.newton = UpTo<N>({end.newton}),
                        .poisson = UpTo<N>({end.poisson}),
                        .energetic = UpTo<N>(end.energetic),
                        .tangential = Between(plastic.tangential, end.tangential),
                        .normal_total = {{plastic.tau1}, {end.tau}}};
  return ranges;
}

// Gives the ranges for a contact that separates: all are 0. The coefficients of a pendulum do not depend on its speed,
// so they are answered for one that leaves, too.
template <typename N>
BothRanges<N> RangesWhereSeparating(Contact<N> contact, bool is_pendulum, Branches& branches) {
  BothRanges<N> ranges;
  if (is_pendulum) {
    contact.v0 = N(-1.0);
    contact.u0 = -contact.rho;
    ranges = RangesOf(contact, branches);
    ranges.sharp.normal_total = ranges.energy_only.normal_total = NumberRange<N>();
  }
  ranges.regime = Regime::kSeparating;
  return ranges;
}

// Gives the numbers of Bounds other than the first-order ones, which are approximate by nature.
template <typename N>
Answer<N> AnswerBounds(SystemContact<N> system, Branches& branches) {
  Contact<N>& contact = system.contact;
  const bool is_pendulum = system.is_pendulum;
  Answer<N> answer;
  if (is_pendulum) AddRatios(contact, answer);
  const bool separating = !IsNegative(contact.v0, branches);
  if (!separating) contact.v0 = AtMostZero(contact.v0);
  const BothRanges<N> ranges =
      separating ? RangesWhereSeparating(contact, is_pendulum, branches) : RangesOf(contact, branches);
  answer.regime = is_pendulum ? PendulumRegime(ranges.regime) : ranges.regime;
  AddRanges("sharp.", ranges.sharp, answer);
  AddRanges("energy_only.", ranges.energy_only, answer);
  AddCriticalFriction(separating ? CriticalFrictionOf<N>() : FindCriticalFriction(contact, branches), answer);
  return answer;
}

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_ANSWERS_H_
