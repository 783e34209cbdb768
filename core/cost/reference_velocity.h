// ReferenceVelocity: the exact contact velocity after an impact, to about twice double precision, for a study of cost.
//
//   rigid contact     Certified digits (core/certified/certified.h). A contact of rank one is that of a pendulum, whose
//                     v1 = -kappa_hat v0 and u1 = -kappa_hat u0; rank two is certified from W and (u0, v0) themselves.
//                     Without the component `certified`, or if W is semidefinite to rounding only, the compensated
//                     kernels answer, which are right to 1 ulp.
//   straight path     The equations of core/models/sliding/sliding.h, in Wide numbers.
//   first order       The forms of core/models/pendulum/nearly_vertical_forms.h, in Wide numbers.
//   space             The spatial model with a long double's digits and a tolerance of 1e-16.
//
// W and the velocity before the impact are taken as exact, as Accuracy::relative_error does.

#ifndef RICOCHET_CORE_COST_REFERENCE_VELOCITY_H_
#define RICOCHET_CORE_COST_REFERENCE_VELOCITY_H_

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "core/cost/cost_kernel.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/sliding/sliding.h"
#include "core/models/spatial/spatial.h"
#include "core/numerics/wide.h"
#include "ricochet/certificate.h"
#include "ricochet/scene.h"

namespace ricochet {

struct ReferenceVelocity {
  std::array<Wide, 3> of;  // Along t1, t2 and n; in a plane the second is 0.
  double error = 0.0;      // Over V = max(|u0|, |v0|).
  std::string source;      // One sentence that says where the numbers come from.
};

// Returns a reference with these numbers as they are.
ReferenceVelocity ReferenceAt(const Velocity3& velocity, double error, std::string source);

// Return the exact velocity of a rigid impact that approaches, of a pendulum or of a planar contact.
ReferenceVelocity ExactRigid(const pendulum::Problem& problem, Stopped stopped);
ReferenceVelocity ExactRigid(const planar::Problem& problem, Stopped stopped);

// The scene whose certificate gives the numbers of a contact: that of a pendulum if W has rank one
// and the velocity lies in its range.
Scene CertifiableScene(const planar::Problem& problem);

// Returns the velocity if slip along u0 goes on to the end; with mu = 0 there is no friction at all.
template <size_t kTangential>
ReferenceVelocity ExactSliding(const sliding::Problem<kTangential>& problem);

// Returns the velocity after an impact without friction.
ReferenceVelocity ExactFrictionless(const pendulum::Problem& problem);

ReferenceVelocity ExactFirstOrder(const pendulum::Problem& problem);

// If the impact has no end, the error is infinite.
ReferenceVelocity ExactSpatial(const spatial::Problem& problem);

Velocity3 RoundedVelocity(const ReferenceVelocity& exact);

// The largest component of the difference.
double Distance(const Velocity3& velocity, const ReferenceVelocity& exact);
double Distance(const ReferenceVelocity& one, const ReferenceVelocity& other);

// The digits of references. Those of twice double precision are 32.
inline constexpr int kReferenceDigits = 100;
inline constexpr char kCertifiedSource[] = "certified to 100 digits";

// Certifies a valid scene; nothing if it cannot be certified, if only a set is proved, or once `stopped` says true.
std::optional<Certificate> CertifyContact(const Scene& scene, int digits, Stopped stopped);

// The certified number of this path, to twice double precision.
Wide ExactNumber(const Certificate& certificate, const std::string& path);

// The contact velocity after the impact of a planar scene.
ReferenceVelocity ReferenceVelocityOf(const Certificate& certificate);
Velocity3 RoundedVelocityOf(const Certificate& certificate);

// The largest component of the difference of two certificates' contact velocities, by their decimals.
double Distance(const Certificate& one, const Certificate& other);

}  // namespace ricochet

#endif  // RICOCHET_CORE_COST_REFERENCE_VELOCITY_H_
