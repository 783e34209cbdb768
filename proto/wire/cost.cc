#include "proto/wire/cost.h"

#include "proto/wire/engine.h"
#include "proto/wire/enums.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/scene.h"

namespace ricochet {

v1::CostRequest ToProto(const CostRequest& request) {
  v1::CostRequest proto;
  *proto.mutable_scene() = ToProto(request.scene);
  if (request.time_limit_s.has_value()) proto.set_time_limit_s(*request.time_limit_s);
  if (request.samples.has_value()) proto.set_samples(*request.samples);
  return proto;
}

CostRequest FromProto(const v1::CostRequest& proto) {
  CostRequest request{.scene = FromProto(proto.scene())};
  if (proto.has_time_limit_s()) request.time_limit_s = proto.time_limit_s();
  if (proto.has_samples()) request.samples = proto.samples();
  return request;
}

v1::CostRow::Status ToProto(CostStatus status) {
  return SameNumber<v1::CostRow::Status>(status, v1::CostRow::Status_IsValid);
}

CostStatus FromProto(v1::CostRow::Status proto) { return SameNumber<CostStatus>(proto, v1::CostRow::Status_IsValid); }

static v1::CostMethod ToProto(const CostMethod& method) {
  v1::CostMethod proto;
  proto.set_model(ToProto(method.model));
  proto.set_arithmetic(ToProto(method.arithmetic));
  if (method.tolerance.has_value()) proto.set_tolerance(*method.tolerance);
  proto.set_digits(method.digits);
  proto.set_stiffness(method.stiffness);
  return proto;
}

static CostMethod FromProto(const v1::CostMethod& proto) {
  CostMethod method{.model = FromProto(proto.model()),
                    .arithmetic = FromProto(proto.arithmetic()),
                    .digits = proto.digits(),
                    .stiffness = proto.stiffness()};
  if (proto.has_tolerance()) method.tolerance = proto.tolerance();
  return method;
}

static v1::CostTime ToProto(const CostTime& time) {
  v1::CostTime proto;
  proto.set_median_s(time.median_s);
  proto.set_lower_quartile_s(time.lower_quartile_s);
  proto.set_upper_quartile_s(time.upper_quartile_s);
  proto.set_samples(time.samples);
  proto.set_per_sample(time.per_sample);
  return proto;
}

static CostTime FromProto(const v1::CostTime& proto) {
  return {.median_s = proto.median_s(),
          .lower_quartile_s = proto.lower_quartile_s(),
          .upper_quartile_s = proto.upper_quartile_s(),
          .samples = proto.samples(),
          .per_sample = proto.per_sample()};
}

static v1::CostError ToProto(const CostError& error) {
  v1::CostError proto;
  proto.set_total(error.total);
  proto.set_numerical(error.numerical);
  proto.set_modelling(error.modelling);
  return proto;
}

static CostError FromProto(const v1::CostError& proto) {
  return {.total = proto.total(), .numerical = proto.numerical(), .modelling = proto.modelling()};
}

static v1::CostRow ToProto(const CostRow& row) {
  v1::CostRow proto;
  proto.set_name(row.name);
  *proto.mutable_method() = ToProto(row.method);
  proto.set_status(ToProto(row.status));
  proto.set_note(row.note);
  if (row.solve.has_value()) *proto.mutable_solve() = ToProto(*row.solve);
  if (row.batch.has_value()) *proto.mutable_batch() = ToProto(*row.batch);
  proto.set_batch_in_lanes(row.batch_in_lanes);
  *proto.mutable_claimed() = ToProto(row.claimed);
  if (row.achieved.has_value()) *proto.mutable_achieved() = ToProto(*row.achieved);
  proto.set_reference_error(row.reference_error);
  *proto.mutable_velocity_after() = ToProto(row.velocity_after);
  proto.set_steps(row.steps);
  proto.set_right_hand_sides(row.right_hand_sides);
  return proto;
}

static CostRow FromProto(const v1::CostRow& proto) {
  CostRow row{.name = proto.name(),
              .method = FromProto(proto.method()),
              .status = FromProto(proto.status()),
              .note = proto.note(),
              .batch_in_lanes = proto.batch_in_lanes(),
              .claimed = FromProto(proto.claimed()),
              .reference_error = proto.reference_error(),
              .velocity_after = FromProto(proto.velocity_after()),
              .steps = proto.steps(),
              .right_hand_sides = proto.right_hand_sides()};
  if (proto.has_solve()) row.solve = FromProto(proto.solve());
  if (proto.has_batch()) row.batch = FromProto(proto.batch());
  if (proto.has_achieved()) row.achieved = FromProto(proto.achieved());
  return row;
}

static v1::CostPick ToProto(const CostPick& pick) {
  v1::CostPick proto;
  proto.set_row(pick.row);
  proto.set_least_tolerance(pick.least_tolerance);
  proto.set_most_tolerance(pick.most_tolerance);
  proto.set_model(ToProto(pick.model));
  return proto;
}

static CostPick FromProto(const v1::CostPick& proto) {
  return {.row = proto.row(),
          .least_tolerance = proto.least_tolerance(),
          .most_tolerance = proto.most_tolerance(),
          .model = FromProto(proto.model())};
}

static v1::CostMachine ToProto(const CostMachine& machine) {
  v1::CostMachine proto;
  proto.set_cpu(machine.cpu);
  proto.set_compiler(machine.compiler);
  proto.set_simd_target(machine.simd_target);
  proto.set_optimized(machine.optimized);
  return proto;
}

static CostMachine FromProto(const v1::CostMachine& proto) {
  return {.cpu = proto.cpu(),
          .compiler = proto.compiler(),
          .simd_target = proto.simd_target(),
          .optimized = proto.optimized()};
}

static v1::CostSummary ToProto(const CostSummary& summary) {
  v1::CostSummary proto;
  *proto.mutable_reference() = ToProto(summary.reference);
  proto.set_reference_source(summary.reference_source);
  proto.set_reference_error(summary.reference_error);
  proto.mutable_front()->Assign(summary.front.begin(), summary.front.end());
  for (const CostPick& pick : summary.picks) *proto.add_picks() = ToProto(pick);
  proto.set_deceived(summary.deceived);
  proto.set_out_of_time(summary.out_of_time);
  proto.set_failed(summary.failed);
  *proto.mutable_machine() = ToProto(summary.machine);
  proto.set_elapsed_s(summary.elapsed_s);
  return proto;
}

static CostSummary FromProto(const v1::CostSummary& proto) {
  CostSummary summary{.reference = FromProto(proto.reference()),
                      .reference_source = proto.reference_source(),
                      .reference_error = proto.reference_error(),
                      .front = {proto.front().begin(), proto.front().end()},
                      .picks = {},
                      .deceived = proto.deceived(),
                      .out_of_time = proto.out_of_time(),
                      .failed = proto.failed(),
                      .machine = FromProto(proto.machine()),
                      .elapsed_s = proto.elapsed_s()};
  for (const v1::CostPick& pick : proto.picks()) summary.picks.push_back(FromProto(pick));
  return summary;
}

v1::CostResponse ToProto(const CostChunk& chunk) {
  v1::CostResponse proto;
  proto.set_first_row(chunk.first_row);
  for (const CostRow& row : chunk.rows) *proto.add_rows() = ToProto(row);
  proto.set_rows_done(chunk.rows_done);
  proto.set_rows_total(chunk.rows_total);
  if (chunk.summary.has_value()) *proto.mutable_summary() = ToProto(*chunk.summary);
  *proto.mutable_engine() = ToProto(chunk.engine);
  return proto;
}

CostChunk FromProto(const v1::CostResponse& proto) {
  CostChunk chunk{.first_row = proto.first_row(),
                  .rows = {},
                  .rows_done = proto.rows_done(),
                  .rows_total = proto.rows_total(),
                  .engine = FromProto(proto.engine())};
  for (const v1::CostRow& row : proto.rows()) chunk.rows.push_back(FromProto(row));
  if (proto.has_summary()) chunk.summary = FromProto(proto.summary());
  return chunk;
}

}  // namespace ricochet
