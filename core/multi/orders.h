// FindOrders: the outcomes of all sequences of single impacts.
//
// Any contact that approaches may be the next. Its impact is that of one contact with its block of W
// (core/multi/single_impact.h), and moves all others by W. A sequence ends when none approaches. The search goes depth
// first and follows each state once; contacts whose blocks of W are zero commute, and only one of their orders is
// followed. Two contacts that strike each other in turn without end are carried to their limit by a formula, where slip
// keeps its directions or there is no friction; other sequences without end are followed until the speeds of approach
// are rounding. docs/theory/several_contacts.md derives both and the errors.
// Cost: some 0.3 us an impact in a plane, some 100 us in space.

#ifndef RICOCHET_CORE_MULTI_ORDERS_H_
#define RICOCHET_CORE_MULTI_ORDERS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/functional/function_ref.h"
#include "core/multi/problem.h"

namespace ricochet::multi {

// The impacts that a search may take. Of a larger tree some sequences are followed to their ends; one that has not
// ended then ends with kBudgetUsedUp, as does one that comes back to a state it has been in and moves.
inline constexpr int64_t kOrdersBudget = 4096;
// The outcomes that an answer lists. Of more, those are listed that end after the fewest impacts.
inline constexpr size_t kMostOutcomes = 256;

struct DistinctOutcome {
  Attained attained;                     // By the first order found.
  std::vector<std::vector<int>> orders;  // The first kMostOrdersListed orders.
  std::vector<int> repeats_from;         // One for each order; Attained explains it.
  int64_t order_count = 0;
};

struct Orders {
  std::vector<DistinctOutcome> outcomes;  // They differ by more than their errors.
  bool complete = true;   // False if a sequence ran out of budget or jammed, or if sequences or outcomes are left out.
  bool sampled = false;   // True if not all sequences were followed.
  bool left_out = false;  // True if more than kMostOutcomes outcomes were found.
};

// Once `stopped` says true, the answer means nothing.
Orders FindOrders(const Problem& problem, absl::FunctionRef<bool()> stopped, int64_t budget = kOrdersBudget);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_ORDERS_H_
