// Certified velocities: the contact velocity of a certificate, as numbers of twice double precision and as decimals.

#ifndef RICOCHET_CORE_COST_CERTIFIED_VELOCITY_H_
#define RICOCHET_CORE_COST_CERTIFIED_VELOCITY_H_

#include <optional>
#include <string>

#include "core/cost/cost_kernel.h"
#include "core/cost/reference_velocity.h"
#include "core/numerics/wide.h"
#include "ricochet/certificate.h"
#include "ricochet/scene.h"

namespace ricochet {

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

#endif  // RICOCHET_CORE_COST_CERTIFIED_VELOCITY_H_
