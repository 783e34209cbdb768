// The report of a plan as text and as CSV, and the names of its parts.

#ifndef RICOCHET_CLIENT_CLI_PLAN_REPORT_H_
#define RICOCHET_CLIENT_CLI_PLAN_REPORT_H_

#include <string>

#include "ricochet/plan.h"

namespace ricochet::cli {

// Returns the name of an effect as the options spell it: "tangential-compliance".
std::string EffectWord(Effect effect);

// Return the name of a model in words, "finite duration", and in ricochet.v1.Model without its prefix, "COMPLIANT".
std::string ModelText(Model model);
std::string ModelName(Model model);

// Returns the name of an arithmetic in words: "compensated".
std::string ArithmeticText(Arithmetic arithmetic);

// Returns the model, the sum of all that is left out, the arithmetic, and one line for each effect: its size, the decision and the
// reason.
std::string PlanText(const Plan& plan);

// Returns a header and one row for each effect.
std::string PlanCsv(const Plan& plan);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLAN_REPORT_H_
