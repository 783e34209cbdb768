#include "proto/wire/fit.h"

#include "proto/wire/audit.h"
#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/outcome.h"
#include "proto/wire/scene.h"

namespace ricochet {

template <>
struct Map<FitUnknown> : Between<FitUnknown, v1::FitUnknown> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(path), RICOCHET_FIELD(start), RICOCHET_FIELD(low), RICOCHET_FIELD(high));
};

template <>
struct Map<FitInput> : Between<FitInput, v1::FitInput> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(path), RICOCHET_FIELD(values), RICOCHET_FIELD(sigma));
};

template <>
struct Map<FitMeasured> : Between<FitMeasured, v1::FitMeasured> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(path), RICOCHET_FIELD(values), RICOCHET_FIELD(sigma));
};

template <>
struct Map<FitRequest> : Between<FitRequest, v1::FitRequest> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(scene), RICOCHET_FIELD(unknowns), RICOCHET_FIELD(inputs), RICOCHET_FIELD(measured),
              RICOCHET_FIELD(loss), RICOCHET_FIELD(loss_scale), RICOCHET_FIELD(starts), RICOCHET_FIELD(max_iterations),
              RICOCHET_FIELD(region));
};

template <>
struct Map<FitEnd> : Between<FitEnd, v1::FitEnd> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(kind), RICOCHET_FIELD(value));
};

template <>
struct Map<FitProfilePoint> : Between<FitProfilePoint, v1::FitProfilePoint> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(value), RICOCHET_FIELD(rise));
};

template <>
struct Map<FitEstimate> : Between<FitEstimate, v1::FitEstimate> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(path), RICOCHET_FIELD(value), RICOCHET_FIELD(seen), RICOCHET_FIELD(sigma),
              RICOCHET_FIELD(low), RICOCHET_FIELD(high), RICOCHET_FIELD(profile), RICOCHET_FIELD(row_shares));
};

template <>
struct Map<FitRow> : Between<FitRow, v1::FitRow> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(regime), RICOCHET_FIELD(predicted), RICOCHET_FIELD(residuals),
                                          RICOCHET_FIELD(broken_limits));
};

template <>
struct Map<FitOutlier> : Between<FitOutlier, v1::FitOutlier> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(row), RICOCHET_FIELD(path), RICOCHET_FIELD(residual));
};

template <>
struct Map<FitStart> : Between<FitStart, v1::FitStart> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(from), RICOCHET_FIELD(to), RICOCHET_FIELD(objective),
                                          RICOCHET_FIELD(iterations), RICOCHET_FIELD(converged));
};

template <>
struct Map<FitThreshold> : Between<FitThreshold, v1::FitThreshold> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(row), RICOCHET_FIELD(of), RICOCHET_FIELD(by),
                                          RICOCHET_FIELD(from_below), RICOCHET_FIELD(from_above));
};

template <>
struct Map<FitRegionPoint> : Between<FitRegionPoint, v1::FitRegionPoint> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(x), RICOCHET_FIELD(y), RICOCHET_FIELD(kind));
};

template <>
struct Map<FitResponse> : Between<FitResponse, v1::FitResponse> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(unknowns), RICOCHET_FIELD(covariance), RICOCHET_FIELD(correlation), RICOCHET_FIELD(rows),
              RICOCHET_FIELD(outliers), RICOCHET_FIELD(objective), RICOCHET_FIELD(interval_rise), RICOCHET_FIELD(chi2),
              RICOCHET_FIELD(degrees_of_freedom), RICOCHET_FIELD(p_value), RICOCHET_FIELD(refused),
              RICOCHET_FIELD(starts), RICOCHET_FIELD(starts_differ), RICOCHET_FIELD(thresholds), RICOCHET_FIELD(region),
              RICOCHET_FIELD(exact_derivatives), RICOCHET_FIELD(why_differences), RICOCHET_FIELD(notes),
              RICOCHET_FIELD(engine));
};

v1::FitRequest ToProto(const FitRequest& request) { return Sent(request); }
FitRequest FromProto(const v1::FitRequest& proto) { return Received<FitRequest>(proto); }

v1::FitResponse ToProto(const FitResponse& response) { return Sent(response); }
FitResponse FromProto(const v1::FitResponse& proto) { return Received<FitResponse>(proto); }

}  // namespace ricochet
