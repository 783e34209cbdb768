#include "core/contact/reduction.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/match.h"
#include "core/contact/delassus.h"
#include "core/contact/finite_forces.h"
#include "core/contact/linkage_matrices.h"
#include "core/contact/mechanism.h"
#include "core/contact/planar_body_share.h"
#include "core/contact/symmetric_matrix.h"

namespace ricochet {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// An eigenvalue of a W that is scaled to a unit diagonal counts as 0 up to this size.
constexpr double kSingular = 16.0 * kEpsilon;

// --- Pendulums, linkages and mechanisms ---

// A bound on |det W|/(Wtt Wnn), or on an eigenvalue of W scaled to a unit diagonal, after rounding, if the exact one is
// 0.
template <size_t kTangential>
double RankNoise(const Reduction<kTangential>& reduction) {
  return 8.0 * static_cast<double>(reduction.before.size()) * kEpsilon;
}

// Gives a planar W rank one if its determinant may be rounding alone.
void SettleRank(PlanarReduction& reduction) {
  auto& [tt, tn, nn] = reduction.w;
  if (tt == 0.0 || nn == 0.0 || PlanarDelassus{tt, tn, nn}.RelativeDeterminant() > RankNoise(reduction)) return;
  tn = std::copysign(std::sqrt(tt) * std::sqrt(nn), tn);
}

// Moves the velocity into the range of a W of rank one if only rounding put it outside, as happens when all links point
// the same way. The root of the noise in det W/(Wtt Wnn) is the smallest angle between two directions that can be
// resolved (docs/theory/contact.md). A velocity further outside is real: it belongs to a link that is too heavy for the
// impulse to move. `sizes` are the sums of the magnitudes of the terms of u0 and v0.
void SettleVelocity(const Eigen::Vector2d& sizes, PlanarReduction& reduction) {
  const auto& [tt, tn, nn] = reduction.w;
  if (tt == 0.0 || nn == 0.0 || PlanarDelassus{tt, tn, nn}.Rank() == 2) return;
  // Divides by the larger entry, because a product of a velocity and an entry of W may underflow.
  const bool normal_leads = nn >= tt;
  const double leading = normal_leads ? reduction.v0 : reduction.u0[0];
  double& following = normal_leads ? reduction.u0[0] : reduction.v0;
  const double slope = tn / std::max(nn, tt);
  const double size = sizes[normal_leads ? 0 : 1] + std::abs(slope) * sizes[normal_leads ? 1 : 0];
  const double outside = std::fma(-slope, leading, following);
  if (std::abs(outside) <= std::sqrt(RankNoise(reduction)) * size) following = slope * leading;
}

PlanarReduction ReduceOne(const Pendulum& pendulum) {
  const double a = pendulum.a_m;
  const double b = pendulum.b_m;
  const double root = std::sqrt(pendulum.inertia_kg_m2);
  const double yt = b / root;
  const double yn = a / root;
  PlanarReduction reduction = {.w = {yt * yt, yt * yn, yn * yn},
                               .u0 = {b * pendulum.omega_minus_rad_s},
                               .v0 = a * pendulum.omega_minus_rad_s,
                               .coordinates = Coordinates::kRates,
                               .before = {pendulum.omega_minus_rad_s},
                               .response = {b / pendulum.inertia_kg_m2, a / pendulum.inertia_kg_m2}};
  SettleRank(reduction);
  return reduction;
}

void Settle(const Eigen::Vector2d& sizes, PlanarReduction& reduction) {
  SettleRank(reduction);
  SettleVelocity(sizes, reduction);
}

PlanarReduction ReduceOne(const Linkage& linkage) {
  const Eigen::VectorXd rates = RatesOf(linkage);
  const Eigen::MatrixXd jt = TransposedJacobian(linkage);
  const Eigen::LLT<Eigen::MatrixXd> cholesky(MassMatrix(linkage));
  const Eigen::MatrixXd y = cholesky.matrixL().solve(jt);
  const Eigen::MatrixXd response = cholesky.matrixU().solve(y);
  const Eigen::VectorXd velocity = jt.transpose() * rates;
  PlanarReduction reduction = {.w = {y.col(0).dot(y.col(0)), y.col(0).dot(y.col(1)), y.col(1).dot(y.col(1))},
                               .u0 = {velocity(0)},
                               .v0 = velocity(1),
                               .coordinates = Coordinates::kRates};
  reduction.before.assign(rates.begin(), rates.end());
  for (const auto& row : response.rowwise())
    reduction.response.insert(reduction.response.end(), row.begin(), row.end());
  Settle(jt.cwiseAbs().transpose() * rates.cwiseAbs(), reduction);
  return reduction;
}

// The entries of a W of this rank are rounded, so that Rank() may see more. Then all eigenvalues of the scaled W are
// lowered by the few eps that this takes.
void LowerRankTo(int rank, SpatialReduction& reduction) {
  for (double lowered = kEpsilon; SpatialDelassus{reduction.w}.Rank() > rank; lowered *= 2.0) {
    for (const size_t diagonal : {0u, 3u, 5u}) reduction.w[diagonal] *= 1.0 - lowered;
  }
}

// Settles the rank of a W in space, of which the eigenvalues after scaling are compared with the noise, and the
// velocity.
void Settle(const Eigen::Vector3d& sizes, SpatialReduction& reduction) {
  if (!IsFinite(reduction) || IsSurelyDefinite(reduction.w)) return;
  const Eigen::Matrix3d matrix = Symmetric(reduction.w.data());
  const Eigen::Vector3d scales = InverseScales(matrix);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scales.asDiagonal() * matrix * scales.asDiagonal());
  const double noise = RankNoise(reduction);
  Eigen::Vector3d velocity(reduction.u0[0], reduction.u0[1], reduction.v0);
  Eigen::Matrix3d settled = matrix;
  int rank = 3;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = solver.eigenvectors().col(i);
    const Eigen::Vector3d along = axis.cwiseProduct(scales.unaryExpr([](double x) { return x > 0.0 ? 1.0 / x : 0.0; }));
    if (solver.eigenvalues()(i) > noise) continue;
    --rank;
    if (along.isZero(0.0)) continue;  // A row of J that is 0 is exact.
    settled -= solver.eigenvalues()(i) * along * along.transpose();
    const double outside = axis.dot(scales.asDiagonal() * velocity);
    if (std::abs(outside) <= std::sqrt(noise) * (scales.asDiagonal() * sizes).stableNorm()) velocity -= outside * along;
  }
  reduction.w = {settled(0, 0), settled(0, 1), settled(0, 2), settled(1, 1), settled(1, 2), settled(2, 2)};
  reduction.u0 = {velocity(0), velocity(1)};
  reduction.v0 = velocity(2);
  LowerRankTo(std::max(rank, 1), reduction);
}

