#include "core/types/check_rows.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/strings/str_cat.h"
#include "core/base/counted.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

void CheckCount(const char* list, size_t found, size_t wanted, const char* named, std::vector<Violation>& violations) {
  if (found == wanted) return;
  violations.push_back(MakeViolation(list, absl::StrCat("has ", Counted(found, "column")),
                                     absl::StrCat("have ", wanted, ", one for each of ", named)));
}

// `name` makes a text, so it is called only if the column is wrong.
void CheckLength(size_t found, size_t rows, absl::FunctionRef<std::string()> name, std::vector<Violation>& violations) {
  if (found == rows || IsFull(violations)) return;
  violations.push_back(MakeViolation(name(), absl::StrCat("has ", Counted(found, "row")),
                                     absl::StrCat("have ", rows, ", as many as inputs[0]")));
}

template <typename Columns>
void CheckLengths(const char* list, const Columns& columns, size_t rows, std::vector<Violation>& violations) {
  for (size_t i = 0; i < columns.size(); ++i) {
    CheckLength(
        columns[i].size(), rows, [&] { return absl::StrCat(list, "[", i, "]"); }, violations);
  }
}

// A column of the caller's memory, named by its list and its place in it.
struct Memory {
  const char* list;
  size_t place;
  const void* begin;
  const void* end;
  bool Overlaps(const Memory& other) const {
    const std::less<> before;
    return before(begin, other.end) && before(other.begin, end);
  }
};

template <typename Columns>
std::vector<Memory> MemoriesOf(const char* list, const Columns& columns) {
  std::vector<Memory> memories;
  for (size_t i = 0; i < columns.size(); ++i) {
    memories.push_back(
        {.list = list, .place = i, .begin = columns[i].data(), .end = columns[i].data() + columns[i].size()});
  }
  return memories;
}

// Outputs must not overlap other columns, because they are written before all inputs are read.
void CheckApart(const BatchRows& rows, std::vector<Violation>& violations) {
  std::vector<Memory> others = MemoriesOf("inputs", rows.inputs);
  for (const Memory& output : MemoriesOf("outputs", rows.outputs)) {
    const auto shared =
        std::find_if(others.begin(), others.end(), [&output](const Memory& other) { return output.Overlaps(other); });
    if (shared != others.end() && !IsFull(violations)) {
      violations.push_back(MakeViolation(absl::StrCat("outputs[", output.place, "]"),
                                         absl::StrCat("overlaps ", shared->list, "[", shared->place, "]"),
                                         "share no memory with another column"));
    }
    others.push_back(output);
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
  CheckApart(rows, violations);
  return violations.empty() ? absl::OkStatus() : InvalidRequest(violations);
}

}  // namespace ricochet
