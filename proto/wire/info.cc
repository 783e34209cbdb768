#include "proto/wire/info.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <cstdint>
#include <limits>

#include "proto/wire/engine.h"
#include "proto/wire/map.h"
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

}  // namespace

static void ToProto(const Limits& limits, v1::Limits& proto) {
  for (const NamedLimit& limit : kLimits) {
    if (limits.*limit.value != kUnlimited) SetLimit(limit.name, limits.*limit.value, proto);
  }
}

static void FromProto(const v1::Limits& proto, Limits& limits) {
  for (const NamedLimit& limit : kLimits) {
    const bool is_set = proto.GetReflection()->HasField(proto, &FieldOf(proto, limit.name));
    limits.*limit.value = is_set ? GetLimit(proto, limit.name) : kUnlimited;
  }
}

static void FromProto(const v1::ServerLimits& proto, ServerLimits& limits) {
  for (const NamedServerLimit& limit : kServerLimits) limits.*limit.value = GetLimit(proto, limit.name);
}

static void ToProto(const ServerLimits& limits, v1::ServerLimits& proto) {
  for (const NamedServerLimit& limit : kServerLimits) SetLimit(limit.name, limits.*limit.value, proto);
}

RICOCHET_MAP(InfoResponse, engine, limits, server_limits, certified, systems, models);

v1::InfoRequest ToProto(const InfoRequest& /*request*/) { return {}; }
InfoRequest FromProto(const v1::InfoRequest& /*proto*/) { return {}; }

RICOCHET_CONVERT(InfoResponse);

}  // namespace ricochet
