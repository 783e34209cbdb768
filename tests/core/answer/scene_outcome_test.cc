// The impact of every kind of scene: which model answers, and which velocities the system has afterwards.

#include "core/answer/scene_outcome.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/contact/reduction.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kTight = 1e-14;

Scene With(const System& system, double mu, const Restitution& restitution) {
  return {.system = system, .friction = {.kinetic_coefficient = mu}, .restitution = restitution};
}

Outcome Solved(const Scene& scene, std::vector<double> history = {}) {
  const absl::StatusOr<SolveResponse> response =
      LocalSolver().Solve({.scene = scene, .history_at_n_s = std::move(history)});
  EXPECT_TRUE(response.ok()) << response.status();
  return response.ok() ? response->outcome : Outcome();
}

std::string ErrorOf(const SolveRequest& request) {
  const absl::StatusOr<SolveResponse> response = LocalSolver().Solve(request);
  EXPECT_EQ(response.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(response.status().message());
}

// 1 kg and 1 m, leaning by 45 degrees: W = [2.5, 1.5; 1.5, 2.5], velocity (-1, -1).
PlanarBody Rod() {
  const double half = 0.5 * std::sqrt(0.5);
  return {1.0, 1.0 / 12.0, half, -half, -1.0, -1.0, 0.0};
}

PlanarContact RodContact() { return {2.5, 1.5, 2.5, -1.0, -1.0}; }

PlanarBody Disk() { return {2.0, 0.5 * 2.0 * 0.09, 0.0, -0.3, 1.5, -2.0, 0.5}; }

double KineticEnergy(const PlanarBody& body, const BodyVelocity& velocity) {
  return 0.5 * body.mass_kg * (std::pow(velocity.linear_m_s[0], 2) + std::pow(velocity.linear_m_s[1], 2)) +
         0.5 * body.inertia_com_kg_m2 * std::pow(velocity.angular_rad_s[0], 2);
}

BodyVelocity VelocityOf(const PlanarBody& body) {
  return {{body.velocity_t_m_s, body.velocity_n_m_s}, {body.rate_rad_s}};
}

TEST(SceneOutcomeTest, LeaningRodByHandUnderEachLaw) {
  const Outcome newton = Solved(With(Rod(), 0.7, NewtonCoefficient{1.0}));
  EXPECT_NEAR(newton.energy_change_j, 1.0 / 16.0, kTight);
  EXPECT_FALSE(newton.admissible);
  const Outcome poisson = Solved(With(Rod(), 0.7, PoissonCoefficient{1.0}));
  EXPECT_NEAR(poisson.impulse.normal_total_n_s, 40.0 / 71.0, kTight);
  const Outcome energetic = Solved(With(Rod(), 0.7, EnergeticCoefficient{1.0}));
  EXPECT_NEAR(energetic.energy_change_j, -7.0 / 65.0, kTight);
  EXPECT_TRUE(energetic.admissible);
}

TEST(SceneOutcomeTest, BodyAndItsContactAgree) {
  const Outcome body = Solved(With(Rod(), 0.7, EnergeticCoefficient{0.8}));
  const Outcome contact = Solved(With(RodContact(), 0.7, EnergeticCoefficient{0.8}));
  EXPECT_EQ(body.regime, contact.regime);
  EXPECT_NEAR(body.impulse.normal_total_n_s, contact.impulse.normal_total_n_s, kTight);
  EXPECT_NEAR(body.contact_velocity_after.tangential_m_s[0], contact.contact_velocity_after.tangential_m_s[0], kTight);
  EXPECT_THAT(contact.bodies_after, IsEmpty());
  EXPECT_THAT(contact.rates_after_rad_s, IsEmpty());
}

// Lubarda, footnote 3: without coupling the three laws agree.
TEST(SceneOutcomeTest, DiskBouncesTheSameUnderAllThreeLaws) {
  const Outcome newton = Solved(With(Disk(), 0.1, NewtonCoefficient{0.6}));
  for (const Restitution& law : {Restitution(PoissonCoefficient{0.6}), Restitution(EnergeticCoefficient{0.6})}) {
    const Outcome other = Solved(With(Disk(), 0.1, law));
    EXPECT_NEAR(other.impulse.normal_total_n_s, newton.impulse.normal_total_n_s, kTight);
    EXPECT_NEAR(other.contact_velocity_after.tangential_m_s[0], newton.contact_velocity_after.tangential_m_s[0],
                kTight);
    EXPECT_NEAR(other.bodies_after[0].angular_rad_s[0], newton.bodies_after[0].angular_rad_s[0], 10 * kTight);
  }
}

// tau1 = m (1 + e) |v0|, f1 = -mu tau1 while it slides.
TEST(SceneOutcomeTest, SlidingDiskByHand) {
  const Outcome outcome = Solved(With(Disk(), 0.1, NewtonCoefficient{0.5}));
  EXPECT_EQ(outcome.regime, Regime::kSliding);
  EXPECT_NEAR(outcome.impulse.normal_total_n_s, 6.0, kTight);
  EXPECT_NEAR(outcome.impulse.tangential_n_s[0], -0.6, kTight);
  ASSERT_THAT(outcome.bodies_after, SizeIs(1));
  EXPECT_THAT(outcome.bodies_after[0].linear_m_s, ElementsAre(DoubleNear(1.2, kTight), DoubleNear(1.0, kTight)));
  EXPECT_THAT(outcome.bodies_after[0].angular_rad_s, ElementsAre(DoubleNear(0.5 - 0.3 * 0.6 / 0.09, kTight)));
}

TEST(SceneOutcomeTest, EnergyOfTheBodiesChangesByTheLedger) {
  const PlanarBody one = {1.0, 0.2, 0.1, -0.5, 1.0, -1.0, 2.0};
  const PlanarBody two = {3.0, 0.5, -0.3, 0.4, 0.5, 0.25, -1.0};
  const Outcome outcome = Solved(With(BodyPair{PlanarPair{one, two}}, 0.4, EnergeticCoefficient{0.7}));
  ASSERT_THAT(outcome.bodies_after, SizeIs(2));
  const double before = KineticEnergy(one, VelocityOf(one)) + KineticEnergy(two, VelocityOf(two));
  const double after = KineticEnergy(one, outcome.bodies_after[0]) + KineticEnergy(two, outcome.bodies_after[1]);
  EXPECT_NEAR(after - before, outcome.energy_change_j, kTight);
  for (size_t i = 0; i < 2; ++i) {
    const double momentum =
        one.mass_kg * outcome.bodies_after[0].linear_m_s[i] + two.mass_kg * outcome.bodies_after[1].linear_m_s[i];
    EXPECT_NEAR(momentum, i == 0 ? 1.0 + 1.5 : -1.0 + 0.75, kTight);
  }
}

TEST(SceneOutcomeTest, BodyThatStrikesAMountainBouncesAsFromTheGround) {
  const PlanarBody mountain = {1e18, 1e18, 0.3, 0.4, 0.0, 0.0, 0.0};
  const Outcome pair = Solved(With(BodyPair{PlanarPair{Rod(), mountain}}, 0.3, PoissonCoefficient{0.7}));
  const Outcome ground = Solved(With(Rod(), 0.3, PoissonCoefficient{0.7}));
  EXPECT_NEAR(pair.bodies_after[0].linear_m_s[1], ground.bodies_after[0].linear_m_s[1], kTight);
  EXPECT_NEAR(pair.bodies_after[0].angular_rad_s[0], ground.bodies_after[0].angular_rad_s[0], kTight);
}

TEST(SceneOutcomeTest, OneLinkAnswersAsThePendulumDoes) {
  const Link link = {2.0, 3.0, 0.7, 0.4, 0.6, -1.5};
  const Pendulum pendulum = {0.4 + 3.0 * 0.49, 2.0 * std::sin(0.6), 2.0 * std::cos(0.6), -1.5};
  for (const Restitution& law : {Restitution(NewtonCoefficient{0.5}), Restitution(PoissonCoefficient{0.5}),
                                 Restitution(EnergeticCoefficient{0.5})}) {
    for (const double mu : {0.0, 0.2, 0.5, 0.9}) {
      const Outcome chain = Solved(With(Linkage{{link}}, mu, law));
      const Outcome single = Solved(With(pendulum, mu, law));
      EXPECT_EQ(chain.w_rank, 1);
      EXPECT_NEAR(chain.rates_after_rad_s[0], single.rates_after_rad_s[0], kTight);
      EXPECT_NEAR(chain.impulse.normal_total_n_s, single.impulse.normal_total_n_s, kTight);
      EXPECT_NEAR(chain.impulse.tangential_n_s[0], single.impulse.tangential_n_s[0], kTight);
      EXPECT_NEAR(chain.energy_change_j, single.energy_change_j, kTight);
    }
  }
}

TEST(SceneOutcomeTest, PendulumOnAMovingSurfaceTurnsRelativeToIt) {
  Scene moving = With(Pendulum{2.0, 0.3, 1.0, -3.0}, 0.1, EnergeticCoefficient{0.5});
  moving.surface_velocity =
      SurfaceVelocity{{-1.0}, -0.3};  // The contact then has the velocity that a rate of -1 rad/s gives.
  const Outcome still = Solved(With(Pendulum{2.0, 0.3, 1.0, -2.0}, 0.1, EnergeticCoefficient{0.5}));
  const Outcome outcome = Solved(moving);
  EXPECT_NEAR(outcome.rates_after_rad_s[0] + 1.0, still.rates_after_rad_s[0], kTight);
  EXPECT_NEAR(outcome.contact_velocity_after.normal_m_s, still.contact_velocity_after.normal_m_s, kTight);
}

// The contact of Keller (1986) with mu = 0.2 and eta = 0.6.
TEST(SceneOutcomeTest, ContactInSpaceMeetsTheKnownNumbers) {
  const Outcome outcome = Solved(With(ContactInSpace(), 0.2, EnergeticCoefficient{0.6}));
  EXPECT_NEAR(outcome.contact_velocity_after.tangential_m_s[0], 1.1935907812616, 1e-10);
  EXPECT_NEAR(outcome.contact_velocity_after.tangential_m_s[1], -0.23674642666214, 1e-10);
  EXPECT_NEAR(outcome.contact_velocity_after.normal_m_s, 0.58574780070097, 1e-10);
  EXPECT_LE(outcome.accuracy.relative_error, 1e-10);
  EXPECT_EQ(outcome.accuracy.kind, AccuracyKind::kEstimate);
}

TEST(SceneOutcomeTest, SphereInSpaceIsTheDiskInItsPlane) {
  const double inertia = 0.4 * 2.0 * 0.09;
  const SpatialBody sphere = {
      2.0, {inertia, 0, 0, inertia, 0, inertia}, {0.0, 0.0, -0.3}, {1.5, 0.0, -2.0}, {0.0, -0.5, 0.0}};
  const PlanarBody disk = {2.0, inertia, 0.0, -0.3, 1.5, -2.0, 0.5};
  const Outcome space = Solved(With(sphere, 0.1, EnergeticCoefficient{0.6}));
  const Outcome plane = Solved(With(disk, 0.1, EnergeticCoefficient{0.6}));
  ASSERT_THAT(space.bodies_after, SizeIs(1));
  EXPECT_NEAR(space.bodies_after[0].linear_m_s[0], plane.bodies_after[0].linear_m_s[0], 1e-13);
  EXPECT_NEAR(space.bodies_after[0].linear_m_s[2], plane.bodies_after[0].linear_m_s[1], 1e-13);
  EXPECT_NEAR(space.bodies_after[0].angular_rad_s[1], -plane.bodies_after[0].angular_rad_s[0], 1e-12);
}

TEST(SceneOutcomeTest, ContactsThatDoNotApproachKeepTheirVelocities) {
  PlanarBody rising = Rod();
  rising.velocity_n_m_s = 1.0;
  SpatialContact grazing = ContactInSpace();
  grazing.normal_m_s = 0.0;
  for (const System& system : {System(rising), System(BodyPair{PlanarPair{rising, Rod()}}),
                               System(Linkage{{{1.0, 1.0, 0.5, 0.1, 0.3, 1.0}}}), System(grazing)}) {
    const Outcome outcome = Solved(With(system, 0.5, NewtonCoefficient{0.5}));
    EXPECT_EQ(outcome.regime, Regime::kSeparating) << system.index();
    EXPECT_EQ(outcome.impulse.normal_total_n_s, 0.0);
    EXPECT_THAT(outcome.timeline, IsEmpty());
    EXPECT_EQ(outcome.energy_change_j, 0.0);
    EXPECT_EQ(outcome.accuracy.relative_error, 0.0);
  }
  const Outcome body = Solved(With(rising, 0.5, NewtonCoefficient{0.5}));
  EXPECT_EQ(body.bodies_after[0], VelocityOf(rising));
}

TEST(SceneOutcomeTest, HistoryOfAChainGivesItsRates) {
  const Linkage chain = {{{1.0, 1.0, 0.5, 1.0 / 12.0, 0.35, -0.1}, {1.0, 1.0, 0.5, 1.0 / 12.0, 0.52, -0.2}}};
  const Scene scene = With(chain, 0.7, EnergeticCoefficient{0.5});
  const Outcome whole = Solved(scene);
  const double tau1 = whole.impulse.normal_total_n_s;
  const Outcome outcome = Solved(scene, {0.0, 0.5 * tau1, tau1});
  ASSERT_THAT(outcome.history, SizeIs(3));
  EXPECT_THAT(outcome.history[0].rates_rad_s, ElementsAre(-0.1, -0.2));
  EXPECT_THAT(outcome.history[2].rates_rad_s, ElementsAre(DoubleNear(whole.rates_after_rad_s[0], kTight),
                                                          DoubleNear(whole.rates_after_rad_s[1], kTight)));
  EXPECT_THAT(ErrorOf({.scene = scene, .history_at_n_s = {2.0 * tau1}}), HasSubstr("history_at_n_s[0]"));
}

TEST(SceneOutcomeTest, ThereIsNoHistoryInSpaceAndUnderAnImpactLaw) {
  EXPECT_EQ(ErrorOf({.scene = With(ContactInSpace(), 0.2, EnergeticCoefficient{0.6}), .history_at_n_s = {0.0}}),
            "history_at_n_s has 1 entry: must be empty for a system in space");
  Scene law = With(Rod(), 0.2, std::monostate());
  law.impact_law = WhittakerLaw{0.5};
  EXPECT_EQ(ErrorOf({.scene = law, .history_at_n_s = {0.0, 0.1}}),
            "history_at_n_s has 2 entries: must be empty for an impact law, which has no path");
}

TEST(SceneOutcomeTest, ToleranceOutsideItsRangeIsRefused) {
  const Scene scene = With(ContactInSpace(), 0.2, EnergeticCoefficient{0.6});
  for (const double tolerance : {0.2, -1e-13, -1.0, 1e300, std::nan("")}) {
    EXPECT_THAT(ErrorOf({.scene = scene, .demand = {.relative_tolerance = tolerance}}), HasSubstr("be in [0, 0.1]"));
  }
  EXPECT_TRUE(LocalSolver().Solve({.scene = scene, .demand = {.relative_tolerance = 1e-4}}).ok());
}

TEST(SceneOutcomeTest, AWThatOverflowsIsOutOfRange) {
  const absl::StatusOr<SolveResponse> response =
      LocalSolver().Solve({.scene = With(PlanarBody{1e-310, 1.0, 0, 0, 0, -1.0, 0}, 0.1, EnergeticCoefficient{0.5})});
  EXPECT_EQ(response.status().code(), absl::StatusCode::kOutOfRange);
}

TEST(SceneOutcomeTest, AWThatUnderflowsIsOutOfRange) {
  // a^2 is 0, or has lost its digits.
  for (const double a : {1e-200, 1e-160}) {
    Scene scene = With(Pendulum{1.3, a, 0.4, -2.0}, 0.8, EnergeticCoefficient{0.8});
    EXPECT_TRUE(LocalSolver().Solve({.scene = scene}).ok());
    scene.compliance = Compliance{.tangential_ratio_squared = 0.3};
    const absl::Status status = LocalSolver().Solve({.scene = scene}).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kOutOfRange);
    EXPECT_THAT(std::string(status.message()), HasSubstr("W_nn is below the smallest normal one"));
  }
}

