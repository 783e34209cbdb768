#include "client/cli/report/derivatives_report.h"

#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/table.h"
#include "proto/wire/outcome.h"

namespace ricochet::cli {
namespace {

// Returns what lies at the number, as it stands after "on a threshold: ".
const char* ThresholdText(Threshold threshold) {
  switch (threshold) {
    case Threshold::kApproach:
      return "the contact neither approaches nor separates";
    case Threshold::kSlipStart:
      return "there is no slip before the impact";
    case Threshold::kFrictionLimit:
      return "friction only just holds the contact where slip stops";
    case Threshold::kJamming:
      return "the contact only just locks or jams";
    case Threshold::kCompressionEnd:
      return "slip stops exactly where compression ends";
    case Threshold::kImpactEnd:
      return "slip stops exactly where the impact ends";
    case Threshold::kRank:
      return "W has a lower rank here than beside, or the velocity leaves its range";
    case Threshold::kSpeedTable:
      return "the approach speed is one that a table lists";
    case Threshold::kDomain:
      return "the number cannot be lower, or cannot be higher";
    case Threshold::kOther:
      return "the impact takes another course";
    case Threshold::kEndRecedes:
      return "the impact only just ends before its end recedes";
    case Threshold::kUnspecified:
      break;
  }
  return "both sides differ";
}

std::string IfSet(const std::optional<double>& value) { return value.has_value() ? Rounded(*value) : "none"; }

std::string ErrorText(const Derivative& d) {
  return d.error.has_value() ? absl::StrCat(" +- ", absl::SixDigits(*d.error)) : "";
}

// Returns a line that says where the course of the impact changes; nothing if no threshold was found.
std::string ReachText(const std::string& by, const char* moves, const std::optional<NearThreshold>& near) {
  if (!near.has_value()) return "";
  const bool is_end = near->threshold == Threshold::kDomain;
  return absl::StrCat("  If ", by, " ", moves, " by ", Rounded(near->distance), ": ",
                      is_end ? "it cannot go on" : ThresholdText(near->threshold), ".\n");
}

void AppendOnce(const std::string& note, std::string& notes) {
  if (notes.find(note) == std::string::npos) absl::StrAppend(&notes, note);
}

}  // namespace

std::string DerivativesText(const std::vector<Derivative>& derivatives) {
  Table table;
  table.Add({"of", "by", "derivative"});
  std::string notes;
  for (const Derivative& d : derivatives) {
    AppendOnce(absl::StrCat(ReachText(d.by, "falls", d.below), ReachText(d.by, "rises", d.above)), notes);
    if (d.kind == DerivativeKind::kTwoSided) {
      table.Add({d.of, d.by, absl::StrCat(Rounded(*d.value), ErrorText(d))});
      continue;
    }
    table.Add({d.of, d.by, absl::StrCat(IfSet(d.from_below), " below, ", IfSet(d.from_above), " above", ErrorText(d))});
    const bool has_no_end = d.kind == DerivativeKind::kNone && d.threshold == Threshold::kUnspecified;
    const std::string where =
        has_no_end ? " there is none." : absl::StrCat(" on a threshold: ", ThresholdText(d.threshold), ".");
    AppendOnce(absl::StrCat("  By ", d.by, where, d.reason.empty() ? "" : " ", d.reason, "\n"), notes);
  }
  return absl::StrCat("\nDerivatives\n", table.Render(2), notes);
}

std::string DerivativesCsv(const std::vector<Derivative>& derivatives) {
  std::vector<CsvRow> rows;
  for (const Derivative& d : derivatives) {
    CsvRow& row = rows.emplace_back();
    row.Words("of", d.of);
    row.Words("by", d.by);
    row.Words("kind", EnumName(d.kind));
    row.Number("value", d.value);
    row.Number("from_below", d.from_below);
    row.Number("from_above", d.from_above);
    row.Number("error", d.error);
    row.Words("threshold", d.kind == DerivativeKind::kTwoSided ? "" : EnumName(d.threshold));
    row.Quoted("reason", d.reason);
    for (const auto& [name, near] : {std::pair("below", d.below), std::pair("above", d.above)}) {
      row.Number(absl::StrCat("distance_", name), near.has_value() ? std::optional(near->distance) : std::nullopt);
      row.Words(absl::StrCat("threshold_", name), near.has_value() ? EnumName(near->threshold) : "");
    }
  }
  return CsvOf(rows);
}

}  // namespace ricochet::cli
