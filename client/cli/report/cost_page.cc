#include "client/cli/report/cost_page.h"

#include <google/protobuf/text_format.h>

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/cli/report/cost_picture.h"
#include "client/cli/report/cost_report.h"
#include "client/cli/report/html_page.h"
#include "core/base/decimal.h"
#include "core/base/try.h"
#include "proto/wire/scene.h"

namespace ricochet::cli {
namespace {

constexpr char kColumns[] = R"(<dl>
<dt>one solve, spread</dt><dd>The median time of one call for this impact, on one thread with warm caches, and half the
distance between the quartiles. The time of planning is not in it.</dd>
<dt>of a batch</dt><dd>The time of one impact among 1,000 whose velocities before differ slightly.</dd>
<dt>error claimed</dt><dd>The largest error that the method says it may make.</dd>
<dt>error made</dt><dd>The distance of its answer from the exact one. All errors are those of the contact velocity after
the impact, as a fraction of the velocity before.</dd>
<dt>numerical error</dt><dd>The part that rounding and steps cause: the distance from the exact answer of the method's
own model.</dd>
<dt>modelling error</dt><dd>The part that an effect which the model leaves out causes, such as friction.</dd>
<dt>steps</dt><dd>The steps of an integration in time or impulse. A closed form takes none.</dd>
</dl>
)";

constexpr const char* kHeads[] = {"method",     "one solve",       "spread",          "of a batch", "error claimed",
                                  "error made", "numerical error", "modelling error", "steps"};

std::string CellsText(const CostRow& row) {
  const std::vector<std::string> cells = {
      row.name,
      row.solve.has_value()                  ? TimeText(row.solve->median_s)
      : row.status == CostStatus::kOutOfTime ? "no time left"
                                             : "no answer",
      row.solve.has_value() ? absl::StrCat(row.solve->samples == 1 ? "" : "± ", SpreadText(*row.solve)) : "",
      row.batch.has_value() ? TimeText(row.batch->median_s) : "",
      row.status == CostStatus::kMeasured ? ErrorText(row.claimed.total) : "",
      MadeText(row, &CostError::total),
      MadeText(row, &CostError::numerical),
      MadeText(row, &CostError::modelling),
      row.steps > 0 ? absl::StrCat(row.steps) : ""};
  std::string text;
  for (size_t i = 0; i < cells.size(); ++i) {
    absl::StrAppend(
        &text, HtmlElement("td", cells[i],
                           absl::StrCat(i >= 1 && i <= 3 ? " class=\"time\"" : "", " data-label=\"", kHeads[i], "\"")));
  }
  return text;
}

std::string MethodsTable(const CostChunk& study) {
  std::string text = "<table class=\"cards\">\n<thead><tr>";
  for (const char* head : kHeads) absl::StrAppend(&text, HtmlElement("th", head));
  absl::StrAppend(&text, "</tr></thead>\n<tbody>\n");
  const std::vector<bool> front = OnFront(study);
  for (size_t i = 0; i < study.rows.size(); ++i) {
    const CostRow& row = study.rows[i];
    const bool alarm = row.ClaimIsBroken() || row.status == CostStatus::kFailed;
    const char* kind = alarm ? " class=\"alarm\"" : front[i] ? " class=\"front\"" : "";
    absl::StrAppend(&text, "<tr", kind, ">", CellsText(row), "</tr>\n");
  }
  return text + "</tbody>\n</table>\n";
}

std::string PicksTable(const CostChunk& study) {
  std::vector<std::vector<std::string>> rows = {{"tolerance", "method"}};
  for (const CostPick& pick : study.summary->picks) rows.push_back({PickRangeText(pick), PickName(study, pick)});
  return HtmlTable(rows, "words");
}

std::string Notes(const CostChunk& study) {
  std::string text;
  for (const CostNote& note : NotesOf(study)) {
    absl::StrAppend(&text, HtmlElement("dt", absl::StrJoin(note.methods, "; ")), HtmlElement("dd", note.text), "\n");
  }
  return text.empty() ? "" : absl::StrCat("<h2>Notes</h2>\n<dl>\n", text, "</dl>\n");
}

std::string Fact(const std::string& what, const std::string& value, const std::string& more) {
  return absl::StrCat("<li>", HtmlElement("span", what, " class=\"quiet\""), HtmlElement("b", value),
                      HtmlElement("span", more), "</li>\n");
}

std::string Facts(const CostChunk& study) {
  const CostSummary& summary = *study.summary;
  std::string text = "<ul class=\"facts\">\n";
  if (!summary.front.empty()) {
    const CostRow& fast = study.rows.at(static_cast<size_t>(summary.front.front()));
    const CostRow& exact = study.rows.at(static_cast<size_t>(summary.front.back()));
    const auto fact = [&text](const char* what, const CostRow& row) {
      if (!row.solve.has_value() || !row.achieved.has_value()) return;
      absl::StrAppend(&text,
                      Fact(what, row.name,
                           absl::StrCat(TimeText(row.solve->median_s), ", error ", MadeText(row, &CostError::total))));
    };
    fact("fastest", fast);
    fact("most exact", exact);
  }
  return absl::StrCat(text, Fact("claims below the error", absl::StrCat(summary.deceived), TrustText(study)),
                      "</ul>\n");
}

// A picture in two widths, one of which the style sheet hides.
absl::StatusOr<std::string> Figure(const CostChunk& study, Plot (*plot)(const CostChunk&, PictureWidth),
                                   const std::string& id, const std::string& title, const std::string& caption) {
  std::string text = "<figure>\n";
  for (const auto& [width, name] :
       {std::pair(PictureWidth::kWide, "wide"), std::pair(PictureWidth::kNarrow, "narrow")}) {
    RICOCHET_TRY(const std::string file, DrawAs(plot(study, width), "svg"));
    absl::StrAppend(&text, "<div class=\"", name, "\">", InlineSvg(file, absl::StrCat(id, "-", name, "-"), title),
                    "</div>\n");
  }
  return absl::StrCat(text, HtmlElement("figcaption", caption), "\n</figure>\n");
}

std::string RunTable(const CostChunk& study, const std::string& date) {
  const CostSummary& summary = *study.summary;
  const std::pair<const char*, std::string> rows[] = {
      {"processor", absl::StrCat(summary.machine.cpu, ", ", summary.machine.simd_target)},
      {"compiler", absl::StrCat(summary.machine.compiler,
                                summary.machine.optimized ? "" : ", without optimization: these times say little")},
      {"ricochet", absl::StrCat(study.engine.version, ", engine ", study.engine.fingerprint)},
      {"date", date},
      {"time taken", absl::StrFormat("%.2g s", summary.elapsed_s)},
      {"exact answer",
       absl::StrCat(summary.reference_source, ".",
                    summary.reference_error.has_value()
                        ? absl::StrCat(" It is known to within ", ErrorText(*summary.reference_error), ".")
                        : "")}};
  std::string text = "<table class=\"words\">\n<tbody>\n";
  for (const auto& [name, value] : rows) {
    absl::StrAppend(&text, "<tr>", HtmlElement("td", name), HtmlElement("td", value), "</tr>\n");
  }
  return text + "</tbody>\n</table>\n";
}

std::string SceneText(const Scene& scene) {
  std::string text;
  google::protobuf::TextFormat::PrintToString(ToProto(scene), &text);
  return text;
}

constexpr char kTimeCaption[] =
    "Further left is more exact, further down is faster. The grey stairs are the Pareto front: no other method is as "
    "fast "
    "and as exact as the ones on it. Errors below 10⁻¹⁷, less than half an ulp of a double, stand at the left edge. A "
    "line "
    "joins the tolerances, or the digits, that one method was asked for.";
constexpr char kClaimCaption[] =
    "A method below the dashed diagonal errs by less than it claims. One above it would have made its caller believe "
    "too much, and "
    "would "
    "be ringed in red.";

}  // namespace

