#include "python/module/rows.h"

#include <google/protobuf/util/json_util.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/base/invariant.h"
#include "core/rows/axis_values.h"
#include "core/types/grid.h"
#include "proto/wire/batch.h"
#include "proto/wire/chunk_seal.h"
#include "proto/wire/outcome.h"
#include "proto/wire/sweep.h"
#include "python/module/request.h"

namespace ricochet::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style>;
using Codes = py::array_t<uint8_t, py::array::c_style>;

// Writes the numbers of the codes from the place of `first` on.
template <typename Code>
void Put(const std::vector<Code>& codes, int64_t first, Codes& to) {
  std::transform(codes.begin(), codes.end(), to.mutable_data() + first,
                 [](Code code) { return static_cast<uint8_t>(code); });
}

// Counts the rows that have no numbers, those that are inadmissible, those whose impact has no end or no solution,
// those that did not converge, and those in which nothing strikes.
py::tuple Counts(const Codes& regimes, const Codes& statuses) {
  const auto count = [&statuses](RowStatus status) {
    return std::count(statuses.data(), statuses.data() + statuses.size(), static_cast<uint8_t>(status));
  };
  const auto without_end = std::count_if(regimes.data(), regimes.data() + regimes.size(), [](uint8_t code) {
    const auto regime = static_cast<Regime>(code);
    return regime != Regime::kInvalid && !HasEnd(regime);
  });
  const auto separating =
      std::count(regimes.data(), regimes.data() + regimes.size(), static_cast<uint8_t>(Regime::kSeparating));
  return py::make_tuple(count(RowStatus::kInvalid) + count(RowStatus::kNotRepresentable),
                        count(RowStatus::kInadmissible), without_end, count(RowStatus::kNotConverged), separating);
}

absl::Span<const double> SpanOf(py::handle column) {
  const auto numbers = py::cast<Numbers>(column);
  CheckInvariant(numbers.ptr() == column.ptr() && numbers.ndim() == 1, "a column of a batch needs no copy");
  return {numbers.data(), static_cast<size_t>(numbers.shape(0))};
}

// Solves the rows of `inputs`, which are arrays of doubles, into arrays of its own.
py::tuple SolveBatch(const Callee& solver, py::handle scene, const py::dict& arguments, const py::list& inputs) {
  auto setup = RequestOf<v1::BatchSetup>(scene, arguments);
  BatchRows rows;
  for (const py::handle column : inputs) rows.inputs.push_back(SpanOf(column));
  const size_t count = rows.inputs.empty() ? 0 : rows.inputs.front().size();
  py::list outputs;
  for (size_t c = 0; c < setup.columns.size(); ++c) {
    Numbers column(static_cast<py::ssize_t>(count));
    rows.outputs.emplace_back(column.mutable_data(), count);
    outputs.append(std::move(column));
  }
  std::vector<Regime> regimes(count);
  Codes regime_codes(static_cast<py::ssize_t>(count));
  Codes statuses(static_cast<py::ssize_t>(count));
  rows.regimes = absl::MakeSpan(regimes);
  rows.statuses = absl::MakeSpan(reinterpret_cast<RowStatus*>(statuses.mutable_data()), count);
  Call call(solver);
  const absl::StatusOr<BatchResponse> answer =
      call.Run([&] { return call.solver().SolveBatch(setup, rows, call.options()); });
  if (!answer.ok()) Raise(answer.status());
  Put(regimes, 0, regime_codes);
  py::list bad_rows;
  for (const BadRow& row : answer->summary.bad_rows) {
    bad_rows.append(py::make_tuple(row.row, static_cast<int>(row.status), row.field, row.description));
  }
  return py::make_tuple(outputs, regime_codes, statuses, Counts(regime_codes, statuses), bad_rows);
}

// The points of a sweep that have arrived.
struct Points {
  Numbers values;  // One row for each column.
  Codes regimes;
  Codes statuses;

  Points(size_t columns, int64_t count)
      : values({static_cast<py::ssize_t>(columns), static_cast<py::ssize_t>(count)}), regimes(count), statuses(count) {}

  void Take(const SweepChunk& chunk) {
    const int64_t first = chunk.points_done - chunk.count;
    for (py::ssize_t c = 0; c < values.shape(0); ++c) {
      std::copy_n(chunk.values.data() + c * chunk.count, chunk.count,
                  values.mutable_data() + c * values.shape(1) + first);
    }
    Put(chunk.regimes, first, regimes);
    Put(chunk.statuses, first, statuses);
  }
};

py::array_t<double> ValuesOf(const Axis& axis) {
  py::array_t<double> values(AxisCount(axis));
  AxisValues(axis, 0, {values.mutable_data(), static_cast<size_t>(values.size())});
  return values;
}

// The request and the engine of a sweep, by the names that the files of the command line have.
py::dict Provenance(const SweepRequest& request, const EngineInfo& engine) {
  std::string text;
  CheckInvariant(google::protobuf::util::MessageToJsonString(ToProto(request), &text).ok(), "a request is JSON");
  py::dict attributes;
  attributes["ricochet_request"] = text;
  attributes["ricochet_grid_fingerprint"] = GridFingerprint(request);
  attributes["source"] = "ricochet " + engine.version;
  attributes["ricochet_engine_fingerprint"] = engine.fingerprint;
  return attributes;
}

py::tuple Sweep(const Callee& solver, py::handle scene, const py::dict& arguments, const py::object& progress) {
  const auto request = RequestOf<v1::SweepRequest>(scene, arguments);
  std::optional<Points> points;
  EngineInfo engine;
  Call call(solver);
  ForEachPart<SweepStream>(call, &Solver::Sweep, request, [&](const SweepChunk& chunk) {
    if (!points.has_value()) points.emplace(request.columns.size(), chunk.points_total);
    points->Take(chunk);
    engine = chunk.engine;
    if (!progress.is_none()) progress(chunk.points_done, chunk.points_total);
  });
  CheckInvariant(points.has_value(), "a sweep that has not failed has points");
  py::list axes;
  for (const Axis& axis : request.grid.axes) axes.append(ValuesOf(axis));
  return py::make_tuple(points->values, points->regimes, points->statuses, Counts(points->regimes, points->statuses),
                        axes, Provenance(request, engine));
}

// Returns the values of an axis from `start` to `stop`. Raises InvalidRequest where a sweep would.
template <typename Spacing>
py::array_t<double> SpacedValues(double start, double stop, int64_t count) {
  const Axis axis = {.values = Spacing{.start = start, .stop = stop, .count = count}};
  std::vector<Violation> violations = ValidateAxes({.axes = {axis}});
  // "axes[0].linspace.stop" is an argument here.
  for (Violation& violation : violations) violation.field.erase(0, violation.field.rfind('.') + 1);
  if (!violations.empty()) Raise(violations);
  return ValuesOf(axis);
}

}  // namespace

void AddRows(py::module_& module, py::class_<Callee>& solver) {
  solver.def("solve_batch", &SolveBatch).def("sweep", &Sweep);
  module.def("linspace", &SpacedValues<Linspace>, py::arg("start"), py::arg("stop"), py::arg("count"));
  module.def("logspace", &SpacedValues<Logspace>, py::arg("start"), py::arg("stop"), py::arg("count"));
}

}  // namespace ricochet::python
