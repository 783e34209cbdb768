// InputScene: the scene of each row of an audit in turn, as its inputs state it.

#ifndef RICOCHET_CORE_AUDIT_INPUT_SCENE_H_
#define RICOCHET_CORE_AUDIT_INPUT_SCENE_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "core/contact/scene_contact.h"
#include "core/scene/field.h"
#include "ricochet/audit.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet::audit {

// Thread safety: one thread at a time.
class InputScene {
 public:
  // The inputs must outlive this object.
  InputScene(Scene scene, const std::vector<InputColumn>& inputs);
  InputScene(const InputScene&) = delete;
  InputScene& operator=(const InputScene&) = delete;

  // Lists, before the first row, what is wrong with the paths, and what makes the scene none to audit whatever the
  // inputs state.
  std::vector<Violation> Violations() const;

  // Sets the numbers of a row and lists what makes its scene none to audit. There are no violations of all rows, and
  // each input has a value for each row or one for all. `contact` is that of a scene without violations.
  std::vector<Violation> SetRow(size_t row, std::optional<SceneContact>& contact);
  const Scene& scene() const { return scene_; }

 private:
  Scene scene_;
  const std::vector<InputColumn>& inputs_;
  DrivenFields fields_;  // One an input.
};

}  // namespace ricochet::audit

#endif  // RICOCHET_CORE_AUDIT_INPUT_SCENE_H_
