#include "core/contact/inertia.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace ricochet {

double LargestMomentShare(const std::vector<double>& upper) {
  Eigen::Matrix3d matrix;
  matrix << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2], upper[4], upper[5];
  const Eigen::Matrix3d scaled = matrix / matrix.maxCoeff();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scaled, Eigen::EigenvaluesOnly).eigenvalues()(2) /
         scaled.trace();
}

}  // namespace ricochet
