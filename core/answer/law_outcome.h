// The answer of a comparison law (core/models/laws/impact_laws.h) as an Outcome.
//
// A law says how the impact ends, not how it goes on: regime kByLaw, the work and the impulse of the phases 0, Newton's
// coefficient and Brach's alone, a timeline of start and end. The first solution is the outcome; where there are
// several, all of them are its alternatives. Without any: regime kNoSolution, no impulse, nothing changes.
// An energy gained beyond 16 eps of the energies that the impulse moves breaks the energy limit.

#ifndef RICOCHET_CORE_ANSWER_LAW_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_LAW_OUTCOME_H_

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/reduction.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// `law` is set; `mu` is the coefficient of kinetic friction.
// Errors: OUT_OF_RANGE naming the first output that exceeds the largest double; INVALID_ARGUMENT if
// `history_at_n_s` is not empty.
absl::StatusOr<Outcome> MakeLawOutcome(const ImpactLaw& law, double mu, const PlanarReduction& reduction,
                                       absl::Span<const double> history_at_n_s, Detail detail = Detail::kAll);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_LAW_OUTCOME_H_
