// The promises of every Solver (ricochet/solver.h), tested for LocalSolver and Client.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "core/rows/axis_values.h"
#include "core/scene/field.h"
#include "ricochet/engine_info.h"
#include "tests/contract/solvers.h"
#include "tests/support/scenes/multi_contact_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::Field;

class SolverContract : public testing::TestWithParam<std::string> {
 protected:
  const Solver& solver() const { return GetParam() == "Local" ? Local() : Remote(); }
};

INSTANTIATE_TEST_SUITE_P(Solvers, SolverContract, testing::Values("Local", "Remote"),
                         [](const auto& parameter) { return parameter.param; });

SweepRequest FrictionSweep(int64_t count) {
  SweepRequest request;
  request.grid.scene = PaperScene();
  request.grid.axes = {{"friction.kinetic_coefficient", Linspace{0.0, 0.4, count}}};
  request.columns = {"coefficients.newton", "coefficients.poisson"};
  return request;
}

TEST_P(SolverContract, SolvesThePapersExample) {
  const auto response = solver().Solve({.scene = PaperScene(), .history_at_n_s = {}});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->outcome.regime, Regime::kRebound);
  EXPECT_NEAR(response->outcome.coefficients.newton, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(*response->outcome.coefficients.poisson, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(response->outcome.coefficients.tangential, -0.0172, 5e-5);
}

TEST_P(SolverContract, ASurfaceThatOnlyRisesNeedsNoTangentialVelocity) {
  for (const System& system : Systems()) {
    if (std::holds_alternative<BodyPair>(system)) continue;
    const size_t directions = TangentialDirections(system);
    Scene stated = With(system);
    stated.surface_velocity = SurfaceVelocity{std::vector<double>(directions, 0.0), 0.25};
    Scene left_out = stated;
    left_out.surface_velocity->tangential_m_s.clear();
    const bool has_certificate = directions == 1 && !std::holds_alternative<Mechanism>(system);
    const int32_t digits = has_certificate ? 10 : 0;
    const auto wanted = solver().Solve({.scene = stated, .certified_digits = digits});
    const auto found = solver().Solve({.scene = left_out, .certified_digits = digits});
    ASSERT_TRUE(wanted.ok() && found.ok()) << found.status();
    EXPECT_EQ(found->outcome, wanted->outcome);
    const Grid grid = {.scene = left_out, .axes = {{"surface_velocity.tangential_m_s[0]", ListValues{{0.0}}}}};
    for (const auto& chunk : solver().Sweep({.grid = grid, .columns = {"coefficients.newton"}})) {
      ASSERT_TRUE(chunk.ok()) << chunk.status();
      EXPECT_THAT(chunk->values, ElementsAre(wanted->outcome.coefficients.newton));
    }
    if (directions > 1) continue;
    const std::vector<FieldRange> ranges = {{"friction.kinetic_coefficient", 0.4, 0.5}};
    EXPECT_EQ(solver().Bounds({.scene = left_out, .ranges = ranges})->enclosure,
              solver().Bounds({.scene = stated, .ranges = ranges})->enclosure);
  }
}

TEST_P(SolverContract, SaysWhetherTheOrderOfSeveralImpactsMatters) {
  const auto response = solver().MultiContact({.scene = FallingBlock(1.0, 0.5)});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->engine, ThisEngine());
  ASSERT_EQ(response->answers.size(), 1U);
  const MultiContactAnswer& answer = response->answers.front();
  EXPECT_EQ(answer.verdict, MultiContactVerdict::kOrderMatters);
  EXPECT_THAT(answer.orders, ElementsAre(Field(&AttainedOutcome::orders, ElementsAre("1")),
                                         Field(&AttainedOutcome::orders, ElementsAre("2"))));
  EXPECT_NEAR(answer.springs->velocity[1], 0.5, 1e-15);
  EXPECT_TRUE(answer.refused.empty());
}

TEST_P(SolverContract, AnswersEachStateOfSeveralContacts) {
  const auto response =
      solver().MultiContact({.scene = FallingBlock(1.0, 0.5), .states = {{{0, -1, 0}}, {{0, -2, 0}}, {{0, 1, 0}}}});
  ASSERT_TRUE(response.ok()) << response.status();
  ASSERT_EQ(response->answers.size(), 3U);
  EXPECT_NEAR(response->answers[1].springs->velocity[1], 1.0, 1e-15);
  EXPECT_EQ(response->answers[2].verdict, MultiContactVerdict::kSingle);
  EXPECT_EQ(response->answers[2].orders.front().orders.front(), "none");
}

// One call of a server takes 512 states of two contacts.
TEST_P(SolverContract, AnswersMoreStatesThanOneCallTakes) {
  MultiContactRequest request = {.scene = FallingBlock(1.0, 0.5), .methods = {MultiContactMethod::kSprings}};
  for (int i = 0; i < 1300; ++i) request.states.push_back({{0, -0.01 * (i + 1), 0}});
  const auto response = solver().MultiContact(request);
  ASSERT_TRUE(response.ok()) << response.status();
  ASSERT_EQ(response->answers.size(), 1300U);
  for (int i = 0; i < 1300; ++i) {
    ASSERT_NEAR(response->answers[static_cast<size_t>(i)].springs->velocity[1], 0.005 * (i + 1), 1e-14) << i;
  }
  request.states[1100] = {{1.0}};
  EXPECT_THAT(ViolationsOf(solver().MultiContact(request).status()),
              ElementsAre(Field(&Violation::field, testing::StartsWith("states[1100]"))));
}

TEST_P(SolverContract, ListsAllViolationsOfSeveralContacts) {
  MultiContactRequest request = {.scene = FallingBlock(-1.0, 2.0)};
  request.scene.contacts.back() = {.body = 3, .other_body = 3, .point_m = {0.0}, .normal = {0.0, 0.0}};
  request.states = {{{1.0}}};
  EXPECT_THAT(
      ViolationsOf(solver().MultiContact(request).status()),
      ElementsAre(Field(&Violation::field, "contacts[0].friction"), Field(&Violation::field, "contacts[0].energetic"),
                  Field(&Violation::field, "contacts[1].energetic"), Field(&Violation::field, "contacts[1].body"),
                  Field(&Violation::field, "contacts[1].other_body"),
                  Field(&Violation::field, "contacts[1].other_body"), Field(&Violation::field, "contacts[1].point_m"),
                  Field(&Violation::field, "contacts[1].normal")));
}

TEST_P(SolverContract, SaysWhichEngineAnswered) {
  const auto response = solver().Solve({.scene = PaperScene(), .history_at_n_s = {}});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->engine, ThisEngine());
}

