#include "python/module/solver.h"

#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "proto/wire/audit.h"
#include "proto/wire/cost.h"
#include "proto/wire/info.h"
#include "proto/wire/requests.h"
#include "python/module/filler.h"
#include "python/module/fork.h"
#include "python/module/python_names.h"
#include "python/module/record.h"
#include "python/module/scene.h"
#include "ricochet/client.h"
#include "ricochet/engine_info.h"

namespace ricochet::python {
namespace {

std::optional<std::chrono::milliseconds> Milliseconds(std::optional<double> seconds) {
  if (!seconds.has_value()) return std::nullopt;
  return std::chrono::milliseconds(static_cast<int64_t>(*seconds * 1e3));
}

BoundSolver InProcess(std::optional<double> deadline_s) {
  return BoundSolver({.solver = std::make_shared<LocalSolver>(), .deadline = Milliseconds(deadline_s)});
}

// The name that an option has in Python.
std::string OptionName(const std::string& field) {
  if (field == "target") return "server";
  if (field == "max_receive_bytes") return "max_receive";
  return std::string(absl::StripPrefix(field, "security."));
}

ClientOptions OptionsOf(const py::dict& given) {
  const auto text = [&given](const char* name) { return given[name].cast<std::string>(); };
  ClientOptions options = {.target = text("server"), .user_agent = absl::StrCat("ricochet-python/", ThisEngine().version)};
  options.max_receive_bytes = given["max_receive"].cast<int64_t>();
  options.sweep_deadline = Milliseconds(given["deadline"].cast<std::optional<double>>());
  if (options.sweep_deadline.has_value()) options.deadline = *options.sweep_deadline;
  options.security = {.tls = given["tls"].cast<bool>(),
                      .tls_ca = text("tls_ca"),
                      .tls_cert = text("tls_cert"),
                      .tls_key = text("tls_key"),
                      .server_name = text("server_name"),
                      .token = text("token"),
                      .token_file = text("token_file")};
  return options;
}

void CheckOptions(const py::dict& given) {
  const absl::Status checked = ValidateOptions(OptionsOf(given));
  if (checked.ok()) return;
  std::vector<Violation> violations = ViolationsOf(checked);
  for (Violation& violation : violations) violation.field = OptionName(violation.field);
  Raise(InvalidRequest(violations));
}

BoundSolver OfServer(const py::dict& given) {
  StartGrpc();
  absl::StatusOr<Client> client = Client::Connect(OptionsOf(given));
  if (!client.ok()) Raise(client.status());
  return BoundSolver({.solver = std::make_shared<Client>(*std::move(client)), .is_remote = true});
}

py::object Solve(const BoundSolver& solver, py::handle scene, py::handle tolerance, py::handle require,
                 py::handle exclude, py::handle strict, py::handle history, py::handle force_history,
                 py::handle certified) {
  Filler filler;
  SolveRequest request;
  {
    v1::SolveRequest arguments;
    filler.FillArgument("tolerance", tolerance, arguments);
    filler.FillArgument("require", require, arguments);
    filler.FillArgument("exclude", exclude, arguments);
    filler.FillArgument("strict", strict, arguments);
    filler.FillArgument("history", history, arguments);
    filler.FillArgument("force_history", force_history, arguments);
    filler.FillArgument("certified", certified, arguments);
    request = FromProto(arguments);
  }
  request.scene = SceneOf(scene, filler);
  filler.Finish();
  return UnreadRecordOf(std::make_unique<SolveResponse>(Call(solver.callee()).Ask(&Solver::Solve, request)));
}

py::object Info(const BoundSolver& solver) {
  return RecordOf(ToProto(Call(solver.callee()).Ask(&Solver::Info, InfoRequest())));
}

// Answers a request that has one response, as a record.
template <typename Wire, auto kMethod>
py::object Answer(const BoundSolver& solver, const Request& asked) {
  auto request = FromProto(asked.As<Wire>());
  request.scene = asked.scene();
  return RecordOf(ToProto(Call(solver.callee()).Ask(kMethod, request)));
}

// Answers with one message that has all rows.
py::object Cost(const BoundSolver& solver, const Request& asked, const py::object& progress) {
  CostRequest request = FromProto(asked.As<v1::CostRequest>());
  request.scene = asked.scene();
  v1::CostResponse whole;
  Call call(solver.callee());
  ForEachPart<CostStream>(call, &Solver::Cost, request, [&](const CostChunk& chunk) {
    v1::CostResponse part = ToProto(chunk);
    part.mutable_rows()->Swap(whole.mutable_rows());
    whole.mutable_rows()->MergeFrom(part.rows());
    part.mutable_rows()->Swap(whole.mutable_rows());
    whole.Swap(&part);
    if (!progress.is_none()) progress(chunk.rows_done, chunk.rows_total);
  });
  return RecordOf(whole);
}

}  // namespace

void BoundSolver::Abandon() {
  [[maybe_unused]] static std::vector<std::shared_ptr<const Solver>>* const kept =
      new std::vector<std::shared_ptr<const Solver>>();
  kept->push_back(std::move(callee_.solver));
}

void AddSolver(py::module_& module) {
  py::class_<BoundSolver> solver(module, "Solver");
  solver.def("solve", &Solve)
      .def("plan", &Answer<v1::PlanRequest, &Solver::Plan>)
      .def("bounds", &Answer<v1::BoundsRequest, &Solver::Bounds>)
      .def("audit", &Answer<v1::AuditRequest, &Solver::Audit>)
      .def("audit_batch", &Answer<v1::AuditBatchRequest, &Solver::AuditBatch>)
      .def("info", &Info)
      .def("cost", &Cost)
      .def("abandon", &BoundSolver::Abandon);
  AddRows(module, solver);
  module.def("in_process", &InProcess);
  module.def("check_options", &CheckOptions);
  module.def("of_server", &OfServer);
}

}  // namespace ricochet::python
