#include "server/telemetry/observer.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/base/telemetry_names.h"

namespace ricochet::server {
namespace {

// Returns "pendulum:1" for one solved impact, "pendulum:998,sliding:2" for a sweep.
std::string Models(const CallRecord& call) {
  std::string models;
  for (size_t i = 0; i < call.solved_by_model.size(); ++i) {
    const int64_t solved = call.solved_by_model[i];
    if (solved > 0) absl::StrAppend(&models, models.empty() ? "" : ",", ModelName(i), ":", solved);
  }
  return models;
}

// Adds the fields that only some calls have.
void AddPresent(const CallRecord& call, std::vector<LogField>& fields) {
  const auto add = [&fields](const char* name, const auto& value, bool present) {
    if (present) fields.push_back({name, value});
  };
  add("queued_ms", call.queued_s * 1e3, call.queued_s > 0.0);
  add("reason", call.reason, !call.reason.empty());
  add("message", Clipped(call.message), !call.message.empty());
  add("trace_id", call.trace_id, !call.trace_id.empty());
  add("user_agent", Clipped(call.user_agent), !call.user_agent.empty());
  const std::string models = Models(call);
  add("models", models, !models.empty());
  add("points", call.points.value_or(0), call.points.has_value());
  add("first_index", call.first_index, call.first_index > 0);
  add("chunks", call.chunks, call.chunks > 0);
  add("chunk_bytes", call.chunk_bytes, call.chunks > 0);
  add("stalls", call.stalls, call.stalls > 0);
  add("stalled_ms", call.stalled_s * 1e3, call.stalls > 0);
}

}  // namespace

void Observer::Ended(const CallRecord& call) const {
  metrics_.Ended(call);
  const std::optional<int64_t> left_out = sampler_.Take(call, CallSampler::Clock::now());
  if (!left_out.has_value()) return;
  std::vector<LogField> fields = {{"peer", call.peer},
                                  {"method", PathOf(call.method)},
                                  {"status", absl::StatusCodeToString(call.status)},
                                  {"duration_ms", call.duration_s * 1e3},
                                  {"request_id", call.request_id}};
  AddPresent(call, fields);
  if (*left_out > 0) fields.push_back({"calls_left_out", *left_out});
  log_.Write(LogLevel::kInfo, "call", fields);
}

}  // namespace ricochet::server