TEST_P(SolverContract, InfoNamesTheEngineAndWhatItCanCompute) {
  const auto info = solver().Info();
  ASSERT_TRUE(info.ok()) << info.status();
  EXPECT_EQ(info->engine, ThisEngine());
  EXPECT_THAT(info->systems, ElementsAre("pendulum", "planar_body", "spatial_body", "body_pair", "linkage",
                                         "planar_contact", "spatial_contact", "mechanism"));
  EXPECT_THAT(info->models, testing::Contains(Model::kSpatial));
  EXPECT_THAT(info->models, testing::Not(testing::Contains(Model::kUnspecified)));
}

TEST_P(SolverContract, InfoSaysWhetherCertificatesCanBeComputed) {
  const auto info = solver().Info();
  ASSERT_TRUE(info.ok()) << info.status();
  EXPECT_EQ(solver().Solve({.scene = PaperScene(), .certified_digits = 10}).ok(), info->certified);
}

TEST_P(SolverContract, InfoStatesLimitsThatHold) {
  const auto info = solver().Info();
  ASSERT_TRUE(info.ok()) << info.status();
  SolveRequest request = {.scene = PaperScene()};
  request.scene.system = Linkage{std::vector<Link>(65, Link{1.0, 1.0, 0.5, 0.1, 0.3, -1.0})};
  const absl::Status status = solver().Solve(request).status();
  EXPECT_EQ(ReasonOf(status) == ErrorReason::kLimitExceeded, info->limits.max_links < 65) << status;
}

TEST_P(SolverContract, InfoEndsWithItsOptions) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(solver().Info({}, {.stop = stop.get_token()}).status().code(), absl::StatusCode::kCancelled);
}

