#include <vector>

#include "core/answer/model_outcomes.h"
#include "core/plan/arithmetic.h"

namespace ricochet::pendulum {
namespace {

// The state of the contact at angular velocity `omega`. Each product is rounded once.
State MakeState(const Problem& problem, double tau, double omega, double tangential_impulse) {
  return {.normal_impulse_n_s = tau,
          .tangential_impulse_n_s = {tangential_impulse},
          .contact_velocity = {.tangential_m_s = {problem.b * omega + 0.0}, .normal_m_s = problem.a * omega},
          .rates_rad_s = {omega}};
}

std::vector<Event> TimelineOf(const Problem& problem, const Impact& impact) {
  std::vector<Event> timeline;
  if (impact.regime == Regime::kSeparating) return timeline;
  const State rest =
      MakeState(problem, impact[Output::kNormalImpulseCompression], 0.0, impact[Output::kTangentialImpulseCompression]);
  timeline.reserve(4);
  timeline.push_back({EventKind::kStart, MakeState(problem, 0.0, problem.omega_minus, 0.0)});
  if (problem.b != 0.0) timeline.push_back({EventKind::kSlipStops, rest});
  timeline.push_back({EventKind::kCompressionEnds, rest});
  if (impact.regime != Regime::kLocked) {
    timeline.push_back(
        {EventKind::kRestitutionEnds, MakeState(problem, impact[Output::kNormalImpulse], impact[Output::kOmegaPlus],
                                                impact[Output::kTangentialImpulse])});
  }
  return timeline;
}

WorkLedger MakeLedger(const Impact& impact) {
  WorkLedger work = ricochet::MakeLedger(impact[Output::kWorkNormalCompression], impact[Output::kWorkNormalRestitution],
                                         impact[Output::kWorkTangentialCompression],
                                         impact[Output::kWorkTangentialRestitution], impact[Output::kEnergyChange]);
  work.normal_total_j = impact[Output::kWorkNormal];
  work.tangential_total_j = impact[Output::kWorkTangential];
  work.friction_dissipation_j = 0.0 - work.tangential_total_j;
  return work;
}

void SetEnd(const Impact& impact, Outcome& outcome) {
  outcome.regime = impact.regime;
  SetLimits({.sharp_broken = impact.sharp_limit_broken,
             .energetic = impact[Output::kEnergetic],
             .energetic_excess = impact[Output::kEnergeticExcess],
             .energy_broken = impact.energy_limit_broken,
             .energy_change = impact[Output::kEnergyChange]},
            outcome);
  outcome.w_rank = 1;
  outcome.coefficients = {.newton = impact[Output::kNewton],
                          .poisson = impact[Output::kPoisson],
                          .energetic = impact[Output::kEnergetic],
                          .tangential = impact[Output::kTangentialCoefficient]};
  outcome.rates_after_rad_s = {impact[Output::kOmegaPlus]};
  outcome.contact_velocity_after = {.tangential_m_s = {impact[Output::kTangentialVelocityAfter]},
                                    .normal_m_s = impact[Output::kNormalVelocityAfter]};
  outcome.impulse = {.normal_compression_n_s = impact[Output::kNormalImpulseCompression],
                     .normal_total_n_s = impact[Output::kNormalImpulse],
                     .tangential_n_s = {impact[Output::kTangentialImpulse]}};
  outcome.work = MakeLedger(impact);
  outcome.energy_change_j = impact[Output::kEnergyChange];
}

// `error` is the proved bound for the contact velocity over max(|u0|, |v0|); `at` gives the state at tau.
absl::Status MakeOutcomeOf(const Problem& problem, const Impact& impact, double error, const ImpactErrors& errors,
                           Instant (*at)(const Problem& problem, double tau), const OutcomeDetail& detail,
                           Outcome& outcome) {
  const bool separates = impact.regime == Regime::kSeparating;
  SetEnd(impact, outcome);
  // Where the contact separates, its velocity is a product that was rounded once.
  outcome.accuracy = {.relative_error = separates ? 0x1p-53 : error, .kind = AccuracyKind::kBound};
  SetErrors(errors, outcome);
  const auto state_at = [&](double tau) {
    if (separates) return MakeState(problem, tau, problem.omega_minus, 0.0);
    const Instant instant = at(problem, tau);
    return MakeState(problem, tau, instant.omega, instant.tangential_impulse);
  };
  return Complete(
      detail, [&] { return TimelineOf(problem, impact); }, state_at, outcome);
}

}  // namespace

absl::Status MakeOutcome(const Problem& problem, double tolerance, const OutcomeDetail& detail, Outcome& outcome) {
  const SolvedImpact<Impact> solved = SolveWithin(problem, tolerance);
  outcome.plan.arithmetic = solved.arithmetic;
  return MakeOutcomeOf(problem, solved.impact, solved.relative_error(), solved.errors, At, detail, outcome);
}

}  // namespace ricochet::pendulum

namespace ricochet::first_order {

absl::Status MakeOutcome(const Problem& problem, const OutcomeDetail& detail, Outcome& outcome) {
  const Impact impact = first_order::Solve(problem);
  return pendulum::MakeOutcomeOf(problem, impact, ErrorsOf(problem).velocity, NumberErrorsOf(problem, impact),
                                 first_order::At, detail, outcome);
}

}  // namespace ricochet::first_order
