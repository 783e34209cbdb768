// Mechanisms against the systems that are special cases of them, and against closed forms.

#include "core/contact/mechanism.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <variant>
#include <vector>

#include "core/contact/delassus.h"
#include "core/contact/linkage_matrices.h"
#include "core/contact/reduction.h"
#include "ricochet/eigen.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

Mechanism MechanismOf(const Linkage& linkage) {
  Eigen::VectorXd rates(static_cast<Eigen::Index>(linkage.links.size()));
  std::transform(linkage.links.begin(), linkage.links.end(), rates.begin(),
                 [](const Link& link) { return link.rate_rad_s; });
  return *MechanismFrom(MassMatrix(linkage), TransposedJacobian(linkage).transpose(), rates);
}

// The rows of one body, which the impulses act on if `side` is 1.
void AddBody(const PlanarBody& body, double side, Eigen::Index at, Eigen::MatrixXd& mass, Eigen::MatrixXd& jacobian,
             Eigen::VectorXd& rates) {
  mass.diagonal().segment(at, 3) << body.mass_kg, body.mass_kg, body.inertia_com_kg_m2;
  jacobian.block(0, at, 2, 3) << side, 0.0, -side * body.offset_n_m, 0.0, side, side * body.offset_t_m;
  rates.segment(at, 3) << body.velocity_t_m_s, body.velocity_n_m_s, body.rate_rad_s;
}

Mechanism MechanismOf(const std::vector<PlanarBody>& bodies) {
  const auto n = static_cast<Eigen::Index>(3 * bodies.size());
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(2, n);
  Eigen::VectorXd rates(n);
  for (size_t i = 0; i < bodies.size(); ++i) {
    AddBody(bodies[i], i == 0 ? 1.0 : -1.0, static_cast<Eigen::Index>(3 * i), mass, jacobian, rates);
  }
  return *MechanismFrom(mass, jacobian, rates);
}

Mechanism MechanismOf(const SpatialBody& body) {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(6, 6);
  const std::vector<double>& i = body.inertia_com_kg_m2;
  mass.diagonal().head(3).setConstant(body.mass_kg);
  mass.bottomRightCorner(3, 3) << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
  const double x = body.offset_m[0], y = body.offset_m[1], z = body.offset_m[2];
  Eigen::MatrixXd jacobian(3, 6);
  jacobian << 1.0, 0.0, 0.0, 0.0, z, -y, 0.0, 1.0, 0.0, -z, 0.0, x, 0.0, 0.0, 1.0, y, -x, 0.0;
  Eigen::VectorXd rates(6);
  rates << body.linear_m_s[0], body.linear_m_s[1], body.linear_m_s[2], body.angular_rad_s[0], body.angular_rad_s[1],
      body.angular_rad_s[2];
  return *MechanismFrom(mass, jacobian, rates);
}

Outcome Solve(const System& system) { return LocalSolver().Solve({.scene = With(system)})->outcome; }

// Expects that both outcomes agree to `tolerance` of the largest velocity and impulse.
void ExpectSameImpact(const Outcome& mechanism, const Outcome& system, double tolerance) {
  EXPECT_EQ(mechanism.regime, system.regime);
  EXPECT_NEAR(mechanism.contact_velocity_after.normal_m_s, system.contact_velocity_after.normal_m_s, tolerance);
  const double impulse = std::fabs(system.impulse.normal_total_n_s);
  EXPECT_NEAR(mechanism.impulse.normal_total_n_s, system.impulse.normal_total_n_s, tolerance * impulse);
  for (size_t i = 0; i < system.impulse.tangential_n_s.size(); ++i) {
    EXPECT_NEAR(mechanism.impulse.tangential_n_s[i], system.impulse.tangential_n_s[i], tolerance * impulse);
  }
}

