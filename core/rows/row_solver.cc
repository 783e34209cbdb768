#include "core/rows/row_solver.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "absl/strings/match.h"
#include "core/answer/outcome_parts.h"
#include "core/answer/scene_outcome.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"

namespace ricochet {
namespace {

bool HasNumbers(RowStatus status) { return status != RowStatus::kInvalid && status != RowStatus::kNotRepresentable; }

// True if `count` >= 1 entries are equal. Standard algorithms compare enums one by one, which takes several times as
// long.
template <typename T>
bool AreAlike(const T* of, size_t count) {
  static_assert(std::has_unique_object_representations_v<T>);
  return std::memcmp(of, of + 1, (count - 1) * sizeof(T)) == 0;
}

// Counts rows that come after those of the tally.
void Count(int64_t first, size_t count, Tally& tally) {
  if (tally.count == 0) tally.first_index = first;
  tally.count += static_cast<int64_t>(count);
}

bool AnyStartsWith(const std::vector<std::string>& columns, absl::string_view start) {
  return std::any_of(columns.begin(), columns.end(),
                     [start](const std::string& column) { return absl::StartsWith(column, start); });
}

std::vector<std::string> Some(const std::vector<std::string>& names, const std::vector<size_t>& places) {
  std::vector<std::string> some;
  for (const size_t place : places) some.push_back(names[place]);
  return some;
}

}  // namespace

RowSolver::RowSolver(const Scene& scene, std::vector<std::string> fields, std::vector<std::string> columns,
                     const Demand& demand)
    : field_names_(std::move(fields)),
      column_names_(std::move(columns)),
      demand_(demand),
      driven_(scene, field_names_),
      in_space_(TangentialDirections(scene.system) == 2),
      reader_(driven_.scene(), column_names_),
      derivatives_(column_names_),
      others_(derivatives_.Others(column_names_.size())),
      lanes_(SceneLanes::Make(driven_.scene(), Some(column_names_, others_), demand_)),
      places_(column_names_.size()),
      other_places_(others_.size()),
      asks_rates_errors_(AnyStartsWith(column_names_, "errors.rates_after") ||
                         AnyStartsWith(column_names_, "errors.momentum_change")),
      asks_free_end_(AnyStartsWith(column_names_, "free_end.")) {
  if (lanes_ != nullptr) lane_columns_ = std::make_unique<LaneColumns>(*lanes_, driven_);
}

std::optional<int64_t> RowSolver::Solve(RowSource& source, int64_t first, int64_t count, const RowSink& sink,
                                        absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough) {
  for (int64_t done = 0; done < count;) {
    if (lanes_ == nullptr || done % kRowsBetweenStops == 0) {
      if (done > 0 && is_enough()) return done;
      if (stopped()) return std::nullopt;
    }
    const size_t size = std::min(kBlock, static_cast<size_t>(count - done));
    fields_ = source.At(first + done, size);
    for (size_t c = 0; c < places_.size(); ++c) places_[c] = sink.columns[c] + done;
    for (size_t k = 0; k < others_.size(); ++k) other_places_[k] = places_[others_[k]];
    const std::optional<size_t> solved =
        lanes_ == nullptr ? SolveScenes(size, stopped, is_enough) : SolveInLanes(size, stopped);
    if (!solved.has_value()) return std::nullopt;
    Finish(first, static_cast<size_t>(done), *solved, sink);
    done += static_cast<int64_t>(*solved);
    if (*solved < size) return done;
  }
  return count;
}

// Rows that the lanes leave go by their scenes. Returns how many rows are solved, all, or nothing if it was stopped.
std::optional<size_t> RowSolver::SolveInLanes(size_t count, absl::FunctionRef<bool()> stopped) {
  lanes_->Solve(lane_columns_->Of(fields_, count), count, other_places_, block_);
  for (size_t i = 0; i < count; ++i) {
    statuses_[i] = block_.inadmissible[i]                 ? RowStatus::kInadmissible
                   : block_.regimes[i] == Regime::kWedged ? RowStatus::kNotConverged
                                                          : RowStatus::kOk;
  }
  if (block_.is_complete && derivatives_.empty()) return count;
  block_.is_complete = block_.is_uniform = false;
  for (size_t i = 0; i < count; ++i) {
    const bool is_solved = block_.models[i] != Model::kUnspecified;
    if (is_solved) CheckNumbers(i);
    if (is_solved && derivatives_.empty()) continue;
    if (!is_solved && stopped()) return std::nullopt;
    driven_.SetRow(fields_, i);
    if (!(is_solved ? SetDerivatives(i, stopped) : Begin(i, stopped))) return std::nullopt;
  }
  return count;
}

// Returns how many rows are solved, or nothing if it was stopped.
std::optional<size_t> RowSolver::SolveScenes(size_t count, absl::FunctionRef<bool()> stopped,
                                             absl::FunctionRef<bool()> is_enough) {
  block_.is_complete = false;
  block_.is_uniform = false;
  spatial_.Clear();
  in_spatial_.clear();
  for (size_t i = 0; i < count; ++i) {
    if (i > 0 && !in_space_ && is_enough()) return i;
    if (i > 0 && stopped()) return std::nullopt;
    driven_.SetRow(fields_, i);
    if (!Begin(i, stopped)) return std::nullopt;
  }
  spatial_.Solve();
  for (const auto& [i, place] : in_spatial_) {
    Outcome outcome;
    spatial_.SetOutcome(place, outcome);
    CompareWithTolerance(demand_.relative_tolerance, outcome);
    SetRow(i, outcome);
  }
  return count;
}

// Checks and plans the row that is driven, and solves it unless the spatial lanes do. Returns false if it was stopped.
bool RowSolver::Begin(size_t i, absl::FunctionRef<bool()> stopped) {
  std::optional<SceneContact> contact;
  const Scene& scene = driven_.scene();
  if (!driven_.IsValid(contact)) {
    statuses_[i] = RowStatus::kInvalid;
    return true;
  }
  if (asks_rates_errors_ || asks_free_end_ || !derivatives_.empty())
    return SolvePlannedRow(i, contact, PlanScene(scene, contact, demand_), stopped);
  std::optional<size_t> place = spatial_.Add(scene, demand_, contact);
  if (!place.has_value()) {
    const PlannedScene planned = PlanScene(scene, contact, demand_);
    place = spatial_.Add(planned, contact);
    if (!place.has_value()) return SolvePlannedRow(i, contact, planned, stopped);
  }
  in_spatial_.emplace_back(i, *place);
  return true;
}

// Returns false if it was stopped.
bool RowSolver::SolvePlannedRow(size_t i, std::optional<SceneContact>& contact, const PlannedScene& planned,
                                absl::FunctionRef<bool()> stopped) {
  Outcome outcome;
  const OutcomeDetail detail = {.numbers_only = !asks_rates_errors_};
  absl::Status solved = SolvePlanned(driven_.scene(), contact, planned, detail, stopped, outcome);
  if (solved.ok() && asks_free_end_) solved = SetFreeEnd(driven_.scene(), demand_, stopped, outcome);
  if (absl::IsCancelled(solved)) return false;
  if (solved.ok()) {
    SetRow(i, outcome);
    return derivatives_.empty() || SetDerivatives(i, stopped);
  }
  // The demand was checked for the base scene. This row may need an effect that it excludes.
  const bool is_solvable = CheckSolvableWithout(driven_.scene(), contact, demand_).empty();
  SetBad(i, is_solvable ? RowStatus::kNotRepresentable : RowStatus::kInvalid);
  return true;
}

void RowSolver::SetRow(size_t i, const Outcome& outcome) {
  const auto [status, too_large] = reader_.Read(outcome, numbers_);
  for (size_t c = 0; c < places_.size(); ++c) places_[c][i] = numbers_[c];
  block_.regimes[i] = outcome.regime;
  block_.models[i] = outcome.plan.model;
  statuses_[i] = status;
  too_large_[i] = too_large;
}

void RowSolver::SetBad(size_t i, RowStatus status) {
  statuses_[i] = status;
  too_large_[i].reset();
}

// Returns false if it was stopped.
bool RowSolver::SetDerivatives(size_t i, absl::FunctionRef<bool()> stopped) {
  if (!HasNumbers(statuses_[i])) return true;
  bool is_complete = true;
  const absl::Status set = derivatives_.Set(driven_.scene(), demand_, stopped, places_, i, is_complete);
  if (absl::IsCancelled(set)) return false;
  if (!set.ok()) {
    SetBad(i, RowStatus::kNotRepresentable);
  } else if (!is_complete && statuses_[i] == RowStatus::kOk) {
    statuses_[i] = RowStatus::kIncomplete;
  }
  return true;
}

// Checks the numbers of a row that the lanes have solved.
void RowSolver::CheckNumbers(size_t i) {
  const auto bad = std::find_if(other_places_.begin(), other_places_.end(),
                                [i](const double* column) { return !std::isfinite(column[i]); });
  if (bad == other_places_.end()) return;
  statuses_[i] = RowStatus::kNotRepresentable;
  too_large_[i] = others_[static_cast<size_t>(bad - other_places_.begin())];
}

// Overwrites the rows that have no numbers, hands the block over and counts it. The block begins `at` rows behind the
// first of the call.
void RowSolver::Finish(int64_t first, size_t at, size_t count, const RowSink& sink) {
  const int64_t row = first + static_cast<int64_t>(at);
  for (size_t i = 0; i < count && !block_.is_complete; ++i) {
    if (HasNumbers(statuses_[i])) continue;
    block_.regimes[i] = Regime::kInvalid;
    block_.models[i] = Model::kUnspecified;
    for (double* const column : places_) column[i] = std::numeric_limits<double>::quiet_NaN();
    if (sink.bad_rows == nullptr || sink.bad_rows->size() == kMostBadRows) continue;
    sink.bad_rows->push_back(Describe(row + static_cast<int64_t>(i), i));
  }
  if (!sink.regimes.empty())
    std::copy_n(block_.regimes.begin(), count, sink.regimes.begin() + static_cast<ptrdiff_t>(at));
  if (!sink.statuses.empty()) std::copy_n(statuses_.begin(), count, sink.statuses.begin() + static_cast<ptrdiff_t>(at));
  AddTo(sink.counts, row, count);
}

// Counts groups of rows that are alike at once, as most neighbours of a grid are, and other rows one by one.
void RowSolver::AddTo(SweepSummary& counts, int64_t first, size_t count) const {
  constexpr size_t kGroup = 32;
  counts.points += static_cast<int64_t>(count);
  const auto add = [&](size_t i, size_t rows) {
    const int64_t row = first + static_cast<int64_t>(i);
    Count(row, rows, counts.by_regime[static_cast<size_t>(block_.regimes[i])]);
    if (!HasNumbers(statuses_[i])) return;
    Count(row, rows, counts.by_model[static_cast<size_t>(block_.models[i])]);
    if (statuses_[i] == RowStatus::kInadmissible) Count(row, rows, counts.inadmissible);
    if (statuses_[i] == RowStatus::kNotConverged) Count(row, rows, counts.not_converged);
  };
  if (block_.is_uniform) return add(0, count);
  for (size_t i = 0; i < count; i += kGroup) {
    const size_t size = std::min(kGroup, count - i);
    const bool is_alike = AreAlike(block_.regimes.data() + i, size) && AreAlike(block_.models.data() + i, size) &&
                          AreAlike(statuses_.data() + i, size);
    if (is_alike) {
      add(i, size);
    } else {
      for (size_t k = i; k < i + size; ++k) add(k, 1);
    }
  }
}

// Says why a row has no numbers.
BadRow RowSolver::Describe(int64_t row, size_t i) {
  BadRow bad = {.row = row, .status = statuses_[i]};
  if (bad.status == RowStatus::kInvalid) {
    Violation violation = WhyInvalid(i);
    bad.field = std::move(violation.field);
    bad.description = std::move(violation.description);
  } else if (too_large_[i].has_value()) {
    bad.field = column_names_[*too_large_[i]];
    bad.description = "exceeds the largest double";
  } else {
    bad.field = "contact";
    bad.description = std::string(ContactOverflow().message());
  }
  return bad;
}

Violation RowSolver::WhyInvalid(size_t i) {
  driven_.SetRow(fields_, i);
  for (size_t k = 0; k < fields_.size(); ++k) {
    if (field_names_[k] != kPhi) continue;
    if (std::optional<Violation> violation = WhyNoPhi(fields_[k].values[i])) return *std::move(violation);
  }
  std::vector<Violation> violations = Validate(driven_.scene());
  if (!violations.empty()) return std::move(violations.front());
  std::optional<SceneContact> contact;
  violations = CheckSolvableWithout(driven_.scene(), contact, demand_);
  return violations.empty() ? Violation() : std::move(violations.front());
}

}  // namespace ricochet
