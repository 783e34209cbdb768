// CheckRows: checks whether the columns of a batch fit its setup and each other.

#ifndef RICOCHET_CORE_TYPES_CHECK_ROWS_H_
#define RICOCHET_CORE_TYPES_CHECK_ROWS_H_

#include <cstddef>

#include "absl/status/status.h"
#include "ricochet/batch.h"

namespace ricochet {

// The number of rows: the length of the first input column.
inline size_t RowCount(const BatchRows& rows) { return rows.inputs.empty() ? 0 : rows.inputs.front().size(); }

// `fields` and `columns` are the numbers of input and output columns that the setup has.
// Errors: INVALID_ARGUMENT with a violation for each list or column that does not fit.
absl::Status CheckRows(const BatchRows& rows, size_t fields, size_t columns);

}  // namespace ricochet

#endif  // RICOCHET_CORE_TYPES_CHECK_ROWS_H_
