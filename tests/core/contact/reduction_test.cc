// The reduction of systems to contacts: W, the contact velocity and the velocities after an impulse, worked by hand.

#include "core/contact/reduction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "core/contact/delassus.h"
#include "core/numerics/products.h"

namespace ricochet {
namespace {

using testing::DoubleEq;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pointwise;

constexpr double kPi = 3.141592653589793;

PlanarReduction Planar(const System& system) { return std::get<PlanarReduction>(Reduce({.system = system})); }
SpatialReduction Spatial(const System& system) { return std::get<SpatialReduction>(Reduce({.system = system})); }

// A uniform rod of 1 kg and 1 m that leans by 45 degrees and strikes with its lower right end.
PlanarBody Rod() {
  const double half = 0.5 * std::sqrt(0.5);
  return {.mass_kg = 1.0,
          .inertia_com_kg_m2 = 1.0 / 12.0,
          .offset_t_m = half,
          .offset_n_m = -half,
          .velocity_t_m_s = -1.0,
          .velocity_n_m_s = -1.0};
}

TEST(ReductionTest, RodAtFortyFiveDegreesByHand) {
  const PlanarReduction reduction = Planar(Rod());
  EXPECT_THAT(reduction.w, ElementsAre(DoubleEq(2.5), DoubleEq(1.5), DoubleEq(2.5)));
  EXPECT_EQ(reduction.u0[0], -1.0);
  EXPECT_EQ(reduction.v0, -1.0);
}

// tt = 1/m + r^2/I = (1 + 2)/m for a uniform disk.
TEST(ReductionTest, DiskByHandDoesNotCouple) {
  const double radius = 0.3;
  const double mass = 2.0;
  const PlanarReduction reduction = Planar(PlanarBody{.mass_kg = mass,
                                                      .inertia_com_kg_m2 = 0.5 * mass * radius * radius,
                                                      .offset_n_m = -radius,
                                                      .velocity_t_m_s = 1.0,
                                                      .velocity_n_m_s = -2.0,
                                                      .rate_rad_s = 5.0});
  EXPECT_THAT(reduction.w, ElementsAre(DoubleEq(3.0 / mass), 0.0, DoubleEq(1.0 / mass)));
  EXPECT_DOUBLE_EQ(reduction.u0[0], 1.0 + 5.0 * radius);
  EXPECT_EQ(reduction.v0, -2.0);
  const auto after = reduction.After({2.0}, 4.0);
  EXPECT_THAT(after, ElementsAre(DoubleEq(1.0 + 1.0), DoubleEq(-2.0 + 2.0),
                                 DoubleEq(5.0 + radius * 2.0 / (0.5 * mass * radius * radius))));
}

TEST(ReductionTest, PendulumIsOfRankOneWithItsVelocityInTheRange) {
  const PlanarReduction reduction =
      Planar(Pendulum{.inertia_kg_m2 = 2.0, .a_m = 0.3, .b_m = -1.1, .omega_minus_rad_s = -3.0});
  EXPECT_THAT(reduction.w, ElementsAre(DoubleEq(1.1 * 1.1 / 2.0), DoubleEq(-0.3 * 1.1 / 2.0), DoubleEq(0.09 / 2.0)));
  EXPECT_LE(std::abs(RelativeDeterminant(reduction.w[0], reduction.w[1], reduction.w[2])), 4 * 0x1p-52);
  EXPECT_EQ(reduction.u0[0], -1.1 * -3.0);
  EXPECT_EQ(reduction.v0, 0.3 * -3.0);
  EXPECT_THAT(reduction.After({0.0}, 2.0), ElementsAre(DoubleEq(-3.0 + 0.3)));
}

// One link is a pendulum: J0 = I + m c^2, a = l sin(theta), b = l cos(theta).
TEST(ReductionTest, OneLinkIsAPendulum) {
  const Link link = {
      .length_m = 2.0, .mass_kg = 3.0, .com_m = 0.7, .inertia_com_kg_m2 = 0.4, .theta_rad = 0.6, .rate_rad_s = -1.5};
  const PlanarReduction chain = Planar(Linkage{{link}});
  const PlanarReduction pendulum = Planar(Pendulum{.inertia_kg_m2 = 0.4 + 3.0 * 0.7 * 0.7,
                                                   .a_m = 2.0 * std::sin(0.6),
                                                   .b_m = 2.0 * std::cos(0.6),
                                                   .omega_minus_rad_s = -1.5});
  EXPECT_THAT(chain.w, Pointwise(DoubleNear(1e-15), pendulum.w));
  EXPECT_NEAR(chain.u0[0], pendulum.u0[0], 1e-15);
  EXPECT_NEAR(chain.v0, pendulum.v0, 1e-15);
  EXPECT_THAT(chain.response, Pointwise(DoubleNear(1e-15), pendulum.response));
}

// Two uniform rods of 1 kg and 1 m, both at 90 degrees: M = [4/3, 1/2; 1/2, 1/3], J_n = (1, 1), J_t = 0:
// W_nn = (1/3 + 4/3 - 1)/(4/9 - 1/4) = (2/3)/(7/36) = 24/7.
TEST(ReductionTest, StretchedDoublePendulumByHand) {
  const Link rod = {.length_m = 1.0,
                    .mass_kg = 1.0,
                    .com_m = 0.5,
                    .inertia_com_kg_m2 = 1.0 / 12.0,
                    .theta_rad = 0.5 * kPi,
                    .rate_rad_s = -1.0};
  const PlanarReduction reduction = Planar(Linkage{{rod, rod}});
  EXPECT_DOUBLE_EQ(reduction.w[2], 24.0 / 7.0);
  EXPECT_NEAR(reduction.w[0], 0.0, 1e-30);
  EXPECT_EQ(reduction.v0, -2.0);
  EXPECT_LE(std::abs(RelativeDeterminant(reduction.w[0], reduction.w[1], reduction.w[2])), 4 * 0x1p-52);
}

// The tip of a stretched chain moves along one line only; rounding must not change that.
TEST(ReductionTest, StretchedChainsHaveRankOneExactlyEnough) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> number(0.1, 2.0);
  for (int i = 0; i < 1'000; ++i) {
    Linkage chain;
    const double theta = number(random);
    for (int k = 0; k < 2 + i % 7; ++k) {
      chain.links.push_back({.length_m = number(random),
                             .mass_kg = number(random),
                             .com_m = number(random),
                             .inertia_com_kg_m2 = number(random),
                             .theta_rad = theta,
                             .rate_rad_s = -number(random)});
    }
    const PlanarReduction reduction = Planar(chain);
    const auto& [tt, tn, nn] = reduction.w;
    ASSERT_LE(std::abs(RelativeDeterminant(tt, tn, nn)), 4 * 0x1p-52);
    ASSERT_LE(std::abs(reduction.u0[0] * nn - reduction.v0 * tn), 8 * 0x1p-52 * std::abs(reduction.v0 * tn));
  }
}

// A body in the plane (t1, n) is a body in space that does not leave this plane; counter-clockwise is against t2.
TEST(ReductionTest, BodyInSpaceIsThePlanarOneWhereItStaysInAPlane) {
  const PlanarBody flat = {.mass_kg = 1.5,
                           .inertia_com_kg_m2 = 0.2,
                           .offset_t_m = 0.3,
                           .offset_n_m = -0.4,
                           .velocity_t_m_s = 1.0,
                           .velocity_n_m_s = -2.0,
                           .rate_rad_s = 3.0};
  const SpatialBody body = {.mass_kg = 1.5,
                            .inertia_com_kg_m2 = {0.7, 0.0, 0.1, 0.2, 0.0, 0.5},
                            .offset_m = {0.3, 0.0, -0.4},
                            .linear_m_s = {1.0, 0.0, -2.0},
                            .angular_rad_s = {0.0, -3.0, 0.0}};
  const PlanarReduction plane = Planar(flat);
  const SpatialReduction space = Spatial(body);
  EXPECT_NEAR(space.w[0], plane.w[0], 1e-15);
  EXPECT_NEAR(space.w[2], plane.w[1], 1e-15);
  EXPECT_NEAR(space.w[5], plane.w[2], 1e-15);
  EXPECT_NEAR(space.w[1], 0.0, 1e-15);
  EXPECT_NEAR(space.w[4], 0.0, 1e-15);
  EXPECT_NEAR(space.u0[0], plane.u0[0], 1e-15);
  EXPECT_NEAR(space.v0, plane.v0, 1e-15);
  const auto flat_after = plane.After({0.25}, 0.5);
  const auto after = space.After({0.25, 0.0}, 0.5);
  EXPECT_NEAR(after[0], flat_after[0], 1e-15);
  EXPECT_NEAR(after[2], flat_after[1], 1e-15);
  EXPECT_NEAR(after[4], -flat_after[2], 1e-14);
}

// A solid sphere: W = diag(7/2, 7/2, 1)/m.
TEST(ReductionTest, SphereByHand) {
  const double inertia = 0.4 * 2.0 * 0.01;
  const SpatialReduction sphere = Spatial(SpatialBody{.mass_kg = 2.0,
                                                      .inertia_com_kg_m2 = {inertia, 0, 0, inertia, 0, inertia},
                                                      .offset_m = {0.0, 0.0, -0.1},
                                                      .linear_m_s = {1.0, 2.0, -3.0},
                                                      .angular_rad_s = {4.0, 5.0, 6.0}});
  EXPECT_THAT(sphere.w, ElementsAre(DoubleEq(1.75), 0.0, 0.0, DoubleEq(1.75), 0.0, DoubleEq(0.5)));
  EXPECT_THAT(sphere.u0, ElementsAre(DoubleEq(1.0 - 0.5), DoubleEq(2.0 + 0.4)));
  EXPECT_EQ(sphere.v0, -3.0);
}

// The change of the contact velocity follows from those of the bodies: J (q'+ - q') = W p.
template <size_t kTangential>
void ExpectConsistent(const System& before, const std::array<double, kTangential>& f, double tau,
                      void (*set)(const std::vector<double>&, System&)) {
  const auto reduction = std::get<Reduction<kTangential>>(Reduce({.system = before}));
  System moved = before;
  const auto velocities = reduction.After(f, tau);
  set({velocities.begin(), velocities.end()}, moved);
  const auto after = std::get<Reduction<kTangential>>(Reduce({.system = moved}));
  const auto& w = reduction.w;
  if constexpr (kTangential == 1) {
    EXPECT_NEAR(after.u0[0] - reduction.u0[0], w[0] * f[0] + w[1] * tau, 1e-14);
    EXPECT_NEAR(after.v0 - reduction.v0, w[1] * f[0] + w[2] * tau, 1e-14);
  } else {
    EXPECT_NEAR(after.u0[0] - reduction.u0[0], w[0] * f[0] + w[1] * f[1] + w[2] * tau, 1e-14);
    EXPECT_NEAR(after.u0[1] - reduction.u0[1], w[1] * f[0] + w[3] * f[1] + w[4] * tau, 1e-14);
    EXPECT_NEAR(after.v0 - reduction.v0, w[2] * f[0] + w[4] * f[1] + w[5] * tau, 1e-14);
  }
}

TEST(ReductionTest, ChainsMoveTheirTipByTheImpulseTimesW) {
  const Linkage chain = {
      {{1.0, 2.0, 0.3, 0.1, 0.4, -1.0}, {0.7, 1.0, 0.5, 0.2, -0.9, 2.0}, {1.2, 0.5, 0.6, 0.1, 1.3, 0.5}}};
  ExpectConsistent<1>(chain, {0.3}, 0.7, [](const std::vector<double>& rates, System& system) {
    auto& links = std::get<Linkage>(system).links;
    for (size_t i = 0; i < links.size(); ++i) links[i].rate_rad_s = rates[i];
  });
}

TEST(ReductionTest, PairsMoveApartByTheImpulseTimesW) {
  const BodyPair pair = {PlanarPair{{1.0, 0.2, 0.1, -0.5, 1.0, -1.0, 2.0}, {3.0, 0.5, -0.3, 0.4, 0.5, 0.25, -1.0}}};
  ExpectConsistent<1>(pair, {0.3}, 0.7, [](const std::vector<double>& velocities, System& system) {
    auto& bodies = std::get<PlanarPair>(std::get<BodyPair>(system).bodies);
    bodies.body_1.velocity_t_m_s = velocities[0];
    bodies.body_1.velocity_n_m_s = velocities[1];
    bodies.body_1.rate_rad_s = velocities[2];
    bodies.body_2.velocity_t_m_s = velocities[3];
    bodies.body_2.velocity_n_m_s = velocities[4];
    bodies.body_2.rate_rad_s = velocities[5];
  });
}

void SetMotion(const std::vector<double>& velocities, size_t at, SpatialBody& body) {
  for (size_t i = 0; i < 3; ++i) {
    body.linear_m_s[i] = velocities[at + i];
    body.angular_rad_s[i] = velocities[at + 3 + i];
  }
}

TEST(ReductionTest, PairsInSpaceMoveApartByTheImpulseTimesW) {
  const SpatialBody one = {1.0, {0.5, 0.1, 0.05, 0.4, -0.1, 0.6}, {0.3, -0.2, -0.5}, {1, 2, -3}, {0.5, -1, 2}};
  const SpatialBody two = {2.5, {0.9, 0.0, 0.2, 0.7, 0.1, 0.8}, {-0.1, 0.4, 0.6}, {0.5, -1, 1}, {2, 1, -1}};
  ExpectConsistent<2>(BodyPair{SpatialPair{one, two}}, {0.3, -0.4}, 0.7,
                      [](const std::vector<double>& velocities, System& system) {
                        auto& bodies = std::get<SpatialPair>(std::get<BodyPair>(system).bodies);
                        SetMotion(velocities, 0, bodies.body_1);
                        SetMotion(velocities, 6, bodies.body_2);
                      });
}

TEST(ReductionTest, ContactsAreHandedThroughAsTheyAre) {
  const PlanarReduction planar = Planar(PlanarContact{2.0, 0.5, 1.0, 3.0, -4.0});
  EXPECT_THAT(planar.w, ElementsAre(2.0, 0.5, 1.0));
  EXPECT_EQ(planar.u0[0], 3.0);
  EXPECT_EQ(planar.v0, -4.0);
  EXPECT_THAT(planar.After({1.0}, 1.0), IsEmpty());
  const SpatialReduction spatial = Spatial(SpatialContact{{1, 2, 3, 4, 5, 6}, {7, 8}, -9});
  EXPECT_THAT(spatial.w, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(spatial.u0, ElementsAre(7, 8));
  EXPECT_EQ(spatial.v0, -9);
}

TEST(ReductionTest, VelocitiesAreRelativeToTheSurface) {
  const Scene scene = {.system = PlanarContact{2.0, 0.5, 1.0, 3.0, -4.0},
                       .surface_velocity = SurfaceVelocity{{1.0}, 0.5}};
  const auto reduction = std::get<PlanarReduction>(Reduce(scene));
  EXPECT_EQ(reduction.u0[0], 2.0);
  EXPECT_EQ(reduction.v0, -4.5);
  EXPECT_EQ(ApproachSpeed(reduction), 4.5);
}

TEST(DeterminantTest, RelativeDeterminantIsRightOverTheWholeRange) {
  for (const double scale : {0x1p-1000, 1.0, 0x1p1000}) {
    EXPECT_EQ(RelativeDeterminant(4.0 * scale, scale, scale), 0.75) << scale;
    EXPECT_EQ(RelativeDeterminant(4.0 * scale, 2.0 * scale, scale), 0.0) << scale;
    EXPECT_EQ(RelativeDeterminant(scale, 2.0 * scale, scale), -3.0) << scale;
  }
  EXPECT_EQ(RelativeDeterminant(0.0, 0.0, 1.0), 0.0);
  EXPECT_EQ(RelativeDeterminant(0.0, 1e-300, 1.0), -INFINITY);
}

TEST(DeterminantTest, ProductsAgreeWhateverTheirSize) {
  for (const double x : {0x1p-1070, 0x1p-500, 1.0, 0x1p500, 0x1p1020}) {
    for (const double y : {0x1p-1022, 0x1p-300, 1.0, 0x1p1020}) {
      EXPECT_TRUE(ProductsAgree(x, y * 0.5, y, x * 0.5, 0x1p-49)) << x << ' ' << y;
      EXPECT_TRUE(ProductsAgree(-x, y * 0.5, y, -x * 0.5, 0x1p-49)) << x << ' ' << y;
      EXPECT_FALSE(ProductsAgree(x, y * 0.5, -y, x * 0.5, 0x1p-49)) << x << ' ' << y;
      EXPECT_FALSE(ProductsAgree(x, y, y, x * 0.5, 0x1p-49)) << x << ' ' << y;
      EXPECT_FALSE(ProductsAgree(x, y, 0.0, x, 0x1p-49)) << x << ' ' << y;
      if (y < 0x1p-1000) continue;
      EXPECT_TRUE(ProductsAgree(x, y * (1.0 + 0x1p-51), y, x, 0x1p-49)) << x << ' ' << y;
      EXPECT_FALSE(ProductsAgree(x, y * (1.0 + 0x1p-40), y, x, 0x1p-49)) << x << ' ' << y;
    }
  }
  EXPECT_TRUE(ProductsAgree(0.0, 1e-300, 1e300, 0.0, 0x1p-49));
}

// u Wnn and v Wtn are both below the smallest double.
TEST(DelassusTest, AVelocityBesideTheRangeOfASmallWIsBesideIt) {
  const double tn = 0x1p-530;
  const PlanarDelassus w = {1.0, tn, tn * tn};
  EXPECT_TRUE(w.UFollowsV(-1.0, -tn));
  EXPECT_FALSE(w.UFollowsV(-1.0, -tn * (1.0 + 0x1p-20)));
}

}  // namespace
}  // namespace ricochet
