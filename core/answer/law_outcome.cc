#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/answer/model_outcomes.h"
#include "core/base/decimal.h"
#include "core/models/laws/impact_law.h"

namespace ricochet {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Regime RegimeOf(const PlanarReduction& reduction, const laws::ImpactLawResult& result) {
  if (reduction.v0 >= 0.0) return Regime::kSeparating;
  return result.solutions.empty() ? Regime::kNoSolution : Regime::kByLaw;
}

ImpactSolution ToOutcome(const laws::ImpactSolution& solution) {
  return {
      .contact_velocity_after = {.tangential_m_s = {solution.u1}, .normal_m_s = solution.v1},
      .impulse = {
          .normal_compression_n_s = std::nullopt, .normal_total_n_s = solution.tau1, .tangential_n_s = {solution.f}}};
}

WorkLedger LedgerOf(const PlanarReduction& reduction, const laws::ImpactSolution& solution) {
  WorkLedger work;
  work.normal_total_j = solution.tau1 * (0.5 * (reduction.v0 + solution.v1));
  work.tangential_total_j = solution.f * (0.5 * (reduction.u0[0] + solution.u1));
  work.friction_dissipation_j = 0.0 - work.tangential_total_j;
  work.residual_j = work.normal_total_j + work.tangential_total_j - solution.energy_change;
  return work;
}

// Returns the change of energy that rounding alone can cause.
double EnergyOfRounding(const PlanarReduction& reduction, const laws::ImpactSolution& solution) {
  const double moved = std::abs(solution.tau1) * (std::abs(reduction.v0) + std::abs(solution.v1)) +
                       std::abs(solution.f) * (std::abs(reduction.u0[0]) + std::abs(solution.u1));
  return 16.0 * kEpsilon * moved;
}

void SetBrokenLimits(const PlanarReduction& reduction, const laws::ImpactSolution& solution, Outcome& outcome) {
  const double rounding = EnergyOfRounding(reduction, solution);
  const double friction_work = outcome.work.tangential_total_j;
  SetLimits({.energy_broken = solution.energy_change > rounding,
             .energy_change = solution.energy_change,
             .friction_broken = friction_work > rounding,
             .friction_work = friction_work},
            outcome);
}

// Adds the ends of the range of solutions, if there is one.
void AddAlternatives(const laws::ImpactLawResult& result, Outcome& outcome) {
  if (result.ends.empty()) return;
  for (const laws::ImpactSolution& each : result.ends) outcome.alternatives.push_back(ToOutcome(each));
  const bool is_bounded = result.ends.size() > 1;
  outcome.notes.push_back(
      {.kind = NoteKind::kManySolutions,
       .path = "impulse",
       .text =
           absl::StrCat("A range of impulses solves the law with the same velocities and the same energy, from f = ",
                        ShortestDecimal(result.ends.front().f), " N s ",
                        is_bounded ? absl::StrCat("to ", ShortestDecimal(result.ends.back().f), " N s")
                                   : std::string("on without limit"),
                        "; the answer is the one whose friction does the least work.")});
}

std::vector<Event> TimelineOf(const PlanarReduction& reduction, Regime regime, const laws::ImpactSolution& solution) {
  if (regime != Regime::kByLaw) return {};
  return {
      {EventKind::kStart, MakeState<1>(reduction, 0.0, {0.0}, reduction.u0, reduction.v0)},
      {EventKind::kRestitutionEnds, MakeState<1>(reduction, solution.tau1, {solution.f}, {solution.u1}, solution.v1)}};
}

}  // namespace

absl::Status MakeLawOutcome(const ImpactLaw& law, const PlanarProblem& problem, const PlanarReduction& reduction,
                            const OutcomeDetail& detail, Outcome& outcome) {
  const laws::ImpactLawResult result = laws::SolveLaw(law, problem);
  outcome.regime = RegimeOf(reduction, result);
  if (outcome.regime == Regime::kNoSolution) {
    outcome.termination = Termination::kRefused;
    outcome.accuracy.relative_error = std::numeric_limits<double>::infinity();
    outcome.coefficients.newton = -1.0;  // The velocity stays as it is.
  }
  laws::ImpactSolution solution = {.u1 = reduction.u0[0], .v1 = reduction.v0};
  if (outcome.regime == Regime::kByLaw) {
    solution = result.solutions.front();
    outcome.coefficients.newton = 0.0 - solution.v1 / reduction.v0;
    outcome.coefficients.tangential = solution.tau1 == 0.0 ? 0.0 : solution.f / solution.tau1;
    outcome.accuracy.relative_error = laws::RelativeErrorOf(law, problem, solution);
  }
  outcome.accuracy.kind = AccuracyKind::kEstimate;
  outcome.w_rank = problem.w.Rank();
  SetVelocities<1>(reduction, {solution.f}, solution.tau1, 0.0, outcome);
  const ImpactSolution first = ToOutcome(solution);
  outcome.contact_velocity_after = first.contact_velocity_after;
  outcome.impulse = first.impulse;
  outcome.work = LedgerOf(reduction, solution);
  UnsetPhases(outcome);
  outcome.energy_change_j = solution.energy_change;
  SetBrokenLimits(reduction, solution, outcome);
  if (!detail.numbers_only) AddAlternatives(result, outcome);
  return Complete(
      detail, [&] { return TimelineOf(reduction, outcome.regime, solution); }, NoPath, outcome);
}

}  // namespace ricochet
