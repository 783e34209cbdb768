// BatchAnswer: answers one request for a batch after another. Requests without a setup of their own keep the last one.

#ifndef RICOCHET_SERVER_CALLS_BATCH_ANSWER_H_
#define RICOCHET_SERVER_CALLS_BATCH_ANSWER_H_

#include <optional>

#include "absl/status/status.h"
#include "proto/wire/batch.h"
#include "ricochet/batch.h"
#include "ricochet/call_options.h"
#include "ricochet/solver.h"
#include "ricochet/v1/batch.pb.h"
#include "server/admission/request_cost.h"
#include "server/telemetry/call_record.h"

namespace ricochet::server {

// Thread safety: one thread at a time.
class BatchAnswer {
 public:
  // Every batch ends when the options say so. `solver` must outlive this object.
  BatchAnswer(const Solver& solver, CallOptions options) : solver_(solver), options_(std::move(options)) {}

  // Returns how expensive the answer to the request is.
  RequestCost CostOf(const v1::SolveBatchRequest& request);

  // Fills the response, and adds the models that have solved rows to the record.
  // Errors: those of BatchSession, and INVALID_ARGUMENT if no request has had a setup yet.
  absl::Status Fill(const v1::SolveBatchRequest& request, v1::SolveBatchResponse& response, CallRecord& record);

 private:
  const Solver& solver_;
  const CallOptions options_;
  BatchSetup setup_;
  std::optional<BatchSession> session_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_CALLS_BATCH_ANSWER_H_
