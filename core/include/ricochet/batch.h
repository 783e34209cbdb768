// Batch: many different scenes of one system, as columns. The columns of the answer are filled in place.
//
//   BatchSetup setup = {.scene = {.system = PlanarContact{...}, ...},
//                       .fields = {"planar_contact.tangential_m_s", "planar_contact.normal_m_s"},
//                       .columns = {"contact_velocity_after.normal_m_s"}};
//   absl::StatusOr<BatchSession> session = solver.OpenBatches(setup);
//   for (...) session->Solve({.inputs = {u, v}, .outputs = {absl::MakeSpan(v1)}});  // A step of a simulation.
//
// Each row gets the bits that a Solve of its scene gives, whatever other rows there are.

#ifndef RICOCHET_BATCH_H_
#define RICOCHET_BATCH_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "ricochet/demand.h"
#include "ricochet/engine_info.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"
#include "ricochet/sweep.h"

namespace ricochet {

// The part of a batch that all its rows share.
struct BatchSetup {
  Scene scene = {};                       // Gives every field that no column states.
  std::vector<std::string> fields = {};   // Path of each input column, spelled as for an axis of a sweep. At least one.
  std::vector<std::string> columns = {};  // Path of each output column, as for a sweep. At least one, no two equal.
  DemandFields demand = {};               // Demand on every row; each row gets its own plan.
  friend bool operator==(const BatchSetup&, const BatchSetup&) = default;
};

// Rows in memory of the caller. The number of rows is the length of every column. No output may share memory with
// another column.
struct BatchRows {
  std::vector<absl::Span<const double>> inputs = {};  // One for each field of the setup.
  // One for each column; receives quiet NaN in a row without numbers, and where the outcome leaves the number unset.
  std::vector<absl::Span<double>> outputs = {};
  absl::Span<Regime> regimes = {};      // Empty, or receives the regime of each row; kInvalid without numbers.
  absl::Span<RowStatus> statuses = {};  // Empty, or receives the status of each row.
};

// A row without numbers, and the first reason why it has none.
struct BadRow {
  int64_t row = 0;
  RowStatus status = RowStatus::kUnspecified;
  std::string field;        // Path of the field that is wrong, or of the number that exceeds the largest double.
  std::string description;  // The value found and the rule it breaks: "= -0.1: must be >= 0".
  friend bool operator==(const BadRow&, const BadRow&) = default;
};

// A summary names no more bad rows than this number.
inline constexpr size_t kMostBadRows = 8;

struct BatchSummary {
  SweepSummary counts;           // Rows take the place of points: indices are row numbers from 0. It has no time.
  std::vector<BadRow> bad_rows;  // The first of the rows without numbers.
  friend bool operator==(const BatchSummary&, const BatchSummary&) = default;
};

// Returns the summary of two batches of which the second goes on at row `first_row`.
BatchSummary Joined(BatchSummary first, BatchSummary second, int64_t first_row);

struct BatchResponse {
  BatchSummary summary;
  EngineInfo engine;
  friend bool operator==(const BatchResponse&, const BatchResponse&) = default;
};

// BatchSession solves batch after batch of one setup and keeps what they need, so that a step costs its rows alone.
// Thread safety: one thread at a time.
class BatchSession {
 public:
  // The work behind a session, which LocalSolver and Client implement.
  class Worker {
   public:
    virtual ~Worker() = default;
    virtual absl::StatusOr<BatchSummary> Solve(const BatchRows& rows) = 0;
    virtual absl::Status CheckSize(size_t rows) const = 0;
    virtual const EngineInfo& engine() const = 0;
  };
  explicit BatchSession(std::unique_ptr<Worker> worker) : worker_(std::move(worker)) {}

  // Fills the outputs. A row that is wrong does not spoil the others. After an error the outputs may be filled in part;
  // after one that is not INVALID_ARGUMENT or RESOURCE_EXHAUSTED the session is of no further use.
  // Errors: INVALID_ARGUMENT if the columns do not fit the setup or each other, and those of Solver.
  absl::StatusOr<BatchSummary> Solve(const BatchRows& rows) { return worker_->Solve(rows); }

  // Says before any columns are made whether this solver takes so many rows at once; for a Client, any number.
  // Errors: RESOURCE_EXHAUSTED.
  absl::Status CheckSize(size_t rows) const { return worker_->CheckSize(rows); }

  // The engine that solves. A Client knows it after the first batch.
  const EngineInfo& engine() const { return worker_->engine(); }

 private:
  std::unique_ptr<Worker> worker_;
};

}  // namespace ricochet

#endif  // RICOCHET_BATCH_H_
