// RequestCost: how expensive a unary call is, known from its request alone and before any work.
//
// A cheap call takes at most a millisecond or so on a machine of the 2020s, whatever its numbers are. Every other call
// is expensive; its cause and size say which calls take about the same time.

#ifndef RICOCHET_SERVER_ADMISSION_REQUEST_COST_H_
#define RICOCHET_SERVER_ADMISSION_REQUEST_COST_H_

#include <compare>
#include <cstddef>

#include "ricochet/solver.h"

namespace ricochet::server {

// CostCause says why a call is expensive.
enum class CostCause {
  kNothing,      // The call is cheap.
  kCertificate,  // Certified digits.
  kEnclosure,    // Ranges of uncertain fields.
  kDuration,     // An impact that takes time is integrated.
  kHistory,      // A long history.
  kLinks,        // A linkage of many links or a mechanism of many coordinates.
  kRows,         // A batch of many rows.
  kContacts,     // Many contacts at once, or many states of them.
  kDerivatives,  // Derivatives by many numbers of the scene.
  kFit,          // A fit of measured impacts.
};

struct RequestCost {
  CostCause cause = CostCause::kNothing;
  int octave = 0;  // Binary logarithm of the size of the work, rounded down; the unit differs from cause to cause.

  bool is_cheap() const { return cause == CostCause::kNothing; }
  friend auto operator<=>(const RequestCost&, const RequestCost&) = default;  // NOLINT(modernize-use-nullptr)
};

RequestCost CostOf(const SolveRequest& request);
RequestCost CostOf(const PlanRequest& request);
RequestCost CostOf(const BoundsRequest& request);
RequestCost CostOf(const AuditRequest& request);
RequestCost CostOf(const AuditBatchRequest& request);
RequestCost CostOf(const FitRequest& request);
RequestCost CostOf(const MultiContactRequest& request);
RequestCost CostOf(const BatchSetup& setup, size_t rows);
RequestCost CostOf(const InfoRequest& request);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_REQUEST_COST_H_
