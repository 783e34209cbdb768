// Places: limit how many calls are live at once, in all and for each peer, so that no client has them all.
//
// gRPC's own limits count streams, and a stream that its client has reset is free again while its handler still runs. A
// place is therefore held as long as the handler runs. Streams can be held for long and have limits of their own, which
// leave places for unary calls.

#ifndef RICOCHET_SERVER_ADMISSION_PLACES_H_
#define RICOCHET_SERVER_ADMISSION_PLACES_H_

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "absl/status/statusor.h"

namespace ricochet::server {

// All limits >= 1.
struct PlaceLimits {
  int calls = 1;             // Live calls, streams among them.
  int calls_per_peer = 1;    // Live calls of one peer.
  int streams = 1;           // Live streams.
  int streams_per_peer = 1;  // Live streams of one peer.
  friend bool operator==(const PlaceLimits&, const PlaceLimits&) = default;
};

// The limits that go with `calls` >= 1 live calls, unless others are asked for: one peer leaves an eighth of the calls
// and a quarter of the streams to others, and streams leave three quarters of the calls to unary calls.
constexpr PlaceLimits PlacesFor(int calls) {
  const auto at_least_1 = [](int number) { return number < 1 ? 1 : number; };
  return {.calls = calls,
          .calls_per_peer = at_least_1(calls - calls / 8),
          .streams = at_least_1(calls / 4),
          .streams_per_peer = at_least_1(calls / 4 - calls / 16)};
}

// Thread safety: every method may be called from several threads at once.
class Places {
 public:
  // The place of one live call. Destroying it gives the place back.
  class Place {
   public:
    Place(Place&&) noexcept = default;
    Place& operator=(Place&&) noexcept = default;

   private:
    friend class Places;
    struct Held {
      std::string peer;
      bool is_stream;
    };
    struct GiveBack {
      Places* places;
      void operator()(Held* held) const;
    };
    Place(Places* places, Held held) : held_(new Held(std::move(held)), GiveBack{places}) {}
    std::unique_ptr<Held, GiveBack> held_;
  };

  explicit Places(const PlaceLimits& limits) : limits_(limits) {}

  // Returns a place, which this object must outlive.
  // Errors: RESOURCE_EXHAUSTED with kTooManyCalls and a retry delay while a limit is reached.
  absl::StatusOr<Place> Enter(const std::string& peer, bool is_stream);

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

  const PlaceLimits limits_;
  mutable std::mutex mutex_;
  Count all_;
  std::map<std::string, Count> peers_;  // Peers with at least one live call.
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_PLACES_H_
