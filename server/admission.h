// Admission: how many calls may be live at once.
//
// gRPC's own limits count streams, and a stream that a client resets is free again while its handler still runs. A
// ticket is held for as long as the handler runs.

#ifndef RICOCHET_SERVER_ADMISSION_H_
#define RICOCHET_SERVER_ADMISSION_H_

#include <atomic>
#include <memory>

#include "absl/status/statusor.h"

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class Admission {
 public:
  // One live call; gives its place back when destroyed.
  class Ticket {
   public:
    Ticket(Ticket&&) noexcept = default;
    Ticket& operator=(Ticket&&) noexcept = default;

   private:
    friend class Admission;
    struct Release {
      void operator()(std::atomic<int>* live) const { --*live; }
    };
    explicit Ticket(std::atomic<int>& live) : live_(&live) {}
    std::unique_ptr<std::atomic<int>, Release> live_;
  };

  // `limit` >= 1 calls.
  explicit Admission(int limit) : limit_(limit) {}

  // Errors: RESOURCE_EXHAUSTED with kTooManyCalls and a retry delay while `limit` tickets are held.
  // This object must outlive the ticket.
  absl::StatusOr<Ticket> Enter();

  int live() const { return live_; }

 private:
  const int limit_;
  std::atomic<int> live_ = 0;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_H_
