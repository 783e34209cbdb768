#include "core/models/finite_duration/finite_duration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/models/finite_duration/history.h"
#include "core/models/finite_duration/integrator.h"
#include "core/models/finite_duration/path.h"
#include "core/models/finite_duration/report.h"
#include "core/models/finite_duration/scaled_contact.h"
#include "core/models/finite_duration/stop_check.h"

namespace ricochet::finite_duration {
namespace {

// Rounding, relative to the sizes of the terms of a number, of all but the steps,
constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
// and with that of the steps, which goes to and fro.
double RoundingOf(const Path& path) {
  return kRounding + std::numeric_limits<double>::epsilon() * std::sqrt(static_cast<double>(path.steps));
}

// Returns the sum of the magnitudes of the terms that add up to the velocities at the end.
double TermsOf(const ScaledContact& contact, const Path& path) {
  const Motion& end = path.end;
  const double forces = (std::fabs(contact.at) + std::fabs(contact.an)) * end[kTime];
  double terms = std::fabs(contact.u0) + 1.0 + std::fabs(end[kU]) + std::fabs(end[kV]) + forces;
  // Springs along t and n work against each other where W is close to rank one.
  if (contact.compliant) terms += (1.0 + (contact.wtt + std::fabs(contact.wtn)) * contact.mu) * end[kNormal];
  return terms;
}

// Bounds the errors of u and v if the end of a straight path is misplaced by `shift` in the normal impulse. If slip
// stops or starts so close to the end that it may lie on the other side of it, any slope may hold there.
double ChangeOfVelocity(const ScaledContact& contact, const Path& path, double shift) {
  constexpr double kNear = 4.0;
  const auto& [u_slope, v_slope] = path.straight_slopes;
  const double steepness = std::max(std::fabs(u_slope), std::fabs(v_slope));
  const bool just_changed = path.straight_length <= kNear * shift;
  const bool may_stop = std::fabs(path.end[kU]) < kNear * shift * std::fabs(u_slope);
  if (!just_changed && !may_stop) return shift * steepness;
  const auto& [forward_u, forward_v] = contact.forward_slope;
  const auto& [backward_u, backward_v] = contact.backward_slope;
  return shift * std::max({steepness, std::fabs(forward_u), std::fabs(forward_v), std::fabs(backward_u),
                           std::fabs(backward_v), contact.stick_slope});
}

// Returns how far the work of restitution on a straight path is from what it has to return.
double LackingWork(const ScaledContact& contact, const Path& path) {
  return std::fabs(path.straight_other.normal + Square(contact.eta) * path.straight_loading.normal);
}

// Without forces, damping and springs along t, u and v are linear in tau while a mode lasts, and the integration keeps
// that to rounding. Then it can err in one thing alone, the work that restitution returns, and how much is lacking
// there follows from the velocities themselves.
double ErrorOfStraightPath(const ScaledContact& contact, const Path& path) {
  constexpr double kSafety = 1.5;
  const Motion& end = path.end;
  double error = path.cut_off[kU] + path.cut_off[kV] + RoundingOf(path) * TermsOf(contact, path);
  if (end[kV] > 0.0) error += kSafety * ChangeOfVelocity(contact, path, LackingWork(contact, path) / end[kV]);
  return error / std::max(1.0, std::fabs(contact.u0));
}

// Bounds the error of u that the springs along t and n add to its own local errors. An error of the tangential force
// becomes a velocity by oscillation; a relative error of the normal force counts as that part of the mean |u|.
double ErrorOfCompliantSlip(const ScaledContact& contact, const Path& path, double normal) {
  const double swing = std::sqrt(contact.wtt * contact.ratio_squared / contact.stiffness);
  const double mean = 0.5 * (std::fabs(contact.u0) + path.peaks.slip);
  return swing * path.local_errors[kSpringForce] + mean * normal;
}

// Local errors add up at worst in size. They grow where restitution slows down, because v^2 carries over, and they
// shift the end, up to which a_t acts. The safety covers all other growth.
double ErrorOfAnyPath(const ScaledContact& contact, const Path& path) {
  const double safety = contact.compliant ? 3.5 : 4.0;
  const Motion& end = path.end;
  const Motion& local = path.local_errors;
  const double growth = end[kV] > 0.0 ? path.peaks.restitution_speed / end[kV] : 1.0;
  // A relative error of a force causes the same relative error of the change of velocity.
  const double normal = std::max(local[kPlace] / std::max(1.0, path.peaks.place), local[kV]);
  const double shift = std::fabs(contact.at) * end[kTime] * normal;
  // A relative error of the normal force is one of what the contact has changed the slip by since it last stopped.
  const bool never_stops = path.first_stop == FirstStop::kNever;
  const double by_contact = never_stops ? end[kU] - contact.u0 - contact.at * end[kTime] : end[kU];
  double error = std::max(growth * normal, local[kU] + std::fabs(by_contact) * normal) + shift;
  if (contact.compliant) {
    error = growth * std::max(normal, local[kU] + ErrorOfCompliantSlip(contact, path, normal)) + shift;
  }
  // The local errors contain the rounding of the steps.
  return (safety * error + kRounding * TermsOf(contact, path)) / std::max(1.0, std::fabs(contact.u0));
}

// True if finite forces press the contact together where it parts, at a velocity that may be nothing but error. The
// true contact may then be pressed on and part at another time. Without restitution a contact parts where compression
// ends.
bool MayNotPart(const ScaledContact& contact, const Path& path, double error) {
  return path.how == PathEnd::kParted && contact.an < 0.0 && contact.eta != 0.0 &&
         path.end[kV] <= error * std::max(1.0, std::fabs(contact.u0));
}

// Returns how far the velocities at the end of a path may be from the truth, over max(|u0|, |v0|); infinite if unknown.
double ErrorOf(const ScaledContact& contact, const Path& path) {
  const double error = contact.IsStraight() ? ErrorOfStraightPath(contact, path) : ErrorOfAnyPath(contact, path);
  return MayNotPart(contact, path, error) ? ImpactErrors::kUnknown : KnownError(error);
}

// The errors of all numbers, from the error of the velocities over max(|u0|, |v0|). Impulses follow from velocities by
// W (f, tau) = d(u, v), unless finite forces add to them; works of friction from the change of energy and the normal
// work.
ImpactErrors NumberErrorsOf(const Problem& problem, const ScaledContact& contact, const Path& path, double error,
                            const Impact& impact) {
  ImpactErrors errors;
  if (!path.HasEnd() || path.how == PathEnd::kHeld) return errors;
  const bool forces = contact.at != 0.0 || contact.an != 0.0;
  const Motion& end = path.end;
  const Motion& middle = path.compression;
  const double eta2 = Square(contact.eta);
  const double velocity = error * std::max(1.0, std::fabs(contact.u0));
  const double determinant = contact.rank == 2 ? contact.stick_slope * contact.wtt : 0.0;
  const auto impulses_of = [&](double velocities) -> ImpulseErrors {
    if (forces) return {};
    if (contact.smooth) return {.tau = velocities, .f = 0.0};
    return ErrorsOfImpulses(contact.wtt, contact.wtn, 1.0, determinant, velocities, velocities);
  };
  const ImpulseErrors impulses = impulses_of(velocity);
  // The impulses err as the estimate of the velocities does, which is no bound.
  constexpr double kOfEnergy = 2.0;
  // The part that is cut off a velocity stays in the impulses, which then act on the velocities before as well.
  const ImpulseErrors kept = impulses_of(path.cut_off[kU] + path.cut_off[kV]);
  const double energy =
      kOfEnergy * ((std::fabs(end[kU]) + velocity) * impulses.f + (std::fabs(end[kV]) + velocity) * impulses.tau) +
      (std::fabs(contact.u0) + std::fabs(end[kU]) + velocity) * kept.f + (1.0 + std::fabs(end[kV])) * kept.tau;
  const double middle_energy = (std::fabs(middle[kU]) + velocity) * impulses.f + velocity * impulses.tau;
  const double sums = RoundingOf(path) * (end[kNormal] * (1.0 + end[kV]) +
                                          contact.mu_static * end[kNormal] * (std::fabs(contact.u0) + path.peaks.slip));
  double normal = 0.0, returned = 0.0, tangential = 0.0, tangential_returned = 0.0;
  if (contact.IsStraight()) {
    normal = impulses.tau + velocity * middle[kNormal] + sums;
    // Without restitution nothing is returned, whatever is known of compression.
    returned = (eta2 > 0.0 ? eta2 * normal : 0.0) + LackingWork(contact, path) + sums;
    tangential = middle_energy + normal + sums;
    tangential_returned = energy + middle_energy + returned + sums;
  } else {
    // The works are integrated, with local errors of their own, along forces and velocities that err.
    constexpr double kSafety = 4.0;
    const double open =
        std::fabs(impact.work_normal_compression + impact.work_normal_restitution + impact.work_tangential_compression +
                  impact.work_tangential_restitution - impact.energy_change) /
        contact.Energy();
    const double swing = velocity * end[kNormal] * (1.0 + std::fabs(contact.u0));
    normal = returned = kSafety * path.local_errors[kNormalWork] + 2.0 * swing + open + sums;
    tangential = tangential_returned =
        kSafety * path.local_errors[kTangentWork] + 2.0 * (1.0 + contact.mu_static) * swing + open + sums;
  }
  ImpactEnd<double> scaled = impact;
  scaled.tau_compression = middle[kNormal];
  scaled.tau1 = end[kNormal];
  scaled.work_normal_compression = path.compression[kNormalWork];
  errors.v = velocity;
  errors.tau_compression = errors.tau = impulses.tau;
  errors.f = impulses.f;
  errors.work_normal_compression = normal;
  errors.work_normal_restitution = returned;
  const RestitutionLaw law = RestitutionLaw::kEnergetic;
  SetCoefficientErrors(scaled, -1.0, law, contact.damped ? -1.0 : problem.contact.coefficient, errors);
  constexpr double kSmallest = 0x1p-1073;
  const double energy_unit = contact.Energy();
  errors.u = contact.speed * velocity + kSmallest;
  errors.v = contact.speed * velocity + kSmallest;
  errors.tau_compression = errors.tau = contact.Impulse() * impulses.tau + kSmallest;
  errors.f = contact.Impulse() * impulses.f + kSmallest;
  errors.work_normal_compression = energy_unit * normal + kSmallest;
  errors.work_normal_restitution = energy_unit * returned + kSmallest;
  errors.work_tangential_compression = energy_unit * tangential + kSmallest;
  errors.work_tangential_restitution = energy_unit * tangential_returned + kSmallest;
  const double all = normal + returned + tangential + tangential_returned;
  errors.energy_change = energy_unit * (contact.IsStraight() ? energy + sums : all) + kSmallest;
  return errors;
}

struct EstimatedPath {
  Path path;
  double tolerance = 0.0;  // The tolerance of the integration.
  double error = 0.0;
  int64_t steps = 0, right_hand_sides = 0;  // Sums over all integrations.

