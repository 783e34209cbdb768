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

#include "core/models/impact_errors.h"
#include "core/models/restitution_law.h"
#include "core/models/spatial/error_ledger-inl.h"
#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/spatial.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

namespace internal {

// Returns value/whole, or 0 where the whole is 0.
template <typename T>
double Share(T value, T whole) {
  return whole == T{0} ? 0.0 : static_cast<double>(value / whole);
}

// The coefficient that the caller stated is in the report to the last bit, unless the contact is held before.
template <typename T>
void StateCoefficient(const ScaledProblem<T>& problem, const Path<T>& path, Impact& impact) {
  if (impact.regime == Regime::kLocked || path.stops_short || !path.ended) return;
  const auto coefficient = static_cast<double>(problem.coefficient);
  switch (problem.law) {
    case RestitutionLaw::kNewton:
      impact.newton = coefficient;
      // The law states v at the end exactly; a path on which v was larger knows it only to rounding.
      if (path.in_restitution && path.IsRounding(path.state.v - path.goal.target)) {
        impact.v1 = problem.NormalVelocity(path.goal.target);
      }
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

// The error of the change of energy, with the rounding of its terms, which may cancel.
template <typename T>
T EnergyError(const ScaledProblem<T>& problem, const Path<T>& path, const EndErrors<T>& errors) {
  const State<T>& end = path.state;
  const T tau = path.compression_end.tau + end.tau;
  const State<T>& compression = path.compression_end;
  // Friction turns with slip, so that its impulse may be smaller than the parts it was summed from. It stays in its
  // cone, which is no bound where the contact sticks by a large coefficient.
  const T phases = std::sqrt(compression.f1 * compression.f1 + compression.f2 * compression.f2) +
                   std::sqrt(end.f1 * end.f1 + end.f2 * end.f2);
  const T friction = std::min(problem.mu_static * tau, T{16} * phases + problem.graze * tau);
  const T terms =
      friction * (problem.velocity + end.Slip()) + problem.graze * tau * (problem.approach + std::fabs(end.v));
  return errors.energy + T{4} * kEpsilon<T> * terms;
}

// The errors of the coefficients, from numbers in the units of the scaled problem, in which none underflows.
template <typename T>
ImpactErrors ErrorsOfCoefficients(const ScaledProblem<T>& problem, const Path<T>& path, const EndErrors<T>& errors,
                                  const Impact& impact) {
  const auto rounded = [](T error, T value) { return static_cast<double>(error + kEpsilon<T> * std::fabs(value)); };
  const State<T>& compression = path.compression_end;
  ImpactEnd<std::array<double, 2>> scaled = impact;
  scaled.tau_compression = static_cast<double>(compression.tau);
  scaled.tau1 = static_cast<double>(compression.tau + path.state.tau);
  scaled.work_normal_compression = static_cast<double>(compression.normal_work);
  ImpactErrors out;
  out.v = rounded(errors.v, path.state.v);
  out.tau_compression = rounded(errors.tau_compression, compression.tau);
  out.tau = rounded(errors.tau, compression.tau + path.state.tau);
  out.f = rounded(errors.f, static_cast<T>(impact.tangential * scaled.tau1));
  out.work_normal_compression = rounded(errors.normal_compression, compression.normal_work);
  out.work_normal_restitution = rounded(errors.normal_restitution, path.state.normal_work);
  SetCoefficientErrors(scaled, static_cast<double>(problem.v), problem.law, static_cast<double>(problem.coefficient),
                       out);
  return out;
}

// The errors in the units of the caller, with the rounding of the report.
template <typename T>
ImpactErrors ErrorsOf(const ScaledProblem<T>& problem, const Path<T>& path, const EndErrors<T>& errors, T energy_error,
                      const Impact& impact) {
  const auto rounded = [](double error, double value) {
    return error + kEpsilon<double> * std::fabs(value) + 0x1p-1073;
  };
  const double f1 = std::max(std::fabs(impact.f1[0]), std::fabs(impact.f1[1]));
  ImpactErrors out = ErrorsOfCoefficients(problem, path, errors, impact);
  out.u = rounded(problem.Velocity(errors.u), std::max(std::fabs(impact.u1[0]), std::fabs(impact.u1[1])));
  out.v = rounded(problem.NormalVelocity(errors.v), impact.v1);
  out.tau_compression = rounded(problem.Impulse(errors.tau_compression), impact.tau_compression);
  out.tau = rounded(problem.Impulse(errors.tau), impact.tau1);
  out.f = rounded(problem.Impulse(errors.f), f1);
  out.work_normal_compression = rounded(problem.NormalWork(errors.normal_compression), impact.work_normal_compression);
  out.work_normal_restitution = rounded(problem.NormalWork(errors.normal_restitution), impact.work_normal_restitution);
  out.work_tangential_compression =
      rounded(problem.FrictionWork(errors.tangential_compression), impact.work_tangential_compression);
  out.work_tangential_restitution =
      rounded(problem.FrictionWork(errors.tangential_restitution), impact.work_tangential_restitution);
  out.energy_change = rounded(problem.FrictionWork(energy_error), impact.energy_change);
  return out;
}

}  // namespace internal

// `errors` are read if the path has ended.
template <typename T>
Impact MakeImpact(const ScaledProblem<T>& problem, const Path<T>& path, const EndErrors<T>& errors) {
  const State<T>& end = path.state;
  const State<T>& compression = path.compression_end;
  const T tau = compression.tau + end.tau;
  const T f1 = compression.f1 + end.f1;
  const T f2 = compression.f2 + end.f2;
  const T compression_work = path.in_restitution ? compression.normal_work : T{0};
  const T restitution_work = path.in_restitution ? end.normal_work : T{0};
  const T friction_change = T{0.5} * (f1 * (end.u1 + problem.u1) + f2 * (end.u2 + problem.u2));
  const T normal_change = T{0.5} * tau * (end.v + problem.v);
  Impact impact;
  impact.regime = path.regime;
  impact.w_rank = problem.w.rank;
  if (!path.ended) impact.termination = Termination::kRefused;
  impact.error_estimate = path.ended ? KnownError(static_cast<double>(errors.relative)) : ImpactErrors::kUnknown;
  impact.u1 = {problem.Velocity(end.u1), problem.Velocity(end.u2)};
  impact.v1 = problem.NormalVelocity(end.v);
  impact.tau_compression = problem.Impulse(compression.tau);
  impact.tau1 = problem.Impulse(tau);
  impact.f1 = {problem.Impulse(f1), problem.Impulse(f2)};
  impact.work_normal_compression = problem.NormalWork(compression_work);
  impact.work_normal_restitution = problem.NormalWork(restitution_work);
  impact.work_tangential_compression =
      problem.FrictionWork(path.in_restitution ? compression.friction_work : end.friction_work);
  impact.work_tangential_restitution = problem.FrictionWork(path.in_restitution ? end.friction_work : T{0});
  impact.energy_change = problem.FrictionWork(friction_change) + problem.NormalWork(normal_change);
  impact.newton = internal::Share(-end.v, problem.v);
  impact.poisson = internal::Share(end.tau, compression.tau);
  const double returned = internal::Share(-restitution_work, compression_work);
  const double surplus = internal::Share(-(restitution_work + compression_work), compression_work);
  impact.energetic = std::sqrt(std::max(0.0, returned));
  impact.energetic_excess = std::max(-1.0, surplus / (1.0 + impact.energetic));
  // A path without an end has no coefficients of restitution.
  if (!path.ended) {
    impact.newton = impact.poisson = impact.energetic = 0.0;
    impact.energetic_excess = -1.0;
  }
  impact.tangential = internal::Share(std::sqrt(f1 * f1 + f2 * f2), tau);
  const T energy_error = internal::EnergyError(problem, path, errors);
  impact.energy_limit_broken = friction_change + problem.graze * normal_change > energy_error;
  // The works have no known error where a large coefficient only holds the contact; that of the velocities serves then.
  const T work_error = std::min(errors.normal_compression + errors.normal_restitution,
                                errors.relative * problem.velocity * (tau + std::fabs(f1) + std::fabs(f2)));
  impact.sharp_limit_broken = restitution_work + compression_work > work_error;
  impact.events = path.events;
  impact.event_count = path.event_count;
  internal::StateCoefficient(problem, path, impact);
  if (path.ended) impact.errors = internal::ErrorsOf(problem, path, errors, energy_error, impact);
  return impact;
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
