// PlanarBodyShare: what one body of a plane adds to W and to the contact velocity, and how impulses change its
// velocity.
//
// The rows of J are (1, 0, -s_n) and (0, 1, s_t) for a contact at (s_t, s_n) from the centre of mass.
// docs/theory/contact.md derives this.

#ifndef RICOCHET_CORE_CONTACT_PLANAR_BODY_SHARE_H_
#define RICOCHET_CORE_CONTACT_PLANAR_BODY_SHARE_H_

#include <array>
#include <cmath>

#include "ricochet/scene.h"

namespace ricochet {

struct PlanarBodyShare {
  double wtt, wtn, wnn;
  double u0, v0;  // The velocity of the point of contact, which moves with the body.
};

inline PlanarBodyShare ShareOf(const PlanarBody& body) {
  const double root = std::sqrt(body.inertia_com_kg_m2);
  const double yt = -body.offset_n_m / root;
  const double yn = body.offset_t_m / root;
  const double per_mass = 1.0 / body.mass_kg;
  return {.wtt = per_mass + yt * yt,
          .wtn = yt * yn,
          .wnn = per_mass + yn * yn,
          .u0 = body.velocity_t_m_s - body.rate_rad_s * body.offset_n_m,
          .v0 = body.velocity_n_m_s + body.rate_rad_s * body.offset_t_m};
}

// M^-1 J^T, row by row: the change of (velocity along t, along n, rate) by a unit impulse along t and along n. `side`
// is 1 for the body on which the impulses act, -1 for the one on which their opposites act.
inline std::array<double, 6> ResponseOf(const PlanarBody& body, double side) {
  const double per_mass = side / body.mass_kg;
  return {per_mass,
          0.0,
          0.0,
          per_mass,
          side * (-body.offset_n_m / body.inertia_com_kg_m2),
          side * (body.offset_t_m / body.inertia_com_kg_m2)};
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_PLANAR_BODY_SHARE_H_
