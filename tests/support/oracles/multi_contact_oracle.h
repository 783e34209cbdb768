// Oracle of several contacts in a plane, in arithmetic of 128 bits: every sequence of single impacts, and the limit of
// stiff springs, to test core/multi.
//
// Sequences are followed impact by impact by the naive formulas of a planar impact, without merging and without closing
// formulas. Springs are followed in small steps of fixed length; events are found by sampling and bisection, and modes
// by trying all that the signs allow. No code is shared with core/. W and the velocity must be exact: contacts whose
// rows are dependent must be so as doubles. Coefficients of restitution of springs are above 0.

#ifndef RICOCHET_TESTS_SUPPORT_ORACLES_MULTI_CONTACT_ORACLE_H_
#define RICOCHET_TESTS_SUPPORT_ORACLES_MULTI_CONTACT_ORACLE_H_

#include <optional>
#include <vector>

#include "core/multi/problem.h"

namespace ricochet::multi {

struct ExactOutcome {
  std::vector<int> order;
  std::vector<double> v, p;                                // Rounded from 128 bits.
  std::vector<double> compression, restitution, friction;  // Works of each contact.
};

// Returns all outcomes of orders, or nothing if they take more than `budget` impacts. A sequence ends where all speeds
// of approach are below 1e-25.
std::optional<std::vector<ExactOutcome>> OrdersExactly(const Problem& problem, int budget);

// The outcome of springs; nothing if they take more than `budget` events, or no mode fits.
std::optional<ExactOutcome> SpringsExactly(const Problem& problem, int budget);

}  // namespace ricochet::multi

#endif  // RICOCHET_TESTS_SUPPORT_ORACLES_MULTI_CONTACT_ORACLE_H_
