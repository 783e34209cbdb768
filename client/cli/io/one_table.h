// OneTable: CSV is one table, so that options which each ask for a table of their own exclude each other.

#ifndef RICOCHET_CLIENT_CLI_IO_ONE_TABLE_H_
#define RICOCHET_CLIENT_CLI_IO_ONE_TABLE_H_

#include <initializer_list>

#include "absl/status/status.h"
#include "client/cli/io/output_format.h"

namespace ricochet::cli {

// An option that changes which table an answer has, and whether it was given.
struct TableOption {
  const char* name;
  bool is_given;
};

// Errors: INVALID_ARGUMENT that names the options, if the format is CSV and several are given.
absl::Status CheckOneTable(Format format, std::initializer_list<TableOption> options);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_IO_ONE_TABLE_H_
