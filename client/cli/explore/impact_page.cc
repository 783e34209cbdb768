#include "client/cli/explore/impact_page.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/types/span.h"
#include "client/cli/explore/connect.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/input/scene_templates.h"
#include "client/cli/report/solve_plot.h"
#include "client/cli/report/solve_report.h"
#include "client/cli/text/json_text.h"
#include "proto/wire/audit.h"
#include "proto/wire/requests.h"
#include "proto/wire/scene.h"

namespace ricochet::cli {

extern const absl::string_view kImpactPage;  // The text of impact_page.html.

namespace {

constexpr char kFriction[] = "friction.kinetic_coefficient";

std::string SceneJson(const Scene& scene) { return SparseJsonOf(ToProto(scene)); }

// Returns {"pendulum": {...}, ...}, the scenes of the templates.
std::string TemplatesJson() {
  std::string text;
  const auto add = [&text](const SceneTemplate& one, google::protobuf::Message&& scene) {
    ParseMessage("template.textproto", one.text, scene).IgnoreError();  // A template is right: tests solve each.
    absl::StrAppend(&text, text.empty() ? "{" : ",", "\"", one.system, "\":", SparseJsonOf(scene));
  };
  for (const SceneTemplate& one : SceneTemplates()) add(one, v1::Scene());
  for (const SceneTemplate& one : MultiContactTemplates()) add(one, v1::MultiContactScene());
  return text + "}";
}

// `more` is what the page starts with beside its scenes: further members of an object, or nothing.
std::string PageOf(const std::string& more, const std::string& nonce) {
  const std::string start = absl::StrCat("{\"scenes\":", TemplatesJson(), more, "}");
  // The end of the element must not stand in a text of the JSON.
  return absl::StrReplaceAll(kImpactPage,
                             {{"{{nonce}}", nonce}, {"{{start}}", absl::StrReplaceAll(start, {{"<", "\\u003c"}})}});
}

// Returns what the regime, the termination and each event of an outcome mean, as a list of sentences.
std::string WordsJson(const Outcome& outcome) {
  std::string text = "[";
  AppendJson(WhatHappens(outcome), text);
  AppendJson(TerminationText(outcome.termination), text += ",");
  for (const Event& event : outcome.timeline) AppendJson(EventText(event.kind), text += ",");
  return text + "]";
}

// Asks the solver what the page shows of a scene.
struct Asking {
  const Solver& solver;
  const Scene& scene;
  const CallOptions& options;

  // Returns `,"name":{"request":...,"answer":...}`, or with an error in place of the answer.
  std::string Json(const char* name, absl::string_view method, const std::string& request) const {
    const absl::StatusOr<std::string> answer = FindCall(solver, method)(request, options);
    return absl::StrCat(R"(,")", name, R"(":{"request":)", request, answer.ok() ? R"(,"answer":)" : R"(,"error":)",
                        answer.ok() ? *answer : ErrorJson(answer.status()), "}");
  }

  // Returns the regime at each coefficient of friction; nothing if there is no answer.
  std::vector<Regime> RegimesAt(const std::vector<double>& mu) const {
    std::vector<Regime> regimes(mu.size());
    std::vector<double> numbers(mu.size());
    const BatchSetup setup = {.scene = scene, .fields = {kFriction}, .columns = {"coefficients.newton"}};
    const BatchRows rows = {
        .inputs = {mu}, .outputs = {absl::MakeSpan(numbers)}, .regimes = absl::MakeSpan(regimes), .statuses = {}};
    return solver.SolveBatch(setup, rows, options).ok() ? regimes : std::vector<Regime>();
  }

