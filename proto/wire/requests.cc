#include "proto/wire/requests.h"

#include "proto/wire/demand.h"
#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/scene.h"

namespace ricochet {

template <>
struct Map<DerivativePaths> : Between<DerivativePaths, v1::DerivativePaths> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(of), RICOCHET_FIELD(by), RICOCHET_FIELD(find_thresholds));
};

template <>
struct Map<SolveRequest> : Between<SolveRequest, v1::SolveRequest> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(scene), RICOCHET_FIELD(history_at_n_s), RICOCHET_FIELD(inadmissible_is_error),
              RICOCHET_FIELD(history_intervals), RICOCHET_FIELD(force_intervals), RICOCHET_FIELD(certified_digits),
              RICOCHET_FIELD(both_ends), RICOCHET_FIELD(derivatives), Flat(&T::demand, kDemandEntries));
};

template <>
struct Map<SolveResponse> : Between<SolveResponse, v1::SolveResponse> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(outcome), RICOCHET_FIELD(engine));
};

template <>
struct Map<PlanRequest> : Between<PlanRequest, v1::PlanRequest> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(scene), Flat(&T::demand, kDemandEntries));
};

template <>
struct Map<PlanResponse> : Between<PlanResponse, v1::PlanResponse> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(plan), RICOCHET_FIELD(engine));
};

template <>
struct Map<Range> : Between<Range, v1::Range> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(lower), RICOCHET_FIELD(upper));
};

template <>
struct Map<CoefficientBounds> : Between<CoefficientBounds, v1::CoefficientBounds> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(newton), RICOCHET_FIELD(poisson), RICOCHET_FIELD(energetic),
                                          RICOCHET_FIELD(tangential), RICOCHET_FIELD(normal_total_n_s));
};

// The errors of the coefficients are sent with the coefficients only.
struct CoefficientErrorsEntry {
  static void Write(const NearlyVertical& nearly, v1::NearlyVertical& proto) {
    if (nearly.coefficients.has_value()) ToProto(nearly.coefficient_errors, *proto.mutable_coefficient_errors());
  }
  static void Read(const v1::NearlyVertical& proto, NearlyVertical& nearly) {
    if (proto.has_coefficients()) FromProto(proto.coefficient_errors(), nearly.coefficient_errors);
  }
};

template <>
struct Map<NearlyVertical> : Between<NearlyVertical, v1::NearlyVertical> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(bounds), RICOCHET_FIELD(newton_error), RICOCHET_FIELD(poisson_error),
              RICOCHET_FIELD(tangential_error), RICOCHET_FIELD(normal_total_error_n_s), RICOCHET_FIELD(coefficients),
              CoefficientErrorsEntry{});
};

template <>
struct Map<CriticalFriction> : Between<CriticalFriction, v1::CriticalFriction> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(stick), RICOCHET_FIELD(stop_compression), RICOCHET_FIELD(stop),
                                          RICOCHET_FIELD(reversal), RICOCHET_FIELD(jam));
};

template <>
struct Map<Bounds> : Between<Bounds, v1::Bounds> {
  static constexpr auto kFields = Entries(
      RICOCHET_FIELD(regime), RICOCHET_FIELD(friction_ratio), RICOCHET_FIELD(slope_ratio), RICOCHET_FIELD(sharp),
      RICOCHET_FIELD(energy_only), RICOCHET_FIELD(nearly_vertical), RICOCHET_FIELD(critical), RICOCHET_FIELD(sampled));
};

template <>
struct Map<Enclosure> : Between<Enclosure, v1::Enclosure> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(outer), RICOCHET_FIELD(attained), RICOCHET_FIELD(excess), RICOCHET_FIELD(boxes));
};

template <>
struct Map<FieldRange> : Between<FieldRange, v1::FieldRange> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(path), RICOCHET_FIELD(low), RICOCHET_FIELD(high));
};

template <>
struct Map<BoundsRequest> : Between<BoundsRequest, v1::BoundsRequest> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(scene), RICOCHET_FIELD(ranges),
                                          RICOCHET_FIELD(certified_digits), RICOCHET_FIELD(derivatives));
};

template <>
struct Map<BoundsResponse> : Between<BoundsResponse, v1::BoundsResponse> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(bounds), RICOCHET_FIELD(engine), RICOCHET_FIELD(enclosure),
                                          RICOCHET_FIELD(certificate), RICOCHET_FIELD(derivatives));
};

v1::SolveRequest ToProto(const SolveRequest& request) { return Sent(request); }
SolveRequest FromProto(const v1::SolveRequest& proto) { return Received<SolveRequest>(proto); }

v1::SolveResponse ToProto(const SolveResponse& response) { return Sent(response); }
SolveResponse FromProto(const v1::SolveResponse& proto) { return Received<SolveResponse>(proto); }

v1::PlanRequest ToProto(const PlanRequest& request) { return Sent(request); }
PlanRequest FromProto(const v1::PlanRequest& proto) { return Received<PlanRequest>(proto); }

v1::PlanResponse ToProto(const PlanResponse& response) { return Sent(response); }
PlanResponse FromProto(const v1::PlanResponse& proto) { return Received<PlanResponse>(proto); }

v1::BoundsRequest ToProto(const BoundsRequest& request) { return Sent(request); }
BoundsRequest FromProto(const v1::BoundsRequest& proto) { return Received<BoundsRequest>(proto); }

v1::BoundsResponse ToProto(const BoundsResponse& response) { return Sent(response); }
BoundsResponse FromProto(const v1::BoundsResponse& proto) { return Received<BoundsResponse>(proto); }

}  // namespace ricochet
