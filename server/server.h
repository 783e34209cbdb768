// Server: the impact service with health checks, reflection and limits.
//
// A server drains in three steps. First its health becomes NOT_SERVING, so that load balancers send calls elsewhere.
// After the drain grace, running sweeps end at their next chunk with UNAVAILABLE and a retry delay. Then all calls have
// the drain timeout to end.

#ifndef RICOCHET_SERVER_SERVER_H_
#define RICOCHET_SERVER_SERVER_H_

#include <grpcpp/server.h>

#include <memory>
#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "ricochet/solver.h"
#include "server/admission.h"
#include "server/impact_service.h"
#include "server/listen_address.h"
#include "server/log.h"
#include "server/observer.h"
#include "server/options.h"
#include "server/stop_signals.h"

namespace ricochet::server {

class Server {
 public:
  // Starts a server that takes calls. `log` must outlive it.
  // Errors: UNAVAILABLE if it cannot listen, those of the file system if it cannot write the port file.
  static absl::StatusOr<std::unique_ptr<Server>> Start(const Options& options, const Log& log);

  // Cancels the calls that still run.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // Returns the address at which it listens, with the port that the system chose.
  const ListenAddress& address() const { return address_; }

  // Serves until a signal comes, then drains. A second signal skips the rest of the grace. Call it once; afterwards the
  // process must exit without destroying the server: a client that has stopped reading can block a write for ever, so
  // that a thread may still use this object and its destruction may never end.
  void ServeUntil(const StopSignals& signals);

 private:
  Server(const Options& options, const Log& log);
  absl::Status Listen();
  void Shutdown();

  const Options options_;
  const Log& log_;
  ListenAddress address_;
  std::stop_source drain_;
  LocalSolver solver_;
  Admission admission_;
  const Observer observer_;
  ImpactService service_;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_SERVER_H_
