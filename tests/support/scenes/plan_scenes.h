// Random impacts for the plan: over many scales and near the threshold of each effect, with some effects absent.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_PLAN_SCENES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_PLAN_SCENES_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "core/models/spatial/spatial.h"
#include "core/plan/sizes.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/spatial_scenes.h"

namespace ricochet {

class PlanScenes {
 public:
  explicit PlanScenes(uint64_t seed) : planar_(seed), spatial_(seed + 1) {}

  planar::Problem Planar() {
    planar::Problem problem = planar_.Below(4) == 0 ? planar_.Any() : OfManyScales();
    switch (planar_.Below(8)) {
      case 0:
        StopNear(1.0 + problem.coefficient, problem);
        break;
      case 1:
        StopNear(1.0, problem);
        break;
      case 2:
        JamNear(problem);
        break;
      default:
        break;
    }
    return problem;
  }

  pendulum::Problem Pendulum() {
    pendulum::Problem problem = {.inertia = Power(-2.0, 2.0),
                                 .a = Power(-2.0, 2.0),
                                 .b = planar_.Sign() * Power(-2.0, 2.0),
                                 .omega_minus = -Power(-2.0, 2.0)};
    const double x = planar_.Below(4) == 0 ? 1.0 - Power(-12.0, 0.0) : Power(-9.0, 0.0);
    problem.mu = problem.mu_static = x * problem.a / std::fabs(problem.b);
    if (planar_.Below(4) == 0) problem.mu_static *= 1.0 + Power(-3.0, 2.0);
    if (planar_.Below(32) == 0) problem.b = 0.0;
    SetRestitution(problem);
    return problem;
  }

  spatial::Problem Spatial() {
    spatial::Problem problem = planar_.Below(4) == 0 ? spatial_.NearSingular() : spatial_.Typical();
    if (planar_.Below(2) == 0) NearlyASphere(problem);
    if (planar_.Below(2) == 0) {
      const double size = Power(-2.0, 4.0);
      for (double& u : problem.u0) u *= size;
    }
    if (planar_.Below(2) == 0) problem.mu = problem.mu_static = Power(-8.0, 0.0);
    if (planar_.Below(4) == 0) problem.mu_static *= planar_.Uniform(1.0, 3.0);
    problem.tolerance = 1e-12;
    SetRestitution(problem);
    return problem;
  }

  // A contact that may be given springs: near rank one or near locking, a compliant one may rattle for ever.
  planar::Problem ForSprings() {
    planar::Problem problem = OfManyScales();
    while (problem.w.tn * problem.w.tn > 0.99 * problem.w.tt * problem.w.nn) problem = OfManyScales();
    problem.law = RestitutionLaw::kEnergetic;
    problem.mu = std::min(problem.mu, 0.9 * problem.w.nn / std::fabs(problem.w.tn));
    problem.mu_static = problem.mu;
    return problem;
  }

  // A tolerance from 10^-12 to 10^-1.
  double Tolerance() { return Power(-12.0, -1.0); }
  // 10 to a power between both arguments.
  double Power(double low, double high) { return std::pow(10.0, planar_.Uniform(low, high)); }
  double Uniform(double low, double high) { return planar_.Uniform(low, high); }
  uint64_t Below(uint64_t bound) { return planar_.Below(bound); }
  double Sign() { return planar_.Sign(); }

 private:
  planar::Problem OfManyScales() {
    const double wnn = Power(-2.0, 2.0);
    const double wtt = wnn * Power(-1.5, 1.5);
    const double cosine = Below(2) == 0 ? Uniform(0.0, 1.0) : Power(-8.0, 0.0);
    planar::Problem problem = {
        .w = {wtt, Sign() * cosine * std::sqrt(wtt * wnn), wnn}, .v0 = -Power(-3.0, 2.0), .mu = Power(-8.0, 0.5)};
    problem.u0 = Sign() * -problem.v0 * Power(-6.0, 3.0);
    problem.mu_static = Below(4) == 0 ? problem.mu * (1.0 + Power(-3.0, 1.0)) : problem.mu;
    SetRestitution(problem);
    return problem;
  }

  template <typename Problem>
  void SetRestitution(Problem& problem) {
    problem.law = static_cast<RestitutionLaw>(Below(3));
    problem.coefficient = planar_.UnitCoefficient();
  }

  // Slip stops near `periods` times the impulse of compression.
  void StopNear(double periods, planar::Problem& problem) {
    if (problem.mu == 0.0 || planar::SceneSource::IsRankOne(problem)) return;
    const double sign = Sign();
    const double u_slope = sign * problem.w.tn - problem.mu * problem.w.tt;
    const double v_slope = problem.w.nn - sign * problem.mu * problem.w.tn;
    if (!(u_slope < 0.0 && v_slope > 0.0)) return;
    problem.u0 = sign * problem.v0 * u_slope / v_slope * periods * (1.0 + Sign() * Power(-14.0, -0.5));
  }

  void JamNear(planar::Problem& problem) {
    if (problem.w.tn == 0.0 || planar::SceneSource::IsRankOne(problem)) return;
    problem.mu = problem.mu_static = problem.w.nn / std::fabs(problem.w.tn) * (1.0 - Power(-7.0, -0.3));
  }

  void NearlyASphere(spatial::Problem& problem) {
    const double off = Power(-10.0, 0.0);
    const double mean = 0.5 * (problem.w11 + problem.w22);
    const double half = 0.5 * off * (problem.w11 - problem.w22);
    problem.w11 = mean + half;
    problem.w22 = mean - half;
    for (double* w : {&problem.w12, &problem.w13, &problem.w23}) *w *= off;
    if (Below(8) == 0) {
      problem.w22 = problem.w11;
      problem.w12 = problem.w13 = problem.w23 = 0.0;
    }
  }

  planar::SceneSource planar_;
  spatial::SceneSource spatial_;
};

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_PLAN_SCENES_H_
