// Model: the measured numbers as the scene predicts them, and their derivatives by the unknowns.

#ifndef RICOCHET_CORE_FIT_MODEL_H_
#define RICOCHET_CORE_FIT_MODEL_H_

#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "core/fit/problem.h"
#include "core/rows/driven_scene.h"
#include "core/rows/row_solver.h"
#include "ricochet/batch.h"
#include "ricochet/scene.h"

namespace ricochet::fit {

// Numbers stand in the order of Problem::numbers, derivatives row by row with a column for each unknown.
// Thread safety: one thread at a time.
class Model {
 public:
  // The problem must outlive this object. `stopped` is asked before each row.
  Model(const Problem& problem, absl::FunctionRef<bool()> stopped);

  const Problem& problem() const { return problem_; }
  // True once `stopped` has been; the functions below then return false.
  bool is_stopped() const { return is_stopped_; }

  // Sets the predicted numbers and returns true if all exist. The rows of Bad and regimes() are those of the last call.
  bool Predict(absl::Span<const double> unknowns, std::vector<double>& predicted);
  const std::vector<Regime>& regimes() const { return regimes_; }
  // Returns the first measured number that has no prediction, and why.
  std::optional<BadRow> Bad(const std::vector<double>& predicted) const;

  // Sets the derivatives by the free unknowns, 0 for others: exact ones if there are, the mean of both sides where they
  // differ; else differences, 0 for a number without neighbours. Returns false once it is stopped.
  bool Differentiate(absl::Span<const double> unknowns, const std::vector<bool>& is_free,
                     std::vector<double>& derivatives);
  // Sets the difference quotients towards lower and higher unknowns, NaN beyond a bound or a rule.
  bool Sides(absl::Span<const double> unknowns, const std::vector<bool>& is_free, std::vector<double>& below,
             std::vector<double>& above);

  // The scene of a row.
  const Scene& SceneOf(size_t row, absl::Span<const double> unknowns);

 private:
  bool SolveAt(const std::vector<std::vector<double>>& points);
  bool Exact(absl::Span<const double> unknowns, const std::vector<bool>& is_free, std::vector<double>& derivatives);

  const Problem& problem_;
  absl::FunctionRef<bool()> stopped_;
  bool is_stopped_ = false;
  RowSolver solver_;
  DrivenScene driven_;
  // The results of the last points, one after the other: a column for each measured column.
  std::vector<std::vector<double>> outputs_;
  std::vector<Regime> regimes_;
  std::vector<BadRow> bad_rows_;
};

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_MODEL_H_
