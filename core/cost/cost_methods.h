// Methods: every method that applies to a scene, each as a kernel with what it claims and what it is judged by.
//
//   pendulum   frictionless, first order, closed form, planar
//   plane      frictionless, sliding, planar; with an energetic coefficient also tangential compliance, if the scene
//              has any, and finite duration at four tolerances, and at three stiffnesses if finite forces act or the
//              spring has damping, because a stiffness changes nothing else but the time that the impact takes
//   space      frictionless, sliding, space at tolerances from 1e-2 to 1e-12
//   rigid contacts in a plane also certified, at 16, 32 and 64 digits; an impact law alone
//   several contacts: orders, springs and possible, as far as the scene allows each
//
// The closed form and the planar model come in plain and in compensated arithmetic. A model that leaves out an effect
// of the scene applies, too, if core/plan/ can compute the impact without that effect; its claim is then the size that
// the plan gives to what is left out (core/plan/sizes.h), which may be infinite. A model of finite duration applies to
// a scene that states no spring with linear springs that make contacts of some 10, 1 and 0.1 ms, or of 1 ms alone. The
// damping of a spring by Hunt and Crossley takes the place of restitution, so that only the models of finite duration
// apply to it.

#ifndef RICOCHET_CORE_COST_COST_METHODS_H_
#define RICOCHET_CORE_COST_COST_METHODS_H_

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "core/contact/scene_contact.h"
#include "core/cost/cost_kernel.h"
#include "core/cost/reference_velocity.h"
#include "ricochet/cost.h"
#include "ricochet/multi_contact.h"
#include "ricochet/scene.h"

namespace ricochet {

struct MultiReduction;

// An exact answer that is computed when it is first asked for, because some take long.
class Reference {
 public:
  using Compute = std::function<ReferenceVelocity(Stopped)>;

  explicit Reference(Compute compute) : compute_(std::move(compute)) {}

  // Returns null if none is known: its error is infinite. An answer that was stopped is not kept.
  const ReferenceVelocity* Get(Stopped stopped);

 private:
  Compute compute_;
  std::optional<ReferenceVelocity> known_;
};

struct StudiedMethod {
  std::string name;
  CostMethod method;
  Kernel kernel;
  double claimed_modelling = 0.0;  // Over |v0|; infinite where no bound is known.
  double claimed_reduction = 0.0;  // Error over V by the rounding of W, where the exact answer does not share it.
  // The exact answer of the method's own model; null if there is none.
  std::shared_ptr<Reference> exact;
  std::string note;         // One sentence on what is special; may be empty.
  std::string unavailable;  // One sentence that says which component is missing; empty if none is.
};

struct StudiedScene {
  std::vector<StudiedMethod> methods;
  // The exact answer with all effects of the scene; null under an impact law and at several contacts.
  std::shared_ptr<Reference> truth;
  double speed = 0.0;     // V = max(|u0|, |v0|), m/s
  double v0 = 0.0;        // m/s
  size_t directions = 1;  // Tangential directions; 0 at several contacts.
};

// Lists the methods for a valid scene. `contact` is as in PlanScene (core/plan/planned_scene.h), and is set.
// Errors: ContactOverflow.
absl::StatusOr<StudiedScene> StudyScene(const Scene& scene, std::optional<SceneContact>& contact);

// Lists the methods for a valid scene of several contacts, which was reduced.
StudiedScene StudyMultiContact(const MultiContactScene& scene, const MultiReduction& reduction);

}  // namespace ricochet

#endif  // RICOCHET_CORE_COST_COST_METHODS_H_
