// The report of the spatial solver: an Impact in the units of the caller, from the path and the error estimate.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_REPORT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_REPORT_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_REPORT_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_REPORT_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/models/restitution_law.h"
#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/spatial.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

namespace internal {

// value/whole; 0 where the whole is 0.
template <typename T>
double Share(T value, T whole) {
  return whole == T{0} ? 0.0 : static_cast<double>(value / whole);
}

// The coefficient that the caller stated is in the report to the last bit.
template <typename T>
void StateCoefficient(const ScaledProblem<T>& problem, const Path<T>& path, Impact& impact) {
  if (impact.regime == Regime::kLocked || !path.ended) return;
  const auto coefficient = static_cast<double>(problem.coefficient);
  switch (problem.law) {
    case RestitutionLaw::kNewton:
      impact.newton = coefficient;
      break;
    case RestitutionLaw::kPoisson:
      if (path.goal.quantity == Quantity::kImpulse) impact.poisson = coefficient;
      break;
    case RestitutionLaw::kEnergetic:
      impact.energetic = coefficient;
      impact.energetic_excess = coefficient - 1.0;
      impact.sharp_limit_broken = coefficient > 1.0;
      break;
  }
}

}  // namespace internal

// `estimate` is the relative error of the velocities, which is read if the path has ended.
template <typename T>
Impact MakeImpact(const ScaledProblem<T>& problem, const Path<T>& path, T estimate) {
  const State<T>& end = path.state;
  const State<T>& compression = path.compression_end;
  const T tau = compression.tau + end.tau;
  const T f1 = compression.f1 + end.f1;
  const T f2 = compression.f2 + end.f2;
  const T restitution_work = path.in_restitution ? path.NormalWork(end) : T{0};
  const T energy_change =
      T{0.5} * (f1 * (end.u1 + problem.u1) + f2 * (end.u2 + problem.u2) + tau * (end.v + problem.v));
  Impact impact;
  impact.regime = path.regime;
  impact.w_rank = problem.w.rank;
  if (!path.ended) impact.termination = Termination::kRefused;
  impact.error_estimate = path.ended ? static_cast<double>(estimate) : std::numeric_limits<double>::infinity();
  impact.u1 = {problem.Velocity(end.u1), problem.Velocity(end.u2)};
  impact.v1 = problem.Velocity(end.v);
  impact.tau_compression = problem.Impulse(compression.tau);
  impact.tau1 = problem.Impulse(tau);
  impact.f1 = {problem.Impulse(f1), problem.Impulse(f2)};
  impact.work_normal_compression = problem.Work(path.compression_work);
  impact.work_normal_restitution = problem.Work(restitution_work);
  impact.work_tangential_compression =
      problem.Work(path.in_restitution ? compression.friction_work : end.friction_work);
  impact.work_tangential_restitution = problem.Work(path.in_restitution ? end.friction_work : T{0});
  impact.energy_change = problem.Work(energy_change);
  impact.newton = internal::Share(-end.v, problem.v);
  impact.poisson = internal::Share(end.tau, compression.tau);
  impact.energetic = std::sqrt(std::max(0.0, internal::Share(-restitution_work, path.compression_work)));
  impact.energetic_excess =
      internal::Share(-(restitution_work + path.compression_work), path.compression_work) / (1.0 + impact.energetic);
  // A path without an end has no coefficients of restitution.
  if (!path.ended) impact.newton = impact.poisson = impact.energetic = 0.0, impact.energetic_excess = -1.0;
  impact.tangential = internal::Share(std::sqrt(f1 * f1 + f2 * f2), tau);
  const T work_error = estimate * problem.velocity * (tau + std::fabs(f1) + std::fabs(f2));
  impact.energy_limit_broken = energy_change > work_error;
  impact.sharp_limit_broken = restitution_work + path.compression_work > work_error;
  impact.events = path.events;
  impact.event_count = path.event_count;
  internal::StateCoefficient(problem, path, impact);
  return impact;
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
