// DemandFields: what a request says of accuracy and effects, unchecked.

#ifndef RICOCHET_DEMAND_H_
#define RICOCHET_DEMAND_H_

#include <optional>
#include <vector>

#include "ricochet/plan.h"

namespace ricochet {

struct DemandFields {
  std::optional<double> relative_tolerance;  // In [0, 0.1]; absent means 1e-12.
  std::vector<Effect> required;              // In any order, each at most once.
  std::vector<Effect> excluded;
  friend bool operator==(const DemandFields&, const DemandFields&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_DEMAND_H_
