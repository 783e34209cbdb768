// CloseEndlessPair: the limit of two contacts that strike each other in turn without end.
//
// While slip keeps its directions s, the normal velocities answer to normal impulses by A_ij = W_ni,nj - mu_j s_j
// W_ni,tj, and the speeds of approach of one hit after the other obey a linear recursion. With gamma =
// A12 A21/(A11 A22) a pair can go on without end exactly if A12, A21 < 0 and (1+e1)(1+e2) gamma >= (sqrt(e1) +
// sqrt(e2))^2 (strictly if e1 e2 = 0), and does so if the second speed of approach is large enough. The limit has both
// normal velocities 0. docs/theory/several_contacts.md has the proof.

#ifndef RICOCHET_CORE_MULTI_ENDLESS_PAIR_H_
#define RICOCHET_CORE_MULTI_ENDLESS_PAIR_H_

#include "core/multi/problem.h"

namespace ricochet::multi {

// `state` is that after an impact of contact i, which approached with the speed `approach`; contact j is the only one
// that approaches now. Carries it to the limit and returns true if it is proved that the two strike without end, that
// slip keeps its directions and that no other contact approaches until then.
bool CloseEndlessPair(const Problem& problem, int i, int j, double approach, Attained& state);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_ENDLESS_PAIR_H_
