// Acceptor: takes connections for gRPC, within limits.
//
// It has an accept loop of its own because that of gRPC 1.51 stops for good once the process is out of descriptors
// (CVE-2023-4785), limits nothing and does not tell when a connection ends. A connection that a limit refuses is closed
// at once. For each connection the acceptor keeps a second descriptor, by which it notices the end.

#ifndef RICOCHET_SERVER_TRANSPORT_ACCEPTOR_H_
#define RICOCHET_SERVER_TRANSPORT_ACCEPTOR_H_

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"
#include "server/base/descriptor.h"
#include "server/base/log.h"
#include "server/transport/connection_counts.h"
#include "server/transport/listener.h"

namespace ricochet::server {

// Thread safety: every method but Start may be called from several threads at once.
class Acceptor {
 public:
  // Takes over a connected descriptor that does not block.
  using Handler = std::function<void(int descriptor)>;

  struct Counts {
    int open = 0;
    int64_t accepted = 0;  // Since the start, those that have ended included.
    int64_t refused = 0;   // Since the start: by a limit, or for want of descriptors.
  };

  // `log` must outlive the acceptor.
  Acceptor(std::vector<Listener> listeners, const ConnectionLimits& limits, const Log& log);

  // Calls StopAccepting. Connections stay open.
  ~Acceptor();
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  // Starts to hand connections to `handler`, on a thread of the acceptor. Call it once.
  // Errors: RESOURCE_EXHAUSTED without enough descriptors.
  absl::Status Start(Handler handler);

  // Stops to listen; from its return on, the handler is not called any more. Repeated calls do nothing.
  void StopAccepting();

  Counts counts() const;

 private:
  struct Connection {
    Descriptor descriptor;
    std::string peer;
  };

  void Run();
  void AcceptSome(const Listener& listener);
  void Admit(Descriptor connection);
  // Counts a connection and watches for its end. Returns the reason why it is refused, or an empty text.
  std::string TryAdd(const Descriptor& connection, const std::string& peer);
  void Refuse(const std::string& peer, const std::string& reason);
  // Drops the second descriptor of a connection that has ended.
  void Forget(int number);
  // Waits for `time`, or until StopAccepting is called.
  void Pause(std::chrono::milliseconds time) const;

  std::vector<Listener> listeners_;
  const Log& log_;
  Handler handler_;
  const Descriptor epoll_;
  const Descriptor stop_;
  std::mutex stopping_;  // Held by StopAccepting.
  std::jthread thread_;

  std::atomic<int64_t> accepted_ = 0;
  std::atomic<int64_t> refused_ = 0;
  // These two belong to the thread.
  int64_t refused_unlogged_ = 0;
  std::chrono::steady_clock::time_point next_log_;

  mutable std::mutex mutex_;  // Guards what follows.
  ConnectionCounts counts_;
  std::unordered_map<int, Connection> connections_;  // By the number of the second descriptor.
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TRANSPORT_ACCEPTOR_H_
