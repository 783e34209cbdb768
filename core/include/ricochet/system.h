// System: the body or mechanism that strikes, or the contact alone as another program sees it.
//
// t points along the surface to the right, n out of it into the striking body; angles and rates are counter-clockwise
// in the plane (t, n). Units are SI units and radians. Every number must be finite. Each list has the fixed length that
// its comment states.

#ifndef RICOCHET_SYSTEM_H_
#define RICOCHET_SYSTEM_H_

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

namespace ricochet {

// A rigid body that turns about a fixed frictionless pin O and strikes a fixed horizontal surface at the point
// (a, -b) seen from O. With its rate omega the contact velocity is u = b omega along t and v = a omega along n. Lubarda
// (2009), Fig. 1 and Eq. (1).
struct Pendulum {
  double inertia_kg_m2 = 0.0;      // J0, moment of inertia about the pin, > 0.
  double a_m = 0.0;                // Horizontal distance from the pin to the contact, > 0.
  double b_m = 0.0;                // Depth of the contact below the pin; may have either sign.
  double omega_minus_rad_s = 0.0;  // Angular velocity of incidence; if >= 0 the contact separates, nothing happens.

  friend bool operator==(const Pendulum&, const Pendulum&) = default;
};

// A free rigid body in the plane. u = velocity_t - rate offset_n, v = velocity_n + rate offset_t.
struct PlanarBody {
  double mass_kg = 0.0;            // > 0
  double inertia_com_kg_m2 = 0.0;  // Moment of inertia about the centre of mass, > 0.
  double offset_t_m = 0.0;         // Vector from the centre of mass to the contact point.
  double offset_n_m = 0.0;
  double velocity_t_m_s = 0.0;  // Velocity of the centre of mass.
  double velocity_n_m_s = 0.0;
  double rate_rad_s = 0.0;

  friend bool operator==(const PlanarBody&, const PlanarBody&) = default;
};

// A free rigid body in space, everything in the right-handed contact frame (t1, t2, n).
struct SpatialBody {
  double mass_kg = 0.0;                        // > 0
  std::vector<double> inertia_com_kg_m2 = {};  // 11 12 13 22 23 33, > 0; each moment <= the sum of the others.
  std::vector<double> offset_m = {};       // 3 components of the vector from the centre of mass to the contact point.
  std::vector<double> linear_m_s = {};     // 3 components of the velocity of the centre of mass.
  std::vector<double> angular_rad_s = {};  // 3 components of the angular velocity.

  friend bool operator==(const SpatialBody&, const SpatialBody&) = default;
};

// Two free bodies that strike each other: the impulses act on body 1, their opposites on body 2, n points into body 1,
// and the contact velocity is that of body 1 relative to body 2.
struct PlanarPair {
  PlanarBody body_1 = {};
  PlanarBody body_2 = {};

  friend bool operator==(const PlanarPair&, const PlanarPair&) = default;
};
struct SpatialPair {
  SpatialBody body_1 = {};
  SpatialBody body_2 = {};

  friend bool operator==(const SpatialPair&, const SpatialPair&) = default;
};
// std::monostate means that the request stated no bodies, which Validate reports.
struct BodyPair {
  std::variant<std::monostate, PlanarPair, SpatialPair> bodies = {};

  friend bool operator==(const BodyPair&, const BodyPair&) = default;
};

struct Link {
  double length_m = 0.0;           // Distance from its joint to the next joint or to the tip, > 0.
  double mass_kg = 0.0;            // > 0
  double com_m = 0.0;              // Distance from its joint to its centre of mass, along the link.
  double inertia_com_kg_m2 = 0.0;  // Moment of inertia about its centre of mass, > 0.
  double theta_rad = 0.0;          // Absolute angle from the downward vertical, not relative to the link before.
  double rate_rad_s = 0.0;         // Absolute rate, not relative to the link before.

  friend bool operator==(const Link&, const Link&) = default;
};

// A planar chain that hangs from a fixed pin by frictionless joints; its tip strikes a horizontal surface.
struct Linkage {
  std::vector<Link> links = {};  // From the pin to the tip, at least one.

  friend bool operator==(const Linkage&, const Linkage&) = default;
};

// Any mechanism, as a multibody library gives it at one instant: its mass matrix M, the Jacobian J of the contact point
// and its generalised velocities q', in n coordinates of any kind. J has d rows, along t and n in a plane (d = 2) or
// along t1, t2 and n in space (d = 3); rates.size() is n, and jacobian.size() tells d. A linkage is the case whose M
// and J follow from its links.
//
// Coordinates that a brake or a stiff controller holds during the impact keep their rates: their rows and columns leave
// M, and their columns leave J. `composite` holds all joints of a mechanism with a floating base, which then moves as
// one rigid body: the first 6 coordinates (3 in a plane) stay free. They must be those of a free body: its velocity
// along orthonormal axes, of which M makes m, m, m and J a rotation, before or after its angular velocity.
struct Mechanism {
  std::vector<double> mass_matrix = {};        // n x n entries, row by row, of a symmetric positive definite matrix.
  std::vector<double> jacobian = {};           // d x n entries, row by row; the last row is along n.
  std::vector<double> rates = {};              // n entries, q' before the impact.
  std::vector<int32_t> kept_coordinates = {};  // Coordinates in [0, n), each once, that keep their rates.
  bool composite = false;                      // All joints are held; kept_coordinates must then be empty.

  friend bool operator==(const Mechanism&, const Mechanism&) = default;
};

// A contact in the plane: W = J M^-1 J^T, the contact-space inverse inertia (Delassus matrix), symmetric positive
// semidefinite, and the contact velocity.
struct PlanarContact {
  double w_tt_per_kg = 0.0;     // >= 0
  double w_tn_per_kg = 0.0;     // tt nn - tn^2 >= -4 eps tt nn
  double w_nn_per_kg = 0.0;     // >= 0
  double tangential_m_s = 0.0;  // u0
  double normal_m_s = 0.0;      // v0; >= 0 means separating.

  friend bool operator==(const PlanarContact&, const PlanarContact&) = default;
};

// A contact in space: W and the contact velocity with the rules of PlanarContact; the third direction is n.
struct SpatialContact {
  std::vector<double> w_per_kg = {};        // 11 12 13 22 23 33; positive semidefinite, see scene.proto.
  std::vector<double> tangential_m_s = {};  // 2 components along t1 and t2.
  double normal_m_s = 0.0;

  friend bool operator==(const SpatialContact&, const SpatialContact&) = default;
};

// std::monostate means that the request stated no system, which Validate reports.
using System = std::variant<std::monostate, Pendulum, PlanarBody, SpatialBody, BodyPair, Linkage, PlanarContact,
                            SpatialContact, Mechanism>;

// The number of tangential directions: 1 in a plane, 2 in space. The system must be set.
size_t TangentialDirections(const System& system);
// True for a mechanism in which some coordinates or joints are held during the impact.
bool HoldsCoordinates(const System& system);
size_t TangentialDirections(const Mechanism& mechanism);  // 1 for a Jacobian of no valid size, too.

}  // namespace ricochet

#endif  // RICOCHET_SYSTEM_H_
