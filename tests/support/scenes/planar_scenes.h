// Random planar impacts: of everyday size, near rank one, close to every threshold of the path, and over all doubles.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_PLANAR_SCENES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_PLANAR_SCENES_H_

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"

namespace ricochet::planar {

class SceneSource {
 public:
  explicit SceneSource(uint64_t seed) : random_(seed) {}

  // A problem of any of the kinds below that have everyday exponents.
  Problem Any() {
    switch (Below(10)) {
      case 0:
        return NearRankOne();
      case 1:
        return RankOne();
      case 2:
        return NearStick();
      case 3:
        return NearJam();
      case 4:
        return NearStopAtRest();
      case 5:
        return NearStopAtEnd();
      case 6:
        return SmallIntegers();
      case 7:
        return NoSlip();
      default:
        return Everyday();
    }
  }

  Problem Everyday() {
    const double t = Uniform(0.1, 3.0);
    const double n = Uniform(0.1, 3.0);
    Problem problem = {.w = {t * t, t * n * Uniform(-1.0, 1.0), n * n},
                       .u0 = Uniform(-3.0, 3.0),
                       .v0 = -Uniform(0.1, 3.0),
                       .mu = Uniform(0.0, 1.5)};
    if (Below(4) == 0) problem.mu *= 10.0;
    SetRest(problem);
    return problem;
  }

  // det W lies between 1e-3 and some 8 eps of Wtt Wnn, or below.
  Problem NearRankOne() {
    Problem problem = Everyday();
    const double cosine = std::sqrt(1.0 - std::exp2(-Uniform(10.0, 54.0)));
    problem.w.tn = Sign() * cosine * std::sqrt(problem.w.tt * problem.w.nn);
    if (Below(2) == 0) problem.u0 = problem.v0 * problem.w.tn / problem.w.nn * (1.0 + Uniform(-0.1, 0.1));
    return Admitted(problem);
  }

  // The W of a pendulum, rounded.
  Problem RankOne() {
    const double inertia = Uniform(0.1, 10.0);
    const double a = Uniform(0.1, 10.0);
    const double b = Uniform(-10.0, 10.0);
    Problem problem = Everyday();
    problem.w.tt = b * b / inertia;
    problem.w.tn = a * b / inertia;
    problem.w.nn = a * a / inertia;
    return Admitted(problem);
  }

  // The W of a pendulum, or one of a slider, that strikes a surface in motion: (u0, v0) is any velocity, now and then
  // near the range of W, or with slip that stops near an end of a phase.
  Problem OffRange() {
    Problem problem = RankOne();
    const double follows = problem.v0 * problem.w.tn / problem.w.nn;
    problem.u0 = Uniform(-3.0, 3.0);
    if (Below(4) == 0) problem.mu = problem.w.nn / std::fabs(problem.w.tn) * Uniform(0.5, 1.5);
    switch (Below(8)) {
      case 0:
        problem.u0 = 0.0;
        break;
      case 1:
        problem.u0 = follows * (1.0 + Sign() * std::exp2(-Uniform(1.0, 54.0)));
        break;
      case 2:
        problem.w.tt = problem.w.tn = 0.0;
        break;
      case 3:
        problem.u0 = follows * (1.0 + problem.coefficient * NearlyOne());
        break;
      case 4:
        problem.w = {4.0, Sign() * 2.0, 1.0};
        problem.u0 = Integer(-4, 4);
        problem.v0 = -Integer(1, 4);
        problem.mu = Integer(0, 4) / 4.0;
        problem.coefficient = Integer(0, 4) / 4.0;
        break;
      default:
        break;
    }
    problem.mu_static = problem.mu * (Below(3) == 0 ? Uniform(1.0, 2.0) : 1.0);
    return problem;
  }

