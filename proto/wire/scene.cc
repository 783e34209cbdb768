#include "proto/wire/scene.h"

#include <variant>

#include "proto/wire/overloaded.h"

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

static v1::Friction ToProto(const Friction& friction) {
  v1::Friction proto;
  proto.set_kinetic_coefficient(friction.kinetic_coefficient);
  if (friction.static_coefficient.has_value()) {
    proto.set_static_coefficient(*friction.static_coefficient);
  }
  return proto;
}

static Friction FromProto(const v1::Friction& proto) {
  Friction friction;
  friction.kinetic_coefficient = proto.kinetic_coefficient();
  if (proto.has_static_coefficient()) friction.static_coefficient = proto.static_coefficient();
  return friction;
}

static void SetSystem(const System& system, v1::Scene& proto) {
  std::visit(Overloaded{
                 [](std::monostate) {},
                 [&](const Pendulum& pendulum) { *proto.mutable_pendulum() = ToProto(pendulum); },
             },
             system);
}

static System SystemOf(const v1::Scene& proto) {
  switch (proto.system_case()) {
    case v1::Scene::kPendulum:
      return FromProto(proto.pendulum());
    case v1::Scene::SYSTEM_NOT_SET:
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
  return proto;
}

Scene FromProto(const v1::Scene& proto) {
  return {.system = SystemOf(proto),
          .friction = FromProto(proto.friction()),
          .restitution = FromProto(proto.restitution())};
}

}  // namespace ricochet
