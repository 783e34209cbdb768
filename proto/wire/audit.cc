#include "proto/wire/audit.h"

#include <cstddef>
#include <vector>

#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/outcome.h"
#include "proto/wire/scene.h"
#include "proto/wire/sweep.h"

namespace ricochet {

template <>
struct Map<LimitCheck> : Between<LimitCheck, v1::LimitCheck> {
  using Fields =
      Entries<Entry(&T::value, &P::value, &P::set_value), Entry(&T::limit, &P::limit, &P::set_limit),
              Entry(&T::excess, &P::excess, &P::set_excess), Entry(&T::allowance, &P::allowance, &P::set_allowance),
              Entry(&T::verdict, &P::verdict, &P::set_verdict)>;
};

// A check stands in an array under the number of its limit, and in a message under its name.
template <AuditLimit kLimit>
struct CheckField {
  const v1::LimitCheck& (v1::AuditLimits::*get)() const;
  v1::LimitCheck* (v1::AuditLimits::*edit)();

  void Write(const AuditReport& report, v1::AuditLimits& proto) const { ToProto(report[kLimit], *(proto.*edit)()); }
  void Read(const v1::AuditLimits& proto, AuditReport& report) const {
    FromProto((proto.*get)(), report.limits[static_cast<size_t>(kLimit)]);
  }
};

using LimitEntries =
    Entries<CheckField<AuditLimit::kSharp>{&v1::AuditLimits::sharp, &v1::AuditLimits::mutable_sharp},
            CheckField<AuditLimit::kEnergy>{&v1::AuditLimits::energy, &v1::AuditLimits::mutable_energy},
            CheckField<AuditLimit::kNormalImpulse>{&v1::AuditLimits::normal_impulse,
                                                   &v1::AuditLimits::mutable_normal_impulse},
            CheckField<AuditLimit::kPenetration>{&v1::AuditLimits::penetration, &v1::AuditLimits::mutable_penetration},
            CheckField<AuditLimit::kCone>{&v1::AuditLimits::cone, &v1::AuditLimits::mutable_cone}>;

template <>
struct Map<AuditReport> : Between<AuditReport, v1::AuditReport> {
  using Fields = Entries<
      Entry(&T::regime, &P::regime, &P::set_regime), Entry(&T::w_rank, &P::w_rank, &P::set_w_rank),
      Entry(&T::admissible, &P::admissible, &P::set_admissible),
      Entry(&T::unexplained, &P::unexplained, &P::set_unexplained),
      Entry(&T::distance, &P::distance_m_s, &P::set_distance_m_s),
      Entry(&T::compression_ended, &P::compression_ended, &P::set_compression_ended),
      Nested<&P::coefficients, &P::mutable_coefficients,
             Entries<Entry(&T::newton, &v1::Coefficients::newton, &v1::Coefficients::set_newton),
                     Entry(&T::poisson, &v1::Coefficients::poisson, &v1::Coefficients::set_poisson),
                     Entry(&T::energetic, &v1::Coefficients::energetic, &v1::Coefficients::set_energetic),
                     Entry(&T::tangential, &v1::Coefficients::tangential, &v1::Coefficients::set_tangential)>>{},
      Entry(&T::normal_impulse, &P::normal_impulse_n_s, &P::set_normal_impulse_n_s),
      Entry(&T::normal_impulse_compression, &P::normal_compression_n_s, &P::set_normal_compression_n_s),
      Entry(&T::tangential_impulse, &P::tangential_impulse_n_s, &P::mutable_tangential_impulse_n_s),
      Entry(&T::friction_mismatch, &P::friction_mismatch_n_s, &P::mutable_friction_mismatch_n_s),
      Entry(&T::normal_impulse_uncertainty, &P::normal_impulse_uncertainty_n_s, &P::set_normal_impulse_uncertainty_n_s),
      Entry(&T::tangential_impulse_uncertainty, &P::tangential_impulse_uncertainty_n_s,
            &P::mutable_tangential_impulse_uncertainty_n_s),
      Entry(&T::work_normal_compression, &P::work_normal_compression_j, &P::set_work_normal_compression_j),
      Entry(&T::work_normal_restitution, &P::work_normal_restitution_j, &P::set_work_normal_restitution_j),
      Entry(&T::work_tangential_compression, &P::work_tangential_compression_j, &P::set_work_tangential_compression_j),
      Entry(&T::work_tangential_restitution, &P::work_tangential_restitution_j, &P::set_work_tangential_restitution_j),
      Entry(&T::energy_change, &P::energy_change_j, &P::set_energy_change_j),
      Entry(&T::residual, &P::residual_j, &P::set_residual_j),
      Nested<&P::path_velocity, &P::mutable_path_velocity,
             Entries<Entry(&T::path_tangential_velocity, &v1::ContactVelocity::tangential_m_s,
                           &v1::ContactVelocity::mutable_tangential_m_s),
                     Entry(&T::path_normal_velocity, &v1::ContactVelocity::normal_m_s,
                           &v1::ContactVelocity::set_normal_m_s)>>{},
      Nested<&P::limits, &P::mutable_limits, LimitEntries>{}>;
};

// Pairs the tallies of a limit in the same way.
template <AuditLimit kLimit>
struct TallyField {
  const v1::LimitTally& (v1::AuditSummary::*get)() const;
  v1::LimitTally* (v1::AuditSummary::*edit)();

