// Random scenes on which the models of straight slip and of no friction are held to what they claim.
//
// The reference is the formulas of core/models/sliding/sliding.h in ball arithmetic. SlidingTest holds them against the
// planar and the spatial model.

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_SLIDING_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_SLIDING_CLAIMS_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/models/planar/planar.h"
#include "core/models/sliding/sliding.h"
#include "core/plan/scene_problem.h"
#include "tests/support/claims/claims.h"
#include "tests/support/claims/number_claims.h"
#include "tests/support/oracles/arb.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/spatial_scenes.h"

namespace ricochet::sliding {

inline constexpr slong kReferenceBits = 256;

// ---- Scenes ----

template <size_t kTangential>
class ClaimScenes;

template <>
class ClaimScenes<1> {
 public:
  explicit ClaimScenes(uint64_t seed) : source_(seed) {}
  Problem<1> Next(bool hard) { return SlidingProblemOf(hard ? source_.Any() : source_.Everyday()); }
  double Uniform(double low, double high) { return source_.Uniform(low, high); }

 private:
  planar::SceneSource source_;
};

template <>
class ClaimScenes<2> {
 public:
  explicit ClaimScenes(uint64_t seed) : source_(seed) {}
  Problem<2> Next(bool hard) { return SlidingProblemOf(hard ? source_.NearSingular() : source_.Typical()); }
  double Uniform(double low, double high) { return source_.Uniform(low, high); }

