// Minimize: the unknowns within their bounds that minimize the sum of the losses of all residuals, by the
// Levenberg-Marquardt search of Eigen on one thread. It finds a minimum near its start, not the least of several.

#ifndef RICOCHET_CORE_FIT_SEARCH_H_
#define RICOCHET_CORE_FIT_SEARCH_H_

#include <cstdint>
#include <vector>

#include "core/fit/model.h"

namespace ricochet::fit {

struct Minimum {
  std::vector<double> at;
  double objective = 0.0;  // That of ObjectivesAt.
  int32_t iterations = 0;
  bool converged = false;
};

// A fit whose objective is larger by at most this counts as equally good.
inline constexpr double kAsGood = 1e-6;

// The sum of the losses; infinite where a number has no prediction.
double ObjectiveAt(const std::vector<double>& at, Model& model);
// Returns it for each point, all of which are solved together.
std::vector<double> ObjectivesAt(const std::vector<std::vector<double>>& points, Model& model);

// The tolerance of a search whose minimum is wanted to all digits.
inline constexpr double kFineSearch = 1e-13;

// Searches from a start within the bounds, and holds the unknowns that are not free. The search ends once an iteration
// lowers the objective by less than the tolerance times the objective.
Minimum Minimize(const std::vector<double>& start, const std::vector<bool>& is_free, double tolerance, Model& model);

// Moves a fit towards a start as far as it stays as good: an angle by whole turns, and a number that has left the range
// of the starts, because the data do not tell it from others, by halves of the way.
void Approach(const std::vector<double>& start, Model& model, Minimum& found);

// The loss of a squared residual, its derivative by it, and half its second derivative by the residual itself.
struct Loss {
  double loss = 0.0;
  double weight = 1.0;
  double curvature = 1.0;
};
Loss LossOf(const Problem& problem, double squared_residual);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_SEARCH_H_
