// A plan as text and as CSV, and the words for its parts.

#ifndef RICOCHET_CLIENT_CLI_PLAN_REPORT_H_
#define RICOCHET_CLIENT_CLI_PLAN_REPORT_H_

#include <string>

#include "ricochet/plan.h"

namespace ricochet::cli {

// "tangential-compliance", as options spell it.
std::string EffectWord(Effect effect);

// "finite duration", "COMPLIANT" as ricochet.v1.Model without its prefix.
std::string ModelText(Model model);
std::string ModelName(Model model);

// The model, what is left out, and a line an effect: its size, whether it is in, why.
std::string PlanText(const Plan& plan);

// One row an effect.
std::string PlanCsv(const Plan& plan);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLAN_REPORT_H_