  static constexpr auto kIndex = static_cast<size_t>(kLimit);

  void Write(const AuditSummary& summary, v1::AuditSummary& proto) const {
    v1::LimitTally& tally = *(proto.*edit)();
    ToProto(summary.broken[kIndex], *tally.mutable_broken());
    ToProto(summary.within_uncertainty[kIndex], *tally.mutable_within_uncertainty());
    tally.set_largest_excess(summary.largest_excess[kIndex]);
  }
  void Read(const v1::AuditSummary& proto, AuditSummary& summary) const {
    const v1::LimitTally& tally = (proto.*get)();
    if (tally.has_broken()) FromProto(tally.broken(), summary.broken[kIndex]);
    if (tally.has_within_uncertainty()) FromProto(tally.within_uncertainty(), summary.within_uncertainty[kIndex]);
    summary.largest_excess[kIndex] = tally.largest_excess();
  }
};

// An absent tally has no rows, and its first index is then -1 and not 0.
template <>
struct Map<AuditSummary> : Between<AuditSummary, v1::AuditSummary> {
  using Fields =
      Entries<Entry(&T::rows, &P::rows, &P::set_rows), Entry(&T::admissible, &P::admissible, &P::set_admissible),
              Defaulted(&T::invalid, &P::has_invalid, &P::invalid, &P::mutable_invalid),
              Defaulted(&T::unexplained, &P::has_unexplained, &P::unexplained, &P::mutable_unexplained),
              TallyField<AuditLimit::kSharp>{&P::sharp, &P::mutable_sharp},
              TallyField<AuditLimit::kEnergy>{&P::energy, &P::mutable_energy},
              TallyField<AuditLimit::kNormalImpulse>{&P::normal_impulse, &P::mutable_normal_impulse},
              TallyField<AuditLimit::kPenetration>{&P::penetration, &P::mutable_penetration},
              TallyField<AuditLimit::kCone>{&P::cone, &P::mutable_cone}>;
};

// A column of rates is a message of its own, as a list of lists needs one.
struct RatesEntry {
  static void Write(const AuditColumns& columns, v1::AuditColumns& proto) {
    for (const std::vector<double>& rates : columns.rates_after_rad_s) {
      ToProto(rates, *proto.add_rates_after()->mutable_rates_rad_s());
    }
  }
  static void Read(const v1::AuditColumns& proto, AuditColumns& columns) {
    for (const v1::RateColumn& column : proto.rates_after()) {
      FromProto(column.rates_rad_s(), columns.rates_after_rad_s.emplace_back());
    }
  }
};

template <>
struct Map<AuditColumns> : Between<AuditColumns, v1::AuditColumns> {
  using Fields =
      Entries<Entry(&T::tangential_m_s, &P::tangential_m_s, &P::mutable_tangential_m_s),
              Entry(&T::tangential_2_m_s, &P::tangential_2_m_s, &P::mutable_tangential_2_m_s),
              Entry(&T::normal_m_s, &P::normal_m_s, &P::mutable_normal_m_s),
              Entry(&T::tangential_after_m_s, &P::tangential_after_m_s, &P::mutable_tangential_after_m_s),
              Entry(&T::tangential_2_after_m_s, &P::tangential_2_after_m_s, &P::mutable_tangential_2_after_m_s),
              Entry(&T::normal_after_m_s, &P::normal_after_m_s, &P::mutable_normal_after_m_s),
              Entry(&T::friction, &P::friction, &P::mutable_friction),
              Entry(&T::velocity_uncertainty_m_s, &P::velocity_uncertainty_m_s, &P::mutable_velocity_uncertainty_m_s),
              RatesEntry{}>;
};

template <>
struct Map<ObservedRates> : Between<ObservedRates, v1::ObservedRates> {
  using Fields = Entries<Entry(&T::rates_rad_s, &P::rates_rad_s, &P::mutable_rates_rad_s)>;
};

template <>
struct Map<AuditRequest> : Between<AuditRequest, v1::AuditRequest> {
  using Fields = Entries<
      Entry(&T::scene, &P::scene, &P::mutable_scene),
      Flat<&T::observed, OneOf<Case(&P::has_contact_velocity, &P::contact_velocity, &P::mutable_contact_velocity),
                               Case(&P::has_rates, &P::rates, &P::mutable_rates)>>{},
      Entry(&T::velocity_uncertainty_m_s, &P::velocity_uncertainty_m_s, &P::set_velocity_uncertainty_m_s)>;
};

template <>
struct Map<AuditResponse> : Between<AuditResponse, v1::AuditResponse> {
  using Fields = Entries<Entry(&T::report, &P::report, &P::mutable_report),
                         Entry(&T::contact_energy_j, &P::contact_energy_j, &P::set_contact_energy_j),
                         Entry(&T::engine, &P::engine, &P::mutable_engine)>;
};

template <>
struct Map<AuditBatchRequest> : Between<AuditBatchRequest, v1::AuditBatchRequest> {
  using Fields =
      Entries<Entry(&T::scene, &P::scene, &P::mutable_scene), Entry(&T::columns, &P::columns, &P::mutable_columns)>;
};

template <>
struct Map<AuditBatchResponse> : Between<AuditBatchResponse, v1::AuditBatchResponse> {
  using Fields =
      Entries<Entry(&T::reports, &P::reports, &P::mutable_reports),
              Entry(&T::summary, &P::summary, &P::mutable_summary), Entry(&T::engine, &P::engine, &P::mutable_engine)>;
};

v1::AuditReport ToProto(const AuditReport& report) { return Sent(report); }

v1::AuditRequest ToProto(const AuditRequest& request) { return Sent(request); }
AuditRequest FromProto(const v1::AuditRequest& proto) { return Received<AuditRequest>(proto); }

v1::AuditResponse ToProto(const AuditResponse& response) { return Sent(response); }
AuditResponse FromProto(const v1::AuditResponse& proto) { return Received<AuditResponse>(proto); }

v1::AuditBatchRequest ToProto(const AuditBatchRequest& request) { return Sent(request); }
AuditBatchRequest FromProto(const v1::AuditBatchRequest& proto) { return Received<AuditBatchRequest>(proto); }

v1::AuditBatchResponse ToProto(const AuditBatchResponse& response) { return Sent(response); }
AuditBatchResponse FromProto(const v1::AuditBatchResponse& proto) { return Received<AuditBatchResponse>(proto); }

}  // namespace ricochet
