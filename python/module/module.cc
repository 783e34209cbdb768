// The module ricochet._core: the functions of the package, computed in this process or by a server that is named.

#include <google/protobuf/descriptor.h>
#include <grpc/support/log.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "absl/synchronization/mutex.h"
#include "client/cost_reader.h"
#include "core/base/invariant.h"
#include "proto/wire/info.h"
#include "python/module/call.h"
#include "python/module/columns.h"
#include "python/module/record.h"
#include "python/module/request.h"
#include "python/module/rows.h"
#include "ricochet/client.h"
#include "ricochet/engine_info.h"

namespace ricochet::python {
namespace {

using google::protobuf::DescriptorPool;

std::optional<std::chrono::milliseconds> Milliseconds(std::optional<double> seconds) {
  if (!seconds.has_value()) return std::nullopt;
  return std::chrono::milliseconds(std::llround(*seconds * 1e3));
}

Callee InProcess(std::optional<double> deadline_s) {
  return {.solver = std::make_shared<LocalSolver>(), .deadline = Milliseconds(deadline_s)};
}

// The name that an option has in Python.
std::string OptionName(const std::string& field) {
  if (field == "target") return "server";
  if (field == "max_receive_bytes") return "max_receive";
  return std::string(absl::StripPrefix(field, "security."));
}

ClientOptions OptionsOf(const py::dict& given) {
  const auto text = [&given](const char* name) { return given[name].cast<std::string>(); };
  ClientOptions options = {.target = text("server"), .user_agent = absl::StrCat("ricochet-python/", ThisVersion())};
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
  Raise(violations);
}

Callee OfServer(const py::dict& given) {
  StartGrpc();
  absl::StatusOr<Client> client = Client::Connect(OptionsOf(given));
  if (!client.ok()) Raise(client.status());
  return {.solver = std::make_shared<Client>(*std::move(client)), .is_remote = true};
}

py::object Solve(const Callee& solver, py::handle scene, py::handle tolerance, py::handle require, py::handle exclude,
                 py::handle strict, py::handle history, py::handle force_history, py::handle certified,
                 py::handle both_ends, py::handle derivatives) {
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
    filler.FillArgument("both_ends", both_ends, arguments);
    filler.FillArgument("derivatives", derivatives, arguments);
    request = FromProto(arguments);
  }
  request.scene = SceneOf(scene, filler);
  filler.Finish();
  return UnreadRecordOf(std::make_unique<SolveResponse>(Call(solver).Ask(&Solver::Solve, request)));
}

py::object Info(const Callee& solver) { return RecordOf(ToProto(Call(solver).Ask(&Solver::Info, InfoRequest()))); }

// Answers a request that has one response, as a record.
template <typename Wire, auto kMethod>
py::object Answer(const Callee& solver, py::handle scene, const py::dict& arguments) {
  return RecordOf(ToProto(Call(solver).Ask(kMethod, RequestOf<Wire>(scene, arguments))));
}

// Answers with the numbers and the codes of the rows as arrays, and the summary as a record.
py::tuple AuditBatch(const Callee& solver, py::handle scene, const py::dict& arguments) {
  const auto answer =
      ToProto(Call(solver).Ask(&Solver::AuditBatch, RequestOf<v1::AuditBatchRequest>(scene, arguments)));
  std::vector<const google::protobuf::Message*> rows;
  for (const v1::AuditReport& report : answer.reports()) rows.push_back(&report);
  Columns columns;
  AddColumns(*v1::AuditReport::descriptor(), rows, "", columns);
  return py::make_tuple(columns.numbers, columns.codes, RecordOf(answer.summary()));
}

// Answers with one message that has all rows.
py::object Cost(const Callee& solver, py::handle scene, const py::dict& arguments, const py::object& progress) {
  const auto request = RequestOf<v1::CostRequest>(scene, arguments);
  CostChunk whole;
  Call call(solver);
  ForEachPart<CostStream>(call, &Solver::Cost, request, [&](const CostChunk& chunk) {
    AddPart(chunk, whole);
    if (!progress.is_none()) progress(chunk.rows_done, chunk.rows_total);
  });
  return RecordOf(ToProto(whole));
}

py::list NamesOfEnum(const std::string& name) {
  const auto* const type = DescriptorPool::generated_pool()->FindEnumTypeByName(absl::StrCat("ricochet.v1.", name));
  CheckInvariant(type != nullptr, "Python asks for the names of an enum of the service");
  return EnumNames(*type);
}

py::list NamesOfFields(const std::string& name) {
  const auto* const type = DescriptorPool::generated_pool()->FindMessageTypeByName(absl::StrCat("ricochet.v1.", name));
  CheckInvariant(type != nullptr, "Python asks for the fields of a message of the service");
  return FieldNames(*type);
}

void AddSolver(py::module_& module) {
  py::class_<Callee> solver(module, "Solver");
  solver.def("solve", &Solve)
      .def("plan", &Answer<v1::PlanRequest, &Solver::Plan>)
      .def("bounds", &Answer<v1::BoundsRequest, &Solver::Bounds>)
      .def("audit", &Answer<v1::AuditRequest, &Solver::Audit>)
      .def("audit_batch", &AuditBatch)
      .def("fit", &Answer<v1::FitRequest, &Solver::Fit>)
      .def("multicontact", &Answer<v1::MultiContactRequest, &Solver::MultiContact>)
      .def("info", &Info)
      .def("cost", &Cost)
      .def("abandon", &Callee::Abandon);
  AddRows(module, solver);
  module.def("in_process", &InProcess);
  module.def("check_options", &CheckOptions);
  module.def("of_server", &OfServer);
}

}  // namespace
}  // namespace ricochet::python

PYBIND11_MODULE(_core, module) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  // Errors are exceptions. What gRPC writes to standard error is for those who ask for it.
  if (std::getenv("GRPC_VERBOSITY") == nullptr) gpr_set_log_function([](gpr_log_func_args* /*line*/) {});
  using namespace ricochet::python;  // NOLINT(google-build-using-namespace): the module is theirs.
  AddScene(module);
  AddSolver(module);
  AddForks(module);
  AddStates(module);
  module.def("read", &ReadRecord);
  module.def("read_entry", [](py::handle record, py::handle name) {
    py::object entry = ReadEntry(record, name);
    if (!entry) throw py::key_error(py::str(name));
    return entry;
  });
  module.def("enum_names", &NamesOfEnum);
  module.def("field_names", &NamesOfFields);
}
