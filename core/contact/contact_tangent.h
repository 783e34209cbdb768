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

#include <memory>
#include <vector>

#include "core/contact/delassus.h"
#include "core/contact/scene_contact.h"
#include "ricochet/scene.h"

namespace ricochet {

struct ContactTangent {
  PlanarDelassus w;
  double u0 = 0.0, v0 = 0.0;
  double kinetic_friction = 0.0, static_friction = 0.0, restitution = 0.0;
  std::vector<double> before, response, momentum;  // PlanarReduction explains them.
  // The tangent along the opposite direction is the opposite of this.
  bool is_linear = false;
  bool keeps_rank_one = false;        // W has rank one and keeps it along the direction.
  bool is_at_speed_of_table = false;  // The approach speed is one that a table lists.
};

ContactTangent operator-(ContactTangent tangent);

// The derivatives of one contact along any number of directions, for which M is factorized once.
class ContactTangents {
 public:
  // `contact` is that of the scene. Both must outlive this.
  ContactTangents(const Scene& scene, const SceneContact& contact);
  ~ContactTangents();
  ContactTangents(const ContactTangents&) = delete;
  ContactTangents& operator=(const ContactTangents&) = delete;

  // `direction` is a scene of the same form, whose numbers are the changes of those of the scene. Where the contact
  // does not depend smoothly on the direction, the tangent is that towards which it points.
  ContactTangent Along(const Scene& direction) const;

 private:
  struct Bodies;

  const Scene& scene_;
  const SceneContact& contact_;
  bool is_rank_one_;
  std::unique_ptr<const Bodies> bodies_;  // Unset if W is given.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_CONTACT_TANGENT_H_
