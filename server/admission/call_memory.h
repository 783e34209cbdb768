// CallMemory: limits the memory that requests and answers hold, in all and for each peer.
//
// The number of live calls does not limit it: a request of 75 bytes can have an answer of megabytes, which stays in
// memory until its caller has read it. A call takes memory for its request before the request is parsed, and for its
// answer once the answer's size is known. What computes is not counted: Limits and the number of compute threads limit
// it.

#ifndef RICOCHET_SERVER_ADMISSION_CALL_MEMORY_H_
#define RICOCHET_SERVER_ADMISSION_CALL_MEMORY_H_

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class CallMemory {
 public:
  // The right to hold some bytes. The end of its last copy gives them back.
  using Hold = std::shared_ptr<void>;

  // Messages of fewer bytes are not counted, so that a small call does not pay for it: the number of live calls limits
  // those.
  static constexpr int64_t kUncounted = int64_t{16} << 10;

  // All peers together hold at most `bytes` > 0, and one of them three quarters of that.
  explicit CallMemory(int64_t bytes) : bytes_(bytes), bytes_of_peer_(bytes - bytes / 4) {}

  // Takes memory for a message of so many bytes, which this object must outlive. `peer` says who sends or reads it.
  // A message larger than a limit is allowed while nothing else counts against that limit.
  // Errors: RESOURCE_EXHAUSTED with kTooManyCalls and a retry delay while a limit is reached.
  absl::StatusOr<Hold> Take(absl::FunctionRef<std::string()> peer, int64_t bytes);

  // Returns the bytes that are held now.
  int64_t held() const;

 private:
  void GiveBack(const std::string& peer, int64_t bytes);

  const int64_t bytes_;
  const int64_t bytes_of_peer_;
  mutable std::mutex mutex_;
  int64_t held_ = 0;
  std::map<std::string, int64_t> held_by_peer_;  // Peers that hold some.
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_CALL_MEMORY_H_
