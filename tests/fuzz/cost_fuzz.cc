// Fuzzes the study of cost: bytes are a v1::CostRequest, which is answered with one sample of each time and as much
// time as a study of one contact needs.
//
// It checks the status; that the stream begins with a chunk without rows, counts its rows, and ends with a summary;
// that names are short and different; that a measured method has a time, finite velocities and errors that are no NaN;
// that the front is one and the picks go through all tolerances; that the counts of the summary are those of the rows;
// and that no method errs by more than it claims.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "core/scene/validate.h"
#include "core/scene/validate_multi.h"
#include "proto/wire/cost.h"
#include "ricochet/solver.h"
#include "tests/fuzz/fail.h"
#include "tests/fuzz/mutate_message.h"
#include "tests/fuzz/outcome_claims.h"

namespace ricochet {
namespace {

constexpr double kTimeLimitS = 0.5;
constexpr size_t kMostName = 32;

void CheckTime(const CostTime& time) {
  const bool in_order =
      time.lower_quartile_s <= time.median_s && time.median_s <= time.upper_quartile_s && time.lower_quartile_s >= 0.0;
  if (!in_order || time.samples < 1 || time.per_sample < 1) Fail("a time is none");
}

void CheckMeasured(const CostRow& row) {
  if (!row.solve.has_value()) Fail(row.name + " is measured and has no time");
  const bool is_one_contact = row.method.multi_contact == MultiContactMethod::kUnspecified;
  if (row.velocity_after.has_value() != is_one_contact) Fail(row.name + " has no velocity, or one of several contacts");
  if (is_one_contact) {
    bool is_finite = std::isfinite(row.velocity_after->normal_m_s);
    for (const double velocity : row.velocity_after->tangential_m_s) is_finite &= std::isfinite(velocity);
    if (!is_finite) Fail(row.name + " is measured and its velocity is not finite");
  }
  if (!(row.claimed.total >= 0.0 && row.claimed.numerical >= 0.0 && row.claimed.modelling >= 0.0)) {
    Fail(row.name + " claims no error");
  }
  if (row.achieved.has_value() && !(row.achieved->total >= 0.0)) Fail(row.name + " achieves no error");
}

void CheckRow(const CostRow& row) {
  if (row.name.empty() || row.name.size() > kMostName) Fail("a name is empty or long: " + row.name);
  const bool has_model = row.method.model != Model::kUnspecified && row.method.arithmetic != Arithmetic::kUnspecified;
  if (has_model == (row.method.multi_contact != MultiContactMethod::kUnspecified)) {
    Fail(row.name + " has no method, or two");
  }
  if (row.solve.has_value()) CheckTime(*row.solve);
  if (row.batch.has_value()) CheckTime(*row.batch);
  switch (row.status) {
    case CostStatus::kMeasured:
      return CheckMeasured(row);
    case CostStatus::kFailed:
    case CostStatus::kOutOfTime:
    case CostStatus::kUnavailable:
      if (row.note.empty()) Fail(row.name + " has no answer and does not say why");
      return;
    case CostStatus::kUnspecified:
      Fail(row.name + " has no status");
  }
}

// The error with which a row enters the front: what the reference leaves open at least.
double ErrorOf(const CostRow& row) { return std::max(row.achieved->total, row.reference_error); }

void CheckFront(const std::vector<int64_t>& front, const std::vector<CostRow>& rows) {
  const CostRow* before = nullptr;
  for (const int64_t index : front) {
    if (index < 0 || index >= static_cast<int64_t>(rows.size())) Fail("the front has a row that there is not");
    const CostRow& row = rows[static_cast<size_t>(index)];
    const bool is_comparable = row.solve.has_value() && row.achieved.has_value();
    if (!is_comparable) Fail(row.name + " is on the front without a time or an error");
    if (before != nullptr && row.solve->median_s < before->solve->median_s) Fail("the front is not in its order");
    if (before != nullptr && !(ErrorOf(row) < ErrorOf(*before))) Fail("a row of the front is no gain");
    before = &row;
  }
}

void CheckPicks(const std::vector<CostPick>& picks, const std::vector<CostRow>& rows) {
  const double* next = std::begin(kCostTolerances);
  for (const CostPick& pick : picks) {
    if (next == std::end(kCostTolerances) || pick.least_tolerance != *next) Fail("a pick leaves a tolerance out");
    next = std::find(next, std::end(kCostTolerances), pick.most_tolerance);
    if (next == std::end(kCostTolerances)) Fail("a pick ends before it begins");
    ++next;
    if (pick.row < -1 || pick.row >= static_cast<int64_t>(rows.size())) Fail("a pick has a row that there is not");
  }
  if (next != std::end(kCostTolerances)) Fail("the picks end before the last tolerance");
}

void CheckSummary(const CostSummary& summary, const std::vector<CostRow>& rows) {
  const auto count = [&rows](const auto& is) { return std::count_if(rows.begin(), rows.end(), is); };
  if (summary.failed != count([](const CostRow& row) { return row.status == CostStatus::kFailed; })) {
    Fail("another count of methods that failed");
  }
  if (summary.out_of_time != count([](const CostRow& row) { return row.status == CostStatus::kOutOfTime; })) {
    Fail("another count of methods without time");
  }
  for (const CostRow& row : rows) {
    if (!row.ClaimIsBroken()) continue;
    Fail(absl::StrCat(row.name, " claims ", row.claimed.total, " and errs by ", row.achieved->total, " +- ",
                      row.reference_error));
  }
  if (summary.deceived != 0) Fail("another count of methods that err by more than they claim");
  CheckFront(summary.front, rows);
  const bool is_one_contact = rows.empty() || rows.front().method.multi_contact == MultiContactMethod::kUnspecified;
  if (is_one_contact) CheckPicks(summary.picks, rows);
}

bool IsValid(const CostRequest& request) {
  if (!request.multi_contact.has_value()) return Validate(request.scene).empty();
  std::optional<MultiReduction> reduction;
  return request.scene == Scene() && Validate(MultiContactRequest{.scene = *request.multi_contact}, reduction).empty();
}

void Run(const v1::CostRequest& proto) {
  CostRequest request = FromProto(proto);
  const bool valid = IsValid(request);
  request.time_limit_s = kTimeLimitS;
  request.samples = 1;
  std::vector<CostRow> rows;
  std::set<std::string> names;
  bool ended = false;
  bool begun = false;
  for (const absl::StatusOr<CostChunk>& chunk : LocalSolver().Cost(request)) {
    CheckStatus(chunk.status(), valid);
    if (!chunk.ok()) return;
    if (ended) Fail("a chunk comes after the summary");
    if (!begun && !chunk->rows.empty()) Fail("the first chunk has rows");
    if (chunk->first_row != static_cast<int64_t>(rows.size())) Fail("rows are missing");
    begun = true;
    for (const CostRow& row : chunk->rows) {
      CheckRow(row);
      if (!names.insert(row.name).second) Fail("two rows are called " + row.name);
      rows.push_back(row);
    }
    if (chunk->rows_done != static_cast<int64_t>(rows.size())) Fail("another number of rows is done");
    ended = chunk->summary.has_value();
    if (ended != (chunk->rows_done == chunk->rows_total)) Fail("the summary is not in the last chunk");
    if (ended) CheckSummary(*chunk->summary, rows);
  }
  if (!ended) Fail("a study has no summary");
}

}  // namespace

std::unique_ptr<google::protobuf::Message> NewInput() { return std::make_unique<v1::CostRequest>(); }
std::vector<std::string> InputTexts() { return {}; }

}  // namespace ricochet

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ricochet::v1::CostRequest request;
  if (request.ParseFromArray(data, static_cast<int>(size))) ricochet::Run(request);
  return 0;
}