TEST(SceneOutcomeTest, AStatedWHasAllItsDigitsWhateverItsSize) {
  const Scene scene = With(PlanarContact{1.0, 0.0, 0x1p-1060, -0.5, -0x1p-100}, 0.0, EnergeticCoefficient{0.5});
  EXPECT_EQ(Solved(scene).impulse.normal_total_n_s, 1.5 * 0x1p960);
}

TEST(SceneOutcomeTest, ALinkTooHeavyForDoublesIsOutOfRangeAndDoesNotSeparate) {
  const Linkage linkage = {.links = {{.length_m = 1.0,
                                      .mass_kg = 1.7e308,
                                      .com_m = 0.5,
                                      .inertia_com_kg_m2 = 1.0,
                                      .theta_rad = -1e-108,
                                      .rate_rad_s = 0.35}}};
  ASSERT_LT(std::get<PlanarReduction>(Reduce({.system = linkage})).v0, 0.0);
  const Scene scene = With(linkage, 0.3, EnergeticCoefficient{0.8});
  EXPECT_EQ(LocalSolver().Solve({.scene = scene}).status().code(), absl::StatusCode::kOutOfRange);
}

// --- Coefficients by speed ---

TEST(SceneOutcomeTest, CoefficientsAreThoseAtTheApproachSpeed) {
  Scene scene = With(Disk(), 0.2, NewtonCoefficient{0.8});  // It approaches at 2 m/s.
  scene.friction.static_coefficient = 0.3;
  scene.friction.by_speed = SpeedTable{{1.0, 3.0}, {1.0, 0.5}};
  scene.restitution_by_speed = PowerLaw{0.25, 1.0};
  const Outcome outcome = Solved(scene);
  EXPECT_DOUBLE_EQ(outcome.effective.kinetic_friction, 0.15);
  EXPECT_DOUBLE_EQ(outcome.effective.static_friction, 0.225);
  EXPECT_DOUBLE_EQ(outcome.effective.restitution.value(), 0.4);
  EXPECT_DOUBLE_EQ(outcome.coefficients.newton, 0.4);
  EXPECT_DOUBLE_EQ(outcome.coefficients.tangential, -0.15);
}

