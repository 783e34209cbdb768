#include "core/models/finite_duration/finite_duration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/models/finite_duration/integrator.h"
#include "core/models/finite_duration/motion.h"
#include "core/models/finite_duration/path.h"
#include "core/numerics/elementary.h"

namespace ricochet::finite_duration {
namespace {

// How far the velocities at the end of a path are from the truth, over max(|u0|, |v0|). Local errors add up at worst in
// size. They grow where restitution slows down, as it is v^2 that carries over, and shift the end, up to which a_t
// acts. The safety is for all other growth; without forces, damping and springs along t each piece of the path is
// straight.
double ErrorOf(const Contact& contact, const Path& path) {
  const bool straight = contact.at == 0.0 && contact.an == 0.0 && !contact.damped && !contact.compliant;
  const double safety = straight ? 2.0 : 4.0;
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
  const Motion& end = path.end;
  const Motion& local = path.local_errors;
  const double growth = end[kV] > 0.0 ? path.fastest / end[kV] : 1.0;
  // A force that is wrong by a part of itself changes the velocities by that part.
  const double normal = std::max(local[kPlace] / std::max(1.0, path.largest_place), local[kV]);
  const double shift = std::fabs(contact.at) * end[kTime] * normal;
  const double error = std::max(growth * normal, local[kU]) + shift;
  double terms = std::fabs(contact.u0) + 1.0 + (std::fabs(contact.at) + std::fabs(contact.an)) * end[kTime];
  // Springs along t and n work against each other where W is close to rank one.
  if (contact.compliant) terms += (1.0 + (contact.wtt + std::fabs(contact.wtn)) * contact.mu) * end[kNormal];
  return (safety * error + kRounding * terms) / std::max(1.0, std::fabs(contact.u0));
}

struct Estimated {
  Path path;
  double tolerance = 0.0;  // Of the integration.
  double error = 0.0;
  int64_t steps = 0, right_hand_sides = 0;
};

// Integrates until the estimated error is within `tolerance`, or rounding forbids any better.
Estimated FollowWithin(const Contact& contact, Integrator& integrator, double tolerance) {
  constexpr double kFirst = 0.1;
  constexpr double kTighter = 0.1;
  constexpr double kFinest = 4e-15;
  constexpr double kCoarsest = 1e-6;
  Estimated result;
  result.tolerance = std::clamp(kFirst * tolerance, kFinest, kCoarsest);
  for (;;) {
    result.path = Follow(contact, integrator, result.tolerance, nullptr);
    const Path& path = result.path;
    result.steps += path.steps;
    result.right_hand_sides += path.right_hand_sides;
    result.error = std::numeric_limits<double>::infinity();
    if (!(path.parted || path.held)) return result;
    result.error = ErrorOf(contact, path);
    if (result.error <= tolerance || result.tolerance == kFinest) return result;
    const double missing = 0.5 * tolerance / result.error;
    result.tolerance = std::max(kFinest, result.tolerance * std::min(missing, kTighter));
  }
}

Regime RegimeOf(const Contact& contact, const Path& path) {
  if (!path.parted && !path.held) return Regime::kWedged;
  if (path.held) return Regime::kLocked;
  if (contact.smooth || (contact.mu == 0.0 && !path.ever_sticks)) return Regime::kFrictionless;
  switch (path.stop) {
    case Stop::kNever:
      return Regime::kSliding;
    case Stop::kInCompression:
      return path.first_stop_sticks ? Regime::kStickInCompression : Regime::kReversalInCompression;
    case Stop::kInRestitution:
      break;
  }
  return path.first_stop_sticks ? Regime::kStickInRestitution : Regime::kReversalInRestitution;
}

void WriteCoefficients(const Problem& problem, const Contact& contact, const Path& path, Impact& impact) {
  impact.energetic_excess = -1.0;
  impact.tangential = path.end[kNormal] > 0.0 ? path.end[kTangential] / path.end[kNormal] : 0.0;
  if (path.held || contact.eta == 0.0) return;
  impact.newton = path.end[kV];
  impact.poisson = (path.end[kNormal] - path.compression[kNormal]) / path.compression[kNormal];
  if (!contact.damped) {
    impact.energetic = problem.energetic;
    impact.energetic_excess = problem.energetic - 1.0;
    return;
  }
  // Damping and what the spring still holds are lost of the work of compression, without a difference that cancels.
  const double p = contact.exponent + 1.0;
  const double left = contact.stiffness * Pow(Indentation(contact, {}, path.end), p) / p;
  const double lost = (path.end[kDampingLoss] + left) / -path.compression_works.normal;
  impact.energetic = std::sqrt(std::max(0.0, 1.0 - lost));
  impact.energetic_excess = -lost / (1.0 + impact.energetic);
}

void WriteWorks(const Contact& contact, const Path& path, Impact& impact) {
  const Motion& end = path.end;
  const double unit = contact.Energy();
  const Works& compression = path.compression_works;
  impact.work_normal_compression = unit * compression.normal;
  impact.work_normal_restitution = unit * (end[kNormalWork] - compression.normal);
  impact.work_tangential_compression = unit * compression.tangential;
  impact.work_tangential_restitution = unit * (end[kTangentWork] - compression.tangential);
  const double half_time = 0.5 * end[kTime];
  const double by_velocity = 0.5 * (end[kTangential] * (contact.u0 + end[kU]) + end[kNormal] * (end[kV] - 1.0));
  const double by_force = contact.at * (half_time * end[kTangential] - end[kTangentMoment]) +
                          contact.an * (half_time * end[kNormal] - end[kNormalMoment]);
  impact.energy_change = unit * (by_velocity + by_force);
  impact.friction_dissipation = unit * end[kFrictionLoss];
  impact.spring_energy = unit * 0.5 * (contact.ratio_squared / contact.stiffness) * Square(path.spring_force);
}

void WriteEvents(const Contact& contact, const Path& path, Impact& impact) {
  const auto is_end = [](const Instant& instant) { return instant.kind == EventKind::kCompressionEnds; };
  const auto last = std::find_if(path.events.rbegin(), path.events.rend(), is_end);
  for (auto instant = path.events.begin(); instant != path.events.end(); ++instant) {
    if (is_end(*instant) && instant + 1 != last.base()) continue;
    const Motion& y = instant->y;
    Event& event = impact.events.emplace_back();
    event.kind = instant->kind;
    event.state.normal_impulse_n_s = contact.Impulse() * y[kNormal];
    event.state.tangential_impulse_n_s = {contact.Impulse() * y[kTangential]};
    event.state.contact_velocity = {{contact.speed * y[kU]}, contact.speed * y[kV]};
  }
}

void WriteContact(const Contact& contact, const Path& path, const History& history, Impact& impact) {
  ContactDuration& duration = impact.contact;
  duration.duration_s = contact.time * path.end[kTime];
  duration.peak_normal_n = contact.Force() * path.peak_normal;
  duration.peak_tangential_n = contact.Force() * path.peak_tangential;
  duration.indentation_m = contact.Length() * path.indentation;
  for (const ForceSample& sample : history.samples) {
    duration.history.push_back({.time_s = contact.time * sample.time_s,
                                .tangential_n = contact.Force() * sample.tangential_n,
                                .normal_n = contact.Force() * sample.normal_n,
                                .indentation_m = contact.Length() * sample.indentation_m,
                                .tangential_m_s = contact.speed * sample.tangential_m_s,
                                .normal_m_s = contact.speed * sample.normal_m_s});
  }
}

Impact MakeImpact(const Problem& problem, const Contact& contact, const Estimated& found, const History& history) {
  const Path& path = found.path;
  const double impulse = contact.Impulse();
  Impact impact;
  impact.regime = RegimeOf(contact, path);
  impact.w_rank = RankOf(problem);
  impact.u1 = contact.speed * path.end[kU];
  impact.v1 = contact.speed * path.end[kV];
  impact.tau_compression = impulse * path.compression[kNormal];
  impact.tau1 = impulse * path.end[kNormal];
  impact.f_compression = impulse * path.compression[kTangential];
  impact.f1 = impulse * path.end[kTangential];
  WriteCoefficients(problem, contact, path, impact);
  WriteWorks(contact, path, impact);
  impact.error_estimate = found.error;
  impact.converged = path.parted || path.held;
  impact.steps = found.steps;
  impact.right_hand_sides = found.right_hand_sides;
  WriteEvents(contact, path, impact);
  WriteContact(contact, path, history, impact);
  return impact;
}

}  // namespace

Impact Solve(const Problem& problem) {
  if (problem.v0 >= 0.0) return Separating<Impact>(RankOf(problem), problem.u0, problem.v0);
  const Contact contact = MakeContact(problem);
  Integrator integrator(contact);
  Estimated found = FollowWithin(contact, integrator, problem.tolerance);
  History history = {.intervals = problem.intervals, .duration = found.path.end[kTime]};
  if (problem.intervals > 0) {
    const Path path = Follow(contact, integrator, found.tolerance, &history);
    found.steps += path.steps;
    found.right_hand_sides += path.right_hand_sides;
  }
  return MakeImpact(problem, contact, found, history);
}

}  // namespace ricochet::finite_duration
