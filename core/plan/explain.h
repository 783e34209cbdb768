// Explain: a choice in words.

#ifndef RICOCHET_CORE_PLAN_EXPLAIN_H_
#define RICOCHET_CORE_PLAN_EXPLAIN_H_

#include "core/plan/choose.h"
#include "core/plan/demand.h"
#include "ricochet/plan.h"

namespace ricochet {

// The plan of a choice that was made for `demand`. It has every effect once, in order of their numbers, each with one
// sentence that gives the reason for its size, with numbers to three digits.
Plan Explain(const Choice& choice, const Demand& demand);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_EXPLAIN_H_
