#include "core/bounds/contact_bounds.h"

#include <algorithm>
#include <cmath>

#include "core/contact/critical_friction.h"
#include "core/models/restitution_law.h"

namespace ricochet::planar {
namespace {

Impact SolveAt(Problem problem, RestitutionLaw law, double coefficient) {
  problem.law = law;
  problem.coefficient = coefficient;
  return Solve(problem);
}

// Returns the largest double, or one a few doubles below it, that is <= `bound` and that Solve accepts as admissible.
double LargestAdmissible(const Problem& problem, RestitutionLaw law, double bound) {
  const auto is_refused = [&] {
    const Impact impact = SolveAt(problem, law, bound);
    return impact.sharp_limit_broken || !impact.Converged();
  };
  for (double step = 0x1p-53; is_refused(); step *= 2.0) {
    bound = std::nextafter(bound - step * bound, 0.0);
  }
  return bound;
}

CoefficientBounds SharpBounds(const Problem& problem, const Impact& plastic, const Impact& elastic) {
  CoefficientBounds bounds;
  if (elastic.regime != Regime::kLocked) {
    bounds.newton.upper = LargestAdmissible(problem, RestitutionLaw::kNewton, elastic.newton);
    bounds.poisson.upper = LargestAdmissible(problem, RestitutionLaw::kPoisson, elastic.poisson);
    bounds.energetic.upper = 1.0;
  }
  bounds.tangential = {std::min(plastic.tangential, elastic.tangential),
                       std::max(plastic.tangential, elastic.tangential)};
  bounds.normal_total_n_s = {plastic.tau1, elastic.tau1};
  return bounds;
}

// Slopes holds d(u, v, f)/dtau; `power` is the slope of E' = dE/dtau.
struct Slopes {
  double u, v, f, power;
};

Slopes SlopesAt(const Problem& problem, int w_rank, double f) {
  const double v = std::fma(f, problem.w.tn, problem.w.nn);
  const double square = problem.w.tn * problem.w.tn;
  const double square_error = std::fma(problem.w.tn, problem.w.tn, -square);
  const double det = w_rank == 1 ? 0.0 : std::fma(problem.w.tt, problem.w.nn, -square) - square_error;
  const double u = w_rank == 1 ? v * problem.w.tn / problem.w.nn : std::fma(f, problem.w.tt, problem.w.tn);
  // (f, 1) W (f, 1)^T with its square completed, so that nothing cancels.
  return {.u = u, .v = v, .f = f, .power = (v * v + f * f * det) / problem.w.nn};
}

// The slopes after slip has stopped.
Slopes SlopesAfterStop(const Problem& problem, int w_rank) {
  const double coupling = std::fabs(problem.w.tn);
  const bool sticks =
      w_rank == 2 ? coupling <= problem.mu_static * problem.w.tt : problem.w.nn <= problem.mu_static * coupling;
  if (sticks && w_rank == 1) return {.u = 0.0, .v = 0.0, .f = -problem.w.nn / problem.w.tn, .power = 0.0};
  if (!sticks) return SlopesAt(problem, w_rank, -std::copysign(problem.mu, problem.w.tn));
  Slopes slopes = SlopesAt(problem, w_rank, -problem.w.tn / problem.w.tt);
  slopes.u = 0.0;
  slopes.v = slopes.power;
  return slopes;
}

// EnergyWalk follows the path up to the point at which the kinetic energy equals that before the impact.
struct EnergyWalk {
  double tau, f, u, v;
  double energy;  // E - E- <= 0, J
  double work;    // The normal work of restitution, J

  void Advance(const Slopes& slopes, double step) {
    const double v_new = v + slopes.v * step;
    work += 0.5 * step * (v + v_new);
    energy += step * (slopes.f * u + v + 0.5 * step * slopes.power);
    tau += step;
    f += slopes.f * step;
    u += slopes.u * step;
    v = v_new;
  }

  // Returns the step along `slopes` after which `energy` is 0.
  double StepToZero(const Slopes& slopes) const {
    const double power = slopes.f * u + v;
    const double root = std::sqrt(power * power - 2.0 * energy * slopes.power);
    return power > 0.0 ? -2.0 * energy / (power + root) : (root - power) / slopes.power;
  }
};

// Walks from the end of the elastic impact to the point at which the kinetic energy equals that before the impact.
EnergyWalk WhereEnergyIsBack(const Problem& problem, const Impact& elastic) {
  EnergyWalk at = {.tau = elastic.tau1,
                   .f = elastic.f1,
                   .u = elastic.u1,
                   .v = elastic.v1,
                   .energy = std::min(elastic.energy_change, 0.0),
                   .work = elastic.work_normal_restitution};
  Slopes slopes;
  if (problem.w.tt == 0.0) {
    slopes = SlopesAt(problem, elastic.w_rank, problem.u0 == 0.0 ? 0.0 : -std::copysign(problem.mu, problem.u0));
  } else if (HasEvent(elastic, EventKind::kSlipStops) || problem.u0 == 0.0) {
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

CoefficientBounds EnergyOnlyBounds(const Problem& problem, const Impact& plastic, const Impact& elastic) {
  const EnergyWalk end = WhereEnergyIsBack(problem, elastic);
  CoefficientBounds bounds;
  const double tangential = end.f / end.tau;
  bounds.newton.upper = end.v / -problem.v0;
  bounds.poisson.upper = (end.tau - plastic.tau1) / plastic.tau1;
  bounds.energetic.upper = std::sqrt(end.work / -elastic.work_normal_compression);
  bounds.tangential = {std::min(plastic.tangential, tangential), std::max(plastic.tangential, tangential)};
  bounds.normal_total_n_s = {plastic.tau1, end.tau};
  return bounds;
}

CriticalFriction Critical(const Problem& problem) {
  const auto is_positive = [](double x) { return x > 0.0; };
  auto critical =
      FindCriticalFriction<CriticalFriction>(problem.w.tt, problem.w.tn, problem.w.nn, problem.u0, problem.v0,
                                             !problem.w.UFollowsV(problem.u0, problem.v0), is_positive);
  for (auto* const one :
       {&critical.stick, &critical.stop_compression, &critical.stop, &critical.reversal, &critical.jam}) {
    // An infinite coefficient means that no finite friction is critical in this way.
    if (one->has_value() && !std::isfinite(**one)) one->reset();
  }
  return critical;
}

}  // namespace

Bounds SolveBounds(const Problem& problem) {
  const Impact plastic = SolveAt(problem, RestitutionLaw::kEnergetic, 0.0);
  const Impact elastic = SolveAt(problem, RestitutionLaw::kEnergetic, 1.0);
  Bounds bounds;
  bounds.regime = elastic.regime;
  bounds.energy_only = CoefficientBounds();
  if (bounds.regime == Regime::kSeparating || bounds.regime == Regime::kWedged) return bounds;
  bounds.critical = Critical(problem);
  bounds.sharp = SharpBounds(problem, plastic, elastic);
  bounds.energy_only = bounds.regime == Regime::kLocked ? bounds.sharp : EnergyOnlyBounds(problem, plastic, elastic);
  return bounds;
}

}  // namespace ricochet::planar
