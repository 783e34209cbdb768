#include "core/models/finite_duration/report.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/elementary.h"

namespace ricochet::finite_duration {
namespace {

Regime RegimeOf(const ScaledContact& contact, const Path& path) {
  if (!path.HasEnd()) return Regime::kWedged;
  if (path.how == PathEnd::kHeld) return Regime::kLocked;
  if (contact.smooth || (contact.mu == 0.0 && !path.ever_sticks)) return Regime::kFrictionless;
  switch (path.first_stop) {
    case FirstStop::kNever:
      return Regime::kSliding;
    case FirstStop::kInCompression:
      return path.first_stop_sticks ? Regime::kStickInCompression : Regime::kReversalInCompression;
    case FirstStop::kInRestitution:
      break;
  }
  return path.first_stop_sticks ? Regime::kStickInRestitution : Regime::kReversalInRestitution;
}

Termination TerminationOf(const Path& path) {
  if (path.HasEnd()) return Termination::kConverged;
  return path.how == PathEnd::kBudgetUsedUp ? Termination::kBudgetUsedUp : Termination::kRefused;
}

void WriteCoefficients(double coefficient, const ScaledContact& contact, const Path& path, Impact& impact) {
  impact.energetic_excess = -1.0;
  impact.tangential = path.end[kNormal] > 0.0 ? path.end[kTangential] / path.end[kNormal] : 0.0;
  if (path.how == PathEnd::kHeld || contact.eta == 0.0) return;
  impact.newton = path.end[kV];
  // If forces press far harder than the approach, the impulse of compression may round to 0.
  if (path.compression[kNormal] == 0.0) return;
  impact.poisson = (path.end[kNormal] - path.compression[kNormal]) / path.compression[kNormal];
  if (!contact.damped) {
    impact.energetic = coefficient;
    impact.energetic_excess = coefficient - 1.0;
    return;
  }
  // Damping and the energy left in the spring are lost; their ratio to the work of compression cancels nothing.
  const double p = contact.exponent + 1.0;
  const double left = contact.stiffness * Pow(Indentation(contact, {}, path.end), p) / p;
  const double lost = (path.end[kDampingLoss] + left) / -path.compression[kNormalWork];
  impact.energetic = std::sqrt(std::max(0.0, 1.0 - lost));
  impact.energetic_excess = std::max(-1.0, -lost / (1.0 + impact.energetic));
}

void WriteWorks(const ScaledContact& contact, const Path& path, Impact& impact) {
  const Motion& end = path.end;
  const double unit = contact.Energy();
  // Where velocities are linear in tau, the works follow from those at the changes of mode, and not from an integral
  // that has errors of its own.
  Works compression = path.straight_loading;
  Works restitution = path.straight_other;
  if (!contact.IsStraight()) {
    compression = {path.compression[kNormalWork], path.compression[kTangentWork]};
    restitution = {end[kNormalWork] - compression.normal, end[kTangentWork] - compression.tangential};
  }
  impact.work_normal_compression = unit * compression.normal;
  impact.work_normal_restitution = unit * restitution.normal;
  impact.work_tangential_compression = unit * compression.tangential;
  impact.work_tangential_restitution = unit * restitution.tangential;
  const double half_time = 0.5 * end[kTime];
  const double by_velocity = 0.5 * (end[kTangential] * (contact.u0 + end[kU]) + end[kNormal] * (end[kV] - 1.0));
  const double by_force = contact.at * (half_time * end[kTangential] - end[kTangentMoment]) +
                          contact.an * (half_time * end[kNormal] - end[kNormalMoment]);
  impact.energy_change = unit * (by_velocity + by_force);
  impact.friction_dissipation =
      unit * (contact.IsStraight() ? 0.0 - (compression.tangential + restitution.tangential) : end[kFrictionLoss]);
  // Without a tangential spring the quotient may be 0/0, which is NaN.
  const double compliance = contact.ratio_squared == 0.0 ? 0.0 : contact.ratio_squared / contact.stiffness;
  impact.spring_energy = unit * 0.5 * compliance * Square(path.spring_force);
}

// Among the ends of compression only the last is reported.
void WriteEvents(const ScaledContact& contact, const Path& path, Impact& impact) {
  const auto is_end = [](const Instant& instant) { return instant.kind == EventKind::kCompressionEnds; };
  const auto last = std::find_if(path.events.rbegin(), path.events.rend(), is_end);
  for (auto instant = path.events.begin(); instant != path.events.end(); ++instant) {
    if (is_end(*instant) && instant + 1 != last.base()) continue;
    const Motion& y = instant->y;
    TimedInstant& event = impact.events.emplace_back();
    event.kind = instant->kind;
    event.tau = contact.Impulse() * y[kNormal];
    event.f = contact.Impulse() * y[kTangential];
    event.u = contact.speed * y[kU];
    event.v = contact.speed * y[kV];
    event.time_s = contact.time * y[kTime];
  }
}

void WriteDuration(const ScaledContact& contact, const Path& path, ContactDuration& duration) {
  duration.duration_s = contact.time * path.end[kTime];
  duration.peak_normal_n = contact.Force() * path.peaks.normal;
  duration.peak_tangential_n = contact.Force() * path.peaks.tangential;
  duration.indentation_m = contact.Length() * path.peaks.indentation;
}

}  // namespace

Impact MakeImpact(const Problem& problem, const ScaledContact& contact, const Path& path) {
  const double impulse = contact.Impulse();
  Impact impact;
  impact.regime = RegimeOf(contact, path);
  impact.w_rank = contact.rank;
  impact.u1 = contact.speed * path.end[kU];
  impact.v1 = contact.speed * path.end[kV];
  impact.tau_compression = impulse * path.compression[kNormal];
  impact.tau1 = impulse * path.end[kNormal];
  impact.f_compression = impulse * path.compression[kTangential];
  impact.f1 = impulse * path.end[kTangential];
  impact.termination = TerminationOf(path);
  WriteCoefficients(problem.contact.coefficient, contact, path, impact);
  WriteWorks(contact, path, impact);
  WriteEvents(contact, path, impact);
  WriteDuration(contact, path, impact.contact);
  return impact;
}

std::vector<ForceSample> InUnitsOfScene(const ScaledContact& contact, const std::vector<ForceSample>& samples) {
  std::vector<ForceSample> history;
  for (const ForceSample& sample : samples) {
    history.push_back({.time_s = contact.time * sample.time_s,
                       .tangential_n = contact.Force() * sample.tangential_n,
                       .normal_n = contact.Force() * sample.normal_n,
                       .indentation_m = contact.Length() * sample.indentation_m,
                       .tangential_m_s = contact.speed * sample.tangential_m_s,
                       .normal_m_s = contact.speed * sample.normal_m_s});
  }
  return history;
}

}  // namespace ricochet::finite_duration
