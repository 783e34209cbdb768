// SpringTail: how much impulse contacts on springs may still take.
//
//   sum P <= (a + sqrt(a^2 + 2 beta E))/beta   if beta > 0
//
// P are the normal impulses to come, a is the largest speed of approach and E the energy in the springs. beta is the
// least P.B P over all P >= 0 that add up to 1, B_ij = W_ni,nj - max(mu_j |W_ni,tj|, mu_i |W_nj,ti|).
// docs/theory/several_contacts.md proves it. Planar contacts only.

#ifndef RICOCHET_CORE_MULTI_SPRING_TAIL_H_
#define RICOCHET_CORE_MULTI_SPRING_TAIL_H_

#include <cmath>

#include "core/multi/problem.h"

namespace ricochet::multi {

// beta or a lower bound of it, its rounding included.
double BetaOf(const Problem& problem);

// The bound on the impulses to come, for beta > 0.
inline double ImpulseToCome(double beta, double approach, double energy) {
  return (approach + std::sqrt(approach * approach + 2.0 * beta * energy)) / beta;
}

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_SPRING_TAIL_H_
