// Signal: a sum of two oscillations, as the velocities and forces of a compliant contact are while its particle sticks.
//
//   f(t) = sum over i of a_i cos(w_i t) + b_i sin(w_i t)/w_i,   w_0 >= w_1 >= 0, w_0 > 0
//
// For w_1 = 0 the slow part is a_1 + b_1 t.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_OSCILLATION_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_OSCILLATION_H_

#include <array>
#include <cstddef>
#include <limits>

namespace ricochet::compliant {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

// Angle errs by much less than this, in radians.
inline constexpr double kAngleError = 0x1p-24;

// Returns the angle in [-pi, pi] of the direction (x, y), 0 for (0, 0).
double Angle(double x, double y);

// The values of both oscillations at one time: cos(w t), its integral sin(w t)/w from 0, and the integral of that.
struct Phase {
  std::array<double, 2> c, s, s_integral;
};

struct Frequencies {
  double fast = 1.0;  // w_0
  double slow = 0.0;  // w_1

  double operator[](size_t i) const { return i == 0 ? fast : slow; }
  Phase At(double t) const;
};

struct Value {
  double f = 0.0;
  double slope = 0.0;
};

struct Signal {
  std::array<double, 2> a = {};
  std::array<double, 2> b = {};

  Value At(const Frequencies& w, double t) const;
};

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_OSCILLATION_H_
