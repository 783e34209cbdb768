#include "server/calls/batch_answer.h"

#include <utility>

#include "ricochet/error.h"

namespace ricochet::server {
namespace {

void Count(const BatchSummary& summary, CallRecord& record) {
  record.points = record.points.value_or(0) + summary.counts.points;
  for (size_t i = 0; i < summary.counts.by_model.size(); ++i) {
    record.solved_by_model[i] += summary.counts.by_model[i].count;
  }
}

absl::Status NoSetup() { return InvalidRequest({{"setup", "is not set: must be in the first request of a call"}}); }

}  // namespace

RequestCost BatchAnswer::CostOf(const v1::SolveBatchRequest& request) {
  if (request.has_setup()) {
    setup_ = FromProto(request.setup());
    session_.reset();
  }
  const size_t bytes = request.inputs_size() == 0 ? 0 : request.inputs(0).size();
  return server::CostOf(setup_, bytes / sizeof(double));
}

absl::Status BatchAnswer::Fill(const v1::SolveBatchRequest& request, v1::SolveBatchResponse& response,
                               CallRecord& record) {
  if (!session_.has_value()) {
    if (!request.has_setup()) return NoSetup();
    absl::StatusOr<BatchSession> session = solver_.OpenBatches(setup_, options_);
    if (!session.ok()) return session.status();
    session_.emplace(*std::move(session));
  }
  const absl::StatusOr<BatchSummary> summary =
      BatchExchange().Answer(*session_, setup_.columns.size(), request, response);
  if (summary.ok()) Count(*summary, record);
  return summary.status();
}

}  // namespace ricochet::server
