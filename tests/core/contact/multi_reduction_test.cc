// The W of bodies that touch at several points, against that of their single contacts and against J M^-1 J^T.

#include "core/contact/multi_reduction.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>

#include "core/contact/reduction.h"
#include "core/contact/symmetric_matrix.h"
#include "tests/support/scenes/multi_contact_scenes.h"

namespace ricochet {
namespace {

// The block of theory: W per foot [[17/5, -+6/5], [., 8/5]], across [[17/5, 6/5], [-6/5, 2/5]].
TEST(MultiReductionTest, TheBlockOnTwoFeetHasItsKnownMatrix) {
  const MultiReduction reduction = Reduce(FallingBlock(0.5, 0.5));
  Eigen::MatrixXd expected(4, 4);
  expected << 3.4, -1.2, 3.4, 1.2, -1.2, 1.6, -1.2, 0.4, 3.4, -1.2, 3.4, 1.2, 1.2, 0.4, 1.2, 1.6;
  EXPECT_LE((reduction.w - expected).cwiseAbs().maxCoeff(), 1e-15);
  const Eigen::VectorXd v = reduction.ContactVelocity(reduction.velocity);
  EXPECT_EQ(v, (Eigen::VectorXd(4) << 0, -1, 0, -1).finished());
}

// In space, with two bodies whose axes lie anywhere.
TEST(MultiReductionTest, IsJTimesTheInverseMassTimesJ) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int scene_number = 0; scene_number < 50; ++scene_number) {
    FreeBodies free;
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(12, 12);
    for (int body = 0; body < 2; ++body) {
      Eigen::Matrix3d a;
      for (double& entry : a.reshaped()) entry = number(random);
      // Inertia of points: trace(C) - C with a positive definite C.
      const Eigen::Matrix3d c = a * a.transpose() + 0.1 * Eigen::Matrix3d::Identity();
      const Eigen::Matrix3d i = c.trace() * Eigen::Matrix3d::Identity() - c;
      const double m = 1.5 + number(random);
      free.bodies.push_back({.mass_kg = m,
                             .inertia_com_kg_m2 = {i(0, 0), i(0, 1), i(0, 2), i(1, 1), i(1, 2), i(2, 2)},
                             .position_m = {number(random), number(random), number(random)},
                             .linear_m_s = {number(random), number(random), number(random)},
                             .angular_rad_s = {number(random), number(random), number(random)}});
      mass.block(6 * body, 6 * body, 3, 3) = m * Eigen::Matrix3d::Identity();
      mass.block(6 * body + 3, 6 * body + 3, 3, 3) = i;
    }
    MultiContactScene scene;
    scene.system = free;
    for (int contact = 0; contact < 3; ++contact) {
      scene.contacts.push_back({.energetic = 0.5,
                                .body = 1 + contact % 2,
                                .other_body = contact == 0 ? 2 : 0,
                                .point_m = {number(random), number(random), number(random)},
                                .normal = {number(random), number(random), number(random)}});
    }
    const MultiReduction reduction = Reduce(scene);
    const Eigen::MatrixXd response = mass.llt().solve(reduction.jacobian.transpose());
    EXPECT_LE((reduction.response - response).norm(), 1e-12 * response.norm());
    EXPECT_LE((reduction.w - reduction.jacobian * response).norm(), 1e-12 * reduction.w.norm());
    EXPECT_EQ(reduction.w, reduction.w.transpose());
    EXPECT_GE(SmallestScaledEigenvalue(reduction.w), -1e-14);
  }
}

TEST(MultiReductionTest, OneContactIsThatOfThePair) {
  const SpatialBody body = {.mass_kg = 2.0,
                            .inertia_com_kg_m2 = {0.3, 0.02, -0.03, 0.4, 0.01, 0.5},
                            .offset_m = {0.1, -0.2, -0.3},
                            .linear_m_s = {0.7, -0.1, -1.1},
                            .angular_rad_s = {0.3, 0.2, -0.9}};
  const auto single = std::get<SpatialReduction>(Reduce(Scene{.system = body}));
  MultiContactScene scene;
  scene.system = FreeBodies{.bodies = {{.mass_kg = body.mass_kg,
                                        .inertia_com_kg_m2 = body.inertia_com_kg_m2,
                                        .position_m = {1.0, 2.0, 3.0},
                                        .linear_m_s = body.linear_m_s,
                                        .angular_rad_s = body.angular_rad_s}}};
  scene.contacts = {{.energetic = 0.5, .body = 1, .point_m = {1.1, 1.8, 2.7}, .normal = {0.0, 0.0, 2.0}}};
  const MultiReduction reduction = Reduce(scene);
  size_t k = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) EXPECT_NEAR(reduction.w(i, j), single.w[k++], 1e-14);
  }
  EXPECT_NEAR(reduction.ContactVelocity(reduction.velocity)(2), single.v0, 1e-15);
}

TEST(MultiReductionTest, DirectionsOfAContactAreARightHandedFrame) {
  const Eigen::MatrixXd plane = ContactDirections(MultiContactPoint{.normal = {0.0, 3.0}});
  EXPECT_EQ(plane, Eigen::MatrixXd::Identity(2, 2));
  for (const std::vector<double>& normal : {std::vector<double>{0, 0, 2}, {1, 0, 0}, {-0.3, 0.5, 0.1}}) {
    const Eigen::MatrixXd frame = ContactDirections(MultiContactPoint{.normal = normal});
    EXPECT_LE((frame * frame.transpose() - Eigen::MatrixXd::Identity(3, 3)).norm(), 1e-15);
    EXPECT_NEAR(frame.determinant(), 1.0, 1e-15);
  }
}

}  // namespace
}  // namespace ricochet
