// MakeOutcome: the answer of each impact model as an Outcome, but for its effective coefficients and its plan.
//
// Each writes into an outcome that is empty. The two models that have a choice of arithmetic write it into the plan.
// The reduction must be that of the problem. `tolerance` is what rounding may change (ToleranceLeft in
// core/plan/arithmetic.h). Errors are those of Complete (core/answer/outcome_parts.h): OUT_OF_RANGE names the first
// output that exceeds the largest double, INVALID_ARGUMENT each impulse of the history that is not in [0, tau1].

#ifndef RICOCHET_CORE_ANSWER_MODEL_OUTCOMES_H_
#define RICOCHET_CORE_ANSWER_MODEL_OUTCOMES_H_

#include <cstddef>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/reduction.h"
#include "core/models/compliant/compliant.h"
#include "core/models/finite_duration/finite_duration.h"
#include "core/models/pendulum/first_order.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/sliding/sliding.h"
#include "core/models/spatial/spatial.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

namespace pendulum {

absl::Status MakeOutcome(const Problem& problem, double tolerance, const OutcomeDetail& detail, Outcome& outcome);

}  // namespace pendulum

namespace first_order {

// The model must serve `problem`.
absl::Status MakeOutcome(const Problem& problem, const OutcomeDetail& detail, Outcome& outcome);

}  // namespace first_order

namespace planar {

absl::Status MakeOutcome(const Problem& problem, const PlanarReduction& reduction, double tolerance,
                         const OutcomeDetail& detail, Outcome& outcome);

}  // namespace planar

namespace sliding {

// The outcome of slip that neither stops nor turns, or of an impact without friction. `errors` are those of that model.
template <size_t kTangential>
absl::Status MakeOutcome(const Problem<kTangential>& problem, const Impact<kTangential>& impact,
                         const RelativeErrors& errors, const Reduction<kTangential>& reduction,
                         const OutcomeDetail& detail, Outcome& outcome);

}  // namespace sliding

namespace spatial {

// The path between events is not kept, so that there is no history.
absl::Status MakeOutcome(const Impact& impact, const SpatialReduction& reduction, const OutcomeDetail& detail,
                         Outcome& outcome);

Approach ApproachOf(const Problem& problem);

}  // namespace spatial

namespace compliant {

// A timeline has at most this many events; if the impact has more, it has the first ones and the end.
inline constexpr size_t kMostEvents = 8192;

// The path between two events is not linear in the normal impulse, so that there is no history.
absl::Status MakeOutcome(const Problem& problem, const PlanarReduction& reduction, const OutcomeDetail& detail,
                         Outcome& outcome);

}  // namespace compliant

namespace finite_duration {

// Histories of such an impact are in time (Problem::intervals). CANCELLED: `stopped` said true.
absl::Status MakeOutcome(const Problem& problem, const PlanarReduction& reduction, const OutcomeDetail& detail,
                         absl::FunctionRef<bool()> stopped, Outcome& outcome);

}  // namespace finite_duration

// An impact law gives the end of the impact but not its course: the regime is kByLaw, the numbers of the phases are
// unset, and the timeline has the start and the end. If a range of impulses solves the law, its ends are the
// alternatives, and a note says so. If there is no solution, the regime is kNoSolution, and nothing changes. A gain of
// energy, or a work of friction, beyond 16 eps of the energies that the impulse moves breaks its limit. `law` must be
// set.
absl::Status MakeLawOutcome(const ImpactLaw& law, const PlanarProblem& problem, const PlanarReduction& reduction,
                            const OutcomeDetail& detail, Outcome& outcome);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_MODEL_OUTCOMES_H_
