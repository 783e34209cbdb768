#include "client/cli/label.h"

#include <array>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace ricochet::cli {
namespace {

struct Named {
  const char* path;
  const char* symbol;
  const char* name;
};

constexpr std::array kNamed = {
    Named{"pendulum.phi_rad", "φ", "angle φ = arctan(a/b)"},
    Named{"pendulum.a_m", "a", "horizontal distance a"},
    Named{"pendulum.b_m", "b", "depth b"},
    Named{"pendulum.inertia_kg_m2", "J", "moment of inertia J"},
    Named{"pendulum.omega_minus_rad_s", "ω-", "angular velocity before, ω-"},
    Named{"friction.kinetic_coefficient", "μ", "kinetic friction μ"},
    Named{"friction.static_coefficient", "μs", "static friction μs"},
    Named{"restitution.newton", "Newton", "Newton's coefficient (given)"},
    Named{"restitution.poisson", "Poisson", "Poisson's coefficient (given)"},
    Named{"restitution.energetic", "η", "energetic coefficient η (given)"},
    Named{"coefficients.newton", "Newton", "Newton's coefficient of restitution"},
    Named{"coefficients.poisson", "Poisson", "Poisson's coefficient of restitution"},
    Named{"coefficients.energetic", "energetic", "energetic coefficient of restitution"},
    Named{"coefficients.tangential", "tangential", "tangential coefficient (Brach)"},
    Named{"rates_after_rad_s[0]", "ω+", "angular velocity after, ω+"},
};

// Maps the suffix of a field's name to its unit. A longer suffix stands before the shorter ones that it ends in.
constexpr std::array kUnits = {
    std::pair{"_kg_m2", "kg m²"}, std::pair{"_rad_s", "rad/s"}, std::pair{"_n_s", "N s"}, std::pair{"_m_s", "m/s"},
    std::pair{"_rad", "rad"},     std::pair{"_m", "m"},         std::pair{"_j", "J"},
};

}  // namespace

Label LabelOf(const std::string& path) {
  std::string stem = path.substr(0, path.find('['));
  Label label;
  for (const auto& [suffix, unit] : kUnits) {
    if (!absl::EndsWith(stem, suffix)) continue;
    stem.resize(stem.size() - std::string(suffix).size());
    label.unit = unit;
    break;
  }
  label.name = absl::StrReplaceAll(stem, {{".", " "}, {"_", " "}});
  label.symbol = label.name;
  for (const Named& named : kNamed) {
    if (path != named.path) continue;
    label.symbol = named.symbol;
    label.name = named.name;
  }
  return label;
}

std::string WithUnit(const Label& label) {
  return label.unit.empty() ? label.name : absl::StrCat(label.name, " [", label.unit, "]");
}

}  // namespace ricochet::cli