template <size_t kTangential>
AnyReduction ReduceMechanism(const Mechanism& mechanism) {
  const FreePart part(mechanism);
  const Response solved(part);
  const ContactMotion motion(mechanism);
  constexpr auto kDirections = static_cast<Eigen::Index>(kTangential + 1);
  const auto n = static_cast<Eigen::Index>(mechanism.rates.size());
  Reduction<kTangential> reduction;
  size_t k = 0;
  for (Eigen::Index i = 0; i < kDirections; ++i) {
    for (Eigen::Index j = i; j < kDirections; ++j) reduction.w[k++] = solved.w(i, j);
  }
  std::copy_n(motion.velocity.begin(), kTangential, reduction.u0.begin());
  reduction.v0 = motion.velocity[kTangential];
  reduction.coordinates = Coordinates::kAny;
  reduction.before.assign(mechanism.rates.begin(), mechanism.rates.end());
  reduction.response.resize(static_cast<size_t>(n * kDirections));
  for (Eigen::Index i = 0; i < part.jt.rows(); ++i) {
    double* const row =
        &reduction.response[static_cast<size_t>(part.coordinates[static_cast<size_t>(i)] * kDirections)];
    for (Eigen::Index j = 0; j < kDirections; ++j) row[j] = part.scales(i) * solved.x(i, j);
  }
  reduction.momentum = MomentumOf(mechanism, part.coordinates, reduction.response);
  Settle(Eigen::Map<const Eigen::Matrix<double, kDirections, 1>>(motion.size.data()), reduction);
  return reduction;
}

