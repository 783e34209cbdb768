// What every answer keeps, whatever the scene; by the answer's numbers alone, not by the model that gave it.
//
//   status     OK; INVALID_ARGUMENT with violations, always if the scene breaks a rule; OUT_OF_RANGE;
//              FAILED_PRECONDITION if asked for
//   numbers    finite, the error estimate apart
//   ledger     |sum of the works - change of energy| <= s
//   energy     E+ - E- <= s under the energetic coefficient; a gain is always flagged
//   cone       |f1| <= mu_s tau1 + s_f, of Coulomb friction
//   signs      normal work of compression <= s, of restitution >= -s; both dissipations >= -s; tau1 >= 0
//   timeline   normal impulses rise from 0 to tau1
//
// s = (relative_error + 2^-40) V P, V the largest contact velocity before or after, P = |tau1| + |f1| the impulse; what
// P W P, a product of two roundings more, adds near singular W is added. s_f is s over V. Both are 0 for no impact.

#ifndef RICOCHET_TESTS_FUZZ_OUTCOME_CLAIMS_H_
#define RICOCHET_TESTS_FUZZ_OUTCOME_CLAIMS_H_

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/solver.h"

namespace ricochet {

// Both Fail (tests/fuzz/fail.h) with the claim that is broken.
void CheckStatus(const absl::Status& status, bool valid_scene, bool inadmissible_is_error = false);
void CheckOutcome(const Scene& scene, const Outcome& outcome);

// CheckStatus and CheckOutcome of what LocalSolver answers, which is returned.
absl::StatusOr<SolveResponse> SolveAndCheck(const SolveRequest& request);

// Whether the plan of a request chooses the model of finite duration.
bool TakesTime(SolveRequest request);

}  // namespace ricochet

#endif  // RICOCHET_TESTS_FUZZ_OUTCOME_CLAIMS_H_