  void Count(const Path& other) {
    steps += other.steps;
    right_hand_sides += other.right_hand_sides;
  }
};

constexpr double kFinest = 1e-14;
constexpr double kMiddle = 1e-9;

// Returns the tolerance at which a path that has no end at those in `tried` is followed again; nothing if no other may
// find one.
std::optional<double> NextTry(PathEnd how, const std::vector<double>& tried) {
  if (how != PathEnd::kBudgetUsedUp) return std::nullopt;
  // A path of many sticks and slips uses up its budget only if it is fine. If a force far exceeds that of the impact, a
  // small rest of the energy decides whether the bodies separate, which only a fine path resolves.
  if (tried.size() == 1) return kMiddle;
  return tried.front() == kFinest || tried.back() == kFinest ? std::nullopt : std::optional(kFinest);
}

// Integrates until the estimated error is within `tolerance`, or rounding forbids any better.
EstimatedPath FollowWithin(const ScaledContact& contact, Integrator& integrator, double tolerance, StopCheck& stop) {
  constexpr double kFirst = 0.1;
  constexpr double kTighter = 0.1;
  constexpr double kCoarsest = 1e-10;
  EstimatedPath result;
  std::vector<double> without_end;
  double next = std::clamp(kFirst * tolerance, kFinest, kCoarsest);
  for (;;) {
    Path path = FollowPath(contact, integrator, next, stop, nullptr);
    result.Count(path);
    const bool had_end = result.path.HasEnd();
    // A finer path that finds no end says less than the coarser one before it, if that one is known to end.
    if (!path.HasEnd() && had_end && std::isfinite(result.error)) return result;
    result.path = std::move(path);
    result.tolerance = next;
    if (!result.path.HasEnd()) {
      result.error = std::numeric_limits<double>::infinity();
      without_end.push_back(next);
      const std::optional<double> again = NextTry(result.path.how, without_end);
      if (had_end || !again.has_value() || stop.WasStopped()) return result;
      next = *again;
      continue;
    }
    result.error = ErrorOf(contact, result.path);
    if (result.error <= tolerance || !without_end.empty() || next == kFinest) return result;
    next = std::max(kFinest, next * std::min(0.5 * tolerance / result.error, kTighter));
  }
}

Impact Stopped() {
  Impact impact;
  impact.stopped = true;
  impact.termination = Termination::kRefused;
  return impact;
}

}  // namespace

Impact Solve(const Problem& problem, absl::FunctionRef<bool()> stopped) {
  const PlanarProblem& stated = problem.contact;
  if (stated.v0 >= 0.0) {
    auto separating = Separating<Impact>(stated.w.Rank(), stated.u0, stated.v0);
    separating.errors = NoErrors();
    return separating;
  }
  const ScaledContact contact = MakeScaledContact(problem);
  Integrator integrator(contact);
  StopCheck stop(stopped);
  EstimatedPath found = FollowWithin(contact, integrator, problem.tolerance, stop);
  if (stop.WasStopped()) return Stopped();
  Impact impact = MakeImpact(problem, contact, found.path);
  if (problem.intervals > 0) {
    HistoryRecorder history(contact, integrator, problem.intervals, found.path.end[kTime]);
    found.Count(FollowPath(contact, integrator, found.tolerance, stop, &history));
    if (stop.WasStopped()) return Stopped();
    impact.contact.history = InUnitsOfScene(contact, history.samples());
  }
  impact.error_estimate = found.error;
  impact.errors = NumberErrorsOf(problem, contact, found.path, found.error, impact);
  impact.steps = found.steps;
  impact.right_hand_sides = found.right_hand_sides;
  return impact;
}

}  // namespace ricochet::finite_duration
