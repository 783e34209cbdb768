#include "ricochet/bounds.h"

#include <array>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "core/types/named_ranges.h"

namespace ricochet {
namespace {

struct NamedFriction {
  const char* name;
  std::optional<double> CriticalFriction::*friction;
};
constexpr std::array kFrictions = {NamedFriction{"stick", &CriticalFriction::stick},
                                   NamedFriction{"stop_compression", &CriticalFriction::stop_compression},
                                   NamedFriction{"stop", &CriticalFriction::stop},
                                   NamedFriction{"reversal", &CriticalFriction::reversal},
                                   NamedFriction{"jam", &CriticalFriction::jam}};

void AddRanges(const char* which, std::vector<std::string>& paths) {
  for (const auto& [name, range] : kNamedRanges) {
    paths.push_back(absl::StrCat(which, ".", name, ".lower"));
    paths.push_back(absl::StrCat(which, ".", name, ".upper"));
  }
}

}  // namespace

std::vector<std::string> BoundsNumbers(const System& system) {
  std::vector<std::string> paths;
  AddRanges("sharp", paths);
  if (TangentialDirections(system) == 2) return paths;
  AddRanges("energy_only", paths);
  for (const auto& [name, friction] : kFrictions) paths.push_back(absl::StrCat("critical.", name));
  return paths;
}

std::optional<double> BoundsNumber(const Bounds& bounds, const std::string& path) {
  const std::vector<absl::string_view> parts = absl::StrSplit(path, '.');
  if (parts.size() == 2 && parts[0] == "critical") {
    for (const auto& [name, friction] : kFrictions) {
      if (parts[1] == name) return bounds.critical.*friction;
    }
  }
  if (parts.size() != 3 || (parts[2] != "lower" && parts[2] != "upper")) return std::nullopt;
  std::optional<CoefficientBounds> ranges;
  if (parts[0] == "sharp") ranges = bounds.sharp;
  if (parts[0] == "energy_only") ranges = bounds.energy_only;
  if (!ranges.has_value()) return std::nullopt;
  for (const auto& [name, range] : kNamedRanges) {
    if (parts[1] == name) return parts[2] == "lower" ? ((*ranges).*range).lower : ((*ranges).*range).upper;
  }
  return std::nullopt;
}

}  // namespace ricochet
