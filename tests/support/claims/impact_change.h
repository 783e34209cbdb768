// ChangeBetween: the difference between the ends of two impacts of one contact, as the plan measures it
// (core/plan/sizes.h).

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_IMPACT_CHANGE_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_IMPACT_CHANGE_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/models/pendulum/first_order.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/sliding/sliding.h"
#include "core/models/spatial/spatial.h"
#include "core/plan/sizes.h"

namespace ricochet {

// The end of an impact.
template <size_t kTangential>
struct Ending {
  std::array<double, kTangential> u1 = {};
  double v1 = 0.0;
  double tau1 = 0.0;
  std::array<double, kTangential> f1 = {};
};

// `wtt` is the trace of Wtt, and `speed` is max(|u0|, |v0|).
template <size_t kTangential>
double ChangeBetween(const Ending<kTangential>& a, const Ending<kTangential>& b, double wtt, double wnn, double speed) {
  double change = std::max(std::fabs(a.v1 - b.v1), wnn * std::fabs(a.tau1 - b.tau1));
  for (size_t i = 0; i < kTangential; ++i) {
    change = std::max({change, std::fabs(a.u1[i] - b.u1[i]), wtt * std::fabs(a.f1[i] - b.f1[i])});
  }
  return change / speed;
}

// The end of an Impact of any planar model.
Ending<1> EndingOf(const auto& impact) {
  return {.u1 = {impact.u1}, .v1 = impact.v1, .tau1 = impact.tau1, .f1 = {impact.f1}};
}

inline Ending<1> EndingOf(const pendulum::Impact& impact) {
  return {.u1 = {impact[pendulum::Output::kTangentialVelocityAfter]},
          .v1 = impact[pendulum::Output::kNormalVelocityAfter],
          .tau1 = impact[pendulum::Output::kNormalImpulse],
          .f1 = {impact[pendulum::Output::kTangentialImpulse]}};
}

inline Ending<2> EndingOf(const spatial::Impact& impact) {
  return {.u1 = impact.u1, .v1 = impact.v1, .tau1 = impact.tau1, .f1 = impact.f1};
}

template <size_t kTangential>
Ending<kTangential> EndingOf(const sliding::Impact<kTangential>& impact) {
  return {.u1 = impact.u1, .v1 = impact.v1, .tau1 = impact.tau1, .f1 = impact.f1};
}

inline double SpeedOf(const planar::Problem& problem) { return std::max(std::fabs(problem.u0), -problem.v0); }
inline double SpeedOf(const spatial::Problem& problem) {
  return std::max({std::fabs(problem.u0[0]), std::fabs(problem.u0[1]), -problem.v0});
}

// The size over max(|u0|, |v0|), to which the changes between endings are relative.
template <typename Problem>
Size OverSpeed(Size size, const Problem& problem) {
  size.value *= -problem.v0 / SpeedOf(problem);
  return size;
}

inline double ChangeBetween(const planar::Problem& problem, const Ending<1>& a, const Ending<1>& b) {
  return ChangeBetween(a, b, problem.w.tt, problem.w.nn, SpeedOf(problem));
}
inline double ChangeBetween(const spatial::Problem& problem, const Ending<2>& a, const Ending<2>& b) {
  return ChangeBetween(a, b, problem.w11 + problem.w22, problem.w33, SpeedOf(problem));
}

// The problem without friction, or with the kinetic coefficient in place of the static one.
template <typename Problem>
Problem Smooth(Problem problem) {
  problem.mu = problem.mu_static = 0.0;
  return problem;
}
template <typename Problem>
Problem WithoutStatic(Problem problem) {
  problem.mu_static = problem.mu;
  return problem;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_IMPACT_CHANGE_H_
