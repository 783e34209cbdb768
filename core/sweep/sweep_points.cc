#include "core/sweep/sweep_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/answer/scene_outcome.h"
#include "core/contact/reduction.h"
#include "core/plan/planned_scene.h"
#include "core/sweep/column.h"

namespace ricochet {
namespace {

absl::Status Stopped() { return absl::CancelledError("the sweep was stopped by its caller"); }

bool HasNumbers(RowStatus status) { return status != RowStatus::kInvalid && status != RowStatus::kNotRepresentable; }

RowStatus StatusOf(bool inadmissible) { return inadmissible ? RowStatus::kInadmissible : RowStatus::kOk; }

}  // namespace

struct SweepPoints::SceneColumns {
  SceneLanes::Columns columns;
  std::array<std::array<double, SceneLanes::kBlock>, SceneLanes::kMostNumbers> numbers;
};

SweepPoints::~SweepPoints() = default;

SweepPoints::SweepPoints(const CheckedSweep& sweep)
    : sweep_(sweep),
      driven_(sweep.grid),
      reader_(driven_.scene(), sweep.columns),
      regimes_(kMostPoints),
      models_(kMostPoints),
      statuses_(kMostPoints),
      columns_(sweep.columns.size()) {
  if (!sweep.in_lanes) return;
  lanes_ = SceneLanes::Make(driven_.scene(), sweep.columns, sweep.demand);
  block_ = std::make_unique<SceneLanes::Block>();
  if (lanes_->TakesFields()) {
    point_columns_ = std::make_unique<PointColumns>(sweep.grid, *lanes_);
  } else {
    scene_columns_ = std::make_unique<SceneColumns>();
  }
}

absl::StatusOr<int64_t> SweepPoints::Compute(int64_t first, int64_t count, absl::Span<double* const> columns,
                                             absl::Span<Regime> regimes, absl::Span<RowStatus> statuses,
                                             SweepSummary& tallies, absl::FunctionRef<bool()> stopped,
                                             absl::FunctionRef<bool()> is_enough) {
  if (stopped()) return Stopped();
  columns_.assign(columns.begin(), columns.end());
  if (lanes_ != nullptr) {
    if (absl::Status solved = SolveInLanes(first, count, tallies, stopped); !solved.ok()) return solved;
  } else {
    const absl::StatusOr<int64_t> solved = SolvePoints(first, count, stopped, is_enough);
    if (!solved.ok()) return solved;
    count = *solved;
    Finish(first, 0, static_cast<size_t>(count), tallies);
  }
  tallies.points += count;
  if (!regimes.empty()) std::copy_n(regimes_.begin(), count, regimes.begin());
  if (!statuses.empty()) std::copy_n(statuses_.begin(), count, statuses.begin());
  return count;
}

absl::StatusOr<int64_t> SweepPoints::SolvePoints(int64_t first, int64_t count, absl::FunctionRef<bool()> stopped,
                                                 absl::FunctionRef<bool()> is_enough) {
  const int64_t together = TangentialDirections(driven_.scene().system) == 2 ? kTogether : 1;
  for (int64_t done = 0; done < count; done += together) {
    if (done > 0 && is_enough()) return done;
    if (done > 0 && stopped()) return Stopped();
    const int64_t size = std::min(together, count - done);
    if (!SolveTogether(first, static_cast<size_t>(done), static_cast<size_t>(size), stopped)) return Stopped();
  }
  return count;
}

// Drives the scene of a point, which costs least from one point to the next.
void SweepPoints::GoTo(int64_t index) {
  if (at_ >= 0 && at_ + 1 == index) {
    driven_.Advance();
  } else if (at_ != index) {
    driven_.GoTo(index);
  }
  at_ = index;
}

// Solves the points [from, from + count) of those that begin at `first`. Returns false if it was stopped.
bool SweepPoints::SolveTogether(int64_t first, size_t from, size_t count, absl::FunctionRef<bool()> stopped) {
  spatial_.Clear();
  in_spatial_.clear();
  for (size_t i = from; i < from + count; ++i) {
    if (i > from && stopped()) return false;
    GoTo(first + static_cast<int64_t>(i));
    if (!BeginPoint(i, stopped)) return false;
  }
  spatial_.Solve();
  for (const auto& [i, place] : in_spatial_) {
    Outcome outcome;
    spatial_.SetOutcome(place, outcome);
    SetPoint(i, outcome);
  }
  return true;
}

// Checks and plans a point, and solves it unless the spatial lanes do. Returns false if it was stopped.
bool SweepPoints::BeginPoint(size_t i, absl::FunctionRef<bool()> stopped) {
  std::optional<SceneContact> contact;
  const Scene& scene = driven_.scene();
  statuses_[i] = driven_.IsValid(contact) ? RowStatus::kOk : RowStatus::kInvalid;
  if (statuses_[i] != RowStatus::kOk) return true;
  std::optional<size_t> place = spatial_.Add(scene, sweep_.demand, contact);
  if (!place.has_value()) {
    const PlannedScene planned = PlanScene(scene, contact, sweep_.demand);
    place = spatial_.Add(scene, planned, contact);
    if (!place.has_value()) return SolvePlannedPoint(i, contact, planned, stopped);
  }
  in_spatial_.emplace_back(i, *place);
  return true;
}

// Returns false if it was stopped.
bool SweepPoints::SolvePlannedPoint(size_t i, const std::optional<SceneContact>& contact, const PlannedScene& planned,
                                    absl::FunctionRef<bool()> stopped) {
  Outcome outcome;
  const absl::Status status =
      SolvePlanned(driven_.scene(), contact, planned, {.extent = {.detail = Detail::kNumbers}, .demand = sweep_.demand},
                   stopped, outcome);
  if (absl::IsCancelled(status)) return false;
  if (!status.ok()) {
    statuses_[i] = RowStatus::kNotRepresentable;
    return true;
  }
  SetPoint(i, outcome);
  return true;
}

void SweepPoints::SetPoint(size_t i, const Outcome& outcome) {
  regimes_[i] = outcome.regime;
  models_[i] = outcome.plan.model;
  statuses_[i] = reader_.Read(outcome, numbers_).status;
  for (size_t c = 0; c < columns_.size(); ++c) columns_[c][i] = numbers_[c];
}

absl::Status SweepPoints::SolveInLanes(int64_t first, int64_t count, SweepSummary& tallies,
                                       absl::FunctionRef<bool()> stopped) {
  const auto size = static_cast<size_t>(count);
  for (size_t done = 0; done < size; done += SceneLanes::kBlock) {
    const size_t some = std::min(SceneLanes::kBlock, size - done);
    if (absl::Status solved = SolveBlock(first, done, some, stopped); !solved.ok()) return solved;
    if (block_->is_uniform) {
      FinishAlike(first, done, some, tallies);
    } else {
      Finish(first, done, some, tallies);
    }
  }
  return absl::OkStatus();
}

// Solves the points [from, from + count) of those that begin at `first`. Those that the lanes leave go by their scenes.
absl::Status SweepPoints::SolveBlock(int64_t first, size_t from, size_t count, absl::FunctionRef<bool()> stopped) {
  const int64_t at = first + static_cast<int64_t>(from);
  places_.clear();
  for (double* const column : columns_) places_.push_back(column + from);
  lanes_->Solve(point_columns_ != nullptr ? point_columns_->At(at, count) : ColumnsOfScenes(at, count), count, places_,
                *block_);
  if (block_->is_uniform) return absl::OkStatus();
  const auto to = static_cast<ptrdiff_t>(from);
  std::copy_n(block_->models.begin(), count, models_.begin() + to);
  std::copy_n(block_->regimes.begin(), count, regimes_.begin() + to);
  std::transform(block_->inadmissible.begin(), block_->inadmissible.begin() + count, statuses_.begin() + to, StatusOf);
  if (block_->is_complete) return absl::OkStatus();
  for (size_t i = from; i < from + count; ++i) {
    const auto is_finite = [i](const double* column) { return std::isfinite(column[i]); };
    if (models_[i] != Model::kUnspecified) {
      if (!std::all_of(columns_.begin(), columns_.end(), is_finite)) statuses_[i] = RowStatus::kNotRepresentable;
      continue;
    }
    if (stopped()) return Stopped();
    if (!SolveTogether(first, i, 1, stopped)) return Stopped();
  }
  return absl::OkStatus();
}

// The numbers of scenes whose coefficients depend on the speed. No lanes take those of a point that is not valid.
const SceneLanes::Columns& SweepPoints::ColumnsOfScenes(int64_t first, size_t count) {
  SceneColumns& scenes = *scene_columns_;
  for (size_t i = 0; i < count; ++i) {
    GoTo(first + static_cast<int64_t>(i));
    SceneLanes::Numbers numbers;
    numbers.fill(std::numeric_limits<double>::quiet_NaN());
    std::optional<SceneContact> contact;
    if (driven_.IsValid(contact)) numbers = lanes_->NumbersOf(driven_.scene());
    for (size_t n = 0; n < numbers.size(); ++n) scenes.numbers[n][i] = numbers[n];
  }
  for (size_t n = 0; n < scenes.numbers.size(); ++n) scenes.columns.of[n] = scenes.numbers[n].data();
  scenes.columns.varies.fill(true);
  return scenes.columns;
}

// Finishes points that all have numbers and the model, the regime and the admissibility of the first.
void SweepPoints::FinishAlike(int64_t first, size_t from, size_t count, SweepSummary& tallies) {
  const auto at = static_cast<ptrdiff_t>(from);
  std::fill_n(regimes_.begin() + at, count, block_->regimes[0]);
  std::fill_n(statuses_.begin() + at, count, StatusOf(block_->inadmissible[0]));
  models_[from] = block_->models[0];
  Add(first, from, from + count, tallies);
}

// Finishes the points [from, from + count) of those that begin at `first`: overwrites those that have no numbers, and
// tallies each run of equal ones at once.
void SweepPoints::Finish(int64_t first, size_t from, size_t count, SweepSummary& tallies) {
  const bool all_have_numbers = lanes_ != nullptr && block_->is_complete;
  for (size_t i = from; i < from + count && !all_have_numbers; ++i) {
    if (HasNumbers(statuses_[i])) continue;
    regimes_[i] = Regime::kInvalid;
    for (double* column : columns_) column[i] = std::numeric_limits<double>::quiet_NaN();
  }
  for (size_t i = from, end = from; i < from + count; i = end) {
    while (end < from + count && regimes_[end] == regimes_[i] && statuses_[end] == statuses_[i] &&
           (regimes_[i] == Regime::kInvalid || models_[end] == models_[i])) {
      ++end;
    }
    Add(first, i, end, tallies);
  }
}

// Tallies the points [from, end), which are all alike.
void SweepPoints::Add(int64_t first, size_t from, size_t end, SweepSummary& tallies) const {
  const Tally tally = {.count = static_cast<int64_t>(end - from), .first_index = first + static_cast<int64_t>(from)};
  const auto add = [&tally](Tally& to) { to = Joined(to, tally); };
  add(tallies.by_regime[static_cast<size_t>(regimes_[from])]);
  if (statuses_[from] == RowStatus::kInadmissible) add(tallies.inadmissible);
  if (regimes_[from] != Regime::kInvalid) add(tallies.by_model[static_cast<size_t>(models_[from])]);
}

}  // namespace ricochet
