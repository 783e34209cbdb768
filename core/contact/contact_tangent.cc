#include "core/contact/contact_tangent.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <variant>

#include "core/base/invariant.h"
#include "core/contact/linkage_matrices.h"
#include "core/contact/mechanism.h"
#include "core/numerics/elementary.h"

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// M, J^T and q' of a system, in all its coordinates, or their derivatives.
struct Motion {
  explicit Motion(Index n) : mass(MatrixXd::Zero(n, n)), jt(MatrixXd::Zero(n, 2)), rates(VectorXd::Zero(n)) {}

  MatrixXd mass, jt;
  VectorXd rates;
};

// `one` is 1 for a system and 0 for a direction, in which the entries of J that are always 1 do not change.
void SetBody(const PlanarBody& body, double side, double one, Index at, Motion& motion) {
  motion.mass.diagonal().segment<3>(at) << body.mass_kg, body.mass_kg, body.inertia_com_kg_m2;
  motion.jt.block<3, 2>(at, 0) << one, 0.0, 0.0, one, -body.offset_n_m, body.offset_t_m;
  motion.jt.block<3, 2>(at, 0) *= side;
  motion.rates.segment<3>(at) << body.velocity_t_m_s, body.velocity_n_m_s, body.rate_rad_s;
}

Motion MotionOf(const Pendulum& pendulum, double /*one*/) {
  Motion motion(1);
  motion.mass(0, 0) = pendulum.inertia_kg_m2;
  motion.jt << pendulum.b_m, pendulum.a_m;
  motion.rates(0) = pendulum.omega_minus_rad_s;
  return motion;
}

Motion MotionOf(const PlanarBody& body, double one) {
  Motion motion(3);
  SetBody(body, 1.0, one, 0, motion);
  return motion;
}

Motion MotionOf(const BodyPair& pair, double one) {
  Motion motion(6);
  const auto& planar = std::get<PlanarPair>(pair.bodies);
  SetBody(planar.body_1, 1.0, one, 0, motion);
  SetBody(planar.body_2, -1.0, one, 3, motion);
  return motion;
}

Motion MotionOf(const Mechanism& mechanism, double /*one*/) {
  const auto n = static_cast<Index>(mechanism.rates.size());
  Motion motion(n);
  motion.mass = Eigen::Map<const MatrixXd>(mechanism.mass_matrix.data(), n, n);
  motion.jt = Eigen::Map<const MatrixXd>(mechanism.jacobian.data(), n, 2);
  motion.rates = Eigen::Map<const VectorXd>(mechanism.rates.data(), n);
  return motion;
}

Motion MotionOf(const Linkage& linkage, double /*one*/) {
  Motion motion(static_cast<Index>(linkage.links.size()));
  motion.mass = MassMatrix(linkage);
  motion.jt = TransposedJacobian(linkage);
  motion.rates = RatesOf(linkage);
  return motion;
}

template <typename OtherSystem>
Motion MotionOf(const OtherSystem& /*system*/, double /*one*/) {
  CheckInvariant(false, "the motion of a contact is asked of a planar system of bodies");
  return Motion(0);
}

Motion MotionOf(const System& system) {
  return std::visit([](const auto& its_system) { return MotionOf(its_system, 1.0); }, system);
}

// Returns the derivatives of MotionOf(system) along a direction. Those of a linkage also depend on the linkage.
Motion MotionTangent(const System& system, const System& direction) {
  const auto* const linkage = std::get_if<Linkage>(&system);
  if (linkage == nullptr) {
    return std::visit([](const auto& its_direction) { return MotionOf(its_direction, 0.0); }, direction);
  }
  const auto& d = std::get<Linkage>(direction);
  Motion motion(static_cast<Index>(linkage->links.size()));
  motion.mass = MassMatrixTangent(*linkage, d);
  motion.jt = TransposedJacobianTangent(*linkage, d);
  motion.rates = RatesOf(d);
  return motion;
}

std::vector<Index> FreeCoordinatesOf(const System& system, Index n) {
  if (const auto* const mechanism = std::get_if<Mechanism>(&system)) return FreeCoordinates(*mechanism);
  std::vector<Index> all;
  for (Index i = 0; i < n; ++i) all.push_back(i);
  return all;
}

// --- Coefficients by speed ---

double FactorTangent(std::monostate /*unset*/, std::monostate /*unset*/, double /*speed*/, double /*d_speed*/) {
  return 0.0;
}

double FactorTangent(const PowerLaw& law, const PowerLaw& d, double speed, double d_speed) {
  const double power = Pow(speed, law.exponent);
  double d_power = 0.0;
  if (law.exponent != 0.0 && d_speed != 0.0) d_power += law.exponent * Pow(speed, law.exponent - 1.0) * d_speed;
  if (d.exponent != 0.0 && speed > 0.0) d_power += power * Log(speed) * d.exponent;
  return -(d.alpha * power + law.alpha * d_power);
}