TEST(SceneOutcomeTest, PendulumTakesItsCoefficientsBySpeedToo) {
  Scene scene = With(Pendulum{2.0, 0.5, 1.0, -4.0}, 0.1, EnergeticCoefficient{0.8});
  scene.restitution_by_speed = PowerLaw{0.25, 1.0};
  Scene constant = scene;
  constant.restitution_by_speed.reset();
  constant.restitution = EnergeticCoefficient{0.8 * (1.0 - 0.25 * 2.0)};
  EXPECT_EQ(Solved(scene), Solved(constant));
}

TEST(SceneOutcomeTest, ConstantCoefficientsAreEchoed) {
  const Outcome outcome = Solved(With(Disk(), 0.4, PoissonCoefficient{0.8}));
  EXPECT_EQ(outcome.effective, (EffectiveCoefficients{0.4, 0.4, 0.8}));
}

TEST(SceneOutcomeTest, FactorsAreLinearBetweenSpeedsAndConstantOutside) {
  Scene scene = With(RodContact(), 1.0, NewtonCoefficient{0.0});
  scene.friction.by_speed = SpeedTable{{1.0, 2.0, 4.0}, {1.0, 0.5, 0.25}};
  const std::vector<std::pair<double, double>> factors = {{0.5, 1.0}, {1.0, 1.0},   {1.5, 0.75},
                                                          {2.0, 0.5}, {3.0, 0.375}, {9.0, 0.25}};
  for (const auto& [speed, factor] : factors) {
    std::get<PlanarContact>(scene.system).normal_m_s = -speed;
    EXPECT_EQ(Solved(scene).effective.kinetic_friction, factor) << speed;
  }
}

// --- Laws to compare with ---

Scene LawScene(const ImpactLaw& law) {
  Scene scene = With(Rod(), 0.7, std::monostate());
  scene.impact_law = law;
  return scene;
}

// Whittaker on the rod: u0 < 0, f = 0.7 tau, tau1 = (1 + e)/(2.5 + 0.7 * 1.5), dE = (f (u0 + u1) + tau1 (v0 + v1))/2.
Outcome SolvedTo(const Scene& scene, const DemandFields& demand) {
  const absl::StatusOr<SolveResponse> response = LocalSolver().Solve({.scene = scene, .demand = demand});
  EXPECT_TRUE(response.ok()) << response.status();
  return response.ok() ? response->outcome : Outcome();
}

Scene GrazingInSpace(double v0) {
  return With(SpatialContact{{1.96, 0.24, 0.6, 2.96, -0.8, 1.85}, {1.0, 0.6}, v0}, 0.3, EnergeticCoefficient{0.8});
}

