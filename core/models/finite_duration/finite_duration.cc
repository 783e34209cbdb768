#include "core/models/finite_duration/finite_duration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/models/finite_duration/history.h"
#include "core/models/finite_duration/integrator.h"
#include "core/models/finite_duration/path.h"
#include "core/models/finite_duration/report.h"
#include "core/models/finite_duration/scaled_contact.h"
#include "core/models/finite_duration/stop_check.h"

namespace ricochet::finite_duration {
namespace {

// Rounding, relative to the sizes of the terms of a velocity.
constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();

// How far the end of a straight path that is misplaced by `shift` in the normal impulse may be off in u and v. Where slip
// stops or starts so close to the end that it may lie on the other side of it, any slope may be that of the end.
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

// Without forces, damping and springs along t, u and v are linear in tau while a mode lasts, and the integration keeps
// that to rounding. Then it can err in one thing alone, the work that restitution returns, and how much is lacking there
// follows from the velocities themselves.
double ErrorOfStraightPath(const ScaledContact& contact, const Path& path) {
  constexpr double kSafety = 1.5;
  const Motion& end = path.end;
  const double terms = std::fabs(contact.u0) + 1.0 + std::fabs(end[kU]) + end[kV];
  double error = path.cut_off[kU] + path.cut_off[kV] + kRounding * terms;
  if (end[kV] > 0.0) {
    const double lacking = std::fabs(path.straight_other_work + Square(contact.eta) * path.straight_loading_work);
    error += kSafety * ChangeOfVelocity(contact, path, lacking / end[kV]);
  }
  return error / std::max(1.0, std::fabs(contact.u0));
}

// How far u may be off beyond its own local errors because of the springs along t and n. An error of the tangential force
// swings into a velocity, and a relative one of the normal force counts as that part of the mean size of u.
double ErrorOfCompliantSlip(const ScaledContact& contact, const Path& path, double normal) {
  const double swing = std::sqrt(contact.wtt * contact.ratio_squared / contact.stiffness);
  const double mean = 0.5 * (std::fabs(contact.u0) + path.peaks.slip);
  return swing * path.local_errors[kSpringForce] + mean * normal;
}

// Local errors add up at worst in size. They grow where restitution slows down, because v^2 carries over, and they shift
// the end, up to which a_t acts. The safety covers all other growth.
double ErrorOfAnyPath(const ScaledContact& contact, const Path& path) {
  const double safety = contact.compliant ? 3.5 : 4.0;
  const Motion& end = path.end;
  const Motion& local = path.local_errors;
  const double growth = end[kV] > 0.0 ? path.peaks.restitution_speed / end[kV] : 1.0;
  // A force with a given relative error changes the velocities by that part of their change.
  const double normal = std::max(local[kPlace] / std::max(1.0, path.peaks.place), local[kV]);
  const double shift = std::fabs(contact.at) * end[kTime] * normal;
  double error = std::max(growth * normal, local[kU]) + shift;
  if (contact.compliant) {
    error = growth * std::max(normal, local[kU] + ErrorOfCompliantSlip(contact, path, normal)) + shift;
  }
  double terms = std::fabs(contact.u0) + 1.0 + (std::fabs(contact.at) + std::fabs(contact.an)) * end[kTime];
  // Springs along t and n work against each other where W is close to rank one.
  if (contact.compliant) terms += (1.0 + (contact.wtt + std::fabs(contact.wtn)) * contact.mu) * end[kNormal];
  return (safety * error + kRounding * terms) / std::max(1.0, std::fabs(contact.u0));
}

// Returns how far the velocities at the end of a path may be from the truth, over max(|u0|, |v0|).
double ErrorOf(const ScaledContact& contact, const Path& path) {
  const bool straight = contact.at == 0.0 && contact.an == 0.0 && !contact.damped && !contact.compliant;
  return straight ? ErrorOfStraightPath(contact, path) : ErrorOfAnyPath(contact, path);
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

// Integrates until the estimated error is within `tolerance`, or rounding forbids any better.
EstimatedPath FollowWithin(const ScaledContact& contact, Integrator& integrator, double tolerance, StopCheck& stop) {
  constexpr double kFirst = 0.1;
  constexpr double kTighter = 0.1;
  constexpr double kFinest = 4e-15;
  constexpr double kCoarsest = 1e-6;
  EstimatedPath result;
  result.tolerance = std::clamp(kFirst * tolerance, kFinest, kCoarsest);
  for (;;) {
    result.path = FollowPath(contact, integrator, result.tolerance, stop, nullptr);
    result.Count(result.path);
    result.error = std::numeric_limits<double>::infinity();
    if (!result.path.HasEnd()) return result;
    result.error = ErrorOf(contact, result.path);
    if (result.error <= tolerance || result.tolerance == kFinest) return result;
    const double missing = 0.5 * tolerance / result.error;
    result.tolerance = std::max(kFinest, result.tolerance * std::min(missing, kTighter));
  }
}

Impact Stopped() {
  Impact impact;
  impact.stopped = true;
  impact.termination = Termination::kRefused;
  return impact;
}

}  // namespace

bool IsAvailable() { return true; }

Impact Solve(const Problem& problem, absl::FunctionRef<bool()> stopped) {
  const PlanarProblem& stated = problem.contact;
  if (stated.v0 >= 0.0) return Separating<Impact>(stated.w.Rank(), stated.u0, stated.v0);
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
  impact.steps = found.steps;
  impact.right_hand_sides = found.right_hand_sides;
  return impact;
}

Impact Solve(const Problem& problem) {
  return Solve(problem, [] { return false; });
}

}  // namespace ricochet::finite_duration
