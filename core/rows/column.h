// Columns: the numbers of an Outcome that a sweep or a batch can ask for, by path, and the derivatives of such numbers
// (core/rows/derivative_columns.h).
//
// Whether an outcome may have a number depends on the parts of its scene and not on their numbers: on the system, its
// links and bodies, an impact law, a normal spring. A number that no outcome of the scene can have is refused. One that
// a single outcome leaves unset, such as the duration of a contact that separates, is quiet NaN in its row.

#ifndef RICOCHET_CORE_ROWS_COLUMN_H_
#define RICOCHET_CORE_ROWS_COLUMN_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "core/contact/scene_contact.h"
#include "core/plan/demand.h"
#include "ricochet/error.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"
#include "ricochet/sweep.h"

namespace ricochet {

// Lists every column of a sweep over the scene but derivatives, as ricochet.v1.Outcome spells it:
// "coefficients.newton", "rates_after_rad_s[0]".
std::vector<std::string> Columns(const Scene& scene);

// Lists the columns and, in their places, the numbers that no outcome of the scene can have although others have them.
std::vector<std::string> ColumnPlaces(const Scene& scene);

// True if an outcome may leave the number unset although it is a column of the scene.
bool MayBeUnset(absl::string_view column);

// Lists what is wrong with the columns that a request names: there must be at least one, each a column of the scene and
// named once.
std::vector<Violation> CheckColumns(const Scene& scene, const std::vector<std::string>& columns);

// Lists why a demand cannot have the effects that make the columns (core/plan/number_demand.h). Neither Validate and
// CheckDemand nor CheckColumns may have found anything.
std::vector<Violation> CheckEffectsBehind(const Scene& scene, std::optional<SceneContact>& contact,
                                          const Demand& demand, const std::vector<std::string>& columns);

// Reads the columns of a request off outcomes.
class ColumnReader {
 public:
  // CheckColumns finds nothing. The outcomes are those of scenes that differ from `scene` in numbers only.
  ColumnReader(const Scene& scene, const std::vector<std::string>& columns);

  struct Reading {
    RowStatus status = RowStatus::kOk;
    std::optional<size_t> too_large;  // The first column whose number exceeds the largest double, if one does.
  };
  // Sets `numbers` to the number behind each column, in the order of the request.
  Reading Read(const Outcome& outcome, std::vector<double>& numbers) const;

 private:
  // A place of an outcome.
  struct Place {
    std::optional<size_t> column;  // The column of the request that has this number; unset if none has.
    bool may_be_infinite = false;
  };

  size_t columns_;
  std::vector<Place> places_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_COLUMN_H_
