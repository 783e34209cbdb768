// SceneSource: random pendulums over all doubles, of everyday size, and close to every threshold of the formulas.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_PENDULUM_SCENES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_PENDULUM_SCENES_H_

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>

#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"

namespace ricochet::pendulum {

class SceneSource {
 public:
  explicit SceneSource(uint64_t seed) : random_(seed) {}

  // A valid problem of any of the kinds below; one in 32 separates, one in 64 is smooth.
  Problem Any() {
    Problem problem = AnyImpact();
    if (Below(32) == 0) problem.omega_minus = -problem.omega_minus;
    if (Below(64) == 0) (Below(2) == 0 ? problem.mu : problem.b) = 0.0;
    return problem;
  }

  Problem AnyImpact() {
    switch (Below(9)) {
      case 0:
      case 1:
        return Everyday();
      case 2:
        return NearLocking();
      case 3:
        return NearLimit();
      case 4:
        return NearUnitPoisson();
      case 5:
        return NearlyVertical();
      case 6:
        return LargeAndSmall();
      default:
        return OverAllDoubles();
    }
  }

  // Exponents up to and a little beyond those that plain double-double arithmetic can take.
  Problem LargeAndSmall() {
    const auto any = [this] { return std::exp2(Uniform(-101.0, 101.0)); };
    Problem problem = {.inertia = any(), .a = any(), .b = Sign() * any(), .omega_minus = -any(), .mu = any()};
    problem.mu_static = problem.mu;
    SetCoefficient(problem, /*any_size=*/false);
    if (problem.law != RestitutionLaw::kEnergetic && Below(2) == 0)
      problem.coefficient = std::exp2(Uniform(-41.0, 41.0));
    if (Below(4) != 0) AimSlope(problem, std::exp2(-Uniform(0.0, 60.0)) * Uniform(0.5, 1.0));
    return problem;
  }

  // Every bit pattern of a finite double is as likely as any other.
  Problem OverAllDoubles() {
    Problem problem = {
        .inertia = Positive(), .a = Positive(), .b = Sign() * Bits(), .omega_minus = -Positive(), .mu = Bits()};
    problem.mu_static = Below(4) == 0 ? std::max(problem.mu, Bits()) : problem.mu;
    SetCoefficient(problem, /*any_size=*/true);
    // If b is random, half of the problems lock and most others have hardly any coupling; half of the time b is chosen
    // in between.
    if (Below(2) == 0) AimSlope(problem, std::exp2(-Uniform(0.0, 60.0)) * Uniform(0.5, 1.0));
    return problem;
  }

  Problem Everyday() {
    Problem problem = {.inertia = Uniform(0.1, 10.0),
                       .a = Uniform(0.1, 10.0),
                       .b = Sign() * Uniform(0.0, 10.0),
                       .omega_minus = -Uniform(0.1, 10.0),
                       .mu = Uniform(0.0, 1.0)};
    problem.mu_static = Below(4) == 0 ? problem.mu * Uniform(1.0, 1.5) : problem.mu;
    SetCoefficient(problem, /*any_size=*/false);
    return problem;
  }

  // mu |b| lies within a few ulp of a, on either side.
  Problem NearLocking() {
    Problem problem = Below(2) == 0 ? Everyday() : OverAllDoubles();
    AimSlope(problem, 1.0);
    problem.mu = Steps(problem.mu, Near(4));
    problem.mu_static = Below(4) == 0 ? Steps(problem.mu, static_cast<int64_t>(Below(4))) : problem.mu;
    return problem;
  }

  // The coefficient lies within a few ulp of its sharp bound or of 1.
  Problem NearLimit() {
    Problem problem = Below(2) == 0 ? Everyday() : NearlyVertical();
    AimSlope(problem, Uniform(0.0, 1.0));
    const double x = problem.mu * std::fabs(problem.b) / problem.a;
    const double root = std::sqrt((1.0 - x) / (1.0 + x));
    problem.law = AnyLaw();
    problem.coefficient = problem.law == RestitutionLaw::kNewton    ? root
                          : problem.law == RestitutionLaw::kPoisson ? 1.0 / root
                                                                    : 1.0;
    if (Below(3) == 0) problem.coefficient = 1.0;
    if (Below(6) == 0) problem.coefficient = root * root;        // Newton's coefficient that makes mu_hat vanish.
    if (Below(6) == 0) problem.coefficient = 1.0 / root / root;  // Poisson's coefficient that conserves energy.
    problem.coefficient = Steps(problem.coefficient, Near(3));
    Admit(problem);
    return problem;
  }

  // kappa lies near 1, where the friction impulse vanishes.
  Problem NearUnitPoisson() {
    Problem problem = Everyday();
    AimSlope(problem, Uniform(0.0, 1.0));
    const double x = problem.mu * std::fabs(problem.b) / problem.a;
    const double r = (1.0 - x) / (1.0 + x);
    problem.law = AnyLaw();
    problem.coefficient = problem.law == RestitutionLaw::kNewton    ? r
                          : problem.law == RestitutionLaw::kPoisson ? 1.0
                                                                    : std::sqrt(r);
    problem.coefficient = Steps(problem.coefficient, Near(3));
    Admit(problem);
    return problem;
  }

