// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/plan/pendulum_models.cc"
#include "core/plan/pendulum_models.h"

#include <algorithm>
#include <array>

#include "core/models/restitution_law.h"
// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/numerics/lanes-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {
namespace pendulum_models {

constexpr double kLimit = 0x1p100;  // The largest magnitude, and the inverse of the least.
// How far a bound must lie above the tolerance; 1 would do but for rounding and the padding of sizes.
constexpr double kMargin = 4.0;

// The first-order form has an error of at least c x^2/2 of the velocities; under Newton's law, which fixes them, of at least
// c x^2 a/max(a, |b|) of the impulses. Friction changes tau0 by x/(1 + x) (core/plan/sizes.cc), which is at least x/2 if it
// does not lock the body; otherwise its size is infinite. Here q = mu |b| = x a.
template <typename V>
HWY_INLINE auto IsFarFromSimple(RestitutionLaw law, V c, V q, V a, V b, double tolerance) {
  const V least = Lanes<V>::Fill(kMargin * tolerance) * a;
  const V longest = law == RestitutionLaw::kNewton ? Larger(a, b) : a;
  return Both(least < q, least * longest < c * q * q);
}

// A comparison with NaN is false.
template <typename V>
HWY_INLINE auto NeedsClosedForm(const pendulum::ProblemColumns& problems, size_t i, double tolerance) {
  const V inertia = Lanes<V>::Load(problems.inertia() + i);
  const V a = Lanes<V>::Load(problems.a() + i);
  const V b = Absolute(Lanes<V>::Load(problems.b() + i));
  const V approach = Lanes<V>::Fill(0.0) - Lanes<V>::Load(problems.omega_minus() + i);
  const V mu = Lanes<V>::Load(problems.mu() + i);
  const V mu_static = Lanes<V>::Load(problems.mu_static() + i);
  const V c = Lanes<V>::Load(problems.coefficient() + i);
  const V lower = Lanes<V>::Fill(1.0 / kLimit);
  const V upper = Lanes<V>::Fill(kLimit);
  const auto is_in_range = [&](V x) { return Both(lower <= x, x <= upper); };
  const V most_c = problems.law() == RestitutionLaw::kEnergetic ? Lanes<V>::Fill(1.0) : upper;
  const auto is_body = Both(Both(is_in_range(inertia), is_in_range(a)), Both(is_in_range(b), is_in_range(approach)));
  const auto is_rough = Both(Both(lower <= mu, mu <= mu_static), mu_static <= upper);
  const auto is_valid = Both(Both(is_body, is_rough), Both(lower <= c, c <= most_c));
  return Both(is_valid, IsFarFromSimple(problems.law(), c, mu * b, a, b, tolerance));
}

template <typename V>
HWY_INLINE bool Choose(const pendulum::ProblemColumns& problems, size_t i, double tolerance, absl::Span<Model> models) {
  const auto needs = NeedsClosedForm<V>(problems, i, tolerance);
  std::fill_n(models.data() + i, Lanes<V>::Count(), Model::kPendulum);
  if (InAllLanes(needs)) return true;
  std::array<double, pendulum::ProblemColumns::kMostLanes> found;
  Lanes<V>::Store(Select(needs, Lanes<V>::Fill(1.0), Lanes<V>::Fill(0.0)), found.data());
  for (size_t lane = 0; lane < Lanes<V>::Count(); ++lane) {
    if (found[lane] == 0.0) models[i + lane] = Model::kUnspecified;
  }
  return false;
}

}  // namespace pendulum_models

bool ChoosePendulums(const pendulum::ProblemColumns& problems, double tolerance, absl::Span<Model> models) {
  bool all = true;
  size_t i = 0;
  for (; i + Lanes<Vector>::Count() <= models.size(); i += Lanes<Vector>::Count()) {
    all &= pendulum_models::Choose<Vector>(problems, i, tolerance, models);
  }
  for (; i < models.size(); ++i) all &= pendulum_models::Choose<double>(problems, i, tolerance, models);
  return all;
}

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet {

HWY_EXPORT(ChoosePendulums);

bool ModelsOfPendulum(const pendulum::ProblemColumns& problems, double tolerance, absl::Span<Model> models) {
  return HWY_DYNAMIC_DISPATCH(ChoosePendulums)(problems, tolerance, models);
}

}  // namespace ricochet

#endif  // HWY_ONCE
