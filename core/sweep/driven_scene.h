// DrivenScene: the scene of each point of a grid in turn, as the axes drive the fields of the base scene.
//
//   DrivenScene driven(grid);                  // Refuse the grid if driven.violations() has any.
//   driven.GoTo(first);
//   for (int64_t i = first; i < end; ++i, driven.Advance()) {
//     if (driven.IsValid()) Solve(driven.scene());
//   }

#ifndef RICOCHET_CORE_SWEEP_DRIVEN_SCENE_H_
#define RICOCHET_CORE_SWEEP_DRIVEN_SCENE_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "core/contact/reduction.h"
#include "core/contact/scene_contact.h"
#include "core/scene/driven_fields.h"
#include "ricochet/error.h"
#include "ricochet/grid.h"
#include "ricochet/scene.h"

namespace ricochet {

class DrivenScene {
 public:
  // Resolves the path of each axis in a copy of the grid's scene, which the resolved fields then point into. The grid
  // must outlive this object.
  explicit DrivenScene(const Grid& grid);
  DrivenScene(const DrivenScene&) = delete;
  DrivenScene& operator=(const DrivenScene&) = delete;

  // The axes whose path names no field of the scene, or one that another axis drives: "axes[1].path".
  const std::vector<Violation>& violations() const { return fields_.violations(); }

  // True if driving a field can cure this violation of the base scene. IsValid decides it at each point.
  bool CanBeCured(const Violation& violation) const { return fields_.CanBeCured(violation); }

  // The scene of the current point; before GoTo it is the base scene.
  const Scene& scene() const { return scene_; }

  // Below, `grid` is valid (ValidateAxes), there are no violations, and the base scene has none that cannot be cured.
  // Makes point `index` of the grid the current one.
  void GoTo(int64_t index);
  // Makes the next point the current one, at the cost of setting the fields that change. After the last comes the first.
  void Advance();
  // Decides whether Validate would find nothing in the current scene. `contact` is as in Validate.
  bool IsValid(std::optional<SceneContact>& contact) const;

 private:
  void SetField(size_t k);

  const Grid& grid_;
  Scene scene_;
  DrivenFields fields_;                    // One an axis.
  bool has_relations_ = false;             // True if the scene has rules beyond those of single numbers.
  bool reduces_once_ = false;              // True if no axis changes the reduction.
  std::optional<AnyReduction> reduction_;  // That of all points if they share one, once a point has asked for it.
  std::vector<int64_t> counts_;            // Values of each axis.
  std::vector<int64_t> positions_;
  std::vector<uint8_t> is_bad_;  // 1 for each field whose value breaks the rule of its number.
  int64_t bad_fields_ = 0;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_DRIVEN_SCENE_H_
