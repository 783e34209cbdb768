#include "proto/wire/outcome.h"

#include "proto/wire/map.h"
#include "proto/wire/plan.h"

namespace ricochet {

template <>
struct Map<Coefficients> : Between<Coefficients, v1::Coefficients> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(newton), RICOCHET_FIELD(poisson), RICOCHET_FIELD(energetic), RICOCHET_FIELD(tangential));
};

void ToProto(const Coefficients& coefficients, v1::Coefficients& proto) {
  Map<Coefficients>::kFields.Write(coefficients, proto);
}
void FromProto(const v1::Coefficients& proto, Coefficients& coefficients) {
  Map<Coefficients>::kFields.Read(proto, coefficients);
}

template <>
struct Map<ContactVelocity> : Between<ContactVelocity, v1::ContactVelocity> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(tangential_m_s), RICOCHET_FIELD(normal_m_s));
};

void ToProto(const ContactVelocity& velocity, v1::ContactVelocity& proto) {
  Map<ContactVelocity>::kFields.Write(velocity, proto);
}
void FromProto(const v1::ContactVelocity& proto, ContactVelocity& velocity) {
  Map<ContactVelocity>::kFields.Read(proto, velocity);
}

template <>
struct Map<Impulse> : Between<Impulse, v1::Impulse> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(normal_compression_n_s), RICOCHET_FIELD(normal_total_n_s), RICOCHET_FIELD(tangential_n_s));
};

template <>
struct Map<WorkLedger> : Between<WorkLedger, v1::WorkLedger> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(normal_compression_j), RICOCHET_FIELD(normal_restitution_j),
              RICOCHET_FIELD(tangential_compression_j), RICOCHET_FIELD(tangential_restitution_j),
              RICOCHET_FIELD(normal_total_j), RICOCHET_FIELD(tangential_total_j),
              RICOCHET_FIELD(friction_dissipation_j), RICOCHET_FIELD(tangential_spring_j), RICOCHET_FIELD(residual_j));
};

template <>
struct Map<State> : Between<State, v1::State> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(normal_impulse_n_s), RICOCHET_FIELD(tangential_impulse_n_s),
                                          RICOCHET_FIELD(contact_velocity), RICOCHET_FIELD(rates_rad_s));
};

template <>
struct Map<Event> : Between<Event, v1::Event> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(kind), RICOCHET_FIELD(state));
};

template <>
struct Map<BrokenLimit> : Between<BrokenLimit, v1::BrokenLimit> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(kind), RICOCHET_FIELD(value), RICOCHET_FIELD(limit), RICOCHET_FIELD(excess));
};

template <>
struct Map<BodyVelocity> : Between<BodyVelocity, v1::BodyVelocity> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(linear_m_s), RICOCHET_FIELD(angular_rad_s));
};

template <>
struct Map<EffectiveCoefficients> : Between<EffectiveCoefficients, v1::EffectiveCoefficients> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD_AS(kinetic_friction, kinetic),
                                          RICOCHET_FIELD_AS(static_friction, static_), RICOCHET_FIELD(restitution));
};

template <>
struct Map<Accuracy> : Between<Accuracy, v1::Accuracy> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(relative_error), RICOCHET_FIELD(kind), RICOCHET_FIELD(steps),
                                          RICOCHET_FIELD(right_hand_sides));
};

template <>
struct Map<NumberErrors> : Between<NumberErrors, v1::Errors> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(newton), RICOCHET_FIELD(poisson), RICOCHET_FIELD(energetic), RICOCHET_FIELD(tangential),
              RICOCHET_FIELD(tangential_m_s), RICOCHET_FIELD(normal_m_s), RICOCHET_FIELD(normal_compression_n_s),
              RICOCHET_FIELD(normal_total_n_s), RICOCHET_FIELD(tangential_n_s), RICOCHET_FIELD(normal_compression_j),
              RICOCHET_FIELD(normal_restitution_j), RICOCHET_FIELD(tangential_compression_j),
              RICOCHET_FIELD(tangential_restitution_j), RICOCHET_FIELD(energy_change_j), RICOCHET_FIELD(rates_after),
              RICOCHET_FIELD(momentum_change));
};

template <>
struct Map<Note> : Between<Note, v1::Note> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(kind), RICOCHET_FIELD(path), RICOCHET_FIELD(text));
};

template <>
struct Map<ImpactSolution> : Between<ImpactSolution, v1::ImpactSolution> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(contact_velocity_after), RICOCHET_FIELD(impulse));
};

