// Solver: the one interface. LocalSolver answers in this process, Client asks a server; both give the same bits.
//
// Thread safety: every method may be called from several threads at once.
// Errors: INVALID_ARGUMENT with all violations (ricochet/error.h) for a bad request; OUT_OF_RANGE for an exact result above
// the largest double; a Client adds those of the network. Numerical outcomes are fields of the answer, not errors.

#ifndef RICOCHET_SOLVER_H_
#define RICOCHET_SOLVER_H_

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "ricochet/audit.h"
#include "ricochet/bounds.h"
#include "ricochet/certificate.h"
#include "ricochet/demand.h"
#include "ricochet/engine_info.h"
#include "ricochet/error.h"
#include "ricochet/outcome.h"
#include "ricochet/result_stream.h"
#include "ricochet/scene.h"
#include "ricochet/sweep.h"

namespace ricochet {

// The most forces of one request's history.
inline constexpr int64_t kMostForceIntervals = 65535;

struct SolveRequest {
  Scene scene;
  // Normal impulses tau at which the state is asked for (Outcome::history), each in [0, tau1]; at most 65,536.
  std::vector<double> history_at_n_s;
  // Turns an outcome with admissible = false into FAILED_PRECONDITION.
  bool inadmissible_is_error = false;
  DemandFields demand;
  bool plan_only = false;  // Answers Outcome::plan alone.
  // > 0: ContactDuration::history at so many equal steps of time, which requires Effect::kFiniteDuration. At most
  // kMostForceIntervals.
  int64_t force_intervals = 0;
  // > 0: Outcome::certificate to so many significant digits, at most kMostCertifiedDigits; 0: none. Not with plan_only
  // nor with excluded effects.
  // core/certified/certified.h says for which scenes.
  int32_t certified_digits = 0;
  friend bool operator==(const SolveRequest&, const SolveRequest&) = default;
};

struct SolveResponse {
  Outcome outcome;
  EngineInfo engine;
  friend bool operator==(const SolveResponse&, const SolveResponse&) = default;
};

// What a field of an uncertain scene lies between.
struct FieldRange {
  std::string path;  // As an axis of a sweep spells it (core/scene/field.h).
  double low = 0.0;
  double high = 0.0;
  friend bool operator==(const FieldRange&, const FieldRange&) = default;
};

struct BoundsRequest {
  Scene scene;  // Its restitution may be left unset.
  // Asks for an enclosure. Of any fields of a planar system, of friction's coefficients and of the surface's velocity
  // (core/answer/scene_enclosure.h).
  std::vector<FieldRange> ranges;
  int32_t certified_digits = 0;  // As in SolveRequest, for BoundsResponse::certificate.
  friend bool operator==(const BoundsRequest&, const BoundsRequest&) = default;
};

struct BoundsResponse {
  Bounds bounds;  // Of the scene as it stands.
  EngineInfo engine;
  std::optional<Enclosure> enclosure;      // Over all scenes whose fields lie in the ranges; absent if there are none.
  std::optional<Certificate> certificate;  // Of `bounds`; present exactly if certified_digits asks for it.
  friend bool operator==(const BoundsResponse&, const BoundsResponse&) = default;
};

struct AuditRequest {
  Scene scene;  // Its restitution and impact law are not used and may be left unset.
  Observed observed;
  double velocity_uncertainty_m_s = 0.0;  // Of each component of the observed contact velocity, >= 0.
  friend bool operator==(const AuditRequest&, const AuditRequest&) = default;
};

struct AuditResponse {
  AuditReport report;
  // 1/2 v-.W+ v- before the impact, to double precision times the condition of W: the least kinetic energy with this
  // contact velocity, the most that an impact can take; all there is if the contact's motion is that of the system.
  double contact_energy_j = 0.0;
  EngineInfo engine;
  friend bool operator==(const AuditResponse&, const AuditResponse&) = default;
};

struct AuditBatchRequest {
  Scene scene;  // As in AuditRequest.
  AuditColumns columns;
  friend bool operator==(const AuditBatchRequest&, const AuditBatchRequest&) = default;
};

struct AuditBatchResponse {
  std::vector<AuditReport> reports;  // One a row; of one that breaks a rule or overflows: kInvalid, all else 0.
  AuditSummary summary;
  EngineInfo engine;
  friend bool operator==(const AuditBatchResponse&, const AuditBatchResponse&) = default;
};

using SweepStream = ResultStream<SweepChunk>;

class Solver {
 public:
  virtual ~Solver() = default;

  // One impact.
  virtual absl::StatusOr<SolveResponse> Solve(const SolveRequest& request) const = 0;

  // The values that the coefficients can take.
  virtual absl::StatusOr<BoundsResponse> Bounds(const BoundsRequest& request) const = 0;

  // What an impact that was observed implies, and which limits it breaks.
  virtual absl::StatusOr<AuditResponse> Audit(const AuditRequest& request) const = 0;

  // The same of many impacts at one contact. A bad row does not spoil the others.
  virtual absl::StatusOr<AuditBatchResponse> AuditBatch(const AuditBatchRequest& request) const = 0;

  // Many impacts, streamed; points in index order, none twice, none left out. Ends with CANCELLED at most 1024 points
  // after `stop` was requested. A request that is invalid gives a stream of that one error.
  virtual SweepStream Sweep(const SweepRequest& request, std::stop_token stop) const = 0;
  SweepStream Sweep(const SweepRequest& request) const { return Sweep(request, std::stop_token()); }
};

// The Solver that runs in this process: no server, no thread, no file. Copying it costs nothing.
class LocalSolver final : public Solver {
 public:
  using Solver::Sweep;
  absl::StatusOr<SolveResponse> Solve(const SolveRequest& request) const override;
  absl::StatusOr<BoundsResponse> Bounds(const BoundsRequest& request) const override;
  absl::StatusOr<AuditResponse> Audit(const AuditRequest& request) const override;
  absl::StatusOr<AuditBatchResponse> AuditBatch(const AuditBatchRequest& request) const override;
  SweepStream Sweep(const SweepRequest& request, std::stop_token stop) const override;
};

}  // namespace ricochet

#endif  // RICOCHET_SOLVER_H_
