// Client: the Solver that asks a server over gRPC.
//
//   absl::StatusOr<ricochet::Client> client = ricochet::Client::Connect({.target = "127.0.0.1:50051"});
//   if (!client.ok()) return client.status();
//   absl::StatusOr<ricochet::SolveResponse> response = client->Solve({.scene = scene});

#ifndef RICOCHET_CLIENT_H_
#define RICOCHET_CLIENT_H_

#include <memory>

#include "absl/status/statusor.h"
#include "ricochet/client_options.h"
#include "ricochet/solver.h"

namespace ricochet {

// A Client gives the same bits as a LocalSolver of the same engine (EngineInfo::fingerprint).
//
// Thread safety: every method may be called from several threads at once; a SweepStream belongs to one thread at a
// time.
//
// Cost: a Client is a shared pointer; its copies share one connection, which is made at the first call. Connect is
// expensive, so make one Client for each server and copy it. A sweep keeps only one chunk in memory. A Client, a
// session or a stream that was moved from can only be destroyed or assigned to.
//
// Retries: ClientOptions::retry says how often a call is repeated, here and on the other servers of the list. Calls
// have no side effects, so a repeated one does no harm. A sweep that breaks off is taken up again at its next point;
// its bits and its summary are those of an undisturbed run, but for the time, which is unset. An engine with another
// fingerprint is refused with FAILED_PRECONDITION. A study of cost measures one machine, so that it is repeated only
// before its first rows, by the same server.
//
// Batches: a session keeps one call open, which is replaced by another if it breaks off or if the server ends it after
// a pause. A step is then answered again from its first row without an answer.
//
// Deadlines: a call ends at the deadline of its CallOptions or of ClientOptions, whichever comes first. The server
// learns of it, and of a stop, and ends its work too.
//
// gRPC, which the first Client starts, stays until the process ends.
//
// Errors: a Client returns the errors of Solver with the same reason and violations, UNAVAILABLE and DEADLINE_EXCEEDED
// of the network, UNAUTHENTICATED and PERMISSION_DENIED for a client without a token or a scope that the server wants,
// FAILED_PRECONDITION for a server that is not trusted or does not speak TLS, and DATA_LOSS if the chunks of a stream
// do not fit together (a gap, a repetition, a wrong size, an early end).
class Client final : public Solver {
 public:
  // Returns without waiting for a connection: only the first call finds out that no server is there.
  // Errors: INVALID_ARGUMENT that names the wrong options.
  static absl::StatusOr<Client> Connect(const ClientOptions& options);

 private:
  struct Connection;

  absl::StatusOr<SolveResponse> DoSolve(const SolveRequest& request, const CallOptions& options) const override;
  absl::StatusOr<PlanResponse> DoPlan(const PlanRequest& request, const CallOptions& options) const override;
  absl::StatusOr<BoundsResponse> DoBounds(const BoundsRequest& request, const CallOptions& options) const override;
  absl::StatusOr<AuditResponse> DoAudit(const AuditRequest& request, const CallOptions& options) const override;
  absl::StatusOr<AuditBatchResponse> DoAuditBatch(const AuditBatchRequest& request,
                                                  const CallOptions& options) const override;
  absl::StatusOr<FitResponse> DoFit(const FitRequest& request, const CallOptions& options) const override;
  absl::StatusOr<MultiContactResponse> DoMultiContact(const MultiContactRequest& request,
                                                      const CallOptions& options) const override;
  absl::StatusOr<BatchResponse> DoSolveBatch(const BatchSetup& setup, const BatchRows& rows,
                                             const CallOptions& options) const override;
  absl::StatusOr<BatchSession> DoOpenBatches(const BatchSetup& setup, const CallOptions& options) const override;
  SweepStream DoSweep(const SweepRequest& request, const CallOptions& options) const override;
  CostStream DoCost(const CostRequest& request, const CallOptions& options) const override;
  absl::StatusOr<InfoResponse> DoInfo(const InfoRequest& request, const CallOptions& options) const override;

  // Sends a batch that is too long for one message over a stream.
  absl::StatusOr<BatchResponse> SolveInPieces(const BatchSetup& setup, const BatchRows& rows,
                                              const CallOptions& options) const;

  explicit Client(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}
  std::shared_ptr<Connection> connection_;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_H_
