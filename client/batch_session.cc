#include "client/batch_session.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/final_failure.h"
#include "core/types/check_rows.h"
#include "proto/wire/batch.h"
#include "proto/wire/engine.h"
#include "proto/wire/status.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

constexpr size_t kPieceBytes = size_t{1} << 20;
// The first message of a call has the setup beside its columns.
constexpr int64_t kBytesOfSetup = 4096;

absl::Status OtherEngine(const EngineInfo& before, const EngineInfo& now) {
  return absl::FailedPreconditionError(absl::StrCat("the batches began with engine ", before.version, " (",
                                                    before.fingerprint, ") and would go on with ", now.version, " (",
                                                    now.fingerprint, "), whose last bits may differ"));
}

// The columns in or out, whichever are more; at least one.
size_t ColumnsOf(const BatchSetup& setup) { return std::max({setup.fields.size(), setup.columns.size(), size_t{1}}); }

}  // namespace

size_t RowsOfAPiece(const BatchSetup& setup, int64_t max_receive_bytes) {
  // An answer has a few bytes of each row beside its columns, and a summary.
  const auto received = static_cast<size_t>(std::max<int64_t>(max_receive_bytes - kBytesOfSetup, 0));
  const size_t by_answer = received / ((setup.columns.size() + 1) * sizeof(double));
  return std::max(std::min(kPieceBytes / (ColumnsOf(setup) * sizeof(double)), by_answer), size_t{1});
}

size_t RowsOfAPiece(const BatchSetup& setup, const Limits& limits) {
  const auto columns = static_cast<int64_t>(ColumnsOf(setup));
  const int64_t by_bytes = (limits.max_request_bytes - kBytesOfSetup) / static_cast<int64_t>(sizeof(double)) / columns;
  return static_cast<size_t>(std::max<int64_t>(std::min(limits.max_batch_numbers / columns, by_bytes), 1));
}

RemoteBatches::RemoteBatches(const BatchSetup& setup, Start start, AskMostRows ask_most_rows, PreferredServer& servers,
                             const RetryPolicy& policy, int64_t max_receive_bytes, CallOptions options)
    : setup_(ToProto(setup)),
      fields_(setup.fields.size()),
      columns_(setup.columns.size()),
      piece_(RowsOfAPiece(setup, max_receive_bytes)),
      start_(std::move(start)),
      ask_most_rows_(std::move(ask_most_rows)),
      servers_(servers),
      policy_(policy),
      options_(std::move(options)) {}

absl::StatusOr<BatchSummary> RemoteBatches::Solve(const BatchRows& rows) {
  if (absl::Status misfit = CheckRows(rows, fields_, columns_); !misfit.ok()) return misfit;
  Remaining remaining = {.rows = rows, .first = 0, .end = RowCount(rows), .summary = {}};
  for (Attempts attempts(servers_, policy_);;) {
    if (IsStopped(options_)) return StoppedByCaller();
    const absl::Status status = Exchange(remaining, attempts);
    if (status.ok()) return remaining.summary;
    if (IsStopped(options_)) return StoppedByCaller();
    if (MakePiecesSmaller(status)) continue;
    const int most = std::max(policy_.max_attempts, static_cast<int>(servers_.count())) - 1;
    const auto wait = MayResume(status) ? attempts.AfterFailure(status, most) : std::nullopt;
    if (!wait.has_value() || !Pause(*wait, options_)) {
      return IsStopped(options_) ? StoppedByCaller() : ExplainFailure(status);
    }
  }
}

// Returns true if the server takes smaller pieces than that which it has refused.
bool RemoteBatches::MakePiecesSmaller(const absl::Status& status) {
  if (ReasonOf(status) != ErrorReason::kLimitExceeded) return false;
  const absl::StatusOr<size_t> most = ask_most_rows_();
  if (!most.ok() || *most >= piece_) return false;
  piece_ = *most;
  return true;
}

RemoteBatches::~RemoteBatches() {
  if (!call_.has_value()) return;
  call_->stream->WritesDone();
  static_cast<void>(End());
}

bool RemoteBatches::Write(const BatchRows& rows, size_t first, size_t count) {
  if (call_->has_setup) {
    request_.clear_setup();
  } else {
    *request_.mutable_setup() = setup_;
  }
  call_->has_setup = true;
  SetInputs(rows, first, count, request_);
  return call_->stream->Write(request_);
}

// Asks for all that remains by one call. No piece is sent before the answer to the last one has come: the server reads
// none while it writes, and behind a proxy what waits to be read would keep back what the answer waits for. The call is
// over after an error.
absl::Status RemoteBatches::Exchange(Remaining& remaining, Attempts& attempts) {
  if (!call_.has_value()) call_.emplace(options_, start_, attempts.server());
  do {
    const size_t count = PieceAt(remaining.first, remaining.end);
    if (!Write(remaining.rows, remaining.first, count) || !call_->stream->Read(&response_)) return End();
    if (absl::Status wrong = ReadAnswer(remaining); !wrong.ok()) {
      call_->context.get().TryCancel();
      static_cast<void>(End());
      return wrong;
    }
    attempts.Succeeded();
  } while (remaining.first < remaining.end);
  return absl::OkStatus();
}

absl::Status RemoteBatches::ReadAnswer(Remaining& remaining) {
  const EngineInfo engine = FromProto(response_.engine());
  if (engine_.fingerprint.empty()) engine_ = engine;
  if (engine.fingerprint != engine_.fingerprint) return OtherEngine(engine_, engine);
  const size_t count = PieceAt(remaining.first, remaining.end);
  if (absl::Status misfit = CopyOutputs(response_, remaining.first, count, remaining.rows); !misfit.ok()) return misfit;
  remaining.summary =
      Joined(std::move(remaining.summary), FromProto(response_.summary()), static_cast<int64_t>(remaining.first));
  remaining.first += count;
  return absl::OkStatus();
}

absl::Status RemoteBatches::End() {
  // gRPC allows Finish only after all answers were read.
  while (call_->stream->Read(&response_)) {
  }
  const absl::Status status = FromGrpcStatus(call_->stream->Finish());
  call_.reset();
  // A server ends a call only after the client has, so that this one broke off.
  return status.ok() ? absl::UnavailableError("the server ended the call before its last answer") : status;
}

}  // namespace ricochet
