// FairQueue: the order in which calls that wait get to compute.
//
// Peers share the time of computing equally, however many calls each of them has: the next call is one of the peer that
// has had the least time. Among the calls of one peer the earliest deadline goes first. A peer that has been away
// starts level with the others and brings no credit (start-time fair queueing: Goyal, Vin and Cheng 1997).

#ifndef RICOCHET_SERVER_ADMISSION_FAIR_QUEUE_H_
#define RICOCHET_SERVER_ADMISSION_FAIR_QUEUE_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace ricochet::server {

// Thread safety: one thread at a time.
class FairQueue {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // A call that wants to compute.
  struct Item {
    std::string peer;
    Time deadline = Time::max();
    double expected_s = 0.0;  // Time that it is expected to compute, s.

   private:
    friend class FairQueue;
    uint64_t ticket_ = 0;  // Orders calls of the same deadline by their arrival.
  };

  // Adds a call, which must outlive its stay in the queue.
  void Add(Item& item);
  // Removes a call that waits.
  void Remove(const Item& item);

  // Removes the call whose turn it is and returns it, or null if none waits. Its peer is charged the expected time.
  Item* Next();

  // Corrects the time that the peer of a call was charged, to the time that it has computed in fact. Call it once for
  // each call that Next returned, when it has ended.
  void Settle(const Item& item, double computed_s);

  // Returns the time that calls would compute before `item`, s, if it were added now.
  double ExpectedAhead(const Item& item) const;

  size_t size() const { return size_; }

 private:
  struct Peer {
    double served_s = 0.0;
    double waiting_s = 0.0;  // Sum of expected_s of its calls that wait.
    int computing = 0;
    std::map<std::pair<Time, uint64_t>, Item*> waiting;
  };

  // Forgets a peer that neither waits nor computes.
  void ForgetIfIdle(std::map<std::string, Peer>::iterator peer);

  std::map<std::string, Peer> peers_;
  size_t size_ = 0;
  uint64_t tickets_ = 0;
  double level_s_ = 0.0;  // served_s of the peer whose turn it was last: where a peer that comes back starts.
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_FAIR_QUEUE_H_
