#include "ricochet/bounds.h"

#include <array>

#include "absl/strings/str_cat.h"

namespace ricochet {
namespace {

struct NamedRange {
  const char* name;
  Range CoefficientBounds::*range;
};
constexpr std::array kRanges = {
    NamedRange{"newton", &CoefficientBounds::newton}, NamedRange{"poisson", &CoefficientBounds::poisson},
    NamedRange{"energetic", &CoefficientBounds::energetic}, NamedRange{"tangential", &CoefficientBounds::tangential},
    NamedRange{"normal_total_n_s", &CoefficientBounds::normal_total_n_s}};

struct NamedFriction {
  const char* name;
  std::optional<double> CriticalFriction::*friction;
};
constexpr std::array kFrictions = {NamedFriction{"stick", &CriticalFriction::stick},
                                   NamedFriction{"stop_compression", &CriticalFriction::stop_compression},
                                   NamedFriction{"stop", &CriticalFriction::stop},
                                   NamedFriction{"reversal", &CriticalFriction::reversal},
                                   NamedFriction{"jam", &CriticalFriction::jam}};

// Calls `visit` with the path of each number and its value.
template <typename Visit>
void VisitRanges(const char* which, const std::optional<CoefficientBounds>& bounds, const Visit& visit) {
  for (const auto& [name, range] : kRanges) {
    std::optional<double> lower, upper;
    if (bounds.has_value()) lower = ((*bounds).*range).lower;
    if (bounds.has_value()) upper = ((*bounds).*range).upper;
    visit(absl::StrCat(which, ".", name, ".lower"), lower);
    visit(absl::StrCat(which, ".", name, ".upper"), upper);
  }
}

}  // namespace

std::vector<std::string> BoundsNumbers(const System& system) {
  std::vector<std::string> paths;
  const auto add = [&paths](std::string path, std::optional<double> /*value*/) { paths.push_back(std::move(path)); };
  VisitRanges("sharp", {}, add);
  if (TangentialDirections(system) == 2) return paths;
  VisitRanges("energy_only", {}, add);
  for (const auto& [name, friction] : kFrictions) paths.push_back(absl::StrCat("critical.", name));
  return paths;
}

std::optional<double> BoundsNumber(const Bounds& bounds, const std::string& path) {
  std::optional<double> found;
  const auto match = [&](const std::string& at, std::optional<double> value) {
    if (at == path) found = value;
  };
  VisitRanges("sharp", bounds.sharp, match);
  VisitRanges("energy_only", bounds.energy_only, match);
  for (const auto& [name, friction] : kFrictions) match(absl::StrCat("critical.", name), bounds.critical.*friction);
  return found;
}

}  // namespace ricochet
