#include "core/audit/input_scene.h"

#include <string>
#include <utility>
#include <variant>

#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/audit/audit_parts.h"
#include "core/base/invariant.h"
#include "core/scene/driven_fields.h"
#include "core/scene/rigid.h"
#include "core/scene/validate.h"

namespace ricochet::audit {

std::vector<Violation> CheckInputs(const Scene& scene, const std::vector<InputColumn>& inputs) {
  if (std::holds_alternative<std::monostate>(scene.system)) return Validate(scene, RestitutionIs::kOptional);
  std::vector<std::string> paths;
  for (const InputColumn& input : inputs) paths.push_back(input.path);
  Scene driven = scene;
  const DrivenFields fields(
      paths, [](size_t i) { return absl::StrCat("inputs[", i, "]"); }, ".path", driven);
  if (!fields.violations().empty()) return fields.violations();
  for (size_t i = 0; i < paths.size(); ++i) {
    if (!absl::StartsWith(paths[i], "restitution.") && !absl::StartsWith(paths[i], "impact_law.")) continue;
    return {MakeViolation(absl::StrCat("inputs[", i, "].path"), Found(paths[i]),
                          "be another number, an audit uses neither restitution nor impact law")};
  }
  std::optional<SceneContact> unused;
  std::vector<Violation> violations =
      Validate(driven, RestitutionIs::kOptional, unused,
               [&](const Violation& violation) { return !fields.CanBeCured(violation); });
  // Whether a tangential spring shows in an audit depends on the numbers of each row.
  if (driven.compliance.has_value()) driven.compliance->tangential_ratio_squared.reset();
  if (violations.empty()) RequireRigid(driven, RigidIn::kNormal, "for an audit", violations);
  return violations;
}

InputScene::InputScene(Scene scene, const std::vector<InputColumn>& inputs)
    : scene_(std::move(scene)), inputs_(inputs) {
  for (const InputColumn& input : inputs) {
    absl::StatusOr<Field> field = ResolveField(input.path, scene_);
    CheckInvariant(field.ok(), "the inputs of an audit were checked");
    fields_.push_back(*std::move(field));
  }
}

std::vector<Violation> InputScene::SetRow(size_t row, std::optional<SceneContact>& contact) {
  contact.reset();
  for (size_t i = 0; i < fields_.size(); ++i) {
    const std::vector<double>& values = inputs_[i].values;
    const double value = values.size() == 1 ? values[0] : values[row];
    if (!fields_[i].Set(value) && inputs_[i].path == kPhi) return {*WhyNoPhi(value)};
  }
  return CheckScene(scene_, contact);
}

}  // namespace ricochet::audit
