// Starts: the places from which a fit is sought.

#ifndef RICOCHET_CORE_FIT_STARTS_H_
#define RICOCHET_CORE_FIT_STARTS_H_

#include <cstddef>
#include <vector>

#include "core/fit/model.h"
#include "core/fit/problem.h"

namespace ricochet::fit {

// Returns the start of search `number`, from 0. The first is that of the problem. The others are spread evenly over the
// bounds or, if a bound is infinite, from a quarter to four times the first.
std::vector<double> StartOf(const Problem& problem, int number);

// Looks at `count` places around `centre`, denser near it, and returns the `most` that fit best, the best first; a slow
// model gets fewer of both. The places lie within the bounds or, if a bound is infinite, from a sixteenth to sixteen
// times the centre. Unknowns that are not free stay.
std::vector<std::vector<double>> BestPlaces(const std::vector<double>& centre, const std::vector<bool>& is_free,
                                            int count, size_t most, Model& model);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_STARTS_H_