AnyReduction ReduceOne(const Mechanism& mechanism) {
  return TangentialDirections(mechanism) == 2 ? ReduceMechanism<2>(mechanism) : ReduceMechanism<1>(mechanism);
}

// --- Bodies. `side` is 1 for the body on which the impulses act, -1 for the one on which their opposites act. ---

void AddBody(const PlanarBody& body, double side, PlanarReduction& reduction) {
  const PlanarBodyShare share = ShareOf(body);
  reduction.w[0] += share.wtt;
  reduction.w[1] += share.wtn;
  reduction.w[2] += share.wnn;
  reduction.u0[0] += side * share.u0;
  reduction.v0 += side * share.v0;
  for (const double velocity : {body.velocity_t_m_s, body.velocity_n_m_s, body.rate_rad_s}) {
    reduction.before.push_back(velocity);
  }
  for (const double change : ResponseOf(body, side)) reduction.response.push_back(change);
}

Eigen::Vector3d ToEigen(const std::vector<double>& values) { return {values[0], values[1], values[2]}; }

// The matrix of the cross product r x.
Eigen::Matrix3d Cross(const Eigen::Vector3d& r) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -r(2), r(1), r(2), 0.0, -r(0), -r(1), r(0), 0.0;
  return matrix;
}

void AddBody(const SpatialBody& body, double side, SpatialReduction& reduction) {
  const Eigen::Vector3d r = ToEigen(body.offset_m);
  const Eigen::Vector3d linear = ToEigen(body.linear_m_s);
  const Eigen::Vector3d angular = ToEigen(body.angular_rad_s);
  const Eigen::LLT<Eigen::Matrix3d> cholesky(Symmetric(body.inertia_com_kg_m2.data()));
  const Eigen::Matrix3d y = cholesky.matrixL().solve(Cross(r));
  const Eigen::Matrix3d turn = cholesky.matrixU().solve(y);
  const double inverse_mass = 1.0 / body.mass_kg;
  size_t k = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) reduction.w[k++] += y.col(i).dot(y.col(j)) + (i == j ? inverse_mass : 0.0);
  }
  const Eigen::Vector3d velocity = linear + angular.cross(r);
  reduction.u0[0] += side * velocity(0);
  reduction.u0[1] += side * velocity(1);
  reduction.v0 += side * velocity(2);
  for (const Eigen::Vector3d& part : {linear, angular}) {
    reduction.before.insert(reduction.before.end(), part.data(), part.data() + 3);
  }
  const Eigen::Matrix3d move = inverse_mass * Eigen::Matrix3d::Identity();
  for (const Eigen::Matrix3d& part : {move, turn}) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) reduction.response.push_back(side * part(row, column));
    }
  }
}

PlanarReduction ReduceOne(const PlanarBody& body) {
  PlanarReduction reduction;
  reduction.coordinates = Coordinates::kBodies;
  AddBody(body, 1.0, reduction);
  SettleRank(reduction);
  return reduction;
}

SpatialReduction ReduceOne(const SpatialBody& body) {
  SpatialReduction reduction = {.coordinates = Coordinates::kBodies};
  AddBody(body, 1.0, reduction);
  return reduction;
}

