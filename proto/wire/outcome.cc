#include "proto/wire/outcome.h"

#include "proto/wire/map.h"
#include "proto/wire/plan.h"

namespace ricochet {

RICOCHET_MAP(Coefficients, newton, poisson, energetic, tangential);

RICOCHET_CONVERT_IN_PLACE(Coefficients);

RICOCHET_MAP(ContactVelocity, tangential_m_s, normal_m_s);

RICOCHET_CONVERT_IN_PLACE(ContactVelocity);

RICOCHET_MAP(Impulse, normal_compression_n_s, normal_total_n_s, tangential_n_s);
RICOCHET_MAP(WorkLedger, normal_compression_j, normal_restitution_j, tangential_compression_j, tangential_restitution_j,
             normal_total_j, tangential_total_j, friction_dissipation_j, tangential_spring_j, residual_j);
RICOCHET_MAP(State, normal_impulse_n_s, tangential_impulse_n_s, contact_velocity, rates_rad_s);
RICOCHET_MAP(Event, kind, state);
RICOCHET_MAP(BrokenLimit, kind, value, limit, excess);
RICOCHET_MAP(BodyVelocity, linear_m_s, angular_rad_s);

template <>
struct Map<EffectiveCoefficients> : Between<EffectiveCoefficients, v1::EffectiveCoefficients> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD_AS(kinetic_friction, kinetic),
                                          RICOCHET_FIELD_AS(static_friction, static_), RICOCHET_FIELD(restitution));
};

RICOCHET_MAP(Accuracy, relative_error, kind, steps, right_hand_sides);
RICOCHET_MAP_AS(NumberErrors, v1::Errors, newton, poisson, energetic, tangential, tangential_m_s, normal_m_s,
                normal_compression_n_s, normal_total_n_s, tangential_n_s, normal_compression_j, normal_restitution_j,
                tangential_compression_j, tangential_restitution_j, energy_change_j, rates_after, momentum_change);
RICOCHET_MAP(Note, kind, path, text);
RICOCHET_MAP(ImpactSolution, contact_velocity_after, impulse);
RICOCHET_MAP(ForceSample, time_s, tangential_n, normal_n, indentation_m, tangential_m_s, normal_m_s);
RICOCHET_MAP(ContactDuration, duration_s, peak_normal_n, peak_tangential_n, indentation_m, history);
RICOCHET_MAP(FreeEnd, regime, termination, coefficients, rates_after, contact_velocity_after, impulse, errors,
             admissible, broken_limits);
RICOCHET_MAP_AS(NearThreshold, v1::Derivative::Near, threshold, distance);
RICOCHET_MAP(Derivative, of, by, kind, value, from_below, from_above, threshold, reason, error, below, above);
RICOCHET_MAP(CertifiedNumber, path, decimal, lower, upper, value, exact);
RICOCHET_MAP(Certificate, digits, precision_bits, regimes, is_set, numbers);

RICOCHET_CONVERT_IN_PLACE(Certificate);

RICOCHET_MAP(Outcome, regime, termination, admissible, broken_limits, w_rank, coefficients, rates_after_rad_s,
             contact_velocity_after, impulse, work, energy_change_j, timeline, history, bodies_after, effective,
             accuracy, errors, notes, alternatives, plan, rates_after, momentum_change, free_end, contact, certificate,
             derivatives);

RICOCHET_CONVERT_IN_PLACE(Derivative);
RICOCHET_CONVERT_IN_PLACE(Outcome);
RICOCHET_CONVERT(Outcome);

}  // namespace ricochet
