// ContactTangent: the derivatives of what an impact knows of a planar scene (core/contact/scene_contact.h) along a
// direction in its numbers.
//
// With X = M^-1 J^T of the coordinates that are free,
//
//   dX = M^-1 (dJ^T - dM X),   dW = dJ X + (dJ X)^T - X^T dM X,   d(u0, v0) = dJ q' + J dq' - d(surface velocity)
//
// M, J and q' of bodies and mechanisms are linear in the numbers of the scene, those of a linkage are differentiated
// one by one. Friction and restitution change with the approach speed, too, if they depend on it.
// Accuracy: a few n ulp times the condition of M after scaling to a unit diagonal. The scene must be valid and planar;
// what overflows is not finite. Source: docs/theory/derivatives.md.

#ifndef RICOCHET_CORE_CONTACT_CONTACT_TANGENT_H_
#define RICOCHET_CORE_CONTACT_CONTACT_TANGENT_H_

#include <vector>

#include "core/contact/delassus.h"
#include "core/contact/scene_contact.h"
#include "ricochet/scene.h"

namespace ricochet {

struct ContactTangent {
  PlanarDelassus w;
  double u0 = 0.0, v0 = 0.0;
  double kinetic_friction = 0.0, static_friction = 0.0, restitution = 0.0;
  std::vector<double> before, response;  // PlanarReduction explains both.
  // One coordinate alone is free, so that W has rank one whatever the numbers are.
  bool keeps_rank_one = false;
  bool is_at_speed_of_table = false;  // The approach speed is one that a table lists.
};

// `direction` is a scene of the form of `scene`, whose numbers are the changes of those of `scene`. Where the contact
// does not depend smoothly on the direction, the tangent is that towards which it points.
ContactTangent TangentOf(const Scene& scene, const SceneContact& contact, const Scene& direction);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_CONTACT_TANGENT_H_