AnyReduction ReduceOne(const BodyPair& pair) {
  if (const auto* spatial = std::get_if<SpatialPair>(&pair.bodies)) {
    SpatialReduction reduction = {.coordinates = Coordinates::kBodies};
    AddBody(spatial->body_1, 1.0, reduction);
    AddBody(spatial->body_2, -1.0, reduction);
    return reduction;
  }
  PlanarReduction reduction = {.coordinates = Coordinates::kBodies};
  if (const auto* planar = std::get_if<PlanarPair>(&pair.bodies)) {
    AddBody(planar->body_1, 1.0, reduction);
    AddBody(planar->body_2, -1.0, reduction);
    SettleRank(reduction);
  }
  return reduction;
}

// --- Contacts ---

PlanarReduction ReduceOne(const PlanarContact& contact) {
  return {.w = {contact.w_tt_per_kg, contact.w_tn_per_kg, contact.w_nn_per_kg},
          .u0 = {contact.tangential_m_s},
          .v0 = contact.normal_m_s};
}

SpatialReduction ReduceOne(const SpatialContact& contact) {
  SpatialReduction reduction = {.v0 = contact.normal_m_s};
  std::copy_n(contact.w_per_kg.begin(), reduction.w.size(), reduction.w.begin());
  std::copy_n(contact.tangential_m_s.begin(), reduction.u0.size(), reduction.u0.begin());
  return reduction;
}

PlanarReduction ReduceOne(std::monostate /*unset*/) { return {}; }

}  // namespace

template <size_t kTangential>
typename Reduction<kTangential>::Velocities Reduction<kTangential>::After(
    const std::array<double, kTangential>& tangential, double normal, double duration) const {
  Velocities after = before;
  for (size_t i = 0; i < drift.size(); ++i) after[i] += drift[i] * duration;
  const double* row = response.data();
  for (double& velocity : after) {
    double change = row[kTangential] * normal;
    for (size_t i = 0; i < kTangential; ++i) change += row[i] * tangential[i];
    velocity += change;
    row += kDirections;
  }
  return after;
}

template struct Reduction<1>;
template struct Reduction<2>;

AnyReduction Reduce(const Scene& scene) {
  AnyReduction reduction =
      std::visit([](const auto& system) -> AnyReduction { return ReduceOne(system); }, scene.system);
  if (auto* planar = std::get_if<PlanarReduction>(&reduction)) AddFiniteForces(scene, *planar);
  if (!scene.surface_velocity.has_value()) return reduction;
  std::visit(
      [&surface = *scene.surface_velocity](auto& reduced) {
        for (size_t i = 0; i < surface.tangential_m_s.size(); ++i) reduced.u0[i] -= surface.tangential_m_s[i];
        reduced.v0 -= surface.normal_m_s;
      },
      reduction);
  return reduction;
}

bool ReductionDependsOn(absl::string_view path) {
  constexpr std::array kOthers = {"friction.", "restitution.", "compliance."};
  return std::none_of(kOthers.begin(), kOthers.end(), [&](const char* part) { return absl::StartsWith(path, part); });
}

bool IsFinite(const AnyReduction& reduction) {
  return std::visit(
      [](const auto& reduced) {
        // A finite number times 0 is 0, and an infinity or a NaN times 0 is NaN.
        double zero = 0.0 * reduced.v0;
        for (const double w : reduced.w) zero += 0.0 * w;
        for (const double u : reduced.u0) zero += 0.0 * u;
        return zero == 0.0;
      },
      reduction);
}

bool FitsDoubles(const AnyReduction& reduction) {
  const auto may_bounce = [](const auto& reduced) {
    constexpr double kSmallestNormal = std::numeric_limits<double>::min();
    const double nn = reduced.w.back();
    return reduced.v0 >= 0.0 || (reduced.coordinates == Coordinates::kNone ? nn > 0.0 : nn >= kSmallestNormal);
  };
  return std::visit(may_bounce, reduction) && IsFinite(reduction);
}

double ApproachSpeed(const AnyReduction& reduction) {
  return std::visit([](const auto& reduced) { return std::max(0.0, -reduced.v0); }, reduction);
}

