// Solver: the one interface. LocalSolver answers in this process, Client asks a server; both give the same bits.
//
// Thread safety: every method may be called from several threads at once.
// Errors: a bad request gets INVALID_ARGUMENT with its violations (ricochet/error.h), one that is too large for the
// solver RESOURCE_EXHAUSTED (ricochet/limits.h), an exact result above the largest double OUT_OF_RANGE, a call that its
// CallOptions end CANCELLED or DEADLINE_EXCEEDED; a Client adds the errors of the network. Numerical outcomes are
// fields of the answer, not errors.

#ifndef RICOCHET_SOLVER_H_
#define RICOCHET_SOLVER_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "ricochet/audit.h"
#include "ricochet/batch.h"
#include "ricochet/bounds.h"
#include "ricochet/call_options.h"
#include "ricochet/certificate.h"
#include "ricochet/cost.h"
#include "ricochet/demand.h"
#include "ricochet/derivatives.h"
#include "ricochet/engine_info.h"
#include "ricochet/error.h"
#include "ricochet/fit.h"
#include "ricochet/helpers.h"
#include "ricochet/info.h"
#include "ricochet/limits.h"
#include "ricochet/multi_contact.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/result_stream.h"
#include "ricochet/scene.h"
#include "ricochet/sweep.h"

namespace ricochet {

// A request may ask for the states, or the forces, at the ends of at most this many equal steps.
inline constexpr int64_t kMostIntervals = 65535;

struct SolveRequest {
  Scene scene = {};
  // Normal impulses tau at which Outcome::history gives the state, each in [0, tau1]; at most kMostIntervals + 1. Only
  // a planar scene without compliance and without an impact law has such a history, whatever the tolerance.
  std::vector<double> history_at_n_s = {};
  // If > 0, Outcome::history has the states at the ends of this many equal steps of tau from 0 to tau1, at most
  // kMostIntervals. It excludes history_at_n_s, whose scenes it takes.
  int64_t history_intervals = 0;
  // If true, admissible = false and the terminations kBudgetUsedUp and kRefused become FAILED_PRECONDITION.
  bool inadmissible_is_error = false;
  DemandFields demand = {};
  // If > 0, ContactDuration::history has the forces at this many equal steps of time, at most kMostIntervals. This
  // requires Effect::kFiniteDuration.
  int64_t force_intervals = 0;
  // If > 0, Outcome::certificate has this many significant digits, at most kMostCertifiedDigits. It must be 0 with
  // excluded effects. docs/theory/certified.md says which scenes can be certified.
  int32_t certified_digits = 0;
  // If true, Outcome::free_end has the same impact with no coordinate held. It takes a mechanism that holds some.
  bool both_ends = false;
  // If present, asks for Outcome::derivatives. No effect may be excluded.
  std::optional<DerivativePaths> derivatives = {};
  friend bool operator==(const SolveRequest&, const SolveRequest&) = default;
};

struct SolveResponse {
  // A defaulted constructor would clear the 2 KB of an answer that is made in place, before it initializes them.
  SolveResponse() {}  // NOLINT(modernize-use-equals-default)