TEST(MechanismTest, IsTheSameChainAsALinkage) {
  for (size_t links = 1; links <= 64; ++links) {
    SCOPED_TRACE(links);
    Linkage chain = Chain(links);
    // These rates let all other chains approach, too.
    for (Link& link : chain.links) link.rate_rad_s = -1.0 - 0.01 * static_cast<double>(links);
    const Outcome outcome = Solve(MechanismOf(chain));
    const Outcome linkage = Solve(chain);
    ExpectSameImpact(outcome, linkage, 1e-11);
    for (size_t i = 0; i < links; ++i) {
      const double bound = outcome.errors.rates_after[i];
      EXPECT_NEAR(outcome.rates_after[i], linkage.rates_after_rad_s[i], 1e-11 * 64.0);
      EXPECT_LT(bound, 1e-10);
    }
  }
}

TEST(MechanismTest, IsTheSameAsABodyOrAPairInThePlane) {
  const PlanarBody other = {2.0, 0.2, 0.1, 0.3, 0.0, 0.5, 0.0};
  for (const auto& [mechanism, system] :
       {std::pair{MechanismOf(std::vector{Flat()}), System(Flat())},
        std::pair{MechanismOf(std::vector{Flat(), other}), System(BodyPair{PlanarPair{Flat(), other}})}}) {
    const Outcome outcome = Solve(mechanism);
    const Outcome expected = Solve(system);
    ExpectSameImpact(outcome, expected, 1e-14);
    for (size_t i = 0; i < expected.bodies_after.size(); ++i) {
      EXPECT_NEAR(outcome.rates_after[3 * i], expected.bodies_after[i].linear_m_s[0], 1e-14);
      EXPECT_NEAR(outcome.rates_after[3 * i + 1], expected.bodies_after[i].linear_m_s[1], 1e-14);
      EXPECT_NEAR(outcome.rates_after[3 * i + 2], expected.bodies_after[i].angular_rad_s[0], 1e-13);
    }
  }
}

TEST(MechanismTest, IsTheSameAsABodyInSpace) {
  const Outcome outcome = Solve(MechanismOf(Body()));
  const Outcome expected = Solve(Body());
  ExpectSameImpact(outcome, expected, 1e-11);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(outcome.rates_after[i], expected.bodies_after[0].linear_m_s[i], 1e-11);
    EXPECT_NEAR(outcome.rates_after[3 + i], expected.bodies_after[0].angular_rad_s[i], 1e-11);
  }
}

// The rows and columns of what is held may be struck by hand.
TEST(MechanismTest, HeldCoordinatesLeaveTheMatrices) {
  Mechanism held = Arm();
  held.kept_coordinates = {1};
  held.rates[1] = 0.0;
  const Mechanism struck = {
      .mass_matrix = {2.0, 0.1, 0.1, 0.5}, .jacobian = {0.9, -0.2, 0.7, 0.4}, .rates = {-1.0, -0.5}};
  const Outcome outcome = Solve(held);
  const Outcome expected = Solve(struck);
  EXPECT_DOUBLE_EQ(outcome.rates_after[0], expected.rates_after[0]);
  EXPECT_DOUBLE_EQ(outcome.rates_after[2], expected.rates_after[1]);
  EXPECT_EQ(outcome.rates_after[1], 0.0);
}

// The rates of what is held move the contact all the same.
TEST(MechanismTest, HeldCoordinatesKeepTheirRatesAndMoveTheContact) {
  Mechanism held = Arm();
  held.kept_coordinates = {1};
  const Outcome outcome = Solve(held);
  EXPECT_EQ(outcome.rates_after[1], held.rates[1]);
  double v = 0.0;
  for (size_t i = 0; i < 3; ++i) v += held.jacobian[3 + i] * outcome.rates_after[i];
  EXPECT_NEAR(v, outcome.contact_velocity_after.normal_m_s, 1e-15);
}

