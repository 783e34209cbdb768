#include "core/scene/validate.h"

#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/numerics/decimal.h"

namespace ricochet {
namespace {

// Lists what is wrong.
class Listing {
 public:
  // A value that is not finite breaks every rule. `rule` is a function, called only when it is broken.
  template <typename Rule>
  void Require(bool holds, const char* field, double value, const Rule& rule) {
    if (!std::isfinite(value)) {
      violations_.push_back(MakeViolation(field, value, "be finite"));
    } else if (!holds) {
      violations_.push_back(MakeViolation(field, value, rule()));
    }
  }
  void Missing(const char* field, const char* rule) {
    violations_.push_back({field, absl::StrCat("is not set: must ", rule)});
  }
  std::vector<Violation> violations() && { return std::move(violations_); }

 private:
  std::vector<Violation> violations_;
};

// Says only whether something is.
class Verdict {
 public:
  template <typename Rule>
  void Require(bool holds, const char* /*field*/, double value, const Rule& /*rule*/) {
    valid_ = valid_ && holds && std::isfinite(value);
  }
  void Missing(const char* /*field*/, const char* /*rule*/) { valid_ = false; }
  bool valid() const { return valid_; }

 private:
  bool valid_ = true;
};

const char* Positive() { return "be > 0"; }
const char* NotNegative() { return "be >= 0"; }
const char* Finite() { return "be finite"; }
const char* UnitInterval() { return "be in [0, 1]"; }

template <typename Check>
void CheckSystem(std::monostate /*unset*/, Check& check) {
  check.Missing("system", "be one of pendulum");
}

template <typename Check>
void CheckSystem(const Pendulum& pendulum, Check& check) {
  check.Require(pendulum.inertia_kg_m2 > 0.0, "pendulum.inertia_kg_m2", pendulum.inertia_kg_m2, Positive);
  check.Require(pendulum.a_m > 0.0, "pendulum.a_m", pendulum.a_m, Positive);
  check.Require(true, "pendulum.b_m", pendulum.b_m, Finite);
  check.Require(true, "pendulum.omega_minus_rad_s", pendulum.omega_minus_rad_s, Finite);
}

template <typename Check>
void CheckFriction(const Friction& friction, Check& check) {
  const double kinetic = friction.kinetic_coefficient;
  check.Require(kinetic >= 0.0, "friction.kinetic_coefficient", kinetic, NotNegative);
  if (!friction.static_coefficient.has_value()) return;
  // Against a kinetic coefficient that is itself wrong there is nothing to compare.
  const bool comparable = kinetic >= 0.0 && std::isfinite(kinetic);
  check.Require(*friction.static_coefficient >= (comparable ? kinetic : 0.0), "friction.static_coefficient",
                *friction.static_coefficient, [&] {
                  return comparable ? absl::StrCat("be >= friction.kinetic_coefficient = ", ShortestDecimal(kinetic))
                                    : std::string(NotNegative());
                });
}

template <typename Check>
void CheckRestitution(std::monostate /*unset*/, Check& check) {
  check.Missing("restitution.coefficient", "be one of newton, poisson, energetic");
}

template <typename Check>
void CheckRestitution(NewtonCoefficient newton, Check& check) {
  check.Require(newton.value >= 0.0, "restitution.newton", newton.value, NotNegative);
}

template <typename Check>
void CheckRestitution(PoissonCoefficient poisson, Check& check) {
  check.Require(poisson.value >= 0.0, "restitution.poisson", poisson.value, NotNegative);
}

template <typename Check>
void CheckRestitution(EnergeticCoefficient energetic, Check& check) {
  check.Require(energetic.value >= 0.0 && energetic.value <= 1.0, "restitution.energetic", energetic.value,
                UnitInterval);
}

template <typename Check>
void CheckScene(const Scene& scene, RestitutionIs restitution, Check& check) {
  std::visit([&](const auto& system) { CheckSystem(system, check); }, scene.system);
  CheckFriction(scene.friction, check);
  const bool unset = std::holds_alternative<std::monostate>(scene.restitution);
  if (unset && restitution == RestitutionIs::kOptional) return;
  std::visit([&](const auto& coefficient) { CheckRestitution(coefficient, check); }, scene.restitution);
}

}  // namespace

std::vector<Violation> Validate(const Scene& scene, RestitutionIs restitution) {
  Listing listing;
  CheckScene(scene, restitution, listing);
  return std::move(listing).violations();
}

bool IsValid(const Scene& scene) {
  Verdict verdict;
  CheckScene(scene, RestitutionIs::kRequired, verdict);
  return verdict.valid();
}

}  // namespace ricochet
