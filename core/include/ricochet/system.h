// System: what strikes. A body or a mechanism, or the contact alone as another program sees it.
//
// t points along the surface to the right, n out of it into the striking body; angles and rates are counter-clockwise
// in the plane (t, n). SI units and radians. Every number must be finite. Lists have a fixed length, given beside each.

#ifndef RICOCHET_SYSTEM_H_
#define RICOCHET_SYSTEM_H_

#include <cstddef>
#include <variant>
#include <vector>

namespace ricochet {

// A rigid body that turns about a fixed frictionless pin O and strikes a fixed horizontal surface at the point
// (a, -b) seen from O. Contact velocity: u = b w along t, v = a w along n. Lubarda (2009), Fig. 1 and Eq. (1).
struct Pendulum {
  double inertia_kg_m2 = 0.0;      // J0 about the pin, > 0.
  double a_m = 0.0;                // Horizontal distance pin to contact, > 0.
  double b_m = 0.0;                // Depth of the contact below the pin, of either sign.
  double omega_minus_rad_s = 0.0;  // w-, the angular velocity of incidence; >= 0 means separating: nothing happens.

  friend bool operator==(const Pendulum&, const Pendulum&) = default;
};

// A free rigid body in the plane. u = velocity_t - rate offset_n, v = velocity_n + rate offset_t.
struct PlanarBody {
  double mass_kg = 0.0;            // > 0
  double inertia_com_kg_m2 = 0.0;  // About the centre of mass, > 0.
  double offset_t_m = 0.0;         // From the centre of mass to the contact point.
  double offset_n_m = 0.0;
  double velocity_t_m_s = 0.0;  // Of the centre of mass.
  double velocity_n_m_s = 0.0;
  double rate_rad_s = 0.0;

  friend bool operator==(const PlanarBody&, const PlanarBody&) = default;
};

// A free rigid body in space, everything in the right-handed contact frame (t1, t2, n).
struct SpatialBody {
  double mass_kg = 0.0;                   // > 0
  std::vector<double> inertia_com_kg_m2;  // 11 12 13 22 23 33, positive definite.
  std::vector<double> offset_m;           // 3: from the centre of mass to the contact point.
  std::vector<double> linear_m_s;         // 3: of the centre of mass.
  std::vector<double> angular_rad_s;      // 3

  friend bool operator==(const SpatialBody&, const SpatialBody&) = default;
};

// Two free bodies that strike each other: the impulses act on body 1, their opposites on body 2, n points into body 1,
// and the contact velocity is that of body 1 relative to body 2.
struct PlanarPair {
  PlanarBody body_1;
  PlanarBody body_2;

  friend bool operator==(const PlanarPair&, const PlanarPair&) = default;
};
struct SpatialPair {
  SpatialBody body_1;
  SpatialBody body_2;

  friend bool operator==(const SpatialPair&, const SpatialPair&) = default;
};
// std::monostate: the request left the choice open, which Validate reports.
struct BodyPair {
  std::variant<std::monostate, PlanarPair, SpatialPair> bodies;

  friend bool operator==(const BodyPair&, const BodyPair&) = default;
};

struct Link {
  double length_m = 0.0;           // Joint to joint, or to the tip, > 0.
  double mass_kg = 0.0;            // > 0
  double com_m = 0.0;              // From the joint where it hangs to its centre of mass, along the link.
  double inertia_com_kg_m2 = 0.0;  // About its centre of mass, > 0.
  double theta_rad = 0.0;          // From the downward vertical, not from the link before.
  double rate_rad_s = 0.0;         // Not relative to the link before.

  friend bool operator==(const Link&, const Link&) = default;
};

// A planar chain that hangs from a fixed pin by frictionless joints; its tip strikes a horizontal surface.
struct Linkage {
  std::vector<Link> links;  // From the pin to the tip, at least one.

  friend bool operator==(const Linkage&, const Linkage&) = default;
};

// A contact in the plane: W = J M^-1 J^T, the contact-space inverse inertia (Delassus matrix), symmetric positive
// semidefinite, and the contact velocity, which lies in the range of W.
struct PlanarContact {
  double w_tt_per_kg = 0.0;     // >= 0
  double w_tn_per_kg = 0.0;     // tt nn - tn^2 >= -4 eps tt nn
  double w_nn_per_kg = 0.0;     // >= 0
  double tangential_m_s = 0.0;  // u0
  double normal_m_s = 0.0;      // v0; >= 0 means separating.

  friend bool operator==(const PlanarContact&, const PlanarContact&) = default;
};

// The same in space, n last.
struct SpatialContact {
  std::vector<double> w_per_kg;        // 11 12 13 22 23 33, positive semidefinite.
  std::vector<double> tangential_m_s;  // 2
  double normal_m_s = 0.0;

  friend bool operator==(const SpatialContact&, const SpatialContact&) = default;
};

// std::monostate: the request left the choice open, which Validate reports.
using System =
    std::variant<std::monostate, Pendulum, PlanarBody, SpatialBody, BodyPair, Linkage, PlanarContact, SpatialContact>;

// The number of tangential directions of a system that is set: 1 in a plane, 2 in space.
size_t TangentialDirections(const System& system);

}  // namespace ricochet

#endif  // RICOCHET_SYSTEM_H_
