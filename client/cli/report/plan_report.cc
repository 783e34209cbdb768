#include "client/cli/report/plan_report.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/table.h"
#include "core/base/decimal.h"

namespace ricochet::cli {
namespace {

std::string DecisionText(Decision decision) {
  switch (decision) {
    case Decision::kAbsent:
      return "absent";
    case Decision::kSimulated:
      return "simulated";
    case Decision::kNegligible:
      return "negligible";
    case Decision::kRequired:
      return "required by the caller";
    case Decision::kExcluded:
      return "left out by the caller";
    case Decision::kUnspecified:
      break;
  }
  return "?";
}

std::string WhyText(const Plan& plan) {
  switch (plan.arithmetic.reason) {
    case ArithmeticReason::kWithinTolerance:
      return "which is within the tolerance";
    case ArithmeticReason::kZeroTolerance:
      return "because nothing is left of the tolerance";
    case ArithmeticReason::kSignNotProved:
      return "because plain arithmetic cannot prove what decides on this impact";
    case ArithmeticReason::kBoundTooLarge:
      return "because the bound of plain arithmetic exceeds what is left of the tolerance";
    case ArithmeticReason::kOnlyOne:
      return "the only one of this model";
    case ArithmeticReason::kUnspecified:
      break;
  }
  return "?";
}

std::string ArithmeticLine(const Plan& plan) {
  const PlannedArithmetic& arithmetic = plan.arithmetic;
  std::string text = absl::StrCat("  ", ArithmeticText(arithmetic.arithmetic), " arithmetic, ");
  if (arithmetic.rounding_error.has_value() && std::isinf(*arithmetic.rounding_error)) {
    absl::StrAppend(&text, "no bound on rounding, as the impact has no end that is known, ");
  } else if (arithmetic.rounding_error.has_value()) {
    absl::StrAppend(&text, "rounding error <= ", Rounded(*arithmetic.rounding_error), " (proved), ");
  }
  return absl::StrCat(text, WhyText(plan), "\n");
}

}  // namespace

std::string PlanText(const Plan& plan) {
  std::string text = absl::StrCat(
      "Plan\n  model ", ModelText(plan.model), ", tolerance ", Rounded(plan.relative_tolerance),
      "; the effects left out change velocities by at most ", Rounded(plan.neglected), "\n", ArithmeticLine(plan));
  const std::vector<PlannedEffect> effects = plan.effects.List();
  if (effects.empty()) return text;
  Table table;
  table.Add({"effect", "size"});
  for (const PlannedEffect& planned : effects) table.Add({EffectWord(planned.effect), Rounded(planned.size)});
  const std::vector<std::string> lines = absl::StrSplit(table.Render(2), '\n', absl::SkipEmpty());
  absl::StrAppend(&text, lines[0], "   decision: reason\n");
  for (size_t i = 0; i < effects.size(); ++i) {
    const PlannedEffect& planned = effects[i];
    absl::StrAppend(&text, lines[i + 1], "   ", DecisionText(planned.decision), ": ", planned.reason, "\n");
  }
  return text;
}

std::vector<std::string> LeftOut(const Plan& plan) {
  std::vector<std::string> names;
  for (const PlannedEffect& planned : plan.effects.List()) {
    const bool is_left_out = planned.decision == Decision::kNegligible || planned.decision == Decision::kExcluded;
    if (is_left_out && planned.size > 0.0) names.push_back(EffectWord(planned.effect));
  }
  return names;
}

std::string LeftOutText(const Plan& plan) {
  const std::vector<std::string> names = LeftOut(plan);
  if (names.empty()) return "";
  const std::string most = std::isinf(plan.neglected)
                               ? " by an amount that is not known"
                               : absl::StrCat(" by at most ", Rounded(plan.neglected), " of the approach speed");
  return absl::StrCat("  left out: ", absl::StrJoin(names, ", "), "; this changes velocities", most, "\n");
}

std::string PlanCsv(const Plan& plan) {
  std::string text = "effect,decision,size,reason\n";
  for (const PlannedEffect& planned : plan.effects.List()) {
    absl::StrAppend(&text, EffectWord(planned.effect), ",", DecisionText(planned.decision), ",",
                    ShortestDecimal(planned.size), ",", CsvQuoted(planned.reason), "\n");
  }
  return text;
}

}  // namespace ricochet::cli
