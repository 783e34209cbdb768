#include "proto/wire/outcome.h"

#include <optional>

#include "proto/wire/certificate.h"
#include "proto/wire/enums.h"
#include "proto/wire/plan.h"
#include "proto/wire/repeated.h"

namespace ricochet {

v1::Regime ToProto(Regime regime) { return SameNumber<v1::Regime>(regime, v1::Regime_IsValid); }

Regime FromProto(v1::Regime proto) { return SameNumber<Regime>(proto, v1::Regime_IsValid); }

v1::Event::Kind ToProto(EventKind kind) { return SameNumber<v1::Event::Kind>(kind, v1::Event::Kind_IsValid); }

EventKind FromProto(v1::Event::Kind proto) { return SameNumber<EventKind>(proto, v1::Event::Kind_IsValid); }

v1::Accuracy::Kind ToProto(AccuracyKind kind) {
  return SameNumber<v1::Accuracy::Kind>(kind, v1::Accuracy::Kind_IsValid);
}

AccuracyKind FromProto(v1::Accuracy::Kind proto) { return SameNumber<AccuracyKind>(proto, v1::Accuracy::Kind_IsValid); }

v1::BrokenLimit::Kind ToProto(LimitKind kind) {
  return SameNumber<v1::BrokenLimit::Kind>(kind, v1::BrokenLimit::Kind_IsValid);
}

LimitKind FromProto(v1::BrokenLimit::Kind proto) { return SameNumber<LimitKind>(proto, v1::BrokenLimit::Kind_IsValid); }

v1::Termination ToProto(Termination termination) {
  return SameNumber<v1::Termination>(termination, v1::Termination_IsValid);
}

Termination FromProto(v1::Termination proto) { return SameNumber<Termination>(proto, v1::Termination_IsValid); }

static std::optional<double> IfSet(bool is_set, double value) {
  return is_set ? std::optional<double>(value) : std::nullopt;
}

v1::Coefficients ToProto(const Coefficients& coefficients) {
  v1::Coefficients proto;
  proto.set_newton(coefficients.newton);
  if (coefficients.poisson.has_value()) proto.set_poisson(*coefficients.poisson);
  if (coefficients.energetic.has_value()) proto.set_energetic(*coefficients.energetic);
  proto.set_tangential(coefficients.tangential);
  return proto;
}

Coefficients FromProto(const v1::Coefficients& proto) {
  return {.newton = proto.newton(),
          .poisson = IfSet(proto.has_poisson(), proto.poisson()),
          .energetic = IfSet(proto.has_energetic(), proto.energetic()),
          .tangential = proto.tangential()};
}

v1::ContactVelocity ToProto(const ContactVelocity& velocity) {
  v1::ContactVelocity proto;
  AssignDoubles(velocity.tangential_m_s, *proto.mutable_tangential_m_s());
  proto.set_normal_m_s(velocity.normal_m_s);
  return proto;
}

ContactVelocity FromProto(const v1::ContactVelocity& proto) {
  return {.tangential_m_s = ToComponents(proto.tangential_m_s()), .normal_m_s = proto.normal_m_s()};
}

static v1::Impulse ToProto(const Impulse& impulse) {
  v1::Impulse proto;
  if (impulse.normal_compression_n_s.has_value()) proto.set_normal_compression_n_s(*impulse.normal_compression_n_s);
  proto.set_normal_total_n_s(impulse.normal_total_n_s);
  AssignDoubles(impulse.tangential_n_s, *proto.mutable_tangential_n_s());
  return proto;
}

static Impulse FromProto(const v1::Impulse& proto) {
  return {.normal_compression_n_s = IfSet(proto.has_normal_compression_n_s(), proto.normal_compression_n_s()),
          .normal_total_n_s = proto.normal_total_n_s(),
          .tangential_n_s = ToComponents(proto.tangential_n_s())};
}

static v1::WorkLedger ToProto(const WorkLedger& work) {
  v1::WorkLedger proto;
  if (work.normal_compression_j.has_value()) proto.set_normal_compression_j(*work.normal_compression_j);
  if (work.normal_restitution_j.has_value()) proto.set_normal_restitution_j(*work.normal_restitution_j);
  if (work.tangential_compression_j.has_value()) proto.set_tangential_compression_j(*work.tangential_compression_j);
  if (work.tangential_restitution_j.has_value()) proto.set_tangential_restitution_j(*work.tangential_restitution_j);
  proto.set_normal_total_j(work.normal_total_j);
  proto.set_tangential_total_j(work.tangential_total_j);
  proto.set_friction_dissipation_j(work.friction_dissipation_j);
  proto.set_tangential_spring_j(work.tangential_spring_j);
  proto.set_residual_j(work.residual_j);
  return proto;
}

static WorkLedger FromProto(const v1::WorkLedger& proto) {
  return {.normal_compression_j = IfSet(proto.has_normal_compression_j(), proto.normal_compression_j()),
          .normal_restitution_j = IfSet(proto.has_normal_restitution_j(), proto.normal_restitution_j()),
          .tangential_compression_j = IfSet(proto.has_tangential_compression_j(), proto.tangential_compression_j()),
          .tangential_restitution_j = IfSet(proto.has_tangential_restitution_j(), proto.tangential_restitution_j()),
          .normal_total_j = proto.normal_total_j(),
          .tangential_total_j = proto.tangential_total_j(),
          .friction_dissipation_j = proto.friction_dissipation_j(),
          .tangential_spring_j = proto.tangential_spring_j(),
          .residual_j = proto.residual_j()};
}

static v1::State ToProto(const State& state) {
  v1::State proto;
  proto.set_normal_impulse_n_s(state.normal_impulse_n_s);
  AssignDoubles(state.tangential_impulse_n_s, *proto.mutable_tangential_impulse_n_s());
  *proto.mutable_contact_velocity() = ToProto(state.contact_velocity);
  AssignDoubles(state.rates_rad_s, *proto.mutable_rates_rad_s());
  return proto;
}

static State FromProto(const v1::State& proto) {
  return {.normal_impulse_n_s = proto.normal_impulse_n_s(),
          .tangential_impulse_n_s = ToComponents(proto.tangential_impulse_n_s()),
          .contact_velocity = FromProto(proto.contact_velocity()),
          .rates_rad_s = ToComponents(proto.rates_rad_s())};
}

static v1::Event ToProto(const Event& event) {
  v1::Event proto;
  proto.set_kind(ToProto(event.kind));
  *proto.mutable_state() = ToProto(event.state);
  return proto;
}

static Event FromProto(const v1::Event& proto) {
  return {.kind = FromProto(proto.kind()), .state = FromProto(proto.state())};
}

static v1::BrokenLimit ToProto(const BrokenLimit& broken) {
  v1::BrokenLimit proto;
  proto.set_kind(ToProto(broken.kind));
  proto.set_value(broken.value);
  proto.set_limit(broken.limit);
  proto.set_excess(broken.excess);
  return proto;
}

static BrokenLimit FromProto(const v1::BrokenLimit& proto) {
  return {.kind = FromProto(proto.kind()), .value = proto.value(), .limit = proto.limit(), .excess = proto.excess()};
}

static v1::BodyVelocity ToProto(const BodyVelocity& body) {
  v1::BodyVelocity proto;
  AssignDoubles(body.linear_m_s, *proto.mutable_linear_m_s());
  AssignDoubles(body.angular_rad_s, *proto.mutable_angular_rad_s());
  return proto;
}

static BodyVelocity FromProto(const v1::BodyVelocity& proto) {
  return {.linear_m_s = ToComponents(proto.linear_m_s()), .angular_rad_s = ToComponents(proto.angular_rad_s())};
}

static v1::EffectiveCoefficients ToProto(const EffectiveCoefficients& effective) {
  v1::EffectiveCoefficients proto;
  proto.set_kinetic(effective.kinetic_friction);
  proto.set_static_(effective.static_friction);
  if (effective.restitution.has_value()) proto.set_restitution(*effective.restitution);
  return proto;
}

static EffectiveCoefficients FromProto(const v1::EffectiveCoefficients& proto) {
  EffectiveCoefficients effective = {.kinetic_friction = proto.kinetic(), .static_friction = proto.static_()};
  if (proto.has_restitution()) effective.restitution = proto.restitution();
  return effective;
}

static v1::Accuracy ToProto(const Accuracy& accuracy) {
  v1::Accuracy proto;
  proto.set_relative_error(accuracy.relative_error);
  proto.set_kind(ToProto(accuracy.kind));
  proto.set_steps(accuracy.steps);
  proto.set_right_hand_sides(accuracy.right_hand_sides);
  return proto;
}

static Accuracy FromProto(const v1::Accuracy& proto) {
  return {.relative_error = proto.relative_error(),
          .kind = FromProto(proto.kind()),
          .steps = proto.steps(),
          .right_hand_sides = proto.right_hand_sides()};
}

static v1::Errors ToProto(const NumberErrors& errors) {
  v1::Errors proto;
  if (errors.newton.has_value()) proto.set_newton(*errors.newton);
  if (errors.poisson.has_value()) proto.set_poisson(*errors.poisson);
  if (errors.energetic.has_value()) proto.set_energetic(*errors.energetic);
  if (errors.tangential.has_value()) proto.set_tangential(*errors.tangential);
  if (errors.tangential_m_s.has_value()) proto.set_tangential_m_s(*errors.tangential_m_s);
  if (errors.normal_m_s.has_value()) proto.set_normal_m_s(*errors.normal_m_s);
  if (errors.normal_compression_n_s.has_value()) proto.set_normal_compression_n_s(*errors.normal_compression_n_s);
  if (errors.normal_total_n_s.has_value()) proto.set_normal_total_n_s(*errors.normal_total_n_s);
  if (errors.tangential_n_s.has_value()) proto.set_tangential_n_s(*errors.tangential_n_s);
  if (errors.normal_compression_j.has_value()) proto.set_normal_compression_j(*errors.normal_compression_j);
  if (errors.normal_restitution_j.has_value()) proto.set_normal_restitution_j(*errors.normal_restitution_j);
  if (errors.tangential_compression_j.has_value()) proto.set_tangential_compression_j(*errors.tangential_compression_j);
  if (errors.tangential_restitution_j.has_value()) proto.set_tangential_restitution_j(*errors.tangential_restitution_j);
  if (errors.energy_change_j.has_value()) proto.set_energy_change_j(*errors.energy_change_j);
  return proto;
}

static NumberErrors FromProto(const v1::Errors& proto) {
  return {.newton = IfSet(proto.has_newton(), proto.newton()),
          .poisson = IfSet(proto.has_poisson(), proto.poisson()),
          .energetic = IfSet(proto.has_energetic(), proto.energetic()),
          .tangential = IfSet(proto.has_tangential(), proto.tangential()),
          .tangential_m_s = IfSet(proto.has_tangential_m_s(), proto.tangential_m_s()),
          .normal_m_s = IfSet(proto.has_normal_m_s(), proto.normal_m_s()),
          .normal_compression_n_s = IfSet(proto.has_normal_compression_n_s(), proto.normal_compression_n_s()),
          .normal_total_n_s = IfSet(proto.has_normal_total_n_s(), proto.normal_total_n_s()),
          .tangential_n_s = IfSet(proto.has_tangential_n_s(), proto.tangential_n_s()),
          .normal_compression_j = IfSet(proto.has_normal_compression_j(), proto.normal_compression_j()),
          .normal_restitution_j = IfSet(proto.has_normal_restitution_j(), proto.normal_restitution_j()),
          .tangential_compression_j = IfSet(proto.has_tangential_compression_j(), proto.tangential_compression_j()),
          .tangential_restitution_j = IfSet(proto.has_tangential_restitution_j(), proto.tangential_restitution_j()),
          .energy_change_j = IfSet(proto.has_energy_change_j(), proto.energy_change_j())};
}

static v1::Note ToProto(const Note& note) {
  v1::Note proto;
  proto.set_kind(SameNumber<v1::Note::Kind>(note.kind, v1::Note::Kind_IsValid));
  proto.set_path(note.path);
  proto.set_text(note.text);
  return proto;
}

static Note FromProto(const v1::Note& proto) {
  return {
      .kind = SameNumber<NoteKind>(proto.kind(), v1::Note::Kind_IsValid), .path = proto.path(), .text = proto.text()};
}

static v1::ImpactSolution ToProto(const ImpactSolution& solution) {
  v1::ImpactSolution proto;
  *proto.mutable_contact_velocity_after() = ToProto(solution.contact_velocity_after);
  *proto.mutable_impulse() = ToProto(solution.impulse);
  return proto;
}

static ImpactSolution FromProto(const v1::ImpactSolution& proto) {
  return {.contact_velocity_after = FromProto(proto.contact_velocity_after()), .impulse = FromProto(proto.impulse())};
}

static v1::ForceSample ToProto(const ForceSample& sample) {
  v1::ForceSample proto;
  proto.set_time_s(sample.time_s);
  proto.set_tangential_n(sample.tangential_n);
  proto.set_normal_n(sample.normal_n);
  proto.set_indentation_m(sample.indentation_m);
  proto.set_tangential_m_s(sample.tangential_m_s);
  proto.set_normal_m_s(sample.normal_m_s);
  return proto;
}

static ForceSample FromProto(const v1::ForceSample& proto) {
  return {.time_s = proto.time_s(),
          .tangential_n = proto.tangential_n(),
          .normal_n = proto.normal_n(),
          .indentation_m = proto.indentation_m(),
          .tangential_m_s = proto.tangential_m_s(),
          .normal_m_s = proto.normal_m_s()};
}

static v1::ContactDuration ToProto(const ContactDuration& contact) {
  v1::ContactDuration proto;
  proto.set_duration_s(contact.duration_s);
  proto.set_peak_normal_n(contact.peak_normal_n);
  proto.set_peak_tangential_n(contact.peak_tangential_n);
  proto.set_indentation_m(contact.indentation_m);
  for (const ForceSample& sample : contact.history) *proto.add_history() = ToProto(sample);
  return proto;
}

static ContactDuration FromProto(const v1::ContactDuration& proto) {
  ContactDuration contact{.duration_s = proto.duration_s(),
                          .peak_normal_n = proto.peak_normal_n(),
                          .peak_tangential_n = proto.peak_tangential_n(),
                          .indentation_m = proto.indentation_m(),
                          .history = {}};
  for (const v1::ForceSample& sample : proto.history()) contact.history.push_back(FromProto(sample));
  return contact;
}

v1::Outcome ToProto(const Outcome& outcome) {
  v1::Outcome proto;
  proto.set_regime(ToProto(outcome.regime));
  proto.set_termination(ToProto(outcome.termination));
  proto.set_admissible(outcome.admissible);
  for (const BrokenLimit& broken : outcome.broken_limits) {
    *proto.add_broken_limits() = ToProto(broken);
  }
  proto.set_w_rank(outcome.w_rank);
  *proto.mutable_coefficients() = ToProto(outcome.coefficients);
  AssignDoubles(outcome.rates_after_rad_s, *proto.mutable_rates_after_rad_s());
  *proto.mutable_contact_velocity_after() = ToProto(outcome.contact_velocity_after);
  *proto.mutable_impulse() = ToProto(outcome.impulse);
  *proto.mutable_work() = ToProto(outcome.work);
  proto.set_energy_change_j(outcome.energy_change_j);
  for (const Event& event : outcome.timeline) *proto.add_timeline() = ToProto(event);
  for (const State& state : outcome.history) *proto.add_history() = ToProto(state);
  for (const BodyVelocity& body : outcome.bodies_after) *proto.add_bodies_after() = ToProto(body);
  *proto.mutable_effective() = ToProto(outcome.effective);
  *proto.mutable_accuracy() = ToProto(outcome.accuracy);
  *proto.mutable_errors() = ToProto(outcome.errors);
  for (const Note& note : outcome.notes) *proto.add_notes() = ToProto(note);
  for (const ImpactSolution& solution : outcome.alternatives) *proto.add_alternatives() = ToProto(solution);
  proto.set_alternatives_are_ends(outcome.alternatives_are_ends);
  *proto.mutable_plan() = ToProto(outcome.plan);
  if (outcome.contact.has_value()) *proto.mutable_contact() = ToProto(*outcome.contact);
  if (outcome.certificate.has_value()) *proto.mutable_certificate() = ToProto(*outcome.certificate);
  return proto;
}

Outcome FromProto(const v1::Outcome& proto) {
  Outcome outcome;
  outcome.regime = FromProto(proto.regime());
  outcome.termination = FromProto(proto.termination());
  outcome.admissible = proto.admissible();
  for (const v1::BrokenLimit& broken : proto.broken_limits()) {
    outcome.broken_limits.push_back(FromProto(broken));
  }
  outcome.w_rank = proto.w_rank();
  outcome.coefficients = FromProto(proto.coefficients());
  outcome.rates_after_rad_s = ToComponents(proto.rates_after_rad_s());
  outcome.contact_velocity_after = FromProto(proto.contact_velocity_after());
  outcome.impulse = FromProto(proto.impulse());
  outcome.work = FromProto(proto.work());
  outcome.energy_change_j = proto.energy_change_j();
  for (const v1::Event& event : proto.timeline()) outcome.timeline.push_back(FromProto(event));
  for (const v1::State& state : proto.history()) outcome.history.push_back(FromProto(state));
  for (const v1::BodyVelocity& body : proto.bodies_after()) outcome.bodies_after.push_back(FromProto(body));
  outcome.effective = FromProto(proto.effective());
  outcome.accuracy = FromProto(proto.accuracy());
  outcome.errors = FromProto(proto.errors());
  for (const v1::Note& note : proto.notes()) outcome.notes.push_back(FromProto(note));
  for (const v1::ImpactSolution& solution : proto.alternatives()) {
    outcome.alternatives.push_back(FromProto(solution));
  }
  outcome.alternatives_are_ends = proto.alternatives_are_ends();
  outcome.plan = FromProto(proto.plan());
  if (proto.has_contact()) outcome.contact = FromProto(proto.contact());
  if (proto.has_certificate()) outcome.certificate = FromProto(proto.certificate());
  return outcome;
}

}  // namespace ricochet
