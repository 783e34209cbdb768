#include "client/cli/report/audit_report.h"

#include <array>
#include <limits>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/input/command_options.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/table.h"
#include "core/base/counted.h"

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
    absl::StrAppend(&text, "  ", BrokenLimitText(name.limit, Rounded(check.excess)));
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

std::string FirstText(const Tally& tally) { return tally.count == 0 ? "" : absl::StrCat(tally.first_index); }

}  // namespace

std::string BrokenLimitText(AuditLimit limit, const std::string& excess) {
  for (const LimitName& name : kLimits) {
    if (name.limit == limit) return absl::StrCat(name.broken, excess, name.unit);
  }
  return "";
}

std::string AuditText(const AuditResponse& response, size_t directions) {
  const AuditReport& report = response.report;
  return absl::StrCat(Heading(response), LimitsText(report), CoefficientsText(report), ImpulseText(report, directions),
                      WorkText(report));
}

CsvRow AuditCsvRow(const AuditReport& report, size_t directions) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  CsvRow row;
  const auto number = [&](const std::string& name, double value) {
    row.Number(name, report.regime == Regime::kInvalid ? kNone : value);
  };
  const auto numbers = [&](const char* name, const std::array<double, 2>& values) {
    for (size_t i = 0; i < directions; ++i) number(absl::StrCat(name, "[", i, "]"), values[i]);
  };
  const auto truth = [&](const std::string& name, bool value) {
    report.regime == Regime::kInvalid ? row.Number(name, kNone) : row.Truth(name, value);
  };
  truth("admissible", report.admissible);
  row.Words("regime", RegimeName(report.regime));
  truth("unexplained", report.unexplained);
  number("distance_m_s", report.distance);
  number("coefficients.newton", report.newton);
  number("coefficients.poisson", report.poisson);
  number("coefficients.energetic", report.energetic);
  number("coefficients.tangential", report.tangential);
  number("normal_impulse_n_s", report.normal_impulse);
  numbers("tangential_impulse_n_s", report.tangential_impulse);
  numbers("friction_mismatch_n_s", report.friction_mismatch);
  number("energy_change_j", report.energy_change);
  for (const LimitName& name : kLimits) {
    const LimitCheck& check = report[name.limit];
    truth(absl::StrCat("limits.", name.column, ".broken"), check.verdict == Verdict::kBroken);
    truth(absl::StrCat("limits.", name.column, ".within_uncertainty"), check.verdict == Verdict::kWithinUncertainty);
    number(absl::StrCat("limits.", name.column, ".excess"), check.excess);
    number(absl::StrCat("limits.", name.column, ".allowance"), check.allowance);
  }
  return row;
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
  return absl::StrCat(Counted(summary.rows, "row"), "\n", table.Render(2));
}

std::string AuditComplaint(const AuditReport& report, const std::string& invalid_reason) {
  if (report.regime == Regime::kInvalid) return absl::StrCat("invalid: ", invalid_reason);
  std::vector<std::string> complaints;
  for (const LimitName& name : kLimits) {
    const LimitCheck& check = report[name.limit];
    if (check.verdict == Verdict::kBroken) {
      complaints.push_back(BrokenLimitText(name.limit, Rounded(check.excess)));
    }
  }
  if (report.unexplained) {
    complaints.push_back(
        absl::StrCat("no impulse explains it, the nearest is ", Rounded(report.distance), " m/s away"));
  }
  return absl::StrJoin(complaints, "; ");
}

}  // namespace ricochet::cli
