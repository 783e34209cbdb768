#include "core/sweep/sweep_run.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/answer/scene_outcome.h"
#include "core/contact/reduction.h"
#include "core/models/pendulum/columns.h"
#include "core/models/pendulum/first_order.h"
#include "core/models/pendulum/pendulum.h"
#include "core/numerics/invariant.h"
#include "core/plan/demand_fields.h"
#include "core/plan/planned_scene.h"
#include "core/problem/scene_problem.h"
#include "core/scene/validate.h"
#include "core/sweep/column.h"
#include "core/sweep/driven_scene.h"
#include "core/sweep/grid.h"

namespace ricochet {
namespace {

constexpr int64_t kFirstChunkPoints = 1024;

void Add(int64_t index, Tally& tally) {
  if (tally.count++ == 0) tally.first_index = index;
}

std::vector<Violation> CheckRange(const SweepRequest& request) {
  const int64_t points = PointCount(request.grid);
  const int64_t end = request.end_index.value_or(points);
  std::vector<Violation> violations;
  if (end < 0 || end > points) {
    violations.push_back({"end_index", absl::StrCat("= ", end, ": must be in [0, ", points, "], the grid's points")});
  } else if (request.first_index < 0 || request.first_index > end) {
    violations.push_back(
        {"first_index", absl::StrCat("= ", request.first_index, ": must be in [0, end_index = ", end, "]")});
  }
  return violations;
}

absl::Status Stopped() { return absl::CancelledError("the sweep was stopped by its caller"); }

void Append(std::vector<Violation> more, std::vector<Violation>& violations) {
  std::move(more.begin(), more.end(), std::back_inserter(violations));
}

}  // namespace

class SweepRun::Impl {
 public:
  explicit Impl(const SweepRequest& request)
      : driven_(request.grid), demand_(ToDemand(request.demand)), with_regime_(request.with_regime) {}

  absl::Status Prepare(const SweepRequest& request);

  int64_t points_total() const { return end_ - first_; }
  int64_t points_done() const { return next_ - first_; }
  bool ended() const { return ended_; }
  absl::StatusOr<SweepChunk> NextChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough,
                                       int64_t most_bytes);

 private:
  void ResolveColumns(const std::vector<std::string>& columns, const ColumnPositions& known);
  int64_t NextCount(int64_t most_bytes) const;
  absl::StatusOr<int64_t> ComputeBlock(int64_t count, absl::FunctionRef<bool()> stopped,
                                       absl::FunctionRef<bool()> is_enough);
  absl::StatusOr<int64_t> SolvePoints(int64_t count, absl::FunctionRef<bool()> stopped,
                                      absl::FunctionRef<bool()> is_enough);
  bool SolvePoint(size_t i, absl::FunctionRef<bool()> stopped);
  void SolveLanes(int64_t count);
  void GatherProblems(int64_t count);
  pendulum::Problem PlanPendulum(size_t i, pendulum::Problem problem);
  void SolveInLanes(size_t first, size_t count);
  void SolveToFirstOrder(size_t first, size_t count);
  void FinishBlock(int64_t count);

  DrivenScene driven_;
  Demand demand_;
  bool with_regime_;
  bool in_lanes_ = false;                  // True if the pendulum's SIMD lanes give every column.
  std::vector<pendulum::Output> outputs_;  // The columns, if the lanes give them.
  std::vector<size_t> positions_of_;       // Else the columns' positions in Columns(scene).
  std::vector<double> numbers_;            // All columns of one point.
  int64_t first_ = 0;
  int64_t end_ = 0;
  int64_t next_ = 0;
  bool ended_ = false;
  SweepSummary summary_;

  // One block of at most kPointsBetweenStops points.
  pendulum::ProblemColumns problems_;  // Only if the lanes give the columns.
  std::vector<Regime> regimes_;
  std::vector<Model> models_;
  std::unique_ptr<bool[]> valid_;
  std::unique_ptr<bool[]> inadmissible_;
  std::vector<double*> columns_;  // The place of the block's values of each column.
};

absl::Status SweepRun::Impl::Prepare(const SweepRequest& request) {
  const Scene& scene = driven_.scene();
  std::optional<SceneContact> contact;
  const auto stays = [this](const Violation& violation) { return !driven_.CanBeCured(violation); };
  std::vector<Violation> violations = Validate(scene, RestitutionIs::kRequired, contact, stays);
  if (violations.empty()) {
    violations = CheckDemand(scene, contact, request.demand);
    std::erase_if(violations, std::not_fn(stays));
  }
  Append(driven_.violations(), violations);
  const std::vector<Violation> axes = ValidateAxes(request.grid);
  Append(axes, violations);
  const std::vector<std::string> all = Columns(scene);
  const ColumnPositions known = PositionsOf(all);
  Append(CheckColumns(request.columns, all, known), violations);
  if (axes.empty()) Append(CheckRange(request), violations);
  if (!violations.empty()) return InvalidRequest(violations);

  ResolveColumns(request.columns, known);
  first_ = request.first_index;
  end_ = request.end_index.value_or(PointCount(request.grid));
  next_ = first_;
  regimes_.resize(kPointsBetweenStops);
  models_.resize(kPointsBetweenStops);
  valid_ = std::make_unique<bool[]>(kPointsBetweenStops);
  inadmissible_ = std::make_unique<bool[]>(kPointsBetweenStops);
  columns_.resize(request.columns.size());
  if (first_ < end_) driven_.GoTo(first_);
  return absl::OkStatus();
}