TEST(SolverContract, OnlyAServerLimitsRequestsAndCalls) {
  const auto local = Local().Info();
  const auto remote = Remote().Info();
  ASSERT_TRUE(local.ok() && remote.ok());
  EXPECT_EQ(local->limits, Limits::None());
  EXPECT_FALSE(local->server_limits.has_value());
  EXPECT_EQ(remote->limits, Limits());
  ASSERT_TRUE(remote->server_limits.has_value());
  EXPECT_EQ(remote->server_limits->max_unary_time_ms, 60'000);
  EXPECT_EQ(remote->server_limits->max_stream_age_ms, 3'600'000);
}

TEST_P(SolverContract, BoundsNeedNoRestitution) {
  Scene scene = PaperScene();
  scene.restitution = std::monostate();
  const auto response = solver().Bounds({.scene = scene});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_NEAR(response->bounds.sharp.newton.upper, std::sqrt(0.5), 1e-15);
  EXPECT_EQ(solver().Solve({.scene = scene, .history_at_n_s = {}}).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST_P(SolverContract, BoundsHoldForEverySystem) {
  for (const System& system : Systems()) {
    const auto response = solver().Bounds({.scene = With(system)});
    ASSERT_TRUE(response.ok()) << response.status();
    EXPECT_EQ(response->bounds.sharp.energetic, (Range{0.0, 1.0}));
    EXPECT_EQ(response->bounds.energy_only.has_value(), !response->bounds.sampled);
    EXPECT_FALSE(response->enclosure.has_value());
  }
}

TEST_P(SolverContract, EnclosesAnUncertainScene) {
  const auto response =
      solver().Bounds({.scene = PaperScene(), .ranges = {{"friction.kinetic_coefficient", 0.09, 0.11}}});
  ASSERT_TRUE(response.ok()) << response.status();
  ASSERT_TRUE(response->enclosure.has_value());
  EXPECT_NEAR(response->enclosure->outer.newton.upper, std::sqrt(0.21 / 0.39), 1e-15);
  EXPECT_NEAR(response->enclosure->outer.poisson.upper, std::sqrt(0.41 / 0.19), 1e-15);
}

TEST_P(SolverContract, EnclosesUpToInfinityWhereFrictionMayLock) {
  const auto response =
      solver().Bounds({.scene = PaperScene(), .ranges = {{"friction.kinetic_coefficient", 0.1, 0.4}}});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_TRUE(std::isinf(response->enclosure->outer.poisson.upper));
}

TEST_P(SolverContract, RefusesRangesOfFieldsThatItCannotEnclose) {
  const absl::Status status =
      solver().Bounds({.scene = PaperScene(), .ranges = {{"restitution.energetic", 0.5, 0.6}}}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ViolationsOf(status), ElementsAre(Field(&Violation::field, "ranges[0].path")));
}

TEST_P(SolverContract, ReportsEveryViolationOfAScene) {
  Scene scene = PaperScene();
  std::get<Pendulum>(scene.system).a_m = 0.0;
  scene.friction.kinetic_coefficient = -0.1;
  scene.restitution = EnergeticCoefficient{1.5};
  const absl::Status status = solver().Solve({.scene = scene, .history_at_n_s = {}}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInvalidRequest);
  EXPECT_THAT(ViolationsOf(status), ElementsAre(Violation{"pendulum.a_m", "= 0: must be > 0"},
                                                Violation{"friction.kinetic_coefficient", "= -0.1: must be >= 0"},
                                                Violation{"restitution.energetic", "= 1.5: must be in [0, 1]"}));
}

TEST_P(SolverContract, PlansWhatASolveUses) {
  for (const System& system : Systems()) {
    Scene scene = With(system);
    scene.restitution = EnergeticCoefficient{0.5};
    const DemandFields demand = {.relative_tolerance = 1e-3};
    const auto planned = solver().Plan({.scene = scene, .demand = demand});
    ASSERT_TRUE(planned.ok()) << planned.status();
    const auto solved = solver().Solve({.scene = scene, .demand = demand});
    ASSERT_TRUE(solved.ok()) << solved.status();
    EXPECT_EQ(planned->plan, solved->outcome.plan);
    EXPECT_EQ(planned->engine, ThisEngine());
  }
}

TEST_P(SolverContract, APlanOfABadRequestReportsEveryViolation) {
  PlanRequest request = {.scene = PaperScene()};
  request.demand = {.relative_tolerance = 1.0, .required = {Effect::kSlipTurn}};
  EXPECT_THAT(ViolationsOf(solver().Plan(request).status()),
              ElementsAre(Field(&Violation::field, "relative_tolerance"), Field(&Violation::field, "required[0]")));
  request.scene.friction.kinetic_coefficient = -1.0;
  EXPECT_THAT(ViolationsOf(solver().Plan(request).status()),
              ElementsAre(Field(&Violation::field, "friction.kinetic_coefficient"),
                          Field(&Violation::field, "relative_tolerance")));
}

// Calls every method that answers once, and returns the errors.
std::vector<absl::Status> CallEach(const Solver& solver, const CallOptions& options) {
  const Scene scene = PaperScene();
  const Observed observed = ObservedRates{{0.5}};
  return {
      solver.Solve({.scene = scene}, options).status(),
      solver.Plan({.scene = scene}, options).status(),
      solver.Bounds({.scene = scene}, options).status(),
      solver.Audit({.scene = scene, .observed = observed}, options).status(),
      solver
          .AuditBatch({.scene = scene, .columns = {.tangential_after_m_s = {0.5}, .normal_after_m_s = {0.15}}}, options)
          .status(),
      Collect(solver.Sweep(FrictionSweep(1000), options)).back().status()};
}

TEST_P(SolverContract, EveryMethodEndsOnceItsOptionsSayStop) {
  std::stop_source stop;
  stop.request_stop();
  for (const CallOptions& options :
       {CallOptions{.stop = stop.get_token()}, CallOptions{.is_stopped = [] { return true; }}}) {
    for (const absl::Status& status : CallEach(solver(), options)) {
      EXPECT_EQ(status, absl::CancelledError("the call was stopped by its caller"));
    }
  }
}

TEST_P(SolverContract, EveryMethodEndsAtItsDeadline) {
  const auto now = std::chrono::steady_clock::now();
  for (const auto past : {now - std::chrono::seconds(1), std::chrono::steady_clock::time_point::min()}) {
    for (const absl::Status& status : CallEach(solver(), {.deadline = past})) {
      EXPECT_EQ(status.code(), absl::StatusCode::kDeadlineExceeded) << status;
    }
  }
}

TEST_P(SolverContract, NumbersThatNameNoEffectAreRefused) {
  for (const int number : {9, 33, 77, -5}) {
    SolveRequest request = {.scene = With(PlanarContact{2.5, 1.5, 2.5, -1.0, -1.0})};
    request.demand.excluded = {static_cast<Effect>(number)};
    EXPECT_EQ(solver().Solve(request).status().code(), absl::StatusCode::kInvalidArgument) << number;
    request.demand = {.required = {static_cast<Effect>(number)}};
    EXPECT_EQ(solver().Solve(request).status().code(), absl::StatusCode::kInvalidArgument) << number;
  }
}

TEST_P(SolverContract, OptionsThatNeverStopChangeNothing) {
  const std::stop_source stop;
  const CallOptions options = {.stop = stop.get_token(),
                               .deadline = std::chrono::steady_clock::time_point::max(),
                               .is_stopped = [] { return false; }};
  for (const absl::Status& status : CallEach(solver(), options)) EXPECT_TRUE(status.ok()) << status;
}

TEST_P(SolverContract, ALongSearchEndsAtItsDeadlineOrAStop) {
  const Scene scene = {.system = PlanarBody{1.0, 0.1, 0.2, -0.3, 1.0, -2.0, 0.5},
                       .friction = {.kinetic_coefficient = 0.5}};
  const BoundsRequest request = {.scene = scene,
                                 .ranges = {{"planar_body.mass_kg", 0.5, 2.0},
                                            {"planar_body.inertia_com_kg_m2", 0.05, 0.2},
                                            {"planar_body.offset_t_m", 0.1, 0.3},
                                            {"planar_body.offset_n_m", -0.4, -0.2},
                                            {"planar_body.rate_rad_s", 0.25, 0.75},
                                            {"friction.kinetic_coefficient", 0.3, 0.7}}};
  const auto start = std::chrono::steady_clock::now();
  const CallOptions options = {.deadline = start + std::chrono::milliseconds(50)};
  EXPECT_EQ(solver().Bounds(request, options).status().code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  std::stop_source stop;
  const std::jthread stopper([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop.request_stop();
  });
  EXPECT_EQ(solver().Bounds(request, {.stop = stop.get_token()}).status().code(), absl::StatusCode::kCancelled);
}

TEST_P(SolverContract, AnswersAnInadmissibleOutcomeUnlessAskedNotTo) {
  SolveRequest request{.scene = PaperScene(), .history_at_n_s = {}};
  request.scene.restitution = NewtonCoefficient{0.9};
  const auto response = solver().Solve(request);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_FALSE(response->outcome.admissible);
  request.inadmissible_is_error = true;
  const absl::Status status = solver().Solve(request).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInadmissibleOutcome);
}

TEST_P(SolverContract, RefusesAResultAboveTheLargestDouble) {
  Scene scene = PaperScene();
  std::get<Pendulum>(scene.system).inertia_kg_m2 = 1e308;
  std::get<Pendulum>(scene.system).omega_minus_rad_s = -1e10;
  const absl::Status status = solver().Solve({.scene = scene, .history_at_n_s = {}}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kOutOfRange);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kOutputOverflow);
}

TEST_P(SolverContract, AnswersTheLongestHistory) {
  SolveRequest request{.scene = PaperScene(), .history_at_n_s = std::vector<double>(65536, 1.0)};
  const auto response = solver().Solve(request);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->outcome.history.size(), 65536);
  EXPECT_EQ(response->outcome.history.back(), response->outcome.history.front());
}

TEST_P(SolverContract, RefusesAHistoryOutsideTheImpact) {
  const absl::Status status = solver().Solve({.scene = PaperScene(), .history_at_n_s = {0.0, 100.0}}).status();
  ASSERT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ViolationsOf(status), ElementsAre(Field(&Violation::field, "history_at_n_s[1]")));
}

TEST_P(SolverContract, MechanismsHaveTheBitsOfTheEngineAtBothEnds) {
  for (const bool in_space : {false, true}) {
    Mechanism arm = Arm(in_space);
    arm.kept_coordinates = {2};
    const SolveRequest request = {.scene = With(arm), .both_ends = true};
    const auto response = solver().Solve(request);
    ASSERT_TRUE(response.ok()) << response.status();
    EXPECT_EQ(*response, *LocalSolver().Solve(request));
    ASSERT_TRUE(response->outcome.free_end.has_value());
    EXPECT_EQ(response->outcome.errors.rates_after.size(), 3U);
  }
}

