#include "core/models/finite_duration/scaled_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "core/base/invariant.h"
#include "core/numerics/elementary.h"

namespace ricochet::finite_duration {
namespace {

struct Curve {
  double stiffness = 0.0, exponent = 1.0, damping = 0.0;
  bool damped = false;
};

struct CurveOf {
  Curve operator()(std::monostate) const {
    StopOnBrokenInvariant("a contact of finite duration has a normal spring", __FILE__, __LINE__);
  }
  Curve operator()(const LinearSpring& spring) const { return {.stiffness = spring.stiffness_n_m}; }
  Curve operator()(const HertzSpring& spring) const { return {.stiffness = spring.stiffness_n_m1_5, .exponent = 1.5}; }
  Curve operator()(const HuntCrossleySpring& spring) const {
    return {spring.stiffness_n_m_p, spring.exponent, spring.damping_s_m, true};
  }
};

// Solves k Wnn |v0|^(p-1) T^(p+1) = 1 for T, root by root, so that no power leaves the range of doubles.
double NaturalTime(const Curve& curve, double wnn, double speed) {
  const double root = 1.0 / (curve.exponent + 1.0);
  return Pow(curve.stiffness, -root) * Pow(wnn, -root) * Pow(speed, -(curve.exponent - 1.0) * root);
}

void SetUnits(const Problem& problem, ScaledContact& contact) {
  const Curve curve = std::visit(CurveOf(), problem.spring);
  contact.exponent = curve.exponent;
  contact.rooted = curve.exponent != 1.0;
  contact.damped = curve.damped;
  contact.speed = -problem.contact.v0;
  contact.time = NaturalTime(curve, problem.contact.w.nn, contact.speed);
  const double turn = contact.speed / problem.normal_acceleration;
  if (turn > 0.0 && turn < contact.time) {
    contact.stiffness = Pow(turn / contact.time, curve.exponent + 1.0);
    contact.time = turn;
  }
  contact.mass = 1.0 / problem.contact.w.nn;
  contact.damping = curve.damping * contact.speed;
  const bool returns = Square(problem.contact.coefficient) >= std::numeric_limits<double>::min();
  contact.eta = curve.damped ? 1.0 : returns ? problem.contact.coefficient : 0.0;
}

// The slope of slip towards +t for mu > 0, towards -t for mu < 0.
Acceleration SlopeOf(const PlanarProblem& problem, double mu) {
  return {std::fma(-mu, problem.w.tt, problem.w.tn) / problem.w.nn,
          std::fma(-mu, problem.w.tn, problem.w.nn) / problem.w.nn};
}

// Tells whether finite forces move u off v Wtn/Wnn by no more than rounding, of them or of u0, and underflow do.
bool ForcesFollow(const ScaledContact& contact, double in_range) {
  constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
  const double terms = std::fabs(contact.at) + std::fabs(in_range) + std::fabs(contact.u0);
  const double underflow = kSmallest + kSmallest * std::max(contact.time, 1.0) / contact.speed;
  return std::fabs(contact.at - in_range) <= kRangeTolerance * terms + underflow * (1.0 + std::fabs(contact.wtn));
}

void SetInertia(const PlanarProblem& problem, ScaledContact& contact) {
  contact.rank = problem.w.Rank();
  contact.wtn = problem.w.tn / problem.w.nn;
  contact.wtt = problem.w.tt / problem.w.nn;
  contact.forward_slope = SlopeOf(problem, problem.mu);
  contact.backward_slope = SlopeOf(problem, -problem.mu);
  contact.stick_slope = problem.w.RelativeDeterminant();
  if (contact.rank == 2) return;
  contact.wtt = Square(contact.wtn);
  contact.stick_slope = 0.0;
  if (problem.w.tn == 0.0) return;
  // W counts as Wnn (g, 1)(g, 1)^T, whatever its entries are rounded to.
  contact.forward_slope.u = contact.wtn * contact.forward_slope.v;
  contact.backward_slope.u = contact.wtn * contact.backward_slope.v;
  if (!problem.w.UFollowsV(problem.u0, problem.v0)) return;
  // u is then v Wtn/Wnn, unless a force of its own drives it off by more than rounding and underflow do.
  const double in_range = contact.an * contact.wtn;
  contact.u0 = -contact.wtn;
  contact.coupled = ForcesFollow(contact, in_range);
  if (contact.coupled) contact.at = in_range;
}

// At rank one Wtt = Wtn^2/Wnn, which must not be rounded on the way. If Wtt = 0, so is Wtn, and nothing has to be held.
bool HoldsFreely(const PlanarProblem& problem, int rank) {
  if (rank == 1 && problem.w.tt > 0.0)
    return std::fma(problem.mu_static, std::fabs(problem.w.tn), -problem.w.nn) >= 0.0;
  return std::fma(problem.mu_static, problem.w.tt, -std::fabs(problem.w.tn)) >= 0.0;
}

}  // namespace

ScaledContact MakeScaledContact(const Problem& problem) {
  ScaledContact contact;
  SetUnits(problem, contact);
  contact.u0 = problem.contact.u0 / contact.speed;
  contact.at = problem.tangential_acceleration * contact.time / contact.speed;
  contact.an = problem.normal_acceleration * contact.time / contact.speed;
  contact.mu = problem.contact.mu;
  contact.mu_static = problem.contact.mu_static;
  contact.compliant = problem.ratio_squared.has_value();
  contact.ratio_squared = problem.ratio_squared.value_or(0.0);
  SetInertia(problem.contact, contact);
  contact.pulled = contact.damped && (contact.an > 0.0 || contact.at != 0.0);
  contact.smooth = problem.contact.mu_static == 0.0 || (contact.wtt == 0.0 && contact.u0 == 0.0);
  contact.holds_freely = HoldsFreely(problem.contact, contact.rank);
  return contact;
}

}  // namespace ricochet::finite_duration
