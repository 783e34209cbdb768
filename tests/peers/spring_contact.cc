#include "tests/peers/spring_contact.h"

#include <cmath>
#include <numbers>

namespace ricochet::peers {
namespace {

double RestitutionAt(double zeta) {
  const double s = std::sqrt(1 - zeta * zeta);
  return std::exp(-zeta / s * (std::numbers::pi - std::atan2(2 * zeta * s, s * s - zeta * zeta)));
}

}  // namespace

double DampingRatio(double restitution) {
  if (restitution >= 1) return 0;
  double low = 0;
  double high = 0.999;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (RestitutionAt(middle) > restitution ? low : high) = middle;
  }
  return low;
}

SpringContact SpringFor(const PendulumCase& c, double contact_time) {
  const double mass = kInertiaAboutPin / (c.a * c.a);
  const double frequency = std::numbers::pi / contact_time;
  return {.stiffness = mass * frequency * frequency,
          .damping = 2 * DampingRatio(c.restitution) * mass * frequency,
          .mass = mass};
}

}  // namespace ricochet::peers
