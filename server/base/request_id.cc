#include "server/base/request_id.h"

#include <algorithm>
#include <cstddef>

#include "absl/random/random.h"
#include "absl/strings/str_cat.h"

namespace ricochet::server {
namespace {

constexpr size_t kLongest = 128;

bool MayStandInId(char c) { return c > ' ' && c < 0x7F && c != '"' && c != '\'' && c != '\\'; }

std::string NewRequestId() {
  thread_local absl::BitGen random;
  return absl::StrCat(absl::Hex(random(), absl::kZeroPad16), absl::Hex(random(), absl::kZeroPad16));
}

}  // namespace

std::string RequestIdOr(absl::string_view sent) {
  const bool good = !sent.empty() && sent.size() <= kLongest && std::all_of(sent.begin(), sent.end(), MayStandInId);
  return good ? std::string(sent) : NewRequestId();
}

}  // namespace ricochet::server
