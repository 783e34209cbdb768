#include "server/base/trace_parent.h"

#include <algorithm>
#include <cstddef>

namespace ricochet::server {
namespace {

// The parts of "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01".
constexpr size_t kTraceId = 3;
constexpr size_t kParentId = 36;
constexpr size_t kFlags = 53;
constexpr size_t kLength = 55;

bool IsHex(absl::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

bool IsZero(absl::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c == '0'; });
}

}  // namespace

std::string TraceId(absl::string_view traceparent) {
  if (traceparent.size() < kLength) return "";
  const absl::string_view version = traceparent.substr(0, 2);
  const absl::string_view trace_id = traceparent.substr(kTraceId, kParentId - 1 - kTraceId);
  const absl::string_view parent_id = traceparent.substr(kParentId, kFlags - 1 - kParentId);
  const absl::string_view flags = traceparent.substr(kFlags, kLength - kFlags);
  const bool hyphens =
      traceparent[kTraceId - 1] == '-' && traceparent[kParentId - 1] == '-' && traceparent[kFlags - 1] == '-';
  const bool hex = IsHex(version) && IsHex(trace_id) && IsHex(parent_id) && IsHex(flags);
  if (!hyphens || !hex || version == "ff" || IsZero(trace_id) || IsZero(parent_id)) return "";
  // Version 00 ends here; a later one may append parts.
  const bool ends_here = traceparent.size() == kLength;
  if (!ends_here && (version == "00" || traceparent[kLength] != '-')) return "";
  return std::string(trace_id);
}

}  // namespace ricochet::server
