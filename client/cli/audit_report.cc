#include "client/cli/audit_report.h"

#include <array>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/common.h"
#include "client/cli/table.h"
#include "core/numerics/decimal.h"

namespace ricochet::cli {
namespace {

struct LimitName {
  AuditLimit limit;
  const char* column;
  const char* title;
  const char* broken;  // The complaint in words, up to the excess.
  const char* unit;
};

constexpr LimitName kLimits[] = {
    {AuditLimit::kEnergy, "energy", "kinetic energy gained <= 0 [J]", "the kinetic energy grows by ", " J"},
    {AuditLimit::kSharp, "sharp", "energetic coefficient <= 1", "the energetic coefficient exceeds 1 by ", ""},
    {AuditLimit::kNormalImpulse, "normal_impulse", "normal impulse >= 0 [N s]", "the surface pulls with an impulse of ",
     " N s"},
    {AuditLimit::kPenetration, "penetration", "normal velocity after >= 0 [m/s]", "the bodies still approach at ",
     " m/s"},
    {AuditLimit::kCone, "cone", "tangential impulse <= mu normal [N s]",
     "the impulse lies outside the friction cone by ", " N s"},
};

std::string VerdictText(Verdict verdict) {
  switch (verdict) {
    case Verdict::kKept:
      return "kept";
    case Verdict::kWithinUncertainty:
      return "within uncertainty";
    case Verdict::kBroken:
      return "BROKEN";
    case Verdict::kUnspecified:
      break;
  }
  return "not checked";
}

std::string Heading(const AuditResponse& response) {
  const AuditReport& report = response.report;
  if (report.admissible) return "Admissible: every limit is kept.\n";
  std::string text = "Inadmissible:\n";
  for (const LimitName& name : kLimits) {
    const LimitCheck& check = report[name.limit];
    if (check.verdict != Verdict::kBroken) continue;
    absl::StrAppend(&text, "  ", name.broken, Rounded(check.excess), name.unit);
    if (name.limit == AuditLimit::kEnergy && response.contact_energy_j > 0.0) {
      absl::StrAppendFormat(&text, ", %+.4g %% of the contact's kinetic energy",
                            100.0 * check.excess / response.contact_energy_j);
    }
    text += "\n";
  }
  if (report.unexplained) {
    absl::StrAppend(&text, "  no impulse explains the observation; the nearest point of the path, shown here, is ",
                    Rounded(report.distance), " m/s away\n");
  }
  if (!report.compression_ended && report.regime != Regime::kSeparating) {
    absl::StrAppend(&text, "  the normal impulse is too small to end compression: Poisson's coefficient is negative\n");
  }
  return text;
}

std::string LimitsText(const AuditReport& report) {
  Table table;
  table.Add({"", "observed", "limit", "excess", "uncertainty", ""});
  for (const LimitName& name : kLimits) {
    const LimitCheck& check = report[name.limit];
    table.Add({name.title, Rounded(check.value), Rounded(check.limit), Rounded(check.excess), Rounded(check.allowance),
               VerdictText(check.verdict)});
  }
  return "\nLimits\n" + table.Render(2);
}

std::string CoefficientsText(const AuditReport& report) {
  Table table;
  table.Add({"Newton      (velocities, -v+/v-)", Rounded(report.newton)});
  table.Add({"Poisson     (normal impulses)", Rounded(report.poisson)});
  table.Add({"energetic   (normal works)", Rounded(report.energetic)});
  table.Add({"tangential  (Brach, f/tau)", Rounded(report.tangential)});
  return absl::StrCat("\nImplied coefficients (", RegimeText(report.regime), ")\n", table.Render(2));
}

std::string ImpulseText(const AuditReport& report, size_t directions) {
  Table table;
  table.Add({"", "observed", "uncertainty", "minus that of the path"});
  table.Add({"normal [N s]", Rounded(report.normal_impulse), Rounded(report.normal_impulse_uncertainty), ""});
  for (size_t i = 0; i < directions; ++i) {
    const std::string name = directions == 1 ? "tangential [N s]" : absl::StrCat("tangential ", i + 1, " [N s]");
    table.Add({name, Rounded(report.tangential_impulse[i]), Rounded(report.tangential_impulse_uncertainty[i]),
               Rounded(report.friction_mismatch[i])});
  }
  return "\nImpulse on the body\n" + table.Render(2);
}

std::string WorkText(const AuditReport& report) {
  Table table;
  table.Add({"[J]", "compression", "restitution", "total"});
  table.Add({"normal", Rounded(report.work_normal_compression), Rounded(report.work_normal_restitution),
             Rounded(report.work_normal_compression + report.work_normal_restitution)});
  table.Add({"tangential", Rounded(report.work_tangential_compression), Rounded(report.work_tangential_restitution),
             Rounded(report.work_tangential_compression + report.work_tangential_restitution)});
  table.Add({"change of kinetic energy, observed", "", "", Rounded(report.energy_change)});
  table.Add({"sum of the works minus that change", "", "", Rounded(report.residual)});
  return "\nWork on the body, along the scene's Coulomb path\n" + table.Render(2);
}

// The columns of a row: the name and the value of each.
using Row = std::vector<std::pair<std::string, std::string>>;

std::string Truth(bool value) { return value ? "true" : "false"; }

// The columns are named as the fields of ricochet.v1.AuditReport. An invalid row has no numbers.
Row RowOf(const AuditReport& report, size_t directions) {
  const bool is_valid = report.regime != Regime::kInvalid;
  const auto number = [is_valid](double value) { return is_valid ? ShortestDecimal(value) : "nan"; };
  Row row = {{"admissible", Truth(report.admissible)},
             {"regime", RegimeName(report.regime)},
             {"unexplained", Truth(report.unexplained)},
             {"distance_m_s", number(report.distance)},
             {"coefficients.newton", number(report.newton)},
             {"coefficients.poisson", number(report.poisson)},
             {"coefficients.energetic", number(report.energetic)},
             {"coefficients.tangential", number(report.tangential)},
             {"normal_impulse_n_s", number(report.normal_impulse)}};
  const auto add_directions = [&](const char* name, const std::array<double, 2>& values) {
    for (size_t i = 0; i < directions; ++i) row.emplace_back(absl::StrCat(name, "[", i, "]"), number(values[i]));
  };
  add_directions("tangential_impulse_n_s", report.tangential_impulse);
  add_directions("friction_mismatch_n_s", report.friction_mismatch);
  row.emplace_back("energy_change_j", number(report.energy_change));
  for (const LimitName& name : kLimits) {
    const LimitCheck& check = report[name.limit];
    row.emplace_back(absl::StrCat("limits.", name.column, ".broken"), Truth(check.verdict == Verdict::kBroken));
    row.emplace_back(absl::StrCat("limits.", name.column, ".excess"), number(check.excess));
    row.emplace_back(absl::StrCat("limits.", name.column, ".allowance"), number(check.allowance));
  }
  return row;
}

std::string FirstText(const Tally& tally) { return tally.count == 0 ? "" : absl::StrCat(tally.first_index); }

}  // namespace

std::string AuditText(const AuditResponse& response, size_t directions) {
  const AuditReport& report = response.report;
  return absl::StrCat(Heading(response), LimitsText(report), CoefficientsText(report), ImpulseText(report, directions),
                      WorkText(report));
}

std::string AuditCsvHeader(size_t directions) {
  std::vector<std::string> names;
  for (const auto& [name, value] : RowOf(AuditReport(), directions)) names.push_back(name);
  return absl::StrJoin(names, ",");
}

std::string AuditCsvRow(const AuditReport& report, size_t directions) {
  std::vector<std::string> cells;
  for (const auto& [name, value] : RowOf(report, directions)) cells.push_back(value);
  return absl::StrJoin(cells, ",");
}

std::string AuditSummaryText(const AuditSummary& summary) {
  Table table;
  table.Add({"", "rows", "first", "within uncertainty", "largest excess"});
  table.Add({"admissible", absl::StrCat(summary.admissible)});
  table.Add({"invalid", absl::StrCat(summary.invalid.count), FirstText(summary.invalid)});
  table.Add({"unexplained", absl::StrCat(summary.unexplained.count), FirstText(summary.unexplained)});
  for (const LimitName& name : kLimits) {
    const auto i = static_cast<size_t>(name.limit);
    table.Add({absl::StrCat("breaks ", name.title), absl::StrCat(summary.broken[i].count), FirstText(summary.broken[i]),
               absl::StrCat(summary.within_uncertainty[i].count), Rounded(summary.largest_excess[i])});
  }
  return absl::StrCat(summary.rows, summary.rows == 1 ? " row\n" : " rows\n", table.Render(2));
}

std::string AuditComplaint(const AuditReport& report, const std::string& invalid_reason) {
  if (report.regime == Regime::kInvalid) return absl::StrCat("invalid: ", invalid_reason);
  std::vector<std::string> complaints;
  for (const LimitName& name : kLimits) {
    const LimitCheck& check = report[name.limit];
    if (check.verdict == Verdict::kBroken) {
      complaints.push_back(absl::StrCat(name.broken, Rounded(check.excess), name.unit));
    }
  }
  if (report.unexplained) {
    complaints.push_back(
        absl::StrCat("no impulse explains it, the nearest is ", Rounded(report.distance), " m/s away"));
  }
  return absl::StrJoin(complaints, "; ");
}

}  // namespace ricochet::cli
