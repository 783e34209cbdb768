#include "proto/wire/outcome.h"

#include "proto/wire/map.h"
#include "proto/wire/plan.h"

namespace ricochet {

template <>
struct Map<Coefficients> : Between<Coefficients, v1::Coefficients> {
  using Fields = Entries<Entry(&T::newton, &P::newton, &P::set_newton),
                         Entry(&T::poisson, &P::has_poisson, &P::poisson, &P::set_poisson),
                         Entry(&T::energetic, &P::has_energetic, &P::energetic, &P::set_energetic),
                         Entry(&T::tangential, &P::tangential, &P::set_tangential)>;
};

void ToProto(const Coefficients& coefficients, v1::Coefficients& proto) {
  Map<Coefficients>::Fields::Write(coefficients, proto);
}
void FromProto(const v1::Coefficients& proto, Coefficients& coefficients) {
  Map<Coefficients>::Fields::Read(proto, coefficients);
}

template <>
struct Map<ContactVelocity> : Between<ContactVelocity, v1::ContactVelocity> {
  using Fields = Entries<Entry(&T::tangential_m_s, &P::tangential_m_s, &P::mutable_tangential_m_s),
                         Entry(&T::normal_m_s, &P::normal_m_s, &P::set_normal_m_s)>;
};

void ToProto(const ContactVelocity& velocity, v1::ContactVelocity& proto) {
  Map<ContactVelocity>::Fields::Write(velocity, proto);
}
void FromProto(const v1::ContactVelocity& proto, ContactVelocity& velocity) {
  Map<ContactVelocity>::Fields::Read(proto, velocity);
}

template <>
struct Map<Impulse> : Between<Impulse, v1::Impulse> {
  using Fields = Entries<Entry(&T::normal_compression_n_s, &P::has_normal_compression_n_s, &P::normal_compression_n_s,
                               &P::set_normal_compression_n_s),
                         Entry(&T::normal_total_n_s, &P::normal_total_n_s, &P::set_normal_total_n_s),
                         Entry(&T::tangential_n_s, &P::tangential_n_s, &P::mutable_tangential_n_s)>;
};

template <>
struct Map<WorkLedger> : Between<WorkLedger, v1::WorkLedger> {
  using Fields = Entries<Entry(&T::normal_compression_j, &P::has_normal_compression_j, &P::normal_compression_j,
                               &P::set_normal_compression_j),
                         Entry(&T::normal_restitution_j, &P::has_normal_restitution_j, &P::normal_restitution_j,
                               &P::set_normal_restitution_j),
                         Entry(&T::tangential_compression_j, &P::has_tangential_compression_j,
                               &P::tangential_compression_j, &P::set_tangential_compression_j),
                         Entry(&T::tangential_restitution_j, &P::has_tangential_restitution_j,
                               &P::tangential_restitution_j, &P::set_tangential_restitution_j),
                         Entry(&T::normal_total_j, &P::normal_total_j, &P::set_normal_total_j),
                         Entry(&T::tangential_total_j, &P::tangential_total_j, &P::set_tangential_total_j),
                         Entry(&T::friction_dissipation_j, &P::friction_dissipation_j, &P::set_friction_dissipation_j),
                         Entry(&T::tangential_spring_j, &P::tangential_spring_j, &P::set_tangential_spring_j),
                         Entry(&T::residual_j, &P::residual_j, &P::set_residual_j)>;
};

template <>
struct Map<State> : Between<State, v1::State> {
  using Fields =
      Entries<Entry(&T::normal_impulse_n_s, &P::normal_impulse_n_s, &P::set_normal_impulse_n_s),
              Entry(&T::tangential_impulse_n_s, &P::tangential_impulse_n_s, &P::mutable_tangential_impulse_n_s),
              Entry(&T::contact_velocity, &P::contact_velocity, &P::mutable_contact_velocity),
              Entry(&T::rates_rad_s, &P::rates_rad_s, &P::mutable_rates_rad_s)>;
};

template <>
struct Map<Event> : Between<Event, v1::Event> {
  using Fields = Entries<Entry(&T::kind, &P::kind, &P::set_kind), Entry(&T::state, &P::state, &P::mutable_state)>;
};

template <>
struct Map<BrokenLimit> : Between<BrokenLimit, v1::BrokenLimit> {
  using Fields = Entries<Entry(&T::kind, &P::kind, &P::set_kind), Entry(&T::value, &P::value, &P::set_value),
                         Entry(&T::limit, &P::limit, &P::set_limit), Entry(&T::excess, &P::excess, &P::set_excess)>;
};

template <>
struct Map<BodyVelocity> : Between<BodyVelocity, v1::BodyVelocity> {
  using Fields = Entries<Entry(&T::linear_m_s, &P::linear_m_s, &P::mutable_linear_m_s),
                         Entry(&T::angular_rad_s, &P::angular_rad_s, &P::mutable_angular_rad_s)>;
};

template <>
struct Map<EffectiveCoefficients> : Between<EffectiveCoefficients, v1::EffectiveCoefficients> {
  using Fields = Entries<Entry(&T::kinetic_friction, &P::kinetic, &P::set_kinetic),
                         Entry(&T::static_friction, &P::static_, &P::set_static_),
                         Entry(&T::restitution, &P::has_restitution, &P::restitution, &P::set_restitution)>;
};

template <>
struct Map<Accuracy> : Between<Accuracy, v1::Accuracy> {
  using Fields = Entries<Entry(&T::relative_error, &P::relative_error, &P::set_relative_error),
                         Entry(&T::kind, &P::kind, &P::set_kind), Entry(&T::steps, &P::steps, &P::set_steps),
                         Entry(&T::right_hand_sides, &P::right_hand_sides, &P::set_right_hand_sides)>;
};

template <>
struct Map<NumberErrors> : Between<NumberErrors, v1::Errors> {
  using Fields =
      Entries<Entry(&T::newton, &P::has_newton, &P::newton, &P::set_newton),
              Entry(&T::poisson, &P::has_poisson, &P::poisson, &P::set_poisson),
              Entry(&T::energetic, &P::has_energetic, &P::energetic, &P::set_energetic),
              Entry(&T::tangential, &P::has_tangential, &P::tangential, &P::set_tangential),
              Entry(&T::tangential_m_s, &P::has_tangential_m_s, &P::tangential_m_s, &P::set_tangential_m_s),
              Entry(&T::normal_m_s, &P::has_normal_m_s, &P::normal_m_s, &P::set_normal_m_s),
              Entry(&T::normal_compression_n_s, &P::has_normal_compression_n_s, &P::normal_compression_n_s,
                    &P::set_normal_compression_n_s),
              Entry(&T::normal_total_n_s, &P::has_normal_total_n_s, &P::normal_total_n_s, &P::set_normal_total_n_s),
              Entry(&T::tangential_n_s, &P::has_tangential_n_s, &P::tangential_n_s, &P::set_tangential_n_s),
              Entry(&T::normal_compression_j, &P::has_normal_compression_j, &P::normal_compression_j,
                    &P::set_normal_compression_j),
              Entry(&T::normal_restitution_j, &P::has_normal_restitution_j, &P::normal_restitution_j,
                    &P::set_normal_restitution_j),
              Entry(&T::tangential_compression_j, &P::has_tangential_compression_j, &P::tangential_compression_j,
                    &P::set_tangential_compression_j),
              Entry(&T::tangential_restitution_j, &P::has_tangential_restitution_j, &P::tangential_restitution_j,
                    &P::set_tangential_restitution_j),
              Entry(&T::energy_change_j, &P::has_energy_change_j, &P::energy_change_j, &P::set_energy_change_j),
              Entry(&T::rates_after, &P::rates_after, &P::mutable_rates_after),
              Entry(&T::momentum_change, &P::momentum_change, &P::mutable_momentum_change)>;
};

template <>
struct Map<Note> : Between<Note, v1::Note> {
  using Fields = Entries<Entry(&T::kind, &P::kind, &P::set_kind), Entry(&T::path, &P::path, &P::mutable_path),
                         Entry(&T::text, &P::text, &P::mutable_text)>;
};

template <>
struct Map<ImpactSolution> : Between<ImpactSolution, v1::ImpactSolution> {
  using Fields =
      Entries<Entry(&T::contact_velocity_after, &P::contact_velocity_after, &P::mutable_contact_velocity_after),
              Entry(&T::impulse, &P::impulse, &P::mutable_impulse)>;
};

template <>
struct Map<ForceSample> : Between<ForceSample, v1::ForceSample> {
  using Fields = Entries<Entry(&T::time_s, &P::time_s, &P::set_time_s),
                         Entry(&T::tangential_n, &P::tangential_n, &P::set_tangential_n),
                         Entry(&T::normal_n, &P::normal_n, &P::set_normal_n),
                         Entry(&T::indentation_m, &P::indentation_m, &P::set_indentation_m),
                         Entry(&T::tangential_m_s, &P::tangential_m_s, &P::set_tangential_m_s),
                         Entry(&T::normal_m_s, &P::normal_m_s, &P::set_normal_m_s)>;
};

template <>
struct Map<ContactDuration> : Between<ContactDuration, v1::ContactDuration> {
  using Fields = Entries<Entry(&T::duration_s, &P::duration_s, &P::set_duration_s),
                         Entry(&T::peak_normal_n, &P::peak_normal_n, &P::set_peak_normal_n),
                         Entry(&T::peak_tangential_n, &P::peak_tangential_n, &P::set_peak_tangential_n),
                         Entry(&T::indentation_m, &P::indentation_m, &P::set_indentation_m),
                         Entry(&T::history, &P::history, &P::mutable_history)>;
};

template <>
struct Map<FreeEnd> : Between<FreeEnd, v1::FreeEnd> {
  using Fields =
      Entries<Entry(&T::regime, &P::regime, &P::set_regime),
              Entry(&T::termination, &P::termination, &P::set_termination),
              Entry(&T::coefficients, &P::coefficients, &P::mutable_coefficients),
              Entry(&T::rates_after, &P::rates_after, &P::mutable_rates_after),
              Entry(&T::contact_velocity_after, &P::contact_velocity_after, &P::mutable_contact_velocity_after),
              Entry(&T::impulse, &P::impulse, &P::mutable_impulse), Entry(&T::errors, &P::errors, &P::mutable_errors),
              Entry(&T::admissible, &P::admissible, &P::set_admissible),
              Entry(&T::broken_limits, &P::broken_limits, &P::mutable_broken_limits)>;
};

template <>
struct Map<NearThreshold> : Between<NearThreshold, v1::Derivative::Near> {
  using Fields = Entries<Entry(&T::threshold, &P::threshold, &P::set_threshold),
                         Entry(&T::distance, &P::distance, &P::set_distance)>;
};

template <>
struct Map<Derivative> : Between<Derivative, v1::Derivative> {
  using Fields =
      Entries<Entry(&T::of, &P::of, &P::mutable_of), Entry(&T::by, &P::by, &P::mutable_by),
              Entry(&T::kind, &P::kind, &P::set_kind), Entry(&T::value, &P::has_value, &P::value, &P::set_value),
              Entry(&T::from_below, &P::has_from_below, &P::from_below, &P::set_from_below),
              Entry(&T::from_above, &P::has_from_above, &P::from_above, &P::set_from_above),
              Entry(&T::threshold, &P::threshold, &P::set_threshold), Entry(&T::reason, &P::reason, &P::mutable_reason),
              Entry(&T::error, &P::has_error, &P::error, &P::set_error),
              Entry(&T::below, &P::has_below, &P::below, &P::mutable_below),
              Entry(&T::above, &P::has_above, &P::above, &P::mutable_above)>;
};

template <>
struct Map<CertifiedNumber> : Between<CertifiedNumber, v1::CertifiedNumber> {
  using Fields =
      Entries<Entry(&T::path, &P::path, &P::mutable_path), Entry(&T::decimal, &P::decimal, &P::mutable_decimal),
              Entry(&T::lower, &P::lower, &P::mutable_lower), Entry(&T::upper, &P::upper, &P::mutable_upper),
              Entry(&T::value, &P::value, &P::set_value), Entry(&T::exact, &P::exact, &P::set_exact)>;
};

template <>
struct Map<Certificate> : Between<Certificate, v1::Certificate> {
  using Fields =
      Entries<Entry(&T::digits, &P::digits, &P::set_digits),
              Entry(&T::precision_bits, &P::precision_bits, &P::set_precision_bits),
              Entry(&T::regimes, &P::regimes, &P::mutable_regimes), Entry(&T::is_set, &P::is_set, &P::set_is_set),
              Entry(&T::numbers, &P::numbers, &P::mutable_numbers)>;
};

void ToProto(const Certificate& certificate, v1::Certificate& proto) {
  Map<Certificate>::Fields::Write(certificate, proto);
}
void FromProto(const v1::Certificate& proto, Certificate& certificate) {
  Map<Certificate>::Fields::Read(proto, certificate);
}

template <>
struct Map<Outcome> : Between<Outcome, v1::Outcome> {
  using Fields = Entries<
      Entry(&T::regime, &P::regime, &P::set_regime), Entry(&T::termination, &P::termination, &P::set_termination),
      Entry(&T::admissible, &P::admissible, &P::set_admissible),
      Entry(&T::broken_limits, &P::broken_limits, &P::mutable_broken_limits),
      Entry(&T::w_rank, &P::w_rank, &P::set_w_rank),
      Entry(&T::coefficients, &P::coefficients, &P::mutable_coefficients),
      Entry(&T::rates_after_rad_s, &P::rates_after_rad_s, &P::mutable_rates_after_rad_s),
      Entry(&T::contact_velocity_after, &P::contact_velocity_after, &P::mutable_contact_velocity_after),
      Entry(&T::impulse, &P::impulse, &P::mutable_impulse), Entry(&T::work, &P::work, &P::mutable_work),
      Entry(&T::energy_change_j, &P::energy_change_j, &P::set_energy_change_j),
      Entry(&T::timeline, &P::timeline, &P::mutable_timeline), Entry(&T::history, &P::history, &P::mutable_history),
      Entry(&T::bodies_after, &P::bodies_after, &P::mutable_bodies_after),
      Entry(&T::effective, &P::effective, &P::mutable_effective),
      Entry(&T::accuracy, &P::accuracy, &P::mutable_accuracy), Entry(&T::errors, &P::errors, &P::mutable_errors),
      Entry(&T::notes, &P::notes, &P::mutable_notes),
      Entry(&T::alternatives, &P::alternatives, &P::mutable_alternatives),
      Entry(&T::plan, &P::plan, &P::mutable_plan), Entry(&T::rates_after, &P::rates_after, &P::mutable_rates_after),
      Entry(&T::momentum_change, &P::momentum_change, &P::mutable_momentum_change),
      Entry(&T::free_end, &P::has_free_end, &P::free_end, &P::mutable_free_end),
      Entry(&T::contact, &P::has_contact, &P::contact, &P::mutable_contact),
      Entry(&T::certificate, &P::has_certificate, &P::certificate, &P::mutable_certificate),
      Entry(&T::derivatives, &P::derivatives, &P::mutable_derivatives)>;
};

void ToProto(const Derivative& derivative, v1::Derivative& proto) { Map<Derivative>::Fields::Write(derivative, proto); }
void FromProto(const v1::Derivative& proto, Derivative& derivative) {
  Map<Derivative>::Fields::Read(proto, derivative);
}

void ToProto(const Outcome& outcome, v1::Outcome& proto) { Map<Outcome>::Fields::Write(outcome, proto); }
void FromProto(const v1::Outcome& proto, Outcome& outcome) { Map<Outcome>::Fields::Read(proto, outcome); }

v1::Outcome ToProto(const Outcome& outcome) { return Sent(outcome); }
Outcome FromProto(const v1::Outcome& proto) { return Received<Outcome>(proto); }

}  // namespace ricochet
