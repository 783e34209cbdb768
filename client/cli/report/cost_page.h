// CostPage: a cost study as one HTML page that needs nothing beside it.

#ifndef RICOCHET_CLIENT_CLI_REPORT_COST_PAGE_H_
#define RICOCHET_CLIENT_CLI_REPORT_COST_PAGE_H_

#include <string>

#include "absl/status/statusor.h"
#include "ricochet/cost.h"
#include "ricochet/scene.h"

namespace ricochet::cli {

// Returns "pendulum", "planar body" or another name of the scene's system.
std::string SystemText(const Scene& scene);

// Returns the page of a whole study of `scene`: all rows in one CostChunk, with its summary. `date` stands on the page.
// Errors: those of DrawAs.
absl::StatusOr<std::string> CostPage(const Scene& scene, const CostChunk& study, const std::string& date);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_COST_PAGE_H_
