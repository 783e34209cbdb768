#include "proto/wire/scene.h"

#include <variant>

#include "proto/wire/overloaded.h"
#include "proto/wire/repeated.h"

namespace ricochet {

static v1::Pendulum ToProto(const Pendulum& pendulum) {
  v1::Pendulum proto;
  proto.set_inertia_kg_m2(pendulum.inertia_kg_m2);
  proto.set_a_m(pendulum.a_m);
  proto.set_b_m(pendulum.b_m);
  proto.set_omega_minus_rad_s(pendulum.omega_minus_rad_s);
  return proto;
}

static Pendulum FromProto(const v1::Pendulum& proto) {
  return {.inertia_kg_m2 = proto.inertia_kg_m2(),
          .a_m = proto.a_m(),
          .b_m = proto.b_m(),
          .omega_minus_rad_s = proto.omega_minus_rad_s()};
}

static v1::PlanarBody ToProto(const PlanarBody& body) {
  v1::PlanarBody proto;
  proto.set_mass_kg(body.mass_kg);
  proto.set_inertia_com_kg_m2(body.inertia_com_kg_m2);
  proto.set_offset_t_m(body.offset_t_m);
  proto.set_offset_n_m(body.offset_n_m);
  proto.set_velocity_t_m_s(body.velocity_t_m_s);
  proto.set_velocity_n_m_s(body.velocity_n_m_s);
  proto.set_rate_rad_s(body.rate_rad_s);
  return proto;
}

static PlanarBody FromProto(const v1::PlanarBody& proto) {
  return {.mass_kg = proto.mass_kg(),
          .inertia_com_kg_m2 = proto.inertia_com_kg_m2(),
          .offset_t_m = proto.offset_t_m(),
          .offset_n_m = proto.offset_n_m(),
          .velocity_t_m_s = proto.velocity_t_m_s(),
          .velocity_n_m_s = proto.velocity_n_m_s(),
          .rate_rad_s = proto.rate_rad_s()};
}

static v1::SpatialBody ToProto(const SpatialBody& body) {
  v1::SpatialBody proto;
  proto.set_mass_kg(body.mass_kg);
  AssignDoubles(body.inertia_com_kg_m2, *proto.mutable_inertia_com_kg_m2());
  AssignDoubles(body.offset_m, *proto.mutable_offset_m());
  AssignDoubles(body.linear_m_s, *proto.mutable_linear_m_s());
  AssignDoubles(body.angular_rad_s, *proto.mutable_angular_rad_s());
  return proto;
}

static SpatialBody FromProto(const v1::SpatialBody& proto) {
  return {.mass_kg = proto.mass_kg(),
          .inertia_com_kg_m2 = ToVector(proto.inertia_com_kg_m2()),
          .offset_m = ToVector(proto.offset_m()),
          .linear_m_s = ToVector(proto.linear_m_s()),
          .angular_rad_s = ToVector(proto.angular_rad_s())};
}

static v1::BodyPair ToProto(const BodyPair& pair) {
  v1::BodyPair proto;
  const auto set = [](const auto& bodies, auto& target) {
    *target.mutable_body_1() = ToProto(bodies.body_1);
    *target.mutable_body_2() = ToProto(bodies.body_2);
  };
  std::visit(Overloaded{
                 [](std::monostate) {},
                 [&](const PlanarPair& planar) { set(planar, *proto.mutable_planar()); },
                 [&](const SpatialPair& spatial) { set(spatial, *proto.mutable_spatial()); },
             },
             pair.bodies);
  return proto;
}

static BodyPair FromProto(const v1::BodyPair& proto) {
  switch (proto.bodies_case()) {
    case v1::BodyPair::kPlanar:
      return {PlanarPair{FromProto(proto.planar().body_1()), FromProto(proto.planar().body_2())}};
    case v1::BodyPair::kSpatial:
      return {SpatialPair{FromProto(proto.spatial().body_1()), FromProto(proto.spatial().body_2())}};
    case v1::BodyPair::BODIES_NOT_SET:
      break;
  }
  return {};
}

static v1::Link ToProto(const Link& link) {
  v1::Link proto;
  proto.set_length_m(link.length_m);
  proto.set_mass_kg(link.mass_kg);
  proto.set_com_m(link.com_m);
  proto.set_inertia_com_kg_m2(link.inertia_com_kg_m2);
  proto.set_theta_rad(link.theta_rad);
  proto.set_rate_rad_s(link.rate_rad_s);
  return proto;
}

static Link FromProto(const v1::Link& proto) {
  return {.length_m = proto.length_m(),
          .mass_kg = proto.mass_kg(),
          .com_m = proto.com_m(),
          .inertia_com_kg_m2 = proto.inertia_com_kg_m2(),
          .theta_rad = proto.theta_rad(),
          .rate_rad_s = proto.rate_rad_s()};
}

static v1::Linkage ToProto(const Linkage& linkage) {
  v1::Linkage proto;
  for (const Link& link : linkage.links) *proto.add_links() = ToProto(link);
  return proto;
}

static Linkage FromProto(const v1::Linkage& proto) {
  Linkage linkage;
  for (const v1::Link& link : proto.links()) linkage.links.push_back(FromProto(link));
  return linkage;
}

static v1::PlanarContact ToProto(const PlanarContact& contact) {
  v1::PlanarContact proto;
  proto.set_w_tt_per_kg(contact.w_tt_per_kg);
  proto.set_w_tn_per_kg(contact.w_tn_per_kg);
  proto.set_w_nn_per_kg(contact.w_nn_per_kg);
  proto.set_tangential_m_s(contact.tangential_m_s);
  proto.set_normal_m_s(contact.normal_m_s);
  return proto;
}

static PlanarContact FromProto(const v1::PlanarContact& proto) {
  return {.w_tt_per_kg = proto.w_tt_per_kg(),
          .w_tn_per_kg = proto.w_tn_per_kg(),
          .w_nn_per_kg = proto.w_nn_per_kg(),
          .tangential_m_s = proto.tangential_m_s(),
          .normal_m_s = proto.normal_m_s()};
}

static v1::SpatialContact ToProto(const SpatialContact& contact) {
  v1::SpatialContact proto;
  AssignDoubles(contact.w_per_kg, *proto.mutable_w_per_kg());
  AssignDoubles(contact.tangential_m_s, *proto.mutable_tangential_m_s());
  proto.set_normal_m_s(contact.normal_m_s);
  return proto;
}

static SpatialContact FromProto(const v1::SpatialContact& proto) {
  return {.w_per_kg = ToVector(proto.w_per_kg()),
          .tangential_m_s = ToVector(proto.tangential_m_s()),
          .normal_m_s = proto.normal_m_s()};
}

static void SetSystem(const System& system, v1::Scene& proto) {
  std::visit(Overloaded{
                 [](std::monostate) {},
                 [&](const Pendulum& pendulum) { *proto.mutable_pendulum() = ToProto(pendulum); },
                 [&](const PlanarBody& body) { *proto.mutable_planar_body() = ToProto(body); },
                 [&](const SpatialBody& body) { *proto.mutable_spatial_body() = ToProto(body); },
                 [&](const BodyPair& pair) { *proto.mutable_body_pair() = ToProto(pair); },
                 [&](const Linkage& linkage) { *proto.mutable_linkage() = ToProto(linkage); },
                 [&](const PlanarContact& contact) { *proto.mutable_planar_contact() = ToProto(contact); },
                 [&](const SpatialContact& contact) { *proto.mutable_spatial_contact() = ToProto(contact); },
             },
             system);
}

static System SystemOf(const v1::Scene& proto) {
  switch (proto.system_case()) {
    case v1::Scene::kPendulum:
      return FromProto(proto.pendulum());
    case v1::Scene::kPlanarBody:
      return FromProto(proto.planar_body());
    case v1::Scene::kSpatialBody:
      return FromProto(proto.spatial_body());
    case v1::Scene::kBodyPair:
      return FromProto(proto.body_pair());
    case v1::Scene::kLinkage:
      return FromProto(proto.linkage());
    case v1::Scene::kPlanarContact:
      return FromProto(proto.planar_contact());
    case v1::Scene::kSpatialContact:
      return FromProto(proto.spatial_contact());
    case v1::Scene::SYSTEM_NOT_SET:
      break;
  }
  return std::monostate();
}

static v1::SpeedDependence ToProto(const SpeedDependence& dependence) {
  v1::SpeedDependence proto;
  std::visit(Overloaded{
                 [](std::monostate) {},
                 [&](const PowerLaw& law) {
                   proto.mutable_power_law()->set_alpha(law.alpha);
                   proto.mutable_power_law()->set_exponent(law.exponent);
                 },
                 [&](const SpeedTable& table) {
                   AssignDoubles(table.speed_m_s, *proto.mutable_table()->mutable_speed_m_s());
                   AssignDoubles(table.factor, *proto.mutable_table()->mutable_factor());
                 },
             },
             dependence);
  return proto;
}

static SpeedDependence FromProto(const v1::SpeedDependence& proto) {
  switch (proto.form_case()) {
    case v1::SpeedDependence::kPowerLaw:
      return PowerLaw{.alpha = proto.power_law().alpha(), .exponent = proto.power_law().exponent()};
    case v1::SpeedDependence::kTable:
      return SpeedTable{.speed_m_s = ToVector(proto.table().speed_m_s()), .factor = ToVector(proto.table().factor())};
    case v1::SpeedDependence::FORM_NOT_SET:
      break;
  }
  return std::monostate();
}

static v1::Friction ToProto(const Friction& friction) {
  v1::Friction proto;
  proto.set_kinetic_coefficient(friction.kinetic_coefficient);
  if (friction.static_coefficient.has_value()) {
    proto.set_static_coefficient(*friction.static_coefficient);
  }
  if (friction.by_speed.has_value()) *proto.mutable_by_speed() = ToProto(*friction.by_speed);
  return proto;
}

static Friction FromProto(const v1::Friction& proto) {
  Friction friction;
  friction.kinetic_coefficient = proto.kinetic_coefficient();
  if (proto.has_static_coefficient()) friction.static_coefficient = proto.static_coefficient();
  if (proto.has_by_speed()) friction.by_speed = FromProto(proto.by_speed());
  return friction;
}

static v1::SurfaceVelocity ToProto(const SurfaceVelocity& velocity) {
  v1::SurfaceVelocity proto;
  AssignDoubles(velocity.tangential_m_s, *proto.mutable_tangential_m_s());
  proto.set_normal_m_s(velocity.normal_m_s);
  return proto;
}

static SurfaceVelocity FromProto(const v1::SurfaceVelocity& proto) {
  return {.tangential_m_s = ToVector(proto.tangential_m_s()), .normal_m_s = proto.normal_m_s()};
}

static void SetImpactLaw(const ImpactLaw& law, v1::Scene& proto) {
  std::visit(Overloaded{
                 [](std::monostate) {},
                 [&](WhittakerLaw whittaker) { proto.mutable_whittaker()->set_e(whittaker.e); },
                 [&](KaneLevinsonLaw kane_levinson) { proto.mutable_kane_levinson()->set_e(kane_levinson.e); },
                 [&](BrachLaw brach) {
                   proto.mutable_brach()->set_e(brach.e);
                   proto.mutable_brach()->set_mu_hat(brach.mu_hat);
                 },
                 [&](ChatterjeeRuinaLaw chatterjee_ruina) {
                   proto.mutable_chatterjee_ruina()->set_e(chatterjee_ruina.e);
                   proto.mutable_chatterjee_ruina()->set_e_t(chatterjee_ruina.e_t);
                 },
             },
             law);
}

static ImpactLaw ImpactLawOf(const v1::Scene& proto) {
  switch (proto.impact_law_case()) {
    case v1::Scene::kWhittaker:
      return WhittakerLaw{proto.whittaker().e()};
    case v1::Scene::kKaneLevinson:
      return KaneLevinsonLaw{proto.kane_levinson().e()};
    case v1::Scene::kBrach:
      return BrachLaw{proto.brach().e(), proto.brach().mu_hat()};
    case v1::Scene::kChatterjeeRuina:
      return ChatterjeeRuinaLaw{proto.chatterjee_ruina().e(), proto.chatterjee_ruina().e_t()};
    case v1::Scene::IMPACT_LAW_NOT_SET:
      break;
  }
  return std::monostate();
}

static v1::Compliance ToProto(const Compliance& compliance) {
  v1::Compliance proto;
  if (compliance.tangential_ratio_squared.has_value()) {
    proto.set_tangential_ratio_squared(*compliance.tangential_ratio_squared);
  }
  std::visit(Overloaded{
                 [](std::monostate) {},
                 [&](LinearSpring spring) { proto.mutable_linear()->set_stiffness_n_m(spring.stiffness_n_m); },
                 [&](HertzSpring spring) { proto.mutable_hertz()->set_stiffness_n_m1_5(spring.stiffness_n_m1_5); },
                 [&](const HuntCrossleySpring& spring) {
                   proto.mutable_hunt_crossley()->set_stiffness_n_m_p(spring.stiffness_n_m_p);
                   proto.mutable_hunt_crossley()->set_exponent(spring.exponent);
                   proto.mutable_hunt_crossley()->set_damping_s_m(spring.damping_s_m);
                 },
             },
             compliance.normal);
  return proto;
}

static NormalSpring SpringOf(const v1::Compliance& proto) {
  switch (proto.normal_case()) {
    case v1::Compliance::kLinear:
      return LinearSpring{proto.linear().stiffness_n_m()};
    case v1::Compliance::kHertz:
      return HertzSpring{proto.hertz().stiffness_n_m1_5()};
    case v1::Compliance::kHuntCrossley:
      return HuntCrossleySpring{.stiffness_n_m_p = proto.hunt_crossley().stiffness_n_m_p(),
                                .exponent = proto.hunt_crossley().exponent(),
                                .damping_s_m = proto.hunt_crossley().damping_s_m()};
    case v1::Compliance::NORMAL_NOT_SET:
      break;
  }
  return std::monostate();
}

static Compliance FromProto(const v1::Compliance& proto) {
  Compliance compliance{.tangential_ratio_squared = std::nullopt, .normal = SpringOf(proto)};
  if (proto.has_tangential_ratio_squared()) compliance.tangential_ratio_squared = proto.tangential_ratio_squared();
  return compliance;
}

// Gravity and ContactAcceleration have the same fields.
template <typename Acceleration, typename AccelerationProto>
static void SetAcceleration(const Acceleration& acceleration, AccelerationProto& proto) {
  proto.set_tangential_m_s2(acceleration.tangential_m_s2);
  proto.set_normal_m_s2(acceleration.normal_m_s2);
}

template <typename Acceleration, typename AccelerationProto>
static Acceleration AccelerationOf(const AccelerationProto& proto) {
  return {.tangential_m_s2 = proto.tangential_m_s2(), .normal_m_s2 = proto.normal_m_s2()};
}

static void SetFiniteForces(const FiniteForces& forces, v1::Scene& proto) {
  std::visit(Overloaded{
                 [](std::monostate) {},
                 [&](const Gravity& gravity) { SetAcceleration(gravity, *proto.mutable_gravity()); },
                 [&](PinMoment moment) { proto.mutable_pin_moment()->set_moment_n_m(moment.moment_n_m); },
                 [&](const ContactAcceleration& acceleration) {
                   SetAcceleration(acceleration, *proto.mutable_contact_acceleration());
                 },
             },
             forces);
}

static FiniteForces FiniteForcesOf(const v1::Scene& proto) {
  switch (proto.finite_forces_case()) {
    case v1::Scene::kGravity:
      return AccelerationOf<Gravity>(proto.gravity());
    case v1::Scene::kPinMoment:
      return PinMoment{proto.pin_moment().moment_n_m()};
    case v1::Scene::kContactAcceleration:
      return AccelerationOf<ContactAcceleration>(proto.contact_acceleration());
    case v1::Scene::FINITE_FORCES_NOT_SET:
      break;
  }
  return std::monostate();
}

static void SetRestitution(const Restitution& restitution, v1::Scene& proto) {
  std::visit(Overloaded{
                 [](std::monostate) {},
                 [&](NewtonCoefficient newton) { proto.mutable_restitution()->set_newton(newton.value); },
                 [&](PoissonCoefficient poisson) { proto.mutable_restitution()->set_poisson(poisson.value); },
                 [&](EnergeticCoefficient energetic) { proto.mutable_restitution()->set_energetic(energetic.value); },
             },
             restitution);
}

static Restitution FromProto(const v1::Restitution& proto) {
  switch (proto.coefficient_case()) {
    case v1::Restitution::kNewton:
      return NewtonCoefficient{proto.newton()};
    case v1::Restitution::kPoisson:
      return PoissonCoefficient{proto.poisson()};
    case v1::Restitution::kEnergetic:
      return EnergeticCoefficient{proto.energetic()};
    case v1::Restitution::COEFFICIENT_NOT_SET:
      break;
  }
  return std::monostate();
}

v1::Scene ToProto(const Scene& scene) {
  v1::Scene proto;
  SetSystem(scene.system, proto);
  *proto.mutable_friction() = ToProto(scene.friction);
  SetRestitution(scene.restitution, proto);
  if (scene.restitution_by_speed.has_value()) {
    *proto.mutable_restitution()->mutable_by_speed() = ToProto(*scene.restitution_by_speed);
  }
  if (scene.surface_velocity.has_value()) *proto.mutable_surface_velocity() = ToProto(*scene.surface_velocity);
  SetImpactLaw(scene.impact_law, proto);
  if (scene.compliance.has_value()) *proto.mutable_compliance() = ToProto(*scene.compliance);
  SetFiniteForces(scene.finite_forces, proto);
  return proto;
}

Scene FromProto(const v1::Scene& proto) {
  Scene scene{.system = SystemOf(proto),
              .friction = FromProto(proto.friction()),
              .restitution = FromProto(proto.restitution()),
              .impact_law = ImpactLawOf(proto),
              .finite_forces = FiniteForcesOf(proto)};
  if (proto.restitution().has_by_speed()) scene.restitution_by_speed = FromProto(proto.restitution().by_speed());
  if (proto.has_compliance()) scene.compliance = FromProto(proto.compliance());
  if (proto.has_surface_velocity()) scene.surface_velocity = FromProto(proto.surface_velocity());
  return scene;
}

}  // namespace ricochet
