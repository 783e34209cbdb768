#include "proto/wire/fit.h"

#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/outcome.h"
#include "proto/wire/scene.h"

namespace ricochet {

template <>
struct Map<FitUnknown> : Between<FitUnknown, v1::FitUnknown> {
  using Fields =
      Entries<Entry(&T::path, &P::path, &P::mutable_path), Entry(&T::start, &P::has_start, &P::start, &P::set_start),
              Entry(&T::low, &P::has_low, &P::low, &P::set_low), Entry(&T::high, &P::has_high, &P::high, &P::set_high)>;
};

template <>
struct Map<FitInput> : Between<FitInput, v1::FitInput> {
  using Fields =
      Entries<Entry(&T::path, &P::path, &P::mutable_path), Entry(&T::values, &P::values, &P::mutable_values)>;
};

template <>
struct Map<FitMeasured> : Between<FitMeasured, v1::FitMeasured> {
  using Fields = Entries<Entry(&T::path, &P::path, &P::mutable_path), Entry(&T::values, &P::values, &P::mutable_values),
                         Entry(&T::sigma, &P::sigma, &P::mutable_sigma)>;
};

template <>
struct Map<FitRequest> : Between<FitRequest, v1::FitRequest> {
  using Fields =
      Entries<Entry(&T::scene, &P::scene, &P::mutable_scene), Entry(&T::unknowns, &P::unknowns, &P::mutable_unknowns),
              Entry(&T::inputs, &P::inputs, &P::mutable_inputs),
              Entry(&T::measured, &P::measured, &P::mutable_measured), Entry(&T::loss, &P::loss, &P::set_loss),
              Entry(&T::loss_scale, &P::has_loss_scale, &P::loss_scale, &P::set_loss_scale),
              Entry(&T::starts, &P::has_starts, &P::starts, &P::set_starts),
              Entry(&T::max_iterations, &P::has_max_iterations, &P::max_iterations, &P::set_max_iterations),
              Entry(&T::region, &P::region, &P::mutable_region)>;
};

template <>
struct Map<FitEnd> : Between<FitEnd, v1::FitEnd> {
  using Fields =
      Entries<Entry(&T::kind, &P::kind, &P::set_kind), Entry(&T::value, &P::has_value, &P::value, &P::set_value)>;
};

template <>
struct Map<FitProfilePoint> : Between<FitProfilePoint, v1::FitProfilePoint> {
  using Fields = Entries<Entry(&T::value, &P::value, &P::set_value), Entry(&T::rise, &P::rise, &P::set_rise)>;
};

template <>
struct Map<FitEstimate> : Between<FitEstimate, v1::FitEstimate> {
  using Fields =
      Entries<Entry(&T::path, &P::path, &P::mutable_path), Entry(&T::value, &P::value, &P::set_value),
              Entry(&T::seen, &P::seen, &P::set_seen), Entry(&T::sigma, &P::has_sigma, &P::sigma, &P::set_sigma),
              Entry(&T::low, &P::low, &P::mutable_low), Entry(&T::high, &P::high, &P::mutable_high),
              Entry(&T::profile, &P::profile, &P::mutable_profile),
              Entry(&T::row_shares, &P::row_shares, &P::mutable_row_shares)>;
};

template <>
struct Map<FitRow> : Between<FitRow, v1::FitRow> {
  using Fields =
      Entries<Entry(&T::regime, &P::regime, &P::set_regime), Entry(&T::predicted, &P::predicted, &P::mutable_predicted),
              Entry(&T::residuals, &P::residuals, &P::mutable_residuals),
              Entry(&T::broken_limits, &P::broken_limits, &P::mutable_broken_limits)>;
};

template <>
struct Map<FitOutlier> : Between<FitOutlier, v1::FitOutlier> {
  using Fields = Entries<Entry(&T::row, &P::row, &P::set_row), Entry(&T::path, &P::path, &P::mutable_path),
                         Entry(&T::residual, &P::residual, &P::set_residual)>;
};

template <>
struct Map<FitStart> : Between<FitStart, v1::FitStart> {
  using Fields = Entries<Entry(&T::from, &P::from, &P::mutable_from), Entry(&T::to, &P::to, &P::mutable_to),
                         Entry(&T::objective, &P::objective, &P::set_objective),
                         Entry(&T::iterations, &P::iterations, &P::set_iterations),
                         Entry(&T::converged, &P::converged, &P::set_converged)>;
};

template <>
struct Map<FitThreshold> : Between<FitThreshold, v1::FitThreshold> {
  using Fields =
      Entries<Entry(&T::row, &P::row, &P::set_row), Entry(&T::of, &P::of, &P::mutable_of),
              Entry(&T::by, &P::by, &P::mutable_by), Entry(&T::from_below, &P::from_below, &P::set_from_below),
              Entry(&T::from_above, &P::from_above, &P::set_from_above)>;
};

template <>
struct Map<FitRegionPoint> : Between<FitRegionPoint, v1::FitRegionPoint> {
  using Fields =
      Entries<Entry(&T::x, &P::x, &P::set_x), Entry(&T::y, &P::y, &P::set_y), Entry(&T::kind, &P::kind, &P::set_kind)>;
};

template <>
struct Map<FitResponse> : Between<FitResponse, v1::FitResponse> {
  using Fields =
      Entries<Entry(&T::unknowns, &P::unknowns, &P::mutable_unknowns),
              Entry(&T::covariance, &P::covariance, &P::mutable_covariance),
              Entry(&T::correlation, &P::correlation, &P::mutable_correlation),
              Entry(&T::rows, &P::rows, &P::mutable_rows), Entry(&T::outliers, &P::outliers, &P::mutable_outliers),
              Entry(&T::objective, &P::objective, &P::set_objective), Entry(&T::chi2, &P::chi2, &P::set_chi2),
              Entry(&T::degrees_of_freedom, &P::degrees_of_freedom, &P::set_degrees_of_freedom),
              Entry(&T::p_value, &P::has_p_value, &P::p_value, &P::set_p_value),
              Entry(&T::refused, &P::refused, &P::set_refused), Entry(&T::starts, &P::starts, &P::mutable_starts),
              Entry(&T::starts_differ, &P::starts_differ, &P::set_starts_differ),
              Entry(&T::thresholds, &P::thresholds, &P::mutable_thresholds),
              Entry(&T::region, &P::region, &P::mutable_region),
              Entry(&T::exact_derivatives, &P::exact_derivatives, &P::set_exact_derivatives),
              Entry(&T::why_differences, &P::why_differences, &P::mutable_why_differences),
              Entry(&T::notes, &P::notes, &P::mutable_notes), Entry(&T::engine, &P::engine, &P::mutable_engine)>;
};

v1::FitRequest ToProto(const FitRequest& request) { return Sent(request); }
FitRequest FromProto(const v1::FitRequest& proto) { return Received<FitRequest>(proto); }

v1::FitResponse ToProto(const FitResponse& response) { return Sent(response); }
FitResponse FromProto(const v1::FitResponse& proto) { return Received<FitResponse>(proto); }

}  // namespace ricochet
