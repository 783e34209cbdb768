#include "core/models/compliant/oscillation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numerics/elementary.h"

namespace ricochet::compliant {

double Angle(double x, double y) {
  const double size = std::max(std::fabs(x), std::fabs(y));
  if (size == 0.0) return 0.0;
  const double c = x / size;
  const double s = y / size;
  const double low = std::min(std::fabs(c), std::fabs(s));
  // This guess is right to 4e-3. One step of Newton's method on sin(angle - guess) leaves a sixth of the cube of that.
  double angle = low * (std::numbers::pi / 4.0 + 0.273 * (1.0 - low));
  if (std::fabs(s) > std::fabs(c)) angle = std::numbers::pi / 2.0 - angle;
  if (c < 0.0) angle = std::numbers::pi - angle;
  if (s < 0.0) angle = -angle;
  const double radius = std::sqrt(c * c + s * s);
  return angle + (s * Cos(angle) - c * Sin(angle)) / radius;
}

Phase Frequencies::At(double t) const {
  Phase phase = {};
  for (size_t i = 0; i < 2; ++i) {
    const double w = (*this)[i];
    // Half the angle is used because nothing cancels then in the integral 2 sin^2(w t/2)/w^2.
    const double sine = Sin(0.5 * w * t);
    const double cosine = Cos(0.5 * w * t);
    const double half = w > 0.0 ? sine / w : 0.5 * t;
    phase.c[i] = 1.0 - 2.0 * sine * sine;
    phase.s[i] = 2.0 * half * cosine;
    phase.s_integral[i] = 2.0 * half * half;
  }
  return phase;
}

Value Signal::At(const Frequencies& w, double t) const {
  Value value;
  for (size_t i = 0; i < 2; ++i) {
    const double cosine = Cos(w[i] * t);
    const double sine = w[i] > 0.0 ? Sin(w[i] * t) / w[i] : t;
    value.f += a[i] * cosine + b[i] * sine;
    value.slope += b[i] * cosine - w[i] * w[i] * a[i] * sine;
  }
  return value;
}

}  // namespace ricochet::compliant
