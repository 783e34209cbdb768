#include "core/batch/batch_run.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/answer/scene_outcome.h"
#include "core/batch/check_rows.h"
#include "core/contact/scene_contact.h"
#include "core/plan/demand_fields.h"
#include "core/plan/number_demand.h"
#include "core/plan/planned_scene.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"

namespace ricochet {
namespace {

// The paths of the input columns; none if the scene has no system, which is then the only violation.
std::vector<std::string> PathsOf(const BatchSetup& setup) {
  return std::holds_alternative<std::monostate>(setup.scene.system) ? std::vector<std::string>() : setup.fields;
}

void Append(std::vector<Violation> more, std::vector<Violation>& violations) {
  std::move(more.begin(), more.end(), std::back_inserter(violations));
}

void Count(int64_t row, Tally& tally) {
  tally.first_index = tally.count == 0 ? row : tally.first_index;
  ++tally.count;
}

bool HasNumbers(RowStatus status) {
  return status == RowStatus::kOk || status == RowStatus::kInadmissible || status == RowStatus::kIncomplete;
}

}  // namespace

BatchRun::BatchRun(const BatchSetup& setup)
    : scene_(setup.scene),
      fields_(
          PathsOf(setup), [](size_t i) { return absl::StrCat("fields[", i, "]"); }, "", scene_),
      demand_(WithNumbers(ToDemand(setup.demand), setup.columns)),
      has_relations_(HasRelations(scene_)) {}

absl::StatusOr<std::unique_ptr<BatchRun>> BatchRun::Make(const BatchSetup& setup) {
  std::unique_ptr<BatchRun> run(new BatchRun(setup));
  if (absl::Status status = run->Prepare(setup); !status.ok()) return status;
  return run;
}

absl::Status BatchRun::Prepare(const BatchSetup& setup) {
  std::optional<SceneContact> contact;
  const auto stays = [this](const Violation& violation) { return !fields_.CanBeCured(violation); };
  std::vector<Violation> violations = Validate(scene_, RestitutionIs::kRequired, contact, stays);
  if (violations.empty()) {
    violations = CheckDemand(scene_, contact, setup.demand);
    std::erase_if(violations, std::not_fn(stays));
  }
  if (setup.fields.empty()) violations.push_back({"fields", "is empty: must name at least one"});
  Append(fields_.violations(), violations);
  Append(CheckColumns(scene_, setup.columns), violations);
  if (violations.empty()) violations = CheckEffectsBehind(scene_, contact, ToDemand(setup.demand), setup.columns);
  if (!violations.empty()) return InvalidRequest(violations);
  names_ = setup.fields;
  columns_ = setup.columns;
  reader_.emplace(scene_, columns_);
  lanes_ = LaneRows::Make(scene_, setup, demand_);
  return absl::OkStatus();
}

// Returns true if every number keeps its own rule.
bool BatchRun::SetRow(const BatchRows& rows, size_t i) {
  bool keeps_rules = true;
  for (size_t k = 0; k < fields_.size(); ++k) keeps_rules &= fields_[k].Set(rows.inputs[k][i]);
  return keeps_rules;
}

// Checks and plans a row, and solves it unless the spatial lanes do. Returns nothing if it was stopped.
std::optional<BatchRun::Begun> BatchRun::BeginRow(const BatchRows& rows, size_t i, absl::FunctionRef<bool()> stopped) {
  Begun begun;
  std::optional<SceneContact> contact;
  if (!SetRow(rows, i) || (has_relations_ && !KeepsRelations(scene_, nullptr, contact))) {
    begun.row.status = RowStatus::kInvalid;
    return begun;
  }
  begun.lane = spatial_.Add(scene_, demand_, contact);
  if (begun.lane.has_value()) return begun;
  const PlannedScene planned = PlanScene(scene_, contact, demand_);
  begun.lane = spatial_.Add(scene_, planned, contact);
  if (begun.lane.has_value()) return begun;
  if (stopped()) return std::nullopt;
  Outcome outcome;
  const absl::Status solved = SolvePlanned(
      scene_, contact, planned, {.extent = {.detail = Detail::kNumbers}, .demand = demand_}, stopped, outcome);
  if (absl::IsCancelled(solved)) return std::nullopt;
  if (solved.ok()) {
    begun.row = RowOf(rows, i, outcome);
  } else {
    begun.row.status = RowStatus::kNotRepresentable;
  }
  return begun;
}

// Writes the numbers of a row.
BatchRun::Row BatchRun::RowOf(const BatchRows& rows, size_t i, const Outcome& outcome) {
  const auto [status, too_large] = reader_->Read(outcome, numbers_);
  for (size_t c = 0; c < columns_.size(); ++c) rows.outputs[c][i] = numbers_[c];
  return {.status = status,
          .regime = HasNumbers(status) ? outcome.regime : Regime::kInvalid,
          .model = outcome.plan.model,
          .too_large = too_large};
}

// Checks the numbers of a row that the lanes have solved.
void BatchRun::CheckNumbers(const BatchRows& rows, size_t i, Row& row) const {
  for (size_t c = 0; c < columns_.size(); ++c) {
    if (std::isfinite(rows.outputs[c][i])) continue;
    row.status = RowStatus::kNotRepresentable;
    row.regime = Regime::kInvalid;
    row.too_large = c;
    return;
  }
}

// Solves rows that need a scene each, and finishes them in their order. Returns false if it was stopped.
bool BatchRun::SolveScenes(const BatchRows& rows, size_t first, size_t count, absl::FunctionRef<bool()> stopped,
                           BatchSummary& summary) {
  begun_.clear();
  spatial_.Clear();
  if (stopped()) return false;
  for (size_t k = 0; k < count; ++k) {
    const std::optional<Begun> begun = BeginRow(rows, first + k, stopped);
    if (!begun.has_value()) return false;
    begun_.push_back(*begun);
  }
  spatial_.Solve();
  for (size_t k = 0; k < count; ++k) {
    Row& row = begun_[k].row;
    if (begun_[k].lane.has_value()) {
      Outcome outcome;
      spatial_.SetOutcome(*begun_[k].lane, outcome);
      row = RowOf(rows, first + k, outcome);
    }
    // The scene has to be that of a row that is described.
    if (!HasNumbers(row.status)) SetRow(rows, first + k);
    Finish(rows, first + k, row, summary);
  }
  return true;
}

// Returns false if it was stopped. The rows are finished in their order.
bool BatchRun::SolveBlock(const BatchRows& rows, size_t first, size_t count, absl::FunctionRef<bool()> stopped,
                          BatchSummary& summary) {
  if (stopped()) return false;
  lanes_->Solve(rows, first, count);
  if (lanes_->block().is_complete) {
    FinishBlock(rows, first, count, summary);
    return true;
  }
  const SceneLanes::Block& block = lanes_->block();
  for (size_t k = 0; k < count; ++k) {
    if (block.models[k] == Model::kUnspecified) {
      if (!SolveScenes(rows, first + k, 1, stopped, summary)) return false;
      continue;
    }
    Row row = {.status = block.inadmissible[k] ? RowStatus::kInadmissible : RowStatus::kOk,
               .regime = block.regimes[k],
               .model = block.models[k],
               .too_large = std::nullopt};
    CheckNumbers(rows, first + k, row);
    Finish(rows, first + k, row, summary);
  }
  return true;
}

// Returns false if it was stopped.
bool BatchRun::SolveSome(const BatchRows& rows, size_t first, size_t count, absl::FunctionRef<bool()> stopped,
                         BatchSummary& summary) {
  if (lanes_ != nullptr) return SolveBlock(rows, first, count, stopped, summary);
  return SolveScenes(rows, first, count, stopped, summary);
}

absl::StatusOr<BatchSummary> BatchRun::Solve(const BatchRows& rows, absl::FunctionRef<bool()> stopped) {
  if (absl::Status misfit = CheckRows(rows, fields_.size(), columns_.size()); !misfit.ok()) return misfit;
  BatchSummary summary;
  const size_t all = RowCount(rows);
  for (size_t first = 0; first < all; first += LaneRows::kBlock) {
    if (!SolveSome(rows, first, std::min(LaneRows::kBlock, all - first), stopped, summary)) {
      return absl::CancelledError("the batch was stopped by its caller");
    }
  }
  return summary;
}

// Does for every row of a block with all its numbers what Finish does.
void BatchRun::FinishBlock(const BatchRows& rows, size_t first, size_t count, BatchSummary& summary) const {
  const SceneLanes::Block& block = lanes_->block();
  SweepSummary& counts = summary.counts;
  counts.points += static_cast<int64_t>(count);
  for (size_t k = 0; k < count; ++k) {
    const auto index = static_cast<int64_t>(first + k);
    Count(index, counts.by_regime[static_cast<size_t>(block.regimes[k])]);
    Count(index, counts.by_model[static_cast<size_t>(block.models[k])]);
    if (block.inadmissible[k]) Count(index, counts.inadmissible);
  }
  const auto at = static_cast<ptrdiff_t>(first);
  if (!rows.regimes.empty()) std::copy_n(block.regimes.begin(), count, rows.regimes.begin() + at);
  if (!rows.statuses.empty()) {
    std::transform(block.inadmissible.begin(), block.inadmissible.begin() + count, rows.statuses.begin() + at,
                   [](bool inadmissible) { return inadmissible ? RowStatus::kInadmissible : RowStatus::kOk; });
  }
}

// Writes what every row has, and counts the row.
void BatchRun::Finish(const BatchRows& rows, size_t i, const Row& row, BatchSummary& summary) const {
  const auto index = static_cast<int64_t>(i);
  if (!rows.regimes.empty()) rows.regimes[i] = row.regime;
  if (!rows.statuses.empty()) rows.statuses[i] = row.status;
  ++summary.counts.points;
  Count(index, summary.counts.by_regime[static_cast<size_t>(row.regime)]);
  if (HasNumbers(row.status)) {
    Count(index, summary.counts.by_model[static_cast<size_t>(row.model)]);
    if (row.status == RowStatus::kInadmissible) Count(index, summary.counts.inadmissible);
    return;
  }
  for (const absl::Span<double> column : rows.outputs) column[i] = std::numeric_limits<double>::quiet_NaN();
  if (summary.bad_rows.size() < kMostBadRows) summary.bad_rows.push_back(Describe(rows, index, row));
}

// A derived field can break a rule of its own in a scene that keeps all of its own. The scene must be that of the row.
Violation BatchRun::WhyInvalid(const BatchRows& rows, size_t i) const {
  std::vector<Violation> violations = Validate(scene_);
  if (!violations.empty()) return std::move(violations.front());
  for (size_t k = 0; k < fields_.size(); ++k) {
    const double value = rows.inputs[k][i];
    if (!Holds(value, fields_[k].rule())) return MakeViolation(names_[k], value, "lie in the range of the field");
  }
  return {};
}

// The scene must be that of the row.
BadRow BatchRun::Describe(const BatchRows& rows, int64_t index, const Row& row) const {
  BadRow bad = {.row = index, .status = row.status};
  if (row.status == RowStatus::kInvalid) {
    const Violation violation = WhyInvalid(rows, static_cast<size_t>(index));
    bad.field = violation.field;
    bad.description = violation.description;
  } else if (row.too_large.has_value()) {
    bad.field = columns_[*row.too_large];
    bad.description = "exceeds the largest double";
  } else {
    bad.field = "contact";
    bad.description = std::string(ContactOverflow().message());
  }
  return bad;
}

BatchSummary Joined(BatchSummary first, BatchSummary second, int64_t first_row) {
  const auto shift = [first_row](Tally& tally) {
    if (tally.count > 0) tally.first_index += first_row;
  };
  for (Tally& tally : second.counts.by_regime) shift(tally);
  for (Tally& tally : second.counts.by_model) shift(tally);
  shift(second.counts.inadmissible);
  first.counts = Joined(first.counts, second.counts);
  for (BadRow& bad : second.bad_rows) {
    if (first.bad_rows.size() == kMostBadRows) break;
    bad.row += first_row;
    first.bad_rows.push_back(std::move(bad));
  }
  return first;
}

}  // namespace ricochet
