// PendulumColumns: every column of a sweep that a pendulum's closed form gives in SIMD lanes, in the order of its
// outputs.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_PENDULUM_COLUMNS_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_PENDULUM_COLUMNS_H_

#include <string>
#include <utility>
#include <vector>

#include "core/answer/model_outcomes.h"

namespace ricochet {

inline std::vector<std::string> PendulumColumns() {
  std::vector<std::string> paths;
  for (int i = 0; i < pendulum::kOutputCount; ++i) {
    std::string path = pendulum::kOutputPaths[static_cast<size_t>(i)];
    if (!path.empty()) paths.push_back(std::move(path));
  }
  return paths;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_PENDULUM_COLUMNS_H_
