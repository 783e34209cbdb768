#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/conformance/answers.h"
#include "client/cli/conformance/cases.h"
#include "client/cli/conformance/grade.h"
#include "client/cli/conformance/grade_report.h"
#include "client/cli/input/file_option.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/io/output.h"
#include "client/cli/program.h"
#include "client/cli/text/number_input.h"
#include "client/cli/text/table.h"
#include "core/base/decimal.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] =
    R"(Example: grade the answers of a simulator to all impacts in which slip reverses.
  $ ricochet conformance grade answers.csv --family reversal --tolerance 1e-6
docs/conformance.md says how to take the test; impacts.json has the cases, and grade.py grades without ricochet.
Exit codes: 0 all cases are right, 2 wrong input, 42 some are not.)";

struct ConformanceOptions {
  CommonOptions common;
  std::string name;  // The case to show, or the file with the answers.
  std::string tolerance = "1e-9";
  std::string law;
  std::vector<std::string> families, cases;
  std::string html;
};

// Returns the cases of the families and names that were given; all if none were.
absl::StatusOr<std::vector<const ConformanceCase*>> Asked(const ConformanceOptions& options) {
  std::vector<const ConformanceCase*> named;
  for (const std::string& name : options.cases) {
    RICOCHET_TRY(const ConformanceCase* one, FindConformanceCase(name, "--case"));
    named.push_back(one);
  }
  std::vector<std::string> unknown = options.families;
  std::vector<std::string> families;
  std::vector<const ConformanceCase*> asked;
  for (const ConformanceCase& one : AllConformanceCases().cases) {
    if (families.empty() || families.back() != one.family) families.push_back(one.family);
    std::erase(unknown, one.family);
    const bool in_family =
        std::find(options.families.begin(), options.families.end(), one.family) != options.families.end();
    const bool is_named = std::find(named.begin(), named.end(), &one) != named.end();
    if (in_family || is_named || (options.families.empty() && named.empty())) asked.push_back(&one);
  }
  if (unknown.empty()) return asked;
  return InputError("--family", unknown.front(), absl::StrCat("be one of ", absl::StrJoin(families, ", ")));
}

absl::Status RunList(const ConformanceOptions& options) {
  RICOCHET_TRY(const std::vector<const ConformanceCase*> asked, Asked(options));
  Table table(Table::Align::kLeft);
  std::string json = "[";
  for (const ConformanceCase* one : asked) {
    table.Add({one->name, one->family, one->shows});
    absl::StrAppend(&json, json.size() > 1 ? ",\n" : "\n", one->summary);
  }
  return WriteOutput(options.common, options.common.format == Format::kJson ? json + "\n]\n" : table.Render(0));
}

std::string MatrixText(const Eigen::MatrixXd& matrix) {
  Table table;
  for (const auto& row : matrix.rowwise()) {
    std::vector<std::string> cells;
    for (const double entry : row) cells.push_back(ShortestDecimal(entry));
    table.Add(std::move(cells));
  }
  return table.Render(4);
}

std::string CaseText(const ConformanceCase& one) {
  std::string text =
      absl::StrCat(one.name, " (", one.family, ")\n", Wrapped(one.shows, 2),
                   Wrapped(absl::StrCat("Source: ", one.source), 2), "\n  M\n", MatrixText(one.mass), "  J\n",
                   MatrixText(one.jacobian), "  friction\n", MatrixText(one.friction.transpose()),
                   "  coefficient of restitution\n", MatrixText(one.coefficient.transpose()), "\n");
  Table table;
  const bool moves = !one.frame.isZero(0.0);
  std::vector<std::string> head = {"", "before"};
  if (moves) head.emplace_back("of the surface");
  for (const RightAnswer& answer : one.answers) {
    head.push_back(absl::StrCat(answer.law, answer.also.empty() ? "" : ", ", absl::StrJoin(answer.also, ", ")));
  }
  table.Add(head);
  for (Eigen::Index i = 0; i < one.before.size(); ++i) {
    std::vector<std::string> row = {one.coordinates[static_cast<size_t>(i)], ShortestDecimal(one.before(i))};
    if (moves) row.push_back(ShortestDecimal(one.frame(i)));
    for (const RightAnswer& answer : one.answers) row.push_back(ShortestDecimal(answer.velocity_after(i)));
    table.Add(std::move(row));
  }
  return text + table.Render(2);
}

