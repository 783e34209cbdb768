#include "proto/wire/cost.h"

#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/scene.h"

namespace ricochet {

template <>
struct Map<CostRequest> : Between<CostRequest, v1::CostRequest> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(scene), RICOCHET_FIELD(time_limit_s), RICOCHET_FIELD(samples),
                                          RICOCHET_FIELD(multi_contact));
};

template <>
struct Map<CostMethod> : Between<CostMethod, v1::CostMethod> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(model), RICOCHET_FIELD(arithmetic), RICOCHET_FIELD(tolerance), RICOCHET_FIELD(digits),
              RICOCHET_FIELD(stiffness), RICOCHET_FIELD(multi_contact));
};

template <>
struct Map<CostTime> : Between<CostTime, v1::CostTime> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(median_s), RICOCHET_FIELD(lower_quartile_s), RICOCHET_FIELD(upper_quartile_s),
              RICOCHET_FIELD(samples), RICOCHET_FIELD(per_sample));
};

template <>
struct Map<CostError> : Between<CostError, v1::CostError> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(total), RICOCHET_FIELD(numerical), RICOCHET_FIELD(modelling));
};

template <>
struct Map<CostRow> : Between<CostRow, v1::CostRow> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(name), RICOCHET_FIELD(method), RICOCHET_FIELD(status), RICOCHET_FIELD(note),
              RICOCHET_FIELD(solve), RICOCHET_FIELD(batch), RICOCHET_FIELD(batch_in_lanes), RICOCHET_FIELD(claimed),
              RICOCHET_FIELD(achieved), RICOCHET_FIELD(reference_error), RICOCHET_FIELD(velocity_after),
              RICOCHET_FIELD(steps), RICOCHET_FIELD(right_hand_sides));
};

template <>
struct Map<CostPick> : Between<CostPick, v1::CostPick> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(row), RICOCHET_FIELD(least_tolerance),
                                          RICOCHET_FIELD(most_tolerance), RICOCHET_FIELD(model));
};

template <>
struct Map<CostMachine> : Between<CostMachine, v1::CostMachine> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(cpu), RICOCHET_FIELD(compiler), RICOCHET_FIELD(simd_target), RICOCHET_FIELD(optimized));
};

template <>
struct Map<CostSummary> : Between<CostSummary, v1::CostSummary> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(reference), RICOCHET_FIELD(reference_source), RICOCHET_FIELD(reference_error),
              RICOCHET_FIELD(front), RICOCHET_FIELD(picks), RICOCHET_FIELD(deceived), RICOCHET_FIELD(out_of_time),
              RICOCHET_FIELD(failed), RICOCHET_FIELD(machine), RICOCHET_FIELD(elapsed_s));
};

template <>
struct Map<CostChunk> : Between<CostChunk, v1::CostResponse> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(first_row), RICOCHET_FIELD(rows), RICOCHET_FIELD(rows_done),
                                          RICOCHET_FIELD(rows_total), RICOCHET_FIELD(summary), RICOCHET_FIELD(engine));
};

v1::CostRequest ToProto(const CostRequest& request) { return Sent(request); }
CostRequest FromProto(const v1::CostRequest& proto) { return Received<CostRequest>(proto); }

v1::CostResponse ToProto(const CostChunk& chunk) { return Sent(chunk); }
CostChunk FromProto(const v1::CostResponse& proto) { return Received<CostChunk>(proto); }

}  // namespace ricochet
