#include "proto/wire/requests.h"

#include "proto/wire/bounds.h"
#include "proto/wire/engine.h"
#include "proto/wire/outcome.h"
#include "proto/wire/repeated.h"
#include "proto/wire/scene.h"

namespace ricochet {

v1::SolveRequest ToProto(const SolveRequest& request) {
  v1::SolveRequest proto;
  *proto.mutable_scene() = ToProto(request.scene);
  AssignDoubles(request.history_at_n_s, *proto.mutable_history_at_n_s());
  proto.set_inadmissible_is_error(request.inadmissible_is_error);
  if (request.relative_tolerance.has_value()) proto.set_relative_tolerance(*request.relative_tolerance);
  return proto;
}

SolveRequest FromProto(const v1::SolveRequest& proto) {
  SolveRequest request{.scene = FromProto(proto.scene()),
                       .history_at_n_s = ToVector(proto.history_at_n_s()),
                       .inadmissible_is_error = proto.inadmissible_is_error()};
  if (proto.has_relative_tolerance()) request.relative_tolerance = proto.relative_tolerance();
  return request;
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

v1::BoundsRequest ToProto(const BoundsRequest& request) {
  v1::BoundsRequest proto;
  *proto.mutable_scene() = ToProto(request.scene);
  return proto;
}

BoundsRequest FromProto(const v1::BoundsRequest& proto) { return {.scene = FromProto(proto.scene())}; }

v1::BoundsResponse ToProto(const BoundsResponse& response) {
  v1::BoundsResponse proto;
  *proto.mutable_bounds() = ToProto(response.bounds);
  *proto.mutable_engine() = ToProto(response.engine);
  return proto;
}

BoundsResponse FromProto(const v1::BoundsResponse& proto) {
  return {.bounds = FromProto(proto.bounds()), .engine = FromProto(proto.engine())};
}

}  // namespace ricochet
