#include "core/sweep/sweep_run.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/answer/scene_outcome.h"
#include "core/contact/reduction.h"
#include "core/models/pendulum/first_order.h"
#include "core/models/pendulum/pendulum.h"
#include "core/plan/demand_fields.h"
#include "core/plan/planned_scene.h"
#include "core/problem/scene_problem.h"
#include "core/scene/field.h"
#include "core/scene/validate.h"
#include "core/sweep/column.h"
#include "core/sweep/grid.h"

namespace ricochet {
namespace {

constexpr int64_t kFirstChunkPoints = 1024;
constexpr int64_t kChunkBytes = int64_t{512} << 10;

void Add(int64_t index, Tally& tally) {
  if (tally.count++ == 0) tally.first_index = index;
}

std::vector<Violation> CheckColumns(const std::vector<std::string>& columns, const std::vector<std::string>& known) {
  std::vector<Violation> violations;
  if (columns.empty()) violations.push_back({"columns", "is empty: must name at least one"});
  std::set<std::string> seen;
  for (size_t i = 0; i < columns.size(); ++i) {
    const std::string path = absl::StrCat("columns[", i, "]");
    const std::string found = absl::StrCat("= \"", absl::CEscape(columns[i]), "\": must be ");
    if (std::find(known.begin(), known.end(), columns[i]) == known.end()) {
      violations.push_back({path, absl::StrCat(found, "one of ", absl::StrJoin(known, ", "))});
    } else if (!seen.insert(columns[i]).second) {
      violations.push_back({path, found + "named once"});
    }
  }
  return violations;
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

// The fields that the axes drive, resolved in `scene`.
struct Drivers {
  std::vector<Field> fields;
  std::vector<Violation> violations;
  std::set<std::string> driven;  // Numbers of the scene whose base value does not matter, by path.
};

Drivers ResolveAxes(const std::vector<Axis>& axes, Scene& scene) {
  Drivers drivers;
  std::map<std::string, size_t> driven_by;
  for (size_t i = 0; i < axes.size(); ++i) {
    const std::string path = absl::StrCat("axes[", i, "].path");
    absl::StatusOr<Field> field = ResolveField(axes[i].path, scene);
    if (!field.ok()) {
      drivers.violations.push_back({path, std::string(field.status().message())});
      continue;
    }
    for (const std::string& target : field->sets()) {
      const auto [other, is_new] = driven_by.emplace(target, i);
      if (is_new) continue;
      drivers.violations.push_back({path, absl::StrCat("= \"", absl::CEscape(axes[i].path), "\": must not drive ",
                                                       target, ", which axes[", other->second, "] drives")});
    }
    // An angle needs the base scene's distance, so a and b must be right there.
    if (field->sets().size() == 1) drivers.driven.insert(axes[i].path);
    drivers.fields.push_back(*std::move(field));
  }
  return drivers;
}

// Whether a point may keep the rule that the base scene breaks, because axes drive what it is about.
bool IsAMatterOfEachPoint(const Violation& violation, const Drivers& drivers) {
  switch (violation.kind) {
    case ViolationKind::kShape:
      return false;
    case ViolationKind::kValue:
      return drivers.driven.contains(violation.field) ||
             std::any_of(violation.tied_to.begin(), violation.tied_to.end(),
                         [&](const std::string& path) { return drivers.driven.contains(path); });
    case ViolationKind::kContact:
      return !drivers.fields.empty();
  }
  return false;
}

// Those of the base scene that no axis cures.
std::vector<Violation> Uncured(std::vector<Violation> violations, const Drivers& drivers) {
  std::erase_if(violations, [&](const Violation& violation) { return IsAMatterOfEachPoint(violation, drivers); });
  return violations;
}

void Append(std::vector<Violation> more, std::vector<Violation>& violations) {
  std::move(more.begin(), more.end(), std::back_inserter(violations));
}

}  // namespace

class SweepRun::Impl {
 public:
  explicit Impl(const SweepRequest& request)
      : grid_(request.grid), demand_(ToDemand(request.demand)), scene_(request.grid.scene) {}

  absl::Status Prepare(const SweepRequest& request);

  int64_t column_count() const { return static_cast<int64_t>(columns_.size()); }
  int64_t points_total() const { return end_ - first_; }
  int64_t points_done() const { return next_ - first_; }
  const SweepSummary& summary() const { return summary_; }

  Extent Next() const;
  bool Compute(Extent extent, absl::Span<double> values, absl::Span<Regime> regimes, absl::FunctionRef<bool()> stopped);

 private:
  void SetPoint(int64_t index);
  void AdvancePoint();
  void SetField(size_t k);
  bool PointIsValid() const;
  void ResolveColumns(const std::vector<std::string>& columns, const std::vector<std::string>& known);
  void PlanPendulum(size_t i);
  void GatherProblems(int64_t count);
  void SolveLanes(int64_t count);
  void SolveInLanes(size_t first, size_t count);
  void SolveToFirstOrder(size_t first, size_t count);
  bool SolvePoints(int64_t count, absl::FunctionRef<bool()> stopped);
  void SolvePoint(size_t i);
  bool ComputeBlock(int64_t count, absl::FunctionRef<bool()> stopped);
  void FinishBlock(int64_t count);

