#include "core/sweep/column.h"

#include "core/models/pendulum_outcome.h"

namespace ricochet {

const std::vector<std::string>& PendulumColumns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> paths;
    for (int i = 0; i < pendulum::kOutputCount; ++i) {
      std::string path = pendulum::OutputPath(static_cast<pendulum::Output>(i));
      if (!path.empty()) paths.push_back(std::move(path));
    }
    return paths;
  }();
  return columns;
}

std::optional<pendulum::Output> PendulumColumn(const std::string& name) {
  for (int i = 0; i < pendulum::kOutputCount; ++i) {
    const auto output = static_cast<pendulum::Output>(i);
    const std::string path = pendulum::OutputPath(output);
    if (!path.empty() && path == name) return output;
  }
  return std::nullopt;
}

}  // namespace ricochet
