#include "core/bounds/contact_bounds.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/models/restitution_law.h"

namespace ricochet::planar {
namespace {

Impact SolveAt(Problem problem, RestitutionLaw law, double coefficient) {
  problem.law = law;
  problem.coefficient = coefficient;
  return Solve(problem);
}

// The largest double not above `bound`, but for a few, that Solve accepts as admissible.
double LargestAdmissible(const Problem& problem, RestitutionLaw law, double bound) {
  for (double step = 0x1p-53; SolveAt(problem, law, bound).sharp_limit_broken; step *= 2.0) {
    bound = std::nextafter(bound - step * bound, 0.0);
  }
  return bound;
}

CoefficientBounds SharpBounds(const Problem& problem, const Impact& dead, const Impact& elastic) {
  CoefficientBounds bounds;
  if (elastic.regime != Regime::kLocked) {
    bounds.newton.upper = LargestAdmissible(problem, RestitutionLaw::kNewton, elastic.newton);
    bounds.poisson.upper = LargestAdmissible(problem, RestitutionLaw::kPoisson, elastic.poisson);
    bounds.energetic.upper = 1.0;
  }
  bounds.tangential = {std::min(dead.tangential, elastic.tangential), std::max(dead.tangential, elastic.tangential)};
  bounds.normal_total_n_s = {dead.tau1, elastic.tau1};
  return bounds;
}

// d(u, v, f)/dtau, and the slope of E'.
struct Slopes {
  double u, v, f, power;
};

Slopes SlopesAt(const Problem& problem, int w_rank, double f) {
  const double v = std::fma(f, problem.wtn, problem.wnn);
  const double square = problem.wtn * problem.wtn;
  const double square_error = std::fma(problem.wtn, problem.wtn, -square);
  const double det = w_rank == 1 ? 0.0 : std::fma(problem.wtt, problem.wnn, -square) - square_error;
  const double u = w_rank == 1 ? v * problem.wtn / problem.wnn : std::fma(f, problem.wtt, problem.wtn);
  // (f, 1) W (f, 1)^T by its square completed: no cancellation.
  return {.u = u, .v = v, .f = f, .power = (v * v + f * f * det) / problem.wnn};
}

// After slip has stopped.
Slopes SlopesAfterStop(const Problem& problem, int w_rank) {
  const bool sticks = w_rank == 2 && std::fabs(problem.wtn) <= problem.mu_static * problem.wtt;
  if (!sticks) return SlopesAt(problem, w_rank, -std::copysign(problem.mu, problem.wtn));
  Slopes slopes = SlopesAt(problem, w_rank, -problem.wtn / problem.wtt);
  slopes.u = 0.0;
  slopes.v = slopes.power;
  return slopes;
}

// The contact on its way to where it has the energy that it came with.
struct Traveller {
  double tau, f, u, v;
  double energy;  // E - E-, <= 0.
  double work;    // Normal work of restitution.

  void Advance(const Slopes& slopes, double step) {
    const double v_new = v + slopes.v * step;
    work += 0.5 * step * (v + v_new);
    energy += step * (slopes.f * u + v + 0.5 * step * slopes.power);
    tau += step;
    f += slopes.f * step;
    u += slopes.u * step;
    v = v_new;
  }

