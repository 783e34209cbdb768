// Reduction: all quantities that determine the impact of a system at one point, and the map from its impulse back to
// the velocities of the system.
//
//   W = J M^-1 J^T,   (u0, v0) = J q' - surface velocity,   q'+ = q' + M^-1 J^T (f, tau)
//
// M is the mass matrix, J the Jacobian of the contact point, and q' the n generalised velocities: the rates of a
// pendulum or linkage, or the velocity and angular velocity of a body. W is computed as the Gram matrix of L^-1 J^T
// with L L^T = M, so that it is positive semidefinite up to rounding. A planar W whose determinant may be rounding
// alone (below 8 n eps Wtt Wnn) is given rank one by wtn = +-sqrt(Wtt Wnn). docs/theory/contact.md derives this.
// Accuracy: a few n ulp times the condition of M after scaling to a unit diagonal. The M^-1 J^T of a mechanism is
// corrected once by its residual (core/contact/mechanism.h), so that the condition counts for little. Units are SI
// units. The scene must be valid (core/scene/validate.h). If a product overflows, W or a velocity is not finite.

#ifndef RICOCHET_CORE_CONTACT_REDUCTION_H_
#define RICOCHET_CORE_CONTACT_REDUCTION_H_

#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include "absl/container/inlined_vector.h"
#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "ricochet/scene.h"

namespace ricochet {

// The kind of generalised velocities that a system has.
enum class Coordinates {
  kNone,    // The system is a contact alone and has none.
  kRates,   // A pendulum or a linkage has the angular velocities of its links.
  kAny,     // A mechanism has generalised velocities of any kind.
  kBodies,  // Each body has its linear, then its angular velocity: 3 numbers in a plane, 6 in space.
};

template <size_t kTangential>
struct Reduction {
  static constexpr size_t kDirections = kTangential + 1;  // The last direction is n.
  // Two bodies have this many generalised velocities. As many lie in place; a longer linkage takes memory of the heap.
  static constexpr size_t kVelocities = kTangential == 1 ? 6 : 12;
  using Velocities = absl::InlinedVector<double, kVelocities>;

  std::array<double, kDirections*(kDirections + 1) / 2> w = {};  // Upper triangle, row by row.
  std::array<double, kTangential> u0 = {};                       // Relative to the surface.
  double v0 = 0.0;
  Coordinates coordinates = Coordinates::kNone;
  Velocities before;                                                // q'
  absl::InlinedVector<double, kVelocities * kDirections> response;  // M^-1 J^T, row by row.
  // Only a mechanism has it: M M^-1 J^T of all coordinates, row by row, the momentum that each takes of a unit impulse.
  // A free coordinate has its row of J^T, one that is held has what the free ones pass on to it.
  std::vector<double> momentum;
  // The accelerations by finite forces alone: (a_t, a_n) of the contact and q'' = M^-1 Q of the system. The latter is
  // empty if there are no finite forces.
  std::array<double, kDirections> acceleration = {};
  Velocities drift;

  // q' after the contact has received the impulse (`tangential`, `normal`) in N s and finite forces have acted for
  // `duration` in s.
  Velocities After(const std::array<double, kTangential>& tangential, double normal, double duration = 0.0) const;
};

using PlanarReduction = Reduction<1>;   // w: tt, tn, nn
using SpatialReduction = Reduction<2>;  // w: 11, 12, 13, 22, 23, 33
using AnyReduction = std::variant<PlanarReduction, SpatialReduction>;

// Reduces a scene whose system keeps its own rules. Friction, restitution, compliance and impact law do not matter.
AnyReduction Reduce(const Scene& scene);

// False if no number at this path of a scene, such as "friction.kinetic_coefficient", changes what Reduce returns.
bool ReductionDependsOn(absl::string_view path);

// True if W and the velocities are finite.
bool IsFinite(const AnyReduction& reduction);

// True if doubles can represent what an impact needs: W and the velocities are finite, and if the contact approaches,
// W_nn is not 0 and has not lost digits to underflow. A stated W_nn has all its digits whatever its size.
bool FitsDoubles(const AnyReduction& reduction);

// The approach speed max(0, -v0), m/s.
double ApproachSpeed(const AnyReduction& reduction);

// 1/2 v.W+ v with the pseudo-inverse W+ of W: the least kinetic energy, in J, that goes with the contact velocity.
double ContactEnergy(const AnyReduction& reduction);

// True only if the matrix of 11, 12, 13, 22, 23, 33, scaled to a unit diagonal, has no eigenvalue below 2^-12. This
// spares the eigenvalues: they add up to 3, so that the smallest positive one is at least 4/9 of the determinant.
bool IsSurelyDefinite(absl::Span<const double> upper);

// The share of the velocity (u0, v0) that lies outside the range of W: 0 if the velocity lies within it, 1 if it is
// perpendicular to it. W counts as singular along an eigenvector whose eigenvalue, after scaling to a unit diagonal, is
// below 16 eps.
double ShareOutsideRange(const SpatialReduction& reduction);

// True if the velocity lies in the range of W up to rounding, as every velocity does if the rank of W is full. Only W,
// u0 and v0 are read.
bool VelocityIsInRange(const PlanarReduction& reduction);
bool VelocityIsInRange(const SpatialReduction& reduction);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_REDUCTION_H_
