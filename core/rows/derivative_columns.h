// DerivativeColumns: the columns of a sweep or a batch that are derivatives, "d(OF)/d(BY)":
// "d(contact_velocity_after.normal_m_s)/d(friction.kinetic_coefficient)".
//
// The value is that of Derivative::value, quiet NaN where the two sides differ or do not exist: the row then has
// RowStatus::kIncomplete, and a Solve of its scene says why.

#ifndef RICOCHET_CORE_ROWS_DERIVATIVE_COLUMNS_H_
#define RICOCHET_CORE_ROWS_DERIVATIVE_COLUMNS_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/types/span.h"
#include "core/answer/exact_derivatives.h"
#include "core/base/derivative_name.h"
#include "core/plan/demand.h"
#include "ricochet/derivatives.h"
#include "ricochet/scene.h"

namespace ricochet {

// The rule that the column breaks as a derivative of the valid scene; empty if it breaks none.
std::string RuleForDerivative(const Scene& scene, const DerivativeName& name);

class DerivativeColumns {
 public:
  // CheckColumns finds nothing in the columns.
  explicit DerivativeColumns(absl::Span<const std::string> columns);

  bool empty() const { return asked_.empty(); }

  // Returns the numbers of those of `count` columns that are no derivatives.
  std::vector<size_t> Others(size_t count) const;

  // Sets entry `i` of the columns that are derivatives for a valid scene that has an outcome, and `is_complete` to
  // whether all of them have a value. All scenes have one form.
  // Errors: those of DerivativesOf.
  absl::Status Set(const Scene& scene, const Demand& demand, absl::FunctionRef<bool()> stopped,
                   absl::Span<double* const> columns, size_t i, bool& is_complete);

 private:
  // A column, with the places of its numbers among the paths.
  struct Asked {
    size_t column, of, by;
  };

  DerivativePaths paths_;  // Each number once.
  std::vector<Asked> asked_;
  std::optional<ExactDerivatives> exact_;  // For the form of the first scene that has exact ones.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_DERIVATIVE_COLUMNS_H_