TEST(MechanismTest, MomentumTakenIsTheMassMatrixTimesTheChangeOfTheRates) {
  for (const std::vector<int32_t>& kept : {std::vector<int32_t>{}, {1}, {0, 2}}) {
    for (const bool in_space : {false, true}) {
      Mechanism arm = Arm(in_space);
      arm.kept_coordinates = kept;
      const Outcome outcome = Solve(arm);
      for (size_t i = 0; i < 3; ++i) {
        double momentum = 0.0;
        for (size_t k = 0; k < 3; ++k) momentum += arm.mass_matrix[3 * i + k] * (outcome.rates_after[k] - arm.rates[k]);
        EXPECT_NEAR(outcome.momentum_change[i], momentum, 1e-13);
      }
    }
  }
}

// A floating base with one joint: with the joint held it is one body of both masses.
TEST(MechanismTest, CompositeMovesAsOneRigidBody) {
  // Two bars on a line, the second pinned to the first at (l, 0) from its centre; theta_2 is relative.
  const double m = 1.0, inertia = 0.1, l = 0.5, c = 0.4;
  const double r = l + c;  // The second centre is so far from the first.
  const Eigen::MatrixXd mass{{2 * m, 0, 0, 0},
                             {0, 2 * m, m * r, m * c},
                             {0, m * r, 2 * inertia + m * r * r, inertia + m * c * r},
                             {0, m * c, inertia + m * c * r, inertia + m * c * c}};
  const double tip = r + 0.3;
  const Eigen::MatrixXd jacobian{{1, 0, 0, 0}, {0, 1, tip, tip - l}};
  const Eigen::VectorXd rates{{0.4, -1.0, 0.2, 0.0}};
  Mechanism arm = *MechanismFrom(mass, jacobian, rates);
  arm.composite = true;
  const double centre = r / 2.0;
  const PlanarBody both = {.mass_kg = 2 * m,
                           .inertia_com_kg_m2 = 2 * inertia + 2 * m * centre * centre,
                           .offset_t_m = tip - centre,
                           .velocity_t_m_s = 0.4,
                           .velocity_n_m_s = -1.0 + 0.2 * centre,
                           .rate_rad_s = 0.2};
  const Outcome outcome = Solve(arm);
  const Outcome body = Solve(both);
  ExpectSameImpact(outcome, body, 1e-13);
  EXPECT_NEAR(outcome.rates_after[2], body.bodies_after[0].angular_rad_s[0], 1e-13);
  EXPECT_EQ(outcome.rates_after[3], 0.0);
}

TEST(MechanismTest, BothEndsAreTheAnswersWithAndWithoutWhatIsHeld) {
  Mechanism arm = Arm();
  const Outcome free = Solve(arm);
  arm.kept_coordinates = {1, 2};
  const auto response = LocalSolver().Solve({.scene = With(arm), .both_ends = true});
  ASSERT_TRUE(response.ok()) << response.status();
  const Outcome& outcome = response->outcome;
  ASSERT_TRUE(outcome.free_end.has_value());
  EXPECT_EQ(outcome.free_end->rates_after, free.rates_after);
  EXPECT_EQ(outcome.free_end->impulse, free.impulse);
  EXPECT_EQ(outcome.free_end->coefficients, free.coefficients);
  EXPECT_EQ(outcome.rates_after, Solve(arm).rates_after);
  EXPECT_FALSE(LocalSolver().Solve({.scene = With(Arm()), .both_ends = true}).ok());
  EXPECT_FALSE(LocalSolver().Solve({.scene = With(Chain()), .both_ends = true}).ok());
}

// Two joints cannot move a contact along three directions.
TEST(MechanismTest, TwoJointsInSpaceHaveAWOfRankTwo) {
  const Mechanism two = {
      .mass_matrix = {1.3, 0.5, 0.5, 0.4}, .jacobian = {0.9, 0.2, -0.3, 0.8, 0.6, 0.5}, .rates = {-1.0, -0.5}};
  const Outcome outcome = Solve(two);
  EXPECT_EQ(outcome.w_rank, 2);
  EXPECT_EQ(outcome.termination, Termination::kConverged);
}