TEST(NumberErrorsTest, AGrazingImpactInSpaceKeepsItsDigitsAtToleranceZero) {
  for (const double v0 : {-1e-12, -1e-20, -1e-100, -1e-300}) {
    const Outcome outcome = SolvedTo(GrazingInSpace(v0), {.relative_tolerance = 0.0});
    // To first order in v0 slip keeps its direction, and the three definitions agree.
    EXPECT_NEAR(outcome.coefficients.newton, 0.8, 1e-11) << v0;
    EXPECT_NEAR(outcome.contact_velocity_after.normal_m_s, -0.8 * v0, 1e-11 * -v0) << v0;
    ASSERT_TRUE(outcome.errors.newton.has_value()) << v0;
    EXPECT_LE(*outcome.errors.newton, 1e-13) << v0;
  }
}

TEST(NumberErrorsTest, FrictionIsNotLeftOutHoweverSmallTheApproachIs) {
  for (const double v0 : {-1e-20, -1e-30, -1e-100, -1e-300}) {
    const Outcome outcome = SolvedTo(GrazingInSpace(v0), {});
    EXPECT_LE(outcome.plan.neglected, 1e-12) << v0;
    EXPECT_GT(outcome.coefficients.tangential, 0.0) << v0;
    ASSERT_TRUE(outcome.errors.normal_m_s.has_value());
    EXPECT_LE(*outcome.errors.normal_m_s, 1e-9 * -v0);
    EXPECT_LE(outcome.errors.normal_total_n_s.value_or(1.0), 1e-9 * outcome.impulse.normal_total_n_s);
  }
}

TEST(NumberErrorsTest, AnErrorAboveTheToleranceIsNotConverged) {
  // The works are below the smallest double, so that their errors are above the energy moved.
  const Scene scene = With(PlanarContact{2.0, 1.0, 1.0, -1e-200, -1e-200}, 0.3, EnergeticCoefficient{0.8});
  const Outcome outcome = SolvedTo(scene, {});
  EXPECT_GT(outcome.accuracy.relative_error, 1e-12);
  EXPECT_EQ(outcome.termination, Termination::kLessAccurate);
  EXPECT_EQ(SolvedTo(scene, {.relative_tolerance = 0.0}).termination, Termination::kConverged);
  EXPECT_LE(*outcome.errors.normal_m_s, 1e-215);
}

TEST(NumberErrorsTest, TheLedgerOfAStraightImpactInTimeCloses) {
  Scene scene = With(Pendulum{1.0, 0.3, 1.0, -1.0}, 1.0, EnergeticCoefficient{0.8});
  scene.friction.by_speed = SpeedDependence(SpeedTable{{0.0, 1.0, 2.0}, {1.0, 0.5, 0.4}});
  scene.compliance = Compliance{.normal = HertzSpring{1e5}};
  const Outcome outcome = SolvedTo(scene, {.required = {Effect::kFiniteDuration}});
  EXPECT_NEAR(outcome.work.residual_j, 0.0, 1e-15);
}

TEST(SceneOutcomeTest, WhittakerOnTheRodByHand) {
  const Outcome outcome = Solved(LawScene(WhittakerLaw{1.0}));
  const double tau1 = 2.0 / 3.55;
  EXPECT_EQ(outcome.regime, Regime::kByLaw);
  EXPECT_NEAR(outcome.impulse.normal_total_n_s, tau1, kTight);
  EXPECT_NEAR(outcome.coefficients.tangential, 0.7, kTight);
  EXPECT_NEAR(outcome.contact_velocity_after.normal_m_s, 1.0, kTight);
  const double u1 = -1.0 + (2.5 * 0.7 + 1.5) * tau1;
  EXPECT_NEAR(outcome.contact_velocity_after.tangential_m_s[0], u1, kTight);
  EXPECT_NEAR(outcome.energy_change_j, 0.5 * 0.7 * tau1 * (u1 - 1.0), kTight);
  EXPECT_EQ(outcome.effective.restitution, 1.0);
  EXPECT_NEAR(outcome.work.normal_total_j + outcome.work.tangential_total_j, outcome.energy_change_j, kTight);
  EXPECT_THAT(outcome.bodies_after, SizeIs(1));
  EXPECT_THAT(outcome.timeline, SizeIs(2));
}

TEST(SceneOutcomeTest, BrachThatPushesCreatesEnergyAndIsFlagged) {
  const Outcome outcome = Solved(LawScene(BrachLaw{1.0, 2.0}));
  EXPECT_GT(outcome.energy_change_j, 0.0);
  EXPECT_FALSE(outcome.admissible);
  ASSERT_THAT(outcome.broken_limits, SizeIs(2));
  EXPECT_EQ(outcome.broken_limits[0].kind, LimitKind::kEnergy);
  EXPECT_EQ(outcome.broken_limits[1].kind, LimitKind::kFriction);
  EXPECT_EQ(outcome.broken_limits[1].value, outcome.work.tangential_total_j);
  EXPECT_GT(outcome.work.tangential_total_j, 0.0);
}

// f = tau1/2 = 1/7 along a slip that goes from -1 to 1/2 on average: (1/7) (-1/2)/2 < 0; mu_hat = -1/2 gives the
// opposite sign.
TEST(SceneOutcomeTest, FrictionThatPushesIsFlaggedByEveryLawAndFrictionThatBrakesByNone) {
  const PlanarContact pendulum = {1.0, 4.0, 16.0, -1.0, -4.0};
  const auto limits = [&](const ImpactLaw& law) {
    Scene scene = With(pendulum, 0.5, std::monostate());
    scene.impact_law = law;
    std::vector<LimitKind> kinds;
    for (const BrokenLimit& limit : Solved(scene).broken_limits) kinds.push_back(limit.kind);
    return kinds;
  };
  EXPECT_THAT(limits(BrachLaw{0.5, 0.5}), IsEmpty());
  EXPECT_THAT(limits(BrachLaw{0.5, -0.5}), ElementsAre(LimitKind::kFriction));
  EXPECT_THAT(limits(WhittakerLaw{0.5}), IsEmpty());
  // The law's friction opposes the slip after the impact, which has reversed: it pushes along the slip before.
  EXPECT_THAT(limits(KaneLevinsonLaw{0.5}), ElementsAre(LimitKind::kFriction));
  // At e = 1 the mean slip is 0, but for rounding.
  EXPECT_THAT(limits(KaneLevinsonLaw{1.0}), IsEmpty());
  EXPECT_THAT(limits(WhittakerLaw{2.0}), ElementsAre(LimitKind::kEnergy, LimitKind::kFriction));
}

TEST(SceneOutcomeTest, EachLawHoldsItsNewtonCoefficient) {
  for (const ImpactLaw& law : {ImpactLaw(WhittakerLaw{0.5}), ImpactLaw(KaneLevinsonLaw{0.5}),
                               ImpactLaw(BrachLaw{0.5, 0.1}), ImpactLaw(ChatterjeeRuinaLaw{0.5, 0.1})}) {
    const Outcome outcome = Solved(LawScene(law));
    EXPECT_NEAR(outcome.coefficients.newton, 0.5, kTight) << law.index();
    EXPECT_THAT(outcome.alternatives, IsEmpty());
  }
}

