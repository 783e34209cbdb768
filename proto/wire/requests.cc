#include "proto/wire/requests.h"

#include "proto/wire/bounds.h"
#include "proto/wire/demand.h"
#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/scene.h"

namespace ricochet {

template <>
struct Map<DerivativePaths> : Between<DerivativePaths, v1::DerivativePaths> {
  using Fields = Entries<Entry(&T::of, &P::of, &P::mutable_of), Entry(&T::by, &P::by, &P::mutable_by),
                         Entry(&T::find_thresholds, &P::find_thresholds, &P::set_find_thresholds)>;
};

template <>
struct Map<SolveRequest> : Between<SolveRequest, v1::SolveRequest> {
  using Fields = Entries<Entry(&T::scene, &P::scene, &P::mutable_scene),
                         Entry(&T::history_at_n_s, &P::history_at_n_s, &P::mutable_history_at_n_s),
                         Entry(&T::inadmissible_is_error, &P::inadmissible_is_error, &P::set_inadmissible_is_error),
                         Entry(&T::history_intervals, &P::history_intervals, &P::set_history_intervals),
                         Entry(&T::force_intervals, &P::force_intervals, &P::set_force_intervals),
                         Entry(&T::certified_digits, &P::certified_digits, &P::set_certified_digits),
                         Entry(&T::both_ends, &P::both_ends, &P::set_both_ends),
                         Entry(&T::derivatives, &P::has_derivatives, &P::derivatives, &P::mutable_derivatives),
                         Flat<&T::demand, DemandEntries<P>>{}>;
};

template <>
struct Map<SolveResponse> : Between<SolveResponse, v1::SolveResponse> {
  using Fields =
      Entries<Entry(&T::outcome, &P::outcome, &P::mutable_outcome), Entry(&T::engine, &P::engine, &P::mutable_engine)>;
};

template <>
struct Map<PlanRequest> : Between<PlanRequest, v1::PlanRequest> {
  using Fields = Entries<Entry(&T::scene, &P::scene, &P::mutable_scene), Flat<&T::demand, DemandEntries<P>>{}>;
};

template <>
struct Map<PlanResponse> : Between<PlanResponse, v1::PlanResponse> {
  using Fields =
      Entries<Entry(&T::plan, &P::plan, &P::mutable_plan), Entry(&T::engine, &P::engine, &P::mutable_engine)>;
};

template <>
struct Map<FieldRange> : Between<FieldRange, v1::FieldRange> {
  using Fields = Entries<Entry(&T::path, &P::path, &P::mutable_path), Entry(&T::low, &P::low, &P::set_low),
                         Entry(&T::high, &P::high, &P::set_high)>;
};

template <>
struct Map<BoundsRequest> : Between<BoundsRequest, v1::BoundsRequest> {
  using Fields =
      Entries<Entry(&T::scene, &P::scene, &P::mutable_scene), Entry(&T::ranges, &P::ranges, &P::mutable_ranges),
              Entry(&T::certified_digits, &P::certified_digits, &P::set_certified_digits),
              Entry(&T::derivatives, &P::has_derivatives, &P::derivatives, &P::mutable_derivatives)>;
};

template <>
struct Map<BoundsResponse> : Between<BoundsResponse, v1::BoundsResponse> {
  using Fields =
      Entries<Entry(&T::bounds, &P::bounds, &P::mutable_bounds), Entry(&T::engine, &P::engine, &P::mutable_engine),
              Entry(&T::enclosure, &P::has_enclosure, &P::enclosure, &P::mutable_enclosure),
              Entry(&T::certificate, &P::has_certificate, &P::certificate, &P::mutable_certificate),
              Entry(&T::derivatives, &P::derivatives, &P::mutable_derivatives)>;
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