  // Returns coefficients of friction from 0 to at least 2; none if the scene has no answer. The scene's own is one of
  // them, and where the regime changes two are so near to each other that the page need not guess where it does.
  std::vector<double> FrictionAxis() const {
    const double own = scene.friction.kinetic_coefficient, most = std::max(2.0, 1.25 * own);
    std::vector<double> mu = {own};
    for (int i = 0; i <= 100; ++i) mu.push_back(most * i / 100);
    std::map<double, Regime> known;
    // Each further round is one call, and makes the gaps in which the regime changes kParts times as narrow.
    constexpr int kRounds = 3, kParts = 16;
    for (int round = 0; round <= kRounds && !mu.empty(); ++round) {
      const std::vector<Regime> regimes = RegimesAt(mu);
      if (regimes.empty()) break;
      for (size_t i = 0; i < mu.size(); ++i) known.emplace(mu[i], regimes[i]);
      mu.clear();
      for (auto low = known.begin(), high = std::next(low); high != known.end(); low = high++) {
        // The regime of a smooth surface holds at mu = 0 alone, so that this gap is not refined.
        if (low->first == 0.0 || low->second == high->second) continue;
        for (int part = 1; part < kParts; ++part) {
          mu.push_back(low->first + (high->first - low->first) * part / kParts);
        }
      }
    }
    std::vector<double> axis;
    for (const auto& [at, regime] : known) axis.push_back(at);
    return axis;
  }

  // Asks for the coefficients of restitution and the effective friction over the stated one.
  std::string Curves(const char* name, const Scene& of, const std::vector<double>& mu) const {
    const std::string bytes(reinterpret_cast<const char*>(mu.data()), mu.size() * sizeof(double));
    return Json(name, "SolveBatch",
                absl::StrCat(R"({"setup":{"fields":[")", kFriction, R"("],"columns":[)",
                             R"("coefficients.newton","coefficients.poisson","coefficients.energetic",)",
                             R"("effective.kinetic"],)", R"("scene":)", SceneJson(of), R"(},"inputs":[")",
                             absl::Base64Escape(bytes), R"("]})"));
  }

  // These answers depend on the stated coefficient; without one there are none.
  std::string operator()(std::monostate /*none*/) const { return ""; }
  template <typename Coefficient>
  std::string operator()(const Coefficient& stated) const {
    Scene elastic = scene, by_newton = scene;
    elastic.restitution = EnergeticCoefficient{1.0};
    elastic.restitution_by_speed.reset();
    by_newton.restitution = NewtonCoefficient{stated.value};
    const std::vector<double> mu = FrictionAxis();
    return absl::StrCat(Curves("over", scene, mu), Curves("elastic", elastic, mu),
                        Json("simulator", "Solve", absl::StrCat("{\"scene\":", SceneJson(by_newton), "}")));
  }
};

// Returns {"solve": {...}, "bounds": {...}, ...}.
std::string AnswersJson(const Solver& solver, const SolveRequest& request, const SolveResponse& response,
                        const CallOptions& options) {
  const Scene& scene = request.scene;
  const Asking asking = {solver, scene, options};
  std::string text = absl::StrCat(R"({"solve":{"request":)", SparseJsonOf(ToProto(request)), R"(,"answer":)",
                                  JsonOf(ToProto(response)), R"(},"words":)", WordsJson(response.outcome),
                                  asking.Json("bounds", "Bounds", absl::StrCat(R"({"scene":)", SceneJson(scene), "}")),
                                  std::visit(asking, scene.restitution));
  // In space the course is curved between its events.
  if (response.outcome.timeline.size() > 1 && TangentialDirections(scene.system) == 2) {
    const AuditBatchRequest path = {.scene = scene, .columns = PartsOfTheWay(response.outcome, 48)};
    text += asking.Json("path", "AuditBatch", JsonOf(ToProto(path)));
  }
  return text + "}";
}

}  // namespace

std::string LivePage(const std::optional<Scene>& scene, const std::string& nonce) {
  return PageOf(scene.has_value() ? absl::StrCat(",\"scene\":", SceneJson(*scene)) : "", nonce);
}

std::string FinishedPage(const Solver& solver, const SolveRequest& request, const SolveResponse& response) {
  return PageOf(absl::StrCat(",\"scene\":", SceneJson(request.scene),
                             ",\"answers\":", AnswersJson(solver, request, response, {})),
                "");
}

absl::StatusOr<std::string> PageAnswers(const Solver& solver, const std::string& body, const CallOptions& options) {
  v1::SolveRequest proto;
  if (absl::Status wrong = ParseJson("the body", body, proto); !wrong.ok()) return wrong;
  const SolveRequest request = FromProto(proto);
  const absl::StatusOr<SolveResponse> response = solver.Solve(request, options);
  if (!response.ok()) return response.status();
  return AnswersJson(solver, request, *response, options);
}

}  // namespace ricochet::cli
