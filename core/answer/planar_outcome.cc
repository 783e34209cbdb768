#include <cmath>

#include "core/answer/model_outcomes.h"
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

absl::Status MakeOutcome(const Problem& problem, const PlanarReduction& reduction, const Extent& extent,
                         Outcome& outcome) {
  const Impact impact = Solve(problem);
  SetEnd(impact, reduction, 0.0, outcome);
  outcome.accuracy = AccuracyOf(problem, reduction, impact);
  const auto state_at = [&](double tau) { return MakeState(reduction, At(problem, impact, tau)); };
  return Complete(
      extent, [&] { return MakeTimeline(impact, reduction); }, state_at, outcome);
}

}  // namespace ricochet::planar
