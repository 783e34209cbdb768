#include "core/contact/multi_reduction.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "core/contact/mechanism.h"
#include "core/contact/symmetric_matrix.h"

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The arm of a direction about a centre of mass: one number in a plane, three in space.
Eigen::VectorXd Arm(const Eigen::VectorXd& r, const Eigen::VectorXd& direction) {
  if (r.size() == 2) return Eigen::VectorXd::Constant(1, r(0) * direction(1) - r(1) * direction(0));
  return Eigen::Vector3d(r).cross(Eigen::Vector3d(direction));
}

Eigen::VectorXd ToEigen(const std::vector<double>& values, Eigen::Index size) {
  if (values.empty()) return Eigen::VectorXd::Zero(size);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), size);
}

Eigen::MatrixXd InertiaOf(const FreeBody& body) {
  const std::vector<double>& i = body.inertia_com_kg_m2;
  if (i.size() == 1) return Eigen::MatrixXd::Constant(1, 1, i[0]);
  return Symmetric(i.data());
}

// The share of one of its two bodies in a contact: the body's number, +1 if its impulses act on it and -1 if their
// opposites do, and for each direction L^-1 times the arm, with the inertia L L^T.
struct Share {
  int body;
  double side, per_mass;
  std::vector<Eigen::VectorXd> scaled_arms;
};

struct BodyContact {
  Eigen::MatrixXd directions;
  std::vector<Share> shares;
};

// The block of W for two contacts, to which each body adds that both have.
Eigen::MatrixXd BlockOf(const BodyContact& one, const BodyContact& other) {
  const Eigen::Index space = one.directions.rows();
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(space, space);
  for (const Share& share : one.shares) {
    for (const Share& its : other.shares) {
      if (share.body != its.body) continue;
      const double side = share.side * its.side;
      for (Eigen::Index a = 0; a < space; ++a) {
        for (Eigen::Index b = 0; b < space; ++b) {
          const double along = one.directions.row(a).dot(other.directions.row(b));
          const double turning = share.scaled_arms[static_cast<size_t>(a)].dot(its.scaled_arms[static_cast<size_t>(b)]);
          block(a, b) += side * (share.per_mass * along + turning);
        }
      }
    }
  }
  return block;
}

MultiReduction ReduceBodies(const std::vector<FreeBody>& bodies, const std::vector<MultiContactPoint>& contacts) {
  const auto space = static_cast<Eigen::Index>(bodies.front().position_m.size());
  const Eigen::Index turns = space == 2 ? 1 : 3;
  const Eigen::Index coordinates = space + turns;
  const auto n = coordinates * static_cast<Eigen::Index>(bodies.size());
  const Eigen::Index rows = space * static_cast<Eigen::Index>(contacts.size());
  MultiReduction reduction = {.w = Eigen::MatrixXd::Zero(rows, rows),
                              .jacobian = Eigen::MatrixXd::Zero(rows, n),
                              .response = Eigen::MatrixXd::Zero(n, rows),
                              .mobility = Eigen::VectorXd(n),
                              .velocity = Eigen::VectorXd(n)};
  std::vector<Eigen::LLT<Eigen::MatrixXd>> inertias;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const auto at = coordinates * static_cast<Eigen::Index>(b);
    inertias.emplace_back(InertiaOf(bodies[b]));
    reduction.velocity.segment(at, space) = ToEigen(bodies[b].linear_m_s, space);
    reduction.velocity.segment(at + space, turns) = ToEigen(bodies[b].angular_rad_s, turns);
    reduction.mobility.segment(at, space).setConstant(1.0 / bodies[b].mass_kg);
    reduction.mobility.segment(at + space, turns) =
        inertias[b].solve(Eigen::MatrixXd::Identity(turns, turns)).diagonal();
  }
  std::vector<BodyContact> touching;
  for (size_t c = 0; c < contacts.size(); ++c) {
    const MultiContactPoint& contact = contacts[c];
    BodyContact& own = touching.emplace_back(BodyContact{.directions = ContactDirections(contact), .shares = {}});
    for (const auto& [number, side] : {std::pair(contact.body, 1.0), std::pair(contact.other_body, -1.0)}) {
      if (number == 0) continue;
      const auto b = static_cast<size_t>(number - 1);
      const auto at = coordinates * static_cast<Eigen::Index>(b);
      const double per_mass = 1.0 / bodies[b].mass_kg;
      Share& share = own.shares.emplace_back(Share{number, side, per_mass, {}});
      const Eigen::VectorXd r = ToEigen(contact.point_m, space) - ToEigen(bodies[b].position_m, space);
      for (Eigen::Index a = 0; a < space; ++a) {
        const Eigen::Index row = space * static_cast<Eigen::Index>(c) + a;
        const Eigen::VectorXd direction = own.directions.row(a);
        const Eigen::VectorXd arm = Arm(r, direction);
        share.scaled_arms.emplace_back(inertias[b].matrixL().solve(arm));
        reduction.jacobian.row(row).segment(at, space) = side * direction;
        reduction.jacobian.row(row).segment(at + space, turns) = side * arm;
        reduction.response.col(row).segment(at, space) = (side / bodies[b].mass_kg) * direction;
        reduction.response.col(row).segment(at + space, turns) = side * inertias[b].solve(arm);
      }
    }
  }
  for (size_t i = 0; i < contacts.size(); ++i) {
    for (size_t j = 0; j < contacts.size(); ++j) {
      reduction.w.block(space * static_cast<Eigen::Index>(i), space * static_cast<Eigen::Index>(j), space, space) =
          BlockOf(touching[i], touching[j]);
    }
  }
  return reduction;
}

