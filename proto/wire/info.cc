#include "proto/wire/info.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <cstdint>
#include <limits>

#include "proto/wire/engine.h"
#include "proto/wire/plan.h"

namespace ricochet {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr int64_t kUnlimited = std::numeric_limits<int64_t>::max();

// The field of a limit has the limit's name, as tests/proto/info_test.cc makes sure.
const FieldDescriptor& FieldOf(const Message& message, const char* name) {
  return *message.GetDescriptor()->FindFieldByName(name);
}

void SetLimit(const char* name, int64_t value, Message& message) {
  message.GetReflection()->SetInt64(&message, &FieldOf(message, name), value);
}

int64_t GetLimit(const Message& message, const char* name) {
  return message.GetReflection()->GetInt64(message, &FieldOf(message, name));
}

void ToProto(const Limits& limits, v1::Limits& proto) {
  for (const NamedLimit& limit : kLimits) {
    if (limits.*limit.value != kUnlimited) SetLimit(limit.name, limits.*limit.value, proto);
  }
}

Limits FromProto(const v1::Limits& proto) {
  Limits limits = Limits::None();
  for (const NamedLimit& limit : kLimits) {
    const bool is_set = proto.GetReflection()->HasField(proto, &FieldOf(proto, limit.name));
    if (is_set) limits.*limit.value = GetLimit(proto, limit.name);
  }
  return limits;
}

ServerLimits FromProto(const v1::ServerLimits& proto) {
  ServerLimits limits;
  for (const NamedServerLimit& limit : kServerLimits) limits.*limit.value = GetLimit(proto, limit.name);
  return limits;
}

}  // namespace

v1::InfoRequest ToProto(const InfoRequest& /*request*/) { return {}; }
InfoRequest FromProto(const v1::InfoRequest& /*proto*/) { return {}; }

v1::ServerLimits ToProto(const ServerLimits& limits) {
  v1::ServerLimits proto;
  for (const NamedServerLimit& limit : kServerLimits) SetLimit(limit.name, limits.*limit.value, proto);
  return proto;
}

v1::InfoResponse ToProto(const InfoResponse& response) {
  v1::InfoResponse proto;
  *proto.mutable_engine() = ToProto(response.engine);
  ToProto(response.limits, *proto.mutable_limits());
  if (response.server_limits.has_value()) *proto.mutable_server_limits() = ToProto(*response.server_limits);
  proto.set_certified(response.certified);
  proto.set_finite_duration(response.finite_duration);
  proto.mutable_systems()->Assign(response.systems.begin(), response.systems.end());
  for (const Model model : response.models) proto.add_models(ToProto(model));
  return proto;
}

InfoResponse FromProto(const v1::InfoResponse& proto) {
  InfoResponse response = {.engine = FromProto(proto.engine()),
                           .limits = FromProto(proto.limits()),
                           .certified = proto.certified(),
                           .finite_duration = proto.finite_duration(),
                           .systems = {proto.systems().begin(), proto.systems().end()}};
  if (proto.has_server_limits()) response.server_limits = FromProto(proto.server_limits());
  for (const int model : proto.models()) response.models.push_back(FromProto(static_cast<v1::Model>(model)));
  return response;
}

}  // namespace ricochet
