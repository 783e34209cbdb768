#include "proto/wire/multi_contact.h"

#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/scene.h"

namespace ricochet {

RICOCHET_MAP(ContactMatrix, w_per_kg, velocity_m_s);
RICOCHET_MAP(FreeBody, mass_kg, inertia_com_kg_m2, position_m, linear_m_s, angular_rad_s);
RICOCHET_MAP(FreeBodies, bodies);
RICOCHET_MAP(MultiContactPoint, friction, energetic, relative_stiffness, body, other_body, point_m, normal);

template <>
struct Map<MultiContactScene> : Between<MultiContactScene, v1::MultiContactScene> {
  static constexpr auto kFields =
      Entries(Flat(&T::system,
                   OneOf(RICOCHET_ACCESS(contact_matrix), RICOCHET_ACCESS(free_bodies), RICOCHET_ACCESS(mechanism))),
              RICOCHET_FIELD(contacts));
};

RICOCHET_MAP(MultiContactState, velocity);
RICOCHET_MAP(LinearOutput, name, coefficients);
RICOCHET_MAP(StiffnessRange, contact, low, high);
RICOCHET_MAP(MultiContactRequest, scene, states, methods, outputs, stiffness_range);
RICOCHET_MAP(ContactLedger, work_compression_j, work_restitution_j, work_friction_j, newton, poisson);
RICOCHET_MAP(AttainedOutcome, orders, order_count, end, events, contact_velocity_m_s, contact_velocity_error_m_s,
             velocity, velocity_error, impulse_n_s, normal_impulse_error_n_s, friction_split_is_unique, contacts,
             energy_change_j, work_error_j, error_is_proved);
RICOCHET_MAP(ContactPair, contact_1, contact_2, cosine, divisor);
RICOCHET_MAP(PossibleRange, output, lower, upper);
RICOCHET_MAP(StiffnessSample, relative_stiffness, outcome);
RICOCHET_MAP(StiffnessJump, low, high, difference);
RICOCHET_MAP(RefusedMethod, method, reason);
RICOCHET_MAP(MultiContactAnswer, verdict, differing_output, difference, outcome_1, outcome_2,
             contact_velocity_before_m_s, energy_before_j, jams, pairs, orders, springs, stiffness_samples,
             stiffness_jumps, possible, refused);
RICOCHET_MAP(MultiContactResponse, answers, engine);

RICOCHET_CONVERT_IN_PLACE(MultiContactScene);
RICOCHET_CONVERT(MultiContactScene);
RICOCHET_CONVERT(MultiContactRequest);
RICOCHET_CONVERT(MultiContactResponse);

}  // namespace ricochet
