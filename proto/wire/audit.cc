#include "proto/wire/audit.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "proto/wire/engine.h"
#include "proto/wire/enums.h"
#include "proto/wire/outcome.h"
#include "proto/wire/overloaded.h"
#include "proto/wire/repeated.h"
#include "proto/wire/scene.h"
#include "proto/wire/sweep.h"

namespace ricochet {
namespace {

using google::protobuf::RepeatedField;

void Assign(const std::array<double, 2>& values, RepeatedField<double>& field) {
  field.Assign(values.begin(), values.end());
}

// Reads a list of tangential entries; missing ones are 0, further ones are ignored.
std::array<double, 2> ToArray(const RepeatedField<double>& field) {
  std::array<double, 2> values = {};
  std::copy_n(field.data(), std::min<size_t>(2, static_cast<size_t>(field.size())), values.begin());
  return values;
}

v1::LimitCheck ToProto(const LimitCheck& check) {
  v1::LimitCheck proto;
  proto.set_value(check.value);
  proto.set_limit(check.limit);
  proto.set_excess(check.excess);
  proto.set_allowance(check.allowance);
  proto.set_verdict(ricochet::ToProto(check.verdict));
  return proto;
}

LimitCheck FromProto(const v1::LimitCheck& proto) {
  return {.value = proto.value(),
          .limit = proto.limit(),
          .excess = proto.excess(),
          .allowance = proto.allowance(),
          .verdict = ricochet::FromProto(proto.verdict())};
}

v1::AuditLimits ToProto(const std::array<LimitCheck, kAuditLimitCount>& limits) {
  const auto of = [&limits](AuditLimit limit) { return ToProto(limits[static_cast<size_t>(limit)]); };
  v1::AuditLimits proto;
  *proto.mutable_sharp() = of(AuditLimit::kSharp);
  *proto.mutable_energy() = of(AuditLimit::kEnergy);
  *proto.mutable_normal_impulse() = of(AuditLimit::kNormalImpulse);
  *proto.mutable_penetration() = of(AuditLimit::kPenetration);
  *proto.mutable_cone() = of(AuditLimit::kCone);
  return proto;
}

std::array<LimitCheck, kAuditLimitCount> FromProto(const v1::AuditLimits& proto) {
  return {LimitCheck(),
          FromProto(proto.sharp()),
          FromProto(proto.energy()),
          FromProto(proto.normal_impulse()),
          FromProto(proto.penetration()),
          FromProto(proto.cone())};
}

v1::LimitTally ToProto(const AuditSummary& summary, AuditLimit limit) {
  const auto i = static_cast<size_t>(limit);
  v1::LimitTally proto;
  *proto.mutable_broken() = ricochet::ToProto(summary.broken[i]);
  *proto.mutable_within_uncertainty() = ricochet::ToProto(summary.within_uncertainty[i]);
  proto.set_largest_excess(summary.largest_excess[i]);
  return proto;
}

// An absent tally has no rows, and its first index is then -1 and not 0.
Tally TallyOf(bool present, const v1::Tally& proto) { return present ? ricochet::FromProto(proto) : Tally(); }

void FromProto(const v1::LimitTally& proto, AuditLimit limit, AuditSummary& summary) {
  const auto i = static_cast<size_t>(limit);
  summary.broken[i] = TallyOf(proto.has_broken(), proto.broken());
  summary.within_uncertainty[i] = TallyOf(proto.has_within_uncertainty(), proto.within_uncertainty());
  summary.largest_excess[i] = proto.largest_excess();
}

v1::AuditSummary ToProto(const AuditSummary& summary) {
  v1::AuditSummary proto;
  proto.set_rows(summary.rows);
  proto.set_admissible(summary.admissible);
  *proto.mutable_invalid() = ricochet::ToProto(summary.invalid);
  *proto.mutable_unexplained() = ricochet::ToProto(summary.unexplained);
  *proto.mutable_sharp() = ToProto(summary, AuditLimit::kSharp);
  *proto.mutable_energy() = ToProto(summary, AuditLimit::kEnergy);
  *proto.mutable_normal_impulse() = ToProto(summary, AuditLimit::kNormalImpulse);
  *proto.mutable_penetration() = ToProto(summary, AuditLimit::kPenetration);
  *proto.mutable_cone() = ToProto(summary, AuditLimit::kCone);
  return proto;
}

AuditSummary FromProto(const v1::AuditSummary& proto) {
  AuditSummary summary;
  summary.rows = proto.rows();
  summary.admissible = proto.admissible();
  summary.invalid = TallyOf(proto.has_invalid(), proto.invalid());
  summary.unexplained = TallyOf(proto.has_unexplained(), proto.unexplained());
  FromProto(proto.sharp(), AuditLimit::kSharp, summary);
  FromProto(proto.energy(), AuditLimit::kEnergy, summary);
  FromProto(proto.normal_impulse(), AuditLimit::kNormalImpulse, summary);
  FromProto(proto.penetration(), AuditLimit::kPenetration, summary);
  FromProto(proto.cone(), AuditLimit::kCone, summary);
  return summary;
}

v1::AuditColumns ToProto(const AuditColumns& columns) {
  v1::AuditColumns proto;
  AssignDoubles(columns.tangential_m_s, *proto.mutable_tangential_m_s());
  AssignDoubles(columns.tangential_2_m_s, *proto.mutable_tangential_2_m_s());
  AssignDoubles(columns.normal_m_s, *proto.mutable_normal_m_s());
  AssignDoubles(columns.tangential_after_m_s, *proto.mutable_tangential_after_m_s());
  AssignDoubles(columns.tangential_2_after_m_s, *proto.mutable_tangential_2_after_m_s());
  AssignDoubles(columns.normal_after_m_s, *proto.mutable_normal_after_m_s());
  AssignDoubles(columns.friction, *proto.mutable_friction());
  AssignDoubles(columns.velocity_uncertainty_m_s, *proto.mutable_velocity_uncertainty_m_s());
  for (const std::vector<double>& rates : columns.rates_after_rad_s) {
    AssignDoubles(rates, *proto.add_rates_after()->mutable_rates_rad_s());
  }
  return proto;
}

AuditColumns FromProto(const v1::AuditColumns& proto) {
  std::vector<std::vector<double>> rates_after_rad_s;
  for (const v1::RateColumn& column : proto.rates_after()) rates_after_rad_s.push_back(ToVector(column.rates_rad_s()));
  return {.tangential_m_s = ToVector(proto.tangential_m_s()),
          .tangential_2_m_s = ToVector(proto.tangential_2_m_s()),
          .normal_m_s = ToVector(proto.normal_m_s()),
          .tangential_after_m_s = ToVector(proto.tangential_after_m_s()),
          .tangential_2_after_m_s = ToVector(proto.tangential_2_after_m_s()),
          .normal_after_m_s = ToVector(proto.normal_after_m_s()),
          .friction = ToVector(proto.friction()),
          .velocity_uncertainty_m_s = ToVector(proto.velocity_uncertainty_m_s()),
          .rates_after_rad_s = std::move(rates_after_rad_s)};
}

void ImpulsesToProto(const AuditReport& report, v1::AuditReport& proto) {
  proto.set_normal_impulse_n_s(report.normal_impulse);
  proto.set_normal_compression_n_s(report.normal_impulse_compression);
  Assign(report.tangential_impulse, *proto.mutable_tangential_impulse_n_s());
  Assign(report.friction_mismatch, *proto.mutable_friction_mismatch_n_s());
  proto.set_normal_impulse_uncertainty_n_s(report.normal_impulse_uncertainty);
  Assign(report.tangential_impulse_uncertainty, *proto.mutable_tangential_impulse_uncertainty_n_s());
}

void WorksToProto(const AuditReport& report, v1::AuditReport& proto) {
  proto.set_work_normal_compression_j(report.work_normal_compression);
  proto.set_work_normal_restitution_j(report.work_normal_restitution);
  proto.set_work_tangential_compression_j(report.work_tangential_compression);
  proto.set_work_tangential_restitution_j(report.work_tangential_restitution);
  proto.set_energy_change_j(report.energy_change);
  proto.set_residual_j(report.residual);
}

}  // namespace

v1::LimitCheck::Verdict ToProto(Verdict verdict) {
  return SameNumber<v1::LimitCheck::Verdict>(verdict, v1::LimitCheck::Verdict_IsValid);
}

Verdict FromProto(v1::LimitCheck::Verdict proto) { return SameNumber<Verdict>(proto, v1::LimitCheck::Verdict_IsValid); }

v1::AuditReport ToProto(const AuditReport& report) {
  v1::AuditReport proto;
  proto.set_regime(ToProto(report.regime));
  proto.set_w_rank(report.w_rank);
  proto.set_admissible(report.admissible);
  proto.set_unexplained(report.unexplained);
  proto.set_distance_m_s(report.distance);
  proto.set_compression_ended(report.compression_ended);
  *proto.mutable_coefficients() =
      ToProto(Coefficients{report.newton, report.poisson, report.energetic, report.tangential});
  ImpulsesToProto(report, proto);
  WorksToProto(report, proto);
  Assign(report.path_tangential_velocity, *proto.mutable_path_velocity()->mutable_tangential_m_s());
  proto.mutable_path_velocity()->set_normal_m_s(report.path_normal_velocity);
  *proto.mutable_limits() = ToProto(report.limits);
  return proto;
}

AuditReport FromProto(const v1::AuditReport& proto) {
  return {.regime = FromProto(proto.regime()),
          .w_rank = proto.w_rank(),
          .admissible = proto.admissible(),
          .unexplained = proto.unexplained(),
          .distance = proto.distance_m_s(),
          .compression_ended = proto.compression_ended(),
          .newton = proto.coefficients().newton(),
          .poisson = proto.coefficients().poisson(),
          .energetic = proto.coefficients().energetic(),
          .tangential = proto.coefficients().tangential(),
          .normal_impulse = proto.normal_impulse_n_s(),
          .normal_impulse_compression = proto.normal_compression_n_s(),
          .tangential_impulse = ToArray(proto.tangential_impulse_n_s()),
          .friction_mismatch = ToArray(proto.friction_mismatch_n_s()),
          .normal_impulse_uncertainty = proto.normal_impulse_uncertainty_n_s(),
          .tangential_impulse_uncertainty = ToArray(proto.tangential_impulse_uncertainty_n_s()),
          .work_normal_compression = proto.work_normal_compression_j(),
          .work_normal_restitution = proto.work_normal_restitution_j(),
          .work_tangential_compression = proto.work_tangential_compression_j(),
          .work_tangential_restitution = proto.work_tangential_restitution_j(),
          .energy_change = proto.energy_change_j(),
          .residual = proto.residual_j(),
          .path_tangential_velocity = ToArray(proto.path_velocity().tangential_m_s()),
          .path_normal_velocity = proto.path_velocity().normal_m_s(),
          .limits = FromProto(proto.limits())};
}

v1::AuditRequest ToProto(const AuditRequest& request) {
  v1::AuditRequest proto;
  *proto.mutable_scene() = ToProto(request.scene);
  std::visit(Overloaded{[](std::monostate) {},
                        [&proto](const ContactVelocity& velocity) {
                          v1::ContactVelocity& out = *proto.mutable_contact_velocity();
                          AssignDoubles(velocity.tangential_m_s, *out.mutable_tangential_m_s());
                          out.set_normal_m_s(velocity.normal_m_s);
                        },
                        [&proto](const ObservedRates& rates) {
                          AssignDoubles(rates.rates_rad_s, *proto.mutable_rates()->mutable_rates_rad_s());
                        }},
             request.observed);
  proto.set_velocity_uncertainty_m_s(request.velocity_uncertainty_m_s);
  return proto;
}

AuditRequest FromProto(const v1::AuditRequest& proto) {
  AuditRequest request{
      .scene = FromProto(proto.scene()), .observed = {}, .velocity_uncertainty_m_s = proto.velocity_uncertainty_m_s()};
  if (proto.has_contact_velocity()) {
    request.observed = ContactVelocity{.tangential_m_s = ToComponents(proto.contact_velocity().tangential_m_s()),
                                       .normal_m_s = proto.contact_velocity().normal_m_s()};
  }
  if (proto.has_rates()) request.observed = ObservedRates{ToComponents(proto.rates().rates_rad_s())};
  return request;
}

v1::AuditResponse ToProto(const AuditResponse& response) {
  v1::AuditResponse proto;
  *proto.mutable_report() = ToProto(response.report);
  proto.set_contact_energy_j(response.contact_energy_j);
  *proto.mutable_engine() = ToProto(response.engine);
  return proto;
}

AuditResponse FromProto(const v1::AuditResponse& proto) {
  return {.report = FromProto(proto.report()),
          .contact_energy_j = proto.contact_energy_j(),
          .engine = FromProto(proto.engine())};
}

v1::AuditBatchRequest ToProto(const AuditBatchRequest& request) {
  v1::AuditBatchRequest proto;
  *proto.mutable_scene() = ToProto(request.scene);
  *proto.mutable_columns() = ToProto(request.columns);
  return proto;
}

AuditBatchRequest FromProto(const v1::AuditBatchRequest& proto) {
  return {.scene = FromProto(proto.scene()), .columns = FromProto(proto.columns())};
}

v1::AuditBatchResponse ToProto(const AuditBatchResponse& response) {
  v1::AuditBatchResponse proto;
  for (const AuditReport& report : response.reports) *proto.add_reports() = ToProto(report);
  *proto.mutable_summary() = ToProto(response.summary);
  *proto.mutable_engine() = ToProto(response.engine);
  return proto;
}

AuditBatchResponse FromProto(const v1::AuditBatchResponse& proto) {
  AuditBatchResponse response{
      .reports = {}, .summary = FromProto(proto.summary()), .engine = FromProto(proto.engine())};
  response.reports.reserve(static_cast<size_t>(proto.reports_size()));
  for (const v1::AuditReport& report : proto.reports()) response.reports.push_back(FromProto(report));
  return response;
}

}  // namespace ricochet
