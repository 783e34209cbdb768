// Client: the Solver that asks a server.
//
//   absl::StatusOr<ricochet::Client> client = ricochet::Client::Connect({.target = "127.0.0.1:50051"});
//   if (!client.ok()) return client.status();
//   absl::StatusOr<ricochet::SolveResponse> response = client->Solve({.scene = scene});

#ifndef RICOCHET_CLIENT_H_
#define RICOCHET_CLIENT_H_

#include <memory>
#include <stop_token>

#include "absl/status/statusor.h"
#include "ricochet/client_options.h"
#include "ricochet/solver.h"

namespace ricochet {

// Answers with the bits of a LocalSolver of the same engine (EngineInfo::fingerprint).
//
// Thread safety: every method may be called from several threads at once; a SweepStream belongs to one thread at a
// time.
//
// Cost: a Client is a shared pointer; copies share one connection, which is made at the first call. Connect is the
// expensive step: make one Client a server and copy it. A sweep holds one chunk, whatever its size.
//
// Retries: by ClientOptions::retry, on UNAVAILABLE and before the first response, so never in the middle of a sweep.
// All calls are pure, so a repeated one does no harm. A sweep that broke off is taken up by asking for
// [next index, end_index), which gives the same bits.
//
// Errors: those of Solver with the same reason and violations; UNAVAILABLE and DEADLINE_EXCEEDED of the network;
// DATA_LOSS if the chunks of a sweep do not fit together: a gap, a repeat, a wrong size, an early end.
class Client final : public Solver {
 public:
  // Does not wait for a connection: a server that is not there shows at the first call.
  // Errors: INVALID_ARGUMENT that names the wrong options.
  static absl::StatusOr<Client> Connect(const ClientOptions& options);

  using Solver::Sweep;
  absl::StatusOr<SolveResponse> Solve(const SolveRequest& request) const override;
  absl::StatusOr<BoundsResponse> Bounds(const BoundsRequest& request) const override;
  absl::StatusOr<AuditResponse> Audit(const AuditRequest& request) const override;
  absl::StatusOr<AuditBatchResponse> AuditBatch(const AuditBatchRequest& request) const override;
  SweepStream Sweep(const SweepRequest& request, std::stop_token stop) const override;

 private:
  struct Connection;
  explicit Client(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}
  std::shared_ptr<Connection> connection_;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_H_
