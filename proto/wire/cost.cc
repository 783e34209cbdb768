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
  using Fields = Entries<Entry(&T::scene, &P::scene, &P::mutable_scene),
                         Entry(&T::time_limit_s, &P::has_time_limit_s, &P::time_limit_s, &P::set_time_limit_s),
                         Entry(&T::samples, &P::has_samples, &P::samples, &P::set_samples),
                         Entry(&T::multi_contact, &P::has_multi_contact, &P::multi_contact, &P::mutable_multi_contact)>;
};

template <>
struct Map<CostMethod> : Between<CostMethod, v1::CostMethod> {
  using Fields =
      Entries<Entry(&T::model, &P::model, &P::set_model), Entry(&T::arithmetic, &P::arithmetic, &P::set_arithmetic),
              Entry(&T::tolerance, &P::has_tolerance, &P::tolerance, &P::set_tolerance),
              Entry(&T::digits, &P::digits, &P::set_digits), Entry(&T::stiffness, &P::stiffness, &P::set_stiffness),
              Entry(&T::multi_contact, &P::multi_contact, &P::set_multi_contact)>;
};

template <>
struct Map<CostTime> : Between<CostTime, v1::CostTime> {
  using Fields = Entries<Entry(&T::median_s, &P::median_s, &P::set_median_s),
                         Entry(&T::lower_quartile_s, &P::lower_quartile_s, &P::set_lower_quartile_s),
                         Entry(&T::upper_quartile_s, &P::upper_quartile_s, &P::set_upper_quartile_s),
                         Entry(&T::samples, &P::samples, &P::set_samples),
                         Entry(&T::per_sample, &P::per_sample, &P::set_per_sample)>;
};

template <>
struct Map<CostError> : Between<CostError, v1::CostError> {
  using Fields =
      Entries<Entry(&T::total, &P::total, &P::set_total), Entry(&T::numerical, &P::numerical, &P::set_numerical),
              Entry(&T::modelling, &P::modelling, &P::set_modelling)>;
};

template <>
struct Map<CostRow> : Between<CostRow, v1::CostRow> {
  using Fields = Entries<Entry(&T::name, &P::name, &P::mutable_name), Entry(&T::method, &P::method, &P::mutable_method),
                         Entry(&T::status, &P::status, &P::set_status), Entry(&T::note, &P::note, &P::mutable_note),
                         Entry(&T::solve, &P::has_solve, &P::solve, &P::mutable_solve),
                         Entry(&T::batch, &P::has_batch, &P::batch, &P::mutable_batch),
                         Entry(&T::batch_in_lanes, &P::batch_in_lanes, &P::set_batch_in_lanes),
                         Entry(&T::claimed, &P::claimed, &P::mutable_claimed),
                         Entry(&T::achieved, &P::has_achieved, &P::achieved, &P::mutable_achieved),
                         Entry(&T::reference_error, &P::reference_error, &P::set_reference_error),
                         Entry(&T::velocity_after, &P::velocity_after, &P::mutable_velocity_after),
                         Entry(&T::steps, &P::steps, &P::set_steps),
                         Entry(&T::right_hand_sides, &P::right_hand_sides, &P::set_right_hand_sides)>;
};

template <>
struct Map<CostPick> : Between<CostPick, v1::CostPick> {
  using Fields = Entries<Entry(&T::row, &P::row, &P::set_row),
                         Entry(&T::least_tolerance, &P::least_tolerance, &P::set_least_tolerance),
                         Entry(&T::most_tolerance, &P::most_tolerance, &P::set_most_tolerance),
                         Entry(&T::model, &P::model, &P::set_model)>;
};

template <>
struct Map<CostMachine> : Between<CostMachine, v1::CostMachine> {
  using Fields =
      Entries<Entry(&T::cpu, &P::cpu, &P::mutable_cpu), Entry(&T::compiler, &P::compiler, &P::mutable_compiler),
              Entry(&T::simd_target, &P::simd_target, &P::mutable_simd_target),
              Entry(&T::optimized, &P::optimized, &P::set_optimized)>;
};

template <>
struct Map<CostSummary> : Between<CostSummary, v1::CostSummary> {
  using Fields =
      Entries<Entry(&T::reference, &P::reference, &P::mutable_reference),
              Entry(&T::reference_source, &P::reference_source, &P::mutable_reference_source),
              Entry(&T::reference_error, &P::reference_error, &P::set_reference_error),
              Entry(&T::front, &P::front, &P::mutable_front), Entry(&T::picks, &P::picks, &P::mutable_picks),
              Entry(&T::deceived, &P::deceived, &P::set_deceived),
              Entry(&T::out_of_time, &P::out_of_time, &P::set_out_of_time),
              Entry(&T::failed, &P::failed, &P::set_failed), Entry(&T::machine, &P::machine, &P::mutable_machine),
              Entry(&T::elapsed_s, &P::elapsed_s, &P::set_elapsed_s)>;
};

template <>
struct Map<CostChunk> : Between<CostChunk, v1::CostResponse> {
  using Fields =
      Entries<Entry(&T::first_row, &P::first_row, &P::set_first_row), Entry(&T::rows, &P::rows, &P::mutable_rows),
              Entry(&T::rows_done, &P::rows_done, &P::set_rows_done),
              Entry(&T::rows_total, &P::rows_total, &P::set_rows_total),
              Entry(&T::summary, &P::has_summary, &P::summary, &P::mutable_summary),
              Entry(&T::engine, &P::engine, &P::mutable_engine)>;
};

v1::CostRequest ToProto(const CostRequest& request) { return Sent(request); }
CostRequest FromProto(const v1::CostRequest& proto) { return Received<CostRequest>(proto); }

v1::CostResponse ToProto(const CostChunk& chunk) { return Sent(chunk); }
CostChunk FromProto(const v1::CostResponse& proto) { return Received<CostChunk>(proto); }

}  // namespace ricochet
