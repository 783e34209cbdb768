// The recipe of docs/your_robot.md for MuJoCo, on robots read from MJCF and URDF files.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "ricochet/eigen.h"
#include "ricochet/solver.h"
#include "tests/robots/rods.h"

namespace {

absl::StatusOr<ricochet::Mechanism> AtContact(const mjModel* model, mjData* data, int body, const mjtNum point[3],
                                              const Eigen::Matrix3d& axes) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Rows mass(model->nv, model->nv), jacobian(3, model->nv);
  mj_forward(model, data);
  mj_fullM(model, mass.data(), data->qM);
  mj_jac(model, data, jacobian.data(), nullptr, point, body);
  const Eigen::Map<const Eigen::VectorXd> rates(data->qvel, model->nv);
  return ricochet::MechanismFrom(mass, axes * jacobian, rates);
}

}  // namespace

namespace ricochet::robots {
namespace {

struct Delete {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};

struct Robot {
  explicit Robot(const std::string& file) {
    char error[1000] = "";
    model.reset(mj_loadXML((std::string(RICOCHET_SOURCE_DIR "/tests/data/robots/") + file).c_str(), nullptr, error,
                           sizeof error));
    EXPECT_NE(model, nullptr) << error;
    if (model != nullptr) data.reset(mj_makeData(model.get()));
  }
  // The point of the last body that lies `reach` from its origin.
  Mechanism Touch(const Eigen::Vector3d& reach, const Eigen::Matrix3d& axes) {
    mj_forward(model.get(), data.get());
    const int body = model->nbody - 1;
    const Eigen::Map<const Eigen::Vector3d> origin(data->xpos + 3 * body);
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> turn(data->xmat + 9 * body);
    const Eigen::Vector3d point = origin + turn * reach;
    return *AtContact(model.get(), data.get(), body, point.data(), axes);
  }
  std::unique_ptr<mjModel, Delete> model;
  std::unique_ptr<mjData, Delete> data;
};

// Rows t1 = x, t2 = y, n = z.
const Eigen::Matrix3d kFloor = Eigen::Matrix3d::Identity();

Scene With(const System& system, double friction, double newton) {
  return {.system = system, .friction = {.kinetic_coefficient = friction}, .restitution = NewtonCoefficient{newton}};
}
Outcome Solve(const Scene& scene) {
  const auto response = LocalSolver().Solve({.scene = scene});
  EXPECT_TRUE(response.ok()) << response.status();
  return response.ok() ? response->outcome : Outcome();
}

// Its own plane is one of three directions: the row of t2 is 0.
TEST(MujocoRecipe, DoublePendulumIsTheLinkageAndTheClosedForm) {
  Robot robot("double_pendulum.xml");
  const Joints joints;
  for (size_t i = 0; i < 2; ++i) {
    robot.data->qpos[i] = joints.angle[i];
    robot.data->qvel[i] = joints.rate[i];
  }
  const Mechanism mechanism = robot.Touch({0.0, 0.0, -0.6}, kFloor);
  const Outcome rough = Solve(With(mechanism, 0.3, 0.5));
  const Outcome linkage = Solve(With(Rods(joints), 0.3, 0.5));
  EXPECT_NEAR(rough.rates_after[0], linkage.rates_after_rad_s[0], 1e-9);
  EXPECT_NEAR(rough.rates_after[0] + rough.rates_after[1], linkage.rates_after_rad_s[1], 1e-9);
  EXPECT_NEAR(rough.impulse.normal_total_n_s, linkage.impulse.normal_total_n_s, 1e-9);
  const Outcome smooth = Solve(With(mechanism, 0.0, 0.5));
  const std::array<double, 2> exact = RatesAfterFrictionlessImpact(joints, 0.5);
  EXPECT_NEAR(smooth.rates_after[0], exact[0], 1e-12);
  EXPECT_NEAR(smooth.rates_after[1], exact[1], 1e-12);
}

class FloatingArm : public testing::TestWithParam<std::string> {
 protected:
  Robot robot_{GetParam()};
  Mechanism Touch() {
    robot_.data->qpos[7] = 0.3;
    robot_.data->qpos[8] = -0.5;
    const double rates[] = {0.3, -0.2, -1.0, 0.1, 0.2, -0.1, 0.0, 0.0};
    std::copy(std::begin(rates), std::end(rates), robot_.data->qvel);
    return robot_.Touch({0.25, 0.0, 0.0}, kFloor);
  }
};

TEST_P(FloatingArm, TakesTheImpulseAsItsMomentum) {
  const Outcome outcome = Solve(With(Touch(), 0.2, 0.5));
  ASSERT_EQ(outcome.rates_after.size(), 8U);
  EXPECT_NEAR(outcome.momentum_change[0], outcome.impulse.tangential_n_s[0], 1e-12);
  EXPECT_NEAR(outcome.momentum_change[1], outcome.impulse.tangential_n_s[1], 1e-12);
  EXPECT_NEAR(outcome.momentum_change[2], outcome.impulse.normal_total_n_s, 1e-12);
}

// The three rods as one body, by the theorem of parallel axes.
TEST_P(FloatingArm, IsOneRigidBodyWhereItsJointsHold) {
  Mechanism mechanism = Touch();
  mechanism.composite = true;
  const mjModel& model = *robot_.model;
  const mjData& data = *robot_.data;
  double mass = 0.0;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  for (int i = 1; i < model.nbody; ++i) {
    mass += model.body_mass[i];
    com += model.body_mass[i] * Eigen::Vector3d(data.xipos + 3 * i);
  }
  com /= mass;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (int i = 1; i < model.nbody; ++i) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> turn(data.ximat + 9 * i);
    const Eigen::Vector3d arm = Eigen::Vector3d(data.xipos + 3 * i) - com;
    inertia += turn * Eigen::Vector3d(model.body_inertia + 3 * i).asDiagonal() * turn.transpose();
    inertia += model.body_mass[i] * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  const int last = model.nbody - 1;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> turn(data.xmat + 9 * last);
  const Eigen::Vector3d tip = Eigen::Vector3d(data.xpos + 3 * last) + turn * Eigen::Vector3d(0.25, 0.0, 0.0);
  const Eigen::Vector3d origin(data.xpos + 3);
  const Eigen::Vector3d omega(0.1, 0.2, -0.1);  // The base is not turned, so that its axes are those of the world.
  const Eigen::Vector3d speed = Eigen::Vector3d(0.3, -0.2, -1.0) + omega.cross(com - origin);
  const auto list = [](const Eigen::Vector3d& x) { return std::vector<double>{x(0), x(1), x(2)}; };
  const SpatialBody body = {
      .mass_kg = mass,
      .inertia_com_kg_m2 = {inertia(0, 0), inertia(0, 1), inertia(0, 2), inertia(1, 1), inertia(1, 2), inertia(2, 2)},
      .offset_m = list(tip - com),
      .linear_m_s = list(speed),
      .angular_rad_s = list(omega)};
  const Outcome held = Solve(With(mechanism, 0.2, 0.5));
  const Outcome rigid = Solve(With(body, 0.2, 0.5));
  EXPECT_NEAR(held.impulse.normal_total_n_s, rigid.impulse.normal_total_n_s, 1e-9);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(held.rates_after[3 + i], rigid.bodies_after[0].angular_rad_s[i], 1e-9);
  EXPECT_EQ(held.rates_after[6], 0.0);
  // The joints pass on far more than nothing: the arm alone would give way.
  mechanism.composite = false;
  EXPECT_LT(Solve(With(mechanism, 0.2, 0.5)).impulse.normal_total_n_s, 0.8 * held.impulse.normal_total_n_s);
}

INSTANTIATE_TEST_SUITE_P(Files, FloatingArm, testing::Values("floating_arm.xml", "floating_arm.urdf"),
                         [](const auto& file) { return file.index == 0 ? "Mjcf" : "Urdf"; });

}  // namespace
}  // namespace ricochet::robots