double FactorTangent(const SpeedTable& table, const SpeedTable& d, double speed, double d_speed) {
  const auto& speeds = table.speed_m_s;
  auto above = static_cast<size_t>(std::upper_bound(speeds.begin(), speeds.end(), speed) - speeds.begin());
  // A speed that equals an entry of the table is taken on the side to which it moves relative to that entry.
  if (above > 0 && speeds[above - 1] == speed && d_speed < d.speed_m_s[above - 1]) --above;
  if (above == 0) return d.factor.front();
  if (above == speeds.size()) return d.factor.back();
  const double width = speeds[above] - speeds[above - 1];
  const double share = (speed - speeds[above - 1]) / width;
  const double d_width = d.speed_m_s[above] - d.speed_m_s[above - 1];
  const double d_share = (d_speed - d.speed_m_s[above - 1] - share * d_width) / width;
  return d.factor[above - 1] + share * (d.factor[above] - d.factor[above - 1]) +
         d_share * (table.factor[above] - table.factor[above - 1]);
}

double FactorTangent(const std::optional<SpeedDependence>& dependence, const std::optional<SpeedDependence>& direction,
                     double speed, double d_speed) {
  if (!dependence.has_value()) return 0.0;
  const auto tangent = [&]<typename Form>(const Form& form) {
    return FactorTangent(form, std::get<Form>(*direction), speed, d_speed);
  };
  return std::visit(tangent, *dependence);
}

bool Lists(const std::optional<SpeedDependence>& dependence, double speed) {
  const auto* const table = dependence.has_value() ? std::get_if<SpeedTable>(&*dependence) : nullptr;
  return table != nullptr && std::count(table->speed_m_s.begin(), table->speed_m_s.end(), speed) > 0;
}

double CoefficientOf(const Restitution& restitution) {
  const auto value = [](const auto& stated) {
    if constexpr (requires { stated.value; }) return stated.value;
    return 0.0;
  };
  return std::visit(value, restitution);
}

void SetCoefficients(const Scene& scene, const SceneContact& contact, const Scene& d, ContactTangent& tangent) {
  const double speed = ApproachSpeed(contact.reduction);
  // A contact that separates has the speed 0 and keeps it.
  const bool separates = std::get<PlanarReduction>(contact.reduction).v0 > 0.0;
  const double d_speed = speed > 0.0 ? -tangent.v0 : separates ? 0.0 : std::max(0.0, -tangent.v0);
  const double factor = FactorAt(scene.friction.by_speed, speed);
  const double d_factor = FactorTangent(scene.friction.by_speed, d.friction.by_speed, speed, d_speed);
  const Friction& friction = scene.friction;
  tangent.kinetic_friction = d.friction.kinetic_coefficient * factor + friction.kinetic_coefficient * d_factor;
  tangent.static_friction = tangent.kinetic_friction;
  if (friction.static_coefficient.has_value()) {
    tangent.static_friction = *d.friction.static_coefficient * factor + *friction.static_coefficient * d_factor;
  }
  tangent.restitution = CoefficientOf(d.restitution) * FactorAt(scene.restitution_by_speed, speed) +
                        CoefficientOf(scene.restitution) *
                            FactorTangent(scene.restitution_by_speed, d.restitution_by_speed, speed, d_speed);
  // The approach speed, which is never negative, changes linearly where it is positive.
  tangent.is_at_speed_of_table = Lists(scene.friction.by_speed, speed) || Lists(scene.restitution_by_speed, speed);
  tangent.is_linear = !DependsOnSpeed(scene) || (speed > 0.0 && !tangent.is_at_speed_of_table);
}

}  // namespace

struct ContactTangents::Bodies {
  Bodies(const System& system, bool w_is_rank_one)
      : motion(MotionOf(system)),
        free(FreeCoordinatesOf(system, motion.rates.size())),
        is_rank_one(w_is_rank_one),
        takes_momentum(std::holds_alternative<Mechanism>(system)) {
    if (free.empty()) return;
    cholesky.compute(motion.mass(free, free));
    response = cholesky.solve(motion.jt(free, Eigen::all));
  }

  // Sets what follows from the derivatives of M, J^T and q'.
  void SetTangent(const Motion& d, ContactTangent& tangent) const {
    const VectorXd d_velocity = d.jt.transpose() * motion.rates + motion.jt.transpose() * d.rates;
    tangent.u0 = d_velocity(0);
    tangent.v0 = d_velocity(1);
    tangent.before.assign(d.rates.begin(), d.rates.end());
    tangent.response.resize(static_cast<size_t>(2 * d.rates.size()));
    if (takes_momentum) tangent.momentum.resize(tangent.response.size());
    if (is_rank_one) tangent.keeps_rank_one = KeepsRowsParallel(d.jt);
    if (free.empty()) return;  // No impulse moves anything.
    const MatrixXd d_mass = d.mass(free, free);
    const MatrixXd d_jt = d.jt(free, Eigen::all);
    const MatrixXd& x = response;
    const MatrixXd d_x = cholesky.solve(d_jt - d_mass * x);
    const MatrixXd d_w = d_jt.transpose() * x + x.transpose() * d_jt - x.transpose() * d_mass * x;
    tangent.w = {d_w(0, 0), d_w(0, 1), d_w(1, 1)};
    for (size_t i = 0; i < free.size(); ++i) {
      for (Index j = 0; j < 2; ++j) {
        tangent.response[static_cast<size_t>(2 * free[i] + j)] = d_x(static_cast<Index>(i), j);
      }
    }
    if (takes_momentum) SetMomentum(d, d_x, tangent);
  }

