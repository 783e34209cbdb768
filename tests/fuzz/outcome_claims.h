// Outcome claims: properties that every answer has, whatever the scene. They are checked by the numbers of the answer
// alone, without the model that gave it.
//
//   status     OK; INVALID_ARGUMENT with violations, always if the scene breaks a rule; OUT_OF_RANGE;
//              FAILED_PRECONDITION if asked for
//   numbers    finite, except the error estimate
//   ledger     |sum of the works - change of energy| <= the sum of their stated errors, and s where one has none
//   energy     E+ - E- <= s under the energetic coefficient; a gain is always flagged
//   cone       |f1| <= mu_s tau1 + s_f, of Coulomb friction
//   signs      normal work of compression <= s, of restitution >= -s; both dissipations >= -s; tau1 >= 0
//              (if the request excludes that slip stops or turns, or higher orders, energy and dissipation only have to
//              flag a gain)
//   timeline   normal impulses rise from 0 to tau1
//
// s = (e + 2^-40) (V + W P) P + e V^2/Wnn and s_f = 2 (e + 2^-40) P + e V/Wnn, where e is the outcome's relative error,
// which is one of velocities, V the largest contact velocity before or after, P = tau1 + |f1|, and W the sum of the
// magnitudes of its entries. To s comes the sum of the stated errors of the works; those of the model of finite
// duration, which integrates them beside the velocities, are taken as 2^-30 of the energy that moves if it states none.
// An answer with infinite e has not converged; its numbers only have to be finite.

#ifndef RICOCHET_TESTS_FUZZ_OUTCOME_CLAIMS_H_
#define RICOCHET_TESTS_FUZZ_OUTCOME_CLAIMS_H_

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "ricochet/solver.h"

namespace ricochet {

// Both functions call Fail (tests/fuzz/fail.h) with the claim that is broken.
void CheckStatus(const absl::Status& status, bool valid_scene, bool inadmissible_is_error = false);
void CheckOutcome(const Scene& scene, const Outcome& outcome);

// Asks LocalSolver, checks the answer with CheckStatus and CheckOutcome, and returns it.
absl::StatusOr<SolveResponse> SolveAndCheck(const SolveRequest& request);

// True if the plan of the request chooses the model of finite duration.
bool TakesTime(const SolveRequest& request);

}  // namespace ricochet

#endif  // RICOCHET_TESTS_FUZZ_OUTCOME_CLAIMS_H_