  // mu Wtt lies within a few ulp of |Wtn|.
  Problem NearStick() {
    Problem problem = Below(3) == 0 ? NearRankOne() : Everyday();
    if (problem.w.tn == 0.0) return problem;
    problem.mu = Steps(std::fabs(problem.w.tn) / problem.w.tt, Near(3));
    problem.mu_static = Below(2) == 0 ? problem.mu : Steps(problem.mu, static_cast<int64_t>(Below(3)));
    return Admitted(problem);
  }

  // mu |Wtn| lies near Wnn, so that v falls at first, or nearly does.
  Problem NearJam() {
    Problem problem = Everyday();
    if (problem.w.tn == 0.0) return problem;
    problem.mu = problem.w.nn / std::fabs(problem.w.tn) * (1.0 + Uniform(-1.0, 1.0) * std::exp2(-Uniform(0.0, 54.0)));
    problem.mu_static = problem.mu;
    problem.u0 = std::copysign(problem.u0, problem.w.tn);
    return problem;
  }

  // Slip stops within a few ulp of the end of compression.
  Problem NearStopAtRest() { return NearStop(Everyday(), 0.0); }

  // Slip stops near the end of restitution; on one piece the three laws agree.
  Problem NearStopAtEnd() {
    const Problem problem = Everyday();
    return NearStop(problem, problem.coefficient);
  }

  // The thresholds at which an output changes its sign, or the impact its regime.
  enum class SignChange {
    kStick,            // mu Wtt - |Wtn|
    kJam,              // Wnn - mu |Wtn|
    kStopAtRest,       // Slip stops where compression ends.
    kStopAtEnd,        // Slip stops where restitution ends.
    kDeterminant,      // det W
    kFrictionImpulse,  // f1
    kDeformation,      // eta - 1
    kEnergy,           // E+ - E-
  };
  static constexpr int kSignChanges = 8;

  // A problem at `factor` times the input nearest to the sign change.
  Problem NearSignChange(SignChange change, double factor) {
    while (true) {
      Problem problem = Everyday();
      if (Approach(change, factor, problem)) return Admitted(problem);
    }
  }

  // 1 +- a power of two whose exponent is uniform in [-52, -20].
  double NearlyOne() { return 1.0 + Sign() * std::exp2(-Uniform(20.0, 52.0)); }

  // The numbers have a few bits only, so that events coincide exactly.
  Problem SmallIntegers() {
    Problem problem = {.w = {Integer(1, 6), Integer(-6, 6), Integer(1, 6)},
                       .u0 = Integer(-4, 4),
                       .v0 = -Integer(1, 4),
                       .mu = Integer(0, 8) / 4.0};
    problem.mu_static = problem.mu + (Below(3) == 0 ? Integer(0, 4) / 4.0 : 0.0);
    problem.law = static_cast<RestitutionLaw>(Below(3));
    problem.coefficient = Integer(0, 4) / 4.0;
    return Admitted(problem);
  }

  Problem NoSlip() {
    Problem problem = Below(4) == 0 ? NearStick() : Everyday();
    problem.u0 = 0.0;
    return Admitted(problem);
  }

  // Every exponent is as likely as any other.
  Problem OverAllDoubles() {
    Problem problem = {.u0 = Sign() * Bits(), .v0 = -Positive(), .mu = Bits()};
    problem.mu_static = Below(4) == 0 ? std::max(problem.mu, Bits()) : problem.mu;
    const double t = Uniform(0.5, 1.0);
    const double n = Uniform(0.5, 1.0);
    const int t_exponent = static_cast<int>(Below(1000)) - 500;
    const int n_exponent = static_cast<int>(Below(1000)) - 500;
    problem.w.tt = std::ldexp(t * t, 2 * t_exponent);
    problem.w.nn = std::ldexp(n * n, 2 * n_exponent);
    problem.w.tn = Sign() * std::ldexp(t * n * (Below(4) == 0 ? 1.0 : Uniform(0.0, 1.0)), t_exponent + n_exponent);
    // Half of the time friction is chosen so that it matters.
    if (Below(2) == 0) problem.mu = std::ldexp(Uniform(0.1, 3.0), n_exponent - t_exponent);
    problem.mu_static = std::max(problem.mu, problem.mu_static);
    SetCoefficient(problem);
    problem = Admitted(problem);
    const bool is_rounded_well = std::isnormal(problem.u0) || !IsRankOne(problem) || problem.w.tn == 0.0;
    return std::isfinite(problem.u0) && is_rounded_well ? problem : OverAllDoubles();
  }

