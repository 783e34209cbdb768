// SweepFanOut: the receiving end of a sweep that all servers of a list compute together.
//
// Each server has a thread here, which asks it for one range of points after another. A RangeScheduler says which range
// is next, and gives the chunks in the order of the points. A server that is fast gets long ranges, and many.

#ifndef RICOCHET_CLIENT_SWEEP_FAN_OUT_H_
#define RICOCHET_CLIENT_SWEEP_FAN_OUT_H_

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/attempts.h"
#include "client/range_scheduler.h"
#include "client/sweep_reader.h"
#include "ricochet/call_options.h"
#include "ricochet/client_options.h"
#include "ricochet/sweep.h"

namespace ricochet {

// The chunks, joined, and the summary are those of a call that nothing disturbed. The sweep fails like a SweepReader.
// It goes on without a server that cannot be reached as often as the retry policy allows, or that refuses it by a limit
// or a right of its own, and fails once all servers are lost in one of these ways. Until then each is asked again and
// again, in case that it comes back.
//
// Thread safety: one thread at a time may use a reader; any thread may trigger the stop token.
class SweepFanOut {
 public:
  // Servers says how the servers are reached: `start` asks the server of a number in [0, servers).
  struct Servers {
    SweepReader::Start start;
    size_t count = 1;
    RetryPolicy retry;
    FanOut fan_out;
  };

  // `request` is for at least one point of a valid grid and has an end_index. All calls together end when `options` say
  // so.
  SweepFanOut(const SweepRequest& request, Servers servers, CallOptions options);

  // Ends all calls and waits for their threads.
  ~SweepFanOut();
  SweepFanOut(const SweepFanOut&) = delete;
  SweepFanOut& operator=(const SweepFanOut&) = delete;

  // Returns the next chunk, an error, or nothing at the end of the sweep; it serves as a ResultStream::Source.
  std::optional<absl::StatusOr<SweepChunk>> Next();

  // The most bytes of chunks that ever waited for their turn.
  int64_t most_waiting_bytes() const;

 private:
  using Clock = std::chrono::steady_clock;
  class Server;

  void StartThreads();
  // The work of a server's thread.
  void Serve(size_t number);
  // Waits until there is work for the server; returns nothing at the end.
  std::optional<RangeScheduler::Task> WaitForTask(const Server& server);
  absl::Status Compute(const RangeScheduler::Task& task, Server& server);
  // Decides what an error means: how long the server is left alone, or that the sweep fails.
  void Fail(const absl::Status& status, const RangeScheduler::Task& task, Server& server);
  // Waits for this time, or until the end.
  void BackOff(std::chrono::milliseconds time);
  void End();

  // Returns the next chunk or the failure, or nothing at this time or at the end.
  std::optional<absl::StatusOr<SweepChunk>> WaitUntil(Clock::time_point until);
  absl::StatusOr<SweepChunk> Join(RangeScheduler::Piece piece);
  // Adds to a status which server has failed.
  absl::Status FromServer(const absl::Status& status, size_t number) const;
  // Called with the mutex locked.
  absl::Status NoServerLeft(const absl::Status& last) const;

  const SweepRequest request_;
  const Servers servers_;
  const CallOptions options_;

  mutable std::mutex mutex_;
  std::condition_variable arrived_;  // A chunk that may leave, or a failure.
  std::condition_variable work_;     // A range, room for one, or the end.
  RangeScheduler scheduler_;
  std::vector<bool> is_lost_;  // True for a server that has failed as often as allowed.
  bool has_begun_ = false;     // True once a chunk has arrived.
  bool ended_ = false;
  std::optional<absl::Status> failure_;

  // The members below belong to the reading thread and describe the chunks that have left.
  int64_t points_ = 0;
  int64_t task_ = 0;            // The task of the last chunk.
  std::string engine_;          // The fingerprint of its engine.
  SweepSummary task_tallies_;   // The counts of that task.
  SweepSummary other_tallies_;  // The counts of all tasks before it.

  std::vector<std::thread> threads_;
  std::optional<std::stop_callback<std::function<void()>>> on_stop_;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_SWEEP_FAN_OUT_H_