  Grid grid_;
  Demand demand_;
  Scene scene_;  // The current point; the fields point into it.
  std::vector<Field> fields_;
  std::vector<uint8_t> is_bad_;  // Whether a field's value breaks its own rule.
  int64_t bad_fields_ = 0;
  bool has_relations_ = false;  // Whether there are rules beyond those.
  std::vector<int64_t> counts_;
  std::vector<int64_t> positions_;
  bool in_lanes_ = false;                  // Whether the pendulum's SIMD lanes give every column.
  bool in_space_ = false;                  // Whether each point is integrated.
  std::vector<pendulum::Output> outputs_;  // The columns, if they do.
  std::vector<size_t> positions_of_;       // The columns' positions in Columns(scene_), if they do not.
  std::vector<double> numbers_;            // One point's.
  int64_t first_ = 0;
  int64_t end_ = 0;
  int64_t next_ = 0;
  SweepSummary summary_;

  // One block of points.
  std::vector<pendulum::Problem> problems_;
  std::vector<Regime> regimes_;
  std::vector<Model> models_;
  std::unique_ptr<bool[]> valid_;
  std::unique_ptr<bool[]> inadmissible_;
  std::vector<double*> columns_;
};

absl::Status SweepRun::Impl::Prepare(const SweepRequest& request) {
  std::vector<Violation> violations;
  Drivers drivers;
  if (!std::holds_alternative<std::monostate>(scene_.system)) {
    drivers = ResolveAxes(grid_.axes, scene_);
  }
  Append(Uncured(Validate(scene_), drivers), violations);
  if (violations.empty()) Append(Uncured(CheckDemand(scene_, request.demand), drivers), violations);
  Append(std::move(drivers.violations), violations);
  const std::vector<Violation> axes = ValidateAxes(grid_);
  Append(axes, violations);
  const std::vector<std::string> known = Columns(scene_);
  Append(CheckColumns(request.columns, known), violations);
  if (axes.empty()) Append(CheckRange(request), violations);
  if (!violations.empty()) return InvalidRequest(violations);

  fields_ = std::move(drivers.fields);
  is_bad_.assign(fields_.size(), 0);
  has_relations_ = HasRelations(scene_);
  for (const Axis& axis : grid_.axes) counts_.push_back(AxisCount(axis));
  positions_.resize(grid_.axes.size());
  ResolveColumns(request.columns, known);
  first_ = request.first_index;
  end_ = request.end_index.value_or(PointCount(grid_));
  next_ = first_;
  problems_.resize(kPointsBetweenStops);
  regimes_.resize(kPointsBetweenStops);
  models_.resize(kPointsBetweenStops);
  valid_ = std::make_unique<bool[]>(kPointsBetweenStops);
  inadmissible_ = std::make_unique<bool[]>(kPointsBetweenStops);
  columns_.resize(request.columns.size());
  if (first_ < end_) SetPoint(first_);
  return absl::OkStatus();
}

void SweepRun::Impl::ResolveColumns(const std::vector<std::string>& columns, const std::vector<std::string>& known) {
  in_lanes_ = HasClosedForm(scene_) && !scene_.compliance.has_value() &&
              std::all_of(columns.begin(), columns.end(),
                          [](const std::string& column) { return PendulumColumn(column).has_value(); });
  in_space_ = TangentialDirections(scene_.system) == 2;
  for (const std::string& column : columns) {
    if (in_lanes_) {
      outputs_.push_back(*PendulumColumn(column));
    } else {
      positions_of_.push_back(static_cast<size_t>(std::find(known.begin(), known.end(), column) - known.begin()));
    }
  }
}

void SweepRun::Impl::SetPoint(int64_t index) {
  AxisPositions(grid_, index, absl::MakeSpan(positions_));
  for (size_t k = 0; k < fields_.size(); ++k) SetField(k);
}

void SweepRun::Impl::SetField(size_t k) {
  const bool is_bad = !fields_[k].Set(AxisValue(grid_.axes[k], positions_[k]));
  bad_fields_ += static_cast<int64_t>(is_bad) - static_cast<int64_t>(is_bad_[k]);
  is_bad_[k] = is_bad;
}

// To the next point, setting only what changes.
void SweepRun::Impl::AdvancePoint() {
  for (size_t k = fields_.size(); k-- > 0;) {
    const bool wraps = ++positions_[k] == counts_[k];
    if (wraps) positions_[k] = 0;
    SetField(k);
    if (!wraps && grid_.combination != Combination::kZip) return;
  }
}

// As Validate would have it: Prepare has checked all that no axis drives.
bool SweepRun::Impl::PointIsValid() const { return bad_fields_ == 0 && (!has_relations_ || KeepsRelations(scene_)); }

SweepRun::Extent SweepRun::Impl::Next() const {
  const int64_t wanted = next_ == first_ ? kFirstChunkPoints : kChunkBytes / (column_count() * int64_t{sizeof(double)});
  return {next_, std::min(wanted, end_ - next_)};
}

// Most demands are a tolerance alone, and most points are cheap: so must their plan be.
void SweepRun::Impl::PlanPendulum(size_t i) {
  if (demand_.required.IsEmpty() && demand_.excluded.IsEmpty()) {
    models_[i] = ModelOfPendulum(problems_[i], demand_.relative_tolerance);
    if (models_[i] == Model::kFrictionless) problems_[i].mu = problems_[i].mu_static = 0.0;
    return;
  }
  const Choice choice = ChoosePendulum(problems_[i], {}, demand_);
  models_[i] = choice.model;
  problems_[i] = Without(choice, problems_[i]);
}

void SweepRun::Impl::GatherProblems(int64_t count) {
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    valid_[i] = PointIsValid();
    problems_[i] = valid_[i] ? ClosedFormProblem(scene_) : pendulum::Problem{};
    if (!valid_[i]) problems_[i].omega_minus = 1.0;  // Separating: the cheapest to solve.
    PlanPendulum(i);
    AdvancePoint();
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

void SweepRun::Impl::SolveInLanes(size_t first, size_t count) {
  std::vector<double*> columns = columns_;
  for (double*& column : columns) column += first;
  pendulum::SolveColumns(absl::MakeConstSpan(problems_).subspan(first, count), outputs_, columns,
                         absl::MakeSpan(regimes_).subspan(first, count),
                         absl::MakeSpan(inadmissible_.get() + first, count));
}

void SweepRun::Impl::SolveToFirstOrder(size_t first, size_t count) {
  for (size_t i = first; i < first + count; ++i) {
    const first_order::Approximation approximation = first_order::Approximate(problems_[i]);
    for (size_t c = 0; c < columns_.size(); ++c) {
      columns_[c][i] = first_order::Value(problems_[i], approximation, outputs_[c]);
    }
    regimes_[i] = first_order::RegimeOf(problems_[i]);
    inadmissible_[i] = false;
  }
}

// Each run of points whose plans agree by the model that they call for.
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

void SweepRun::Impl::SolvePoint(size_t i) {
  valid_[i] = PointIsValid();
  if (!valid_[i]) return;
  const absl::StatusOr<Outcome> outcome = SolveScene(scene_, {.demand = demand_, .detail = Detail::kNumbers});
  valid_[i] = outcome.ok();
  if (!valid_[i]) return;
  regimes_[i] = outcome->regime;
  models_[i] = outcome->plan.model;
  inadmissible_[i] = !outcome->admissible;
  ReadColumns(*outcome, numbers_);
  for (size_t c = 0; c < columns_.size(); ++c) columns_[c][i] = numbers_[positions_of_[c]];
}

// False if it was stopped.
bool SweepRun::Impl::SolvePoints(int64_t count, absl::FunctionRef<bool()> stopped) {
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    if (in_space_ && stopped()) return false;
    SolvePoint(i);
    AdvancePoint();
  }
  return true;
}

bool SweepRun::Impl::ComputeBlock(int64_t count, absl::FunctionRef<bool()> stopped) {
  if (in_lanes_) {
    SolveLanes(count);
  } else if (!SolvePoints(count, stopped)) {
    return false;
  }
  FinishBlock(count);
  next_ += count;
  summary_.points += count;
  return true;
}

bool SweepRun::Impl::Compute(Extent extent, absl::Span<double> values, absl::Span<Regime> regimes,
                             absl::FunctionRef<bool()> stopped) {
  assert(extent.first_index == next_);
  assert(static_cast<int64_t>(values.size()) == extent.count * column_count());
  for (int64_t done = 0; done < extent.count;) {
    if (stopped()) return false;
    const int64_t count = std::min(kPointsBetweenStops, extent.count - done);
    for (int64_t c = 0; c < column_count(); ++c) {
      columns_[static_cast<size_t>(c)] = values.data() + c * extent.count + done;
    }
    if (!ComputeBlock(count, stopped)) return false;
    if (!regimes.empty()) {
      std::copy_n(regimes_.begin(), count, regimes.begin() + done);
    }
    done += count;
  }
  return true;
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

int64_t SweepRun::column_count() const { return impl_->column_count(); }
int64_t SweepRun::points_total() const { return impl_->points_total(); }
int64_t SweepRun::points_done() const { return impl_->points_done(); }
SweepRun::Extent SweepRun::Next() const { return impl_->Next(); }
const SweepSummary& SweepRun::summary() const { return impl_->summary(); }

bool SweepRun::Compute(Extent extent, absl::Span<double> values, absl::Span<Regime> regimes,
                       absl::FunctionRef<bool()> stopped) {
  return impl_->Compute(extent, values, regimes, stopped);
}

}  // namespace ricochet
