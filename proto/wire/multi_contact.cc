#include "proto/wire/multi_contact.h"

#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/scene.h"

namespace ricochet {

template <>
struct Map<ContactMatrix> : Between<ContactMatrix, v1::ContactMatrix> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(w_per_kg), RICOCHET_FIELD(velocity_m_s));
};

template <>
struct Map<FreeBody> : Between<FreeBody, v1::FreeBody> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(mass_kg), RICOCHET_FIELD(inertia_com_kg_m2), RICOCHET_FIELD(position_m),
              RICOCHET_FIELD(linear_m_s), RICOCHET_FIELD(angular_rad_s));
};

template <>
struct Map<FreeBodies> : Between<FreeBodies, v1::FreeBodies> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(bodies));
};

template <>
struct Map<MultiContactPoint> : Between<MultiContactPoint, v1::MultiContactPoint> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(friction), RICOCHET_FIELD(energetic), RICOCHET_FIELD(relative_stiffness),
              RICOCHET_FIELD(body), RICOCHET_FIELD(other_body), RICOCHET_FIELD(point_m), RICOCHET_FIELD(normal));
};

template <>
struct Map<MultiContactScene> : Between<MultiContactScene, v1::MultiContactScene> {
  static constexpr auto kFields =
      Entries(Flat(&T::system,
                   OneOf(RICOCHET_ACCESS(contact_matrix), RICOCHET_ACCESS(free_bodies), RICOCHET_ACCESS(mechanism))),
              RICOCHET_FIELD(contacts));
};

template <>
struct Map<MultiContactState> : Between<MultiContactState, v1::MultiContactState> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(velocity));
};

template <>
struct Map<LinearOutput> : Between<LinearOutput, v1::LinearOutput> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(name), RICOCHET_FIELD(coefficients));
};

template <>
struct Map<StiffnessRange> : Between<StiffnessRange, v1::StiffnessRange> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(contact), RICOCHET_FIELD(low), RICOCHET_FIELD(high));
};

template <>
struct Map<MultiContactRequest> : Between<MultiContactRequest, v1::MultiContactRequest> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(scene), RICOCHET_FIELD(states), RICOCHET_FIELD(methods),
                                          RICOCHET_FIELD(outputs), RICOCHET_FIELD(stiffness_range));
};

template <>
struct Map<ContactLedger> : Between<ContactLedger, v1::ContactLedger> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(work_compression_j), RICOCHET_FIELD(work_restitution_j), RICOCHET_FIELD(work_friction_j),
              RICOCHET_FIELD(newton), RICOCHET_FIELD(poisson));
};

template <>
struct Map<AttainedOutcome> : Between<AttainedOutcome, v1::AttainedOutcome> {
  static constexpr auto kFields = Entries(
      RICOCHET_FIELD(orders), RICOCHET_FIELD(order_count), RICOCHET_FIELD(end), RICOCHET_FIELD(events),
      RICOCHET_FIELD(contact_velocity_m_s), RICOCHET_FIELD(contact_velocity_error_m_s), RICOCHET_FIELD(velocity),
      RICOCHET_FIELD(velocity_error), RICOCHET_FIELD(impulse_n_s), RICOCHET_FIELD(normal_impulse_error_n_s),
      RICOCHET_FIELD(friction_split_is_unique), RICOCHET_FIELD(contacts), RICOCHET_FIELD(energy_change_j),
      RICOCHET_FIELD(work_error_j), RICOCHET_FIELD(error_is_proved));
};

template <>
struct Map<ContactPair> : Between<ContactPair, v1::ContactPair> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(contact_1), RICOCHET_FIELD(contact_2), RICOCHET_FIELD(cosine), RICOCHET_FIELD(divisor));
};

template <>
struct Map<PossibleRange> : Between<PossibleRange, v1::PossibleRange> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(output), RICOCHET_FIELD(lower), RICOCHET_FIELD(upper));
};

template <>
struct Map<StiffnessSample> : Between<StiffnessSample, v1::StiffnessSample> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(relative_stiffness), RICOCHET_FIELD(outcome));
};

template <>
struct Map<StiffnessJump> : Between<StiffnessJump, v1::StiffnessJump> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(low), RICOCHET_FIELD(high), RICOCHET_FIELD(difference));
};

template <>
struct Map<RefusedMethod> : Between<RefusedMethod, v1::RefusedMethod> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(method), RICOCHET_FIELD(reason));
};

template <>
struct Map<MultiContactAnswer> : Between<MultiContactAnswer, v1::MultiContactAnswer> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(verdict), RICOCHET_FIELD(differing_output), RICOCHET_FIELD(difference),
              RICOCHET_FIELD(outcome_1), RICOCHET_FIELD(outcome_2), RICOCHET_FIELD(contact_velocity_before_m_s),
              RICOCHET_FIELD(energy_before_j), RICOCHET_FIELD(jams), RICOCHET_FIELD(pairs), RICOCHET_FIELD(orders),
              RICOCHET_FIELD(springs), RICOCHET_FIELD(stiffness_samples), RICOCHET_FIELD(stiffness_jumps),
              RICOCHET_FIELD(possible), RICOCHET_FIELD(refused));
};

template <>
struct Map<MultiContactResponse> : Between<MultiContactResponse, v1::MultiContactResponse> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(answers), RICOCHET_FIELD(engine));
};

void ToProto(const MultiContactScene& scene, v1::MultiContactScene& proto) {
  Map<MultiContactScene>::kFields.Write(scene, proto);
}
void FromProto(const v1::MultiContactScene& proto, MultiContactScene& scene) {
  Map<MultiContactScene>::kFields.Read(proto, scene);
}

v1::MultiContactScene ToProto(const MultiContactScene& scene) { return Sent(scene); }
MultiContactScene FromProto(const v1::MultiContactScene& proto) { return Received<MultiContactScene>(proto); }

v1::MultiContactRequest ToProto(const MultiContactRequest& request) { return Sent(request); }
MultiContactRequest FromProto(const v1::MultiContactRequest& proto) { return Received<MultiContactRequest>(proto); }

v1::MultiContactResponse ToProto(const MultiContactResponse& response) { return Sent(response); }
MultiContactResponse FromProto(const v1::MultiContactResponse& proto) { return Received<MultiContactResponse>(proto); }

}  // namespace ricochet
