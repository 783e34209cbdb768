// SettledRow: a row of measured numbers whose inputs have errors, too ("errors in variables").
//
// The row measured the numbers y with the standard deviations s_y, and states the inputs z with s_z. Its part of the
// objective is the least value over the true inputs x of
//
//   |(y - f(x)) / s_y|^2 + |(z - x) / s_z|^2
//
// where f is what the scene predicts. With J = df/dx beside that x and d = y - f(x) - J (z - x), it is the square of
// the independent residuals
//
//   e = R d,   R^T R = C^-1,   C = diag(s_y^2) + J diag(s_z^2) J^T
//
// whose derivatives by the unknowns are -R df. Source: P. T. Boggs, R. H. Byrd, R. B. Schnabel, A stable and efficient
// algorithm for nonlinear orthogonal distance regression, SIAM J. Sci. Stat. Comput. 8 (1987).

#ifndef RICOCHET_CORE_FIT_SETTLED_ROW_H_
#define RICOCHET_CORE_FIT_SETTLED_ROW_H_

#include <Eigen/Core>
#include <vector>

#include "absl/functional/function_ref.h"
#include "core/fit/problem.h"

namespace ricochet::fit {

struct SettledRow {
  std::vector<double> inputs;  // All inputs of the row; those that have errors are x.
  // These have an entry for each number of the row, which is NaN if the row has no prediction.
  Eigen::VectorXd predicted;  // y - d, the prediction for the stated inputs by the course that x takes.
  Eigen::VectorXd sigmas;     // The standard deviations of d.
  Eigen::VectorXd residuals;  // e
  // R: the inverse of a triangular root of C, or, for a robust loss, of the symmetric one, which does not depend on the
  // order of the numbers.
  Eigen::MatrixXd whitening;
  // This has an entry for each uncertain input: its shift in sigmas if it is held at the end of its allowed range, else
  // 0. The objective counts the square of the shift, too.
  Eigen::VectorXd held;
  size_t held_inputs = 0;  // Counts the inputs so held. One whose stated value is the end has no shift.
};

// A column for each field of the problem's batch, or for each of its columns.
using Table = std::vector<std::vector<double>>;
// Sets the measured columns of rows that are given by their fields. Returns false once it is stopped.
using SolveTable = absl::FunctionRef<bool(const Table& fields, Table& columns)>;
using TakeRow = absl::FunctionRef<void(const SettledRow& row)>;

// Settles all rows of the problem at each of some values of the unknowns, and gives them to `take` one after the other.
// A search starts from the stated inputs, and from others nearby where f is not on its straight lines, as behind the
// threshold of another course. J is that of central differences, and 0 for an input that is held at the end of its
// range. If the best inputs lie on a corner of f, the residuals have the sum of squares that belongs to the inputs
// found. Returns false once `solve` does.
bool SettleRows(const Problem& problem, const Table& points, SolveTable solve, TakeRow take);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_SETTLED_ROW_H_