void SweepRun::Impl::ResolveColumns(const std::vector<std::string>& columns, const ColumnPositions& known) {
  const Scene& scene = driven_.scene();
  in_lanes_ = HasClosedForm(scene) && !scene.compliance.has_value() &&
              std::all_of(columns.begin(), columns.end(),
                          [](const std::string& column) { return PendulumColumn(column).has_value(); });
  if (in_lanes_) problems_ = pendulum::ProblemColumns(pendulum::MakeProblem(scene).law, kPointsBetweenStops);
  for (const std::string& column : columns) {
    if (in_lanes_) {
      outputs_.push_back(*PendulumColumn(column));
    } else {
      positions_of_.push_back(known.at(column));
    }
  }
}

// The first chunk is small, so that a caller soon sees something.
int64_t SweepRun::Impl::NextCount(int64_t most_bytes) const {
  const auto bytes_a_point = static_cast<int64_t>(columns_.size() * sizeof(double));
  const int64_t fitting = std::max(most_bytes / bytes_a_point, int64_t{1});
  return std::min({next_ == first_ ? kFirstChunkPoints : fitting, fitting, end_ - next_});
}

// Moves the first `count` values of each column together, out of columns that had room for `room` values.
void Shorten(int64_t room, int64_t count, size_t columns, std::vector<double>& values) {
  for (int64_t c = 1; c < static_cast<int64_t>(columns); ++c) {
    std::copy_n(values.begin() + c * room, count, values.begin() + c * count);
  }
  values.resize(static_cast<size_t>(count) * columns);
}

absl::StatusOr<SweepChunk> SweepRun::Impl::NextChunk(absl::FunctionRef<bool()> stopped,
                                                     absl::FunctionRef<bool()> is_enough, int64_t most_bytes) {
  CheckInvariant(!ended_, "a sweep has no chunk after the one with its summary");
  const int64_t room = NextCount(most_bytes);
  SweepChunk chunk = {.first_index = next_};
  chunk.values.resize(static_cast<size_t>(room) * columns_.size());
  bool is_cut = false;
  while (chunk.count < room && !is_cut) {
    for (size_t c = 0; c < columns_.size(); ++c) {
      columns_[c] = chunk.values.data() + static_cast<int64_t>(c) * room + chunk.count;
    }
    const int64_t block = std::min(kPointsBetweenStops, room - chunk.count);
    const absl::StatusOr<int64_t> solved = ComputeBlock(block, stopped, is_enough);
    if (!solved.ok()) return solved.status();
    if (with_regime_) chunk.regimes.insert(chunk.regimes.end(), regimes_.begin(), regimes_.begin() + *solved);
    chunk.count += *solved;
    is_cut = *solved < block || is_enough();
  }
  if (chunk.count < room) Shorten(room, chunk.count, columns_.size(), chunk.values);
  chunk.points_done = points_done();
  chunk.points_total = points_total();
  chunk.tallies = summary_;
  ended_ = next_ == end_;
  if (ended_) chunk.summary = summary_;
  return chunk;
}

// Returns the number of points that it has computed: `count`, unless they took long enough before.
absl::StatusOr<int64_t> SweepRun::Impl::ComputeBlock(int64_t count, absl::FunctionRef<bool()> stopped,
                                                     absl::FunctionRef<bool()> is_enough) {
  if (stopped()) return Stopped();
  if (in_lanes_) {
    SolveLanes(count);
  } else {
    const absl::StatusOr<int64_t> solved = SolvePoints(count, stopped, is_enough);
    if (!solved.ok()) return solved;
    count = *solved;
  }
  FinishBlock(count);
  next_ += count;
  summary_.points += count;
  return count;
}

absl::StatusOr<int64_t> SweepRun::Impl::SolvePoints(int64_t count, absl::FunctionRef<bool()> stopped,
                                                    absl::FunctionRef<bool()> is_enough) {
  for (int64_t i = 0; i < count; ++i) {
    if (i > 0 && is_enough()) return i;
    if (stopped() || !SolvePoint(static_cast<size_t>(i), stopped)) return Stopped();
    driven_.Advance();
  }
  return count;
}

