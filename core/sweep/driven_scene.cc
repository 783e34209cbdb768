#include "core/sweep/driven_scene.h"

#include <algorithm>
#include <string>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "core/contact/reduction.h"
#include "core/scene/validate.h"
#include "core/sweep/grid.h"

namespace ricochet {

// The paths of the axes; none if the scene has no system, which is then the only violation.
static std::vector<std::string> PathsOf(const Grid& grid) {
  if (std::holds_alternative<std::monostate>(grid.scene.system)) return {};
  return AxisPaths(grid);
}

DrivenScene::DrivenScene(const Grid& grid)
    : grid_(grid),
      scene_(grid.scene),
      fields_(
          PathsOf(grid), [](size_t i) { return absl::StrCat("axes[", i, "]"); }, ".path", scene_) {
  has_relations_ = HasRelations(scene_);
  reduces_once_ = std::none_of(grid_.axes.begin(), grid_.axes.end(),
                               [](const Axis& axis) { return ReductionDependsOn(axis.path); });
  for (const Axis& axis : grid_.axes) counts_.push_back(AxisCount(axis));
  positions_.resize(grid_.axes.size());
  is_bad_.resize(fields_.size());
}

void DrivenScene::SetField(size_t k) {
  const bool is_bad = !fields_[k].Set(AxisValue(grid_.axes[k], positions_[k]));
  bad_fields_ += static_cast<int64_t>(is_bad) - static_cast<int64_t>(is_bad_[k]);
  is_bad_[k] = is_bad;
}

void DrivenScene::GoTo(int64_t index) {
  AxisPositions(grid_, index, absl::MakeSpan(positions_));
  for (size_t k = 0; k < fields_.size(); ++k) SetField(k);
  if (has_relations_ && reduces_once_ && !reduction_.has_value()) reduction_ = Reduce(scene_);
}

void DrivenScene::Advance() {
  for (size_t k = fields_.size(); k-- > 0;) {
    const bool wraps = ++positions_[k] == counts_[k];
    if (wraps) positions_[k] = 0;
    SetField(k);
    if (!wraps && grid_.combination != Combination::kZip) return;
  }
}

bool DrivenScene::IsValid(std::optional<SceneContact>& contact) const {
  contact.reset();
  return bad_fields_ == 0 &&
         (!has_relations_ || KeepsRelations(scene_, reduction_.has_value() ? &*reduction_ : nullptr, contact));
}

}  // namespace ricochet
