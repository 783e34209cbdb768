// Summary of a study of cost: the Pareto front, and the methods that the plan picks.

#ifndef RICOCHET_CORE_COST_COST_SUMMARY_H_
#define RICOCHET_CORE_COST_COST_SUMMARY_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "core/contact/scene_contact.h"
#include "ricochet/cost.h"
#include "ricochet/scene.h"

namespace ricochet {

// The indices of the rows that no other row beats in both time and error, from fast to exact. Rows without a time or an
// error are not on it. An error counts as no smaller than what its reference leaves open. Of two rows that are alike in
// both, the first is on it.
std::vector<int64_t> ParetoFront(const std::vector<CostRow>& rows);

// The methods that the plan picks at each of kCostTolerances, as ranges.
std::vector<CostPick> PicksFor(const Scene& scene, std::optional<SceneContact>& contact,
                               const std::vector<CostRow>& rows);

}  // namespace ricochet

#endif  // RICOCHET_CORE_COST_COST_SUMMARY_H_
