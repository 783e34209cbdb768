#include "client/cli/text/label.h"

#include <array>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/cli/text/field_table.h"

namespace ricochet::cli {
namespace {

// Fields with a letter of their own.
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
    Named{"pendulum.omega_minus_rad_s", "ω⁻", "angular velocity before, ω⁻"},
    Named{"friction.kinetic_coefficient", "μ", "kinetic friction μ"},
    Named{"friction.static_coefficient", "μs", "static friction μs"},
    Named{"restitution.newton", "Newton", "Newton's coefficient of the scene"},
    Named{"restitution.poisson", "Poisson", "Poisson's coefficient of the scene"},
    Named{"restitution.energetic", "η", "energetic coefficient η of the scene"},
    Named{"coefficients.newton", "Newton", "Newton's coefficient of restitution"},
    Named{"coefficients.poisson", "Poisson", "Poisson's coefficient of restitution"},
    Named{"coefficients.energetic", "energetic", "energetic coefficient of restitution"},
    Named{"coefficients.tangential", "tangential", "tangential coefficient (Brach)"},
};

constexpr char kRates[] = "rates_after_rad_s";

}  // namespace

Label LabelOf(const std::string& path) {
  Label label{.symbol = path, .name = path, .unit = ""};
  if (const FieldInfo* field = FindFieldInfo(path); field != nullptr) {
    label.unit = field->unit;
    label.name = label.symbol = absl::StrReplaceAll(WithoutUnit(path), {{"_", " "}, {".", " "}});
  }
  if (absl::StartsWith(path, kRates)) {
    label.symbol = absl::StrCat("ω+", path.substr(sizeof(kRates) - 1));
    label.name = absl::StrCat("angular velocity after, ", label.symbol);
  }
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
