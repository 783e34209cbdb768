#include "proto/wire/scene.h"

#include "proto/wire/map.h"

namespace ricochet {

template <>
struct Map<Pendulum> : Between<Pendulum, v1::Pendulum> {
  using Fields = Entries<Entry(&T::inertia_kg_m2, &P::inertia_kg_m2, &P::set_inertia_kg_m2),
                         Entry(&T::a_m, &P::a_m, &P::set_a_m), Entry(&T::b_m, &P::b_m, &P::set_b_m),
                         Entry(&T::omega_minus_rad_s, &P::omega_minus_rad_s, &P::set_omega_minus_rad_s)>;
};

template <>
struct Map<PlanarBody> : Between<PlanarBody, v1::PlanarBody> {
  using Fields = Entries<Entry(&T::mass_kg, &P::mass_kg, &P::set_mass_kg),
                         Entry(&T::inertia_com_kg_m2, &P::inertia_com_kg_m2, &P::set_inertia_com_kg_m2),
                         Entry(&T::offset_t_m, &P::offset_t_m, &P::set_offset_t_m),
                         Entry(&T::offset_n_m, &P::offset_n_m, &P::set_offset_n_m),
                         Entry(&T::velocity_t_m_s, &P::velocity_t_m_s, &P::set_velocity_t_m_s),
                         Entry(&T::velocity_n_m_s, &P::velocity_n_m_s, &P::set_velocity_n_m_s),
                         Entry(&T::rate_rad_s, &P::rate_rad_s, &P::set_rate_rad_s)>;
};

template <>
struct Map<SpatialBody> : Between<SpatialBody, v1::SpatialBody> {
  using Fields = Entries<Entry(&T::mass_kg, &P::mass_kg, &P::set_mass_kg),
                         Entry(&T::inertia_com_kg_m2, &P::inertia_com_kg_m2, &P::mutable_inertia_com_kg_m2),
                         Entry(&T::offset_m, &P::offset_m, &P::mutable_offset_m),
                         Entry(&T::linear_m_s, &P::linear_m_s, &P::mutable_linear_m_s),
                         Entry(&T::angular_rad_s, &P::angular_rad_s, &P::mutable_angular_rad_s)>;
};

template <>
struct Map<PlanarPair> : Between<PlanarPair, v1::PlanarPair> {
  using Fields =
      Entries<Entry(&T::body_1, &P::body_1, &P::mutable_body_1), Entry(&T::body_2, &P::body_2, &P::mutable_body_2)>;
};

template <>
struct Map<SpatialPair> : Between<SpatialPair, v1::SpatialPair> {
  using Fields =
      Entries<Entry(&T::body_1, &P::body_1, &P::mutable_body_1), Entry(&T::body_2, &P::body_2, &P::mutable_body_2)>;
};

template <>
struct Map<BodyPair> : Between<BodyPair, v1::BodyPair> {
  using Fields = Entries<Flat<&T::bodies, OneOf<Case(&P::has_planar, &P::planar, &P::mutable_planar),
                                                Case(&P::has_spatial, &P::spatial, &P::mutable_spatial)>>{}>;
};

template <>
struct Map<Link> : Between<Link, v1::Link> {
  using Fields = Entries<Entry(&T::length_m, &P::length_m, &P::set_length_m),
                         Entry(&T::mass_kg, &P::mass_kg, &P::set_mass_kg), Entry(&T::com_m, &P::com_m, &P::set_com_m),
                         Entry(&T::inertia_com_kg_m2, &P::inertia_com_kg_m2, &P::set_inertia_com_kg_m2),
                         Entry(&T::theta_rad, &P::theta_rad, &P::set_theta_rad),
                         Entry(&T::rate_rad_s, &P::rate_rad_s, &P::set_rate_rad_s)>;
};

template <>
struct Map<Linkage> : Between<Linkage, v1::Linkage> {
  using Fields = Entries<Entry(&T::links, &P::links, &P::mutable_links)>;
};

template <>
struct Map<PlanarContact> : Between<PlanarContact, v1::PlanarContact> {
  using Fields = Entries<Entry(&T::w_tt_per_kg, &P::w_tt_per_kg, &P::set_w_tt_per_kg),
                         Entry(&T::w_tn_per_kg, &P::w_tn_per_kg, &P::set_w_tn_per_kg),
                         Entry(&T::w_nn_per_kg, &P::w_nn_per_kg, &P::set_w_nn_per_kg),
                         Entry(&T::tangential_m_s, &P::tangential_m_s, &P::set_tangential_m_s),
                         Entry(&T::normal_m_s, &P::normal_m_s, &P::set_normal_m_s)>;
};

template <>
struct Map<SpatialContact> : Between<SpatialContact, v1::SpatialContact> {
  using Fields = Entries<Entry(&T::w_per_kg, &P::w_per_kg, &P::mutable_w_per_kg),
                         Entry(&T::tangential_m_s, &P::tangential_m_s, &P::mutable_tangential_m_s),
                         Entry(&T::normal_m_s, &P::normal_m_s, &P::set_normal_m_s)>;
};

template <>
struct Map<Mechanism> : Between<Mechanism, v1::Mechanism> {
  using Fields =
      Entries<Entry(&T::mass_matrix, &P::mass_matrix, &P::mutable_mass_matrix),
              Entry(&T::jacobian, &P::jacobian, &P::mutable_jacobian), Entry(&T::rates, &P::rates, &P::mutable_rates),
              Entry(&T::kept_coordinates, &P::kept_coordinates, &P::mutable_kept_coordinates),
              Entry(&T::composite, &P::composite, &P::set_composite)>;
};

template <>
struct Map<PowerLaw> : Between<PowerLaw, v1::PowerLaw> {
  using Fields =
      Entries<Entry(&T::alpha, &P::alpha, &P::set_alpha), Entry(&T::exponent, &P::exponent, &P::set_exponent)>;
};

template <>
struct Map<SpeedTable> : Between<SpeedTable, v1::SpeedTable> {
  using Fields = Entries<Entry(&T::speed_m_s, &P::speed_m_s, &P::mutable_speed_m_s),
                         Entry(&T::factor, &P::factor, &P::mutable_factor)>;
};

template <>
struct Map<SpeedDependence> : Between<SpeedDependence, v1::SpeedDependence> {
  using Fields = OneOf<Case(&P::has_power_law, &P::power_law, &P::mutable_power_law),
                       Case(&P::has_table, &P::table, &P::mutable_table)>;
};

template <>
struct Map<Friction> : Between<Friction, v1::Friction> {
  using Fields = Entries<Entry(&T::kinetic_coefficient, &P::kinetic_coefficient, &P::set_kinetic_coefficient),
                         Entry(&T::static_coefficient, &P::has_static_coefficient, &P::static_coefficient,
                               &P::set_static_coefficient),
                         Entry(&T::by_speed, &P::has_by_speed, &P::by_speed, &P::mutable_by_speed)>;
};

template <>
struct Map<SurfaceVelocity> : Between<SurfaceVelocity, v1::SurfaceVelocity> {
  using Fields = Entries<Entry(&T::tangential_m_s, &P::tangential_m_s, &P::mutable_tangential_m_s),
                         Entry(&T::normal_m_s, &P::normal_m_s, &P::set_normal_m_s)>;
};

template <>
struct Map<LinearSpring> : Between<LinearSpring, v1::LinearSpring> {
  using Fields = Entries<Entry(&T::stiffness_n_m, &P::stiffness_n_m, &P::set_stiffness_n_m)>;
};

template <>
struct Map<HertzSpring> : Between<HertzSpring, v1::HertzSpring> {
  using Fields = Entries<Entry(&T::stiffness_n_m1_5, &P::stiffness_n_m1_5, &P::set_stiffness_n_m1_5)>;
};

template <>
struct Map<HuntCrossleySpring> : Between<HuntCrossleySpring, v1::HuntCrossleySpring> {
  using Fields = Entries<Entry(&T::stiffness_n_m_p, &P::stiffness_n_m_p, &P::set_stiffness_n_m_p),
                         Entry(&T::exponent, &P::exponent, &P::set_exponent),
                         Entry(&T::damping_s_m, &P::damping_s_m, &P::set_damping_s_m)>;
};

template <>
struct Map<Compliance> : Between<Compliance, v1::Compliance> {
  using Fields =
      Entries<Entry(&T::tangential_ratio_squared, &P::has_tangential_ratio_squared, &P::tangential_ratio_squared,
                    &P::set_tangential_ratio_squared),
              Flat<&T::normal, OneOf<Case(&P::has_linear, &P::linear, &P::mutable_linear),
                                     Case(&P::has_hertz, &P::hertz, &P::mutable_hertz),
                                     Case(&P::has_hunt_crossley, &P::hunt_crossley, &P::mutable_hunt_crossley)>>{}>;
};

template <>
struct Map<WhittakerLaw> : Between<WhittakerLaw, v1::Whittaker> {
  using Fields = Entries<Entry(&T::e, &P::e, &P::set_e)>;
};

template <>
struct Map<KaneLevinsonLaw> : Between<KaneLevinsonLaw, v1::KaneLevinson> {
  using Fields = Entries<Entry(&T::e, &P::e, &P::set_e)>;
};

template <>
struct Map<BrachLaw> : Between<BrachLaw, v1::Brach> {
  using Fields = Entries<Entry(&T::e, &P::e, &P::set_e), Entry(&T::mu_hat, &P::mu_hat, &P::set_mu_hat)>;
};

template <>
struct Map<ChatterjeeRuinaLaw> : Between<ChatterjeeRuinaLaw, v1::ChatterjeeRuina> {
  using Fields = Entries<Entry(&T::e, &P::e, &P::set_e), Entry(&T::e_t, &P::e_t, &P::set_e_t)>;
};

template <>
struct Map<Gravity> : Between<Gravity, v1::Gravity> {
  using Fields = Entries<Entry(&T::tangential_m_s2, &P::tangential_m_s2, &P::set_tangential_m_s2),
                         Entry(&T::normal_m_s2, &P::normal_m_s2, &P::set_normal_m_s2)>;
};

template <>
struct Map<PinMoment> : Between<PinMoment, v1::PinMoment> {
  using Fields = Entries<Entry(&T::moment_n_m, &P::moment_n_m, &P::set_moment_n_m)>;
};

template <>
struct Map<ContactAcceleration> : Between<ContactAcceleration, v1::ContactAcceleration> {
  using Fields = Entries<Entry(&T::tangential_m_s2, &P::tangential_m_s2, &P::set_tangential_m_s2),
                         Entry(&T::normal_m_s2, &P::normal_m_s2, &P::set_normal_m_s2)>;
};

// A scene has its restitution and the dependence on speed as two members. The message of both is sent if one is set.
struct RestitutionEntry {
  using P = v1::Restitution;
  using Fields =
      Entries<Flat<&Scene::restitution,
                   OneOf<Case(&NewtonCoefficient::value, &P::has_newton, &P::newton, &P::set_newton),
                         Case(&PoissonCoefficient::value, &P::has_poisson, &P::poisson, &P::set_poisson),
                         Case(&EnergeticCoefficient::value, &P::has_energetic, &P::energetic, &P::set_energetic)>>{},
              Entry(&Scene::restitution_by_speed, &P::has_by_speed, &P::by_speed, &P::mutable_by_speed)>;