template <>
struct Map<ForceSample> : Between<ForceSample, v1::ForceSample> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(time_s), RICOCHET_FIELD(tangential_n), RICOCHET_FIELD(normal_n),
              RICOCHET_FIELD(indentation_m), RICOCHET_FIELD(tangential_m_s), RICOCHET_FIELD(normal_m_s));
};

template <>
struct Map<ContactDuration> : Between<ContactDuration, v1::ContactDuration> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(duration_s), RICOCHET_FIELD(peak_normal_n), RICOCHET_FIELD(peak_tangential_n),
              RICOCHET_FIELD(indentation_m), RICOCHET_FIELD(history));
};

template <>
struct Map<FreeEnd> : Between<FreeEnd, v1::FreeEnd> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(regime), RICOCHET_FIELD(termination), RICOCHET_FIELD(coefficients),
              RICOCHET_FIELD(rates_after), RICOCHET_FIELD(contact_velocity_after), RICOCHET_FIELD(impulse),
              RICOCHET_FIELD(errors), RICOCHET_FIELD(admissible), RICOCHET_FIELD(broken_limits));
};

template <>
struct Map<NearThreshold> : Between<NearThreshold, v1::Derivative::Near> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(threshold), RICOCHET_FIELD(distance));
};

template <>
struct Map<Derivative> : Between<Derivative, v1::Derivative> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(of), RICOCHET_FIELD(by), RICOCHET_FIELD(kind), RICOCHET_FIELD(value),
              RICOCHET_FIELD(from_below), RICOCHET_FIELD(from_above), RICOCHET_FIELD(threshold), RICOCHET_FIELD(reason),
              RICOCHET_FIELD(error), RICOCHET_FIELD(below), RICOCHET_FIELD(above));
};

template <>
struct Map<CertifiedNumber> : Between<CertifiedNumber, v1::CertifiedNumber> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(path), RICOCHET_FIELD(decimal), RICOCHET_FIELD(lower),
                                          RICOCHET_FIELD(upper), RICOCHET_FIELD(value), RICOCHET_FIELD(exact));
};

template <>
struct Map<Certificate> : Between<Certificate, v1::Certificate> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(digits), RICOCHET_FIELD(precision_bits),
                                          RICOCHET_FIELD(regimes), RICOCHET_FIELD(is_set), RICOCHET_FIELD(numbers));
};

void ToProto(const Certificate& certificate, v1::Certificate& proto) {
  Map<Certificate>::kFields.Write(certificate, proto);
}
void FromProto(const v1::Certificate& proto, Certificate& certificate) {
  Map<Certificate>::kFields.Read(proto, certificate);
}

template <>
struct Map<Outcome> : Between<Outcome, v1::Outcome> {
  static constexpr auto kFields = Entries(
      RICOCHET_FIELD(regime), RICOCHET_FIELD(termination), RICOCHET_FIELD(admissible), RICOCHET_FIELD(broken_limits),
      RICOCHET_FIELD(w_rank), RICOCHET_FIELD(coefficients), RICOCHET_FIELD(rates_after_rad_s),
      RICOCHET_FIELD(contact_velocity_after), RICOCHET_FIELD(impulse), RICOCHET_FIELD(work),
      RICOCHET_FIELD(energy_change_j), RICOCHET_FIELD(timeline), RICOCHET_FIELD(history), RICOCHET_FIELD(bodies_after),
      RICOCHET_FIELD(effective), RICOCHET_FIELD(accuracy), RICOCHET_FIELD(errors), RICOCHET_FIELD(notes),
      RICOCHET_FIELD(alternatives), RICOCHET_FIELD(plan), RICOCHET_FIELD(rates_after), RICOCHET_FIELD(momentum_change),
      RICOCHET_FIELD(free_end), RICOCHET_FIELD(contact), RICOCHET_FIELD(certificate), RICOCHET_FIELD(derivatives));
};

void ToProto(const Derivative& derivative, v1::Derivative& proto) { Map<Derivative>::kFields.Write(derivative, proto); }
void FromProto(const v1::Derivative& proto, Derivative& derivative) {
  Map<Derivative>::kFields.Read(proto, derivative);
}

void ToProto(const Outcome& outcome, v1::Outcome& proto) { Map<Outcome>::kFields.Write(outcome, proto); }
void FromProto(const v1::Outcome& proto, Outcome& outcome) { Map<Outcome>::kFields.Read(proto, outcome); }

v1::Outcome ToProto(const Outcome& outcome) { return Sent(outcome); }
Outcome FromProto(const v1::Outcome& proto) { return Received<Outcome>(proto); }

}  // namespace ricochet