TEST(SceneOutcomeTest, ALawWithoutASolutionSaysSoAndChangesNothing) {
  Scene scene = With(PlanarContact{2.5, -1.5, 1.0, 1.0, -1.0}, 0.0, std::monostate());
  scene.impact_law = BrachLaw{0.5, 1.0};  // Wnn + mu_hat Wtn = -0.5: the impulse would increase the approach velocity.
  const Outcome outcome = Solved(scene);
  EXPECT_EQ(outcome.regime, Regime::kNoSolution);
  EXPECT_EQ(outcome.termination, Termination::kRefused);
  EXPECT_FALSE(outcome.coefficients.poisson.has_value());
  EXPECT_FALSE(outcome.work.normal_compression_j.has_value());
  EXPECT_EQ(outcome.impulse.normal_total_n_s, 0.0);
  EXPECT_EQ(outcome.contact_velocity_after.normal_m_s, -1.0);
  EXPECT_EQ(outcome.coefficients.newton, -1.0);
  EXPECT_TRUE(std::isinf(outcome.accuracy.relative_error));
}

// a = mu b: the pendulum jams exactly, but its W = (b^2, ab, a^2)/I on a surface of its own velocity is rounded.
TEST(SceneOutcomeTest, ANoteSaysWhereTheRoundingOfWDecidesWhetherTheContactJams) {
  for (const auto& [a, is_near] : {std::pair(0.3, true), {0.3 + 1e-8, true}, {0.31, false}}) {
    Scene scene = With(Pendulum{1.0, a, 1.0, -1.0}, 0.3, EnergeticCoefficient{0.5});
    scene.surface_velocity = SurfaceVelocity{{0.0}, 0.5};
    const Outcome outcome = Solved(scene);
    const auto warns = [](const Note& note) { return note.text.find("so nearly equal") != std::string::npos; };
    EXPECT_EQ(std::any_of(outcome.notes.begin(), outcome.notes.end(), warns), is_near) << a;
  }
}

TEST(SceneOutcomeTest, KaneAndLevinsonTakeTheImpulseThatBrakesAndGiveTheEndsOfTheRange) {
  Scene scene = With(PlanarContact{4.0, 2.0, 1.0, -2.0, -1.0}, 0.3, std::monostate());
  scene.impact_law = KaneLevinsonLaw{0.0};  // W has rank one, so that any impulse of the cone ends the approach.
  const Outcome outcome = Solved(scene);
  // tau1 = 1/(1 + .6) and f = .3 tau1 against u0 = -2; the other end is tau1 = 1/(1 - .6), f = -.3 tau1.
  EXPECT_NEAR(outcome.impulse.tangential_n_s[0], 0.1875, kTight);
  EXPECT_NEAR(outcome.work.tangential_total_j, -0.1875, kTight);
  EXPECT_TRUE(outcome.admissible);
  ASSERT_THAT(outcome.alternatives, SizeIs(2));
  EXPECT_NEAR(outcome.alternatives[0].impulse.tangential_n_s[0], -0.75, kTight);
  EXPECT_NEAR(outcome.alternatives[1].impulse.tangential_n_s[0], 0.1875, kTight);
  EXPECT_EQ(outcome.alternatives[0].contact_velocity_after, outcome.contact_velocity_after);
  ASSERT_THAT(outcome.notes, SizeIs(1));
  EXPECT_EQ(outcome.notes[0].kind, NoteKind::kManySolutions);
  EXPECT_THAT(outcome.notes[0].text, HasSubstr("from f = -0.75"));
}

// A plan that leaves out the stop of slip may let slip reverse, but not so far that friction gives energy.
TEST(SceneOutcomeTest, NoPlanLetsFrictionPushUnlessTheCallerExcludesThatSlipStops) {
  std::mt19937_64 random(26);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  int sliding = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double t = uniform(0.1, 2.0);
    const double n = uniform(0.1, 2.0);
    const PlanarContact contact = {t * t, t * n * uniform(-0.5, 0.5), n * n, uniform(-0.2, 0.2), -uniform(0.5, 2.0)};
    SolveRequest request = {.scene = With(contact, uniform(0.0, 0.3), EnergeticCoefficient{uniform(0.0, 1.0)}),
                            .demand = {.relative_tolerance = std::pow(10.0, uniform(-3.0, -1.0))}};
    const absl::StatusOr<SolveResponse> response = LocalSolver().Solve(request);
    ASSERT_TRUE(response.ok()) << response.status();
    ASSERT_TRUE(response->outcome.admissible);
    ASSERT_GE(response->outcome.work.friction_dissipation_j, -1e-15);
    sliding += response->outcome.plan.model == Model::kSliding ? 1 : 0;
    const bool slides_straight =
        request.scene.friction.kinetic_coefficient * std::fabs(contact.w_tn_per_kg) < 0.5 * n * n;
    if (i % 10 != 0 || !slides_straight) continue;
    request.demand.excluded = {Effect::kSlipStop};
    const absl::StatusOr<SolveResponse> forced = LocalSolver().Solve(request);
    ASSERT_TRUE(forced.ok()) << forced.status();
    const auto& limits = forced->outcome.broken_limits;
    const bool is_flagged =
        std::any_of(limits.begin(), limits.end(), [](const auto& one) { return one.kind == LimitKind::kFriction; });
    ASSERT_EQ(is_flagged, forced->outcome.work.tangential_total_j > 1e-14) << forced->outcome.work.tangential_total_j;
  }
  EXPECT_GT(sliding, 100);
}

// ---- Surfaces in motion that a mechanism with one joint cannot follow ----

Scene OnConveyor(double mu, double normal_m_s, const Restitution& restitution) {
  Scene scene = With(Pendulum{1.0, 0.3, 1.0, -1.0}, mu, restitution);
  scene.surface_velocity = SurfaceVelocity{{0.0}, normal_m_s};
  return scene;
}

// u0 = -1, v0 = -.6, Wnn = .09: tau1 = 1.8 (.6/.09) = 12, v+ = .48, w+ = -1 + .3 12 = 2.6.
TEST(SceneOutcomeTest, APendulumStrikesASurfaceThatRises) {
  const Outcome outcome = Solved(OnConveyor(0.0, 0.3, EnergeticCoefficient{0.8}));
  EXPECT_NEAR(outcome.contact_velocity_after.normal_m_s, 0.48, kTight);
  EXPECT_NEAR(outcome.rates_after_rad_s[0], 2.6, 4 * kTight);
  EXPECT_EQ(outcome.w_rank, 1);
  EXPECT_EQ(outcome.termination, Termination::kConverged);
}

// Slip stops at tau = 2.5, v = -.3, and reverses: v' = .06, u' = .2. Compression ends at 7.5 with u = 1, Wc = -(2.25 +
// 1.5)/2. Restitution: v+ = sqrt(.06 2 .64 1.5), tau1 = 7.5 + v+/.06.
TEST(SceneOutcomeTest, SlipReversesBeneathAPendulumOnARisingSurface) {
  const Outcome outcome = Solved(OnConveyor(0.1, 0.3, EnergeticCoefficient{0.8}));
  EXPECT_EQ(outcome.regime, Regime::kReversalInCompression);
  EXPECT_NEAR(*outcome.work.normal_compression_j, -1.875, kTight);
  const double v = std::sqrt(0.06 * 2.0 * 0.64 * 1.875);
  EXPECT_NEAR(outcome.contact_velocity_after.normal_m_s, v, kTight);
  EXPECT_NEAR(outcome.impulse.normal_total_n_s, 7.5 + v / 0.06, 16 * kTight);
  EXPECT_NEAR(outcome.contact_velocity_after.tangential_m_s[0], 1.0 + v / 0.3, 4 * kTight);
}

