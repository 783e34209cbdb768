#include "core/scene/validate.h"

#include <cmath>
#include <string>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/numerics/decimal.h"

namespace ricochet {
namespace {

class Checker {
 public:
  // Adds a violation unless `holds`; a value that is not finite breaks every rule.
  void Require(bool holds, const char* field, double value, const std::string& rule) {
    if (!std::isfinite(value)) {
      violations_.push_back(MakeViolation(field, value, "be finite"));
    } else if (!holds) {
      violations_.push_back(MakeViolation(field, value, rule));
    }
  }
  void Missing(const char* field, const char* rule) {
    violations_.push_back({field, absl::StrCat("is not set: must ", rule)});
  }

  std::vector<Violation> violations() && { return std::move(violations_); }

 private:
  std::vector<Violation> violations_;
};

void CheckSystem(std::monostate /*unset*/, Checker& check) {
  check.Missing("system", "be one of pendulum");
}

void CheckSystem(const Pendulum& pendulum, Checker& check) {
  check.Require(pendulum.inertia_kg_m2 > 0.0, "pendulum.inertia_kg_m2", pendulum.inertia_kg_m2,
                "be > 0");
  check.Require(pendulum.a_m > 0.0, "pendulum.a_m", pendulum.a_m, "be > 0");
  check.Require(true, "pendulum.b_m", pendulum.b_m, "be finite");
  check.Require(true, "pendulum.omega_minus_rad_s", pendulum.omega_minus_rad_s, "be finite");
}

void CheckFriction(const Friction& friction, Checker& check) {
  const double kinetic = friction.kinetic_coefficient;
  check.Require(kinetic >= 0.0, "friction.kinetic_coefficient", kinetic, "be >= 0");
  if (friction.static_coefficient.has_value()) {
    check.Require(*friction.static_coefficient >= kinetic || !(kinetic >= 0.0),
                  "friction.static_coefficient", *friction.static_coefficient,
                  absl::StrCat("be >= friction.kinetic_coefficient = ", ShortestDecimal(kinetic)));
  }
}

void CheckRestitution(std::monostate /*unset*/, Checker& check) {
  check.Missing("restitution.coefficient", "be one of newton, poisson, energetic");
}

void CheckRestitution(NewtonCoefficient newton, Checker& check) {
  check.Require(newton.value >= 0.0, "restitution.newton", newton.value, "be >= 0");
}

void CheckRestitution(PoissonCoefficient poisson, Checker& check) {
  check.Require(poisson.value >= 0.0, "restitution.poisson", poisson.value, "be >= 0");
}

void CheckRestitution(EnergeticCoefficient energetic, Checker& check) {
  check.Require(energetic.value >= 0.0 && energetic.value <= 1.0, "restitution.energetic",
                energetic.value, "be in [0, 1]");
}

}  // namespace

std::vector<Violation> Validate(const Scene& scene) {
  Checker check;
  std::visit([&](const auto& system) { CheckSystem(system, check); }, scene.system);
  CheckFriction(scene.friction, check);
  std::visit([&](const auto& coefficient) { CheckRestitution(coefficient, check); },
             scene.restitution);
  return std::move(check).violations();
}

}  // namespace ricochet
