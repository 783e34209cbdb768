// Audit: what an observed impact implies, and which limits of an admissible impact it breaks.
//
// Given are the contact (W, the approach velocity v-, friction), taken as stated, and the velocity v+ after the impact
// that a simulator or an experiment has seen, each component to within +-uncertainty. Where W has full rank the impulse
// p = W^-1 (v+ - v-) is unique; the coefficients, the phases and the works are those of the contact's Coulomb path
// (core/audit/coulomb_path.h) run to the normal impulse p_n. Where W is rank deficient the audit is that of the point
// of the path nearest to v+; if that is not v+ to within the uncertainty, the impact is `unexplained`. A contact that
// does not approach is unexplained unless v+ = v-. A limit is broken if no v+ within the uncertainty keeps it: if its
// excess is above its allowance. Accuracy: the impulse, the energy and all excesses but the sharp limit's are rounded
// once from 100 bits; the coefficients and the works are exact to within the allowance of p_n. Bad input: none gets
// here; problems are valid, observations are finite. docs/theory/audit.md derives the limits, their allowances and the
// accuracy.

#ifndef RICOCHET_CORE_AUDIT_AUDIT_H_
#define RICOCHET_CORE_AUDIT_AUDIT_H_

#include <array>
#include <variant>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/spatial/spatial.h"
#include "ricochet/audit.h"

namespace ricochet::audit {

struct Observation {
  std::array<double, 2> u1 = {};  // m/s; a plane uses the first direction only.
  double v1 = 0.0;                // m/s
  double uncertainty = 0.0;       // m/s, >= 0
  // The sizes of the terms that the velocities before and after are the sums of, by whose ulp they are rounded, m/s. 0
  // if the velocities are themselves what was observed.
  std::array<double, 2> u_terms = {};
  double v_terms = 0.0;
};

using AnyProblem = std::variant<pendulum::Problem, planar::Problem, spatial::Problem>;

// Audits one impact. The law and the coefficient of restitution of the problem are not used.
// A pendulum's contact velocity is (b w, a w) for the angular velocity w after the impact, along its range of rank one.
AuditReport Audit(const pendulum::Problem& problem, const Observation& observation);
AuditReport Audit(const planar::Problem& problem, const Observation& observation);

// In space the path is integrated to the problem's tolerance. The velocity error of a simulator belongs to the
// uncertainty. Where W is rank deficient the nearest point is searched for in some hundred solutions; `stopped` is
// asked before each of them. Errors: CANCELLED once `stopped` returns true.
absl::StatusOr<AuditReport> Audit(const spatial::Problem& problem, const Observation& observation,
                                  absl::FunctionRef<bool()> stopped);
absl::StatusOr<AuditReport> Audit(const AnyProblem& problem, const Observation& observation,
                                  absl::FunctionRef<bool()> stopped);

// Returns the path, in ricochet.v1.AuditResponse, of the first number that exceeds the largest double; null if none
// does. Allowances and uncertainties may be infinite.
const char* OverflowIn(const AuditReport& report);

}  // namespace ricochet::audit

#endif  // RICOCHET_CORE_AUDIT_AUDIT_H_