// mu Wtn = Wnn: slip stops at tau = 1/.6 with v = -.3, and the surface goes on rising at that speed.
TEST(SceneOutcomeTest, APendulumThatFrictionHoldsAgainstARisingSurfaceJams) {
  const Outcome outcome = Solved(OnConveyor(0.31, 0.3, EnergeticCoefficient{0.8}));
  EXPECT_EQ(outcome.regime, Regime::kWedged);
  EXPECT_EQ(outcome.termination, Termination::kRefused);
  EXPECT_EQ(outcome.accuracy.relative_error, INFINITY);
  EXPECT_EQ(outcome.contact_velocity_after.tangential_m_s[0], 0.0);
  EXPECT_NEAR(outcome.contact_velocity_after.normal_m_s, -0.3, kTight);
  EXPECT_NEAR(outcome.impulse.normal_total_n_s, 1.0 / 0.61, kTight);
  EXPECT_NEAR(outcome.rates_after_rad_s[0], 0.0, kTight);
  EXPECT_EQ(outcome.coefficients.newton, 0.0);
  ASSERT_THAT(outcome.notes, SizeIs(1));
  EXPECT_EQ(outcome.notes[0].kind, NoteKind::kUndetermined);
  EXPECT_THAT(outcome.notes[0].text, HasSubstr("while it approaches at 0.3"));
  EXPECT_THAT(LocalSolver().Bounds({.scene = OnConveyor(0.31, 0.3, std::monostate())}).status().message(),
              HasSubstr("has no end"));
}

// v0 = -.2: v' = .183, u' = .61. Compression ends at .2/.183; slip stops at 1/.61 with v = .1, which friction then
// keeps.
TEST(SceneOutcomeTest, APendulumThatFrictionHoldsOnAFallingSurfacePartsAtTheSpeedOfTheSurface) {
  const double tau_c = 0.2 / 0.183;
  const Outcome poisson = Solved(OnConveyor(0.31, -0.1, PoissonCoefficient{0.8}));
  EXPECT_EQ(poisson.regime, Regime::kStickInRestitution);
  EXPECT_NEAR(poisson.contact_velocity_after.normal_m_s, 0.1, kTight);
  EXPECT_NEAR(poisson.impulse.normal_total_n_s, 1.8 * tau_c, kTight);
  const Outcome energetic = Solved(OnConveyor(0.31, -0.1, EnergeticCoefficient{0.8}));
  EXPECT_NEAR(energetic.contact_velocity_after.normal_m_s, 0.1, kTight);
  const double stop = 1.0 / 0.61;
  EXPECT_NEAR(energetic.impulse.normal_total_n_s, stop + (0.64 * 0.1 * tau_c - 0.05 * (stop - tau_c)) / 0.1,
              4 * kTight);
  // Newton's coefficient asks for v = .16, which no impulse gives.
  const Outcome newton = Solved(OnConveyor(0.31, -0.1, NewtonCoefficient{0.8}));
  EXPECT_EQ(newton.termination, Termination::kRefused);
  EXPECT_THAT(newton.notes[0].text, HasSubstr("while it parts at"));
}

// Each event has the rates that go with its contact velocity (b w, a w), from those before to those after the impact.
TEST(SceneOutcomeTest, EventsOfAnImpactInTimeHaveTheRatesOfThePendulum) {
  constexpr double kA = 0.6;
  constexpr double kB = 0.25;
  Scene scene = With(Pendulum{1.3, kA, kB, -2.0}, 0.1, EnergeticCoefficient{0.8});
  scene.compliance = Compliance{.normal = HertzSpring{1e5}};
  scene.finite_forces = PinMoment{-20.0};
  const Outcome outcome = SolvedTo(scene, {.required = {Effect::kFiniteDuration}});
  ASSERT_GE(outcome.timeline.size(), 3U);
  for (const Event& event : outcome.timeline) {
    ASSERT_THAT(event.state.rates_rad_s, SizeIs(1));
    EXPECT_NEAR(kA * event.state.rates_rad_s[0], event.state.contact_velocity.normal_m_s, 1e-9);
  }
  EXPECT_EQ(outcome.timeline.front().state.rates_rad_s[0], -2.0);
  EXPECT_EQ(outcome.timeline.back().state.rates_rad_s, outcome.rates_after_rad_s);
}

// Without finite forces and rigid along t, an impact that takes time ends as one that takes none, for any spring. A
// tangential compliance of 1e-6 of the normal one changes velocities by a small multiple of its root.
TEST(SceneOutcomeTest, SpringsAgreeWithRigidContactBesideTheRange) {
  int jams = 0;
  for (const double mu : {0.0, 0.1, 0.2, 0.31, 0.6}) {
    for (const double normal : {0.3, 0.05, -0.1}) {
      for (const double tangential : {-2.0, -0.5, 0.5}) {
        Scene scene = OnConveyor(mu, normal, EnergeticCoefficient{0.8});
        scene.surface_velocity->tangential_m_s = {tangential};
        const Outcome rigid = Solved(scene);
        const std::string what = testing::PrintToString(std::vector<double>{mu, normal, tangential});
        scene.compliance = Compliance{.normal = LinearSpring{1e4}};
        const absl::StatusOr<SolveResponse> timed =
            LocalSolver().Solve({.scene = scene, .demand = {.required = {Effect::kFiniteDuration}}});
        ASSERT_TRUE(timed.ok()) << timed.status();
        scene.compliance = Compliance{.tangential_ratio_squared = 1e-6};
        const Outcome compliant = Solved(scene);
        if (rigid.termination != Termination::kConverged) {
          ++jams;
          EXPECT_NE(timed->outcome.termination, Termination::kConverged) << what;
          EXPECT_NE(compliant.termination, Termination::kConverged) << what;
          continue;
        }
        for (const auto& [outcome, tolerance] : {std::pair(timed->outcome, 1e-9), std::pair(compliant, 0.05)}) {
          EXPECT_EQ(outcome.termination, Termination::kConverged) << what;
          EXPECT_NEAR(outcome.contact_velocity_after.normal_m_s, rigid.contact_velocity_after.normal_m_s, tolerance)
              << what;
          EXPECT_NEAR(outcome.contact_velocity_after.tangential_m_s[0], rigid.contact_velocity_after.tangential_m_s[0],
                      tolerance)
              << what;
          EXPECT_NEAR(outcome.work.residual_j, 0.0, 1e-9) << what;
        }
      }
    }
  }
  EXPECT_GT(jams, 3);
}