std::string SystemText(const Scene& scene) {
  const v1::Scene proto = ToProto(scene);
  const auto* choice = v1::Scene::descriptor()->FindOneofByName("system");
  const auto* field = proto.GetReflection()->GetOneofFieldDescriptor(proto, choice);
  return field == nullptr ? "scene" : absl::StrReplaceAll(field->name(), {{"_", " "}});
}

absl::StatusOr<std::string> CostPage(const Scene& scene, const CostChunk& study, const std::string& date) {
  const std::string title = absl::StrCat("What accuracy costs: one impact, ", SystemText(scene));
  RICOCHET_TRY(const std::string time,
               Figure(study, CostTimePlot, "time", "Time of one solve over its error", kTimeCaption));
  RICOCHET_TRY(const std::string claim,
               Figure(study, CostClaimPlot, "claim", "Error made over error claimed", kClaimCaption));
  return HtmlPage(
      title, absl::StrCat(HtmlElement("h1", title), "\n",
                          HtmlElement("p",
                                      absl::StrCat("Measured on ", date, " by ricochet ", study.engine.version, " on ",
                                                   MachineText(study.summary->machine), "."),
                                      " class=\"quiet\""),
                          "\n", Facts(study), "<h2>Time and error</h2>\n", time,
                          HtmlElement("h2", absl::StrCat("Errors claimed and made: ", study.summary->deceived, " of ",
                                                         AnswerCount(study), " claim too little")),
                          "\n", claim, "<h2>Methods</h2>\n", MethodsTable(study),
                          "<p class=\"quiet\">● on the Pareto front: no other method is as fast and as exact.</p>\n",
                          "<h2>The method that the plan picks</h2>\n", PicksTable(study), Notes(study),
                          "<h2>What the columns mean</h2>\n", kColumns, "<h2>The scene</h2>\n",
                          HtmlElement("pre", SceneText(scene)), "\n<h2>The run</h2>\n", RunTable(study, date)));
}

}  // namespace ricochet::cli