  static void Write(const Scene& scene, v1::Scene& proto) {
    const bool is_set = scene.restitution.index() != 0 || scene.restitution_by_speed.has_value();
    if (is_set) Fields::Write(scene, *proto.mutable_restitution());
  }
  static void Read(const v1::Scene& proto, Scene& scene) { Fields::Read(proto.restitution(), scene); }
};

template <>
struct Map<Scene> : Between<Scene, v1::Scene> {
  using Fields = Entries<
      Flat<&T::system, OneOf<Case(&P::has_pendulum, &P::pendulum, &P::mutable_pendulum),
                             Case(&P::has_planar_body, &P::planar_body, &P::mutable_planar_body),
                             Case(&P::has_spatial_body, &P::spatial_body, &P::mutable_spatial_body),
                             Case(&P::has_body_pair, &P::body_pair, &P::mutable_body_pair),
                             Case(&P::has_linkage, &P::linkage, &P::mutable_linkage),
                             Case(&P::has_planar_contact, &P::planar_contact, &P::mutable_planar_contact),
                             Case(&P::has_spatial_contact, &P::spatial_contact, &P::mutable_spatial_contact),
                             Case(&P::has_mechanism, &P::mechanism, &P::mutable_mechanism)>>{},
      Entry(&T::friction, &P::friction, &P::mutable_friction), RestitutionEntry{},
      Entry(&T::surface_velocity, &P::has_surface_velocity, &P::surface_velocity, &P::mutable_surface_velocity),
      Flat<&T::impact_law, OneOf<Case(&P::has_whittaker, &P::whittaker, &P::mutable_whittaker),
                                 Case(&P::has_kane_levinson, &P::kane_levinson, &P::mutable_kane_levinson),
                                 Case(&P::has_brach, &P::brach, &P::mutable_brach),
                                 Case(&P::has_chatterjee_ruina, &P::chatterjee_ruina, &P::mutable_chatterjee_ruina)>>{},
      Entry(&T::compliance, &P::has_compliance, &P::compliance, &P::mutable_compliance),
      Flat<&T::finite_forces,
           OneOf<Case(&P::has_gravity, &P::gravity, &P::mutable_gravity),
                 Case(&P::has_pin_moment, &P::pin_moment, &P::mutable_pin_moment),
                 Case(&P::has_contact_acceleration, &P::contact_acceleration, &P::mutable_contact_acceleration)>>{}>;
};

void ToProto(const Scene& scene, v1::Scene& proto) { Map<Scene>::Fields::Write(scene, proto); }
void FromProto(const v1::Scene& proto, Scene& scene) { Map<Scene>::Fields::Read(proto, scene); }

void ToProto(const Mechanism& mechanism, v1::Mechanism& proto) { Map<Mechanism>::Fields::Write(mechanism, proto); }
void FromProto(const v1::Mechanism& proto, Mechanism& mechanism) { Map<Mechanism>::Fields::Read(proto, mechanism); }

v1::Scene ToProto(const Scene& scene) { return Sent(scene); }
Scene FromProto(const v1::Scene& proto) { return Received<Scene>(proto); }

}  // namespace ricochet
