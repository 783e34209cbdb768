// Judge: what a best fit says about the physics and the data: residuals, chi-squared, outliers, limits that rows break,
// thresholds, starts that disagree, and all of it in sentences.

#ifndef RICOCHET_CORE_FIT_JUDGEMENT_H_
#define RICOCHET_CORE_FIT_JUDGEMENT_H_

#include <vector>

#include "core/fit/information.h"
#include "core/fit/model.h"
#include "core/fit/problem.h"
#include "ricochet/fit.h"

namespace ricochet::fit {

// Completes a response that has its unknowns and starts. `best` are the unknowns of the best fit.
void Judge(const Problem& problem, const std::vector<double>& best, const Information& information, Model& model,
           FitResponse& response);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_JUDGEMENT_H_
