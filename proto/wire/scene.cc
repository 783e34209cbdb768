#include "proto/wire/scene.h"

#include "proto/wire/map.h"

namespace ricochet {

RICOCHET_MAP(Pendulum, inertia_kg_m2, a_m, b_m, omega_minus_rad_s);
RICOCHET_MAP(PlanarBody, mass_kg, inertia_com_kg_m2, offset_t_m, offset_n_m, velocity_t_m_s, velocity_n_m_s,
             rate_rad_s);
RICOCHET_MAP(SpatialBody, mass_kg, inertia_com_kg_m2, offset_m, linear_m_s, angular_rad_s);
RICOCHET_MAP(PlanarPair, body_1, body_2);
RICOCHET_MAP(SpatialPair, body_1, body_2);

template <>
struct Map<BodyPair> : Between<BodyPair, v1::BodyPair> {
  static constexpr auto kFields = Entries(Flat(&T::bodies, OneOf(RICOCHET_ACCESS(planar), RICOCHET_ACCESS(spatial))));
};

RICOCHET_MAP(Link, length_m, mass_kg, com_m, inertia_com_kg_m2, theta_rad, rate_rad_s);
RICOCHET_MAP(Linkage, links);
RICOCHET_MAP(PlanarContact, w_tt_per_kg, w_tn_per_kg, w_nn_per_kg, tangential_m_s, normal_m_s);
RICOCHET_MAP(SpatialContact, w_per_kg, tangential_m_s, normal_m_s);
RICOCHET_MAP(Mechanism, mass_matrix, jacobian, rates, kept_coordinates, composite);
RICOCHET_MAP(PowerLaw, alpha, exponent);
RICOCHET_MAP(SpeedTable, speed_m_s, factor);

template <>
struct Map<SpeedDependence> : Between<SpeedDependence, v1::SpeedDependence> {
  static constexpr auto kFields = OneOf(RICOCHET_ACCESS(power_law), RICOCHET_ACCESS(table));
};

RICOCHET_MAP(Friction, kinetic_coefficient, static_coefficient, by_speed);
RICOCHET_MAP(SurfaceVelocity, tangential_m_s, normal_m_s);
RICOCHET_MAP(LinearSpring, stiffness_n_m);
RICOCHET_MAP(HertzSpring, stiffness_n_m1_5);
RICOCHET_MAP(HuntCrossleySpring, stiffness_n_m_p, exponent, damping_s_m);

template <>
struct Map<Compliance> : Between<Compliance, v1::Compliance> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(tangential_ratio_squared),
              Flat(&T::normal, OneOf(RICOCHET_ACCESS(linear), RICOCHET_ACCESS(hertz), RICOCHET_ACCESS(hunt_crossley))));
};

RICOCHET_MAP_AS(WhittakerLaw, v1::Whittaker, e);
RICOCHET_MAP_AS(KaneLevinsonLaw, v1::KaneLevinson, e);
RICOCHET_MAP_AS(BrachLaw, v1::Brach, e, mu_hat);
RICOCHET_MAP_AS(ChatterjeeRuinaLaw, v1::ChatterjeeRuina, e, e_t);
RICOCHET_MAP(Gravity, tangential_m_s2, normal_m_s2);
RICOCHET_MAP(PinMoment, moment_n_m);
RICOCHET_MAP(ContactAcceleration, tangential_m_s2, normal_m_s2);

// A scene has its restitution and the dependence on speed as two members. The message of both is sent if one is set.
struct RestitutionEntry {
  static constexpr auto kFields =
      Entries(Flat(&Scene::restitution, OneOf(RICOCHET_FIELD_AS(value, newton), RICOCHET_FIELD_AS(value, poisson),
                                              RICOCHET_FIELD_AS(value, energetic))),
              RICOCHET_FIELD_AS(restitution_by_speed, by_speed));

  static void Write(const Scene& scene, v1::Scene& proto) {
    const bool is_set = scene.restitution.index() != 0 || scene.restitution_by_speed.has_value();
    if (is_set) kFields.Write(scene, *proto.mutable_restitution());
  }
  static void Read(const v1::Scene& proto, Scene& scene) { kFields.Read(proto.restitution(), scene); }
};

template <>
struct Map<Scene> : Between<Scene, v1::Scene> {
  static constexpr auto kFields = Entries(
      Flat(&T::system, OneOf(RICOCHET_ACCESS(pendulum), RICOCHET_ACCESS(planar_body), RICOCHET_ACCESS(spatial_body),
                             RICOCHET_ACCESS(body_pair), RICOCHET_ACCESS(linkage), RICOCHET_ACCESS(planar_contact),
                             RICOCHET_ACCESS(spatial_contact), RICOCHET_ACCESS(mechanism))),
      RICOCHET_FIELD(friction), RestitutionEntry{}, RICOCHET_FIELD(surface_velocity),
      Flat(&T::impact_law, OneOf(RICOCHET_ACCESS(whittaker), RICOCHET_ACCESS(kane_levinson), RICOCHET_ACCESS(brach),
                                 RICOCHET_ACCESS(chatterjee_ruina))),
      RICOCHET_FIELD(compliance),
      Flat(&T::finite_forces,
           OneOf(RICOCHET_ACCESS(gravity), RICOCHET_ACCESS(pin_moment), RICOCHET_ACCESS(contact_acceleration))));
};

RICOCHET_CONVERT_IN_PLACE(Scene);
RICOCHET_CONVERT_IN_PLACE(Mechanism);
RICOCHET_CONVERT(Scene);

}  // namespace ricochet