TEST_P(SolverContract, StrictJudgesTheEndWithNothingHeldToo) {
  Scene scene = With(Mechanism{.mass_matrix = {3.5, -1.26, 0.49, -1.26, 2.45, -0.61, 0.49, -0.61, 3.72},
                               .jacobian = {1.4, 0.34, -0.62, 0.9, 1.69, 1.25},
                               .rates = {-0.42, -0.32, -0.09},
                               .kept_coordinates = {0}});
  scene.friction.kinetic_coefficient = 0.6;
  scene.restitution = NewtonCoefficient{0.9};
  SolveRequest request = {.scene = scene, .inadmissible_is_error = true};
  EXPECT_TRUE(solver().Solve(request).ok());
  request.both_ends = true;
  const absl::Status status = solver().Solve(request).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(status.message()),
              testing::HasSubstr("with no coordinate held is inadmissible: its energetic"));
}

TEST_P(SolverContract, RefusesBothEndsOfAMechanismThatHoldsNothing) {
  const absl::Status status = solver().Solve({.scene = With(Arm()), .both_ends = true}).status();
  ASSERT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ViolationsOf(status), ElementsAre(Field(&Violation::field, "both_ends")));
}

TEST_P(SolverContract, DerivativesHaveTheBitsOfTheEngine) {
  Scene scene = With(Flat());
  scene.friction.kinetic_coefficient = 0.3;
  const DerivativePaths paths = {
      .of = {"bodies_after[0].angular_rad_s[0]", "work.friction_dissipation_j"},
      .by = {"friction.kinetic_coefficient", "friction.static_coefficient", "planar_body.offset_t_m"},
      .find_thresholds = true};
  const SolveRequest request = {.scene = scene, .derivatives = paths};
  const auto response = solver().Solve(request);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(*response, *LocalSolver().Solve(request));
  ASSERT_EQ(response->outcome.derivatives.size(), 6U);
  EXPECT_EQ(response->outcome.derivatives[0].kind, DerivativeKind::kTwoSided);
  EXPECT_EQ(response->outcome.derivatives[1].threshold, Threshold::kDomain);  // Below it would be less than kinetic.
  EXPECT_EQ(response->outcome.derivatives[1].below, (NearThreshold{Threshold::kDomain, 0.0}));
}

TEST_P(SolverContract, DerivativesOfBoundsHaveTheBitsOfTheEngine) {
  const BoundsRequest request = {
      .scene = PaperScene(),
      .derivatives = DerivativePaths{.of = {"sharp.newton.upper", "critical.stick"},
                                     .by = {"friction.kinetic_coefficient", "pendulum.b_m"}}};
  const auto response = solver().Bounds(request);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(*response, *LocalSolver().Bounds(request));
  ASSERT_EQ(response->derivatives.size(), 4U);
  EXPECT_EQ(response->derivatives[2].value, 0.0);  // What friction would hold the contact does not depend on friction.
}

TEST_P(SolverContract, RefusesDerivativesThatDoNotExist) {
  const DerivativePaths paths = {.of = {"w_rank"}, .by = {"pendulum.mass_kg"}};
  const absl::Status status = solver().Solve({.scene = PaperScene(), .derivatives = paths}).status();
  ASSERT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ViolationsOf(status), ElementsAre(Field(&Violation::field, "derivatives.of[0]"),
                                                Field(&Violation::field, "derivatives.by[0]")));
}

// Two rods of 1 m and 1 kg, hinged, at 20 and 30 degrees: Kane and Levinson (1985).
Scene KanesScene() {
  constexpr double kDegree = 0.017453292519943295;
  const Link rod = {.length_m = 1.0, .mass_kg = 1.0, .com_m = 0.5, .inertia_com_kg_m2 = 1.0 / 12.0};
  Linkage linkage{{rod, rod}};
  linkage.links[0].theta_rad = 20.0 * kDegree;
  linkage.links[0].rate_rad_s = -0.1;
  linkage.links[1].theta_rad = 30.0 * kDegree;
  linkage.links[1].rate_rad_s = -0.2;
  return {.system = linkage, .friction = {.kinetic_coefficient = 0.7}, .restitution = NewtonCoefficient{1.0}};
}

TEST_P(SolverContract, AuditFindsKanesParadoxInRates) {
  Scene scene = KanesScene();
  const auto solved = solver().Solve({.scene = scene, .history_at_n_s = {}});
  ASSERT_TRUE(solved.ok()) << solved.status();
  scene.restitution = std::monostate();
  const auto audit = solver().Audit({.scene = scene, .observed = ObservedRates{solved->outcome.rates_after_rad_s}});
  ASSERT_TRUE(audit.ok()) << audit.status();
  const AuditReport& report = audit->report;
  EXPECT_NEAR(report.energy_change / audit->contact_energy_j, 5.35, 0.005);
  // All of the kinetic energy, since the contact has as many directions as the system has links:
  // m l^2 (4/3 w1^2 + 1/3 w2^2 + w1 w2 cos 10 deg)/2.
  EXPECT_NEAR(audit->contact_energy_j, 0.5 * (0.04 / 3.0 + 0.04 / 3.0 + 0.02 * std::cos(std::acos(-1.0) / 18.0)),
              1e-15);
  EXPECT_NEAR(report.newton, 1.0, 1e-12);
  EXPECT_FALSE(report.admissible);
  EXPECT_EQ(report[AuditLimit::kEnergy].verdict, Verdict::kBroken);
  EXPECT_EQ(report[AuditLimit::kSharp].verdict, Verdict::kBroken);
  EXPECT_EQ(report[AuditLimit::kCone].verdict, Verdict::kKept);
}

// Returns all velocities of the system after an impact, as an audit takes them.
ObservedRates RatesOf(const Outcome& outcome) {
  ObservedRates rates;
  const auto add = [&rates](const Components& list) {
    rates.values.insert(rates.values.end(), list.begin(), list.end());
  };
  add(outcome.rates_after_rad_s);
  add(outcome.rates_after);
  for (const BodyVelocity& body : outcome.bodies_after) {
    add(body.linear_m_s);
    add(body.angular_rad_s);
  }
  return rates;
}

