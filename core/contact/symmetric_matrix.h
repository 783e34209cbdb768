// Symmetric matrices: a 3 x 3 one of its upper triangle, its scales, its least eigenvalue, the moments of an inertia.

#ifndef RICOCHET_CORE_CONTACT_SYMMETRIC_MATRIX_H_
#define RICOCHET_CORE_CONTACT_SYMMETRIC_MATRIX_H_

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace ricochet {

// `upper` is the upper triangle, row by row.
inline Eigen::Matrix3d Symmetric(const double* upper) {
  Eigen::Matrix3d matrix;
  matrix << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2], upper[4], upper[5];
  return matrix;
}

// The inverse square roots of the diagonal; 0 for an entry that is not positive.
template <typename Matrix>
auto InverseScales(const Matrix& matrix) {
  Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1> scales(matrix.rows());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    scales(i) = matrix(i, i) > 0.0 ? 1.0 / std::sqrt(matrix(i, i)) : 0.0;
  }
  return scales;
}

// The smallest eigenvalue of a matrix that is scaled to a unit diagonal: at most 1, and 0 for a singular matrix. It is
// -infinity if a diagonal entry is negative, or is 0 in a row that is not 0.
template <typename Matrix>
double SmallestScaledEigenvalue(const Matrix& matrix) {
  const auto scales = InverseScales(matrix);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (scales(i) == 0.0 && !matrix.row(i).isZero(0.0)) return -std::numeric_limits<double>::infinity();
  }
  const Matrix scaled = scales.asDiagonal() * matrix * scales.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix>(scaled, Eigen::EigenvaluesOnly).eigenvalues()(0);
}

// The largest principal moment of a positive definite inertia tensor divided by the sum of all three. The tensor of a
// body has at most 1/2, which a flat plate and a thin rod reach, because no moment exceeds the sum of the other two.
inline double LargestMomentShare(const Eigen::Matrix3d& inertia) {
  const Eigen::Matrix3d scaled = inertia / inertia.maxCoeff();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scaled, Eigen::EigenvaluesOnly).eigenvalues()(2) /
         scaled.trace();
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_SYMMETRIC_MATRIX_H_