 private:
  spatial::SceneSource source_;
};

// A scene that the model serves: v' > 0 and, in a plane, slip that does not stop. Half of the hard scenes are scaled by
// up to 10^+-100.
template <size_t kTangential>
Problem<kTangential> ServedScene(ClaimScenes<kTangential>& scenes, bool friction, bool hard) {
  for (;;) {
    Problem<kTangential> problem = scenes.Next(hard);
    problem.coefficient = std::min(problem.coefficient, 1.0);
    if (!friction) problem.mu = 0.0;
    if (hard && scenes.Uniform(0.0, 1.0) < 0.5) {
      const double speed = std::exp2(scenes.Uniform(-332.0, 332.0));
      const double mobility = std::exp2(scenes.Uniform(-332.0, 332.0));
      for (double& u : problem.u0) u *= speed;
      for (double& w : problem.w) w *= mobility;
      problem.v0 *= speed;
    }
    if (!friction) return problem;
    const bool slips = std::any_of(problem.u0.begin(), problem.u0.end(), [](double u) { return u != 0.0; });
    if (!slips || problem.mu == 0.0 || !(SlidingSlopes(problem).v > 0.0)) continue;
    if (kTangential == 2 || Solve(problem).u1[0] * problem.u0[0] > 0.0) return problem;
  }
}

// ---- Errors ----

// The distance of `impact` from the formulas of the header, as RelativeErrors counts it.
template <size_t kTangential>
RelativeErrors ErrorsReached(const Problem<kTangential>& p, const Impact<kTangential>& impact, bool friction) {
  const auto ball = [](double x) { return Ball(x, kReferenceBits); };
  const auto wtt = [&](size_t i, size_t j) { return ball(kTangential == 1 ? p.w[0] : p.w[i + j == 2 ? 3 : i + j]); };
  const Vector<kTangential> wtn = p.Wtn();
  Ball square(0.0, kReferenceBits);
  double scale = std::fabs(p.v0);
  for (const double u : p.u0) {
    square = square + ball(u) * ball(u);
    scale = std::max(scale, std::fabs(u));
  }
  std::array<Ball, kTangential> f_slope;
  Ball v_slope = ball(p.Wnn());
  for (size_t i = 0; i < kTangential; ++i) {
    f_slope[i] = friction ? -(ball(p.mu) * ball(p.u0[i]) / Sqrt(square)) : ball(0.0);
    v_slope = v_slope + ball(wtn[i]) * f_slope[i];
  }
  const Ball tau = -(ball(p.v0) * (ball(1.0) + ball(p.coefficient)) / v_slope);
  const auto error = [&](double x, const Ball& exact) { return (Abs(ball(x) - exact) / ball(scale)).UpperBound(); };
  RelativeErrors reached = {.velocity = error(impact.v1, -(ball(p.coefficient) * ball(p.v0))),
                            .impulse = (ball(p.Wnn()) * Abs(ball(impact.tau1) - tau) / ball(scale)).UpperBound()};
  Ball trace = wtt(0, 0);
  if (kTangential == 2) trace = trace + wtt(1, 1);
  for (size_t i = 0; i < kTangential; ++i) {
    Ball slope = ball(wtn[i]);
    for (size_t j = 0; j < kTangential; ++j) slope = slope + wtt(i, j) * f_slope[j];
    reached.velocity = std::max(reached.velocity, error(impact.u1[i], ball(p.u0[i]) + slope * tau));
    const Ball distance = Abs(ball(impact.f1[i]) - f_slope[i] * tau);
    reached.impulse = std::max(reached.impulse, (trace * distance / ball(scale)).UpperBound());
  }
  return reached;
}

// The impact by the formulas of the header.
template <size_t kTangential>
ComparedNumbers CompareNumbers(const Problem<kTangential>& p, const Impact<kTangential>& impact, bool friction) {
  const auto ball = [](double x) { return Ball(x, kReferenceBits); };
  const auto wtt = [&](size_t i, size_t j) { return ball(kTangential == 1 ? p.w[0] : p.w[i + j == 2 ? 3 : i + j]); };
  const Vector<kTangential> wtn = p.Wtn();
  const Ball c = ball(p.coefficient);
  Ball square = ball(0.0);
  for (const double u : p.u0) square = square + ball(u) * ball(u);
  std::array<Ball, kTangential> f_slope;
  Ball v_slope = ball(p.Wnn());
  for (size_t i = 0; i < kTangential; ++i) {
    f_slope[i] = friction ? -(ball(p.mu) * ball(p.u0[i]) / Sqrt(square)) : ball(0.0);
    v_slope = v_slope + ball(wtn[i]) * f_slope[i];
  }
  const Ball tau_c = -(ball(p.v0) / v_slope);
  const Ball tau = tau_c * (1.0 + c);
  const Ball normal = 0.5 * tau_c * ball(p.v0);
  Ball tangential_c = ball(0.0);
  Ball tangential = ball(0.0);
  ComparedNumber u;
  ComparedNumber f;
  for (size_t i = 0; i < kTangential; ++i) {
    Ball slope = ball(wtn[i]);
    for (size_t j = 0; j < kTangential; ++j) slope = slope + wtt(i, j) * f_slope[j];
    const Ball u1 = ball(p.u0[i]) + slope * tau;
    tangential_c = tangential_c + 0.5 * f_slope[i] * tau_c * (2.0 * ball(p.u0[i]) + slope * tau_c);
    tangential = tangential + 0.5 * f_slope[i] * tau * (ball(p.u0[i]) + u1);
    const ComparedNumber u_here(impact.u1[i], u1);
    const ComparedNumber f_here(impact.f1[i], f_slope[i] * tau);
    u = {std::max(u.reached, u_here.reached), std::max(u.size, u_here.size)};
    f = {std::max(f.reached, f_here.reached), std::max(f.size, f_here.size)};
  }
  const Ball mu_hat = !friction ? ball(0.0) : kTangential == 1 ? f_slope[0] : ball(p.mu);
  return {.newton = {impact.newton, c},
          .poisson = {impact.poisson, c},
          .energetic = {impact.energetic, c},
          .tangential = {impact.tangential, mu_hat},
          .u = u,
          .v = {impact.v1, -(c * ball(p.v0))},
          .tau_compression = {impact.tau_compression, tau_c},
          .tau = {impact.tau1, tau},
          .f = f,
          .work_normal_compression = {impact.work_normal_compression, normal},
          .work_normal_restitution = {impact.work_normal_restitution, -(c * c * normal)},
          .work_tangential_compression = {impact.work_tangential_compression, tangential_c},
          .work_tangential_restitution = {impact.work_tangential_restitution, tangential - tangential_c},
          .energy_change = {impact.energy_change, normal * (1.0 - c * c) + tangential}};
}

// Compares impacts number by number; |v0| of a grazing scene is down to 1e-300 of |u0|.
template <size_t kTangential>
NumberClaims NumberClaimsOf(bool friction, bool hard, bool grazing, int count, uint64_t seed) {
  ClaimScenes<kTangential> scenes(seed);
  NumberClaims claims;
  for (int i = 0; i < count; ++i) {
    Problem<kTangential> problem = ServedScene(scenes, friction, hard);
    if (grazing) problem.v0 *= std::pow(10.0, -scenes.Uniform(0.0, 300.0));
    const Impact<kTangential> impact = friction ? Solve(problem) : SolveFrictionless(problem);
    claims.Add(NumberErrorsOf(problem, impact), CompareNumbers(problem, impact, friction),
               "scene " + std::to_string(i));
  }
  return claims;
}

struct Claims {
  ClaimTally velocity, impulse;
};

template <size_t kTangential>
Claims ClaimsOf(bool friction, bool hard, int count, uint64_t seed) {
  ClaimScenes<kTangential> scenes(seed);
  Claims claims;
  for (int i = 0; i < count; ++i) {
    const Problem<kTangential> problem = ServedScene(scenes, friction, hard);
    const Impact<kTangential> impact = friction ? Solve(problem) : SolveFrictionless(problem);
    const RelativeErrors claimed = friction ? ErrorsOf(problem) : FrictionlessErrorsOf(problem);
    const RelativeErrors reached = ErrorsReached(problem, impact, friction);
    claims.velocity.Add(claimed.velocity, reached.velocity);
    claims.impulse.Add(claimed.impulse, reached.impulse);
  }
  return claims;
}

}  // namespace ricochet::sliding

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_SLIDING_CLAIMS_H_