TEST_P(SolverContract, AuditOfAnAnswerGivesItsCoefficientBack) {
  for (const System& system : Systems()) {
    const Scene scene = With(system);
    const auto solved = solver().Solve({.scene = scene, .history_at_n_s = {}});
    ASSERT_TRUE(solved.ok()) << solved.status();
    const auto audit = solver().Audit(
        {.scene = scene, .observed = solved->outcome.contact_velocity_after, .velocity_uncertainty_m_s = 1e-8});
    ASSERT_TRUE(audit.ok()) << audit.status();
    EXPECT_TRUE(audit->report.admissible) << "system " << system.index();
    EXPECT_NEAR(audit->report.energetic, 0.5, 1e-7) << "system " << system.index();
    EXPECT_NEAR(audit->report.normal_impulse, solved->outcome.impulse.normal_total_n_s, 1e-7);
    EXPECT_NEAR(audit->report.energy_change, solved->outcome.energy_change_j, 1e-7);
    const ObservedRates rates = RatesOf(solved->outcome);
    if (rates.values.empty()) continue;  // A contact alone.
    const auto by_rates = solver().Audit({.scene = scene, .observed = rates, .velocity_uncertainty_m_s = 1e-8});
    ASSERT_TRUE(by_rates.ok()) << by_rates.status();
    EXPECT_NEAR(by_rates->report.energetic, 0.5, 1e-7) << "system " << system.index();
    EXPECT_NEAR(by_rates->report.normal_impulse, audit->report.normal_impulse, 1e-12) << "system " << system.index();
    AuditBatchRequest batch = {.scene = scene, .columns = {}};
    for (const double rate : rates.values) batch.columns.rates_after.push_back({rate});
    const auto row = solver().AuditBatch(batch);
    ASSERT_TRUE(row.ok()) << row.status();
    EXPECT_EQ(row->reports[0].normal_impulse, by_rates->report.normal_impulse) << "system " << system.index();
    EXPECT_EQ(row->reports[0].unexplained, by_rates->report.unexplained) << "system " << system.index();
  }
}

// A velocity that the impulse at the contact does not make beside the others.
TEST_P(SolverContract, AuditOfRatesThatNoImpulseMakesIsUnexplained) {
  for (const System& system : Systems()) {
    const Scene scene = With(system);
    const auto solved = solver().Solve({.scene = scene, .history_at_n_s = {}});
    ASSERT_TRUE(solved.ok()) << solved.status();
    const ObservedRates rates = RatesOf(solved->outcome);
    if (rates.values.size() <= TangentialDirections(system) + 1) continue;  // Any such velocities have an impulse.
    for (size_t i = 0; i < rates.values.size(); ++i) {
      ObservedRates wrong = rates;
      wrong.values[i] += 0.1;
      const auto audit = solver().Audit({.scene = scene, .observed = wrong, .velocity_uncertainty_m_s = 1e-6});
      ASSERT_TRUE(audit.ok()) << audit.status();
      EXPECT_TRUE(audit->report.unexplained) << "system " << system.index() << " velocity " << i;
      EXPECT_FALSE(audit->report.admissible) << "system " << system.index() << " velocity " << i;
      EXPECT_GT(audit->report.distance, 1e-6) << "system " << system.index() << " velocity " << i;
    }
  }
}

TEST_P(SolverContract, AuditsAPendulumByItsRateAndOnAMovingSurface) {
  Scene scene = PaperScene();
  scene.restitution = std::monostate();
  const auto still = solver().Audit({.scene = scene, .observed = ObservedRates{{0.9}}});
  ASSERT_TRUE(still.ok()) << still.status();
  EXPECT_NEAR(still->report.newton, 0.9, 1e-15);
  EXPECT_NEAR(still->report.energetic, 0.9 * std::sqrt(2.0), 1e-14);
  EXPECT_EQ(still->report[AuditLimit::kSharp].verdict, Verdict::kBroken);
  EXPECT_EQ(still->report[AuditLimit::kEnergy].verdict, Verdict::kKept);
  EXPECT_NEAR(still->contact_energy_j, 0.5, 1e-14);
  scene.surface_velocity = SurfaceVelocity{{1.0}, 0.3};
  const auto moving = solver().Audit({.scene = scene, .observed = ObservedRates{{1.9}}});
  ASSERT_TRUE(moving.ok()) << moving.status();
  EXPECT_NEAR(moving->report.newton, 0.45, 1e-14);
}

TEST_P(SolverContract, AuditReportsEveryViolation) {
  AuditRequest request = {.scene = PaperScene(), .observed = {}, .velocity_uncertainty_m_s = -1.0};
  request.scene.friction.kinetic_coefficient = -0.1;
  EXPECT_THAT(ViolationsOf(solver().Audit(request).status()),
              ElementsAre(Violation{"friction.kinetic_coefficient", "= -0.1: must be >= 0"},
                          Violation{"observed", "is not set: must be one of contact_velocity, rates"},
                          Violation{"velocity_uncertainty_m_s", "= -1: must be finite and >= 0"}));
  request = {.scene = PaperScene(), .observed = ObservedRates{{1.0, 2.0}}};
  EXPECT_THAT(ViolationsOf(solver().Audit(request).status()),
              ElementsAre(Violation{"rates.values", "has 2 entries: must have 1"}));
  request = {.scene = With(ContactInSpace()), .observed = ContactVelocity{{std::nan("")}, 1.0}};
  EXPECT_THAT(ViolationsOf(solver().Audit(request).status()),
              ElementsAre(Violation{"contact_velocity.tangential_m_s", "has 1 entry: must have 2"},
                          Field(&Violation::field, "contact_velocity.tangential_m_s[0]")));
  request.observed = ObservedRates{{1.0}};
  EXPECT_THAT(ViolationsOf(solver().Audit(request).status()), ElementsAre(Field(&Violation::field, "rates")));
  request = {.scene = With(PlanarContact{1.0, 0.0, 0.0, 1.0, 1.0}), .observed = ContactVelocity{{1.0}, 1.0}};
  EXPECT_THAT(ViolationsOf(solver().Audit(request).status()), ElementsAre(Field(&Violation::field, "system")));
}

TEST_P(SolverContract, AuditsOfABatchAreThoseOfItsRowsAndABadRowSpoilsNoOther) {
  AuditBatchRequest request = {.scene = With(Contact()), .columns = {}};
  request.columns.tangential_m_s = {1.0, 0.5, 0.5, -1.0};
  request.columns.normal_m_s = {-1.0};
  request.columns.tangential_after_m_s = {0.5, 0.4, 0.1, -0.5};
  request.columns.normal_after_m_s = {0.5, std::nan(""), 3.0, 0.25};
  request.columns.friction = {0.5, 0.5, 0.75, 0.25};
  const auto batch = solver().AuditBatch(request);
  ASSERT_TRUE(batch.ok()) << batch.status();
  ASSERT_EQ(batch->reports.size(), 4);
  for (const size_t row : {0u, 2u, 3u}) {
    PlanarContact contact = Contact();
    contact.tangential_m_s = request.columns.tangential_m_s[row];
    Scene scene = With(contact);
    scene.friction.kinetic_coefficient = request.columns.friction[row];
    const auto one = solver().Audit({.scene = scene,
                                     .observed = ContactVelocity{{request.columns.tangential_after_m_s[row]},
                                                                 request.columns.normal_after_m_s[row]}});
    ASSERT_TRUE(one.ok()) << one.status();
    EXPECT_EQ(batch->reports[row], one->report) << "row " << row;
  }
  EXPECT_EQ(batch->reports[1].regime, Regime::kInvalid);
  EXPECT_EQ(batch->summary.rows, 4);
  EXPECT_EQ(batch->summary.invalid, (Tally{1, 1}));
  EXPECT_EQ(batch->summary.broken[static_cast<size_t>(AuditLimit::kEnergy)].first_index, 2);
}

