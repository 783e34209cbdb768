#include "core/answer/planar_outcome.h"

#include <cmath>

#include "core/numerics/determinant.h"

namespace ricochet::planar {
namespace {

// Errors of the velocities, and where W is near to rank one: what the tests of this model hold it to.
constexpr double kError = 1e-13;
constexpr double kNearlySingular = 1e-6;
constexpr double kNearlySingularError = 1e-9;

Accuracy AccuracyOf(const Problem& problem, const PlanarReduction& reduction, const Impact& impact) {
  Accuracy accuracy = {.kind = AccuracyKind::kEstimate};
  if (impact.regime == Regime::kSeparating) return accuracy;
  const double det = std::abs(RelativeDeterminant(problem.w.tt, problem.w.tn, problem.w.nn));
  const double error = impact.w_rank > 1 && det < kNearlySingular ? kNearlySingularError : kError;
  accuracy.relative_error = RelativeToBefore<1>(error, reduction, {impact.u1}, impact.v1);
  return accuracy;
}

}  // namespace

absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const PlanarReduction& reduction,
                                    absl::Span<const double> history_at_n_s, Detail detail) {
  const Impact impact = Solve(problem);
  Outcome outcome = MakeEnd(impact, reduction);
  outcome.accuracy = AccuracyOf(problem, reduction, impact);
  if (detail == Detail::kNumbers) return outcome;
  outcome.timeline = MakeTimeline(impact, reduction);
  const absl::Status finite = CheckFinite(outcome);
  if (!finite.ok()) return finite;
  const auto violations = CheckHistory(history_at_n_s, impact.tau1);
  if (!violations.empty()) return InvalidRequest(violations);
  for (const double tau : history_at_n_s) {
    outcome.history.push_back(MakeState(reduction, At(problem, impact, tau)));
  }
  return outcome;
}

}  // namespace ricochet::planar