  // A free coordinate has its row of J^T, one that is held has what the free ones pass on to it.
  void SetMomentum(const Motion& d, const MatrixXd& d_x, ContactTangent& tangent) const {
    MatrixXd momentum = d.mass(Eigen::all, free) * response + motion.mass(Eigen::all, free) * d_x;
    momentum(free, Eigen::all) = d.jt(free, Eigen::all);
    for (Index i = 0; i < momentum.rows(); ++i) {
      for (Index j = 0; j < 2; ++j) tangent.momentum[static_cast<size_t>(2 * i + j)] = momentum(i, j);
    }
  }

  // True if the rows of J are parallel in the free coordinates and stay so along a direction of J: all minors of
  // J + s dJ vanish for every s, to within rounding. M does not change the rank of J M^-1 J^T.
  bool KeepsRowsParallel(const MatrixXd& d_jt) const {
    const auto vanishes = [](double a, double b, double c, double d) {
      constexpr double kOfRounding = 0x1p-44;
      return std::fabs(a - b + c - d) <= kOfRounding * (std::fabs(a) + std::fabs(b) + std::fabs(c) + std::fabs(d));
    };
    const MatrixXd& jt = motion.jt;
    for (const Index i : free) {
      for (const Index k : free) {
        if (!vanishes(jt(i, 0) * jt(k, 1), jt(k, 0) * jt(i, 1), 0.0, 0.0) ||
            !vanishes(jt(i, 0) * d_jt(k, 1), jt(k, 0) * d_jt(i, 1), d_jt(i, 0) * jt(k, 1), d_jt(k, 0) * jt(i, 1)) ||
            !vanishes(d_jt(i, 0) * d_jt(k, 1), d_jt(k, 0) * d_jt(i, 1), 0.0, 0.0)) {
          return false;
        }
      }
    }
    return true;
  }

  Motion motion;
  std::vector<Index> free;
  bool is_rank_one;
  bool takes_momentum;
  // These belong to the free coordinates and are unset if there are none.
  Eigen::LLT<MatrixXd> cholesky;
  MatrixXd response;
};

ContactTangent operator-(ContactTangent tangent) {
  const auto reverse = [](double& number) { number = -number; };
  tangent.w = {-tangent.w.tt, -tangent.w.tn, -tangent.w.nn};
  for (double* const number :
       {&tangent.u0, &tangent.v0, &tangent.kinetic_friction, &tangent.static_friction, &tangent.restitution}) {
    reverse(*number);
  }
  std::for_each(tangent.before.begin(), tangent.before.end(), reverse);
  std::for_each(tangent.response.begin(), tangent.response.end(), reverse);
  std::for_each(tangent.momentum.begin(), tangent.momentum.end(), reverse);
  return tangent;
}

ContactTangents::ContactTangents(const Scene& scene, const SceneContact& contact) : scene_(scene), contact_(contact) {
  const auto& [tt, tn, nn] = std::get<PlanarReduction>(contact.reduction).w;
  is_rank_one_ = PlanarDelassus{tt, tn, nn}.Rank() == 1;
  if (!std::holds_alternative<PlanarContact>(scene.system)) {
    bodies_ = std::make_unique<const Bodies>(scene.system, is_rank_one_);
  }
}

ContactTangents::~ContactTangents() = default;

ContactTangent ContactTangents::Along(const Scene& direction) const {
  ContactTangent tangent;
  if (bodies_ != nullptr) {
    bodies_->SetTangent(MotionTangent(scene_.system, direction.system), tangent);
  } else {
    const auto& d = std::get<PlanarContact>(direction.system);
    tangent.w = {d.w_tt_per_kg, d.w_tn_per_kg, d.w_nn_per_kg};
    // The determinant of W + s dW is 0 for every s.
    const auto& [tt, tn, nn] = std::get<PlanarReduction>(contact_.reduction).w;
    tangent.keeps_rank_one = is_rank_one_ && tangent.w.tt * nn + tt * tangent.w.nn == 2.0 * tn * tangent.w.tn &&
                             tangent.w.tt * tangent.w.nn == tangent.w.tn * tangent.w.tn;
    tangent.u0 = d.tangential_m_s;
    tangent.v0 = d.normal_m_s;
  }
  if (scene_.surface_velocity.has_value()) {
    const SurfaceVelocity& d = *direction.surface_velocity;
    if (!d.tangential_m_s.empty()) tangent.u0 -= d.tangential_m_s[0];
    tangent.v0 -= d.normal_m_s;
  }
  SetCoefficients(scene_, contact_, direction, tangent);
  return tangent;
}

}  // namespace ricochet