  // The coefficient is one that every law allows, now and then an end of its range.
  double UnitCoefficient() {
    const uint64_t kind = Below(8);
    return kind == 0 ? 0.0 : kind == 1 ? 1.0 : Uniform(0.0, 1.0);
  }

  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  uint64_t Below(uint64_t bound) { return random_() % bound; }
  double Sign() { return Below(2) == 0 ? 1.0 : -1.0; }

  // A W within 4 eps of rank one; (u0, v0) then lies in its range.
  static bool IsRankOne(const Problem& problem) {
    int t = 0;
    int n = 0;
    int c = 0;
    const double tt = std::frexp(problem.w.tt, &t);
    const double nn = std::frexp(problem.w.nn, &n);
    const double tn = std::frexp(problem.w.tn, &c);
    if (problem.w.tn == 0.0 || t + n - 2 * c > 60) return problem.w.tt == 0.0;
    // tt nn - tn^2 as a difference of products with one rounding each.
    const double square = std::ldexp(tt, t + n - 2 * c) * nn;
    const double low = std::fma(std::ldexp(tt, t + n - 2 * c), nn, -square);
    const double other = tn * tn;
    const double det = (square - other) + (low - std::fma(tn, tn, -other));
    return det <= 0x1p-50 * square;
  }

 private:
  static double Steps(double x, int64_t steps) {
    return std::fabs(std::bit_cast<double>(std::bit_cast<int64_t>(x) + (x == 0.0 ? std::abs(steps) : steps)));
  }
  // Slip stops within a few ulp of 1 + `k` times the normal impulse of compression.
  Problem NearStop(Problem problem, double k) {
    const double sign = Sign();
    const double u_slope = sign * problem.w.tn - problem.mu * problem.w.tt;
    const double v_slope = problem.w.nn - sign * problem.mu * problem.w.tn;
    if (u_slope < 0.0 && v_slope > 0.0) {
      problem.u0 = sign * Steps(problem.v0 * u_slope / v_slope * (1.0 + k), Near(3));
    }
    return problem;
  }

  // Moves one input of `problem` to `factor` times its critical value; false if it has none.
  bool Approach(SignChange change, double factor, Problem& problem) {
    if (problem.w.tn == 0.0) return false;
    switch (change) {
      case SignChange::kStick:
        problem.mu = problem.mu_static = std::fabs(problem.w.tn) / problem.w.tt * factor;
        return true;
      case SignChange::kJam:
        problem.mu = problem.mu_static = problem.w.nn / std::fabs(problem.w.tn) * factor;
        problem.u0 = std::copysign(problem.u0, problem.w.tn);
        return true;
      case SignChange::kStopAtRest:
        return ApproachStop(0.0, factor, problem);
      case SignChange::kStopAtEnd:
        return ApproachStop(problem.coefficient, factor, problem);
      case SignChange::kDeterminant:
        problem.w.tn = Sign() * std::sqrt(1.0 - std::fabs(1.0 - factor)) * std::sqrt(problem.w.tt * problem.w.nn);
        return true;
      case SignChange::kFrictionImpulse:
        return ApproachNoFrictionImpulse(factor, problem);
      case SignChange::kDeformation:
        problem.law = Below(2) == 0 ? RestitutionLaw::kNewton : RestitutionLaw::kPoisson;
        problem.coefficient = Elastic(problem) * factor;
        return problem.coefficient > 0.0;
      case SignChange::kEnergy:
        return ApproachNoEnergyLost(factor, problem);
    }
    return false;
  }

