#include "client/sweep_reader.h"

#include <algorithm>
#include <utility>

#include "client/call_context.h"
#include "proto/wire/sweep.h"

namespace ricochet {
SweepReader::SweepReader(const SweepRequest& request, Start start, PreferredServer& servers, const RetryPolicy& policy,
                         std::optional<std::chrono::milliseconds> deadline, const CallOptions& options, Sleeper sleep)
    : checker_(request),
      request_(ToProto(request)),
      start_(std::move(start)),
      sleep_(std::move(sleep)),
      options_(WithDeadline(options, deadline)),
      policy_(policy),
      most_starts_(std::max(policy.max_attempts, static_cast<int>(servers.count()))),
      attempts_(servers, policy) {
  Ask();
}

void SweepReader::Ask() {
  call_.emplace([this](grpc::ClientContext* context) { return start_(attempts_.server(), context, request_); },
                std::nullopt, options_);
}

std::optional<absl::StatusOr<SweepChunk>> SweepReader::Next() {
  for (;;) {
    if (call_->Read(message_)) return Received();
    const std::optional<absl::Status> end = AfterEnd();
    if (!end.has_value()) continue;
    if (end->ok()) return std::nullopt;
    return *end;
  }
}

absl::StatusOr<SweepChunk> SweepReader::Received() {
  // Once the caller has asked to stop, chunks that had already arrived are dropped.
  if (IsStopped(options_) && !message_.has_summary()) return StoppedByCaller();
  absl::StatusOr<SweepChunk> chunk = checker_.Accept(message_);
  if (chunk.ok()) attempts_.Succeeded();
  return chunk;
}

// Returns OK if the sweep is complete, its final error, or nothing if another call now goes on with it.
std::optional<absl::Status> SweepReader::AfterEnd() {
  const absl::Status status = call_->Finish();
  const absl::Status complete = checker_.CheckEnd();
  // A call that fails after its summary has already delivered everything.
  if (complete.ok()) return complete;
  if (IsStopped(options_)) return StoppedByCaller();
  if (status.ok()) return complete;
  if (!MayResume(status)) return status;
  const auto wait = attempts_.AfterFailure(status, checker_.has_begun() ? policy_.max_resumes : most_starts_ - 1);
  if (!wait.has_value()) return status;
  if (!sleep_(*wait, options_)) return IsStopped(options_) ? StoppedByCaller() : status;
  checker_.StartCall();
  request_.set_first_index(checker_.next_index());
  Ask();
  return std::nullopt;
}

}  // namespace ricochet
