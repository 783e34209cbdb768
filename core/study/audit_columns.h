// Audit of many impacts given by columns: to lint a whole run of a simulator or an experiment.

#ifndef RICOCHET_CORE_STUDY_AUDIT_COLUMNS_H_
#define RICOCHET_CORE_STUDY_AUDIT_COLUMNS_H_

#include <array>
#include <cstdint>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/study/audit.h"

namespace ricochet::audit {

// Each column has `rows` values, or one for all rows; an empty one has the value it is said to have.
struct PlanarColumns {
  int64_t rows = 0;
  absl::Span<const double> wtt, wtn, wnn;  // 1/kg
  absl::Span<const double> mu;
  absl::Span<const double> mu_static;       // Empty: mu.
  absl::Span<const double> u0, v0, u1, v1;  // m/s
  absl::Span<const double> uncertainty;     // m/s; empty: 0.
};

struct SpatialColumns {
  int64_t rows = 0;
  absl::Span<const double> w11, w12, w13, w22, w23, w33;
  absl::Span<const double> mu;
  absl::Span<const double> mu_static;  // Empty: mu.
  std::array<absl::Span<const double>, 2> u0, u1;
  absl::Span<const double> v0, v1;
  absl::Span<const double> uncertainty;  // Empty: 0.
  double tolerance = 1e-10;              // Of the path, core/models/spatial/spatial.h.
};

// Counts a row's report.
void Add(int64_t row, const AuditReport& report, AuditSummary& summary);

// Audits row after row, in order, and hands each report to `receive`. A row that is not finite, or whose W is not
// positive semidefinite with Wnn > 0, mu < 0, mu_s < mu, uncertainty < 0, or in a plane W of rank one with (u0, v0)
// outside its range, gets a report of regime kInvalid; so does one with OverflowIn its report.
// Errors: INVALID_ARGUMENT naming each column whose length is neither 1 nor `rows`, empty ones without a default
// included. No rows: none.
absl::StatusOr<AuditSummary> AuditColumns(const PlanarColumns& columns,
                                          absl::FunctionRef<void(int64_t row, const AuditReport& report)> receive);
absl::StatusOr<AuditSummary> AuditColumns(const SpatialColumns& columns,
                                          absl::FunctionRef<void(int64_t row, const AuditReport& report)> receive);

}  // namespace ricochet::audit

#endif  // RICOCHET_CORE_STUDY_AUDIT_COLUMNS_H_
