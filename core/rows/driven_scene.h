// DrivenScene: the scene of each row of a sweep or of a batch in turn, as its fields get the values of the row.

#ifndef RICOCHET_CORE_ROWS_DRIVEN_SCENE_H_
#define RICOCHET_CORE_ROWS_DRIVEN_SCENE_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "core/contact/reduction.h"
#include "core/contact/scene_contact.h"
#include "core/rows/row_source.h"
#include "core/scene/field.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

class DrivenScene {
 public:
  // Resolves the paths in a copy of the scene, which the resolved fields then point into; no path if the scene has no
  // system, which is then the only violation. The last two arguments are as in DrivenFields.
  DrivenScene(const Scene& scene, const std::vector<std::string>& paths, DrivenFields::NameOf name_of,
              const char* member);
  // This constructor is for a request that has been checked.
  DrivenScene(const Scene& scene, const std::vector<std::string>& paths);
  DrivenScene(const DrivenScene&) = delete;
  DrivenScene& operator=(const DrivenScene&) = delete;

  // Lists what is wrong with the paths: see DrivenFields.
  const std::vector<Violation>& violations() const { return fields_.violations(); }

  // True if driving a field can cure this violation of the base scene. IsValid decides it for each row.
  bool CanBeCured(const Violation& violation) const { return fields_.CanBeCured(violation); }

  // The scene of the current row; at first it is the base scene.
  const Scene& scene() const { return scene_; }
  const DrivenFields& fields() const { return fields_; }

  // The functions below require that violations() is empty and that fields can cure every violation of the base scene.
  // Set sets the field of one path. It returns false if the value breaks the rule of its number.
  bool Set(size_t k, double value);
  // Sets all fields to row `i` of their columns. A field that has its value already costs nothing.
  void SetRow(absl::Span<const FieldColumn> columns, size_t i);
  // Decides whether Validate would find nothing in the current scene. `contact` is as in Validate.
  bool IsValid(std::optional<SceneContact>& contact);

 private:
  // The last value of a field.
  struct Last {
    std::optional<uint64_t> bits;
    bool is_bad = false;  // It breaks the rule of its number.
  };

  Scene scene_;
  DrivenFields fields_;                    // One a path.
  bool has_relations_ = false;             // True if the scene has rules beyond those of single numbers.
  bool reduces_once_ = false;              // True if no field changes the reduction.
  std::optional<AnyReduction> reduction_;  // All rows may share one; it is set once a row has asked for it.
  std::vector<Last> last_;                 // One a field.
  int64_t bad_fields_ = 0;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_DRIVEN_SCENE_H_
