// Solves a planar impact from event to event in plain doubles, as a textbook would.

#ifndef RICOCHET_TESTS_HARD_CASES_NAIVE_PLANAR_H_
#define RICOCHET_TESTS_HARD_CASES_NAIVE_PLANAR_H_

#include "core/models/planar/planar.h"

namespace ricochet::planar {

// The problem must not be separating. W is taken as it stands: a rank of one that rounding has spoilt is rank two.
Impact NaiveSolve(const Problem& problem);

}  // namespace ricochet::planar

#endif  // RICOCHET_TESTS_HARD_CASES_NAIVE_PLANAR_H_
