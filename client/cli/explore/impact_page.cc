#include "client/cli/explore/impact_page.h"

#include <algorithm>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/cli/explore/connect.h"
#include "client/cli/report/solve_plot.h"
#include "client/cli/report/solve_report.h"
#include "client/cli/text/json_text.h"
#include "proto/wire/audit.h"
#include "proto/wire/requests.h"
#include "proto/wire/scene.h"

namespace ricochet::cli {

extern const absl::string_view kImpactPage;  // The text of impact_page.html.

namespace {

// Returns {"REGIME_SLIDING": "Sliding: ...", ...}, in the order of the numbers.
template <typename Words>
std::string WordsJson(const google::protobuf::EnumDescriptor& type, Words words) {
  std::string text;
  for (int i = 0; i < type.value_count(); ++i) {
    text += i == 0 ? "{" : ",";
    AppendJson(type.value(i)->name(), text);
    text += ":";
    AppendJson(words(type.value(i)->number()), text);
  }
  return text + "}";
}

// `more` is what the page starts with beside its words: further members of an object, or nothing.
std::string PageOf(const std::string& more, const std::string& nonce) {
  const auto regime = [](int number) { return RegimeSentence(static_cast<Regime>(number)); };
  const auto event = [](int number) { return EventText(static_cast<EventKind>(number)); };
  const auto termination = [](int number) { return TerminationText(static_cast<Termination>(number)); };
  const std::string start =
      absl::StrCat("{\"regimes\":", WordsJson(*v1::Regime_descriptor(), regime),
                   ",\"events\":", WordsJson(*v1::Event::Kind_descriptor(), event),
                   ",\"terminations\":", WordsJson(*v1::Termination_descriptor(), termination), more, "}");
  // The end of the element must not stand in a text of the JSON.
  return absl::StrReplaceAll(kImpactPage,
                             {{"{{nonce}}", nonce}, {"{{start}}", absl::StrReplaceAll(start, {{"<", "\\u003c"}})}});
}

std::string SceneJson(const Scene& scene) { return SparseJsonOf(ToProto(scene)); }

// Returns `,"name":{"request":...,"answer":...}`, or with an error in place of the answer.
std::string AnswerJson(const char* name, const Solver& solver, absl::string_view method, const std::string& request) {
  const absl::StatusOr<std::string> answer = AskInJson(solver, method, request);
  return absl::StrCat(R"(,")", name, R"(":{"request":)", request, answer.ok() ? R"(,"answer":)" : R"(,"error":)",
                      answer.ok() ? *answer : ErrorJson(answer.status()), "}");
}

// Asks for the coefficients of restitution over friction, from 0 to at least 2.
std::string CurvesJson(const char* name, const Solver& solver, const Scene& scene) {
  const double most = std::max(2.0, 1.25 * scene.friction.kinetic_coefficient);
  std::vector<double> mu;
  for (int i = 0; i <= 100; ++i) mu.push_back(most * i / 100);
  const std::string bytes(reinterpret_cast<const char*>(mu.data()), mu.size() * sizeof(double));
  return AnswerJson(
      name, solver, "SolveBatch",
      absl::StrCat(R"({"setup":{"fields":["friction.kinetic_coefficient"],"columns":[)",
                   R"("coefficients.newton","coefficients.poisson","coefficients.energetic"],)", R"("scene":)",
                   SceneJson(scene), R"(},"inputs":[")", absl::Base64Escape(bytes), R"("]})"));
}

// The answers that depend on the coefficient that the scene states, which are none without one.
struct LawsJson {
  const Solver& solver;
  const Scene& scene;

  std::string operator()(std::monostate /*none*/) const { return ""; }
  template <typename Coefficient>
  std::string operator()(const Coefficient& stated) const {
    Scene elastic = scene, by_newton = scene;
    elastic.restitution = EnergeticCoefficient{1.0};
    by_newton.restitution = NewtonCoefficient{stated.value};
    const std::string simulated = absl::StrCat("{\"scene\":", SceneJson(by_newton), "}");
    return absl::StrCat(CurvesJson("over", solver, scene), CurvesJson("elastic", solver, elastic),
                        AnswerJson("simulator", solver, "Solve", simulated));
  }
};

}  // namespace

std::string LivePage(const std::optional<Scene>& scene, const std::string& nonce) {
  return PageOf(scene.has_value() ? absl::StrCat(",\"scene\":", SceneJson(*scene)) : "", nonce);
}

std::string FinishedPage(const Solver& solver, const SolveRequest& request, const SolveResponse& response) {
  const Scene& scene = request.scene;
  const std::string shown = SceneJson(scene);
  std::string more = absl::StrCat(R"(,"scene":)", shown, R"(,"answers":{"solve":{"request":)",
                                  SparseJsonOf(ToProto(request)), R"(,"answer":)", JsonOf(ToProto(response)), "}",
                                  AnswerJson("bounds", solver, "Bounds", absl::StrCat(R"({"scene":)", shown, "}")),
                                  std::visit(LawsJson{solver, scene}, scene.restitution));
  if (response.outcome.timeline.size() > 1 && TangentialDirections(scene.system) == 2) {
    const AuditBatchRequest path = {.scene = scene, .columns = PartsOfTheWay(response.outcome, 48)};
    more += AnswerJson("path", solver, "AuditBatch", JsonOf(ToProto(path)));
  }
  return PageOf(more + "}", "");
}

}  // namespace ricochet::cli