TEST_P(SolverContract, AuditOfABatchTakesWhatItLeavesOutFromTheScene) {
  AuditBatchRequest request = {.scene = With(Contact()), .columns = {}};
  request.scene.friction.by_speed = PowerLaw{0.5, 1.0};
  request.columns.tangential_after_m_s = {0.5};
  request.columns.normal_after_m_s = {0.5};
  const auto own = solver().AuditBatch(request);
  ASSERT_TRUE(own.ok()) << own.status();
  const auto one = solver().Audit({.scene = request.scene, .observed = ContactVelocity{{0.5}, 0.5}});
  ASSERT_TRUE(one.ok()) << one.status();
  EXPECT_EQ(own->reports[0], one->report);
  request.columns.tangential_m_s = {1.0};
  request.columns.normal_m_s = {-1.0};
  const auto stated = solver().AuditBatch(request);
  ASSERT_TRUE(stated.ok()) << stated.status();
  EXPECT_EQ(stated->reports, own->reports);
  EXPECT_EQ(solver().AuditBatch({.scene = request.scene, .columns = {}})->reports.size(), 0);
}

// Each system has the velocities of its own before each impact, and its own friction.
TEST_P(SolverContract, AuditOfABatchWithInputsIsThatOfEachRowsScene) {
  const std::pair<System, std::string> systems[] = {{Contact(), "planar_contact.normal_m_s"},
                                                    {Chain(), "linkage.links[0].rate_rad_s"},
                                                    {PaperScene().system, "pendulum.omega_minus_rad_s"}};
  for (const auto& [system, path] : systems) {
    const Scene scene = With(system);
    const InputColumn velocity = {.path = path, .values = {-1.0, -0.5, std::nan("")}};
    const InputColumn friction = {.path = "friction.kinetic_coefficient", .values = {0.25}};
    const auto batch =
        solver().AuditBatch({.scene = scene,
                             .columns = {.tangential_after_m_s = {0.5}, .normal_after_m_s = {0.25, 0.125, 0.25}},
                             .inputs = {velocity, friction}});
    ASSERT_TRUE(batch.ok()) << path << batch.status();
    EXPECT_EQ(batch->summary.invalid, (Tally{1, 2})) << path;
    for (const size_t row : {0u, 1u}) {
      Scene of_row = scene;
      ResolveField(path, of_row)->Set(velocity.values[row]);
      of_row.friction.kinetic_coefficient = 0.25;
      const Observed observed = ContactVelocity{{0.5}, row == 0 ? 0.25 : 0.125};
      const auto one = solver().Audit({.scene = of_row, .observed = observed});
      ASSERT_TRUE(one.ok()) << path << one.status();
      EXPECT_EQ(batch->reports[row], one->report) << path << ", row " << row;
    }
  }
}

TEST_P(SolverContract, AuditInputsThatAreWrongAreNamed) {
  const auto violations = [this](const std::vector<InputColumn>& inputs, const AuditColumns& columns) {
    return ViolationsOf(solver().AuditBatch({.scene = With(Contact()), .columns = columns, .inputs = inputs}).status());
  };
  const AuditColumns after = {.tangential_after_m_s = {0.5}, .normal_after_m_s = {0.5, 0.25}};
  const InputColumn normal = {.path = "planar_contact.normal_m_s", .values = {-1.0}};
  EXPECT_THAT(violations({{.path = "planar_contact.normal", .values = {-1.0}}}, after),
              ElementsAre(Field(&Violation::field, "inputs[0].path")));
  EXPECT_THAT(violations({normal, normal}, after), ElementsAre(Field(&Violation::field, "inputs[1].path")));
  EXPECT_THAT(violations({{.path = normal.path, .values = {}}}, after),
              ElementsAre(Field(&Violation::field, "inputs[0].values")));
  EXPECT_THAT(violations({{.path = normal.path, .values = {-1, -1, -1}}}, after),
              ElementsAre(Field(&Violation::field, "columns.normal_after_m_s")));
  AuditColumns before = after;
  before.normal_m_s = {-1.0};
  before.friction = {0.5};
  EXPECT_THAT(violations({normal}, before), ElementsAre(Field(&Violation::field, "columns.normal_m_s")));
  EXPECT_THAT(violations({{.path = "friction.kinetic_coefficient", .values = {0.25}}}, before),
              ElementsAre(Field(&Violation::field, "columns.friction")));
}

TEST_P(SolverContract, AuditOfABatchByRatesIsThatOfEachRowsRates) {
  AuditBatchRequest request = {.scene = With(Chain()), .columns = {}};
  const size_t links = std::get<Linkage>(request.scene.system).links.size();
  const std::vector<double> rates = {0.5, -0.25, 1e308, std::nan("")};
  for (size_t link = 0; link < links; ++link) request.columns.rates_after.push_back({0.125});
  request.columns.rates_after.back() = rates;
  request.scene.friction.kinetic_coefficient = 0.25;
  const auto batch = solver().AuditBatch(request);
  ASSERT_TRUE(batch.ok()) << batch.status();
  ASSERT_EQ(batch->reports.size(), rates.size());
  for (const size_t row : {0u, 1u}) {
    ObservedRates observed;
    for (size_t link = 0; link < links; ++link) observed.values.push_back(0.125);
    observed.values.back() = rates[row];
    const auto one = solver().Audit({.scene = request.scene, .observed = observed});
    ASSERT_TRUE(one.ok()) << one.status();
    EXPECT_EQ(batch->reports[row], one->report) << "row " << row;
  }
  EXPECT_EQ(batch->summary.invalid, (Tally{2, 2}));
}

TEST_P(SolverContract, AuditOfABatchByThePendulumsRateIsThatOfEachRow) {
  AuditBatchRequest request = {.scene = PaperScene(), .columns = {}};
  request.columns.rates_after = {{0.125, 0.5, 0.75, 1.5}};
  const auto batch = solver().AuditBatch(request);
  ASSERT_TRUE(batch.ok()) << batch.status();
  for (size_t row = 0; row < 4; ++row) {
    const auto one =
        solver().Audit({.scene = request.scene, .observed = ObservedRates{{request.columns.rates_after[0][row]}}});
    ASSERT_TRUE(one.ok()) << one.status();
    EXPECT_EQ(batch->reports[row], one->report) << "row " << row;
  }
}

