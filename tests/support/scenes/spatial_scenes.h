// Random spatial impacts, of everyday size and close to everything that is singular for the spatial model.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_SPATIAL_SCENES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_SPATIAL_SCENES_H_

#include <cmath>
#include <cstdint>
#include <random>

#include "core/models/spatial/spatial.h"

namespace ricochet::spatial {

class SceneSource {
 public:
  explicit SceneSource(uint64_t seed) : random_(seed) {}

  Problem Typical() {
    Problem problem = WithMatrix(3, 0.1);
    problem.u0 = {Uniform(-1.0, 1.0), Uniform(-1.0, 1.0)};
    problem.v0 = -Uniform(0.1, 1.5);
    problem.mu = problem.mu_static = Uniform(0.05, 1.2);
    problem.law = static_cast<RestitutionLaw>(Below(3));
    problem.coefficient = Uniform(0.0, 1.0);
    return problem;
  }

  Problem NearSingular() {
    switch (Below(8)) {
      case 0:
        return SmallSlip();
      case 1:
      case 2:
        return NearMiss();
      case 3:
        return NearStick();
      case 4:
        return LargeFriction();
      case 5:
        return NearJam();
      case 6:
        return NearRankTwo();
      default:
        return SmallFriction();
    }
  }

  // The contact of a mechanism with fewer than three degrees of freedom: W is the sum of g g^T, the velocity that of g
  // times a rate.
  Problem WithDegreesOfFreedom(int count) {
    Problem problem = Typical();
    problem.w11 = problem.w12 = problem.w13 = problem.w22 = problem.w23 = problem.w33 = 0.0;
    problem.u0 = {};
    problem.v0 = 0.0;
    for (int i = 0; i < count; ++i) {
      const double g1 = Uniform(-1.0, 1.0);
      const double g2 = Uniform(-1.0, 1.0);
      const double g3 = Uniform(0.1, 1.0);
      const double rate = -Uniform(0.1, 1.0);
      problem.w11 += g1 * g1;
      problem.w12 += g1 * g2;
      problem.w13 += g1 * g3;
      problem.w22 += g2 * g2;
      problem.w23 += g2 * g3;
      problem.w33 += g3 * g3;
      problem.u0[0] += g1 * rate;
      problem.u0[1] += g2 * rate;
      problem.v0 += g3 * rate;
    }
    return problem;
  }

  // The contact of a mechanism with one degree of freedom, whose velocity others change: slip has a part that no
  // impulse moves. Friction is too small to jam it.
  Problem WithPartThatStays() {
    Problem problem = WithDegreesOfFreedom(1);
    const Problem other = Typical();
    problem.u0 = other.u0;
    problem.v0 = other.v0;
    problem.mu = problem.mu_static = Uniform(0.0, 0.9) * problem.w33 / std::hypot(problem.w13, problem.w23);
    return problem;
  }

  Problem SmallSlip() {
    Problem problem = Typical();
    const double size = Power(0.0, 14.0);
    problem.u0 = {problem.u0[0] * size, problem.u0[1] * size};
    return problem;
  }

  // Slip starts almost along a direction in which it would stop, if there is one: it falls to nearly nothing, turns and
  // grows.
  Problem NearMiss() {
    Problem problem = Typical();
    double phi = NearestInvariant(problem);
    phi += Sign() * Power(1.0, 14.0);
    const double slip = Uniform(0.01, 0.5);
    problem.u0 = {slip * std::cos(phi), slip * std::sin(phi)};
    return problem;
  }

  Problem NearStick() {
    Problem problem = Typical();
    problem.mu = problem.mu_static = StickFriction(problem) * (1.0 + Sign() * Power(1.0, 14.0));
    return problem;
  }

  Problem LargeFriction() {
    Problem problem = Typical();
    problem.mu = problem.mu_static = 1.0 / Power(0.0, 6.0);
    return problem;
  }

  // v hardly grows at first, or falls.
  Problem NearJam() {
    Problem problem = Typical();
    const double critical = problem.w33 / std::hypot(problem.w13, problem.w23);
    problem.mu = problem.mu_static = critical * (1.0 + Sign() * Power(1.0, 14.0));
    return problem;
  }

  Problem NearRankTwo() {
    const Problem matrix = WithMatrix(2, Power(1.0, 14.0));
    Problem problem = Typical();
    problem.w11 = matrix.w11;
    problem.w12 = matrix.w12;
    problem.w13 = matrix.w13;
    problem.w22 = matrix.w22;
    problem.w23 = matrix.w23;
    problem.w33 = matrix.w33;
    return problem;
  }

  Problem SmallFriction() {
    Problem problem = Typical();
    problem.mu = problem.mu_static = Power(0.0, 8.0);
    if (Below(2) == 0) problem.coefficient = Power(0.0, 10.0);
    return problem;
  }

  // The friction above which slip that stopped stays stopped: |Wtt^-1 wtn|.
  static double StickFriction(const Problem& p) {
    const double determinant = p.w11 * p.w22 - p.w12 * p.w12;
    return std::hypot(p.w22 * p.w13 - p.w12 * p.w23, p.w11 * p.w23 - p.w12 * p.w13) / determinant;
  }

  double Uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  uint64_t Below(uint64_t bound) { return random_() % bound; }
  double Sign() { return Below(2) == 0 ? -1.0 : 1.0; }

 private:
  // A random power of 10, with an exponent between -`least` and -`most`.
  double Power(double least, double most) { return std::pow(10.0, -Uniform(least, most)); }

  // W = sum of `rank` random dyads, plus `ridge` on the diagonal.
  Problem WithMatrix(int rank, double ridge) {
    Problem p = {.w11 = ridge, .w22 = ridge, .w33 = ridge};
    for (int i = 0; i < rank; ++i) {
      const double a = Normal();
      const double b = Normal();
      const double c = Normal();
      p.w11 += a * a / rank;
      p.w12 += a * b / rank;
      p.w13 += a * c / rank;
      p.w22 += b * b / rank;
      p.w23 += b * c / rank;
      p.w33 += c * c / rank;
    }
    return p;
  }

  struct Flow {
    double growth, turn;
  };
  static Flow FlowAt(const Problem& p, double phi) {
    const double c = std::cos(phi);
    const double s = std::sin(phi);
    const double u1 = p.w13 - p.mu * (p.w11 * c + p.w12 * s);
    const double u2 = p.w23 - p.mu * (p.w12 * c + p.w22 * s);
    return {c * u1 + s * u2, c * u2 - s * u1};
  }

  // Bisects a sign change of the turning rate, for a direction in which slip slows and does not turn.
  double NearestInvariant(const Problem& problem) {
    constexpr int kSamples = 64;
    constexpr double kTurn = 6.283185307179586;
    const double start = Uniform(0.0, kTurn);
    for (int i = 0; i < kSamples; ++i) {
      double low = start + kTurn * i / kSamples;
      double high = start + kTurn * (i + 1) / kSamples;
      const bool rises = FlowAt(problem, low).turn < 0.0;
      if (!rises || FlowAt(problem, high).turn < 0.0 || FlowAt(problem, low).growth > 0.0) continue;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (FlowAt(problem, middle).turn < 0.0 ? low : high) = middle;
      }
      return low;
    }
    return start;
  }

  double Normal() { return std::normal_distribution<>()(random_); }

  std::mt19937_64 random_;
};

}  // namespace ricochet::spatial

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_SPATIAL_SCENES_H_
