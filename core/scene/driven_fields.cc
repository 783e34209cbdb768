#include "core/scene/driven_fields.h"

#include <algorithm>
#include <map>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"

namespace ricochet {

DrivenFields::DrivenFields(const std::vector<std::string>& paths, NameOf name_of, const char* member, Scene& scene) {
  std::map<std::string, size_t> driven_by;
  for (size_t i = 0; i < paths.size() && !IsFull(violations_); ++i) {
    const std::string place = absl::StrCat(name_of(i), member);
    absl::StatusOr<Field> field = ResolveField(paths[i], scene);
    if (!field.ok()) {
      violations_.push_back({place, std::string(field.status().message())});
      continue;
    }
    for (const std::string& target : field->sets()) {
      const auto [other, is_new] = driven_by.emplace(target, i);
      if (is_new) continue;
      const std::string& driver = paths[other->second];
      const std::string also = driver == paths[i] ? "" : absl::StrCat(", ", driver, ",");
      violations_.push_back(
          MakeViolation(place, Found(paths[i]),
                        absl::StrCat("not drive ", target, ", which ", name_of(other->second), also, " drives")));
    }
    // An angle sets two numbers from the base scene's distance, so their base values must be right.
    if (paths[i] != kPhi) {
      driven_.insert(paths[i]);
      driven_.insert(field->sets().begin(), field->sets().end());
    }
    fields_.push_back(*std::move(field));
  }
}

bool DrivenFields::CanBeCured(const Violation& violation) const {
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

}  // namespace ricochet
