#include "proto/wire/requests.h"

#include "proto/wire/demand.h"
#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/scene.h"

namespace ricochet {

RICOCHET_MAP(DerivativePaths, of, by, find_thresholds);

template <>
struct Map<SolveRequest> : Between<SolveRequest, v1::SolveRequest> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(scene), RICOCHET_FIELD(history_at_n_s), RICOCHET_FIELD(inadmissible_is_error),
              RICOCHET_FIELD(history_intervals), RICOCHET_FIELD(force_intervals), RICOCHET_FIELD(certified_digits),
              RICOCHET_FIELD(both_ends), RICOCHET_FIELD(derivatives), Flat(&T::demand, kDemandEntries));
};

RICOCHET_MAP(SolveResponse, outcome, engine);

template <>
struct Map<PlanRequest> : Between<PlanRequest, v1::PlanRequest> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(scene), Flat(&T::demand, kDemandEntries));
};

RICOCHET_MAP(PlanResponse, plan, engine);
RICOCHET_MAP(Range, lower, upper);
RICOCHET_MAP(CoefficientBounds, newton, poisson, energetic, tangential, normal_total_n_s);

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

RICOCHET_MAP(CriticalFriction, stick, stop_compression, stop, reversal, jam);
RICOCHET_MAP(Bounds, regime, friction_ratio, slope_ratio, sharp, energy_only, nearly_vertical, critical, sampled);
RICOCHET_MAP(Enclosure, outer, attained, excess, boxes);
RICOCHET_MAP(FieldRange, path, low, high);
RICOCHET_MAP(BoundsRequest, scene, ranges, certified_digits, derivatives);
RICOCHET_MAP(BoundsResponse, bounds, engine, enclosure, certificate, derivatives);

RICOCHET_CONVERT(SolveRequest);
RICOCHET_CONVERT(SolveResponse);
RICOCHET_CONVERT(PlanRequest);
RICOCHET_CONVERT(PlanResponse);
RICOCHET_CONVERT(BoundsRequest);
RICOCHET_CONVERT(BoundsResponse);

}  // namespace ricochet