// Solves a contact on a tangential spring; the numbers are Wtt, Wtn, Wnn, u0, mu and eta, and v0 = -1.
Outcome OnSpring(const std::array<double, 6>& numbers, double ratio_squared) {
  const auto [tt, tn, nn, u0, mu, eta] = numbers;
  Scene scene = With(PlanarContact{tt, tn, nn, u0, -1.0}, mu, EnergeticCoefficient{eta});
  scene.compliance = Compliance{.tangential_ratio_squared = ratio_squared};
  const absl::StatusOr<SolveResponse> response =
      LocalSolver().Solve({.scene = scene, .demand = {.required = {Effect::kTangentialCompliance}}});
  EXPECT_TRUE(response.ok()) << response.status();
  return response.ok() ? response->outcome : Outcome();
}

TEST(SceneOutcomeTest, CompressionOnASpringEndsOnce) {
  using enum EventKind;
  const auto kinds = [](const Outcome& outcome) {
    std::vector<EventKind> all;
    for (const Event& event : outcome.timeline) all.push_back(event.kind);
    return all;
  };
  const Outcome plastic = OnSpring({3.5, 0.4, 1.0, 0.7, 0.5, 0.0}, 1.2);
  EXPECT_THAT(kinds(plastic), ElementsAre(kStart, kStickStarts, kCompressionEnds, kRestitutionEnds));
  EXPECT_EQ(plastic.timeline[2].state.normal_impulse_n_s, plastic.impulse.normal_total_n_s);
  for (const double eta : {1e-60, 1e-30, 1e-17, 1e-16, 1e-15}) {
    EXPECT_THAT(kinds(OnSpring({2.0, 0.3, 1.0, 0.2, 0.5, eta}, 1.2)), Contains(kCompressionEnds).Times(1)) << eta;
  }
  EXPECT_THAT(kinds(OnSpring({1.2, 0.6, 1.0, -0.3, 0.0, 0.5}, 1.2)),
              ElementsAre(kStart, kCompressionEnds, kRestitutionEnds));
}

TEST(SceneOutcomeTest, ATimelineThatIsCutSaysSo) {
  const Outcome outcome = OnSpring({3.5, 0.0, 1.0, 1.0, 0.9, 0.6}, 1e-9);
  EXPECT_THAT(outcome.timeline, SizeIs(8192));
  EXPECT_EQ(outcome.timeline.back().kind, EventKind::kRestitutionEnds);
  ASSERT_THAT(outcome.notes, SizeIs(1));
  EXPECT_EQ(outcome.notes[0].kind, NoteKind::kTimelineCut);
  EXPECT_THAT(OnSpring({3.5, 0.0, 1.0, 1.0, 0.9, 0.6}, 1e-6).notes, IsEmpty());
}

// Newton's coefficient is .9728 of a small energetic one here (mode by mode, in 36 digits).
TEST(SceneOutcomeTest, ACoefficientThatIsTooSmallToComputeIsInTheErrors) {
  const Outcome outcome = OnSpring({2.0, 0.3, 1.0, 0.2, 0.5, 1e-100}, 1.2);
  ASSERT_TRUE(outcome.errors.newton.has_value() && outcome.errors.normal_m_s.has_value());
  EXPECT_GE(*outcome.errors.newton, std::fabs(0.9728e-100 - outcome.coefficients.newton));
  EXPECT_LE(*outcome.errors.newton, 1e-97);
  EXPECT_GE(*outcome.errors.normal_m_s, std::fabs(0.9728e-100 - outcome.contact_velocity_after.normal_m_s));
}

// A slider on a guide along n: the surface passes below it, and friction rubs without moving it.
TEST(SceneOutcomeTest, FrictionRubsOnASliderThatItCannotMove) {
  const Outcome outcome = Solved(With(PlanarContact{0.0, 0.0, 1.0, 2.0, -1.0}, 0.3, EnergeticCoefficient{0.5}));
  EXPECT_EQ(outcome.regime, Regime::kSliding);
  EXPECT_EQ(outcome.contact_velocity_after.tangential_m_s[0], 2.0);
  EXPECT_NEAR(outcome.impulse.tangential_n_s[0], -0.45, kTight);
  EXPECT_NEAR(outcome.work.friction_dissipation_j, 0.9, kTight);
  EXPECT_NEAR(outcome.energy_change_j, -0.9 - 0.375, kTight);
  EXPECT_THAT(outcome.notes, IsEmpty());
}

TEST(SceneOutcomeTest, FrictionThatCouldBeAnyIsNamed) {
  const Outcome contact = Solved(With(PlanarContact{0.0, 0.0, 1.0, 0.0, -1.0}, 0.3, EnergeticCoefficient{0.5}));
  ASSERT_THAT(contact.notes, SizeIs(1));
  EXPECT_EQ(contact.notes[0].path, "impulse.tangential_n_s");
  EXPECT_THAT(Solved(With(Pendulum{1.0, 1.0, 0.0, -1.0}, 0.3, EnergeticCoefficient{0.5})).notes, SizeIs(1));
  EXPECT_THAT(Solved(With(Pendulum{1.0, 1.0, 0.0, -1.0}, 0.0, EnergeticCoefficient{0.5})).notes, IsEmpty());
}

// ---- In space ----

// True if the impact was followed to its end. Beside the range of a singular W its estimated error, near 2^-25, is
// above the default tolerance, although these tests find errors below 1e-10.
bool Ends(const Outcome& outcome) {
  return outcome.termination == Termination::kConverged || outcome.termination == Termination::kLessAccurate;
}

// W = diag(1, 0, 1): u2 = .5 stays, v' = 1, and u1' = -mu u1/|u|, so that F(u) = sqrt(u^2 + .25) - .5 asinh(.5/u) falls
// by mu tau1 = .45.
TEST(SceneOutcomeTest, SlipThatNoImpulseReachesGoesOnInSpace) {
  const Outcome outcome =
      Solved(With(SpatialContact{{1, 0, 0, 0, 0, 1}, {1.0, 0.5}, -1.0}, 0.3, EnergeticCoefficient{0.5}));
  const auto f = [](double u) { return std::sqrt(u * u + 0.25) - 0.5 * std::asinh(0.5 / u); };
  EXPECT_TRUE(Ends(outcome));
  EXPECT_NEAR(outcome.contact_velocity_after.normal_m_s, 0.5, 1e-11);
  EXPECT_NEAR(outcome.contact_velocity_after.tangential_m_s[1], 0.5, 1e-11);
  EXPECT_NEAR(f(outcome.contact_velocity_after.tangential_m_s[0]), f(1.0) - 0.45, 1e-10);
  EXPECT_EQ(outcome.w_rank, 2);
}

TEST(SceneOutcomeTest, FrictionRubsOnASliderInSpace) {
  for (const double u2 : {0.0, 1.5}) {
    const Outcome outcome =
        Solved(With(SpatialContact{{0, 0, 0, 0, 0, 1}, {2.0, u2}, -1.0}, 0.3, EnergeticCoefficient{0.5}));
    const double slip = std::hypot(2.0, u2);
    EXPECT_EQ(outcome.regime, Regime::kSliding);
    EXPECT_LE(outcome.accuracy.relative_error, 1e-12);
    EXPECT_NEAR(outcome.impulse.tangential_n_s[0], -0.45 * 2.0 / slip, kTight);
    EXPECT_NEAR(outcome.impulse.tangential_n_s[1], -0.45 * u2 / slip, kTight);
    EXPECT_NEAR(outcome.work.friction_dissipation_j, 0.45 * slip, kTight);
  }
}