absl::Status RunShow(const ConformanceOptions& options) {
  if (options.name.empty()) return WriteOutput(options.common, ConformanceCasesJson());
  RICOCHET_TRY(const ConformanceCase* one, FindConformanceCase(options.name, "CASE"));
  return WriteOutput(options.common, options.common.format == Format::kJson ? one->json : CaseText(*one));
}

absl::StatusOr<Grade> MakeGrade(const ConformanceOptions& options) {
  GradeDemand demand = {.law = options.law};
  RICOCHET_TRY(const double tolerance, ParseNumber(options.tolerance, "--tolerance"));
  if (!(tolerance > 0.0 && tolerance < 1e100)) {
    return InputError("--tolerance", options.tolerance, "be above 0 and below 1e100");
  }
  demand.tolerance = tolerance;
  if (absl::Status status = CheckConformanceLaw(options.law, "--law"); !status.ok()) return status;
  RICOCHET_TRY(demand.asked, Asked(options));
  RICOCHET_TRY(const std::string text, ReadText(options.name));
  RICOCHET_TRY(SimulatorAnswers answers, ReadSimulatorAnswers(text, options.name));
  if (answers.simulator.empty()) answers.simulator = options.name;
  return GradeOf(answers, demand);
}

absl::Status RunGrade(const ConformanceOptions& options) {
  RICOCHET_TRY(const Grade grade, MakeGrade(options));
  const Format format = options.common.format;
  absl::Status written = WriteOutput(options.common, format == Format::kJson  ? GradeJson(grade)
                                                     : format == Format::kCsv ? GradeCsv(grade)
                                                                              : GradeText(grade));
  if (written.ok() && !options.html.empty()) written = WriteFile(options.html, GradePage(grade));
  if (!written.ok() || grade.AllRight()) return written;
  return absl::FailedPreconditionError(absl::StrCat("only ", GradeVerdict(grade)));
}

constexpr std::array kListFormats = {Format::kText, Format::kJson};

void AddFamilies(CLI::App& sub, ConformanceOptions& options) {
  AddRepeatable(sub, "--family", options.families, "The cases of this family alone; repeatable")->type_name("NAME");
}

void AddGradeOptions(CLI::App& sub, ConformanceOptions& options) {
  MarkFile(FileUse::kRead,
           sub.add_option("ANSWERS", options.name,
                          "Velocities after, as JSON or CSV (docs/conformance.md); - for standard input"))
      ->required();
  sub.add_option(
         "--tolerance", options.tolerance,
         absl::StrCat("Largest error of a velocity, m/s or rad/s, that counts as right [", options.tolerance, "]"))
      ->type_name("X");
  sub.add_option("--law", options.law,
                 "newton, poisson or energetic: the law to be obeyed [that of ANSWERS, else the one that most obey]")
      ->type_name("NAME");
  AddFamilies(sub, options);
  AddRepeatable(sub, "--case", options.cases, "This case alone; repeatable, and beside --family")->type_name("NAME");
  AddHtmlOption(sub, "the report", options.html);
}

}  // namespace

void AddConformance(CLI::App& app, Command& command) {
  CLI::App* conformance = app.add_subcommand("conformance", "A test that every simulator can take, and its grades");
  conformance->require_subcommand(1);
  conformance->footer(kExample);
  const auto [list, list_options] = AddCommand<ConformanceOptions>(
      *conformance, "list", "List the cases: what each shows, and whence it is", kExample, RunList, command);
  AddFamilies(*list, *list_options);
  AddOutputOptions(*list, list_options->common, kListFormats);
  const auto [show, show_options] = AddCommand<ConformanceOptions>(
      *conformance, "show", "Print one case with its right answers, or all as impacts.json", kExample, RunShow,
      command);
  show->add_option("CASE", show_options->name,
                   "A name of `ricochet conformance list`; without one, impacts.json is printed as it is");
  AddOutputOptions(*show, show_options->common, kListFormats);
  const auto [grade, grade_options] = AddCommand<ConformanceOptions>(
      *conformance, "grade", "Say which law the answers of a simulator obey, and which limits they break", kExample,
      RunGrade, command);
  AddGradeOptions(*grade, *grade_options);
  AddOutputOptions(*grade, grade_options->common, kMessageFormats);
}

}  // namespace ricochet::cli
