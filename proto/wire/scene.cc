#include "proto/wire/scene.h"

#include "proto/wire/map.h"

namespace ricochet {

template <>
struct Map<Pendulum> : Between<Pendulum, v1::Pendulum> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(inertia_kg_m2), RICOCHET_FIELD(a_m), RICOCHET_FIELD(b_m),
                                          RICOCHET_FIELD(omega_minus_rad_s));
};

template <>
struct Map<PlanarBody> : Between<PlanarBody, v1::PlanarBody> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(mass_kg), RICOCHET_FIELD(inertia_com_kg_m2), RICOCHET_FIELD(offset_t_m),
              RICOCHET_FIELD(offset_n_m), RICOCHET_FIELD(velocity_t_m_s), RICOCHET_FIELD(velocity_n_m_s),
              RICOCHET_FIELD(rate_rad_s));
};

template <>
struct Map<SpatialBody> : Between<SpatialBody, v1::SpatialBody> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(mass_kg), RICOCHET_FIELD(inertia_com_kg_m2), RICOCHET_FIELD(offset_m),
              RICOCHET_FIELD(linear_m_s), RICOCHET_FIELD(angular_rad_s));
};

template <>
struct Map<PlanarPair> : Between<PlanarPair, v1::PlanarPair> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(body_1), RICOCHET_FIELD(body_2));
};

template <>
struct Map<SpatialPair> : Between<SpatialPair, v1::SpatialPair> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(body_1), RICOCHET_FIELD(body_2));
};

template <>
struct Map<BodyPair> : Between<BodyPair, v1::BodyPair> {
  static constexpr auto kFields = Entries(Flat(&T::bodies, OneOf(RICOCHET_ACCESS(planar), RICOCHET_ACCESS(spatial))));
};

template <>
struct Map<Link> : Between<Link, v1::Link> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(length_m), RICOCHET_FIELD(mass_kg), RICOCHET_FIELD(com_m),
              RICOCHET_FIELD(inertia_com_kg_m2), RICOCHET_FIELD(theta_rad), RICOCHET_FIELD(rate_rad_s));
};

template <>
struct Map<Linkage> : Between<Linkage, v1::Linkage> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(links));
};

template <>
struct Map<PlanarContact> : Between<PlanarContact, v1::PlanarContact> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(w_tt_per_kg), RICOCHET_FIELD(w_tn_per_kg), RICOCHET_FIELD(w_nn_per_kg),
              RICOCHET_FIELD(tangential_m_s), RICOCHET_FIELD(normal_m_s));
};

template <>
struct Map<SpatialContact> : Between<SpatialContact, v1::SpatialContact> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(w_per_kg), RICOCHET_FIELD(tangential_m_s), RICOCHET_FIELD(normal_m_s));
};

template <>
struct Map<Mechanism> : Between<Mechanism, v1::Mechanism> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(mass_matrix), RICOCHET_FIELD(jacobian), RICOCHET_FIELD(rates),
                                          RICOCHET_FIELD(kept_coordinates), RICOCHET_FIELD(composite));
};

template <>
struct Map<PowerLaw> : Between<PowerLaw, v1::PowerLaw> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(alpha), RICOCHET_FIELD(exponent));
};

template <>
struct Map<SpeedTable> : Between<SpeedTable, v1::SpeedTable> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(speed_m_s), RICOCHET_FIELD(factor));
};

template <>
struct Map<SpeedDependence> : Between<SpeedDependence, v1::SpeedDependence> {
  static constexpr auto kFields = OneOf(RICOCHET_ACCESS(power_law), RICOCHET_ACCESS(table));
};

template <>
struct Map<Friction> : Between<Friction, v1::Friction> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(kinetic_coefficient), RICOCHET_FIELD(static_coefficient), RICOCHET_FIELD(by_speed));
};

template <>
struct Map<SurfaceVelocity> : Between<SurfaceVelocity, v1::SurfaceVelocity> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(tangential_m_s), RICOCHET_FIELD(normal_m_s));
};

template <>
struct Map<LinearSpring> : Between<LinearSpring, v1::LinearSpring> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(stiffness_n_m));
};

template <>
struct Map<HertzSpring> : Between<HertzSpring, v1::HertzSpring> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(stiffness_n_m1_5));
};

template <>
struct Map<HuntCrossleySpring> : Between<HuntCrossleySpring, v1::HuntCrossleySpring> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(stiffness_n_m_p), RICOCHET_FIELD(exponent), RICOCHET_FIELD(damping_s_m));
};

template <>
struct Map<Compliance> : Between<Compliance, v1::Compliance> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(tangential_ratio_squared),
              Flat(&T::normal, OneOf(RICOCHET_ACCESS(linear), RICOCHET_ACCESS(hertz), RICOCHET_ACCESS(hunt_crossley))));
};

template <>
struct Map<WhittakerLaw> : Between<WhittakerLaw, v1::Whittaker> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(e));
};

template <>
struct Map<KaneLevinsonLaw> : Between<KaneLevinsonLaw, v1::KaneLevinson> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(e));
};

template <>
struct Map<BrachLaw> : Between<BrachLaw, v1::Brach> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(e), RICOCHET_FIELD(mu_hat));
};

template <>
struct Map<ChatterjeeRuinaLaw> : Between<ChatterjeeRuinaLaw, v1::ChatterjeeRuina> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(e), RICOCHET_FIELD(e_t));
};

template <>
struct Map<Gravity> : Between<Gravity, v1::Gravity> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(tangential_m_s2), RICOCHET_FIELD(normal_m_s2));
};

template <>
struct Map<PinMoment> : Between<PinMoment, v1::PinMoment> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(moment_n_m));
};

template <>
struct Map<ContactAcceleration> : Between<ContactAcceleration, v1::ContactAcceleration> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(tangential_m_s2), RICOCHET_FIELD(normal_m_s2));
};

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

void ToProto(const Scene& scene, v1::Scene& proto) { Map<Scene>::kFields.Write(scene, proto); }
void FromProto(const v1::Scene& proto, Scene& scene) { Map<Scene>::kFields.Read(proto, scene); }

void ToProto(const Mechanism& mechanism, v1::Mechanism& proto) { Map<Mechanism>::kFields.Write(mechanism, proto); }
void FromProto(const v1::Mechanism& proto, Mechanism& mechanism) { Map<Mechanism>::kFields.Read(proto, mechanism); }

v1::Scene ToProto(const Scene& scene) { return Sent(scene); }
Scene FromProto(const v1::Scene& proto) { return Received<Scene>(proto); }

}  // namespace ricochet