MultiReduction ReduceMatrix(const ContactMatrix& matrix) {
  const auto rows = static_cast<Eigen::Index>(matrix.velocity_m_s.size());
  const Eigen::Map<const Eigen::MatrixXd> w(matrix.w_per_kg.data(), rows, rows);
  const Eigen::MatrixXd symmetric = 0.5 * w + 0.5 * w.transpose();
  return {.w = symmetric,
          .jacobian = Eigen::MatrixXd::Identity(rows, rows),
          .response = symmetric,
          .mobility = symmetric.diagonal(),
          .velocity = ToEigen(matrix.velocity_m_s, rows)};
}

MultiReduction ReduceMechanism(const Mechanism& mechanism, int directions) {
  const FreePart part(mechanism, directions == 3);
  const Response solved(part);
  const auto n = static_cast<Eigen::Index>(mechanism.rates.size());
  const Eigen::Index rows = part.jt.cols();
  MultiReduction reduction = {
      .w = solved.w,
      .jacobian = Eigen::Map<const Eigen::MatrixXd>(mechanism.jacobian.data(), n, rows).transpose(),
      .response = Eigen::MatrixXd::Zero(n, rows),
      .mobility = Eigen::VectorXd::Zero(n),
      .velocity = ToEigen(mechanism.rates, n)};
  const auto count = static_cast<Eigen::Index>(part.coordinates.size());
  const Eigen::VectorXd inverse = solved.cholesky.solve(Eigen::MatrixXd::Identity(count, count)).diagonal();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index coordinate = part.coordinates[static_cast<size_t>(i)];
    reduction.response.row(coordinate) = part.scales(i) * solved.x.row(i);
    reduction.mobility(coordinate) = part.scales(i) * part.scales(i) * inverse(i);
  }
  return reduction;
}

}  // namespace

Eigen::VectorXd MultiReduction::ContactVelocity(const Eigen::VectorXd& velocities) const {
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  const Eigen::VectorXd sum = jacobian * velocities;
  const Eigen::VectorXd size = jacobian.cwiseAbs() * velocities.cwiseAbs();
  return (sum.array().abs() <= kRounding * size.array()).select(0.0, sum);
}

Eigen::MatrixXd ContactDirections(const MultiContactPoint& contact) {
  const Eigen::VectorXd normal = ToEigen(contact.normal, static_cast<Eigen::Index>(contact.normal.size()));
  const Eigen::VectorXd n = normal / normal.stableNorm();
  Eigen::MatrixXd directions(n.size(), n.size());
  if (n.size() == 2) {
    directions << n(1), -n(0), n(0), n(1);
    return directions;
  }
  const Eigen::Vector3d normal_3 = n;
  const Eigen::Vector3d axis = std::abs(normal_3(0)) > 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d t1 = (axis - axis.dot(normal_3) * normal_3).normalized();
  directions.row(0) = t1;
  directions.row(1) = normal_3.cross(t1);
  directions.row(2) = normal_3;
  return directions;
}

MultiReduction Reduce(const MultiContactScene& scene) {
  struct Reducer {
    const MultiContactScene& scene;
    MultiReduction operator()(std::monostate) const { return {}; }
    MultiReduction operator()(const ContactMatrix& matrix) const { return ReduceMatrix(matrix); }
    MultiReduction operator()(const FreeBodies& free) const { return ReduceBodies(free.bodies, scene.contacts); }
    MultiReduction operator()(const Mechanism& mechanism) const {
      return ReduceMechanism(mechanism, DirectionsOf(scene));
    }
  };
  MultiReduction reduction = std::visit(Reducer{scene}, scene.system);
  reduction.directions = DirectionsOf(scene);
  return reduction;
}

double DistanceFromRange(const Eigen::MatrixXd& w, const Eigen::VectorXd& v, const Eigen::VectorXd& sizes) {
  const Eigen::VectorXd scales = InverseScales(w);
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (scales(i) == 0.0 && v(i) != 0.0) return kInfinity;
  }
  const Eigen::MatrixXd scaled = scales.asDiagonal() * w * scales.asDiagonal();
  // Products with the smallest doubles would vanish.
  const double largest = sizes.size() > 0 ? sizes.maxCoeff() : 0.0;
  const int exponent = largest > 0.0 ? -std::ilogb(largest) : 0;
  const auto raised = [exponent](double number) { return std::scalbn(number, exponent); };
  const Eigen::VectorXd x = scales.asDiagonal() * v.unaryExpr(raised);
  const double norm = (scales.asDiagonal() * sizes.unaryExpr(raised)).stableNorm();
  if (norm == 0.0) return 0.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  Eigen::VectorXd outside = Eigen::VectorXd::Zero(v.size());
  const double least = LeastEigenvalue(static_cast<size_t>(v.size()));
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (solver.eigenvalues()(i) > least) continue;
    outside += solver.eigenvectors().col(i) * solver.eigenvectors().col(i).dot(x);
  }
  return outside.cwiseAbs().maxCoeff() / norm;
}

}  // namespace ricochet
