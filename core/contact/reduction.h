// Reduction: everything that the impact of a system at one point depends on, and the way back.
//
//   W = J M^-1 J^T,   (u0, v0) = J q' - surface velocity,   q'+ = q' + M^-1 J^T (f, tau)
//
// M is the mass matrix, J the Jacobian of the contact point, q' the generalised velocities: a pendulum's or linkage's
// rates, a body's velocity and angular velocity. W is the Gram matrix of L^-1 J^T, L L^T = M, so that it is positive
// semidefinite to rounding; a planar W whose determinant rounding could have made (below 8 n eps Wtt Wnn, n velocities)
// has rank one, and wtn = +-sqrt(Wtt Wnn) says so exactly.
// Accuracy: a few n ulp times the condition of M with its rows scaled to a unit diagonal.
// Bad input: none gets here (core/scene/validate.h). Overflow shows as a W or velocity that is not finite.

#ifndef RICOCHET_CORE_CONTACT_REDUCTION_H_
#define RICOCHET_CORE_CONTACT_REDUCTION_H_

#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include "ricochet/scene.h"

namespace ricochet {

// What the generalised velocities are.
enum class Coordinates {
  kNone,    // The system is a contact alone.
  kRates,   // Angular velocities: pendulum, linkage.
  kBodies,  // Each body's linear velocity, then its angular velocity: 3 numbers a body in a plane, 6 in space.
};

template <size_t kTangential>
struct Reduction {
  static constexpr size_t kDirections = kTangential + 1;  // The last is n.

  std::array<double, kDirections*(kDirections + 1) / 2> w = {};  // Upper triangle, row by row.
  std::array<double, kTangential> u0 = {};                       // Relative to the surface.
  double v0 = 0.0;
  Coordinates coordinates = Coordinates::kNone;
  std::vector<double> before;    // q'
  std::vector<double> response;  // M^-1 J^T, row by row.
  // What finite forces alone give the contact and the system: (a_t, a_n) and q'' = M^-1 Q. The latter is empty where
  // there are none.
  std::array<double, kDirections> acceleration = {};
  std::vector<double> drift;

  // q' once the contact has received the impulse, and finite forces have acted for `duration`.
  std::vector<double> After(const std::array<double, kTangential>& tangential, double normal,
                            double duration = 0.0) const;
};

using PlanarReduction = Reduction<1>;   // w: tt, tn, nn
using SpatialReduction = Reduction<2>;  // w: 11, 12, 13, 22, 23, 33
using AnyReduction = std::variant<PlanarReduction, SpatialReduction>;

// `scene` states a system whose own rules hold. Any impact law and restitution.
AnyReduction Reduce(const Scene& scene);

// Whether W and the velocities are finite.
bool IsFinite(const AnyReduction& reduction);

// Whether doubles hold what an impact needs: both are finite, and W_nn has not underflowed to 0 where the contact
// approaches.
bool FitsDoubles(const AnyReduction& reduction);

// How fast the contact approaches, >= 0.
double ApproachSpeed(const AnyReduction& reduction);

// 1/2 v.W+ v with the pseudo-inverse of W: the least kinetic energy that goes with the contact velocity.
double ContactEnergy(const AnyReduction& reduction);

// The smallest eigenvalue of a symmetric 3 x 3 matrix, upper triangle row by row, scaled to a unit diagonal: in
// [-2, 1], 0 for a singular matrix, -infinity if a diagonal entry is negative or 0 beside entries that are not.
double SmallestScaledEigenvalue(const std::vector<double>& upper);

// How far (u0, v0) lies outside of the range of W, as a share of what could: 0 within, 1 at right angles. A W is
// singular along an eigenvector, scaled to a unit diagonal, of an eigenvalue below 16 eps.
double ShareOutsideRange(const SpatialReduction& reduction);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_REDUCTION_H_
