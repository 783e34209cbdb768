#include "core/audit/coulomb_path.h"

#include <algorithm>
#include <cmath>

#include "core/models/restitution_law.h"
#include "core/numerics/elementary.h"

namespace ricochet::audit {
namespace {

// The planar model rounds a handful of operations at each event and is exact otherwise.
constexpr double kPlanarError = 0x1p-46;

std::array<double, 2> Tangential(double value) { return {value, 0.0}; }
std::array<double, 2> Tangential(const std::array<double, 2>& value) { return value; }

double Scale(const planar::Problem& problem) { return std::max(std::abs(problem.u0), std::abs(problem.v0)); }
double Scale(const spatial::Problem& problem) {
  return std::max(Hypot(problem.u0[0], problem.u0[1]), std::abs(problem.v0));
}
bool Slips(const planar::Problem& problem) { return problem.u0 != 0.0; }
bool Slips(const spatial::Problem& problem) { return problem.u0[0] != 0.0 || problem.u0[1] != 0.0; }
double VelocityError(const planar::Problem& problem, const planar::Impact& /*impact*/) {
  return kPlanarError * Scale(problem);
}
double VelocityError(const spatial::Problem& problem, const spatial::Impact& impact) {
  return std::max(problem.tolerance, impact.error_estimate) * Scale(problem);
}

int64_t Steps(const planar::Impact& /*impact*/) { return 0; }
int64_t Steps(const spatial::Impact& impact) { return impact.steps; }

template <typename Impact>
Regime RegimeOf(const Impact& impact) {
  return impact.termination == Termination::kBudgetUsedUp ? Regime::kUnspecified : impact.regime;
}

// Returns the end of an impact as a point of the path.
template <typename Problem, typename Impact>
PathPoint EndOf(const Problem& problem, const Impact& impact) {
  return {.regime = RegimeOf(impact),
          .w_rank = impact.w_rank,
          .tau_compression = impact.tau_compression,
          .tau = impact.tau1,
          .f = Tangential(impact.f1),
          .u = Tangential(impact.u1),
          .v = impact.v1,
          .newton = impact.newton,
          .poisson = impact.poisson,
          .energetic = impact.energetic,
          .energetic_excess = impact.energetic_excess,
          .work_normal_compression = impact.work_normal_compression,
          .work_normal_restitution = impact.work_normal_restitution,
          .work_tangential_compression = impact.work_tangential_compression,
          .work_tangential_restitution = impact.work_tangential_restitution,
          .energy_change = impact.energy_change,
          .velocity_error = VelocityError(problem, impact),
          .steps = Steps(impact)};
}

using planar::Solve;
using spatial::Solve;

template <typename Problem>
auto SolveBy(Problem problem, RestitutionLaw law, double coefficient) {
  problem.law = law;
  problem.coefficient = coefficient;
  return Solve(problem);
}

// Fills a point before the end of compression, except its impulses, velocities and works.
template <typename Problem, typename Impact>
PathPoint DuringCompression(const Problem& problem, const Impact& impact, double tau) {
  PathPoint point{
      .regime = RegimeOf(impact), .w_rank = impact.w_rank, .tau_compression = impact.tau_compression, .tau = tau};
  point.steps = Steps(impact);
  const bool stopped = HasEvent(impact, EventKind::kSlipStops, tau);
  const bool slides = !stopped && Slips(problem) && impact.regime != Regime::kFrictionless;
  if (slides && point.regime != Regime::kUnspecified) point.regime = Regime::kSliding;
  point.poisson = (tau - impact.tau_compression) / impact.tau_compression;
  point.energetic_excess = -1.0;
  point.velocity_error = VelocityError(problem, impact);
  return point;
}

// The planar path is straight between two events, so trapezoids give its works exactly.
PathPoint BeforeCompressionEnds(const planar::Problem& problem, const planar::Impact& impact, double tau) {
  PathPoint point = DuringCompression(problem, impact, tau);
  const planar::Instant end = planar::At(problem, impact, tau);
  planar::Instant from = impact.events[0];
  const auto advance = [&](const planar::Instant& to) {
    point.work_normal_compression += 0.5 * (to.tau - from.tau) * (from.v + to.v);
    point.work_tangential_compression += 0.5 * (to.f - from.f) * (from.u + to.u);
    from = to;
  };
  for (int i = 1; i < impact.event_count && impact.events[static_cast<size_t>(i)].tau < tau; ++i) {
    advance(impact.events[static_cast<size_t>(i)]);
  }
  advance(end);
  point.f[0] = end.f;
  point.u[0] = end.u;
  point.v = end.v;
  point.newton = -end.v / problem.v0;
  point.energy_change = 0.5 * (end.f * (problem.u0 + end.u) + tau * (problem.v0 + end.v));
  return point;
}

// Solves another contact that has the same slip and ends its compression earlier, and shifts its normal velocity. The
// factors 2 and 0.5 make it end there by tau/2 (docs/theory/audit.md).
PathPoint BeforeCompressionEnds(const spatial::Problem& problem, const spatial::Impact& impact, double tau) {
  PathPoint point = DuringCompression(problem, impact, tau);
  point.u = problem.u0;
  point.v = problem.v0;
  if (tau > 0.0) {
    spatial::Problem other = problem;
    other.w33 = 2.0 * (problem.w33 + problem.mu * Hypot(problem.w13, problem.w23));
    other.v0 = -0.5 * problem.w33 * tau;
    const spatial::Impact half = SolveBy(other, RestitutionLaw::kPoisson, 0.0);
    const double restitution = (tau - half.tau_compression) / half.tau_compression;
    const spatial::Impact end = SolveBy(other, RestitutionLaw::kPoisson, restitution);
    if (RegimeOf(end) == Regime::kUnspecified) point.regime = Regime::kUnspecified;
    point.steps += half.steps + end.steps;
    point.velocity_error = std::max(point.velocity_error, VelocityError(other, end));
    const double v_shift = problem.v0 - other.v0;
    const double slope_shift = other.w33 - problem.w33;
    point.f = end.f1;
    point.u = end.u1;
    point.v = end.v1 + v_shift - slope_shift * tau;
    point.work_normal_compression =
        end.work_normal_compression + end.work_normal_restitution + v_shift * tau - 0.5 * slope_shift * tau * tau;
    point.work_tangential_compression = end.work_tangential_compression + end.work_tangential_restitution;
  }
  point.newton = -point.v / problem.v0;
  point.energy_change = 0.5 * (point.f[0] * (problem.u0[0] + point.u[0]) + point.f[1] * (problem.u0[1] + point.u[1]) +
                               tau * (problem.v0 + point.v));
  return point;
}

template <typename Problem>
PathPoint PointAt(const Problem& problem, double tau) {
  const auto compression = SolveBy(problem, RestitutionLaw::kPoisson, 0.0);
  if (compression.regime == Regime::kSeparating) return EndOf(problem, compression);
  const double restitution = tau - compression.tau_compression;
  if (restitution < 0.0) return BeforeCompressionEnds(problem, compression, tau);
  if (compression.regime == Regime::kLocked) return EndOf(problem, compression);
  PathPoint point =
      EndOf(problem, SolveBy(problem, RestitutionLaw::kPoisson, restitution / compression.tau_compression));
  point.steps += Steps(compression);
  return point;
}

}  // namespace

PathPoint PathAt(const planar::Problem& problem, double tau) { return PointAt(problem, tau); }
PathPoint PathAt(const spatial::Problem& problem, double tau) { return PointAt(problem, tau); }

PathPoint PathWhereNormalIs(const planar::Problem& problem, double normal_m_s) {
  return EndOf(problem, SolveBy(problem, RestitutionLaw::kNewton, -normal_m_s / problem.v0));
}
PathPoint PathWhereNormalIs(const spatial::Problem& problem, double normal_m_s) {
  return EndOf(problem, SolveBy(problem, RestitutionLaw::kNewton, -normal_m_s / problem.v0));
}

}  // namespace ricochet::audit
