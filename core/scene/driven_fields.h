// DrivenFields: the fields of one scene that a sweep sets for each point, or a batch for each row.

#ifndef RICOCHET_CORE_SCENE_DRIVEN_FIELDS_H_
#define RICOCHET_CORE_SCENE_DRIVEN_FIELDS_H_

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "core/scene/field.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

class DrivenFields {
 public:
  // The request's name of its i-th driver: "axes[1]" or "fields[1]".
  using NameOf = absl::FunctionRef<std::string(size_t i)>;

  // Resolves each path in `scene`, which must outlive this object and keep its system, law and lists. `member` follows
  // the driver's name in the place of a violation: ".path" or nothing.
  DrivenFields(const std::vector<std::string>& paths, NameOf name_of, const char* member, Scene& scene);

  // The drivers whose path names no field of the scene, or one that another driver drives.
  const std::vector<Violation>& violations() const { return violations_; }

  // True if driving a field can cure this violation of the base scene.
  bool CanBeCured(const Violation& violation) const;

  // The fields of the drivers in their order, if there is no violation.
  size_t size() const { return fields_.size(); }
  const Field& operator[](size_t i) const { return fields_[i]; }

 private:
  std::vector<Field> fields_;
  std::vector<Violation> violations_;
  std::set<std::string> driven_;  // Paths of the numbers that are set whatever their base value.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_DRIVEN_FIELDS_H_