TEST_P(SolverContract, AuditOfABatchRefusesRatesOfAnotherSystemOrBesideVelocities) {
  AuditBatchRequest request = {.scene = With(Contact()), .columns = {}};
  request.columns.rates_after = {{0.5}};
  EXPECT_THAT(ViolationsOf(solver().AuditBatch(request).status()),
              ElementsAre(Violation{"columns.rates_after",
                                    "is set: must not be for a contact alone, give the contact's velocity"}));
  request = {.scene = PaperScene(), .columns = {}};
  request.columns.rates_after = {{0.5, 0.25}, {}};
  request.columns.normal_after_m_s = {0.5};
  request.columns.friction = {0.5, 0.5, 0.5};
  EXPECT_THAT(
      ViolationsOf(solver().AuditBatch(request).status()),
      ElementsAre(Violation{"columns.rates_after", "has 2 entries: must have 1"},
                  Violation{"columns.normal_after_m_s", "is set: must not be beside rates_after"},
                  Violation{"columns.rates_after[0].values", "has 2 values: must have 1 or 3"},
                  Violation{"columns.rates_after[1].values", "is not set: must have a value a row, or one for all"}));
}

TEST_P(SolverContract, AuditOfABatchTakesFromTheSceneWhatNoColumnStates) {
  Scene scene = With(PlanarContact{3.5, 0.3, 1.0, 0.7, -2.0});
  AuditBatchRequest request = {.scene = scene, .columns = {}};
  request.columns.tangential_after_m_s = {0.1};
  request.columns.normal_after_m_s = {0.6};
  const auto own = solver().AuditBatch(request);
  ASSERT_TRUE(own.ok()) << own.status();
  for (const auto& [column, value] :
       {std::pair(&AuditColumns::tangential_m_s, 0.7), std::pair(&AuditColumns::normal_m_s, -2.0)}) {
    AuditBatchRequest one = request;
    one.columns.*column = {value};
    const auto answer = solver().AuditBatch(one);
    ASSERT_TRUE(answer.ok()) << answer.status();
    EXPECT_EQ(answer->reports, own->reports);
    one.columns.*column = {1.5 * value};
    EXPECT_NE(solver().AuditBatch(one)->reports, own->reports);
  }
}

TEST_P(SolverContract, AuditOfABatchReportsEveryWrongColumn) {
  AuditBatchRequest request = {.scene = With(Contact()), .columns = {}};
  request.columns.normal_m_s = {-1.0};
  request.columns.tangential_2_after_m_s = {1.0};
  request.columns.normal_after_m_s = {0.5, 0.5, 0.5};
  request.columns.friction = {0.5, 0.5};
  EXPECT_THAT(ViolationsOf(solver().AuditBatch(request).status()),
              ElementsAre(Field(&Violation::field, "columns.tangential_after_m_s"),
                          Violation{"columns.tangential_2_after_m_s", "is set: must not be for a planar system"},
                          Violation{"columns.friction", "has 2 values: must have 1 or 3"}));
}

TEST_P(SolverContract, SweepsEveryPointOnceInOrderAndEndsWithTheSummary) {
  constexpr int64_t kPoints = 200'001;
  int64_t next = 0;
  bool summarised = false;
  for (const auto& chunk : solver().Sweep(FrictionSweep(kPoints))) {
    ASSERT_TRUE(chunk.ok()) << chunk.status();
    EXPECT_FALSE(summarised);
    EXPECT_EQ(chunk->first_index, next);
    EXPECT_EQ(chunk->values.size(), static_cast<size_t>(2 * chunk->count));
    EXPECT_TRUE(chunk->regimes.empty());
    next += chunk->count;
    EXPECT_EQ(chunk->points_done, next);
    EXPECT_EQ(chunk->points_total, kPoints);
    EXPECT_EQ(chunk->tallies.points, next);
    summarised = chunk->summary.has_value();
    EXPECT_EQ(chunk->summary.value_or(SweepSummary{.points = kPoints}).points, kPoints);
  }
  EXPECT_TRUE(summarised);
  EXPECT_EQ(next, kPoints);
}

TEST_P(SolverContract, SweepsThePointsOfASolve) {
  SweepRequest request = FrictionSweep(5);
  const auto chunks = Collect(solver().Sweep(request));
  ASSERT_TRUE(chunks.front().ok()) << chunks.front().status();
  for (int64_t i = 0; i < 5; ++i) {
    Scene scene = PaperScene();
    scene.friction.kinetic_coefficient = AxisValue(request.grid.axes[0], i);
    const auto response = solver().Solve({.scene = scene, .history_at_n_s = {}});
    ASSERT_TRUE(response.ok()) << response.status();
    EXPECT_EQ(chunks.front()->values[static_cast<size_t>(i)], response->outcome.coefficients.newton);
  }
}

TEST_P(SolverContract, GivesABadPointQuietNaNAndGoesOn) {
  SweepRequest request = FrictionSweep(3);
  request.grid.axes[0].values = ListValues{{0.1, -1.0, 0.2}};
  request.with_regime = true;
  const auto chunks = Collect(solver().Sweep(request));
  ASSERT_EQ(chunks.size(), 1);
  ASSERT_TRUE(chunks[0].ok()) << chunks[0].status();
  EXPECT_THAT(chunks[0]->regimes, ElementsAre(Regime::kRebound, Regime::kInvalid, Regime::kRebound));
  EXPECT_THAT(chunks[0]->statuses, ElementsAre(RowStatus::kOk, RowStatus::kInvalid, RowStatus::kOk));
  EXPECT_TRUE(std::isnan(chunks[0]->values[1]));
  EXPECT_TRUE((std::bit_cast<uint64_t>(chunks[0]->values[1]) & (uint64_t{1} << 51)) != 0) << "a signalling NaN";
  EXPECT_EQ(chunks[0]->summary->by_regime[static_cast<size_t>(Regime::kInvalid)], (Tally{1, 1}));
}

