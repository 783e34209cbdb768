#include "core/plan/contact_time.h"

#include <cmath>
#include <variant>

#include "core/plan/perturbed_path.h"

namespace ricochet {
namespace {

// The fifth root of x > 0 to a few ulp, by Newton's method: its bits are the same everywhere.
double FifthRoot(double x) {
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  const int fifth = exponent / 5;
  const double scaled = std::ldexp(fraction, exponent - 5 * fifth);  // In (2^-5, 2^5).
  double root = 2.0;
  for (int i = 0; i < 24; ++i) {
    const double square = root * root;
    root -= (root - scaled / (square * square)) / 5.0;
  }
  return std::ldexp(root, fifth);
}

struct DepthTimer {
  const Indentation& of;

  double operator()(std::monostate) const { return 0.0; }
  double operator()(const LinearSpring& spring) const {
    constexpr double kQuarterTurn = 1.5707963267948966;
    const double depth = std::sqrt(2.0 * of.v0 * of.v0 / (3.0 * of.slope_high * spring.stiffness_n_m));
    return Time(depth, kQuarterTurn * std::sqrt(2.0 / (spring.stiffness_n_m * of.slope_low)));
  }
  double operator()(const HertzSpring& spring) const {
    constexpr double kIntegral = 1.4716375921623523;
    const double power = 2.5 * of.v0 * of.v0 / (3.0 * of.slope_high * spring.stiffness_n_m1_5);
    const double root = FifthRoot(power);
    const double depth = root * root;
    return Time(depth,
                kIntegral * std::sqrt(2.5 / (spring.stiffness_n_m1_5 * of.slope_low)) / std::sqrt(std::sqrt(depth)));
  }
  double operator()(const HuntCrossleySpring&) const { return kUnbounded; }

 private:
  double Time(double depth, double loading) const {
    const double pressed = 6.0 * of.acceleration * depth * of.slope_high;
    const bool holds = pressed <= of.slope_low * of.v0 * of.v0 * (1.0 - 0x1p-20) && of.energetic > 0.0;
    return holds ? WithRoundingMargin((1.0 + of.energetic) * loading) : kUnbounded;
  }
};

}  // namespace

double LongestContact(const NormalSpring& spring, const Indentation& of) { return std::visit(DepthTimer{of}, spring); }

}  // namespace ricochet