// The pendulum of the plane above, seen in space along a slanted t.
TEST(SceneOutcomeTest, APlanarMechanismBesideItsRangeIsTheSameInSpace) {
  const double c = 0.6, s = 0.8;
  for (const double mu : {0.0, 0.1, 0.31}) {
    for (const double v0 : {-0.6, -0.2}) {
      const Outcome plane = Solved(With(PlanarContact{1.0, 0.3, 0.09, -1.0, v0}, mu, EnergeticCoefficient{0.8}));
      const Outcome space = Solved(With(SpatialContact{{c * c, c * s, 0.3 * c, s * s, 0.3 * s, 0.09}, {-c, -s}, v0}, mu,
                                        EnergeticCoefficient{0.8}));
      EXPECT_EQ(space.regime, plane.regime) << mu << " " << v0;
      EXPECT_EQ(Ends(space), Ends(plane)) << mu << " " << v0;
      const double u = plane.contact_velocity_after.tangential_m_s[0];
      EXPECT_NEAR(space.contact_velocity_after.tangential_m_s[0], c * u, 1e-11) << mu << " " << v0;
      EXPECT_NEAR(space.contact_velocity_after.tangential_m_s[1], s * u, 1e-11) << mu << " " << v0;
      EXPECT_NEAR(space.contact_velocity_after.normal_m_s, plane.contact_velocity_after.normal_m_s, 1e-11);
      EXPECT_NEAR(space.impulse.normal_total_n_s, plane.impulse.normal_total_n_s, 1e-9) << mu << " " << v0;
    }
  }
}

// The joint moves along (.6, .3) in (t1, n), and the surface passes along t2 at c: slip turns until friction along t1
// balances the joint, mu .6 cos(phi) = .3. If v < 0 there, nothing ends the impact.
TEST(SceneOutcomeTest, SlipThatStandsStillHoldsItsVelocityInSpace) {
  const auto scene = [](double v0, double across) {
    return With(SpatialContact{{0.36, 0, 0.18, 0, 0, 0.09}, {-1.0, across}, v0}, 1.0, EnergeticCoefficient{0.8});
  };
  for (const double across : {0.3, 1e-3, 1e-9}) {
    // cos(phi) = .5: u1 = across/sqrt(3) where slip stands, and v = v0 + .5 (u1 + 1).
    const Outcome jams = Solved(scene(-0.9, across));
    EXPECT_EQ(jams.termination, Termination::kRefused) << across;
    EXPECT_EQ(jams.regime, Regime::kWedged) << across;
    EXPECT_NEAR(jams.contact_velocity_after.tangential_m_s[0], across / std::sqrt(3.0), 1e-8) << across;
    EXPECT_THAT(jams.notes, SizeIs(1)) << across;
    const Outcome parts = Solved(scene(-0.2, across));
    EXPECT_TRUE(Ends(parts)) << across;
    const double u1 = parts.contact_velocity_after.tangential_m_s[0];
    EXPECT_NEAR(parts.contact_velocity_after.normal_m_s, -0.2 + 0.5 * (u1 + 1.0), 1e-10) << across;
    EXPECT_NEAR(parts.contact_velocity_after.tangential_m_s[1], across, 1e-10) << across;
  }
}

// Follows slip by Runge and Kutta's method of fourth order, which shares nothing with the model.
struct RungeKutta {
  std::array<double, 6> w;  // 11, 12, 13, 22, 23, 33
  double mu;
  std::array<double, 3> y;  // u1, u2, v
  double least_slip = INFINITY;

  std::array<double, 3> Rates(const std::array<double, 3>& at) const {
    const double slip = std::hypot(at[0], at[1]);
    const double f1 = -mu * at[0] / slip;
    const double f2 = -mu * at[1] / slip;
    return {w[0] * f1 + w[1] * f2 + w[2], w[1] * f1 + w[3] * f2 + w[4], w[2] * f1 + w[4] * f2 + w[5]};
  }
  void Step(double h) {
    const auto moved = [&](const std::array<double, 3>& rate, double by) {
      return std::array<double, 3>{y[0] + by * rate[0], y[1] + by * rate[1], y[2] + by * rate[2]};
    };
    const auto a = Rates(y), b = Rates(moved(a, h / 2)), c = Rates(moved(b, h / 2)), d = Rates(moved(c, h));
    for (size_t i = 0; i < 3; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    least_slip = std::min(least_slip, std::hypot(y[0], y[1]));
  }
  void Advance(double tau, int steps) {
    for (int i = 0; i < steps; ++i) Step(tau / steps);
  }
};

// W has rank one, or rank two with or without a singular Wtt, and the velocity is any.
TEST(SceneOutcomeTest, SlipBesideTheRangeOfWAgreesWithRungeAndKutta) {
  std::mt19937_64 random(1901);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    std::array<double, 6> w = {};
    const auto add = [&](double x, double y, double z) {
      w = {w[0] + x * x, w[1] + x * y, w[2] + x * z, w[3] + y * y, w[4] + y * z, w[5] + z * z};
    };
    add(uniform(-1, 1), uniform(-1, 1), uniform(0.3, 1));
    if (i % 3 == 1) add(0.0, 0.0, uniform(0.3, 1));
    if (i % 3 == 2) add(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    const std::array<double, 2> u0 = {uniform(-2, 2), uniform(-2, 2)};
    const double v0 = -uniform(0.2, 2);
    const double mu = uniform(0.05, 0.8);
    const double kappa = uniform(0.0, 1.0);
    RungeKutta path = {.w = w, .mu = mu, .y = {u0[0], u0[1], v0}};
    double tau = 0.0;
    constexpr double kStep = 1e-3;
    while (path.y[2] < 0.0 && tau < 50.0) path.Step(kStep), tau += kStep;
    if (path.y[2] < 0.0) continue;
    for (int newton = 0; newton < 3; ++newton) {
      const double back = -path.y[2] / path.Rates(path.y)[2];
      path.Step(back), tau += back;
    }
    path.Advance(kappa * tau, 4000);
    if (path.least_slip < 0.1 || path.y[2] < 0.0) continue;
    ++compared;
    const SpatialContact contact = {{w.begin(), w.end()}, {u0.begin(), u0.end()}, v0};
    const Outcome outcome = Solved(With(contact, mu, PoissonCoefficient{kappa}));
    EXPECT_LT(outcome.w_rank, 3);
    EXPECT_TRUE(Ends(outcome)) << i;
    EXPECT_NEAR(outcome.contact_velocity_after.tangential_m_s[0], path.y[0], 1e-9) << i;
    EXPECT_NEAR(outcome.contact_velocity_after.tangential_m_s[1], path.y[1], 1e-9) << i;
    EXPECT_NEAR(outcome.contact_velocity_after.normal_m_s, path.y[2], 1e-9) << i;
    EXPECT_NEAR(*outcome.impulse.normal_compression_n_s, tau, 1e-9 * tau) << i;
    EXPECT_NEAR(outcome.work.residual_j, 0.0, 1e-11) << i;
  }
  EXPECT_GT(compared, 150);
}

}  // namespace
}  // namespace ricochet
