// VisitNumbers: every number of a scene with its path, a reference to it and the rule that it keeps by itself.
//
// Validate, the axes of sweeps and the ranges of bounds all use this list, so that a new field is added here only.

#ifndef RICOCHET_CORE_SCENE_NUMBERS_H_
#define RICOCHET_CORE_SCENE_NUMBERS_H_

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <type_traits>
#include <variant>

#include "ricochet/number_path.h"
#include "ricochet/scene.h"

namespace ricochet {

// Below this ratio doubles do not resolve the oscillation along the surface (core/models/compliant/compliant.h).
inline constexpr double kLeastTangentialRatioSquared = 1e-9;
// Above this ratio the tangential spring is too soft to have an effect that doubles resolve.
inline constexpr double kMostTangentialRatioSquared = 1e9;

// Each rule requires in addition that the number is finite.
enum class NumberRule {
  kFinite,
  kPositive,
  kNotNegative,
  kUnitInterval,
  kPlusMinusOne,
  kOneToFour,
  kRatioSquared,
  kAngle,     // Any angle in radians; one beyond a full turn may be meant in degrees.
  kHalfTurn,  // An angle above 0 and below pi.
};

// True if `value` keeps `rule`. Every rule compares with two finite ends, so that NaN and infinity break it.
inline bool Holds(double value, NumberRule rule) {
  constexpr double kMost = std::numeric_limits<double>::max();
  switch (rule) {
    case NumberRule::kFinite:
    case NumberRule::kAngle:
      return std::abs(value) <= kMost;
    case NumberRule::kPositive:
      return value > 0.0 && value <= kMost;
    case NumberRule::kNotNegative:
      return value >= 0.0 && value <= kMost;
    case NumberRule::kUnitInterval:
      return value >= 0.0 && value <= 1.0;
    case NumberRule::kPlusMinusOne:
      return value >= -1.0 && value <= 1.0;
    case NumberRule::kOneToFour:
      return value >= 1.0 && value <= 4.0;
    case NumberRule::kHalfTurn:
      // The double that is called pi lies below pi.
      return value > 0.0 && value <= std::numbers::pi;
    case NumberRule::kRatioSquared:
      return value >= kLeastTangentialRatioSquared && value <= kMostTangentialRatioSquared;
  }
  return false;
}

// This namespace implements VisitNumbers.
namespace numbers {

// A Part visits the fields of a part of the scene, which share a prefix.
template <typename Visitor>
struct Part {
  const char* prefix;
  int entry;
  Visitor& visit;