// Expects that each point of the sweep has the status that its Solve has, of which some break a limit and some do not.
void ExpectStatusesOfSolves(const Solver& solver, SweepRequest request) {
  request.with_regime = true;
  const auto chunks = Collect(solver.Sweep(request));
  ASSERT_EQ(chunks.size(), 1);
  ASSERT_TRUE(chunks[0].ok()) << chunks[0].status();
  ASSERT_EQ(chunks[0]->statuses.size(), static_cast<size_t>(chunks[0]->count));
  int64_t inadmissible = 0;
  for (int64_t i = 0; i < chunks[0]->count; ++i) {
    Scene scene = request.grid.scene;
    scene.friction.kinetic_coefficient = AxisValue(request.grid.axes[0], i);
    const auto response = solver.Solve({.scene = scene, .history_at_n_s = {}});
    ASSERT_TRUE(response.ok()) << response.status();
    const bool admissible = response->outcome.admissible;
    EXPECT_EQ(chunks[0]->statuses[static_cast<size_t>(i)], admissible ? RowStatus::kOk : RowStatus::kInadmissible) << i;
    if (!admissible) ++inadmissible;
  }
  EXPECT_EQ(chunks[0]->summary->inadmissible.count, inadmissible);
  EXPECT_GT(inadmissible, 0);
  EXPECT_LT(inadmissible, chunks[0]->count);
}

TEST_P(SolverContract, AStatusSaysWhichPointsBreakALimit) {
  SweepRequest request = FrictionSweep(41);
  request.grid.scene.restitution = NewtonCoefficient{0.6};
  ExpectStatusesOfSolves(solver(), request);
  // A contact that slides both ways, for which Newton's law can ask for more energy than there is.
  request.grid.scene.system = PlanarContact{
      .w_tt_per_kg = 2.5, .w_tn_per_kg = 1.5, .w_nn_per_kg = 2.5, .tangential_m_s = -1.0, .normal_m_s = -1.0};
  request.grid.scene.restitution = NewtonCoefficient{0.9};
  request.columns = {"coefficients.energetic"};
  ExpectStatusesOfSolves(solver(), request);
}

TEST_P(SolverContract, ASumThatIsTooLargeHasItsOwnStatus) {
  SweepRequest request = FrictionSweep(2);
  request.grid.scene.system = PlanarContact{
      .w_tt_per_kg = 1e-300, .w_tn_per_kg = 0.0, .w_nn_per_kg = 1e-300, .tangential_m_s = -1.0, .normal_m_s = -1e100};
  request.columns = {"impulse.normal_total_n_s"};
  request.with_regime = true;
  const auto chunks = Collect(solver().Sweep(request));
  ASSERT_EQ(chunks.size(), 1);
  ASSERT_TRUE(chunks[0].ok()) << chunks[0].status();
  EXPECT_THAT(chunks[0]->statuses, ElementsAre(RowStatus::kNotRepresentable, RowStatus::kNotRepresentable));
  EXPECT_THAT(chunks[0]->regimes, ElementsAre(Regime::kInvalid, Regime::kInvalid));
}

TEST_P(SolverContract, AnEmptyRangeIsOneEmptyChunkWithItsSummary) {
  SweepRequest request = FrictionSweep(10);
  request.first_index = 10;
  const auto chunks = Collect(solver().Sweep(request));
  ASSERT_EQ(chunks.size(), 1);
  ASSERT_TRUE(chunks[0].ok()) << chunks[0].status();
  EXPECT_EQ(chunks[0]->count, 0);
  EXPECT_EQ(chunks[0]->summary->points, 0);
}

TEST_P(SolverContract, ABadGridIsAStreamOfOneErrorWithEveryViolation) {
  SweepRequest request = FrictionSweep(0);
  request.grid.axes.push_back({"pendulum.mass_kg", ListValues{{1.0}}});
  request.columns = {"coefficients.elastic"};
  const auto chunks = Collect(solver().Sweep(request));
  ASSERT_EQ(chunks.size(), 1);
  const absl::Status& status = chunks[0].status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ViolationsOf(status), testing::UnorderedElementsAre(Field(&Violation::field, "axes[0].linspace.count"),
                                                                  Field(&Violation::field, "axes[1].path"),
                                                                  Field(&Violation::field, "columns[0]")));
}

TEST_P(SolverContract, AStoppedSweepEndsWithCancelled) {
  std::stop_source stop;
  absl::Status last;
  int64_t points = 0;
  for (const auto& chunk : solver().Sweep(FrictionSweep(1'000'000'000), {.stop = stop.get_token()})) {
    last = chunk.status();
    if (chunk.ok()) points = chunk->points_done;
    stop.request_stop();
  }
  EXPECT_EQ(last.code(), absl::StatusCode::kCancelled) << last;
  EXPECT_LT(points, 1'000'000);
}

TEST_P(SolverContract, ASweepStoppedFromAnotherThreadEndsSoon) {
  std::jthread stopper;
  std::stop_source stop;
  SweepStream stream = solver().Sweep(FrictionSweep(10'000'000'000), {.stop = stop.get_token()});
  stopper = std::jthread([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop.request_stop();
  });
  absl::Status last;
  for (const auto& chunk : stream) last = chunk.status();
  EXPECT_EQ(last.code(), absl::StatusCode::kCancelled) << last;
}

TEST_P(SolverContract, ASweepStoppedBeforeItStartsGivesNoPoint) {
  std::stop_source stop;
  stop.request_stop();
  const auto chunks = Collect(solver().Sweep(FrictionSweep(1000), {.stop = stop.get_token()}));
  ASSERT_EQ(chunks.size(), 1);
  EXPECT_EQ(chunks[0].status().code(), absl::StatusCode::kCancelled);
}

TEST_P(SolverContract, AStreamMayBeDroppedHalfRead) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 10; ++i) {
    SweepStream stream = solver().Sweep(FrictionSweep(1'000'000'000));
    EXPECT_TRUE((*stream.begin()).ok());
  }
  { const SweepStream unread = solver().Sweep(FrictionSweep(1'000'000'000)); }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  EXPECT_TRUE(solver().Solve({.scene = PaperScene(), .history_at_n_s = {}}).ok());
}

TEST_P(SolverContract, AnswersManyThreadsAtOnce) {
  const Solver& asked = solver();  // Here, because the kernel ends a server with the thread that started it.
  std::atomic<int> right = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([&asked, &right] {
        const auto response = asked.Solve({.scene = PaperScene(), .history_at_n_s = {}});
        const auto chunks = Collect(asked.Sweep(FrictionSweep(20'000)));
        EXPECT_TRUE(response.ok()) << response.status();
        EXPECT_TRUE(chunks.back().ok()) << chunks.back().status();
        if (response.ok() && chunks.back().ok() && chunks.back()->summary.has_value()) ++right;
      });
    }
  }
  EXPECT_EQ(right, 8);
}

}  // namespace
}  // namespace ricochet
