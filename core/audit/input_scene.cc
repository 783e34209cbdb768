#include "core/audit/input_scene.h"

#include <string>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/audit/audit_parts.h"
#include "core/scene/validate.h"

namespace ricochet::audit {

static std::vector<std::string> PathsOf(const Scene& scene, const std::vector<InputColumn>& inputs) {
  std::vector<std::string> paths;
  if (std::holds_alternative<std::monostate>(scene.system)) return paths;
  for (const InputColumn& input : inputs) paths.push_back(input.path);
  return paths;
}

InputScene::InputScene(Scene scene, const std::vector<InputColumn>& inputs)
    : scene_(std::move(scene)),
      inputs_(inputs),
      fields_(
          PathsOf(scene_, inputs), [](size_t i) { return absl::StrCat("inputs[", i, "]"); }, ".path", scene_) {}

std::vector<Violation> InputScene::Violations() const {
  if (std::holds_alternative<std::monostate>(scene_.system)) return Validate(scene_, RestitutionIs::kOptional);
  if (!fields_.violations().empty()) return fields_.violations();
  for (size_t i = 0; i < inputs_.size(); ++i) {
    const std::string& path = inputs_[i].path;
    if (!absl::StartsWith(path, "restitution.") && !absl::StartsWith(path, "impact_law.")) continue;
    return {MakeViolation(absl::StrCat("inputs[", i, "].path"), Found(path),
                          "be another number, an audit uses neither restitution nor impact law")};
  }
  std::optional<SceneContact> unused;
  std::vector<Violation> violations =
      Validate(scene_, RestitutionIs::kOptional, unused,
               [this](const Violation& violation) { return !fields_.CanBeCured(violation); });
  if (!violations.empty()) return violations;
  // Whether a tangential spring shows in an audit depends on the numbers of each row.
  Scene without_spring = scene_;
  if (without_spring.compliance.has_value()) without_spring.compliance->tangential_ratio_squared.reset();
  RequireRigid(without_spring, RigidIn::kNormal, "for an audit", violations);
  return violations;
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
