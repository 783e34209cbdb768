#include "core/sweep/driven_scene.h"

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "core/scene/validate.h"
#include "core/sweep/grid.h"

namespace ricochet {

DrivenScene::DrivenScene(const Grid& grid) : grid_(grid), scene_(grid.scene) {
  if (!std::holds_alternative<std::monostate>(scene_.system)) Resolve();
  has_relations_ = HasRelations(scene_);
  for (const Axis& axis : grid_.axes) counts_.push_back(AxisCount(axis));
  positions_.resize(grid_.axes.size());
  is_bad_.resize(fields_.size());
}

void DrivenScene::Resolve() {
  std::map<std::string, size_t> driven_by;
  for (size_t i = 0; i < grid_.axes.size() && !IsFull(violations_); ++i) {
    const std::string& name = grid_.axes[i].path;
    const std::string path = absl::StrCat("axes[", i, "].path");
    absl::StatusOr<Field> field = ResolveField(name, scene_);
    if (!field.ok()) {
      violations_.push_back({path, std::string(field.status().message())});
      continue;
    }
    for (const std::string& target : field->sets()) {
      const auto [other, is_new] = driven_by.emplace(target, i);
      if (is_new) continue;
      violations_.push_back(
          {path, absl::StrCat(Found(name), ": must not drive ", target, ", which axes[", other->second, "] drives")});
    }
    // An angle sets two numbers from the base scene's distance, so their base values must be right.
    if (field->sets().size() == 1) driven_.insert(name);
    fields_.push_back(*std::move(field));
  }
}

bool DrivenScene::CanBeCured(const Violation& violation) const {
  switch (violation.kind) {
    case ViolationKind::kShape:
      return false;
    case ViolationKind::kValue:
      return driven_.contains(violation.field) ||
             std::any_of(violation.tied_to.begin(), violation.tied_to.end(),
                         [this](const std::string& path) { return driven_.contains(path); });
    case ViolationKind::kContact:
      return !fields_.empty();
  }
  return false;
}

void DrivenScene::SetField(size_t k) {
  const bool is_bad = !fields_[k].Set(AxisValue(grid_.axes[k], positions_[k]));
  bad_fields_ += static_cast<int64_t>(is_bad) - static_cast<int64_t>(is_bad_[k]);
  is_bad_[k] = is_bad;
}

void DrivenScene::GoTo(int64_t index) {
  AxisPositions(grid_, index, absl::MakeSpan(positions_));
  for (size_t k = 0; k < fields_.size(); ++k) SetField(k);
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
  return bad_fields_ == 0 && (!has_relations_ || KeepsRelations(scene_, contact));
}

}  // namespace ricochet
