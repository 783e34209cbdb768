#include "core/sweep/sweep_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/answer/planar_lanes.h"
#include "core/answer/scene_outcome.h"
#include "core/contact/reduction.h"
#include "core/models/pendulum/first_order.h"
#include "core/numerics/invariant.h"
#include "core/plan/planned_scene.h"
#include "core/problem/scene_problem.h"
#include "core/sweep/column.h"

namespace ricochet {
namespace {

void Add(int64_t index, Tally& tally) {
  if (tally.count++ == 0) tally.first_index = index;
}

absl::Status Stopped() { return absl::CancelledError("the sweep was stopped by its caller"); }

}  // namespace

struct SweepPoints::Planar {
  Planar(const Scene& scene, const CheckedSweep& sweep)
      : lanes(scene, *sweep.planar_outputs, sweep.demand.relative_tolerance) {
    columns.varies.fill(true);
    for (size_t n = 0; n < numbers.size(); ++n) columns.of[n] = numbers[n].data();
  }

  PlanarLanes lanes;
  PlanarLanes::Columns columns;
  PlanarLanes::Block block;
  std::array<std::array<double, PlanarLanes::kBlock>, PlanarLanes::kNumberCount> numbers;
};

SweepPoints::~SweepPoints() = default;

SweepPoints::SweepPoints(const CheckedSweep& sweep)
    : sweep_(sweep),
      driven_(sweep.grid),
      regimes_(kMostPoints),
      models_(kMostPoints),
      statuses_(kMostPoints),
      inadmissible_(std::make_unique<bool[]>(kMostPoints)),
      columns_(sweep.columns) {
  if (sweep.in_lanes) problems_ = pendulum::ProblemColumns(pendulum::MakeProblem(driven_.scene()).law, kMostPoints);
  if (sweep.planar_outputs.has_value()) planar_ = std::make_unique<Planar>(driven_.scene(), sweep);
}

absl::StatusOr<int64_t> SweepPoints::Compute(int64_t first, int64_t count, absl::Span<double* const> columns,
                                             absl::Span<Regime> regimes, absl::Span<RowStatus> statuses,
                                             SweepSummary& tallies, absl::FunctionRef<bool()> stopped,
                                             absl::FunctionRef<bool()> is_enough) {
  if (stopped()) return Stopped();
  if (at_ != first) driven_.GoTo(first);
  at_ = -1;  // Unknown until the block is complete.
  columns_.assign(columns.begin(), columns.end());
  if (sweep_.in_lanes) {
    SolveLanes(count);
  } else if (planar_ != nullptr) {
    if (absl::Status solved = SolvePlanar(first, count, stopped); !solved.ok()) return solved;
  } else {
    const absl::StatusOr<int64_t> solved = SolvePoints(count, stopped, is_enough);
    if (!solved.ok()) return solved;
    count = *solved;
  }
  at_ = first + count;
  FinishBlock(first, count, tallies);
  if (!regimes.empty()) std::copy_n(regimes_.begin(), count, regimes.begin());
  if (!statuses.empty()) std::copy_n(statuses_.begin(), count, statuses.begin());
  return count;
}

absl::StatusOr<int64_t> SweepPoints::SolvePoints(int64_t count, absl::FunctionRef<bool()> stopped,
                                                 absl::FunctionRef<bool()> is_enough) {
  const int64_t together = TangentialDirections(driven_.scene().system) == 2 ? kTogether : 1;
  for (int64_t done = 0; done < count; done += together) {
    if (done > 0 && is_enough()) return done;
    if (done > 0 && stopped()) return Stopped();
    const int64_t size = std::min(together, count - done);
    if (!SolveTogether(static_cast<size_t>(done), static_cast<size_t>(size), stopped)) return Stopped();
  }
  return count;
}

// Returns false if it was stopped.
bool SweepPoints::SolveTogether(size_t first, size_t count, absl::FunctionRef<bool()> stopped) {
  spatial_.Clear();
  in_spatial_.clear();
  for (size_t i = first; i < first + count; ++i) {
    if (i > first && stopped()) return false;
    if (!BeginPoint(i, stopped)) return false;
    driven_.Advance();
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
  inadmissible_[i] = !outcome.admissible;
  ReadColumns(outcome, numbers_);
  for (size_t c = 0; c < columns_.size(); ++c) columns_[c][i] = numbers_[sweep_.positions[c]];
}

// Solves each run of points whose plans agree by the model that they call for.
void SweepPoints::SolveLanes(int64_t count) {
  const auto is_exact = [this](size_t i) { return models_[i] == Model::kPendulum || models_[i] == Model::kNone; };
  const auto size = static_cast<size_t>(count);
  GatherProblems(count);
  for (size_t first = 0, end = 0; first < size; first = end) {
    while (end < size && is_exact(end) == is_exact(first)) ++end;
    if (is_exact(first)) {
      SolveInLanes(first, end - first);
    } else {
      SolveToFirstOrder(first, end - first);
    }
  }
}

void SweepPoints::GatherProblems(int64_t count) {
  std::optional<SceneContact> contact;
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    statuses_[i] = driven_.IsValid(contact) ? RowStatus::kOk : RowStatus::kInvalid;
    pendulum::Problem problem = {.omega_minus = 1.0, .law = problems_.law()};  // Separating costs least to solve.
    if (statuses_[i] == RowStatus::kOk) problem = ClosedFormProblem(driven_.scene());
    problems_.Set(i, PlanPendulum(i, problem));
    driven_.Advance();
  }
}

// Chooses the model of the i-th problem and returns what it is to solve. A demand that is a tolerance alone, as most are,
// takes a plan that costs less than the point.
pendulum::Problem SweepPoints::PlanPendulum(size_t i, pendulum::Problem problem) {
  if (sweep_.demand.required.IsEmpty() && sweep_.demand.excluded.IsEmpty()) {
    models_[i] = ModelOfPendulum(problem, sweep_.demand.relative_tolerance);
    if (models_[i] == Model::kFrictionless) problem.mu = problem.mu_static = 0.0;
    return problem;
  }
  const Choice choice = ChoosePendulum(problem, {}, sweep_.demand);
  models_[i] = choice.model;
  CheckInvariant(choice.model != Model::kPendulum || choice.negligible == 0.0,
                 "the closed form of a rigid pendulum neglects nothing");
  return Without(choice, problem);
}

// These models neglect nothing, so that the whole tolerance is left for rounding.
void SweepPoints::SolveInLanes(size_t first, size_t count) {
  std::vector<double*> columns = columns_;
  for (double*& column : columns) column += first;
  pendulum::SolveColumns(problems_, first, count, sweep_.demand.relative_tolerance,
                         {.outputs = sweep_.outputs,
                          .columns = columns,
                          .regimes = absl::MakeSpan(regimes_).subspan(first, count),
                          .inadmissible = absl::MakeSpan(inadmissible_.get() + first, count)});
}

void SweepPoints::SolveToFirstOrder(size_t first, size_t count) {
  for (size_t i = first; i < first + count; ++i) {
    const pendulum::Problem problem = problems_[i];
    const first_order::Approximation approximation = first_order::Approximate(problem);
    for (size_t c = 0; c < columns_.size(); ++c) {
      columns_[c][i] = first_order::Value(problem, approximation, sweep_.outputs[c]);
    }
    regimes_[i] = first_order::RegimeOf(problem);
    inadmissible_[i] = false;
  }
}

// Solves the points in the lanes of planar contacts, then goes back to those that the lanes leave to their scenes.
absl::Status SweepPoints::SolvePlanar(int64_t first, int64_t count, absl::FunctionRef<bool()> stopped) {
  const auto size = static_cast<size_t>(count);
  for (size_t done = 0; done < size; done += PlanarLanes::kBlock) {
    SolvePlanarBlock(done, std::min(PlanarLanes::kBlock, size - done));
  }
  const auto is_left = [](Model model) { return model == Model::kUnspecified; };
  if (std::none_of(models_.begin(), models_.begin() + count, is_left)) return absl::OkStatus();
  for (size_t i = 0; i < size; ++i) {
    if (!is_left(models_[i])) continue;
    if (stopped()) return Stopped();
    driven_.GoTo(first + static_cast<int64_t>(i));
    if (!SolveTogether(i, 1, stopped)) return Stopped();
  }
  driven_.GoTo(first + count - 1);
  driven_.Advance();
  return absl::OkStatus();
}

void SweepPoints::SolvePlanarBlock(size_t first, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const PlanarLanes::Numbers numbers = PlanarLanes::NumbersOf(driven_.scene());
    for (size_t n = 0; n < numbers.size(); ++n) planar_->numbers[n][i] = numbers[n];
    driven_.Advance();
  }
  std::vector<double*> places = columns_;
  for (double*& place : places) place += first;
  const PlanarLanes::Block& block = planar_->block;
  planar_->lanes.Solve(planar_->columns, count, places, planar_->block);
  const auto at = static_cast<ptrdiff_t>(first);
  std::copy_n(block.models.begin(), count, models_.begin() + at);
  std::copy_n(block.regimes.begin(), count, regimes_.begin() + at);
  std::copy_n(block.inadmissible.begin(), count, inadmissible_.get() + at);
  std::fill_n(statuses_.begin() + at, count, RowStatus::kOk);
}

// Overwrites bad points and tallies all of them.
void SweepPoints::FinishBlock(int64_t first, int64_t count, SweepSummary& tallies) {
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    const auto is_finite = [i](const double* column) { return std::isfinite(column[i]); };
    RowStatus& status = statuses_[i];
    if (status == RowStatus::kOk && !std::all_of(columns_.begin(), columns_.end(), is_finite)) {
      status = RowStatus::kNotRepresentable;
    }
    if (status == RowStatus::kOk && inadmissible_[i]) status = RowStatus::kInadmissible;
    if (status != RowStatus::kOk && status != RowStatus::kInadmissible) {
      regimes_[i] = Regime::kInvalid;
      for (double* column : columns_) column[i] = std::numeric_limits<double>::quiet_NaN();
    }
    const int64_t index = first + static_cast<int64_t>(i);
    Add(index, tallies.by_regime[static_cast<size_t>(regimes_[i])]);
    if (status == RowStatus::kInadmissible) Add(index, tallies.inadmissible);
    if (regimes_[i] != Regime::kInvalid) Add(index, tallies.by_model[static_cast<size_t>(models_[i])]);
  }
  tallies.points += count;
}

}  // namespace ricochet
