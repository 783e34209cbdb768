#include "client/cli/conformance/cone_distance.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <optional>
#include <vector>

namespace ricochet::cli {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Columns that are combinations of the others to this share are taken for dependent.
constexpr double kDependent = 3e-7;

// Returns the x that makes |a x - b| least; nothing if the columns of a depend on each other.
std::optional<VectorXd> LeastSquares(const MatrixXd& a, const VectorXd& b) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(a.rows(), a.cols());
  qr.setThreshold(kDependent).compute(a);
  return qr.rank() == a.cols() ? std::optional<VectorXd>(qr.solve(b)) : std::nullopt;
}

// Returns the tangential directions, as columns, of the edges of a pyramid inside a friction cone. In space one of them
// is that of the impulse by which the effects cause the change, if there is one.
MatrixXd Edges(int dimension, const MatrixXd& effects, const VectorXd& change) {
  if (dimension == 2) return Eigen::RowVector2d(1.0, -1.0);
  const std::optional<VectorXd> impulse = LeastSquares(effects, change);
  Eigen::Vector2d along(1.0, 0.0);
  if (impulse.has_value() && !impulse->head<2>().isZero(0.0)) along = impulse->head<2>().normalized();
  const Eigen::Vector2d across(-along(1), along(0));
  MatrixXd edges(2, 4);
  edges << along, -along, across, -across;
  return edges;
}

// Returns the impulses along the edges of all cones, as columns. A cone without friction has one edge.
MatrixXd EdgeImpulses(const ConformanceCase& one, const MatrixXd& edges) {
  std::vector<VectorXd> impulses;
  for (Eigen::Index contact = 0; contact < one.friction.size(); ++contact) {
    for (Eigen::Index i = 0; i < (one.friction(contact) == 0.0 ? 1 : edges.cols()); ++i) {
      VectorXd& impulse = impulses.emplace_back(VectorXd::Zero(one.jacobian.rows()));
      impulse.segment(contact * one.dimension, one.dimension) << one.friction(contact) * edges.col(i), 1.0;
    }
  }
  MatrixXd columns(one.jacobian.rows(), impulses.size());
  for (size_t i = 0; i < impulses.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = impulses[i];
  return columns;
}

}  // namespace

VectorXd OutsideCones(const ConformanceCase& one, const VectorXd& change) {
  // With M = L L^T, the square of L^T v is twice the kinetic energy of v, and an impulse p causes L^T v = L^-1 J^T p.
  const Eigen::LLT<MatrixXd> cholesky(one.mass);
  const VectorXd all = cholesky.matrixU() * change;
  const MatrixXd effects = cholesky.matrixL().solve(one.jacobian.transpose());
  const MatrixXd edges = effects * EdgeImpulses(one, Edges(one.dimension, effects, all));
  VectorXd least = all;
  // The nearest impulse lies on a face of the cones: on the edges of one subset.
  for (size_t subset = 1; subset < size_t{1} << edges.cols(); ++subset) {
    std::vector<Eigen::Index> chosen;
    for (Eigen::Index i = 0; i < edges.cols(); ++i) {
      if ((subset >> i & 1) != 0) chosen.push_back(i);
    }
    const MatrixXd face = edges(Eigen::all, chosen);
    const std::optional<VectorXd> shares = LeastSquares(face, all);
    if (!shares.has_value() || shares->minCoeff() < 0.0) continue;
    const VectorXd left = all - face * *shares;
    if (left.squaredNorm() < least.squaredNorm()) least = left;
  }
  return cholesky.matrixU().solve(least);
}

}  // namespace ricochet::cli
