#include "proto/wire/batch.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "absl/strings/str_cat.h"
#include "proto/wire/demand.h"
#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/scene.h"
#include "proto/wire/sweep.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

// A string of fewer bytes may lie within its object, which need not be aligned for doubles.
constexpr size_t kLeastBytes = 64;

bool LiesAsDoubles(const std::string& bytes) {
  return reinterpret_cast<uintptr_t>(bytes.data()) % alignof(double) == 0;
}

// A column of a message, whose bytes are those of doubles.
absl::Span<const double> Doubles(const std::string& bytes) {
  return {reinterpret_cast<const double*>(bytes.data()), bytes.size() / sizeof(double)};
}

absl::Status Misfit(const std::string& what, size_t found, size_t wanted) {
  return absl::DataLossError(absl::StrCat("the answer to a batch has ", found, " ", what, " in place of ", wanted));
}

}  // namespace

template <>
struct Map<BatchSetup> : Between<BatchSetup, v1::BatchSetup> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(scene), RICOCHET_FIELD(fields), RICOCHET_FIELD(columns), Flat(&T::demand, kDemandEntries));
};

RICOCHET_MAP(BadRow, row, status, field, description);
RICOCHET_MAP(BatchSummary, counts, bad_rows);

RICOCHET_CONVERT(BatchSetup);
RICOCHET_CONVERT(BatchSummary);

void SetInputs(const BatchRows& rows, size_t first, size_t count, v1::SolveBatchRequest& request) {
  request.clear_inputs();
  for (const absl::Span<const double> column : rows.inputs) {
    request.add_inputs()->assign(reinterpret_cast<const char*>(column.data() + first), count * sizeof(double));
  }
}

absl::Status CopyOutputs(const v1::SolveBatchResponse& response, size_t first, size_t count, const BatchRows& rows) {
  const auto columns = static_cast<size_t>(response.outputs_size());
  if (columns != rows.outputs.size()) return Misfit("columns", columns, rows.outputs.size());
  for (const std::string& column : response.outputs()) {
    if (column.size() != count * sizeof(double))
      return Misfit("bytes in a column", column.size(), count * sizeof(double));
  }
  if (response.regimes().size() != count) return Misfit("regimes", response.regimes().size(), count);
  if (response.statuses().size() != count) return Misfit("statuses", response.statuses().size(), count);
  for (const v1::BadRow& bad : response.summary().bad_rows()) {
    if (bad.row() >= 0 && static_cast<size_t>(bad.row()) < count) continue;
    return absl::DataLossError(absl::StrCat("the batch's answer names row ", bad.row(), " of ", count));
  }
  for (size_t c = 0; c < columns; ++c) {
    CopyDoubles(response.outputs(static_cast<int>(c)), rows.outputs[c].subspan(first, count));
  }
  const auto at = static_cast<ptrdiff_t>(first);
  if (!rows.regimes.empty()) {
    std::transform(response.regimes().begin(), response.regimes().end(), rows.regimes.begin() + at, CodeOf<Regime>);
  }
  if (!rows.statuses.empty()) {
    std::transform(response.statuses().begin(), response.statuses().end(), rows.statuses.begin() + at,
                   CodeOf<RowStatus>);
  }
  return absl::OkStatus();
}

absl::Status BatchExchange::OpenInputs(const v1::SolveBatchRequest& request) {
  const auto columns = static_cast<size_t>(request.inputs_size());
  std::vector<Violation> violations;
  rows_ = {};
  aligned_.resize(columns);
  for (size_t k = 0; k < columns && !IsFull(violations); ++k) {
    const std::string& bytes = request.inputs(static_cast<int>(k));
    if (bytes.size() % sizeof(double) != 0) {
      violations.push_back(
          {absl::StrCat("inputs[", k, "]"), absl::StrCat("has ", bytes.size(), " bytes: must have 8 for each row")});
    } else if (LiesAsDoubles(bytes)) {
      rows_.inputs.push_back(Doubles(bytes));
    } else {
      aligned_[k].resize(bytes.size() / sizeof(double));
      CopyDoubles(bytes, absl::MakeSpan(aligned_[k]));
      rows_.inputs.emplace_back(aligned_[k]);
    }
  }
  return violations.empty() ? absl::OkStatus() : InvalidRequest(violations);
}

void BatchExchange::OpenOutputs(size_t columns, v1::SolveBatchResponse& response) {
  const size_t count = row_count();
  response.Clear();
  for (size_t c = 0; c < columns; ++c) {
    std::string& bytes = *response.add_outputs();
    bytes.resize(std::max(count * sizeof(double), kLeastBytes));
    rows_.outputs.emplace_back(reinterpret_cast<double*>(bytes.data()), count);
  }
  regimes_.resize(count);
  statuses_.resize(count);
  rows_.regimes = absl::MakeSpan(regimes_);
  rows_.statuses = absl::MakeSpan(statuses_);
}

void BatchExchange::Close(const BatchSummary& summary, const EngineInfo& engine, v1::SolveBatchResponse& response) {
  for (std::string& bytes : *response.mutable_outputs()) bytes.resize(row_count() * sizeof(double));
  SetCodes(regimes_, *response.mutable_regimes());
  SetCodes(statuses_, *response.mutable_statuses());
  *response.mutable_summary() = ToProto(summary);
  ToProto(engine, *response.mutable_engine());
}

absl::StatusOr<BatchSummary> BatchExchange::Answer(BatchSession& session, size_t columns,
                                                   const v1::SolveBatchRequest& request,
                                                   v1::SolveBatchResponse& response) {
  if (absl::Status wrong = OpenInputs(request); !wrong.ok()) return wrong;
  if (absl::Status too_large = session.CheckSize(row_count()); !too_large.ok()) return too_large;
  OpenOutputs(columns, response);
  absl::StatusOr<BatchSummary> summary = session.Solve(rows());
  if (summary.ok()) {
    Close(*summary, session.engine(), response);
  } else {
    response.Clear();
  }
  return summary;
}

}  // namespace ricochet
