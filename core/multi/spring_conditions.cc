#include "core/multi/spring_conditions.h"

#include <algorithm>
#include <cmath>

namespace ricochet::multi {
namespace {

// Sets to 0 a coefficient that an event made 0. It may exceed rounding if another mode divides friction differently.
void TakeForZero(size_t m, Series& series) {
  double largest = 0.0;
  for (const double c : series.c) largest = std::max(largest, std::abs(c));
  if (std::abs(series.c[m]) <= kZeroOfEvent * largest) series.c[m] = 0.0;
}

}  // namespace

std::vector<Condition> ConditionsOf(const Problem& problem, const Modes& modes, const SpringFlow& flow,
                                    const std::optional<Event>& event) {
  std::vector<Condition> conditions;
  // Adds the condition that `sign` times the series stays >= 0.
  const auto add = [&](int contact, Keeps keeps, double sign, const Series& series) {
    Condition& condition = conditions.emplace_back(Condition{.contact = contact, .keeps = keeps, .series = series});
    if (sign < 0.0) {
      for (double& c : condition.series.c) c = -c;
    }
    const bool is_event = event.has_value() && event->contacts[At(contact)] && event->keeps == keeps;
    const bool has_tie = event.has_value() && event->has_tie;
    if (is_event || (has_tie && IsCone(keeps))) TakeForZero(0, condition.series);
    // Slip that starts where all friction is used up has no acceleration at first.
    if (has_tie && keeps == Keeps::kSlip) TakeForZero(1, condition.series);
    condition.lead = condition.series.Lead();
  };
  for (int i = 0; i < problem.k; ++i) {
    const ContactMode mode = modes[At(i)];
    switch (mode.normal) {
      case NormalMode::kOpen:
        add(i, Keeps::kGap, 1.0, flow.gap(i));
        continue;
      case NormalMode::kLoading:
        add(i, Keeps::kApproaching, -1.0, flow.velocity(2 * i + 1));
        break;
      case NormalMode::kUnloading:
        add(i, Keeps::kParting, 1.0, flow.velocity(2 * i + 1));
        add(i, Keeps::kPressed, 1.0, flow.force(i));
        break;
    }
    const double mu = problem.laws[At(i)].mu;
    if (mu == 0.0) continue;
    if (mode.slip != 0) {
      add(i, Keeps::kSlip, mode.slip, flow.velocity(2 * i));
      continue;
    }
    // Where a contact sticks, friction stays below mu F in both directions.
    const Series tau = flow.Friction(i);
    Series above = flow.force(i), below = flow.force(i);
    for (size_t m = 0; m <= kSeriesOrder; ++m) {
      above.c[m] = mu * above.c[m] - tau.c[m];
      below.c[m] = mu * below.c[m] + tau.c[m];
      above.noise[m] = below.noise[m] = mu * above.noise[m] + tau.noise[m];
    }
    add(i, Keeps::kConeAbove, 1.0, above);
    add(i, Keeps::kConeBelow, 1.0, below);
  }
  return conditions;
}

bool Falls(const Condition& condition, const Problem& problem, const SpringState& state) {
  return condition.keeps == Keeps::kApproaching && condition.lead > 0 && state.f[At(condition.contact)] > 0.0 &&
         problem.laws[At(condition.contact)].e == 0.0;
}

const Condition* Broken(const std::vector<Condition>& conditions, const Problem& problem, const SpringState& state) {
  const Condition* broken = nullptr;
  for (const Condition& condition : conditions) {
    if (condition.lead > kSeriesOrder || condition.series.c[At(condition.lead)] > 0.0) continue;
    if (Falls(condition, problem, state)) continue;
    if (broken == nullptr || condition.lead < broken->lead) broken = &condition;
  }
  return broken;
}

void Change(const Condition& broken, double force, ContactMode& mode) {
  switch (broken.keeps) {
    case Keeps::kGap:
    case Keeps::kParting:
      mode.normal = NormalMode::kLoading;
      return;
    case Keeps::kPressed:
      mode.normal = NormalMode::kOpen;
      return;
    case Keeps::kApproaching:
      mode.normal = force > 0.0 ? NormalMode::kUnloading : NormalMode::kOpen;
      return;
    case Keeps::kSlip:
      mode.slip = static_cast<int8_t>(broken.lead == 0 ? -mode.slip : 0);
      return;
    case Keeps::kConeAbove:
      mode.slip = -1;
      return;
    case Keeps::kConeBelow:
      mode.slip = 1;
      return;
  }
}

}  // namespace ricochet::multi
