// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run
// time.
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

// A comparison with NaN is false.
template <typename V>
HWY_INLINE auto IsSurelyClosedForm(const pendulum::ProblemColumns& problems, size_t i) {
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
  return Both(Both(is_body, is_rough), Both(lower <= c, c <= most_c));
}

template <typename V>
HWY_INLINE bool Choose(const pendulum::ProblemColumns& problems, size_t i, absl::Span<Model> models) {
  const auto is_sure = IsSurelyClosedForm<V>(problems, i);
  std::fill_n(models.data() + i, Lanes<V>::Count(), Model::kPendulum);
  if (InAllLanes(is_sure)) return true;
  std::array<double, pendulum::ProblemColumns::kMostLanes> found;
  Lanes<V>::Store(Select(is_sure, Lanes<V>::Fill(1.0), Lanes<V>::Fill(0.0)), found.data());
  for (size_t lane = 0; lane < Lanes<V>::Count(); ++lane) {
    if (found[lane] == 0.0) models[i + lane] = Model::kUnspecified;
  }
  return false;
}

}  // namespace pendulum_models

bool ChoosePendulums(const pendulum::ProblemColumns& problems, absl::Span<Model> models) {
  bool all = true;
  size_t i = 0;
  for (; i + Lanes<Vector>::Count() <= models.size(); i += Lanes<Vector>::Count()) {
    all &= pendulum_models::Choose<Vector>(problems, i, models);
  }
  for (; i < models.size(); ++i) all &= pendulum_models::Choose<double>(problems, i, models);
  return all;
}

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet {

HWY_EXPORT(ChoosePendulums);

bool ModelsOfPendulum(const pendulum::ProblemColumns& problems, absl::Span<Model> models) {
  return HWY_DYNAMIC_DISPATCH(ChoosePendulums)(problems, models);
}

}  // namespace ricochet

#endif  // HWY_ONCE