  template <typename Number>
  void One(const char* name, Number& number, NumberRule rule = NumberRule::kFinite) const {
    visit(NumberPath{prefix, entry, name}, number, rule);
  }
  template <typename List>
  void Each(const char* name, List& list, NumberRule rule = NumberRule::kFinite) const {
    for (size_t i = 0; i < list.size(); ++i) {
      visit(NumberPath{prefix, entry, name, static_cast<int>(i)}, list[i], rule);
    }
  }
};

// T is U or const U. Each alternative of a variant has its own overload of Visit, so that a new alternative does not
// compile until it has one too.
template <typename T, typename U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

template <Is<std::monostate> Unset, typename Visitor>
void Visit(Unset& /*unset*/, Visitor& /*visit*/) {}

template <Is<PlanarBody> Body, typename Visitor>
void Visit(Body& body, Visitor& visit, const char* prefix = "planar_body") {
  const Part<Visitor> part{prefix, -1, visit};
  part.One("mass_kg", body.mass_kg, NumberRule::kPositive);
  part.One("inertia_com_kg_m2", body.inertia_com_kg_m2, NumberRule::kPositive);
  part.One("offset_t_m", body.offset_t_m);
  part.One("offset_n_m", body.offset_n_m);
  part.One("velocity_t_m_s", body.velocity_t_m_s);
  part.One("velocity_n_m_s", body.velocity_n_m_s);
  part.One("rate_rad_s", body.rate_rad_s);
}

template <Is<SpatialBody> Body, typename Visitor>
void Visit(Body& body, Visitor& visit, const char* prefix = "spatial_body") {
  const Part<Visitor> part{prefix, -1, visit};
  part.One("mass_kg", body.mass_kg, NumberRule::kPositive);
  part.Each("inertia_com_kg_m2", body.inertia_com_kg_m2);
  part.Each("offset_m", body.offset_m);
  part.Each("linear_m_s", body.linear_m_s);
  part.Each("angular_rad_s", body.angular_rad_s);
}

template <Is<PlanarPair> Pair, typename Visitor>
void Visit(Pair& pair, Visitor& visit) {
  Visit(pair.body_1, visit, "body_pair.planar.body_1");
  Visit(pair.body_2, visit, "body_pair.planar.body_2");
}

template <Is<SpatialPair> Pair, typename Visitor>
void Visit(Pair& pair, Visitor& visit) {
  Visit(pair.body_1, visit, "body_pair.spatial.body_1");
  Visit(pair.body_2, visit, "body_pair.spatial.body_2");
}

template <Is<BodyPair> Pair, typename Visitor>
void Visit(Pair& pair, Visitor& visit) {
  std::visit([&visit](auto& bodies) { Visit(bodies, visit); }, pair.bodies);
}

template <Is<Pendulum> SomePendulum, typename Visitor>
void Visit(SomePendulum& pendulum, Visitor& visit) {
  const Part<Visitor> part{"pendulum", -1, visit};
  part.One("inertia_kg_m2", pendulum.inertia_kg_m2, NumberRule::kPositive);
  part.One("a_m", pendulum.a_m, NumberRule::kPositive);
  part.One("b_m", pendulum.b_m);
  part.One("omega_minus_rad_s", pendulum.omega_minus_rad_s);
}

template <Is<Linkage> SomeLinkage, typename Visitor>
void Visit(SomeLinkage& linkage, Visitor& visit) {
  int entry = 0;
  for (auto& link : linkage.links) {
    const Part<Visitor> part{"linkage.links", entry++, visit};
    part.One("length_m", link.length_m, NumberRule::kPositive);
    part.One("mass_kg", link.mass_kg, NumberRule::kPositive);
    part.One("com_m", link.com_m);
    part.One("inertia_com_kg_m2", link.inertia_com_kg_m2, NumberRule::kPositive);
    part.One("theta_rad", link.theta_rad, NumberRule::kAngle);
    part.One("rate_rad_s", link.rate_rad_s);
  }
}

template <Is<PlanarContact> Contact, typename Visitor>
void Visit(Contact& contact, Visitor& visit) {
  const Part<Visitor> part{"planar_contact", -1, visit};
  part.One("w_tt_per_kg", contact.w_tt_per_kg, NumberRule::kNotNegative);
  part.One("w_tn_per_kg", contact.w_tn_per_kg);
  part.One("w_nn_per_kg", contact.w_nn_per_kg, NumberRule::kNotNegative);
  part.One("tangential_m_s", contact.tangential_m_s);
  part.One("normal_m_s", contact.normal_m_s);
}

template <Is<SpatialContact> Contact, typename Visitor>
void Visit(Contact& contact, Visitor& visit) {
  const Part<Visitor> part{"spatial_contact", -1, visit};
  part.Each("w_per_kg", contact.w_per_kg);
  part.Each("tangential_m_s", contact.tangential_m_s);
  part.One("normal_m_s", contact.normal_m_s);
}

// `dependence` is that of "friction" or of "restitution".
template <Is<PowerLaw> Law, typename Visitor>
void VisitBySpeed(Law& law, bool friction, Visitor& visit) {
  const Part<Visitor> part{friction ? "friction.by_speed.power_law" : "restitution.by_speed.power_law", -1, visit};
  part.One("alpha", law.alpha);
  part.One("exponent", law.exponent, NumberRule::kNotNegative);
}

template <Is<SpeedTable> Table, typename Visitor>
void VisitBySpeed(Table& table, bool friction, Visitor& visit) {
  const Part<Visitor> part{friction ? "friction.by_speed.table" : "restitution.by_speed.table", -1, visit};
  part.Each("speed_m_s", table.speed_m_s, NumberRule::kNotNegative);
  part.Each("factor", table.factor);
}

template <Is<std::monostate> Unset, typename Visitor>
void VisitBySpeed(Unset& /*unset*/, bool /*friction*/, Visitor& /*visit*/) {}

// Validate checks in addition that the static coefficient is not below the kinetic one.
template <Is<Friction> SomeFriction, typename Visitor>
void Visit(SomeFriction& friction, Visitor& visit) {
  const Part<Visitor> part{"friction", -1, visit};
  part.One("kinetic_coefficient", friction.kinetic_coefficient, NumberRule::kNotNegative);
  if (friction.static_coefficient.has_value()) {
    part.One("static_coefficient", *friction.static_coefficient, NumberRule::kNotNegative);
  }
}

template <Is<NewtonCoefficient> Newton, typename Visitor>
void Visit(Newton& newton, Visitor& visit) {
  Part<Visitor>{"restitution", -1, visit}.One("newton", newton.value, NumberRule::kNotNegative);
}

template <Is<PoissonCoefficient> Poisson, typename Visitor>
void Visit(Poisson& poisson, Visitor& visit) {
  Part<Visitor>{"restitution", -1, visit}.One("poisson", poisson.value, NumberRule::kNotNegative);
}

template <Is<EnergeticCoefficient> Energetic, typename Visitor>
void Visit(Energetic& energetic, Visitor& visit) {
  Part<Visitor>{"restitution", -1, visit}.One("energetic", energetic.value, NumberRule::kUnitInterval);
}

template <Is<SurfaceVelocity> Velocity, typename Visitor>
void Visit(Velocity& velocity, Visitor& visit) {
  const Part<Visitor> part{"surface_velocity", -1, visit};
  part.Each("tangential_m_s", velocity.tangential_m_s);
  part.One("normal_m_s", velocity.normal_m_s);
}

template <Is<WhittakerLaw> Law, typename Visitor>
void Visit(Law& law, Visitor& visit) {
  Part<Visitor>{"whittaker", -1, visit}.One("e", law.e, NumberRule::kNotNegative);
}

template <Is<KaneLevinsonLaw> Law, typename Visitor>
void Visit(Law& law, Visitor& visit) {
  Part<Visitor>{"kane_levinson", -1, visit}.One("e", law.e, NumberRule::kNotNegative);
}

template <Is<BrachLaw> Law, typename Visitor>
void Visit(Law& law, Visitor& visit) {
  const Part<Visitor> part{"brach", -1, visit};
  part.One("e", law.e, NumberRule::kNotNegative);
  part.One("mu_hat", law.mu_hat);
}

template <Is<ChatterjeeRuinaLaw> Law, typename Visitor>
void Visit(Law& law, Visitor& visit) {
  const Part<Visitor> part{"chatterjee_ruina", -1, visit};
  part.One("e", law.e, NumberRule::kNotNegative);
  part.One("e_t", law.e_t, NumberRule::kPlusMinusOne);
}

template <Is<LinearSpring> Spring, typename Visitor>
void Visit(Spring& spring, Visitor& visit) {
  Part<Visitor>{"compliance.linear", -1, visit}.One("stiffness_n_m", spring.stiffness_n_m, NumberRule::kPositive);
}

template <Is<HertzSpring> Spring, typename Visitor>
void Visit(Spring& spring, Visitor& visit) {
  Part<Visitor>{"compliance.hertz", -1, visit}.One("stiffness_n_m1_5", spring.stiffness_n_m1_5, NumberRule::kPositive);
}

template <Is<HuntCrossleySpring> Spring, typename Visitor>
void Visit(Spring& spring, Visitor& visit) {
  const Part<Visitor> part{"compliance.hunt_crossley", -1, visit};
  part.One("stiffness_n_m_p", spring.stiffness_n_m_p, NumberRule::kPositive);
  part.One("exponent", spring.exponent, NumberRule::kOneToFour);
  part.One("damping_s_m", spring.damping_s_m, NumberRule::kNotNegative);
}

template <Is<Compliance> SomeCompliance, typename Visitor>
void Visit(SomeCompliance& compliance, Visitor& visit) {
  if (compliance.tangential_ratio_squared.has_value()) {
    const Part<Visitor> part{"compliance", -1, visit};
    part.One("tangential_ratio_squared", *compliance.tangential_ratio_squared, NumberRule::kRatioSquared);
  }
  std::visit([&visit](auto& spring) { Visit(spring, visit); }, compliance.normal);
}

template <Is<Gravity> SomeGravity, typename Visitor>
void Visit(SomeGravity& gravity, Visitor& visit) {
  const Part<Visitor> part{"gravity", -1, visit};
  part.One("tangential_m_s2", gravity.tangential_m_s2);
  part.One("normal_m_s2", gravity.normal_m_s2);
}

template <Is<PinMoment> Moment, typename Visitor>
void Visit(Moment& moment, Visitor& visit) {
  Part<Visitor>{"pin_moment", -1, visit}.One("moment_n_m", moment.moment_n_m);
}

template <Is<ContactAcceleration> Acceleration, typename Visitor>
void Visit(Acceleration& acceleration, Visitor& visit) {
  const Part<Visitor> part{"contact_acceleration", -1, visit};
  part.One("tangential_m_s2", acceleration.tangential_m_s2);
  part.One("normal_m_s2", acceleration.normal_m_s2);
}

}  // namespace numbers

// Calls visit(path, number, rule) for every number of the scene, in the order of the proto's fields. `number` is a
// reference to const if the scene is const. A oneof that is not set has no numbers.
template <typename SomeScene, typename Visitor>
void VisitNumbers(SomeScene& scene, Visitor visit) {
  const auto visit_one_of = [&visit](auto& variant) {
    std::visit([&visit](auto& alternative) { numbers::Visit(alternative, visit); }, variant);
  };
  const auto visit_by_speed = [&visit](auto& dependence, bool friction) {
    if (!dependence.has_value()) return;
    std::visit([&](auto& form) { numbers::VisitBySpeed(form, friction, visit); }, *dependence);
  };
  visit_one_of(scene.system);
  numbers::Visit(scene.friction, visit);
  visit_by_speed(scene.friction.by_speed, true);
  visit_one_of(scene.restitution);
  visit_by_speed(scene.restitution_by_speed, false);
  if (scene.surface_velocity.has_value()) numbers::Visit(*scene.surface_velocity, visit);
  visit_one_of(scene.impact_law);
  if (scene.compliance.has_value()) numbers::Visit(*scene.compliance, visit);
  visit_one_of(scene.finite_forces);
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_NUMBERS_H_
