#include "core/models/compliant/compliant.h"

#include <algorithm>
#include <cmath>

#include "core/models/compliant/path.h"
#include "core/models/compliant/spring_contact.h"

namespace ricochet::compliant {
namespace {

// Powers of two that bring |v0| and Wnn to everyday size: the path is followed with v0 2^-speed and W 2^(-2 inertia),
// so that its impulses, with k = 1, are in units of 2^(speed - 2 inertia).
struct Units {
  int speed = 0;
  int inertia = 0;

  double Speed(double value) const { return std::scalbn(value, speed); }
  double Impulse(double value) const { return std::scalbn(value, speed - 2 * inertia); }
  double Work(double value) const { return std::scalbn(value, 2 * (speed - inertia)); }
};

Units UnitsOf(const PlanarProblem& problem) {
  return {.speed = std::ilogb(problem.v0), .inertia = static_cast<int>(std::floor(0.5 * std::ilogb(problem.w.nn)))};
}

PlanarProblem InUnits(const PlanarProblem& problem, const Units& units) {
  PlanarProblem scaled = problem;
  for (double* w : {&scaled.w.tt, &scaled.w.tn, &scaled.w.nn}) *w = std::scalbn(*w, -2 * units.inertia);
  for (double* speed : {&scaled.u0, &scaled.v0}) *speed = std::scalbn(*speed, -units.speed);
  return scaled;
}

Regime RegimeOf(const SpringContact& contact, const PathResult& path) {
  if (!path.Ends()) return Regime::kWedged;
  if (contact.mu == 0.0) return Regime::kFrictionless;
  if (path.first_stick == FirstStick::kNever) return Regime::kSliding;
  // At rank one Wtt = Wtn^2/Wnn, which must not be rounded on the way.
  const bool stays = contact.rank == 1 && contact.wtt > 0.0
                         ? std::fma(contact.mu, std::fabs(contact.wtn), -contact.wnn) >= 0.0
                         : std::fma(contact.mu, contact.wtt, -std::fabs(contact.wtn)) >= 0.0;
  if (path.first_stick == FirstStick::kInCompression) {
    return stays ? Regime::kStickInCompression : Regime::kReversalInCompression;
  }
  return stays ? Regime::kStickInRestitution : Regime::kReversalInRestitution;
}

double ErrorEstimate(const PlanarProblem& problem, const Units& units, const PathResult& path) {
  const double speed = std::max(std::fabs(problem.u0), std::fabs(problem.v0));
  // In units of speed the least double is 2^-1074/2^units.speed, and rounding to it takes up to half of it.
  const double rounding = std::scalbn(1.0, -1075 - units.speed);
  return (std::max(path.u_error, path.v_error) + rounding) / speed;
}

// The rounding of sums over the sections of a path, relative to their terms.
double SumRounding(const PathResult& path) { return 4.0 * kEps * (2.0 + path.sections); }

// The errors of the impulses that have led to `state`, from those of its velocities, and that of the change of energy:
// T is a function of the velocities, and changes by (u, v).d(f, tau).
struct MomentumErrors {
  ImpulseErrors impulses;
  double energy;
};
MomentumErrors ErrorsOfMomentum(const PlanarProblem& problem, const SpringContact& contact, const PathResult& path,
                                const ContactState& state, double u_error, double v_error) {
  const double w_path = (contact.wtt + std::fabs(contact.wtn)) * contact.mu * state.tau +
                        (std::fabs(contact.wtn) + contact.wnn) * state.tau;
  const double unseen = SumRounding(path) * (std::fabs(problem.u0) + std::fabs(problem.v0) + std::fabs(state.u) +
                                             std::fabs(state.v) + w_path);
  const double u_all = u_error + unseen;
  const double v_all = v_error + unseen;
  ImpulseErrors impulses = ErrorsOfImpulses(contact.wtt, contact.wtn, contact.wnn, contact.determinant, u_all, v_all);
  if (contact.mu == 0.0) impulses = {.tau = v_all / contact.wnn, .f = 0.0};
  const double energy = (std::fabs(state.u) + u_all) * impulses.f + (std::fabs(state.v) + v_all) * impulses.tau;
  return {impulses, energy};
}

// The normal impulse of a restitution that is computed as none. It returns the energy (eta F)^2/2 while v rises by at
// least Wnn - mu |Wtn| for each unit of it.
double UnseenRestitution(const SpringContact& contact, double eta, double largest_force) {
  if (eta == 0.0 || eta >= kLeastEnergetic) return 0.0;
  const double slope = contact.wnn - contact.mu * std::fabs(contact.wtn);
  return slope > 0.0 ? eta * largest_force / std::sqrt(slope) : ImpactErrors::kUnknown;
}

ImpactErrors NumberErrorsOf(const PlanarProblem& problem, const Units& units, const SpringContact& contact,
                            const PathResult& path, const Impact& impact) {
  ImpactErrors errors;
  if (!path.Ends()) return errors;
  const MomentumErrors first =
      ErrorsOfMomentum(problem, contact, path, path.compression_end, path.compression_u_error, 0.0);
  const MomentumErrors last = ErrorsOfMomentum(problem, contact, path, path.end, path.u_error, path.v_error);
  const double rounding = SumRounding(path);
  const double eta2 = problem.coefficient * problem.coefficient;
  const double force = path.largest_normal_force;
  const double stored = 0.5 * force * force;
  const double terms = rounding * (stored + std::fabs(path.end.friction_loss) +
                                   contact.mu * path.end.tau * (std::fabs(problem.u0) + std::fabs(path.end.u)) +
                                   path.end.tau * (std::fabs(problem.v0) + path.end.v));
  const double normal = path.compression_force_error * (force + path.compression_force_error) + rounding * stored;
  const bool all = path.end.normal_force == 0.0 || problem.coefficient < kLeastEnergetic;
  const double returned = all ? eta2 * (normal + rounding * stored) : ImpactErrors::kUnknown;
  ImpactEnd<double> scaled = impact;
  scaled.tau_compression = path.compression_end.tau;
  scaled.tau1 = path.end.tau;
  scaled.work_normal_compression = -stored;
  const double unseen = UnseenRestitution(contact, problem.coefficient, force);
  const double coupling = std::fabs(contact.wtn);
  errors.v = path.v_error + rounding * std::fabs(path.end.v) + (contact.wnn + contact.mu * coupling) * unseen;
  errors.tau_compression = first.impulses.tau;
  errors.tau = last.impulses.tau + unseen;
  errors.f = last.impulses.f + contact.mu * unseen;
  SetCoefficientErrors(scaled, problem.v0, RestitutionLaw::kEnergetic, problem.coefficient, errors);
  constexpr double kSmallest = 0x1p-1073;
  errors.u =
      units.Speed(path.u_error + rounding * std::fabs(path.end.u) + (coupling + contact.mu * contact.wtt) * unseen) +
      kSmallest;
  errors.v = units.Speed(errors.v) + kSmallest;
  errors.tau_compression = units.Impulse(first.impulses.tau) + kSmallest;
  errors.tau = units.Impulse(errors.tau) + kSmallest;
  errors.f = units.Impulse(errors.f) + kSmallest;
  errors.work_normal_compression = units.Work(normal) + kSmallest;
  errors.work_normal_restitution = units.Work(returned) + kSmallest;
  errors.work_tangential_compression = units.Work(first.energy + normal + terms) + kSmallest;
  errors.work_tangential_restitution = units.Work(first.energy + last.energy + returned + terms) + kSmallest;
  errors.energy_change = units.Work(last.energy + terms) + kSmallest;
  return errors;
}

void WriteMotion(const PlanarProblem& problem, const Units& units, const PathResult& path, Impact& impact) {
  const ContactState& end = path.end;
  const ContactState& compression = path.compression_end;
  impact.u1 = units.Speed(end.u) + 0.0;
  impact.v1 = units.Speed(end.v) + 0.0;
  impact.tau_compression = units.Impulse(compression.tau);
  impact.tau1 = units.Impulse(end.tau);
  impact.f_compression = units.Impulse(compression.f) + 0.0;
  impact.f1 = units.Impulse(end.f) + 0.0;
  impact.tangential = end.tau > 0.0 ? end.f / end.tau + 0.0 : 0.0;
  impact.energetic_excess = -1.0;
  if (!path.Ends() || problem.coefficient == 0.0) return;
  impact.newton = -end.v / problem.v0;
  impact.poisson = (end.tau - compression.tau) / compression.tau;
  impact.energetic = problem.coefficient;
  impact.energetic_excess = problem.coefficient - 1.0;
}

void WriteNormalWorks(const PlanarProblem& problem, const Units& units, const PathResult& path, Impact& impact) {
  const double largest = path.largest_normal_force;
  const double force = path.end.normal_force;
  // The branch of unloading gives back the energy between the largest indentation and that at the end, all of it where
  // N = 0. At eta = 0 there is no such branch.
  const bool all = force == 0.0 || problem.coefficient < kLeastEnergetic;
  const double returned = all ? largest * largest : (largest - force) * (largest + force);
  impact.work_normal_compression = units.Work(-0.5 * largest * largest);
  impact.work_normal_restitution = units.Work(0.5 * (problem.coefficient * problem.coefficient) * returned);
  // The difference of the two would lose the digits of 1 - eta^2 for eta near 1.
  const double lost = (1.0 - problem.coefficient) * (1.0 + problem.coefficient);
  impact.work_normal =
      all ? units.Work(-0.5 * lost * returned) : impact.work_normal_compression + impact.work_normal_restitution;
}

void WriteTangentialWorks(const Units& units, const SpringContact& contact, const PathResult& path, Impact& impact) {
  const ContactState& end = path.end;
  const ContactState& compression = path.compression_end;
  const double spring = contact.SpringEnergy(end);
  const double spring_before = contact.SpringEnergy(compression);
  impact.work_tangential_compression = units.Work(-(spring_before + compression.friction_loss)) + 0.0;
  impact.work_tangential_restitution =
      units.Work((spring_before - spring) - (end.friction_loss - compression.friction_loss)) + 0.0;
  impact.friction_dissipation = units.Work(end.friction_loss);
  impact.spring_energy = units.Work(spring);
}

// Forces only take energy, so that a positive change can only be rounding.
double EnergyChange(const PlanarProblem& problem, const Units& units, const ContactState& end) {
  const double twice_change = std::fma(end.f, problem.u0 + end.u, end.tau * (problem.v0 + end.v));
  return std::min(0.0, units.Work(0.5 * twice_change)) + 0.0;
}

void ScaleSections(const Units& units, std::vector<Section>& sections) {
  for (Section& section : sections) {
    section.tau = units.Impulse(section.tau);
    section.f = units.Impulse(section.f);
    section.u = units.Speed(section.u);
    section.v = units.Speed(section.v);
  }
}

}  // namespace

Impact Solve(const Problem& problem) {
  const auto& [stated, ratio_squared] = problem;
  if (stated.v0 >= 0.0) {
    auto separating = Separating<Impact>(stated.w.Rank(), stated.u0, stated.v0);
    separating.errors = NoErrors();
    return separating;
  }
  const Units units = UnitsOf(stated);
  const PlanarProblem scaled = InUnits(stated, units);
  const SpringContact contact = MakeSpringContact(scaled, ratio_squared);
  Impact impact;
  const PathResult path = FollowPath(contact, scaled.u0, scaled.v0, impact.sections);
  impact.regime = RegimeOf(contact, path);
  impact.termination = path.termination;
  impact.w_rank = contact.rank;
  WriteMotion(scaled, units, path, impact);
  WriteNormalWorks(scaled, units, path, impact);
  WriteTangentialWorks(units, contact, path, impact);
  impact.energy_change = EnergyChange(scaled, units, path.end);
  impact.error_estimate = KnownError(ErrorEstimate(scaled, units, path));
  impact.errors = NumberErrorsOf(scaled, units, contact, path, impact);
  ScaleSections(units, impact.sections);
  return impact;
}

}  // namespace ricochet::compliant
