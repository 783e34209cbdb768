#include "core/contact/mechanism.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/numerics/compensated_sums.h"
#include "core/numerics/moderate.h"

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-53;  // The largest relative error of one operation.

// (n u)^2/(1 - n u)^2, with a margin: what a compensated sum of n products adds to its own rounding.
double CompensatedNoise(Index n) {
  const double noise = static_cast<double>(n + 1) * kUnit;
  return 1.01 * noise * noise;
}

// J^T - M x, each entry in twice the precision.
void SetResidual(const FreePart& part, Response& response) {
  const Index n = part.mass.rows();
  const double noise = CompensatedNoise(n);
  for (Index j = 0; j < part.jt.cols(); ++j) {
    CompensatedResidual(part.mass.data(), response.x.col(j).data(), part.jt.col(j).data(), static_cast<size_t>(n),
                        response.residual.col(j).data(), response.doubt.col(j).data());
  }
  response.doubt = noise * response.doubt + kUnit * response.residual.cwiseAbs();
}

}  // namespace

double MassScale(double diagonal) {
  return std::scalbn(1.0, -static_cast<int>(std::floor(std::ilogb(diagonal) / 2.0)));
}

double LeastEigenvalue(size_t n) { return 16.0 * static_cast<double>(n) * std::numeric_limits<double>::epsilon(); }

std::vector<Index> FreeCoordinates(const Mechanism& mechanism) {
  return FreeCoordinates(mechanism, TangentialDirections(mechanism) == 2);
}

std::vector<Index> FreeCoordinates(const Mechanism& mechanism, bool in_space) {
  const auto n = static_cast<Index>(mechanism.rates.size());
  const Index base = in_space ? 6 : 3;
  std::vector<bool> is_held(mechanism.rates.size());
  for (const int32_t kept : mechanism.kept_coordinates) is_held[static_cast<size_t>(kept)] = true;
  std::vector<Index> free;
  for (Index i = 0; i < (mechanism.composite ? std::min(n, base) : n); ++i) {
    if (!is_held[static_cast<size_t>(i)]) free.push_back(i);
  }
  return free;
}

InverseBounds::InverseBounds(const Eigen::LLT<MatrixXd>& cholesky, double trace)
    : roots(VectorXd::Constant(cholesky.rows(), kInfinity)), norm(kInfinity) {
  const Index n = cholesky.rows();
  if (n == 0) norm = 0.0;
  if (n == 0 || cholesky.info() != Eigen::Success) return;
  const VectorXd columns = cholesky.matrixL().solve(MatrixXd::Identity(n, n)).colwise().norm();
  const double square = columns.squaredNorm();
  // The factor is that of M + dM with |dM| <= (n + 1) u trace M; where that is small, M^-1 is below 4/3 of the computed
  // inverse, and the inverse of the factor is right to a tenth of its columns.
  const double perturbation = static_cast<double>(n + 2) * kUnit * trace;
  if (!(8.0 * perturbation * square <= 1.0)) return;
  roots = 1.3 * columns;
  norm = 1.3 * std::sqrt(square);
}

ScaledMass::ScaledMass(const std::vector<double>& matrix, size_t n) {
  const auto size = static_cast<Index>(n);
  least_ = LeastEigenvalue(n);
  matrix_ = Eigen::Map<const MatrixXd>(matrix.data(), size, size);
  const VectorXd scales = matrix_.diagonal().unaryExpr(&MassScale);
  matrix_ = scales.asDiagonal() * matrix_ * scales.asDiagonal();
}

bool ScaledMass::IsSurelyDefinite() const {
  const Index n = matrix_.rows();
  // The factor is that of a matrix that differs by no more than (n + 1) u times its trace.
  const double shift = least_ + static_cast<double>(n + 2) * kUnit * matrix_.trace();
  return Eigen::LLT<MatrixXd>(matrix_ - shift * MatrixXd::Identity(n, n)).info() == Eigen::Success;
}

double ScaledMass::SmallestEigenvalue() const {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix_, Eigen::EigenvaluesOnly).eigenvalues()(0);
}

FreePart::FreePart(const Mechanism& mechanism) : FreePart(mechanism, TangentialDirections(mechanism) == 2) {}

FreePart::FreePart(const Mechanism& mechanism, bool in_space) : coordinates(FreeCoordinates(mechanism, in_space)) {
  const auto n = static_cast<Index>(mechanism.rates.size());
  const auto free = static_cast<Index>(coordinates.size());
  const auto directions = static_cast<Index>(mechanism.jacobian.size()) / n;
  const Eigen::Map<const MatrixXd> all(mechanism.mass_matrix.data(), n, n);  // It is symmetric.
  const Eigen::Map<const MatrixXd> transposed(mechanism.jacobian.data(), n, directions);
  scales.resize(free);
  mass.resize(free, free);
  jt.resize(free, directions);
  const auto at = [this](Index i) { return coordinates[static_cast<size_t>(i)]; };
  for (Index i = 0; i < free; ++i) scales(i) = MassScale(all(at(i), at(i)));
  for (Index i = 0; i < free; ++i) {
    for (Index k = 0; k < free; ++k) mass(i, k) = scales(i) * all(at(i), at(k)) * scales(k);
    for (Index j = 0; j < directions; ++j) jt(i, j) = scales(i) * transposed(at(i), j);
  }
}

