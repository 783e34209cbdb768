// Auth: decides by token or client certificate who makes a call and whether that caller may make it.
//
// A refusal tells the caller nothing but UNAUTHENTICATED or PERMISSION_DENIED; the log says why, without the caller's
// address, which gRPC does not tell a check of metadata. Nor does it let such a check answer with metadata. Health is
// open to everybody, because probes have no tokens.

#ifndef RICOCHET_SERVER_SECURITY_AUTH_H_
#define RICOCHET_SERVER_SECURITY_AUTH_H_

#include <grpcpp/server_context.h>

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/base/log.h"
#include "server/base/watched_file.h"
#include "server/security/callers.h"

namespace ricochet::server {

// Evidence: the parts of a call that tell who makes it.
struct Evidence {
  std::string method;                          // Its path: "/ricochet.v1.ImpactService/Solve".
  std::vector<std::string> authorization;      // The values of the header of this name; more than one is refused.
  std::vector<std::string> certificate_names;  // The names of a client certificate that was verified.
  std::string user_agent;                      // The caller's word for its program.
  std::string request_id;                      // The caller's own id of the call; empty if it sent none.
};

// Thread safety: every method may be called from several threads at once.
class Auth {
 public:
  // Reads the file of --tokens. From then on it looks at the file once a second when calls come in; a file that cannot
  // be read or is wrong leaves the callers as they were, with an error in the log. `log` must outlive the object.
  // Errors: those of the file system, INVALID_ARGUMENT for wrong lines; the message names the file.
  static absl::StatusOr<std::shared_ptr<Auth>> Open(const std::string& path, const Log& log);

  // Makes `count` be called with the reason of each refusal, on any thread. Call it before the first call is checked.
  void OnRefusal(std::function<void(const std::string& reason)> count) { count_ = std::move(count); }

  // Returns OK if the call may go on. Errors: UNAUTHENTICATED, PERMISSION_DENIED, both with a fixed text.
  absl::Status Check(const Evidence& evidence);

  // Returns true if the call is one of `caller`, a name of CallerOf, who may call this method (a path, as in Evidence).
  // Neither logs nor counts.
  bool StillAllows(const grpc::ServerContext& context, const std::string& method, const std::string& caller);

  // Returns "token:NAME" or "certificate:NAME" of the caller, or an empty text for a call of health without a token.
  std::string CallerOf(const grpc::ServerContext& context);

 private:
  // Finding says who calls, or why the caller is not known.
  struct Finding {
    std::optional<Callers::Caller> caller;
    std::string reason;
  };

  Auth(const std::string& path, const Log& log) : log_(log), file_(path) {}
  absl::Status Load();
  Finding Find(const Evidence& evidence);
  std::shared_ptr<const Callers> Current();
  // Logs and counts a refusal, and returns it.
  absl::Status Refuse(absl::Status refusal, const Evidence& evidence, const std::string& caller,
                      const std::string& why) const;

  const Log& log_;
  std::function<void(const std::string&)> count_ = [](const std::string& /*reason*/) {};
  std::mutex mutex_;  // Guards what follows.
  WatchedFile file_;
  std::shared_ptr<const Callers> callers_;
  std::chrono::steady_clock::time_point next_look_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_SECURITY_AUTH_H_
