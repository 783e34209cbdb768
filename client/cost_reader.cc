#include "client/cost_reader.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/call_context.h"
#include "proto/wire/cost.h"

namespace ricochet {
namespace {

// True if every index lies in [least, rows).
template <typename Indices, typename Index>
bool AllWithin(const Indices& indices, int64_t least, int64_t rows, Index index) {
  return std::all_of(indices.begin(), indices.end(),
                     [&](const auto& entry) { return index(entry) >= least && index(entry) < rows; });
}

}  // namespace

absl::StatusOr<CostChunk> CostChecker::Accept(const v1::CostResponse& message) {
  CostChunk chunk = FromProto(message);
  if (absl::Status status = Check(chunk); !status.ok()) return status;
  return chunk;
}

absl::Status CostChecker::Check(const CostChunk& chunk) {
  if (summarised_) return absl::DataLossError("the study of cost goes on after its summary");
  if (chunk.first_row != rows_) {
    return absl::DataLossError(
        absl::StrCat("the study's next rows should start at row ", rows_, " but start at ", chunk.first_row));
  }
  rows_ += static_cast<int64_t>(chunk.rows.size());
  if (chunk.rows_done != rows_ || chunk.rows_done > chunk.rows_total) {
    return absl::DataLossError(
        absl::StrCat("the study has ", rows_, " rows and not ", chunk.rows_done, " of ", chunk.rows_total));
  }
  summarised_ = chunk.summary.has_value();
  if (summarised_ != (chunk.rows_done == chunk.rows_total)) {
    return absl::DataLossError(absl::StrCat("the study's summary is ", summarised_ ? "early" : "missing", " at row ",
                                            rows_, " of ", chunk.rows_total));
  }
  if (!summarised_) return absl::OkStatus();
  const bool within = AllWithin(chunk.summary->front, 0, rows_, [](int64_t row) { return row; }) &&
                      AllWithin(chunk.summary->picks, -1, rows_, [](const CostPick& pick) { return pick.row; });
  return within ? absl::OkStatus() : absl::DataLossError("the study's summary names a row that it does not have");
}

void AddPart(CostChunk part, CostChunk& study) {
  std::move(part.rows.begin(), part.rows.end(), std::back_inserter(study.rows));
  study.rows_done = part.rows_done;
  study.rows_total = part.rows_total;
  study.summary = std::move(part.summary);
  study.engine = std::move(part.engine);
}

absl::StatusOr<CostChunk> WholeStudy(CostStream parts, const std::function<void(const CostChunk&)>& see) {
  CostChunk whole;
  for (absl::StatusOr<CostChunk>& part : parts) {
    if (!part.ok()) return part.status();
    see(*part);
    AddPart(*std::move(part), whole);
  }
  if (!whole.summary.has_value()) return absl::DataLossError("the study ended without a summary");
  return whole;
}

absl::Status CostChecker::CheckEnd() const {
  if (summarised_) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("the study of cost ended at row ", rows_, " without its summary"));
}

std::optional<absl::StatusOr<CostChunk>> CostReader::Next() {
  // Once the caller has asked to stop, chunks that had already arrived are dropped.
  if (!call_.Read(message_)) return End(call_.Finish());
  if (IsStopped(options_) && !message_.has_summary()) return End(call_.Cancel());
  return checker_.Accept(message_);
}

std::optional<absl::StatusOr<CostChunk>> CostReader::End(const absl::Status& status) {
  const absl::Status complete = checker_.CheckEnd();
  if (IsStopped(options_) && !complete.ok()) return StoppedByCaller();
  if (!status.ok() && !IsStopped(options_)) return status;
  if (!complete.ok()) return complete;
  return std::nullopt;
}

}  // namespace ricochet