  // The thresholds at which an output changes its sign, or the impact its regime.
  enum class SignChange { kLocking, kFrictionImpulse, kDeformation, kEnergy };
  static constexpr int kSignChanges = 4;

  // A problem at `factor` times the coefficient of friction or restitution nearest to the sign change.
  Problem NearSignChange(SignChange change, double factor) {
    Problem problem = Everyday();
    AimSlope(problem, Uniform(0.0, 1.0));
    const double x = problem.mu * std::fabs(problem.b) / problem.a;
    const double r = (1.0 - x) / (1.0 + x);
    problem.law = AnyLaw();
    const auto coefficient = [&problem](double newton, double poisson, double energetic) {
      return problem.law == RestitutionLaw::kNewton    ? newton
             : problem.law == RestitutionLaw::kPoisson ? poisson
                                                       : energetic;
    };
    switch (change) {
      case SignChange::kLocking:
        problem.mu = problem.mu_static = problem.a / std::fabs(problem.b) * factor;
        break;
      case SignChange::kFrictionImpulse:
        problem.coefficient = coefficient(r, 1.0, std::sqrt(r)) * factor;
        break;
      case SignChange::kDeformation:
        problem.coefficient = coefficient(std::sqrt(r), std::sqrt(1.0 / r), 1.0) * factor;
        break;
      case SignChange::kEnergy:
        problem.coefficient = coefficient(1.0, 1.0 / r, 1.0) * factor;
        break;
    }
    Admit(problem);
    return problem;
  }

  // 1 +- a power of two whose exponent is uniform in [-52, -20].
  double NearlyOne() { return 1.0 + Sign() * std::exp2(-Uniform(20.0, 52.0)); }

  // x lies far below the last bit of 1.
  Problem NearlyVertical() {
    Problem problem = Everyday();
    AimSlope(problem, std::exp2(-Uniform(1.0, 900.0)));
    return problem;
  }

  // A number in [0, 1) with a uniform exponent, and now and then an end of the range.
  double UnitByExponent() {
    const uint64_t kind = Below(8);
    if (kind == 0) return 0.0;
    if (kind == 1) return std::nextafter(1.0, 0.0) - static_cast<double>(Below(4)) * 0x1p-53;
    return std::exp2(-Uniform(0.0, kind < 5 ? 4.0 : 60.0));
  }

  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  uint64_t Below(uint64_t bound) { return random_() % bound; }
  double Sign() { return Below(2) == 0 ? 1.0 : -1.0; }
  RestitutionLaw AnyLaw() { return static_cast<RestitutionLaw>(Below(3)); }

 private:
  static double Steps(double x, int64_t steps) {
    return std::fabs(std::bit_cast<double>(std::bit_cast<int64_t>(x) + (x == 0.0 ? std::abs(steps) : steps)));
  }
  int64_t Near(int64_t steps) { return static_cast<int64_t>(Below(static_cast<uint64_t>(2 * steps + 1))) - steps; }
  double Bits() { return std::bit_cast<double>(Below(uint64_t{0x7ff} << 52)); }
  double Positive() {
    const double x = Bits();
    return x == 0.0 ? 1.0 : x;
  }

  // A b for which mu |b|/a is near x, if a double allows it.
  void AimSlope(Problem& problem, double x) {
    int a_exponent = 0;
    int mu_exponent = 0;
    const double a = std::frexp(problem.a, &a_exponent);
    const double mu = std::frexp(problem.mu, &mu_exponent);
    if (mu == 0.0) return;
    const double b = std::ldexp(x * a / mu, a_exponent - mu_exponent);
    if (std::isfinite(b)) problem.b = std::copysign(b, problem.b);
  }

  void SetCoefficient(Problem& problem, bool any_size) {
    problem.law = AnyLaw();
    const uint64_t kind = Below(8);
    if (problem.law == RestitutionLaw::kEnergetic) {
      problem.coefficient = kind == 0 ? 1.0 : UnitByExponent();
    } else {
      problem.coefficient = kind == 0 && any_size ? Bits() : kind < 2 ? Uniform(0.0, 3.0) : UnitByExponent();
    }
  }
  // Enforces the one rule that depends on the law.
  static void Admit(Problem& problem) {
    if (problem.law == RestitutionLaw::kEnergetic) problem.coefficient = std::min(problem.coefficient, 1.0);
  }

  std::mt19937_64 random_;
};

// A problem as hexadecimal floats, to be pasted into a test.
inline std::string ToString(const Problem& problem) {
  std::ostringstream text;
  text << std::hexfloat << "J " << problem.inertia << " a " << problem.a << " b " << problem.b << " w "
       << problem.omega_minus << " mu " << problem.mu << " mu_s " << problem.mu_static << " law "
       << static_cast<int>(problem.law) << " c " << problem.coefficient;
  return text.str();
}

}  // namespace ricochet::pendulum

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_PENDULUM_SCENES_H_
