// CheckLimits: compares the sizes of a request with the limits, before the request is validated or copied.
//
// It takes time proportional to the lists of the request and no memory beyond its message. A size within the limits may
// still break a rule of the request; validation says so.
// Errors: RESOURCE_EXHAUSTED with ErrorReason::kLimitExceeded and one violation for each field that is too large.

#ifndef RICOCHET_CORE_ENGINE_CHECK_LIMITS_H_
#define RICOCHET_CORE_ENGINE_CHECK_LIMITS_H_

#include <cstddef>
#include <cstdint>

#include "absl/status/status.h"
#include "ricochet/limits.h"
#include "ricochet/solver.h"

namespace ricochet {

absl::Status CheckLimits(const SolveRequest& request, const Limits& limits);
absl::Status CheckLimits(const PlanRequest& request, const Limits& limits);
absl::Status CheckLimits(const BoundsRequest& request, const Limits& limits);
absl::Status CheckLimits(const AuditRequest& request, const Limits& limits);
absl::Status CheckLimits(const AuditBatchRequest& request, const Limits& limits);
absl::Status CheckLimits(const FitRequest& request, const Limits& limits);
absl::Status CheckLimits(const MultiContactRequest& request, const Limits& limits);
absl::Status CheckLimits(const BatchSetup& setup, const Limits& limits);
absl::Status CheckLimits(const SweepRequest& request, const Limits& limits);
absl::Status CheckLimits(const CostRequest& request, const Limits& limits);

// Compares the rows of a batch times its columns, in or out, with the limit.
absl::Status CheckBatchSize(size_t rows, size_t columns, const Limits& limits);

// Compares the number of points of a valid sweep with the limit.
// Errors: RESOURCE_EXHAUSTED with ErrorReason::kSweepTooLarge.
absl::Status CheckPoints(int64_t points, const Limits& limits);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_CHECK_LIMITS_H_
