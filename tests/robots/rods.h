// The double pendulum of tests/data/robots/double_pendulum.xml as a linkage, and what becomes of it in closed form.

#ifndef RICOCHET_TESTS_ROBOTS_RODS_H_
#define RICOCHET_TESTS_ROBOTS_RODS_H_

#include <array>
#include <cmath>

#include "ricochet/scene.h"

namespace ricochet::robots {

// Angles of the first rod from the vertical and of the second from the first, and their rates.
struct Joints {
  std::array<double, 2> angle = {0.5, 0.4};
  std::array<double, 2> rate = {-1.0, -0.7};
};

inline Linkage Rods(const Joints& joints) {
  const double theta = joints.angle[0] + joints.angle[1];
  const double rate = joints.rate[0] + joints.rate[1];
  return {{{0.8, 2.0, 0.4, 0.11, joints.angle[0], joints.rate[0]}, {0.6, 1.5, 0.25, 0.05, theta, rate}}};
}

// The rates of the joints after an impact without friction, by Newton's coefficient e: the textbook mass matrix of a
// double pendulum in joint angles, and q'+ = q' - (1 + e) v M^-1 Jn/(Jn M^-1 Jn).
inline std::array<double, 2> RatesAfterFrictionlessImpact(const Joints& joints, double e) {
  constexpr double l1 = 0.8, l2 = 0.6, m1 = 2.0, m2 = 1.5, c1 = 0.4, c2 = 0.25, i1 = 0.11, i2 = 0.05;
  const double fold = std::cos(joints.angle[1]);
  const double m22 = i2 + m2 * c2 * c2;
  const double m12 = m22 + m2 * l1 * c2 * fold;
  const double m11 = i1 + m1 * c1 * c1 + m22 + m2 * l1 * l1 + 2.0 * m2 * l1 * c2 * fold;
  const double n2 = l2 * std::sin(joints.angle[0] + joints.angle[1]);
  const double n1 = l1 * std::sin(joints.angle[0]) + n2;
  const double determinant = m11 * m22 - m12 * m12;
  const double x1 = (m22 * n1 - m12 * n2) / determinant;
  const double x2 = (m11 * n2 - m12 * n1) / determinant;
  const double v = n1 * joints.rate[0] + n2 * joints.rate[1];
  const double impulse = -(1.0 + e) * v / (n1 * x1 + n2 * x2);
  return {joints.rate[0] + impulse * x1, joints.rate[1] + impulse * x2};
}

}  // namespace ricochet::robots

#endif  // RICOCHET_TESTS_ROBOTS_RODS_H_
