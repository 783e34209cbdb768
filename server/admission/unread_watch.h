// UnreadWatch: ends calls whose caller does not read what it is sent.
//
// A write, and the answer of a unary call, wait for the caller to read, for ever if the caller never does: a peer that
// answers pings keeps its connection. A thread cancels calls that have waited for too long, which ends the wait.

#ifndef RICOCHET_SERVER_ADMISSION_UNREAD_WATCH_H_
#define RICOCHET_SERVER_ADMISSION_UNREAD_WATCH_H_

#include <grpcpp/server_context.h>

#include <chrono>
#include <condition_variable>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class UnreadWatch {
  struct Entry {
    grpc::ServerContext* context;
    std::chrono::steady_clock::time_point start;
    bool is_cut = false;
  };

 public:
  // Calls are cancelled when one write has waited for `limit` > 0.
  explicit UnreadWatch(std::chrono::milliseconds limit);
  ~UnreadWatch();
  UnreadWatch(const UnreadWatch&) = delete;
  UnreadWatch& operator=(const UnreadWatch&) = delete;

  // Is watched from its construction to its destruction.
  class Write {
   public:
    // The watch and the context must outlive the write.
    Write(UnreadWatch& watch, grpc::ServerContext& context);
    ~Write();
    Write(const Write&) = delete;
    Write& operator=(const Write&) = delete;

    // Returns the time since the construction.
    std::chrono::duration<double> waited() const;

    // True if the watch has cancelled the call.
    bool is_cut() const;

   private:
    UnreadWatch& watch_;
    std::list<Entry>::iterator entry_;
  };

  // The answer of a call, from before its handler runs until gRPC has sent it.
  class Answer {
   public:
    Answer(UnreadWatch& watch, grpc::ServerContext& context);
    ~Answer();
    Answer(const Answer&) = delete;
    Answer& operator=(const Answer&) = delete;

   private:
    UnreadWatch& watch_;
    grpc::ServerContext& context_;
  };

  // Says that the handler of a call returns: from now on its caller must read the answer, within the limit or, if the
  // call was refused, within a second. The watch keeps `ending` until the answer is sent, and lets go of it at once if
  // the call has no Answer.
  void Sends(const grpc::ServerContext& context, bool is_refused, std::shared_ptr<void> ending);

  std::chrono::milliseconds limit() const { return limit_; }

 private:
  struct Waiting {
    grpc::ServerContext* context;
    std::optional<std::chrono::steady_clock::time_point> end;  // Absent while the handler runs.
    std::shared_ptr<void> ending;
  };

  void Watch();
  // Cancels what has waited for too long. Called with the mutex locked.
  void Cut();

  const std::chrono::milliseconds limit_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stopping_ = false;
  std::list<Entry> writes_;  // The oldest is the first.
  std::map<const grpc::ServerContext*, Waiting> answers_;
  std::thread thread_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_UNREAD_WATCH_H_
