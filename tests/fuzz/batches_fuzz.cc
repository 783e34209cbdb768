// Fuzzes many impacts at once: bytes are a v1::SweepRequest, whose points are swept as a whole and in part, solved as
// the rows of a batch, and solved one by one. A grid of more than some dozen points is left out, and so is one with a
// point whose impact takes time.
//
// It checks that each point has the same bits, regime and status in the sweep, in a part of it and in the batch, whose
// counts are equal; that each number is that of Solve, and NaN where Solve leaves it unset; that the status of a point
// is INVALID, INADMISSIBLE or NOT_REPRESENTABLE exactly if Solve says so; and that a row without numbers has a reason.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/rows/axis_values.h"
#include "core/scene/field.h"
#include "core/scene/validate.h"
#include "core/types/grid.h"
#include "proto/wire/sweep.h"
#include "ricochet/error.h"
#include "ricochet/outcome_numbers.h"
#include "ricochet/solver.h"
#include "tests/fuzz/fail.h"
#include "tests/fuzz/mutate_message.h"
#include "tests/fuzz/outcome_claims.h"
#include "tests/fuzz/path_texts.h"

namespace ricochet {
namespace {

constexpr int64_t kMostPoints = 48;
constexpr size_t kMostNames = 64;

// Many impacts, whoever has computed them: the values column after column, as a sweep or a batch gives them.
struct Rows {
  std::vector<std::vector<double>> columns;
  std::vector<Regime> regimes;
  std::vector<RowStatus> statuses;
  SweepSummary counts;
};

uint64_t Bits(double value) { return std::isnan(value) ? 0 : std::bit_cast<uint64_t>(value); }

absl::StatusOr<Rows> Sweep(const SweepRequest& request) {
  Rows rows;
  rows.columns.resize(request.columns.size());
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(request)) {
    if (!chunk.ok()) return chunk.status();
    auto value = chunk->values.begin();
    for (std::vector<double>& column : rows.columns) {
      column.insert(column.end(), value, value + chunk->count);
      value += chunk->count;
    }
    rows.regimes.insert(rows.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
    rows.statuses.insert(rows.statuses.end(), chunk->statuses.begin(), chunk->statuses.end());
    rows.counts = chunk->tallies;
  }
  return rows;
}

// The values of the axes at each point.
std::vector<std::vector<double>> InputsOf(const Grid& grid) {
  std::vector<std::vector<double>> inputs(grid.axes.size());
  std::vector<int64_t> positions(grid.axes.size());
  for (int64_t point = 0; point < PointCount(grid); ++point) {
    AxisPositions(grid, point, absl::MakeSpan(positions));
    for (size_t axis = 0; axis < inputs.size(); ++axis) {
      inputs[axis].push_back(AxisValue(grid.axes[axis], positions[axis]));
    }
  }
  return inputs;
}

Rows Batch(const SweepRequest& request, const std::vector<std::vector<double>>& inputs) {
  const size_t count = inputs.front().size();
  Rows rows;
  rows.regimes.resize(count);
  rows.statuses.resize(count);
  rows.columns.assign(request.columns.size(), std::vector<double>(count));
  const BatchSetup setup = {.scene = request.grid.scene,
                            .fields = AxisPaths(request.grid),
                            .columns = request.columns,
                            .demand = request.demand};
  BatchRows batch = {.inputs = {inputs.begin(), inputs.end()},
                     .outputs = {},
                     .regimes = absl::MakeSpan(rows.regimes),
                     .statuses = absl::MakeSpan(rows.statuses)};
  for (std::vector<double>& column : rows.columns) batch.outputs.push_back(absl::MakeSpan(column));
  const absl::StatusOr<BatchResponse> response = LocalSolver().SolveBatch(setup, batch);
  if (!response.ok()) Fail(absl::StrCat("the rows of a sweep are refused as a batch: ", response.status().ToString()));
  rows.counts = response->summary.counts;
  const auto bad = std::count_if(rows.statuses.begin(), rows.statuses.end(), [](RowStatus status) {
    return status == RowStatus::kInvalid || status == RowStatus::kNotRepresentable;
  });
  if (response->summary.bad_rows.size() != std::min(static_cast<size_t>(bad), kMostBadRows)) {
    Fail("another number of bad rows than of rows without numbers");
  }
  for (const BadRow& row : response->summary.bad_rows) {
    if (row.field.empty() || row.description.empty()) Fail("a bad row has no reason");
    if (row.status != rows.statuses[static_cast<size_t>(row.row)]) Fail("a bad row has another status");
  }
  return rows;
}

// Compares `part` with the rows of `all` from `first` on.
void CheckSameRows(const Rows& part, const Rows& all, size_t first, const std::vector<std::string>& names,
                   const char* what) {
  for (size_t i = 0; i < part.regimes.size(); ++i) {
    if (part.regimes[i] != all.regimes[first + i]) Fail(absl::StrCat(what, " has another regime in row ", i));
    if (part.statuses[i] != all.statuses[first + i]) Fail(absl::StrCat(what, " has another status in row ", i));
    for (size_t column = 0; column < names.size(); ++column) {
      const double one = part.columns[column][i];
      const double other = all.columns[column][first + i];
      if (Bits(one) == Bits(other)) continue;
      Fail(absl::StrCat(what, " has ", names[column], " = ", one, " in place of ", other, " in row ", i));
    }
  }
}

void CheckPart(SweepRequest request, const Rows& all) {
  const size_t first = all.regimes.size() / 2;
  request.first_index = static_cast<int64_t>(first);
  const absl::StatusOr<Rows> part = Sweep(request);
  if (!part.ok()) Fail(absl::StrCat("a part of a sweep is refused: ", part.status().ToString()));
  if (part->regimes.size() != all.regimes.size() - first) Fail("a part of a sweep has another number of points");
  CheckSameRows(*part, all, first, request.columns, "a part of a sweep");
}

// Duration is an effect that asking for one of its columns may bring in, and that Solve is not asked for.
bool AsksForDuration(const std::vector<std::string>& columns) {
  return std::any_of(columns.begin(), columns.end(),
                     [](const std::string& column) { return absl::StartsWith(column, "contact."); });
}

std::map<std::string, double> NumbersOf(const Outcome& outcome) {
  std::map<std::string, double> numbers;
  VisitOutcomeNumbers(outcome, [&](const NumberPath& path, double number) { numbers[path.Text()] = number; });
  return numbers;
}

// A point as Solve is asked for it.
struct Point {
  SolveRequest request;
  // False if an axis has a value that its number cannot have. The scene may hide that: an angle becomes two lengths.
  bool keeps_rules = true;
};

// True if Solve refuses the point for nothing but effects that the call requires and that this point lacks, such as
// friction where an axis makes its coefficient 0. In a row such a requirement asks for nothing.
bool OnlyLacksRequired(const absl::Status& refused) {
  const std::vector<Violation> violations = ViolationsOf(refused);
  const auto is_required = [](const Violation& violation) { return absl::StartsWith(violation.field, "required["); };
  return !violations.empty() && std::all_of(violations.begin(), violations.end(), is_required);
}

void CheckRow(const Point& point, const Rows& rows, size_t row, const std::vector<std::string>& names) {
  const RowStatus status = rows.statuses[row];
  if (!point.keeps_rules) {
    if (status != RowStatus::kInvalid) Fail(absl::StrCat("a row that breaks a rule has status ", status));
    return;
  }
  const absl::StatusOr<SolveResponse> response = LocalSolver().Solve(point.request);
  const bool has_numbers = status != RowStatus::kInvalid && status != RowStatus::kNotRepresentable;
  for (size_t column = 0; column < names.size() && !has_numbers; ++column) {
    if (!std::isnan(rows.columns[column][row])) Fail(names[column] + " is a number in a row without numbers");
  }
  if (status != RowStatus::kInvalid && OnlyLacksRequired(response.status())) return;
  if (!response.ok()) {
    // Solve has more numbers than the row, one of which may be too large.
    const bool other_is_too_large = absl::IsOutOfRange(response.status()) && status != RowStatus::kInvalid;
    if (has_numbers && !other_is_too_large) Fail(absl::StrCat("a row has numbers: ", response.status().ToString()));
    if (!has_numbers && (status == RowStatus::kInvalid) != absl::IsInvalidArgument(response.status())) {
      Fail(absl::StrCat("a row has status ", status, ": ", response.status().ToString()));
    }
    return;
  }
  const Outcome& outcome = response->outcome;
  const std::map<std::string, double> numbers = NumbersOf(outcome);
  const bool has_all =
      std::all_of(names.begin(), names.end(), [&](const auto& name) { return numbers.contains(name); });
  const bool is_told = status == (!outcome.admissible                              ? RowStatus::kInadmissible
                                  : outcome.termination != Termination::kConverged ? RowStatus::kNotConverged
                                                                                   : RowStatus::kOk);
  // A row that lacks a number may say so.
  if (!is_told && (has_all || !has_numbers)) Fail(absl::StrCat("a row has status ", status, " and Solve an answer"));
  if (outcome.regime != rows.regimes[row]) Fail("a row has another regime than Solve");
  for (size_t column = 0; column < names.size(); ++column) {
    const auto number = numbers.find(names[column]);
    const double value = rows.columns[column][row];
    const double alone = number == numbers.end() ? std::nan("") : number->second;
    if (Bits(value) == Bits(alone)) continue;
    Fail(absl::StrCat(names[column], " = ", value, " in row ", row, ", and ", alone, " in Solve"));
  }
}

// Returns what Solve is asked for the points; nothing if one of them takes time.
std::vector<Point> PointsOf(const SweepRequest& request, const std::vector<std::vector<double>>& inputs) {
  std::vector<Point> points;
  for (size_t row = 0; row < static_cast<size_t>(PointCount(request.grid)); ++row) {
    auto& [point, keeps_rules] = points.emplace_back();
    point.scene = request.grid.scene;
    point.demand = request.demand;
    for (size_t axis = 0; axis < inputs.size(); ++axis) {
      absl::StatusOr<Field> field = ResolveField(request.grid.axes[axis].path, point.scene);
      if (field.ok() && !field->Set(inputs[axis][row])) keeps_rules = false;
    }
    if (TakesTime(point)) return {};
  }
  return points;
}

void Run(const v1::SweepRequest& proto) {
  SweepRequest request = FromProto(proto);
  if (request.columns.size() > kMostNames || request.grid.axes.size() > kMostNames) return;
  request.with_regime = true;
  request.first_index = 0;
  request.end_index.reset();
  if (!ValidateAxes(request.grid).empty()) return CheckStatus(Sweep(request).status(), false);
  if (PointCount(request.grid) > kMostPoints) return;
  const std::vector<std::vector<double>> inputs = InputsOf(request.grid);
  const std::vector<Point> points = PointsOf(request, inputs);
  if (points.empty() || AsksForDuration(request.columns)) return;
  const absl::StatusOr<Rows> sweep = Sweep(request);
  if (!sweep.ok()) return CheckStatus(sweep.status(), false);
  if (sweep->regimes.size() != points.size()) Fail("a sweep has another number of points than its grid");
  CheckPart(request, *sweep);
  if (!inputs.empty()) {
    const Rows batch = Batch(request, inputs);
    CheckSameRows(batch, *sweep, 0, request.columns, "a batch");
    if (batch.counts != sweep->counts) Fail("a batch has other counts than the sweep");
  }
  for (size_t row = 0; row < points.size(); ++row) CheckRow(points[row], *sweep, row, request.columns);
}

}  // namespace

std::unique_ptr<google::protobuf::Message> NewInput() { return std::make_unique<v1::SweepRequest>(); }

std::vector<std::string> InputTexts() {
  std::vector<std::string> texts = FieldTexts();
  for (std::string& column : ColumnTexts()) texts.push_back(std::move(column));
  return texts;
}

}  // namespace ricochet

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ricochet::v1::SweepRequest request;
  if (request.ParseFromArray(data, static_cast<int>(size))) ricochet::Run(request);
  return 0;
}
