#include "proto/wire/multi_contact.h"

#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/scene.h"

namespace ricochet {

template <>
struct Map<ContactMatrix> : Between<ContactMatrix, v1::ContactMatrix> {
  using Fields = Entries<Entry(&T::w_per_kg, &P::w_per_kg, &P::mutable_w_per_kg),
                         Entry(&T::velocity_m_s, &P::velocity_m_s, &P::mutable_velocity_m_s)>;
};

template <>
struct Map<FreeBody> : Between<FreeBody, v1::FreeBody> {
  using Fields = Entries<Entry(&T::mass_kg, &P::mass_kg, &P::set_mass_kg),
                         Entry(&T::inertia_com_kg_m2, &P::inertia_com_kg_m2, &P::mutable_inertia_com_kg_m2),
                         Entry(&T::position_m, &P::position_m, &P::mutable_position_m),
                         Entry(&T::linear_m_s, &P::linear_m_s, &P::mutable_linear_m_s),
                         Entry(&T::angular_rad_s, &P::angular_rad_s, &P::mutable_angular_rad_s)>;
};

template <>
struct Map<FreeBodies> : Between<FreeBodies, v1::FreeBodies> {
  using Fields = Entries<Entry(&T::bodies, &P::bodies, &P::mutable_bodies)>;
};

template <>
struct Map<MultiContactPoint> : Between<MultiContactPoint, v1::MultiContactPoint> {
  using Fields =
      Entries<Entry(&T::friction, &P::friction, &P::set_friction),
              Entry(&T::energetic, &P::has_energetic, &P::energetic, &P::set_energetic),
              Entry(&T::relative_stiffness, &P::has_relative_stiffness, &P::relative_stiffness,
                    &P::set_relative_stiffness),
              Entry(&T::body, &P::body, &P::set_body), Entry(&T::other_body, &P::other_body, &P::set_other_body),
              Entry(&T::point_m, &P::point_m, &P::mutable_point_m), Entry(&T::normal, &P::normal, &P::mutable_normal)>;
};

template <>
struct Map<MultiContactScene> : Between<MultiContactScene, v1::MultiContactScene> {
  using Fields =
      Entries<Flat<&T::system, OneOf<Case(&P::has_contact_matrix, &P::contact_matrix, &P::mutable_contact_matrix),
                                     Case(&P::has_free_bodies, &P::free_bodies, &P::mutable_free_bodies),
                                     Case(&P::has_mechanism, &P::mechanism, &P::mutable_mechanism)>>{},
              Entry(&T::contacts, &P::contacts, &P::mutable_contacts)>;
};

template <>
struct Map<MultiContactState> : Between<MultiContactState, v1::MultiContactState> {
  using Fields = Entries<Entry(&T::velocity, &P::velocity, &P::mutable_velocity)>;
};

template <>
struct Map<LinearOutput> : Between<LinearOutput, v1::LinearOutput> {
  using Fields = Entries<Entry(&T::name, &P::name, &P::mutable_name),
                         Entry(&T::coefficients, &P::coefficients, &P::mutable_coefficients)>;
};

template <>
struct Map<StiffnessRange> : Between<StiffnessRange, v1::StiffnessRange> {
  using Fields = Entries<Entry(&T::contact, &P::contact, &P::set_contact), Entry(&T::low, &P::low, &P::set_low),
                         Entry(&T::high, &P::high, &P::set_high)>;
};

template <>
struct Map<MultiContactRequest> : Between<MultiContactRequest, v1::MultiContactRequest> {
  using Fields =
      Entries<Entry(&T::scene, &P::scene, &P::mutable_scene), Entry(&T::states, &P::states, &P::mutable_states),
              Entry(&T::methods, &P::methods, &P::mutable_methods),
              Entry(&T::outputs, &P::outputs, &P::mutable_outputs),
              Entry(&T::stiffness_range, &P::has_stiffness_range, &P::stiffness_range, &P::mutable_stiffness_range)>;
};

template <>
struct Map<ContactLedger> : Between<ContactLedger, v1::ContactLedger> {
  using Fields = Entries<Entry(&T::work_compression_j, &P::work_compression_j, &P::set_work_compression_j),
                         Entry(&T::work_restitution_j, &P::work_restitution_j, &P::set_work_restitution_j),
                         Entry(&T::work_friction_j, &P::work_friction_j, &P::set_work_friction_j),
                         Entry(&T::newton, &P::has_newton, &P::newton, &P::set_newton),
                         Entry(&T::poisson, &P::has_poisson, &P::poisson, &P::set_poisson)>;
};

template <>
struct Map<AttainedOutcome> : Between<AttainedOutcome, v1::AttainedOutcome> {
  using Fields = Entries<
      Entry(&T::orders, &P::orders, &P::mutable_orders), Entry(&T::order_count, &P::order_count, &P::set_order_count),
      Entry(&T::end, &P::end, &P::set_end), Entry(&T::events, &P::events, &P::set_events),
      Entry(&T::contact_velocity_m_s, &P::contact_velocity_m_s, &P::mutable_contact_velocity_m_s),
      Entry(&T::contact_velocity_error_m_s, &P::contact_velocity_error_m_s, &P::mutable_contact_velocity_error_m_s),
      Entry(&T::velocity, &P::velocity, &P::mutable_velocity),
      Entry(&T::velocity_error, &P::velocity_error, &P::mutable_velocity_error),
      Entry(&T::impulse_n_s, &P::impulse_n_s, &P::mutable_impulse_n_s),
      Entry(&T::normal_impulse_error_n_s, &P::normal_impulse_error_n_s, &P::mutable_normal_impulse_error_n_s),
      Entry(&T::friction_split_is_unique, &P::friction_split_is_unique, &P::set_friction_split_is_unique),
      Entry(&T::contacts, &P::contacts, &P::mutable_contacts),
      Entry(&T::energy_change_j, &P::energy_change_j, &P::set_energy_change_j),
      Entry(&T::work_error_j, &P::work_error_j, &P::set_work_error_j),
      Entry(&T::error_is_proved, &P::error_is_proved, &P::set_error_is_proved)>;
};

template <>
struct Map<ContactPair> : Between<ContactPair, v1::ContactPair> {
  using Fields =
      Entries<Entry(&T::contact_1, &P::contact_1, &P::set_contact_1),
              Entry(&T::contact_2, &P::contact_2, &P::set_contact_2), Entry(&T::cosine, &P::cosine, &P::set_cosine),
              Entry(&T::divisor, &P::has_divisor, &P::divisor, &P::set_divisor)>;
};

template <>
struct Map<PossibleRange> : Between<PossibleRange, v1::PossibleRange> {
  using Fields = Entries<Entry(&T::output, &P::output, &P::mutable_output), Entry(&T::lower, &P::lower, &P::set_lower),
                         Entry(&T::upper, &P::upper, &P::set_upper)>;
};

template <>
struct Map<StiffnessSample> : Between<StiffnessSample, v1::StiffnessSample> {
  using Fields = Entries<Entry(&T::relative_stiffness, &P::relative_stiffness, &P::set_relative_stiffness),
                         Entry(&T::outcome, &P::outcome, &P::mutable_outcome)>;
};

template <>
struct Map<StiffnessJump> : Between<StiffnessJump, v1::StiffnessJump> {
  using Fields = Entries<Entry(&T::low, &P::low, &P::set_low), Entry(&T::high, &P::high, &P::set_high),
                         Entry(&T::difference, &P::difference, &P::set_difference)>;
};

template <>
struct Map<RefusedMethod> : Between<RefusedMethod, v1::RefusedMethod> {
  using Fields =
      Entries<Entry(&T::method, &P::method, &P::set_method), Entry(&T::reason, &P::reason, &P::mutable_reason)>;
};

template <>
struct Map<MultiContactAnswer> : Between<MultiContactAnswer, v1::MultiContactAnswer> {
  using Fields = Entries<
      Entry(&T::verdict, &P::verdict, &P::set_verdict),
      Entry(&T::differing_output, &P::differing_output, &P::mutable_differing_output),
      Entry(&T::difference, &P::difference, &P::set_difference),
      Entry(&T::outcome_1, &P::outcome_1, &P::mutable_outcome_1),
      Entry(&T::outcome_2, &P::outcome_2, &P::mutable_outcome_2),
      Entry(&T::contact_velocity_before_m_s, &P::contact_velocity_before_m_s, &P::mutable_contact_velocity_before_m_s),
      Entry(&T::energy_before_j, &P::energy_before_j, &P::set_energy_before_j), Entry(&T::jams, &P::jams, &P::set_jams),
      Entry(&T::pairs, &P::pairs, &P::mutable_pairs), Entry(&T::orders, &P::orders, &P::mutable_orders),
      Entry(&T::springs, &P::has_springs, &P::springs, &P::mutable_springs),
      Entry(&T::stiffness_samples, &P::stiffness_samples, &P::mutable_stiffness_samples),
      Entry(&T::stiffness_jumps, &P::stiffness_jumps, &P::mutable_stiffness_jumps),
      Entry(&T::possible, &P::possible, &P::mutable_possible), Entry(&T::refused, &P::refused, &P::mutable_refused)>;
};

template <>
struct Map<MultiContactResponse> : Between<MultiContactResponse, v1::MultiContactResponse> {
  using Fields =
      Entries<Entry(&T::answers, &P::answers, &P::mutable_answers), Entry(&T::engine, &P::engine, &P::mutable_engine)>;
};

void ToProto(const MultiContactScene& scene, v1::MultiContactScene& proto) {
  Map<MultiContactScene>::Fields::Write(scene, proto);
}
void FromProto(const v1::MultiContactScene& proto, MultiContactScene& scene) {
  Map<MultiContactScene>::Fields::Read(proto, scene);
}

v1::MultiContactScene ToProto(const MultiContactScene& scene) { return Sent(scene); }
MultiContactScene FromProto(const v1::MultiContactScene& proto) { return Received<MultiContactScene>(proto); }

v1::MultiContactRequest ToProto(const MultiContactRequest& request) { return Sent(request); }
MultiContactRequest FromProto(const v1::MultiContactRequest& proto) { return Received<MultiContactRequest>(proto); }

v1::MultiContactResponse ToProto(const MultiContactResponse& response) { return Sent(response); }
MultiContactResponse FromProto(const v1::MultiContactResponse& proto) { return Received<MultiContactResponse>(proto); }

}  // namespace ricochet
