#include "client/cli/io/one_table.h"

#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace ricochet::cli {

absl::Status CheckOneTable(Format format, std::initializer_list<TableOption> options) {
  std::vector<std::string> given;
  for (const TableOption& option : options) {
    if (option.is_given) given.emplace_back(option.name);
  }
  if (format != Format::kCsv || given.size() < 2) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(absl::StrJoin(given, ", "),
                                                 " cannot be combined as csv, which is one table: give one of them, or "
                                                 "--format json, which has all"));
}

}  // namespace ricochet::cli
