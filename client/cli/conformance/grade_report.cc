#include "client/cli/conformance/grade_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/report/audit_report.h"
#include "client/cli/report/html_page.h"
#include "client/cli/text/table.h"

namespace ricochet::cli {
namespace {

using Rows = std::vector<std::vector<std::string>>;

bool Broken(const LimitCheck& check) { return check.verdict == Verdict::kBroken; }

constexpr std::pair<const char*, LimitCheck CaseGrade::*> kLimits[] = {{"energy", &CaseGrade::energy},
                                                                       {"approach", &CaseGrade::approach},
                                                                       {"cone", &CaseGrade::cone},
                                                                       {"symmetry", &CaseGrade::symmetry}};

std::string LawText(const std::string& law) {
  if (law == "newton") return "Newton's law";
  if (law == "poisson") return "Poisson's law";
  return law == "energetic" ? "the energetic law" : law;
}

// Returns a number with the digits that the rounding of the checks leaves.
std::string TwoDigits(double value) { return absl::StrFormat("%.2g", value); }

// Returns in words what is wrong with a case; empty if nothing is.
std::string Complaint(const CaseGrade& one) {
  if (!one.answered) return "no answer";
  std::vector<std::string> parts;
  if (!one.right) {
    parts.push_back(absl::StrCat(TwoDigits(one.error), " from ", LawText(one.law)));
    if (!one.obeyed.empty()) parts.push_back(absl::StrCat("obeys ", absl::StrJoin(one.obeyed, ", ")));
  }
  if (one.other_order) {
    parts.push_back(
        absl::StrCat("has the right numbers in another order than ", absl::StrJoin(one.asked->coordinates, ", ")));
  }
  if (Broken(one.energy)) parts.push_back(BrokenLimitText(AuditLimit::kEnergy, TwoDigits(one.energy.excess)));
  if (Broken(one.approach)) {
    parts.push_back(BrokenLimitText(AuditLimit::kPenetration, TwoDigits(one.approach.excess)));
  }
  if (Broken(one.cone)) {
    parts.push_back(absl::StrCat("no impulse within the friction cones explains it, the nearest is ",
                                 TwoDigits(one.cone.value), " away"));
  }
  if (Broken(one.symmetry)) {
    parts.push_back(absl::StrCat("is no mirror image of itself, by ", TwoDigits(one.symmetry.value)));
  }
  return absl::StrJoin(parts, "; ");
}

// Returns how many of these cases a law explains; "-" if they have no answer by it.
std::string CountOfLaw(const std::vector<const CaseGrade*>& cases, const std::string& law) {
  int known = 0;
  int64_t obeyed = 0;
  for (const CaseGrade* one : cases) {
    for (const RightAnswer& answer : one->asked->answers) known += answer.law == law ? 1 : 0;
    obeyed += std::count(one->obeyed.begin(), one->obeyed.end(), law);
  }
  return known == 0 ? "-" : absl::StrCat(obeyed);
}

std::vector<std::string> Row(const std::string& name, const std::vector<const CaseGrade*>& cases) {
  int answered = 0;
  int right = 0;
  double worst = 0.0;
  for (const CaseGrade* one : cases) {
    answered += one->answered ? 1 : 0;
    right += one->right ? 1 : 0;
    worst = std::max(worst, one->error);
  }
  std::vector<std::string> cells = {name, absl::StrCat(cases.size()), absl::StrCat(answered), absl::StrCat(right),
                                    answered == 0 ? "-" : absl::StrFormat("%.1e", worst)};
  for (const std::string& law : kConformanceLaws) cells.push_back(CountOfLaw(cases, law));
  for (const auto& [limit, check] : kLimits) {
    const auto broken = [check = check](const CaseGrade* one) { return Broken(one->*check); };
    cells.push_back(absl::StrCat(std::count_if(cases.begin(), cases.end(), broken)));
  }
  return cells;
}

Rows FamilyRows(const Grade& grade) {
  Rows rows = {{"family", "cases", "answered", "right", "worst error", "Newton", "Poisson", "energetic", "energy",
                "approach", "cone", "symmetry"}};
  std::vector<std::string> families;
  std::vector<const CaseGrade*> all;
  for (const CaseGrade& one : grade.cases) {
    all.push_back(&one);
    const bool known = std::find(families.begin(), families.end(), one.asked->family) != families.end();
    if (!known) families.push_back(one.asked->family);
  }
  for (const std::string& family : families) {
    std::vector<const CaseGrade*> members;
    std::copy_if(all.begin(), all.end(), std::back_inserter(members),
                 [&](const CaseGrade* one) { return one->asked->family == family; });
    rows.push_back(Row(family, members));
  }
  if (families.size() > 1) rows.push_back(Row("all", all));
  return rows;
}

Rows ComplaintRows(const Grade& grade) {
  Rows rows;
  for (const CaseGrade& one : grade.cases) {
    const std::string complaint = Complaint(one);
    if (!complaint.empty()) rows.push_back({one.asked->name, complaint});
  }
  return rows;
}

// Answers may each state a law of their own.
std::string LawsText(const Grade& grade) {
  const bool differ = std::any_of(grade.cases.begin(), grade.cases.end(), [&grade](const CaseGrade& one) {
    return one.answered && one.asked->HasOneContact() && one.law != grade.law;
  });
  const std::string general = LawText(grade.law);
  if (!grade.law_found) return differ ? "the laws that the answers state" : general;
  return absl::StrCat(differ ? "the laws that answers state, else by " : "", general,
                      ", which answers come nearest to");
}

std::string Heading(const Grade& grade) {
  return absl::StrCat(grade.simulator, ": ", GradeVerdict(grade), ", by ", LawsText(grade), ".\n");
}

std::string Origin() {
  const ConformanceCases& all = AllConformanceCases();
  return absl::StrCat("The cases are version ", all.version, ", ", all.fingerprint.substr(0, 16),
                      ". Errors are in m/s or rad/s. At several contacts any order will do, or springs.\n",
                      "The last four columns count the cases that break a limit.\n");
}

constexpr char kComplaints[] = "Not right, or beyond a limit";

}  // namespace

std::string GradeVerdict(const Grade& grade) {
  return absl::StrFormat("%d of %d cases are right to %.2g", grade.RightCases(), grade.cases.size(),
                         grade.demand.tolerance);
}

std::string GradeText(const Grade& grade) {
  Table table;
  for (const std::vector<std::string>& row : FamilyRows(grade)) table.Add(row);
  std::string text = absl::StrCat(Heading(grade), "\n", table.Render(2), "\n", Origin());
  const Rows complaints = ComplaintRows(grade);
  if (!complaints.empty()) absl::StrAppend(&text, "\n", kComplaints, ":\n");
  for (const std::vector<std::string>& row : complaints) absl::StrAppend(&text, "  ", row[0], ": ", row[1], "\n");
  return text;
}

std::string GradeCsv(const Grade& grade) {
  std::vector<CsvRow> rows;
  for (const CaseGrade& one : grade.cases) {
    CsvRow row;
    row.Words("case", one.asked->name);
    row.Words("family", one.asked->family);
    row.Truth("answered", one.answered);
    row.Truth("right", one.right);
    row.Words("law", one.law);
    row.Number("error", one.answered ? std::optional(one.error) : std::nullopt);
    row.Quoted("obeyed", absl::StrJoin(one.obeyed, ", "));
    for (const auto& [name, check] : kLimits) {
      row.Truth(absl::StrCat("breaks_", name), Broken(one.*check));
      row.Number(name, one.answered ? std::optional((one.*check).value) : std::nullopt);
    }
    row.Quoted("complaint", Complaint(one));
    rows.push_back(std::move(row));
  }
  return CsvOf(rows);
}

std::string GradeJson(const Grade& grade) {
  using Json = nlohmann::ordered_json;
  Json cases = Json::array();
  for (const CaseGrade& one : grade.cases) {
    Json json = {
        {"case", one.asked->name}, {"family", one.asked->family}, {"answered", one.answered}, {"right", one.right}};
    if (one.answered) {
      json["law"] = one.law;
      json["error"] = one.error;
      for (size_t i = 0; i < one.errors.size(); ++i) json["errors"][one.asked->answers[i].law] = one.errors[i];
      json["obeyed"] = one.obeyed;
      for (const auto& [name, check] : kLimits) {
        json[name] = {{"value", (one.*check).value}, {"broken", Broken(one.*check)}};
      }
    }
    json["complaint"] = Complaint(one);
    cases.push_back(json);
  }
  const ConformanceCases& all = AllConformanceCases();
  const Json whole = {{"simulator", grade.simulator},
                      {"version", all.version},
                      {"fingerprint", all.fingerprint},
                      {"tolerance", grade.demand.tolerance},
                      {"law", grade.law},
                      {"law_found", grade.law_found},
                      {"right_cases", grade.RightCases()},
                      {"all_right", grade.AllRight()},
                      {"cases", cases}};
  // The name of a file need not be UTF-8.
  return whole.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string GradePage(const Grade& grade) {
  const std::string title = absl::StrCat("Conformance of ", grade.simulator);
  Rows cases = {{"case", "right", "error", "obeys", kComplaints}};
  for (const CaseGrade& one : grade.cases) {
    cases.push_back({one.asked->name, one.right ? "yes" : "no", one.answered ? Rounded(one.error) : "",
                     absl::StrJoin(one.obeyed, ", "), Complaint(one)});
  }
  return HtmlPage(title, absl::StrCat(HtmlElement("h1", title), "\n", HtmlElement("p", Heading(grade)), "\n",
                                      HtmlTable(FamilyRows(grade), ""), HtmlElement("p", Origin(), " class=\"quiet\""),
                                      "\n", HtmlTable(cases, "words")));
}

}  // namespace ricochet::cli
