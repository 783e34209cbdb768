#include "core/rows/driven_scene.h"

#include <algorithm>
#include <bit>
#include <variant>

#include "core/scene/validate.h"

namespace ricochet {

DrivenScene::DrivenScene(const Scene& scene, const std::vector<std::string>& paths, DrivenFields::NameOf name_of,
                         const char* member)
    : scene_(scene),
      fields_(std::holds_alternative<std::monostate>(scene.system) ? std::vector<std::string>() : paths, name_of,
              member, scene_),
      has_relations_(HasRelations(scene_)),
      reduces_once_(
          std::none_of(paths.begin(), paths.end(), [](const std::string& path) { return ReductionDependsOn(path); })),
      last_(fields_.size()) {}

DrivenScene::DrivenScene(const Scene& scene, const std::vector<std::string>& paths)
    : DrivenScene(
          scene, paths, [](size_t /*i*/) { return std::string(); }, "") {}

bool DrivenScene::Set(size_t k, double value) {
  Last& last = last_[k];
  if (last.bits == std::bit_cast<uint64_t>(value)) return !last.is_bad;
  const bool is_bad = !fields_[k].Set(value);
  bad_fields_ += static_cast<int64_t>(is_bad) - static_cast<int64_t>(last.is_bad);
  last = {.bits = std::bit_cast<uint64_t>(value), .is_bad = is_bad};
  return !is_bad;
}

void DrivenScene::SetRow(absl::Span<const FieldColumn> columns, size_t i) {
  for (size_t k = 0; k < columns.size(); ++k) Set(k, columns[k].values[i]);
}

bool DrivenScene::IsValid(std::optional<SceneContact>& contact) {
  contact.reset();
  if (bad_fields_ != 0) return false;
  if (!has_relations_) return true;
  if (reduces_once_ && !reduction_.has_value()) reduction_ = Reduce(scene_);
  return KeepsRelations(scene_, reduction_.has_value() ? &*reduction_ : nullptr, contact);
}

}  // namespace ricochet
