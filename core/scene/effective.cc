#include "core/scene/effective.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "core/numerics/elementary.h"
#include "core/numerics/interval_elementary.h"

namespace ricochet {
namespace {

double Factor(std::monostate /*unset*/, double /*speed*/) { return 1.0; }

double Factor(const PowerLaw& law, double speed) { return 1.0 - law.alpha * Pow(speed, law.exponent); }

double Factor(const SpeedTable& table, double speed) {
  const auto& speeds = table.speed_m_s;
  const auto above = static_cast<size_t>(std::upper_bound(speeds.begin(), speeds.end(), speed) - speeds.begin());
  if (above == 0) return table.factor.front();
  if (above == speeds.size()) return table.factor.back();
  const double share = (speed - speeds[above - 1]) / (speeds[above] - speeds[above - 1]);
  return std::lerp(table.factor[above - 1], table.factor[above], share);
}

Interval Factor(std::monostate /*unset*/, const Interval& /*speed*/) { return 1.0; }

Interval Factor(const PowerLaw& law, const Interval& speed) {
  return Interval(1.0) - Interval(law.alpha) * Pow(speed, law.exponent);
}

// At one speed.
Interval FactorAtPoint(const SpeedTable& table, double speed) {
  const auto& speeds = table.speed_m_s;
  const auto above = static_cast<size_t>(std::upper_bound(speeds.begin(), speeds.end(), speed) - speeds.begin());
  if (above == 0) return table.factor.front();
  if (above == speeds.size()) return table.factor.back();
  const Interval from(speeds[above - 1]);
  const Interval share = (Interval(speed) - from) / (Interval(speeds[above]) - from);
  const Interval factor(table.factor[above - 1]);
  return factor + share * (Interval(table.factor[above]) - factor);
}

// Linear between its nodes: the extremes are at them or at the ends.
Interval Factor(const SpeedTable& table, const Interval& speed) {
  Interval factor = Hull(FactorAtPoint(table, speed.lower), FactorAtPoint(table, speed.upper));
  for (size_t i = 0; i < table.speed_m_s.size(); ++i) {
    if (Contains(speed, table.speed_m_s[i])) factor = Hull(factor, table.factor[i]);
  }
  return factor;
}

double Value(std::monostate /*unset*/) { return 0.0; }
template <typename Coefficient>
double Value(const Coefficient& coefficient) {
  return coefficient.value;
}

double NewtonOf(std::monostate /*unset*/) { return 0.0; }
template <typename Law>
double NewtonOf(const Law& law) {
  return law.e;
}

}  // namespace

double FactorAt(const std::optional<SpeedDependence>& dependence, double speed) {
  if (!dependence.has_value()) return 1.0;
  return std::visit([speed](const auto& form) { return Factor(form, speed); }, *dependence);
}

Interval FactorAt(const std::optional<SpeedDependence>& dependence, const Interval& speed) {
  if (!dependence.has_value()) return 1.0;
  return std::visit([&speed](const auto& form) { return Factor(form, speed); }, *dependence);
}

EffectiveCoefficients EffectiveAt(const Scene& scene, double speed) {
  const double friction = FactorAt(scene.friction.by_speed, speed);
  const double kinetic = scene.friction.kinetic_coefficient;
  const bool has_law = !std::holds_alternative<std::monostate>(scene.impact_law);
  const double restitution = has_law ? std::visit([](const auto& law) { return NewtonOf(law); }, scene.impact_law)
                                     : std::visit([](const auto& given) { return Value(given); }, scene.restitution);
  return {.kinetic_friction = kinetic * friction,
          .static_friction = scene.friction.static_coefficient.value_or(kinetic) * friction,
          .restitution = restitution * FactorAt(scene.restitution_by_speed, speed)};
}

}  // namespace ricochet
