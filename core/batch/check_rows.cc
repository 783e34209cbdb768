#include "core/batch/check_rows.h"

#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

std::string Name(const char* list, size_t i) { return absl::StrCat(list, "[", i, "]"); }

void CheckCount(const char* list, size_t found, size_t wanted, const char* named, std::vector<Violation>& violations) {
  if (found == wanted) return;
  violations.push_back({list, absl::StrCat("has ", found, found == 1 ? " column" : " columns", ": must have ", wanted,
                                           ", one for each of ", named)});
}

void CheckLength(const std::string& name, size_t found, size_t rows, std::vector<Violation>& violations) {
  if (found == rows || IsFull(violations)) return;
  violations.push_back({name, absl::StrCat("has ", found, found == 1 ? " row" : " rows", ": must have ", rows,
                                           ", as many as inputs[0]")});
}

}  // namespace

absl::Status CheckRows(const BatchRows& rows, size_t fields, size_t columns) {
  std::vector<Violation> violations;
  const size_t count = RowCount(rows);
  CheckCount("inputs", rows.inputs.size(), fields, "fields", violations);
  CheckCount("outputs", rows.outputs.size(), columns, "columns", violations);
  for (size_t k = 0; k < rows.inputs.size(); ++k)
    CheckLength(Name("inputs", k), rows.inputs[k].size(), count, violations);
  for (size_t c = 0; c < rows.outputs.size(); ++c) {
    CheckLength(Name("outputs", c), rows.outputs[c].size(), count, violations);
  }
  if (!rows.regimes.empty()) CheckLength("regimes", rows.regimes.size(), count, violations);
  if (!rows.statuses.empty()) CheckLength("statuses", rows.statuses.size(), count, violations);
  return violations.empty() ? absl::OkStatus() : InvalidRequest(violations);
}

}  // namespace ricochet
