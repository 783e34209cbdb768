// Model: the measured numbers as the scene predicts them, their residuals, and the derivatives of these by unknowns.

#ifndef RICOCHET_CORE_FIT_MODEL_H_
#define RICOCHET_CORE_FIT_MODEL_H_

#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "core/fit/fit.h"
#include "core/fit/problem.h"
#include "core/fit/settled_row.h"
#include "core/rows/driven_scene.h"
#include "ricochet/batch.h"
#include "ricochet/regime.h"
#include "ricochet/scene.h"

namespace ricochet::fit {

// Numbers and residuals stand in the order of Problem::numbers, slopes row by row with a column for each unknown. The
// residuals of a row whose inputs have errors are independent combinations of those of its numbers
// (core/fit/settled_row.h); behind those of all rows stand those of inputs that cannot move, which no unknown changes.
// Slopes, sides and scenes are those at the inputs that fit best.
// Thread safety: one thread at a time.
class Model {
 public:
  // The problem must outlive this object. `solve_rows` solves rows of its batch.
  Model(const Problem& problem, SolveRows solve_rows, absl::FunctionRef<bool()> stopped);

  const Problem& problem() const { return problem_; }
  // True once `stopped` has been; the functions below then return false.
  bool is_stopped() const { return is_stopped_; }
  // Asks `stopped`, for work between the functions below that takes long.
  bool Stops() { return is_stopped_ = is_stopped_ || stopped_(); }

  // Sets the residuals and returns true if all numbers have a prediction that doubles resolve.
  bool Residuals(const std::vector<double>& unknowns, std::vector<double>& residuals);
  // False if large unknowns cancel, and the rounding of one moves a number by more than a small part of its sigma: what
  // a search finds there is rounding.
  bool Resolves(const std::vector<double>& unknowns);
  // Sets the residuals at each of some points, NaN for a number without prediction. Returns false once it is stopped.
  bool ResidualsAll(const Table& points, Table& residuals);
  // Sets the regimes of the rows, and the numbers predicted for the stated inputs by the courses that the rows take.
  bool PredictRows(const std::vector<double>& unknowns, std::vector<Regime>& regimes, std::vector<double>& predicted);
  // The standard deviation of each measured number less that predicted one.
  std::vector<double> Sigmas(const std::vector<double>& unknowns);
  // Counts the inputs with errors that are held at the end of their allowed range.
  int64_t HeldInputs(const std::vector<double>& unknowns);
  // Returns the rows whose outcome breaks a limit: energy appears, or friction does positive work along the slip.
  std::vector<size_t> Inadmissible(const std::vector<double>& unknowns);
  // Returns the first measured number that has no prediction for the stated inputs, and why.
  std::optional<BadRow> Bad(const std::vector<double>& unknowns);

  // Sets the derivatives of the residuals by the free unknowns, 0 for others: exact ones if there are, the mean of both
  // sides where they differ; else differences, 0 for a number without neighbours. Returns false once it is stopped.
  bool Slopes(const std::vector<double>& unknowns, const std::vector<bool>& is_free, std::vector<double>& slopes);
  // Sets the difference quotients of the numbers towards lower and higher unknowns, NaN beyond a bound or a rule.
  bool Sides(const std::vector<double>& unknowns, const std::vector<bool>& is_free, std::vector<double>& below,
             std::vector<double>& above);

  // The scene of a row.
  const Scene& SceneOf(size_t row, const std::vector<double>& unknowns);

 private:
  // Solved holds all rows at each of several points, one point after the other, with a column for each measured one.
  struct Solved {
    Table columns;
    std::vector<Regime> regimes;
    std::vector<BadRow> bad_rows;
    std::vector<RowStatus> statuses;  // Set for as many as the caller has made room for.
  };

  bool Solve(const Table& fields, Solved& solved);
  // Solves the rows of all points together, so that they share the lanes and the threads.
  bool SolveAt(const Table& points, const Table& inputs, Solved& solved);
  bool SolveHere(const std::vector<double>& unknowns);
  bool Settle(const Table& points, TakeRow take);
  bool SettleHere(const std::vector<double>& unknowns);
  // The inputs that fit best, a column for each.
  const Table& InputsAt(const std::vector<double>& unknowns);
  std::vector<double> NumbersOf(const Solved& solved, size_t point) const;
  // Sets the derivatives of the predicted numbers.
  bool Differentiate(const std::vector<double>& unknowns, const std::vector<bool>& is_free,
                     std::vector<double>& derivatives);
  bool Exact(const std::vector<double>& unknowns, const std::vector<bool>& is_free, std::vector<double>& derivatives);

  const Problem& problem_;
  SolveRows solve_rows_;
  absl::FunctionRef<bool()> stopped_;
  bool is_stopped_ = false;
  DrivenScene driven_;
  // The last point that was solved, at the inputs that fit best. A search asks for the slopes where it asked for the
  // residuals last.
  std::vector<double> at_;
  Solved here_;
  // The last point at which rows were settled, if inputs have errors.
  std::vector<double> settled_at_;
  std::vector<SettledRow> settled_;
  Table settled_inputs_;
};

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_MODEL_H_
