// Certified answers: the numbers of an impact and of its bounds, proved to as many significant digits as asked.
//
// The path of a planar impact (core/models/planar/planar.h) from a pendulum's a, b, J, w- or a contact's W, u0, v0 and from
// mu, mu_s and the coefficient of restitution, all as the exact numbers that the doubles are:
//
//   pendulum, planar_body, body_pair.planar, planar_contact   exact arithmetic with rationals and one square root
//   linkage                                                   intervals at rising precision, for its sines and cosines
//   inputs that are ranges                                    intervals over a partition of the box of inputs
//
// Exact: every branch of the path compares numbers that are rational in the inputs - mu_s |b| with a, |Wtn| with
// mu_s Wtt, det W with 0, where slip stops with where compression ends or restitution does, energetic restitution too,
// whose impulse alone takes a root - so that every event, tie and regime is decided by proof, and a number is 0 or has
// all its digits. x = mu |b|/a = 1 locks. Only reading off the digits is done to a finite precision (precision_bits).
//
// Rank: a pendulum's W has rank one by construction, so has that of a linkage with parallel links; that of bodies has
// rank two. planar_contact's W is what its doubles say: rank one only if Wtt Wnn = Wtn^2 exactly. The model in doubles
// (core/models/planar/planar.h) takes a W within 4 eps of rank one for one of rank one, because that is how far rounding takes
// a pendulum's; a certificate must not guess what was meant, so there the two may differ widely. A W below rank one by
// rounding is refused, and so is a (u0, v0) not exactly in the range of a W of rank one: such a contact is better
// stated as the system it comes from.
//
// Linkage: precision doubles until all digits are proved, but not beyond `most_bits`. What is then still open (a tie in
// numbers that are not rational) is answered as a set: for each open branch both ways are followed, and each number is
// the hull of all of them. Where branches meet continuously, as the ends of restitution do, the hull is as narrow as
// the precision.
//
// A scene's coefficients that depend on speed are taken as the doubles they come to; so is friction's factor.
// Effects beyond rigid contact in a plane are refused: systems in space, impact laws, compliance and finite forces.
// Bad input: none gets here but what CheckCertifiable finds and what the Certify functions refuse.
// Cost: microseconds to a millisecond for 50 digits, but for linkages, where it grows with the cube of the links.

#ifndef RICOCHET_CORE_CERTIFIED_CERTIFIED_H_
#define RICOCHET_CORE_CERTIFIED_CERTIFIED_H_

#include <vector>

#include "absl/status/statusor.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "ricochet/bounds.h"
#include "ricochet/certificate.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

// No linkage is computed to more bits: what cancels beyond is a tie.
inline constexpr int kMostBits = 1 << 14;
// Into how many boxes the inputs of a set are parted at most.
inline constexpr int kMostSetBoxes = 256;

// What stands against a certificate of so many digits; `scene` need not be valid.
std::vector<Violation> CheckCertifiable(const Scene& scene, int digits);

// The numbers of VisitOutcomeNumbers but the effective coefficients, accuracy and contact duration. `scene` is valid
// and CheckCertifiable finds nothing.
// Errors: INVALID_ARGUMENT for a planar_contact or a moving surface with which W is not semidefinite, or (u0, v0) not
// in its range, exactly.
absl::StatusOr<Certificate> CertifySolve(const Scene& scene, int digits, int most_bits = kMostBits);

// friction_ratio, slope_ratio, sharp, energy_only and critical of Bounds, likewise; the scene's restitution is not
// used.
absl::StatusOr<Certificate> CertifyBounds(const Scene& scene, int digits, int most_bits = kMostBits);

// Inputs that are ranges, lower <= upper, of valid values.
struct PendulumSet {
  Range inertia, a, b, omega_minus, mu, mu_static;
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  Range coefficient;
};
struct ContactSet {
  Range wtt, wtn, wnn, u0, v0, mu, mu_static;
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  Range coefficient;
};

// Each number's hull, and the regimes that could not be excluded: an outer set of all that the inputs can come to, not
// the smallest. An end is infinite where none was found. Where W may be of rank one, (u0, v0) is taken to be in its
// range. Ranges that are all single numbers are answered as a scene of these is.
// Errors: INVALID_ARGUMENT if no W of the set is positive semidefinite, and those of CertifySolve for single numbers.
absl::StatusOr<Certificate> CertifySolve(const PendulumSet& set, int digits);
absl::StatusOr<Certificate> CertifySolve(const ContactSet& set, int digits);
absl::StatusOr<Certificate> CertifyBounds(const PendulumSet& set, int digits);
absl::StatusOr<Certificate> CertifyBounds(const ContactSet& set, int digits);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CERTIFIED_CERTIFIED_H_
