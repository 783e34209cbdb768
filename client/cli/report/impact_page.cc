#include "client/cli/report/impact_page.h"

#include <algorithm>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/cli/report/solve_plot.h"
#include "client/cli/report/solve_report.h"
#include "client/cli/text/json_text.h"
#include "proto/wire/audit.h"
#include "proto/wire/batch.h"
#include "proto/wire/outcome.h"
#include "proto/wire/requests.h"
#include "proto/wire/scene.h"

namespace ricochet::cli {

extern const char kImpactPage[];  // The text of impact_page.html.

namespace {

using google::protobuf::EnumDescriptor;

// Returns {"REGIME_SLIDING": "Sliding: ...", ...}, in the order of the numbers.
template <typename Words>
std::string WordsJson(const EnumDescriptor& type, Words words) {
  std::string text;
  for (int i = 0; i < type.value_count(); ++i) {
    text += i == 0 ? "{" : ",";
    AppendJson(type.value(i)->name(), text);
    text += ":";
    AppendJson(words(type.value(i)->number()), text);
  }
  return text + "}";
}

// `more` is what the page starts with beside its words: further members of the object, or nothing.
std::string PageOf(const std::string& more, const std::string& nonce) {
  const std::string regimes =
      WordsJson(*v1::Regime_descriptor(), [](int number) { return RegimeSentence(static_cast<Regime>(number)); });
  const std::string events =
      WordsJson(*v1::Event::Kind_descriptor(), [](int number) { return EventText(static_cast<EventKind>(number)); });
  const std::string terminations = WordsJson(
      *v1::Termination_descriptor(), [](int number) { return TerminationText(static_cast<Termination>(number)); });
  const std::string start =
      absl::StrCat("{\"regimes\":", regimes, ",\"events\":", events, ",\"terminations\":", terminations, more, "}");
  // The end of the element must not stand in a text of the JSON.
  return absl::StrReplaceAll(kImpactPage,
                             {{"{{nonce}}", nonce}, {"{{start}}", absl::StrReplaceAll(start, {{"<", "\\u003c"}})}});
}

// Returns `,"name":{"request":...,"answer":...}`, or with the message of the error in place of the answer.
std::string PairJson(const char* name, const google::protobuf::Message& request,
                     const absl::StatusOr<std::string>& answer) {
  std::string text = absl::StrCat(",\"", name, "\":{\"request\":", SparseJsonOf(request));
  if (answer.ok()) return absl::StrCat(text, ",\"answer\":", *answer, "}");
  text += ",\"error\":{\"message\":";
  AppendJson(answer.status().message(), text);
  return text + "}}";
}

// Friction from 0 to at least this value, in so many steps, is what the curves are drawn over.
constexpr double kMostFriction = 2.0;
constexpr int kFrictionSteps = 100;

// The slip of an impact in space is drawn at so many parts of its way.
constexpr int kPathIntervals = 48;

// Asks for the coefficients of restitution over friction.
std::string CurvesJson(const char* name, const Solver& solver, const Scene& scene) {
  const double most = std::max(kMostFriction, 1.25 * scene.friction.kinetic_coefficient);
  std::vector<double> friction;
  for (int i = 0; i <= kFrictionSteps; ++i) friction.push_back(most * i / kFrictionSteps);
  const BatchSetup setup = {.scene = scene,
                            .fields = {"friction.kinetic_coefficient"},
                            .columns = {"coefficients.newton", "coefficients.poisson", "coefficients.energetic"}};
  v1::SolveBatchRequest request;
  *request.mutable_setup() = ToProto(setup);
  SetInputs({.inputs = {friction}}, 0, friction.size(), request);
  absl::StatusOr<BatchSession> session = solver.OpenBatches(setup);
  if (!session.ok()) return PairJson(name, request, session.status());
  v1::SolveBatchResponse response;
  const absl::Status solved = BatchExchange().Answer(*session, setup.columns.size(), request, response).status();
  return PairJson(name, request, solved.ok() ? absl::StatusOr<std::string>(JsonOf(response)) : solved);
}

template <typename Request, typename Response>
std::string AnswerJson(const char* name, const Request& request, const absl::StatusOr<Response>& response) {
  return PairJson(name, ToProto(request),
                  response.ok() ? absl::StatusOr<std::string>(JsonOf(ToProto(*response))) : response.status());
}

struct StatedValue {
  std::optional<double> operator()(std::monostate /*none*/) const { return std::nullopt; }
  template <typename Coefficient>
  std::optional<double> operator()(const Coefficient& coefficient) const {
    return coefficient.value;
  }
};

// The answers that depend on the coefficient that the scene states, which are none without one.
std::string LawsJson(const Solver& solver, const Scene& scene) {
  const std::optional<double> coefficient = std::visit(StatedValue(), scene.restitution);
  if (!coefficient.has_value()) return "";
  Scene elastic = scene;
  elastic.restitution = EnergeticCoefficient{1.0};
  SolveRequest by_newton = {.scene = scene};
  by_newton.scene.restitution = NewtonCoefficient{*coefficient};
  return absl::StrCat(CurvesJson("over", solver, scene), CurvesJson("elastic", solver, elastic),
                      AnswerJson("simulator", by_newton, solver.Solve(by_newton)));
}

}  // namespace

std::string LivePage(const std::optional<Scene>& scene, const std::string& nonce) {
  return PageOf(scene.has_value() ? absl::StrCat(",\"scene\":", SparseJsonOf(ToProto(*scene))) : "", nonce);
}

std::string FinishedPage(const Solver& solver, const SolveRequest& request, const SolveResponse& response) {
  const Scene& scene = request.scene;
  const BoundsRequest bounds = {.scene = scene};
  std::string more =
      absl::StrCat(",\"scene\":", SparseJsonOf(ToProto(scene)),
                   ",\"answers\":{\"solve\":{\"request\":", SparseJsonOf(ToProto(request)),
                   ",\"answer\":", JsonOf(ToProto(response)), "}", AnswerJson("bounds", bounds, solver.Bounds(bounds)));
  more += LawsJson(solver, scene);
  if (response.outcome.timeline.size() > 1 && TangentialDirections(scene.system) == 2) {
    const AuditBatchRequest path = {.scene = scene, .columns = PartsOfTheWay(response.outcome, kPathIntervals)};
    more += AnswerJson("path", path, solver.AuditBatch(path));
  }
  return PageOf(more + "}", "");
}

}  // namespace ricochet::cli