Response::Response(const FreePart& part) : cholesky(part.mass) {
  const Index n = part.jt.rows();
  const Index directions = part.jt.cols();
  x = residual = doubt = MatrixXd::Zero(n, directions);
  w = w_size = MatrixXd::Zero(directions, directions);
  if (n == 0) return;
  // For so few columns Eigen solves each alone faster than all at once.
  for (Index j = 0; j < directions; ++j) x.col(j) = cholesky.solve(part.jt.col(j));
  SetResidual(part, *this);
  for (Index j = 0; j < directions; ++j) x.col(j) += cholesky.solve(residual.col(j));
  SetResidual(part, *this);
  for (Index i = 0; i < directions; ++i) {
    for (Index j = i; j < directions; ++j) {
      const CompensatedSum sum = CompensatedDots(part.jt.col(i).data(), x.col(j).data(), x.col(i).data(),
                                                 residual.col(j).data(), static_cast<size_t>(n));
      w(i, j) = w(j, i) = sum.value;
      w_size(i, j) = w_size(j, i) = sum.size;
    }
  }
}

std::vector<double> MomentumOf(const Mechanism& mechanism, const std::vector<Index>& free,
                               absl::Span<const double> response) {
  const auto n = static_cast<Index>(mechanism.rates.size());
  const auto directions = static_cast<Index>(TangentialDirections(mechanism) + 1);
  std::vector<double> momentum(response.size());
  const auto at = [directions](Index i, Index j) { return static_cast<size_t>(i * directions + j); };
  std::vector<bool> is_held(mechanism.rates.size(), true);
  for (const Index i : free) is_held[static_cast<size_t>(i)] = false;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < directions; ++j) {
      double& sum = momentum[at(i, j)];
      if (!is_held[static_cast<size_t>(i)]) {
        sum = mechanism.jacobian[static_cast<size_t>(j * n + i)];
        continue;
      }
      for (Index k = 0; k < n; ++k) sum += mechanism.mass_matrix[static_cast<size_t>(i * n + k)] * response[at(k, j)];
    }
  }
  return momentum;
}

ContactMotion::ContactMotion(const Mechanism& mechanism) {
  const size_t n = mechanism.rates.size();
  for (size_t i = 0; i < mechanism.jacobian.size() / n; ++i) {
    const CompensatedSum sum = CompensatedDot(&mechanism.jacobian[i * n], mechanism.rates.data(), n);
    velocity.push_back(sum.value);
    size.push_back(sum.size);
  }
}

MechanismErrors::MechanismErrors(const Mechanism& mechanism, const FreePart& part) : solved(part), motion(mechanism) {
  const InverseBounds inverse(solved.cholesky, part.mass.trace());
  const Index n = part.jt.rows();
  const Index directions = part.jt.cols();
  // Bounds on the norms of L^-1 R, with the residual's own error.
  const VectorXd energy = inverse.norm * (solved.residual.cwiseAbs() + solved.doubt).colwise().norm();
  const double noise = CompensatedNoise(2 * n);
  w.resize(directions, directions);
  velocity.resize(directions);
  for (Index i = 0; i < directions; ++i) {
    const auto at = static_cast<size_t>(i);
    velocity(i) = kUnit * std::fabs(motion.velocity[at]) +
                  CompensatedNoise(static_cast<Index>(mechanism.rates.size())) * motion.size[at];
    for (Index j = 0; j < directions; ++j) {
      w(i, j) = energy(i) * energy(j) +
                1.01 * solved.x.col(std::min(i, j)).cwiseAbs().dot(solved.doubt.col(std::max(i, j))) +
                kUnit * std::fabs(solved.w(i, j)) + noise * solved.w_size(i, j);
    }
  }
  response = MatrixXd::Zero(static_cast<Index>(mechanism.rates.size()), directions);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < directions; ++j) {
      response(part.coordinates[static_cast<size_t>(i)], j) = part.scales(i) * inverse.roots(i) * energy(j);
    }
  }
  // Outside this range a product may have underflowed.
  for (Index j = 0; j < directions; ++j) {
    if (AreModerate({part.jt.col(j).lpNorm<Eigen::Infinity>(), motion.size[static_cast<size_t>(j)]}, 0x1p300)) continue;
    w.setConstant(kInfinity);
    response.setConstant(kInfinity);
  }
}

}  // namespace ricochet