bool IsSurelyDefinite(absl::Span<const double> upper) {
  // The product of three such numbers is normal.
  const auto is_moderate = [](double size) { return size >= 0x1p-300 && size <= 0x1p300; };
  const double w11 = upper[0], w12 = upper[1], w13 = upper[2], w22 = upper[3], w23 = upper[4], w33 = upper[5];
  if (!is_moderate(w11) || !is_moderate(w22) || !is_moderate(w33) || !(w12 * w12 < w11 * w22)) return false;
  const double diagonal = w11 * w22 * w33;
  const double others = 2.0 * (w12 * w13 * w23) - w11 * (w23 * w23) - w22 * (w13 * w13) - w33 * (w12 * w12);
  return diagonal + others > 0x1p-10 * diagonal;
}

static double ContactEnergy(const SpatialReduction& reduction) {
  const Eigen::Matrix3d matrix = Symmetric(reduction.w.data());
  const Eigen::Vector3d scales = InverseScales(matrix);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scales.asDiagonal() * matrix * scales.asDiagonal());
  const Eigen::Vector3d velocity =
      scales.asDiagonal() * Eigen::Vector3d(reduction.u0[0], reduction.u0[1], reduction.v0);
  double energy = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (solver.eigenvalues()(i) <= kSingular) continue;
    const double along = solver.eigenvectors().col(i).dot(velocity);
    energy += 0.5 * along * along / solver.eigenvalues()(i);
  }
  return energy;
}

double ContactEnergy(const AnyReduction& any) {
  if (const auto* spatial = std::get_if<SpatialReduction>(&any); spatial != nullptr) return ContactEnergy(*spatial);
  const auto& planar = std::get<PlanarReduction>(any);
  const auto& [tt, tn, nn] = planar.w;
  return ContactEnergy(SpatialReduction{.w = {tt, 0.0, tn, 0.0, 0.0, nn}, .u0 = {planar.u0[0], 0.0}, .v0 = planar.v0});
}

double ShareOutsideRange(const SpatialReduction& reduction) {
  if (IsSurelyDefinite(reduction.w)) return 0.0;
  const Eigen::Matrix3d matrix = Symmetric(reduction.w.data());
  const Eigen::Vector3d scales = InverseScales(matrix);
  const Eigen::Vector3d velocity(reduction.u0[0], reduction.u0[1], reduction.v0);
  for (int i = 0; i < 3; ++i) {
    if (scales(i) == 0.0 && velocity(i) != 0.0) return 1.0;
  }
  const Eigen::Matrix3d scaled = scales.asDiagonal() * matrix * scales.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scaled);
  const Eigen::Vector3d scaled_velocity = scales.asDiagonal() * velocity;
  const double norm = scaled_velocity.stableNorm();
  if (!(norm > 0.0)) return 0.0;
  // Rounding of W turns the directions outside its range by up to this share over the least eigenvalue inside.
  double least = 1.0;
  for (int i = 2; i >= 0 && solver.eigenvalues()(i) > kSingular; --i) least = solver.eigenvalues()(i);
  const double turned = std::min(kSingular / std::min(least, 1.0), 0x1p-20);
  double share = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (solver.eigenvalues()(i) > kSingular) continue;
    const Eigen::Vector3d outside = solver.eigenvectors().col(i);
    share = std::max(share, std::abs(outside.dot(scaled_velocity)) / norm - turned);
  }
  return share;
}

bool VelocityIsInRange(const PlanarReduction& reduction) {
  const auto& [tt, tn, nn] = reduction.w;
  if (PlanarDelassus{tt, tn, nn}.Rank() == 2) return true;
  const double u = reduction.u0[0];
  const double v = reduction.v0;
  if (nn == 0.0 && v != 0.0) return false;
  return ProductsAgree(u, nn, v, tn, kRangeTolerance);
}

bool VelocityIsInRange(const SpatialReduction& reduction) { return ShareOutsideRange(reduction) <= 64.0 * kEpsilon; }

}  // namespace ricochet