  bool ApproachStop(double k, double factor, Problem& problem) {
    const double sign = Sign();
    const double u_slope = sign * problem.w.tn - problem.mu * problem.w.tt;
    const double v_slope = problem.w.nn - sign * problem.mu * problem.w.tn;
    problem.u0 = sign * (problem.v0 * u_slope / v_slope * (1.0 + k)) * factor;
    return u_slope < 0.0 && v_slope > 0.0;
  }

  // Slip that stopped in compression has one slope of friction from there on.
  static bool ApproachNoFrictionImpulse(double factor, Problem& problem) {
    problem.law = RestitutionLaw::kPoisson;
    problem.coefficient = 1.0;
    const Impact impact = Solve(problem);
    if (impact.f_compression * (impact.f1 - impact.f_compression) >= 0.0) return false;
    problem.coefficient = impact.f_compression / (impact.f_compression - impact.f1) * factor;
    return true;
  }

  // The coefficient of the problem's law that returns all the normal work.
  static double Elastic(Problem problem) {
    const RestitutionLaw law = problem.law;
    problem.law = RestitutionLaw::kEnergetic;
    problem.coefficient = 1.0;
    const Impact impact = Solve(problem);
    return law == RestitutionLaw::kNewton ? impact.newton : impact.poisson;
  }

  bool ApproachNoEnergyLost(double factor, Problem& problem) {
    problem.law = Below(2) == 0 ? RestitutionLaw::kNewton : RestitutionLaw::kPoisson;
    const auto change = [&problem](double coefficient) {
      problem.coefficient = coefficient;
      return Solve(problem).energy_change;
    };
    double low = Elastic(problem);
    double high = 8.0 * low;
    if (!(change(low) < 0.0 && change(high) > 0.0)) return false;
    constexpr int kBits = 60;
    for (int i = 0; i < kBits; ++i) {
      const double middle = 0.5 * (low + high);
      (change(middle) < 0.0 ? low : high) = middle;
    }
    problem.coefficient = high * factor;
    return true;
  }
  int64_t Near(int64_t steps) { return static_cast<int64_t>(Below(static_cast<uint64_t>(2 * steps + 1))) - steps; }
  double Bits() { return std::bit_cast<double>(Below(uint64_t{0x7ff} << 52)); }
  double Positive() {
    const double x = Bits();
    return x == 0.0 ? 1.0 : x;
  }
  double Integer(int64_t low, int64_t high) {
    return static_cast<double>(low + static_cast<int64_t>(Below(static_cast<uint64_t>(high - low + 1))));
  }

  void SetCoefficient(Problem& problem) {
    problem.law = static_cast<RestitutionLaw>(Below(3));
    problem.coefficient = UnitCoefficient();
    if (problem.law != RestitutionLaw::kEnergetic && Below(8) == 0) problem.coefficient = Uniform(1.0, 3.0);
  }
  void SetRest(Problem& problem) {
    SetCoefficient(problem);
    problem.mu_static = Below(4) == 0 ? problem.mu * Uniform(1.0, 1.5) : problem.mu;
    if (Below(64) == 0) problem.mu = 0.0;
    if (Below(64) == 0) problem.w.tn = 0.0;
    if (Below(64) == 0) problem.u0 *= 0x1p-40;
  }

  // Gives a W that is not positive definite rank one, and moves velocities outside its range into it.
  static Problem Admitted(Problem problem) {
    if (!IsRankOne(problem)) return problem;
    if (problem.w.tn == 0.0) problem.w.tn = problem.w.tt = 0.0;
    problem.w.tt = problem.w.tn * (problem.w.tn / problem.w.nn);
    problem.u0 = problem.v0 * (problem.w.tn / problem.w.nn);
    return problem;
  }

  std::mt19937_64 random_;
};

}  // namespace ricochet::planar

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_PLANAR_SCENES_H_
