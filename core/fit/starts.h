// Starts: the places from which a fit is sought.

#ifndef RICOCHET_CORE_FIT_STARTS_H_
#define RICOCHET_CORE_FIT_STARTS_H_

#include <cstddef>
#include <vector>

#include "core/fit/model.h"
#include "core/fit/problem.h"

namespace ricochet::fit {

// The start of search `number`, from 0. The first is that of the problem. The others are spread evenly: over the
// bounds, or from a quarter to four times the first without two of them.
std::vector<double> StartOf(const Problem& problem, int number);

// Looks at `count` places around `centre`, the denser the nearer to it, and returns the `most` that fit best, the best
// first; of a slow model at fewer, and fewer of them. They lie within the bounds, or without two of them from a
// sixteenth to sixteen times the centre. Unknowns that are not free stay.
std::vector<std::vector<double>> BestPlaces(const std::vector<double>& centre, const std::vector<bool>& is_free,
                                            int count, size_t most, Model& model);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_STARTS_H_
