// LiveCalls: limits how many calls are live at once, in all and for each peer, so that no client has them all.
//
// gRPC's own limits count streams, and a stream that its client has reset is free again while its handler still runs. A
// permit is therefore held as long as the handler runs. Streams can be held for long and have limits of their own,
// which leave permits for unary calls.

#ifndef RICOCHET_SERVER_ADMISSION_LIVE_CALLS_H_
#define RICOCHET_SERVER_ADMISSION_LIVE_CALLS_H_

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "absl/status/statusor.h"

namespace ricochet::server {

// All limits >= 1.
struct LiveCallLimits {
  int calls = 1;             // Live calls, streams among them.
  int calls_per_peer = 1;    // Live calls of one peer.
  int streams = 1;           // Live streams.
  int streams_per_peer = 1;  // Live streams of one peer.
  friend bool operator==(const LiveCallLimits&, const LiveCallLimits&) = default;
};

// The limits that go with others, unless they are asked for: one peer leaves an eighth of the calls and a quarter of
// the streams to others, and streams leave three quarters of the calls to unary calls. `calls` and `streams` are >= 1.
constexpr int CallsPerPeerFor(int calls) { return calls - calls / 8; }
constexpr int StreamsFor(int calls) { return calls < 4 ? 1 : calls / 4; }
constexpr int StreamsPerPeerFor(int streams) { return streams - streams / 4; }
constexpr LiveCallLimits LiveCallLimitsFor(int calls) {
  return {.calls = calls,
          .calls_per_peer = CallsPerPeerFor(calls),
          .streams = StreamsFor(calls),
          .streams_per_peer = StreamsPerPeerFor(StreamsFor(calls))};
}

// Thread safety: every method may be called from several threads at once.
class LiveCalls {
 public:
  // The right of one call to be live. The end of its last copy gives it back.
  using Permit = std::shared_ptr<void>;

  explicit LiveCalls(const LiveCallLimits& limits) : limits_(limits) {}

  // Returns a permit, which this object must outlive.
  // Errors: RESOURCE_EXHAUSTED with kTooManyCalls and a retry delay while a limit is reached.
  absl::StatusOr<Permit> Enter(const std::string& peer, bool is_stream);

  int live() const;

 private:
  struct Count {
    int calls = 0;
    int streams = 0;
    void Add(int number, bool is_stream) {
      calls += number;
      if (is_stream) streams += number;
    }
  };

  void Leave(const std::string& peer, bool is_stream);

  const LiveCallLimits limits_;
  mutable std::mutex mutex_;
  Count all_;
  std::map<std::string, Count> peers_;  // Peers with at least one live call.
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_LIVE_CALLS_H_
