// Model: the measured numbers as the scene predicts them, and their derivatives by the unknowns.

#ifndef RICOCHET_CORE_FIT_MODEL_H_
#define RICOCHET_CORE_FIT_MODEL_H_

#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "core/fit/fit.h"
#include "core/fit/problem.h"
#include "core/rows/driven_scene.h"
#include "ricochet/batch.h"
#include "ricochet/regime.h"
#include "ricochet/scene.h"

namespace ricochet::fit {

// Numbers stand in the order of Problem::numbers, derivatives row by row with a column for each unknown.
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

  // Sets the predicted numbers and returns true if all exist. The rows of Bad and regimes() are those of the last call.
  bool Predict(absl::Span<const double> unknowns, std::vector<double>& predicted);
  // Predicts the numbers at each of some points; a number that does not exist is not finite. Returns false once it is
  // stopped.
  bool PredictAll(const std::vector<std::vector<double>>& points, std::vector<std::vector<double>>& predicted);
  const std::vector<Regime>& regimes() const { return here_.regimes; }
  // The rows whose outcome breaks a limit: energy appears, or friction works along the slip.
  std::vector<size_t> Inadmissible(const std::vector<double>& unknowns);
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
  // All rows at each of some points, one point after the other: a column for each measured column.
  struct Solved {
    std::vector<std::vector<double>> columns;
    std::vector<Regime> regimes;
    std::vector<BadRow> bad_rows;
    std::vector<RowStatus> statuses;  // Set for as many as the caller has made room for.
  };

  bool SolveAt(const std::vector<std::vector<double>>& points, Solved& solved);
  bool SolveHere(absl::Span<const double> unknowns);
  std::vector<double> NumbersOf(const Solved& solved, size_t point) const;
  bool Exact(absl::Span<const double> unknowns, const std::vector<bool>& is_free, std::vector<double>& derivatives);

  const Problem& problem_;
  SolveRows solve_rows_;
  absl::FunctionRef<bool()> stopped_;
  bool is_stopped_ = false;
  DrivenScene driven_;
  // The last point that was predicted. A search asks for the derivatives where it asked for the numbers last.
  std::vector<double> at_;
  Solved here_;
};

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_MODEL_H_
