#include "core/contact/scene_contact.h"

#include <algorithm>
#include <cstddef>
#include <variant>
#include <vector>

#include "core/numerics/elementary.h"

namespace ricochet {
namespace {

double Factor(std::monostate /*unset*/, double /*speed*/) { return 1.0; }

// The power may overflow, and 0 times an infinity is NaN, so alpha = 0 is answered without it.
double Factor(const PowerLaw& law, double speed) {
  return law.alpha == 0.0 ? 1.0 : 1.0 - law.alpha * Pow(speed, law.exponent);
}

double Factor(const SpeedTable& table, double speed) {
  const auto& speeds = table.speed_m_s;
  const auto above = static_cast<size_t>(std::upper_bound(speeds.begin(), speeds.end(), speed) - speeds.begin());
  if (above == 0) return table.factor.front();
  if (above == speeds.size()) return table.factor.back();
  const double share = (speed - speeds[above - 1]) / (speeds[above] - speeds[above - 1]);
  return std::lerp(table.factor[above - 1], table.factor[above], share);
}

AffineInterval Factor(std::monostate /*unset*/, const AffineInterval& /*speed*/) { return 1.0; }

AffineInterval Factor(const PowerLaw& law, const AffineInterval& speed) {
  if (law.alpha == 0.0) return 1.0;
  return AffineInterval(1.0) - AffineInterval(law.alpha) * Pow(speed, law.exponent);
}

// A Piece is a straight line of a table, between two of its speeds or outside them all: factor + slope (speed - from).
struct Piece {
  Interval speeds;
  Interval from, factor;
  Interval slope;
};

std::vector<Piece> PiecesOf(const SpeedTable& table) {
  const auto& speeds = table.speed_m_s;
  std::vector<Piece> pieces = {{{0.0, speeds.front()}, 0.0, table.factor.front(), 0.0}};
  for (size_t i = 1; i < speeds.size(); ++i) {
    const Interval rise = Interval(table.factor[i]) - Interval(table.factor[i - 1]);
    const Interval slope = rise / (Interval(speeds[i]) - Interval(speeds[i - 1]));
    pieces.push_back({{speeds[i - 1], speeds[i]}, speeds[i - 1], table.factor[i - 1], slope});
  }
  pieces.push_back({{speeds.back(), rounding::kInfinity}, 0.0, table.factor.back(), 0.0});
  return pieces;
}

Interval Factor(const std::vector<Piece>& pieces, const Interval& speed) {
  Interval factor(rounding::kInfinity, -rounding::kInfinity);
  for (const Piece& piece : pieces) {
    const Interval part = Intersect(piece.speeds, speed);
    if (!IsEmpty(part)) factor = Hull(factor, piece.factor + (part - piece.from) * piece.slope);
  }
  return factor;
}

AffineInterval Factor(const SpeedTable& table, const AffineInterval& speed) {
  const std::vector<Piece> pieces = PiecesOf(table);
  Interval slope(rounding::kInfinity, -rounding::kInfinity);
  for (const Piece& piece : pieces) {
    if (!IsEmpty(Intersect(piece.speeds, speed.range()))) slope = Hull(slope, piece.slope);
  }
  return speed.Through(Factor(pieces, speed.centre()), Factor(pieces, speed.range()), slope);
}

// The value of a coefficient of restitution, or the coefficient e of an impact law.
std::optional<double> Value(std::monostate /*unset*/) { return std::nullopt; }
template <typename Stated>
std::optional<double> Value(const Stated& stated) {
  if constexpr (requires { stated.value; }) {
    return stated.value;
  } else {
    return stated.e;
  }
}

}  // namespace

double FactorAt(const std::optional<SpeedDependence>& dependence, double speed) {
  if (!dependence.has_value()) return 1.0;
  return std::visit([speed](const auto& form) { return Factor(form, speed); }, *dependence);
}

AffineInterval FactorAt(const std::optional<SpeedDependence>& dependence, const AffineInterval& speed) {
  if (!dependence.has_value()) return 1.0;
  return std::visit([&speed](const auto& form) { return Factor(form, speed); }, *dependence);
}

EffectiveCoefficients CoefficientsAtSpeed(const Scene& scene, double speed) {
  const double friction = FactorAt(scene.friction.by_speed, speed);
  const double kinetic = scene.friction.kinetic_coefficient;
  const bool has_law = !std::holds_alternative<std::monostate>(scene.impact_law);
  const auto value = [](const auto& given) { return Value(given); };
  std::optional<double> restitution =
      has_law ? std::visit(value, scene.impact_law) : std::visit(value, scene.restitution);
  if (restitution.has_value()) *restitution *= FactorAt(scene.restitution_by_speed, speed);
  return {.kinetic_friction = kinetic * friction,
          .static_friction = scene.friction.static_coefficient.value_or(kinetic) * friction,
          .restitution = restitution};
}

}  // namespace ricochet