  Outcome outcome;
  EngineInfo engine;
  friend bool operator==(const SolveResponse&, const SolveResponse&) = default;
};

struct PlanRequest {
  Scene scene = {};
  DemandFields demand = {};
  friend bool operator==(const PlanRequest&, const PlanRequest&) = default;
};

struct PlanResponse {
  Plan plan;
  EngineInfo engine;
  friend bool operator==(const PlanResponse&, const PlanResponse&) = default;
};

// The range in which a field of an uncertain scene lies.
struct FieldRange {
  std::string path = {};  // Path of the field, spelled as for an axis of a sweep.
  double low = 0.0;
  double high = 0.0;
  friend bool operator==(const FieldRange&, const FieldRange&) = default;
};

struct BoundsRequest {
  Scene scene = {};  // Its restitution may be left unset.
  // Ranges ask for an enclosure (docs/theory/bounds.md). All fields of a planar system, the coefficients of friction
  // and the velocity of the surface may have one.
  std::vector<FieldRange> ranges = {};
  int32_t certified_digits = 0;  // Digits of BoundsResponse::certificate; the rules of SolveRequest hold.
  // If present, asks for BoundsResponse::derivatives: of BoundsNumbers by numbers of the scene other than restitution.
  std::optional<DerivativePaths> derivatives = {};
  friend bool operator==(const BoundsRequest&, const BoundsRequest&) = default;
};

struct BoundsResponse {
  Bounds bounds;  // Bounds of the request's scene; ranges do not change them.
  EngineInfo engine;
  std::optional<Enclosure> enclosure;      // Present if there are ranges; holds for all scenes within them.
  std::optional<Certificate> certificate;  // Certifies `bounds`; present exactly if certified_digits asks for it.
  std::vector<Derivative> derivatives;     // One for each pair of BoundsRequest::derivatives; `by` changes first.
  friend bool operator==(const BoundsResponse&, const BoundsResponse&) = default;
};

struct AuditRequest {
  Scene scene = {};  // Its restitution and impact law are not used and may be left unset.
  Observed observed = {};
  double velocity_uncertainty_m_s = 0.0;  // Bound on the error of each component of the observed velocity, >= 0.
  friend bool operator==(const AuditRequest&, const AuditRequest&) = default;
};

struct AuditResponse {
  AuditReport report;
  // 1/2 v-.W+ v- with the pseudo-inverse W+ of W, to double precision times the condition of W. This is the least
  // kinetic energy that goes with the contact velocity before the impact, and the most that an impact can dissipate.
  double contact_energy_j = 0.0;
  EngineInfo engine;
  friend bool operator==(const AuditResponse&, const AuditResponse&) = default;
};

struct AuditBatchRequest {
  Scene scene = {};  // Its restitution and impact law are not used and may be left unset.
  AuditColumns columns = {};
  std::vector<InputColumn> inputs = {};  // Numbers of the scene that differ by row; no two of one path.
  friend bool operator==(const AuditBatchRequest&, const AuditBatchRequest&) = default;
};

struct AuditBatchResponse {
  std::vector<AuditReport> reports;  // One a row; kInvalid, all else 0, if it breaks a rule or cannot be computed.
  AuditSummary summary;
  EngineInfo engine;
  friend bool operator==(const AuditBatchResponse&, const AuditBatchResponse&) = default;
};

using SweepStream = ResultStream<SweepChunk>;
using CostStream = ResultStream<CostChunk>;

class Solver {
 public:
  virtual ~Solver() = default;

  // Computes one impact.
  absl::StatusOr<SolveResponse> Solve(const SolveRequest& request, const CallOptions& options = {}) const {
    return DoSolve(request, options);
  }

  // Plans one impact without computing it: which effects are simulated, which are left out, and why.
  absl::StatusOr<PlanResponse> Plan(const PlanRequest& request, const CallOptions& options = {}) const {
    return DoPlan(request, options);
  }

  // Bounds the values that the coefficients can take.
  absl::StatusOr<BoundsResponse> Bounds(const BoundsRequest& request, const CallOptions& options = {}) const {
    return DoBounds(request, options);
  }

  // Finds what an observed impact implies, and which limits it breaks.
  absl::StatusOr<AuditResponse> Audit(const AuditRequest& request, const CallOptions& options = {}) const {
    return DoAudit(request, options);
  }

  // Audits many observed impacts of scenes of one form. A bad row does not spoil the others.
  absl::StatusOr<AuditBatchResponse> AuditBatch(const AuditBatchRequest& request,
                                                const CallOptions& options = {}) const {
    return DoAuditBatch(request, options);
  }

  // Finds the numbers of a scene that measured impacts tell, with their intervals, and whether the physics can be true.
  absl::StatusOr<FitResponse> Fit(const FitRequest& request, const CallOptions& options = {}) const {
    return DoFit(request, options);
  }

  // Finds what several contacts at once can do, and whether their order matters.
  absl::StatusOr<MultiContactResponse> MultiContact(const MultiContactRequest& request,
                                                    const CallOptions& options = {}) const {
    return DoMultiContact(request, options);
  }

  // Computes many impacts of one system, given as columns, into the columns of `rows`. A bad row does not spoil the
  // others. A Client sends a batch that is too long for one message in pieces.
  absl::StatusOr<BatchResponse> SolveBatch(const BatchSetup& setup, const BatchRows& rows,
                                           const CallOptions& options = {}) const {
    return DoSolveBatch(setup, rows, options);
  }

