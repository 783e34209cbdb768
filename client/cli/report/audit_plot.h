// AuditPlot: the picture of audited impacts.

#ifndef RICOCHET_CLIENT_CLI_REPORT_AUDIT_PLOT_H_
#define RICOCHET_CLIENT_CLI_REPORT_AUDIT_PLOT_H_

#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/plot/plot.h"
#include "ricochet/audit.h"

namespace ricochet::cli {

// It keeps the reports in memory, so it refuses more than a picture can show.
class AuditPlot {
 public:
  static constexpr size_t kMostRows = 20'000;

  // Adds the report of the next row; it ignores rows beyond kMostRows.
  void Add(const AuditReport& report);

  // Returns the tangential over the normal impulse of each row with the friction cone, the energetic coefficient of
  // each row with its limit, and the change of the kinetic energy with its limit. Rows are told apart by their verdict.
  // Errors: FAILED_PRECONDITION for more than kMostRows rows, or if no row has numbers.
  absl::StatusOr<Plot> Make() const;

 private:
  std::vector<AuditReport> reports_;
  size_t rows_ = 0;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_AUDIT_PLOT_H_