// Returns false if it was stopped.
bool SweepRun::Impl::SolvePoint(size_t i, absl::FunctionRef<bool()> stopped) {
  std::optional<SceneContact> contact;
  valid_[i] = driven_.IsValid(contact);
  if (!valid_[i]) return true;
  Outcome outcome;
  const absl::Status status = SolveScene(driven_.scene(), contact,
                                         {.extent = {.detail = Detail::kNumbers}, .demand = demand_}, stopped, outcome);
  if (absl::IsCancelled(status)) return false;
  valid_[i] = status.ok();
  if (!valid_[i]) return true;
  regimes_[i] = outcome.regime;
  models_[i] = outcome.plan.model;
  inadmissible_[i] = !outcome.admissible;
  ReadColumns(outcome, numbers_);
  for (size_t c = 0; c < columns_.size(); ++c) columns_[c][i] = numbers_[positions_of_[c]];
  return true;
}

// Solves each run of points whose plans agree by the model that they call for.
void SweepRun::Impl::SolveLanes(int64_t count) {
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

void SweepRun::Impl::GatherProblems(int64_t count) {
  std::optional<SceneContact> contact;
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    valid_[i] = driven_.IsValid(contact);
    pendulum::Problem problem = {.omega_minus = 1.0, .law = problems_.law()};  // Separating costs least to solve.
    if (valid_[i]) problem = ClosedFormProblem(driven_.scene());
    problems_.Set(i, PlanPendulum(i, problem));
    driven_.Advance();
  }
}

// Chooses the model of the i-th problem and returns what it is to solve. A demand that is a tolerance alone, as most are,
// takes a plan that costs less than the point.
pendulum::Problem SweepRun::Impl::PlanPendulum(size_t i, pendulum::Problem problem) {
  if (demand_.required.IsEmpty() && demand_.excluded.IsEmpty()) {
    models_[i] = ModelOfPendulum(problem, demand_.relative_tolerance);
    if (models_[i] == Model::kFrictionless) problem.mu = problem.mu_static = 0.0;
    return problem;
  }
  const Choice choice = ChoosePendulum(problem, {}, demand_);
  models_[i] = choice.model;
  CheckInvariant(choice.model != Model::kPendulum || choice.negligible == 0.0,
                 "the closed form of a rigid pendulum neglects nothing");
  return Without(choice, problem);
}

// These models neglect nothing, so that the whole tolerance is left for rounding.
void SweepRun::Impl::SolveInLanes(size_t first, size_t count) {
  std::vector<double*> columns = columns_;
  for (double*& column : columns) column += first;
  pendulum::SolveColumns(problems_, first, count, demand_.relative_tolerance,
                         {.outputs = outputs_,
                          .columns = columns,
                          .regimes = absl::MakeSpan(regimes_).subspan(first, count),
                          .inadmissible = absl::MakeSpan(inadmissible_.get() + first, count)});
}

void SweepRun::Impl::SolveToFirstOrder(size_t first, size_t count) {
  for (size_t i = first; i < first + count; ++i) {
    const pendulum::Problem problem = problems_[i];
    const first_order::Approximation approximation = first_order::Approximate(problem);
    for (size_t c = 0; c < columns_.size(); ++c) {
      columns_[c][i] = first_order::Value(problem, approximation, outputs_[c]);
    }
    regimes_[i] = first_order::RegimeOf(problem);
    inadmissible_[i] = false;
  }
}

// Overwrites bad points and tallies all of them.
void SweepRun::Impl::FinishBlock(int64_t count) {
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    const auto is_finite = [i](const double* column) { return std::isfinite(column[i]); };
    if (!valid_[i] || !std::all_of(columns_.begin(), columns_.end(), is_finite)) {
      regimes_[i] = Regime::kInvalid;
      inadmissible_[i] = false;
      for (double* column : columns_) column[i] = std::numeric_limits<double>::quiet_NaN();
    }
    const int64_t index = next_ + static_cast<int64_t>(i);
    Add(index, summary_.by_regime[static_cast<size_t>(regimes_[i])]);
    if (inadmissible_[i]) Add(index, summary_.inadmissible);
    if (regimes_[i] != Regime::kInvalid) Add(index, summary_.by_model[static_cast<size_t>(models_[i])]);
  }
}

absl::StatusOr<SweepRun> SweepRun::Make(const SweepRequest& request) {
  auto impl = std::make_unique<Impl>(request);
  const absl::Status status = impl->Prepare(request);
  if (!status.ok()) return status;
  return SweepRun(std::move(impl));
}

SweepRun::SweepRun(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SweepRun::SweepRun(SweepRun&&) noexcept = default;
SweepRun& SweepRun::operator=(SweepRun&&) noexcept = default;
SweepRun::~SweepRun() = default;

int64_t SweepRun::points_total() const { return impl_->points_total(); }
int64_t SweepRun::points_done() const { return impl_->points_done(); }
bool SweepRun::ended() const { return impl_->ended(); }
absl::StatusOr<SweepChunk> SweepRun::NextChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough,
                                               int64_t most_bytes) {
  return impl_->NextChunk(stopped, is_enough, most_bytes);
}

}  // namespace ricochet