// The rank of W = J M^-1 J^T is at most that of J, and so at most the number of coordinates, however W is rounded.
TEST(MechanismTest, RankIsAtMostTheNumberOfCoordinatesThatMove) {
  std::mt19937_64 random(20260801);
  std::uniform_real_distribution<double> entry(-2.0, 2.0);
  std::uniform_real_distribution<double> exponent(-6.0, 6.0);
  for (int i = 0; i < 30000; ++i) {
    const Eigen::Index n = 1 + i % 3;
    const auto any = [&entry, &random] { return entry(random); };
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, any);
    const Eigen::MatrixXd mass = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::NullaryExpr(3, n, any);
    if (i % 2 == 1) jacobian.row(i % 3) *= std::exp2(exponent(random));
    Mechanism mechanism = *MechanismFrom(mass, jacobian, Eigen::VectorXd::NullaryExpr(n, any));
    if (n == 3) mechanism.kept_coordinates = {i % 5 % 3};
    const auto reduction = std::get<SpatialReduction>(Reduce(With(mechanism)));
    ASSERT_LE(SpatialDelassus{reduction.w}.Rank(), std::min<Eigen::Index>(n, 2)) << i;
    ASSERT_TRUE(VelocityIsInRange(reduction) || n == 3) << i;  // What is held moves as it likes.
  }
}

TEST(MechanismTest, ParallelRowsOfTheJacobianAreAnAnswer) {
  for (const bool in_space : {false, true}) {
    Mechanism arm = Arm(in_space);
    for (size_t i = 0; i < 3; ++i) arm.jacobian[i] = arm.jacobian[arm.jacobian.size() - 3 + i] / 3.0;
    const auto response = LocalSolver().Solve({.scene = With(arm)});
    ASSERT_TRUE(response.ok()) << response.status();
    EXPECT_EQ(response->outcome.w_rank, in_space ? 2 : 1);
  }
}

// Powers of two in the units of a coordinate change no digit.
TEST(MechanismTest, UnitsOfACoordinateDoNotMatter) {
  const Mechanism arm = Arm();
  Mechanism scaled = arm;
  constexpr double kUnit = 0x1p300;
  for (size_t i = 0; i < 3; ++i) {
    scaled.mass_matrix[3 * i] *= kUnit;
    scaled.mass_matrix[i] *= kUnit;
  }
  for (const size_t i : {0u, 3u}) scaled.jacobian[i] *= kUnit;
  scaled.rates[0] /= kUnit;
  const Outcome outcome = Solve(scaled);
  const Outcome expected = Solve(arm);
  EXPECT_EQ(outcome.impulse, expected.impulse);
  EXPECT_EQ(outcome.rates_after[0] * kUnit, expected.rates_after[0]);
  EXPECT_EQ(outcome.rates_after[1], expected.rates_after[1]);
}

// The second coordinate is too heavy for the impulse to move. W has rank one, and the velocity lies outside its range.
// In the units of the second case the product of W and a velocity underflows.
TEST(MechanismTest, VelocityOutsideTheRangeOfWStaysInAnyUnits) {
  for (const int exponent : {0, -500}) {
    SCOPED_TRACE(exponent);
    const double mass = std::ldexp(1.0, -7 * exponent / 5);
    const double rate = std::ldexp(1.0, exponent);
    const Mechanism heavy = {.mass_matrix = {mass, 0.0, 0.0, 0x1p130 * mass},
                             .jacobian = {1.0, 1.0, 0.75, -0.75},
                             .rates = {-rate, 0.25 * rate}};
    const auto reduction = std::get<PlanarReduction>(Reduce(With(heavy)));
    EXPECT_EQ(reduction.w, (std::array<double, 3>{1.0 / mass, 0.75 / mass, 0.5625 / mass}));
    EXPECT_EQ(reduction.u0[0], -0.75 * rate);
    EXPECT_EQ(reduction.v0, -0.9375 * rate);
  }
}

}  // namespace
}  // namespace ricochet
