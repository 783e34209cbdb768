// CertifySolve and CertifyBounds: the numbers of a rigid planar impact, and of its bounds, proved to as many
// significant decimal digits as asked (Lubarda 2009, [10]-[31]; the planar path of core/models/planar/planar.h).
//
// Inputs are the exact numbers that the scene's doubles are. A pendulum, planar bodies and a planar_contact are
// computed in exact arithmetic (rationals and one square root), so every event, tie and regime is decided by proof. A
// linkage is computed in intervals, because of its sines and cosines; the precision doubles until all digits are proved
// or `most_bits` is reached. A tie that is open even then is answered as a set: the hull of both ways to go on.
// Coefficients that depend on speed count as the doubles that they come to. W has rank one only if its determinant is
// exactly 0, unlike in core/contact/delassus.h, which allows for rounding. Cost: microseconds to a millisecond for 50
// digits; for a linkage it grows with the cube of the number of links. docs/theory/certified.md has the derivation.

#ifndef RICOCHET_CORE_CERTIFIED_CERTIFIED_H_
#define RICOCHET_CORE_CERTIFIED_CERTIFIED_H_

#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/certificate.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {
namespace certified {

// False in a build without the component `certified`; CheckCertifiable then refuses every scene.
bool IsAvailable();

}  // namespace certified

// No linkage is computed to more bits; two numbers that agree so far count as a tie.
inline constexpr int kMostBits = 1 << 14;

struct CertifiedPrecision {
  int digits = 0;             // Significant decimal digits, in [1, kMostCertifiedDigits].
  int most_bits = kMostBits;  // Below kMostBits a linkage may be answered as a set earlier.
};

// Lists what stands against a certificate of so many digits; `scene` need not be valid.
std::vector<Violation> CheckCertifiable(const Scene& scene, int digits);

// Proves the numbers of VisitOutcomeNumbers (ricochet/outcome_numbers.h), other than the effective coefficients, the
// accuracy and the contact duration. `scene` is valid and CheckCertifiable finds nothing. `stopped` is asked before
// each entry of a linkage's matrices, each precision and each way to go on.
// Errors: INVALID_ARGUMENT for a planar_contact or a moving surface with which W is not exactly semidefinite, or
// (u0, v0) is not exactly in its range; CANCELLED once `stopped` says true.
absl::StatusOr<Certificate> CertifySolve(const Scene& scene, const CertifiedPrecision& precision,
                                         absl::FunctionRef<bool()> stopped);

// Proves friction_ratio, slope_ratio, sharp, energy_only and critical of Bounds, in the same way. The scene's
// restitution is not used.
absl::StatusOr<Certificate> CertifyBounds(const Scene& scene, const CertifiedPrecision& precision,
                                          absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CERTIFIED_CERTIFIED_H_
