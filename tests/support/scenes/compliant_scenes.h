// Impacts with tangential compliance: those of the vectors, and random ones.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_COMPLIANT_SCENES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_COMPLIANT_SCENES_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "core/models/compliant/compliant.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet::compliant {

// Returns the problem of a row of compliant.csv.
inline Problem ProblemOf(const VectorRow& row) {
  return {.contact = {.w = {Number(row, "wtt"), Number(row, "wtn"), Number(row, "wnn")},
                      .u0 = Number(row, "u0"),
                      .v0 = Number(row, "v0"),
                      .mu = Number(row, "mu"),
                      .coefficient = Number(row, "eta")},
          .ratio_squared = Number(row, "ratio2")};
}

class SceneSource {
 public:
  explicit SceneSource(uint64_t seed) : random_(seed) {}

  // W has full rank, and ratio^2 lies between the arguments. One scene in four has much friction, one in eight starts
  // without slip. Five times an entry of W or a velocity is exact.
  Problem Everyday(double least_ratio_squared, double largest_ratio_squared) {
    const double t = LogUniform(0.1, 3.0);
    const double n = LogUniform(0.1, 3.0);
    Problem problem = {.contact = {.w = {Short(t * t), Short(t * n * Uniform(-1.0, 1.0)), Short(n * n)},
                                   .u0 = Short(Uniform(-3.0, 3.0)),
                                   .v0 = -Short(Uniform(0.1, 3.0)),
                                   .mu = Uniform(0.0, 1.5),
                                   .coefficient = Uniform(0.05, 1.0)},
                       .ratio_squared = LogUniform(least_ratio_squared, largest_ratio_squared)};
    if (Below(4) == 0) problem.contact.mu *= 10.0;
    if (Below(8) == 0) problem.contact.u0 = 0.0;
    return problem;
  }

  // A pendulum's: exactly of rank one, (u0, v0) in the range of W.
  Problem RankOne() {
    Problem problem = Everyday(0.02, 4.0);
    const double a = (1 + Below(1000)) / 32.0;
    const double b = (Below(2001) - 1000) / 32.0;
    const double rate = -(1 + Below(64)) / 64.0;
    problem.contact.w.tt = b * b;
    problem.contact.w.tn = a * b;
    problem.contact.w.nn = a * a;
    problem.contact.u0 = rate * b;
    problem.contact.v0 = rate * a;
    return problem;
  }

  // det W from a tenth to 1e-7 of Wtt Wnn.
  Problem NearRankOne() {
    Problem problem = Everyday(0.02, 4.0);
    const double cosine = std::sqrt(1.0 - LogUniform(1e-7, 1e-1));
    problem.contact.w.tn =
        Short((Below(2) == 0 ? cosine : -cosine) * std::sqrt(problem.contact.w.tt * problem.contact.w.nn));
    return problem;
  }

  // All sizes, det W > 1e-3 Wtt Wnn, and friction that cannot hold the body. One scene in two is a borderline: slip
  // stops close to the end of compression, or the impact starts close to the slip at which it would stick.
  Problem AnySizes() {
    Problem problem = {
        .contact = {.w = {LogUniform(1e-3, 1e3), 0.0, LogUniform(1e-3, 1e3)}, .v0 = -LogUniform(1e-3, 1e3)}};
    problem.contact.w.tn = Uniform(-1.0, 1.0) * std::sqrt((1.0 - 1e-3) * problem.contact.w.tt * problem.contact.w.nn);
    problem.contact.mu =
        LogUniform(1e-12, std::min(10.0, 0.999 * problem.contact.w.nn / std::fabs(problem.contact.w.tn)));
    problem.ratio_squared = LogUniform(1e-4, 1e4);
    const int eta = Below(3);
    problem.contact.coefficient = eta == 0   ? Uniform(0.0, 1.0)
                                  : eta == 1 ? LogUniform(1e-12, 1.0)
                                             : 1.0 - LogUniform(1e-16, 1.0);
    const double side = Below(2) == 0 ? -1.0 : 1.0;
    const double closeness = 1.0 + (Below(2) == 0 ? -1.0 : 1.0) * LogUniform(1e-17, 1e-3);
    const int start = Below(4);
    if (start == 0) {
      const double slope = side * problem.contact.w.tn - problem.contact.mu * problem.contact.w.tt;
      problem.contact.u0 = side * slope * problem.contact.v0 /
                           (problem.contact.w.nn - side * problem.contact.mu * problem.contact.w.tn) * closeness;
    } else if (start == 1) {
      problem.contact.u0 = side * problem.contact.mu * problem.ratio_squared * problem.contact.v0 * closeness;
    } else {
      problem.contact.u0 = side * LogUniform(1e-6, 1e6) * problem.contact.v0;
    }
    return problem;
  }

  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double LogUniform(double low, double high) { return std::exp2(Uniform(std::log2(low), std::log2(high))); }
  int Below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

 private:
  static double Short(double value) { return std::nearbyint(value * 0x1p24) * 0x1p-24; }

  std::mt19937_64 random_;
};

}  // namespace ricochet::compliant

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_COMPLIANT_SCENES_H_
