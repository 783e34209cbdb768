// MakeLawOutcome: the answer of an impact law (core/models/laws/impact_laws.h) as an Outcome.
//
// A law gives the end of the impact but not its course. The regime is kByLaw, works and impulses of the phases are not
// known, only Newton's and Brach's coefficients are, and the timeline has the start and the end. The first solution is
// the outcome; if there are several, all of them are its alternatives. If there is none, the regime is kNoSolution,
// there is no impulse, and nothing changes.
// A gain of energy beyond 16 eps of the energies that the impulse moves breaks the energy limit.

#ifndef RICOCHET_CORE_ANSWER_LAW_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_LAW_OUTCOME_H_

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/reduction.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// `law` must be set; `mu` is the coefficient of kinetic friction.
// Errors: OUT_OF_RANGE names the first output that exceeds the largest double; INVALID_ARGUMENT if
// `history_at_n_s` is not empty.
absl::StatusOr<Outcome> MakeLawOutcome(const ImpactLaw& law, double mu, const PlanarReduction& reduction,
                                       absl::Span<const double> history_at_n_s, Detail detail = Detail::kAll);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_LAW_OUTCOME_H_
