// The head of JSON: the names, units and meanings of the columns of a table and of the axes of a sweep.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_SWEEP_HEAD_H_
#define RICOCHET_CLIENT_CLI_SWEEP_SWEEP_HEAD_H_

#include <string>
#include <vector>

#include "ricochet/sweep.h"

namespace ricochet::cli {

// Returns a list with the name, unit and meaning of each column of a table.
std::string ColumnsJson(const std::vector<std::string>& names);

// Returns the document of a sweep up to and including "values":. `names` are the cells of each point in their order.
std::string SweepHeadJson(const SweepRequest& request, const std::vector<std::string>& names, const EngineInfo& engine);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_SWEEP_HEAD_H_
