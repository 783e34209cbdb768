// This header includes every impact law.

#ifndef RICOCHET_CORE_MODELS_LAWS_IMPACT_LAWS_H_
#define RICOCHET_CORE_MODELS_LAWS_IMPACT_LAWS_H_

#include "core/models/laws/brach.h"
#include "core/models/laws/chatterjee_ruina.h"
#include "core/models/laws/impact_law.h"
#include "core/models/laws/kane_levinson.h"
#include "core/models/laws/whittaker.h"
#include "core/models/planar_problem.h"
#include "ricochet/scene.h"

namespace ricochet::laws {

// Solves an impact by the law that is set. It has no solution if none is.
ImpactLawResult SolveLaw(const ImpactLaw& law, const PlanarProblem& problem);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_IMPACT_LAWS_H_
