// DemandFields: which accuracy and which effects a request asks for. Nothing in it has been checked yet.

#ifndef RICOCHET_DEMAND_H_
#define RICOCHET_DEMAND_H_

#include <optional>
#include <vector>

#include "ricochet/plan.h"

namespace ricochet {

struct DemandFields {
  std::optional<double> relative_tolerance = {};  // In [0, 0.1]; absent means 1e-12.
  std::vector<Effect> required = {};              // Effects to simulate, in any order, each at most once.
  std::vector<Effect> excluded = {};              // Effects to leave out whatever that changes, each at most once.
  friend bool operator==(const DemandFields&, const DemandFields&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_DEMAND_H_
