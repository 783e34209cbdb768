#include "core/types/check_rows.h"

#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/strings/str_cat.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

void CheckCount(const char* list, size_t found, size_t wanted, const char* named, std::vector<Violation>& violations) {
  if (found == wanted) return;
  violations.push_back(MakeViolation(list, absl::StrCat("has ", found, found == 1 ? " column" : " columns"),
                                     absl::StrCat("have ", wanted, ", one for each of ", named)));
}

// `name` is asked for if the column is wrong.
void CheckLength(size_t found, size_t rows, absl::FunctionRef<std::string()> name, std::vector<Violation>& violations) {
  if (found == rows || IsFull(violations)) return;
  violations.push_back(MakeViolation(name(), absl::StrCat("has ", found, found == 1 ? " row" : " rows"),
                                     absl::StrCat("have ", rows, ", as many as inputs[0]")));
}

template <typename Columns>
void CheckLengths(const char* list, const Columns& columns, size_t rows, std::vector<Violation>& violations) {
  for (size_t i = 0; i < columns.size(); ++i) {
    CheckLength(
        columns[i].size(), rows, [&] { return absl::StrCat(list, "[", i, "]"); }, violations);
  }
}

}  // namespace

absl::Status CheckRows(const BatchRows& rows, size_t fields, size_t columns) {
  std::vector<Violation> violations;
  const size_t count = RowCount(rows);
  CheckCount("inputs", rows.inputs.size(), fields, "fields", violations);
  CheckCount("outputs", rows.outputs.size(), columns, "columns", violations);
  CheckLengths("inputs", rows.inputs, count, violations);
  CheckLengths("outputs", rows.outputs, count, violations);
  const auto check = [&](const char* name, size_t found) {
    if (found > 0)
      CheckLength(
          found, count, [name] { return std::string(name); }, violations);
  };
  check("regimes", rows.regimes.size());
  check("statuses", rows.statuses.size());
  return violations.empty() ? absl::OkStatus() : InvalidRequest(violations);
}

}  // namespace ricochet
