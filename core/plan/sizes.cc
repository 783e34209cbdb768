#include "core/plan/sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "core/models/pendulum/first_order.h"
#include "core/models/restitution_law.h"
#include "core/plan/contact_time.h"
#include "core/plan/perturbed_path.h"

namespace ricochet {
namespace {

constexpr double kRounding = 0x1p-48;  // Rounding error of a sum of a few terms, relative to its terms.

// A planar contact in the scales of core/plan/perturbed_path.h. Comments give the symbols of docs/theory/plan.md.
struct Scaled {
  Mobility mobility;   // W, w
  double along = 0.0;  // s w
  double slip = 0.0;   // |u0|
  double mu = 0.0;
  double friction = 0.0;   // m
  bool may_stick = false;  // w <= mu_s W
  bool may_slip = false;   // w > mu_s W; both are true within rounding of equality
  Restoring restoring;

  double Cone() const { return friction * mobility.coupling; }                          // c
  double SlideSlope() const { return 1.0 - mu * along; }                                // v' of A
  double StickSlope() const { return 1.0 - mobility.coupling * Holding(); }             // v' while the contact sticks
  double Holding() const { return mobility.coupling / mobility.tangential; }            // |f'| while the contact sticks
  double Braking() const { return mu * mobility.tangential - along; }                   // -s u' of A
  double UTerms() const { return mu * mobility.tangential + mobility.coupling; }        // Sum of the terms of Braking.
  double SlideImpulse() const { return (1.0 + restoring.coefficient) / SlideSlope(); }  // tau1 of A
  // Relative rounding error of a normal impulse tau on A.
  double TimeError() const { return kRounding * (1.0 + (1.0 + mu * mobility.coupling) / SlideSlope()); }
  // A lower bound on s u of A, close to it.
  double LeastSlip(double tau) const {
    return slip - Braking() * tau - (kRounding * (slip + UTerms() * tau) + TimeError() * std::fabs(Braking()) * tau);
  }
  // A lower bound on tau_s, close to it.
  double EarliestStop() const { return slip / std::max(Braking() + kRounding * UTerms(), 0.0) * (1.0 - TimeError()); }
  double Change(const ReferencePath& reference, const Perturbation& change) const {
    return WithRoundingMargin(LargestChange(mobility, restoring, reference, change));
  }
};

Scaled Scale(const planar::Problem& problem) {
  Scaled contact;
  const double speed = -problem.v0;
  const double w = problem.w.tn / problem.w.nn;
  contact.mobility = {.tangential = problem.w.tt / problem.w.nn, .coupling = std::fabs(w)};
  contact.along = problem.u0 == 0.0 ? contact.mobility.coupling : std::copysign(1.0, problem.u0) * w;
  contact.slip = std::fabs(problem.u0) / speed;
  contact.mu = problem.mu;
  const double held = problem.mu_static * contact.mobility.tangential;
  contact.may_stick = contact.mobility.coupling <= held * (1.0 + kRounding);
  contact.may_slip = contact.mobility.coupling >= held * (1.0 - kRounding);
  contact.friction = contact.may_stick ? std::max(problem.mu, contact.Holding()) : problem.mu;
  contact.restoring = {.law = problem.law, .coefficient = problem.coefficient};
  return contact;
}

// The path of a contact that slides on.
ReferencePath Sliding(const Scaled& contact) {
  return {.slope_low = contact.SlideSlope(),
          .slope_high = contact.SlideSlope(),
          .u_slope = std::fabs(contact.Braking()) + kRounding * contact.UTerms(),
          .f_slope = contact.mu};
}

Size Locking(double cone) { return {.value = kUnbounded, .basis = Basis::kSelfLocking, .number = cone}; }

// Bounds |f| by 2 (|u0| + w tau1)/W, because friction only slows slip.
double HeldImpulse(const Scaled& contact) {
  const double cone = contact.Cone();
  const double c = contact.restoring.coefficient;
  const double v1 =
      contact.restoring.law == RestitutionLaw::kEnergetic ? c * std::sqrt((1.0 + cone) / (1.0 - cone)) : c;
  const double last = (1.0 + v1) / (1.0 - cone) * (1.0 + 0x1p-20);
  return 2.0 * (contact.slip + contact.mobility.coupling * last) / contact.mobility.tangential;
}

Size FrictionSize(const Scaled& contact, const ContactPhysics& physics, bool slips_on) {
  if (contact.friction == 0.0) return {};
  const double cone = contact.Cone();
  const ReferencePath smooth = {.u_slope = contact.mobility.coupling};
  double size =
      contact.Change(smooth, {.f_slope = contact.friction, .slope_low = 1.0 - cone, .slope_high = 1.0 + cone});
  if (1.0 - cone >= kLeastSlope) {
    const Perturbation held = {.f_jump = HeldImpulse(contact), .slope_low = 1.0 - cone, .slope_high = 1.0 + cone};
    // This lower bound on the second size spares computing it for most contacts, for which it is not the smaller one.
    const double least = contact.mobility.tangential * held.f_jump;
    if (!(least >= size)) size = std::min(size, contact.Change(smooth, held));
  }
  const bool sticks = contact.may_stick && !contact.may_slip && contact.SlideSlope() >= kLeastSlope;
  if (sticks && physics.ratio_squared == 0.0 && !slips_on) {
    const double stop = contact.EarliestStop();
    const double latest = contact.slip / std::max(contact.Braking() - kRounding * contact.UTerms(), 0.0);
    size = std::min(size, contact.Change(smooth, {.f_jump = contact.slip == 0.0 ? 0.0 : contact.mu * latest,
                                                  .f_slope = contact.Holding(),
                                                  .from = contact.slip == 0.0 ? 0.0 : stop,
                                                  .slope_low = std::min(contact.SlideSlope(), contact.StickSlope()),
                                                  .slope_high = std::max(contact.SlideSlope(), contact.StickSlope())}));
  }
  if (!(size < kUnbounded)) return Locking(cone);
  return {.value = size, .basis = Basis::kInequality, .number = cone};
}

// True if slip goes on to the end of the sliding path.
bool SlidesThroughout(const Scaled& contact) {
  if (!(contact.SlideSlope() >= kLeastSlope)) return false;
  if (contact.slip == 0.0) return !contact.may_stick;
  return contact.LeastSlip(contact.SlideImpulse()) > 0.0;
}

Size SlidingThroughout(const Scaled& contact, const planar::Problem& problem) {
  const double end = contact.slip - contact.Braking() * contact.SlideImpulse();
  return {.value = 0.0, .basis = Basis::kSlidesThroughout, .number = -problem.v0 * end};
}

// The size of a change of f' by `f_slope` from the earliest stop of slip on; `path` is A.
Size AfterStop(const Scaled& contact, const ReferencePath& path, double f_slope, double low, double high) {
  const double stop = contact.slip == 0.0 ? 0.0 : contact.EarliestStop();
  const double size = contact.Change(path, {.f_slope = f_slope, .from = stop, .slope_low = low, .slope_high = high});
  if (!(size < kUnbounded)) return Locking(contact.Cone());
  return {.value = size,
          .basis = Basis::kInequality,
          .number = std::min(1.0, stop * path.slope_low / (1.0 + contact.restoring.coefficient))};
}

Size StopSize(const Scaled& contact, const planar::Problem& problem) {
  if (contact.friction == 0.0) return {};
  if (SlidesThroughout(contact)) return SlidingThroughout(contact, problem);
  if (contact.slip == 0.0) return {.value = kUnbounded, .basis = Basis::kStaysAtRest};
  if (!(contact.SlideSlope() >= kLeastSlope)) return Locking(contact.Cone());
  double change = 0.0;
  double low = kUnbounded;
  double high = 0.0;
  if (contact.may_stick) {
    change = (contact.Braking() + kRounding * contact.UTerms()) / contact.mobility.tangential;
    low = high = contact.StickSlope();
  }
  if (contact.may_slip) {
    const double slope = 1.0 - contact.mu * contact.mobility.coupling;
    change = std::max(change, 2.0 * contact.mu);
    low = std::min(low, slope);
    high = std::max(high, slope);
  }
  if (!(low >= kLeastSlope)) return Locking(contact.Cone());
  return AfterStop(contact, Sliding(contact), change, low, high);
}

// True if the contact sticks by the static coefficient and slides by the kinetic one. core/models/planar/planar.h
// states the criterion for a W of rank one.
bool CoefficientsDisagree(const planar::Problem& problem) {
  const bool rank_one = problem.w.Rank() == 1;
  const double normal = std::fabs(problem.w.tn);
  const double from = rank_one ? normal : problem.w.tt;
  const double against = rank_one ? problem.w.nn : normal;
  return std::fma(problem.mu, from, -against) < 0.0 && std::fma(problem.mu_static, from, -against) >= 0.0;
}

Size StaticSize(const Scaled& contact, const planar::Problem& problem) {
  if (!(problem.mu_static > problem.mu)) return {};
  if (!CoefficientsDisagree(problem)) return {.basis = Basis::kDecidesNothing};
  if (contact.slip > 0.0 && SlidesThroughout(contact)) return SlidingThroughout(contact, problem);
  const double cone = contact.mu * contact.mobility.coupling;
  const double first = contact.slip == 0.0 ? 1.0 - cone : contact.SlideSlope();
  const ReferencePath reversing = {.slope_low = std::min(first, 1.0 - cone),
                                   .slope_high = std::max(first, 1.0 - cone),
                                   .u_slope = contact.UTerms(),
                                   .f_slope = contact.mu};
  const double stick = contact.StickSlope();
  if (!(stick >= kLeastSlope)) return Locking(contact.Cone());
  const double change = contact.Holding() * (1.0 + kRounding) - contact.mu;
  const Size size = AfterStop(contact, reversing, std::max(change, 0.0), stick, stick);
  if (contact.slip == 0.0 || !(first >= kLeastSlope)) return size;
  const Size to_stick = AfterStop(contact, Sliding(contact), contact.Holding() + contact.mu, stick, stick);
  Size both = AfterStop(contact, Sliding(contact), 2.0 * contact.mu, 1.0 - cone, 1.0 - cone);
  both.value += to_stick.value;
  return both.value < size.value ? both : size;
}

// The earliest normal impulse at which a compliant or a rigid contact may stop; both slide until then.
double EarliestParting(const Scaled& contact, double lag) {
  const double start = contact.slip - lag * (1.0 + kRounding);
  if (start <= 0.0 || !(contact.SlideSlope() >= kLeastSlope)) return 0.0;
  const double compression_end = 1.0 / contact.SlideSlope();
  const double at_compression_end = contact.LeastSlip(compression_end);
  if (at_compression_end > 0.0) return contact.EarliestStop();
  return start / (start - at_compression_end) * compression_end * (1.0 - contact.TimeError());
}

// The normal impulse after which a compliant and a rigid contact that cannot stick both slide towards sgn Wtn. It is
// infinite if compression ends earlier.
double LatestMeeting(const Scaled& contact, double lag) {
  const double drive =
      contact.mobility.coupling - contact.mu * contact.mobility.tangential - kRounding * contact.UTerms();
  if (!(drive > 0.0)) return kUnbounded;
  const double slip = contact.along < 0.0 ? -contact.slip : contact.slip;  // Towards sgn Wtn.
  const double wait = std::max(0.0, (lag * (1.0 + kRounding) - slip * (1.0 - kRounding)) / drive);
  // (t - wait)^2 = 2 b t
  const double b = 4.0 * lag / drive;
  const double meeting = (wait + b + std::sqrt(b * (b + 2.0 * wait))) * (1.0 + 0x1p-20);
  return meeting * (1.0 + contact.Cone()) < 1.0 ? meeting : kUnbounded;
}

Size ComplianceSize(const Scaled& contact, const planar::Problem& problem, const ContactPhysics& physics,
                    double friction) {
  if (physics.ratio_squared == 0.0 || contact.mu == 0.0) return {};
  const double lag = contact.mu * physics.ratio_squared;
  if (contact.slip > lag * (1.0 + kRounding) && SlidesThroughout(contact)) return SlidingThroughout(contact, problem);
  const double cone = contact.mu * contact.mobility.coupling;
  if (!(1.0 - cone >= kLeastSlope)) return Locking(cone);
  const auto change = [&](const ReferencePath& path, double jump, double slope, double from) {
    return contact.Change(
        path, {.f_jump = jump, .f_slope = slope, .from = from, .slope_low = 1.0 - cone, .slope_high = 1.0 + cone});
  };
  const ReferencePath rigid = {
      .slope_low = 1.0 - cone, .slope_high = 1.0 + cone, .u_slope = contact.UTerms(), .f_slope = contact.friction};
  double size = std::min(2.0 * friction, change(rigid, HeldImpulse(contact), 0.0, 0.0));
  const double parting = EarliestParting(contact, lag);
  if (parting > 0.0) size = std::min(size, 2.0 * change(Sliding(contact), 0.0, 2.0 * contact.mu, parting));
  const double meeting = LatestMeeting(contact, lag);
  if (meeting < kUnbounded) size = std::min(size, change(rigid, 2.0 * contact.mu * meeting, 0.0, 0.0));
  if (!(size < kUnbounded)) return Locking(cone);
  return {.value = size, .basis = Basis::kInequality, .number = cone};
}

Size DurationSize(const ContactPhysics& physics) {
  if (std::holds_alternative<std::monostate>(physics.spring)) return {};
  if (std::holds_alternative<HuntCrossleySpring>(physics.spring)) {
    return {.value = kUnbounded, .basis = Basis::kDamped};
  }
  return {.value = 0.0, .basis = Basis::kSameImpulses};
}

// Changes of velocity by finite forces, scaled, and the duration in which they act.
struct Drift {
  double seconds = 0.0;
  double u = 0.0;
  double v = 0.0;
};

Drift DriftOf(const planar::Problem& problem, const ContactPhysics& physics) {
  const double cone = problem.mu_static * std::fabs(problem.w.tn);
  if (!(problem.w.nn - cone >= kLeastSlope * problem.w.nn)) return {.seconds = kUnbounded};
  const double normal = std::fabs(physics.normal_acceleration);
  const double time = LongestContact(physics.spring, {.slope_low = problem.w.nn - cone,
                                                      .slope_high = problem.w.nn + cone,
                                                      .v0 = problem.v0,
                                                      .energetic = problem.coefficient,
                                                      .acceleration = normal});
  return {.seconds = time,
          .u = std::fabs(physics.tangential_acceleration) * time / -problem.v0,
          .v = normal * time / -problem.v0};
}

// The size of finite forces if the contact slides on with them and without them; infinite if it may stop.
double ForcesOnSlide(const Scaled& contact, const ContactPhysics& physics, const Drift& drift) {
  if (contact.slip == 0.0 || !(contact.SlideSlope() >= kLeastSlope)) return kUnbounded;
  const double end = contact.SlideImpulse();
  const double compression_end = 1.0 / contact.SlideSlope();
  const double lag = contact.mu * physics.ratio_squared;
  const double least = std::min(
      {contact.slip - lag * (1.0 + kRounding), contact.LeastSlip(compression_end), contact.LeastSlip(1.25 * end)});
  if (!(least > (drift.u + lag * drift.v) * (1.0 + kRounding))) return kUnbounded;
  const double change =
      LargestChange(contact.mobility, contact.restoring, Sliding(contact), {.u = drift.u, .v = drift.v});
  return change <= 0.25 * end ? WithRoundingMargin(change) : kUnbounded;
}

double ForcesOnFriction(const Scaled& contact, const planar::Problem& problem, const ContactPhysics& physics,
                        const Drift& drift) {
  if (problem.mu_static > problem.mu || physics.ratio_squared > 0.0) return kUnbounded;
  const double cone = contact.Cone();
  const ReferencePath rigid = {.slope_low = 1.0 - cone,
                               .slope_high = 1.0 + cone,
                               .u_slope = contact.friction * contact.mobility.tangential + contact.mobility.coupling,
                               .f_slope = contact.friction};
  const double jump = drift.u == 0.0 ? 0.0 : 2.0 * drift.u / contact.mobility.tangential;
  return contact.Change(rigid, {.f_jump = jump, .u = drift.u, .v = drift.v});
}

void SetForces(const Scaled& contact, const planar::Problem& problem, const ContactPhysics& physics, Sizes& sizes) {
  Size& size = sizes[Effect::kFiniteForces];
  if (physics.tangential_acceleration == 0.0 && physics.normal_acceleration == 0.0) return;
  if (std::holds_alternative<std::monostate>(physics.spring)) {
    size = {.value = 0.0, .basis = Basis::kNoSpring};
    return;
  }
  if (std::holds_alternative<HuntCrossleySpring>(physics.spring)) {
    size = {.value = kUnbounded, .basis = Basis::kDamped};
    sizes.forces_beyond_friction = kUnbounded;
    return;
  }
  const Drift drift = DriftOf(problem, physics);
  const bool bounded = drift.seconds < kUnbounded;
  const double without_friction = bounded ? contact.Change({.u_slope = contact.mobility.coupling},
                                                           {.f_slope = problem.mu_static, .u = drift.u, .v = drift.v})
                                          : kUnbounded;
  const double friction = sizes[Effect::kFriction].value;
  sizes.forces_beyond_friction =
      without_friction < kUnbounded ? std::max(without_friction - friction, 0.0) : kUnbounded;
  double with_friction = kUnbounded;
  if (problem.mu_static == 0.0 || contact.mobility.tangential == 0.0) {
    with_friction = without_friction;
  } else if (bounded) {
    with_friction =
        std::min(ForcesOnSlide(contact, physics, drift), ForcesOnFriction(contact, problem, physics, drift));
  }
  size = {.value = with_friction,
          .basis = with_friction < kUnbounded ? Basis::kInequality : Basis::kNoInequality,
          .number = drift.seconds};
}

}  // namespace

Sizes PlanarSizes(const planar::Problem& problem, const ContactPhysics& physics, bool slips_on) {
  Sizes sizes;
  const Scaled contact = Scale(problem);
  sizes[Effect::kFriction] = FrictionSize(contact, physics, slips_on);
  sizes[Effect::kSlipStop] = StopSize(contact, problem);
  sizes[Effect::kSlipTurn].basis = Basis::kNotOfSystem;
  sizes[Effect::kStaticFriction] = StaticSize(contact, problem);
  sizes[Effect::kTangentialCompliance] = ComplianceSize(contact, problem, physics, sizes[Effect::kFriction].value);
  if (problem.w.tt == 0.0) {
    for (const Effect effect : {Effect::kFriction, Effect::kSlipStop, Effect::kStaticFriction}) {
      sizes[effect] = {.basis = Basis::kImmobile};
    }
    // Impulses along t move nothing here, but a contact that slips still receives a friction impulse that does work.
    if (problem.u0 != 0.0 && problem.mu > 0.0) {
      sizes[Effect::kFriction] = {.value = kUnbounded, .basis = Basis::kNoInequality};
    }
    if (physics.ratio_squared > 0.0) sizes[Effect::kTangentialCompliance] = {.basis = Basis::kImmobile};
  }
  sizes[Effect::kFiniteDuration] = DurationSize(physics);
  SetForces(contact, problem, physics, sizes);
  sizes[Effect::kHigherOrder].basis = Basis::kNotOfSystem;
  return sizes;
}

planar::Problem PlanarOf(const pendulum::Problem& problem) {
  const double per_inertia = 1.0 / problem.inertia;
  return {.w = {problem.b * problem.b * per_inertia, problem.a * problem.b * per_inertia,
                problem.a * problem.a * per_inertia},
          .u0 = problem.b * problem.omega_minus,
          .v0 = problem.a * problem.omega_minus,
          .mu = problem.mu,
          .mu_static = problem.mu_static,
          .law = problem.law,
          .coefficient = problem.coefficient};
}

// The change that friction makes is known exactly for a pendulum, up to rounding.
Size PendulumFrictionSize(const pendulum::Problem& problem) {
  const double b = std::fabs(problem.b);
  const double x = first_order::FrictionRatio(problem);
  if ((problem.mu == 0.0 || b == 0.0) && problem.mu_static * b < problem.a) return {};
  if (!(1.0 - x >= kLeastSlope) || problem.mu_static * b >= problem.a * (1.0 - kRounding)) return Locking(x);
  const double c = problem.coefficient;
  const double ratio = (1.0 - x) / (1.0 + x);
  const double twice = 2.0 * x / (1.0 + x);  // 1 - r
  double v1 = 0.0;
  double kappa = c;
  double grown = 0.0;  // kappa - c
  switch (problem.law) {
    case RestitutionLaw::kEnergetic: {
      const double root = std::sqrt(ratio);
      v1 = c * twice / (1.0 + root);
      kappa = c / root;
      grown = kappa * twice / (1.0 + root);
      break;
    }
    case RestitutionLaw::kPoisson:
      v1 = c * twice;
      break;
    case RestitutionLaw::kNewton:
      kappa = c / ratio;
      grown = kappa * twice;
      break;
  }
  // (1 + kappa)/(1 + x) - (1 + c)
  const double tau1 = (std::fabs(grown - x * (1.0 + c)) + kRounding * (grown + x * (1.0 + c))) / (1.0 + x);
  const double arm = b / problem.a;
  const double f1 = arm * x * (std::fabs(1.0 - kappa) + kRounding * (1.0 + kappa)) / (1.0 + x);
  // Under Newton's law with kappa = 1, friction changes nothing but the impulses of compression.
  const double tau0 = x / (1.0 + x);
  const double largest = std::max({v1, arm * v1, tau1, f1, tau0, arm * tau0});
  return {.value = WithRoundingMargin(largest + std::numeric_limits<double>::min()),
          .basis = Basis::kInequality,
          .number = x};
}

Size PendulumHigherOrderSize(const pendulum::Problem& problem) {
  const double x = first_order::FrictionRatio(problem);
  if (x == 0.0) return {};
  if (!first_order::Serves(problem)) return {.value = kUnbounded, .basis = Basis::kNoInequality, .number = x};
  // The errors are over max(|u0|, |v0|).
  const double arm = std::fabs(problem.b) / problem.a;
  return {.value = WithRoundingMargin(first_order::ErrorsOf(problem).Largest() * std::max(1.0, arm)),
          .basis = Basis::kInequality,
          .number = x};
}

Sizes PendulumSizes(const pendulum::Problem& problem, const ContactPhysics& physics) {
  Sizes sizes;
  const planar::Problem planar = PlanarOf(problem);
  const Scaled contact = Scale(planar);
  const double b = std::fabs(problem.b);
  sizes[Effect::kFriction] = PendulumFrictionSize(problem);
  const bool rubs = problem.mu_static > 0.0 && b > 0.0;
  if (rubs && !sizes[Effect::kFriction].IsAbsent()) {
    sizes[Effect::kSlipStop] = {.value = kUnbounded, .basis = Basis::kStopsAtCompressionEnd};
  }
  sizes[Effect::kSlipTurn].basis = Basis::kNotOfSystem;
  if (problem.mu_static > problem.mu) {
    const bool disagree =
        std::fma(problem.mu, b, -problem.a) < 0.0 && std::fma(problem.mu_static, b, -problem.a) >= 0.0;
    sizes[Effect::kStaticFriction] =
        disagree ? Locking(problem.mu_static * b / problem.a) : Size{.basis = Basis::kDecidesNothing};
  }
  // The size of friction of a planar contact costs more than all other sizes, and only a compliant contact needs it.
  if (physics.ratio_squared != 0.0) {
    const double friction = FrictionSize(contact, physics, false).value;
    sizes[Effect::kTangentialCompliance] = ComplianceSize(contact, planar, physics, friction);
  }
  sizes[Effect::kFiniteDuration] = DurationSize(physics);
  SetForces(contact, planar, physics, sizes);
  sizes[Effect::kHigherOrder] = PendulumHigherOrderSize(problem);
  return sizes;
}

}  // namespace ricochet