  // Opens a session for batch after batch of one setup, such as the steps of a simulation. The session keeps the
  // options, which end it as a whole. A Client keeps one call open, and learns what is wrong with the setup at the
  // first batch.
  absl::StatusOr<BatchSession> OpenBatches(const BatchSetup& setup, const CallOptions& options = {}) const {
    return DoOpenBatches(setup, options);
  }

  // Computes many impacts and streams them in index order, each point once. The stream keeps the options. An invalid
  // request gives a stream of that one error.
  SweepStream Sweep(const SweepRequest& request, const CallOptions& options = {}) const {
    return DoSweep(request, options);
  }

  // Studies what the accuracy of one impact costs in time, on the machine that answers: every method that applies, with
  // its time and its error. The stream starts with a chunk without rows, gives the rows as they are measured, and ends
  // with a summary. It stops within 10 ms of a stop by its options, which it keeps. An invalid request gives a stream
  // of that one error.
  CostStream Cost(const CostRequest& request, const CallOptions& options = {}) const {
    return DoCost(request, options);
  }

  // Says which engine answers, what it can answer, and how large and how long a call may be.
  absl::StatusOr<InfoResponse> Info(const InfoRequest& request = {}, const CallOptions& options = {}) const {
    return DoInfo(request, options);
  }

 private:
  virtual absl::StatusOr<SolveResponse> DoSolve(const SolveRequest& request, const CallOptions& options) const = 0;
  virtual absl::StatusOr<PlanResponse> DoPlan(const PlanRequest& request, const CallOptions& options) const = 0;
  virtual absl::StatusOr<BoundsResponse> DoBounds(const BoundsRequest& request, const CallOptions& options) const = 0;
  virtual absl::StatusOr<AuditResponse> DoAudit(const AuditRequest& request, const CallOptions& options) const = 0;
  virtual absl::StatusOr<AuditBatchResponse> DoAuditBatch(const AuditBatchRequest& request,
                                                          const CallOptions& options) const = 0;
  virtual absl::StatusOr<FitResponse> DoFit(const FitRequest& request, const CallOptions& options) const = 0;
  virtual absl::StatusOr<MultiContactResponse> DoMultiContact(const MultiContactRequest& request,
                                                              const CallOptions& options) const = 0;
  virtual absl::StatusOr<BatchResponse> DoSolveBatch(const BatchSetup& setup, const BatchRows& rows,
                                                     const CallOptions& options) const = 0;
  virtual absl::StatusOr<BatchSession> DoOpenBatches(const BatchSetup& setup, const CallOptions& options) const = 0;
  virtual SweepStream DoSweep(const SweepRequest& request, const CallOptions& options) const = 0;
  virtual CostStream DoCost(const CostRequest& request, const CallOptions& options) const = 0;
  virtual absl::StatusOr<InfoResponse> DoInfo(const InfoRequest& request, const CallOptions& options) const = 0;
};

// LocalSolver is the Solver that runs in this process: it needs no server and no file. Copying it costs little.
//
// A call computes on the thread that makes it. A sweep or a batch that lasts longer than a millisecond is helped by
// others, which the solver starts when it first needs them, shares with its copies, and ends with the last of them and
// of their streams. Between two chunks helpers compute one chunk ahead, so that a stream holds a few chunks of 512 KiB
// at most, and one more for every four helpers. The number of threads changes no bit of an answer, and neither does the
// floating-point mode of the thread that calls (rounding, subnormal numbers, traps), which it has again afterwards.
//
// After a fork the new process has none of these threads: a solver made before it computes there on the calling thread
// alone. No call may be running while the process forks.
class LocalSolver final : public Solver {
 public:
  // Without limits it takes a request of any size, because the process that asks is the one that pays.
  LocalSolver() : LocalSolver(Limits::None()) {}
  // At most `threads` threads compute a sweep or a batch, the caller's own among them; with 1, no thread is ever
  // started. The default is one for each core that this process may use. `threads` must be >= 1.
  explicit LocalSolver(const Limits& limits, int threads = AvailableCores());

 private:
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

  const std::shared_ptr<Helpers>& HelpersOf(const CallOptions& options) const {
    return options.helpers == nullptr ? helpers_ : options.helpers;
  }

  Limits limits_;
  std::shared_ptr<Helpers> helpers_;
};

}  // namespace ricochet

#endif  // RICOCHET_SOLVER_H_
