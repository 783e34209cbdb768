// Admission: limits how many calls are live at once.
//
// gRPC's own limits count streams, and a stream that its client has reset is free again while its handler still runs. A
// ticket is therefore held as long as the handler runs.

#ifndef RICOCHET_SERVER_ADMISSION_H_
#define RICOCHET_SERVER_ADMISSION_H_

#include <atomic>
#include <memory>

#include "absl/status/statusor.h"

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class Admission {
 public:
  // The place of one live call. Destroying the ticket gives the place back.
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

  // Admits `limit` >= 1 calls at once.
  explicit Admission(int limit) : limit_(limit) {}

  // Returns a ticket, which this object must outlive.
  // Errors: RESOURCE_EXHAUSTED with kTooManyCalls and a retry delay while `limit` tickets are held.
  absl::StatusOr<Ticket> Enter();

  int live() const { return live_; }

 private:
  const int limit_;
  std::atomic<int> live_ = 0;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_H_
