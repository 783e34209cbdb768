#include "proto/wire/audit.h"

#include <cstddef>
#include <vector>

#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/outcome.h"
#include "proto/wire/scene.h"
#include "proto/wire/sweep.h"

namespace ricochet {

RICOCHET_MAP(LimitCheck, value, limit, excess, allowance, verdict);

// A check, and the tallies of a limit below, stand in arrays under the number of the limit, and in a message under its
// name.
constexpr size_t IndexOf(AuditLimit limit) { return static_cast<size_t>(limit); }

constexpr auto kLimitEntries = Entries(RICOCHET_FIELD_AS(limits[IndexOf(AuditLimit::kSharp)], sharp),
                                       RICOCHET_FIELD_AS(limits[IndexOf(AuditLimit::kEnergy)], energy),
                                       RICOCHET_FIELD_AS(limits[IndexOf(AuditLimit::kNormalImpulse)], normal_impulse),
                                       RICOCHET_FIELD_AS(limits[IndexOf(AuditLimit::kPenetration)], penetration),
                                       RICOCHET_FIELD_AS(limits[IndexOf(AuditLimit::kCone)], cone));

template <>
struct Map<AuditReport> : Between<AuditReport, v1::AuditReport> {
  static constexpr auto kFields = Entries(
      RICOCHET_FIELD(regime), RICOCHET_FIELD(w_rank), RICOCHET_FIELD(admissible), RICOCHET_FIELD(unexplained),
      RICOCHET_FIELD_AS(distance, distance_m_s), RICOCHET_FIELD(compression_ended),
      Nested(RICOCHET_ACCESS(coefficients), Entries(RICOCHET_FIELD(newton), RICOCHET_FIELD(poisson),
                                                    RICOCHET_FIELD(energetic), RICOCHET_FIELD(tangential))),
      RICOCHET_FIELD_AS(normal_impulse, normal_impulse_n_s),
      RICOCHET_FIELD_AS(normal_impulse_compression, normal_compression_n_s),
      RICOCHET_FIELD_AS(tangential_impulse, tangential_impulse_n_s),
      RICOCHET_FIELD_AS(friction_mismatch, friction_mismatch_n_s),
      RICOCHET_FIELD_AS(normal_impulse_uncertainty, normal_impulse_uncertainty_n_s),
      RICOCHET_FIELD_AS(tangential_impulse_uncertainty, tangential_impulse_uncertainty_n_s),
      RICOCHET_FIELD_AS(work_normal_compression, work_normal_compression_j),
      RICOCHET_FIELD_AS(work_normal_restitution, work_normal_restitution_j),
      RICOCHET_FIELD_AS(work_tangential_compression, work_tangential_compression_j),
      RICOCHET_FIELD_AS(work_tangential_restitution, work_tangential_restitution_j),
      RICOCHET_FIELD_AS(energy_change, energy_change_j), RICOCHET_FIELD_AS(residual, residual_j),
      Nested(RICOCHET_ACCESS(path_velocity), Entries(RICOCHET_FIELD_AS(path_tangential_velocity, tangential_m_s),
                                                     RICOCHET_FIELD_AS(path_normal_velocity, normal_m_s))),
      Nested(RICOCHET_ACCESS(limits), kLimitEntries));
};

// An absent tally has no rows, and its first index is then -1 and not 0.
template <AuditLimit kLimit>
constexpr auto kTallies = Entries(Defaulted(RICOCHET_FIELD_AS(broken[IndexOf(kLimit)], broken)),
                                  Defaulted(RICOCHET_FIELD_AS(within_uncertainty[IndexOf(kLimit)], within_uncertainty)),
                                  RICOCHET_FIELD_AS(largest_excess[IndexOf(kLimit)], largest_excess));

template <>
struct Map<AuditSummary> : Between<AuditSummary, v1::AuditSummary> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(rows), RICOCHET_FIELD(admissible), Defaulted(RICOCHET_FIELD(invalid)),
              Defaulted(RICOCHET_FIELD(unexplained)), Nested(RICOCHET_ACCESS(sharp), kTallies<AuditLimit::kSharp>),
              Nested(RICOCHET_ACCESS(energy), kTallies<AuditLimit::kEnergy>),
              Nested(RICOCHET_ACCESS(normal_impulse), kTallies<AuditLimit::kNormalImpulse>),
              Nested(RICOCHET_ACCESS(penetration), kTallies<AuditLimit::kPenetration>),
              Nested(RICOCHET_ACCESS(cone), kTallies<AuditLimit::kCone>));
};

// A column of rates is a message of its own, as a list of lists needs one.
struct RatesEntry {
  static void Write(const AuditColumns& columns, v1::AuditColumns& proto) {
    for (const std::vector<double>& rates : columns.rates_after) {
      ToProto(rates, *proto.add_rates_after()->mutable_values());
    }
  }
  static void Read(const v1::AuditColumns& proto, AuditColumns& columns) {
    for (const v1::RateColumn& column : proto.rates_after()) {
      FromProto(column.values(), columns.rates_after.emplace_back());
    }
  }
};

template <>
struct Map<AuditColumns> : Between<AuditColumns, v1::AuditColumns> {
  static constexpr auto kFields = Entries(
      RICOCHET_FIELD(tangential_m_s), RICOCHET_FIELD(tangential_2_m_s), RICOCHET_FIELD(normal_m_s),
      RICOCHET_FIELD(tangential_after_m_s), RICOCHET_FIELD(tangential_2_after_m_s), RICOCHET_FIELD(normal_after_m_s),
      RICOCHET_FIELD(friction), RICOCHET_FIELD(velocity_uncertainty_m_s), RatesEntry{});
};

RICOCHET_MAP(ObservedRates, values);
RICOCHET_MAP(InputColumn, path, values);

template <>
struct Map<AuditRequest> : Between<AuditRequest, v1::AuditRequest> {
  static constexpr auto kFields = Entries(
      RICOCHET_FIELD(scene), Flat(&T::observed, OneOf(RICOCHET_ACCESS(contact_velocity), RICOCHET_ACCESS(rates))),
      RICOCHET_FIELD(velocity_uncertainty_m_s));
};

RICOCHET_MAP(AuditResponse, report, contact_energy_j, engine);
RICOCHET_MAP(AuditBatchRequest, scene, columns, inputs);
RICOCHET_MAP(AuditBatchResponse, reports, summary, engine);

RICOCHET_CONVERT_IN_PLACE(InputColumn);

v1::AuditReport ToProto(const AuditReport& report) { return Sent(report); }

RICOCHET_CONVERT(AuditRequest);
RICOCHET_CONVERT(AuditResponse);
RICOCHET_CONVERT(AuditBatchRequest);
RICOCHET_CONVERT(AuditBatchResponse);

}  // namespace ricochet
