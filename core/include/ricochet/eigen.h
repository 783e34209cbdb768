// Eigen: mechanisms and contacts from the matrices of a program that uses Eigen. Nothing else of Ricochet shows Eigen,
// so only a program that includes this header needs it.
//
// MechanismFrom takes M (n x n), J (2 x n, rows t and n, or 3 x n, rows t1, t2 and n) and q' (n). It checks their
// shapes; the solver checks their entries, and its errors name one by its place in ricochet::Mechanism. A library that
// fills one triangle of M alone must fill the other one first: M.triangularView<Eigen::StrictlyLower>() =
// M.transpose(). InFrame turns a Jacobian in world axes (3 x n) into those of the contact: the rows of `axes` are t1,
// t2 and n.

#ifndef RICOCHET_EIGEN_H_
#define RICOCHET_EIGEN_H_

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "ricochet/contact_matrix.h"
#include "ricochet/error.h"
#include "ricochet/outcome.h"
#include "ricochet/system.h"

namespace ricochet {

// Errors: INVALID_ARGUMENT that names the matrices whose shapes do not fit.
inline absl::StatusOr<Mechanism> MechanismFrom(const Eigen::Ref<const Eigen::MatrixXd>& mass_matrix,
                                               const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                                               const Eigen::Ref<const Eigen::VectorXd>& rates) {
  const auto row_by_row = [](const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
    std::vector<double> entries;
    entries.reserve(static_cast<size_t>(matrix.size()));
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) entries.push_back(matrix(i, j));
    }
    return entries;
  };
  const Eigen::Index n = rates.size();
  std::vector<Violation> violations;
  const auto require = [&](bool holds, const char* field, const auto& matrix, const std::string& shape) {
    if (holds) return;
    violations.push_back(
        {field, absl::StrCat("is ", matrix.rows(), " x ", matrix.cols(), ": must be ", shape, " for ", n, " rates")});
  };
  require(mass_matrix.rows() == n && mass_matrix.cols() == n, "mechanism.mass_matrix", mass_matrix,
          absl::StrCat(n, " x ", n));
  require((jacobian.rows() == 2 || jacobian.rows() == 3) && jacobian.cols() == n, "mechanism.jacobian", jacobian,
          absl::StrCat("2 x ", n, " or 3 x ", n));
  if (!violations.empty()) return InvalidRequest(violations);
  return Mechanism{.mass_matrix = row_by_row(mass_matrix),
                   .jacobian = row_by_row(jacobian),
                   .rates = {rates.data(), rates.data() + rates.size()}};
}

inline Eigen::MatrixXd InFrame(const Eigen::Matrix3d& axes, const Eigen::Ref<const Eigen::MatrixXd>& jacobian) {
  return axes * jacobian;
}

// W as a matrix, with the errors of ricochet/contact_matrix.h.
inline absl::StatusOr<PlanarContact> ContactFrom(const Eigen::Matrix2d& w, double tangential_m_s, double normal_m_s) {
  const Eigen::Matrix<double, 2, 2, Eigen::RowMajor> rows = w;
  return ContactFrom(std::span<const double, 4>(rows.data(), 4), tangential_m_s, normal_m_s);
}
inline absl::StatusOr<SpatialContact> ContactFrom(const Eigen::Matrix3d& w, const Eigen::Vector2d& tangential_m_s,
                                                  double normal_m_s) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = w;
  return ContactFrom(std::span<const double, 9>(rows.data(), 9), std::array{tangential_m_s(0), tangential_m_s(1)},
                     normal_m_s);
}

// The velocities of a mechanism after the impact.
inline Eigen::VectorXd RatesAfter(const Outcome& outcome) {
  return Eigen::Map<const Eigen::VectorXd>(outcome.rates_after.data(),
                                           static_cast<Eigen::Index>(outcome.rates_after.size()));
}

}  // namespace ricochet

#endif  // RICOCHET_EIGEN_H_
