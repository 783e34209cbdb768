// Explain: writes the reasons for the choice of a plan in words.

#ifndef RICOCHET_CORE_PLAN_EXPLAIN_H_
#define RICOCHET_CORE_PLAN_EXPLAIN_H_

#include "core/plan/choose.h"
#include "core/plan/demand.h"
#include "ricochet/plan.h"

namespace ricochet {

// Writes the plan of a choice that was made for `demand`. Each effect gets one sentence that gives the reason for its
// size, with numbers to three digits. The arithmetic is left as it is.
void Explain(const Choice& choice, const Demand& demand, Plan& plan);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_EXPLAIN_H_
