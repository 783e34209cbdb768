#include "proto/wire/requests.h"

#include "proto/wire/bounds.h"
#include "proto/wire/certificate.h"
#include "proto/wire/engine.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/repeated.h"
#include "proto/wire/scene.h"

namespace ricochet {

v1::SolveRequest ToProto(const SolveRequest& request) {
  v1::SolveRequest proto;
  *proto.mutable_scene() = ToProto(request.scene);
  AssignDoubles(request.history_at_n_s, *proto.mutable_history_at_n_s());
  proto.set_inadmissible_is_error(request.inadmissible_is_error);
  SetDemand(request.demand, proto);
  proto.set_history_intervals(request.history_intervals);
  proto.set_force_intervals(request.force_intervals);
  proto.set_certified_digits(request.certified_digits);
  return proto;
}

SolveRequest FromProto(const v1::SolveRequest& proto) {
  return {.scene = FromProto(proto.scene()),
          .history_at_n_s = ToVector(proto.history_at_n_s()),
          .history_intervals = proto.history_intervals(),
          .inadmissible_is_error = proto.inadmissible_is_error(),
          .demand = DemandOf(proto),
          .force_intervals = proto.force_intervals(),
          .certified_digits = proto.certified_digits()};
}

v1::SolveResponse ToProto(const SolveResponse& response) {
  v1::SolveResponse proto;
  *proto.mutable_outcome() = ToProto(response.outcome);
  *proto.mutable_engine() = ToProto(response.engine);
  return proto;
}

SolveResponse FromProto(const v1::SolveResponse& proto) {
  return {.outcome = FromProto(proto.outcome()), .engine = FromProto(proto.engine())};
}

v1::PlanRequest ToProto(const PlanRequest& request) {
  v1::PlanRequest proto;
  *proto.mutable_scene() = ToProto(request.scene);
  SetDemand(request.demand, proto);
  return proto;
}

PlanRequest FromProto(const v1::PlanRequest& proto) {
  return {.scene = FromProto(proto.scene()), .demand = DemandOf(proto)};
}

v1::PlanResponse ToProto(const PlanResponse& response) {
  v1::PlanResponse proto;
  *proto.mutable_plan() = ToProto(response.plan);
  *proto.mutable_engine() = ToProto(response.engine);
  return proto;
}

PlanResponse FromProto(const v1::PlanResponse& proto) {
  return {.plan = FromProto(proto.plan()), .engine = FromProto(proto.engine())};
}

v1::BoundsRequest ToProto(const BoundsRequest& request) {
  v1::BoundsRequest proto;
  *proto.mutable_scene() = ToProto(request.scene);
  for (const FieldRange& range : request.ranges) {
    v1::FieldRange& added = *proto.add_ranges();
    added.set_path(range.path);
    added.set_low(range.low);
    added.set_high(range.high);
  }
  proto.set_certified_digits(request.certified_digits);
  return proto;
}

BoundsRequest FromProto(const v1::BoundsRequest& proto) {
  BoundsRequest request{.scene = FromProto(proto.scene()), .ranges = {}, .certified_digits = proto.certified_digits()};
  for (const v1::FieldRange& range : proto.ranges()) {
    request.ranges.push_back({.path = range.path(), .low = range.low(), .high = range.high()});
  }
  return request;
}

v1::BoundsResponse ToProto(const BoundsResponse& response) {
  v1::BoundsResponse proto;
  *proto.mutable_bounds() = ToProto(response.bounds);
  *proto.mutable_engine() = ToProto(response.engine);
  if (response.enclosure.has_value()) *proto.mutable_enclosure() = ToProto(*response.enclosure);
  if (response.certificate.has_value()) *proto.mutable_certificate() = ToProto(*response.certificate);
  return proto;
}

BoundsResponse FromProto(const v1::BoundsResponse& proto) {
  BoundsResponse response{.bounds = FromProto(proto.bounds()), .engine = FromProto(proto.engine())};
  if (proto.has_enclosure()) response.enclosure = FromProto(proto.enclosure());
  if (proto.has_certificate()) response.certificate = FromProto(proto.certificate());
  return response;
}

}  // namespace ricochet