  // How far along `slopes` the energy is back.
  double StepToZero(const Slopes& slopes) const {
    const double power = slopes.f * u + v;
    const double root = std::sqrt(power * power - 2.0 * energy * slopes.power);
    return power > 0.0 ? -2.0 * energy / (power + root) : (root - power) / slopes.power;
  }
};

bool HasStopped(const Impact& impact) {
  return std::any_of(impact.events.begin(), impact.events.begin() + impact.event_count,
                     [](const Instant& instant) { return instant.kind == EventKind::kSlipStops; });
}

// Where the energy is back, from the end of the elastic impact on.
Traveller WhereEnergyIsBack(const Problem& problem, const Impact& elastic) {
  Traveller at = {.tau = elastic.tau1,
                  .f = elastic.f1,
                  .u = elastic.u1,
                  .v = elastic.v1,
                  .energy = std::min(elastic.energy_change, 0.0),
                  .work = elastic.work_normal_restitution};
  Slopes slopes;
  if (problem.wtt == 0.0) {
    slopes = SlopesAt(problem, elastic.w_rank, 0.0);
  } else if (HasStopped(elastic) || problem.u0 == 0.0) {
    slopes = SlopesAfterStop(problem, elastic.w_rank);
  } else {
    slopes = SlopesAt(problem, elastic.w_rank, -std::copysign(problem.mu, problem.u0));
    const double to_stop = -at.u / slopes.u;
    if (to_stop >= 0.0 && to_stop < at.StepToZero(slopes)) {
      at.Advance(slopes, to_stop);
      at.u = 0.0;
      slopes = SlopesAfterStop(problem, elastic.w_rank);
    }
  }
  at.Advance(slopes, at.StepToZero(slopes));
  return at;
}

CoefficientBounds EnergyOnlyBounds(const Problem& problem, const Impact& dead, const Impact& elastic) {
  const Traveller end = WhereEnergyIsBack(problem, elastic);
  CoefficientBounds bounds;
  const double tangential = end.f / end.tau;
  bounds.newton.upper = end.v / -problem.v0;
  bounds.poisson.upper = (end.tau - dead.tau1) / dead.tau1;
  bounds.energetic.upper = std::sqrt(end.work / -elastic.work_normal_compression);
  bounds.tangential = {std::min(dead.tangential, tangential), std::max(dead.tangential, tangential)};
  bounds.normal_total_n_s = {dead.tau1, end.tau};
  return bounds;
}

// n/d as a least coefficient of friction, which is not below 0; absent if d is not above 0.
std::optional<double> LeastFriction(double n, double d) {
  if (!(d > 0.0)) return std::nullopt;
  return std::max(n / d, 0.0);
}

CriticalFriction FindCriticalFriction(const Problem& problem, int w_rank) {
  const double p = std::fabs(problem.u0);
  const double w = -problem.v0;
  const double q = std::signbit(problem.u0) ? -problem.wtn : problem.wtn;
  CriticalFriction critical;
  if (problem.wtt == 0.0) return critical;
  critical.stick = std::fabs(problem.wtn) / problem.wtt;
  if (problem.u0 == 0.0) return critical;
  // At rank one slip stops just where compression ends, and what is left of these differences is rounding.
  if (w_rank == 2) {
    critical.stop_compression = LeastFriction(problem.wnn * p + w * q, w * problem.wtt + q * p);
  }
  critical.stop = LeastFriction(problem.wnn * p + 2.0 * w * q, 2.0 * w * problem.wtt + q * p);
  if (q < 0.0 && critical.stop.has_value() && *critical.stop < *critical.stick) critical.reversal = critical.stop;
  if (q > 0.0) critical.jam = problem.wnn / q;
  return critical;
}

// An infinite coefficient of friction is none.
CriticalFriction OnlyFinite(CriticalFriction critical) {
  for (auto* const one :
       {&critical.stick, &critical.stop_compression, &critical.stop, &critical.reversal, &critical.jam}) {
    if (one->has_value() && !std::isfinite(**one)) one->reset();
  }
  return critical;
}

}  // namespace

ContactBounds SolveBounds(const Problem& problem) {
  const Impact dead = SolveAt(problem, RestitutionLaw::kEnergetic, 0.0);
  const Impact elastic = SolveAt(problem, RestitutionLaw::kEnergetic, 1.0);
  ContactBounds bounds;
  bounds.regime = elastic.regime;
  bounds.w_rank = elastic.w_rank;
  if (bounds.regime == Regime::kSeparating) return bounds;
  bounds.critical = OnlyFinite(FindCriticalFriction(problem, bounds.w_rank));
  bounds.sharp = SharpBounds(problem, dead, elastic);
  bounds.energy_only = bounds.regime == Regime::kLocked ? bounds.sharp : EnergyOnlyBounds(problem, dead, elastic);
  return bounds;
}

}  // namespace ricochet::planar
