// The conversion core -> proto -> bytes -> proto -> core keeps every value, and an unset value stays unset.

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/types/span.h"
#include "proto/wire/audit.h"
#include "proto/wire/cost.h"
#include "proto/wire/requests.h"
#include "proto/wire/scene.h"
#include "proto/wire/sweep.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kSubnormal = std::numeric_limits<double>::denorm_min();

template <typename Message>
Message ThroughBytes(const Message& proto) {
  Message parsed;
  EXPECT_TRUE(parsed.ParseFromString(proto.SerializeAsString()));
  return parsed;
}

template <typename T>
T ThroughWire(const T& value) {
  return FromProto(ThroughBytes(ToProto(value)));
}

SweepChunk ThroughWire(const SweepChunk& chunk) {
  v1::SweepResponse proto;
  ToProto(chunk, proto);
  return FromProto(ThroughBytes(proto));
}

std::vector<uint64_t> Bits(absl::Span<const double> values) {
  std::vector<uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<uint64_t>(value));
  return bits;
}

Scene PaperScene() {
  return {.system = Pendulum{.inertia_kg_m2 = 1.25, .a_m = 0.3, .b_m = -1.0, .omega_minus_rad_s = -2.0},
          .friction = {.kinetic_coefficient = 0.1, .static_coefficient = 0.2},
          .restitution = EnergeticCoefficient{0.75}};
}

Outcome SomeOutcome() {
  const State start = {.normal_impulse_n_s = 0.0,
                       .tangential_impulse_n_s = {-0.0},
                       .contact_velocity = {.tangential_m_s = {2.0}, .normal_m_s = -0.6},
                       .rates_rad_s = {-2.0}};
  return {.regime = Regime::kRebound,
          .admissible = false,
          .broken_limits = {{LimitKind::kSharp, 1.0, 1.0, 1e-17}, {LimitKind::kEnergy, 0.25, 0.0, 0.25}},
          .w_rank = 1,
          .coefficients = {0.5, 0.7, 0.6, -0.08},
          .rates_after_rad_s = {1.5},
          .contact_velocity_after = {.tangential_m_s = {-1.5}, .normal_m_s = 0.45},
          .impulse = {.normal_compression_n_s = 6.25, .normal_total_n_s = 10.625, .tangential_n_s = {-0.85}},
          .work = {-1.0, 0.36, -0.5, -0.25, -0.64, -0.75, kSubnormal},
          .energy_change_j = -1.39,
          .timeline = {{EventKind::kStart, start}, {EventKind::kCompressionEnds, start}},
          .history = {start, start, start},
          .bodies_after = {{{1.0, 2.0}, {3.0}}, {{4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}}},
          .effective = {0.1, 0.2, 0.3},
          .accuracy = {1e-12, AccuracyKind::kEstimate, 7, 8},
          .errors = {1e-1, 2e-1, 3e-1, 4e-1, 5e-1, 6e-1, 7e-1, 8e-1, 9e-1, 1.0, 1.1, 1.2, 1.3, 1.4},
          .notes = {{NoteKind::kLargeAngle, "linkage.links[1].theta_rad", "It is in radians."}},
          .alternatives = {{start.contact_velocity, {0.0, 1.0, {2.0}}}},
          .alternatives_are_ends = true};
}

TEST(SceneTest, SurvivesWithEachDefinitionOfRestitution) {
  Scene scene = PaperScene();
  for (const Restitution& restitution : {Restitution(NewtonCoefficient{0.5}), Restitution(PoissonCoefficient{0.5}),
                                         Restitution(EnergeticCoefficient{0.5}), Restitution(std::monostate())}) {
    scene.restitution = restitution;
    EXPECT_EQ(ThroughWire(scene), scene) << "definition " << restitution.index();
  }
}

TEST(SceneTest, SurvivesWithEachSystem) {
  const PlanarBody flat = {1.0, 0.1, 0.2, -0.3, 1.0, -2.0, 0.5};
  const SpatialBody body = {1.0, {0.3, 0.1, 0.0, 0.2, 0.0, 0.4}, {0.1, 0.2, -0.3}, {1, 2, -3}, {0, 0, 1}};
  Scene scene = PaperScene();
  for (const System& system :
       {System(std::monostate()), System(flat), System(body), System(BodyPair()),
        System(BodyPair{PlanarPair{flat, {2.0, 0.2}}}), System(BodyPair{SpatialPair{body, {2.0}}}), System(Linkage()),
        System(Linkage{{{1.0, 2.0, 0.5, 0.1, 0.3, -1.0}, {1.5}}}), System(PlanarContact{2.0, 0.5, 1.0, 1.0, -1.0}),
        System(SpatialContact{{1, 2, 3, 4, 5, 6}, {7, 8}, -9}), System(SpatialContact{{1.0}, {}, 0.0})}) {
    scene.system = system;
    EXPECT_EQ(ThroughWire(scene), scene) << "system " << system.index();
  }
}

TEST(SceneTest, SurvivesWithEachImpactLaw) {
  Scene scene = PaperScene();
  scene.restitution = std::monostate();
  for (const ImpactLaw& law : {ImpactLaw(WhittakerLaw{0.5}), ImpactLaw(KaneLevinsonLaw{0.0}),
                               ImpactLaw(BrachLaw{0.5, -0.2}), ImpactLaw(ChatterjeeRuinaLaw{0.5, 0.25})}) {
    scene.impact_law = law;
    EXPECT_EQ(ThroughWire(scene), scene) << "law " << law.index();
  }
}

TEST(SceneTest, SpeedDependenceSurvivesAndItsAbsenceToo) {
  Scene scene = PaperScene();
  for (const SpeedDependence& form :
       {SpeedDependence(), SpeedDependence(PowerLaw{0.1, 0.5}), SpeedDependence(PowerLaw()),
        SpeedDependence(SpeedTable{{0.0, 1.0}, {1.0, 0.5}}), SpeedDependence(SpeedTable())}) {
    scene.friction.by_speed = form;
    scene.restitution_by_speed.reset();
    EXPECT_EQ(ThroughWire(scene), scene) << "form " << form.index();
    std::swap(scene.friction.by_speed, scene.restitution_by_speed);
    EXPECT_EQ(ThroughWire(scene), scene) << "form " << form.index();
  }
}

TEST(SceneTest, SurfaceAtRestIsNotUnset) {
  Scene scene = PaperScene();
  scene.surface_velocity = SurfaceVelocity();
  EXPECT_EQ(ThroughWire(scene), scene);
  scene.surface_velocity = SurfaceVelocity{{1.0, 2.0}, 3.0};
  EXPECT_EQ(ThroughWire(scene), scene);
}

TEST(SceneTest, RestitutionOfZeroIsNotUnset) {
  Scene scene = PaperScene();
  scene.restitution = NewtonCoefficient{0.0};
  EXPECT_EQ(ThroughWire(scene), scene);
}

TEST(SceneTest, StaticCoefficientOfZeroIsNotUnset) {
  Scene scene = PaperScene();
  scene.friction.static_coefficient = 0.0;
  EXPECT_EQ(ThroughWire(scene), scene);
  scene.friction.static_coefficient.reset();
  EXPECT_EQ(ThroughWire(scene), scene);
  EXPECT_FALSE(ToProto(scene).friction().has_static_coefficient());
}

TEST(SceneTest, WhatARequestLeftOpenStaysOpen) {
  const Scene scene = FromProto(v1::Scene());
  EXPECT_EQ(scene, Scene());
  EXPECT_TRUE(std::holds_alternative<std::monostate>(scene.system));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(scene.restitution));
  v1::Scene without_coefficient;
  without_coefficient.mutable_restitution();
  EXPECT_EQ(FromProto(without_coefficient), Scene());
}

TEST(SceneTest, FrictionIsSentEvenIfThereIsNone) {
  const v1::Scene proto = ToProto(Scene());
  EXPECT_TRUE(proto.has_friction());
  EXPECT_EQ(proto.system_case(), v1::Scene::SYSTEM_NOT_SET);
  EXPECT_FALSE(proto.has_restitution());
}

TEST(SceneTest, JsonHasTheNamesOfTheProto) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  std::string json;
  ASSERT_TRUE(google::protobuf::util::MessageToJsonString(ToProto(PaperScene()), &json, options).ok());
  EXPECT_EQ(json, R"({"pendulum":{"inertia_kg_m2":1.25,"a_m":0.3,"b_m":-1,"omega_minus_rad_s":-2},)"
                  R"("friction":{"kinetic_coefficient":0.1,"static_coefficient":0.2},)"
                  R"("restitution":{"energetic":0.75}})");
}

TEST(SceneTest, JsonIsReadBack) {
  v1::Scene proto;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(
                  R"({"pendulum": {"inertia_kg_m2": 1.25, "a_m": 0.3, "b_m": -1, "omega_minus_rad_s": -2},
                      "friction": {"kinetic_coefficient": 0.1, "static_coefficient": 0.2},
                      "restitution": {"energetic": 0.75}})",
                  &proto)
                  .ok());
  EXPECT_EQ(FromProto(proto), PaperScene());
}

TEST(SolveTest, RequestSurvives) {
  const SolveRequest request = {
      .scene = PaperScene(), .history_at_n_s = {0.0, 1.5, kSubnormal, 1e308}, .inadmissible_is_error = true};
  EXPECT_EQ(ThroughWire(request), request);
  EXPECT_EQ(ThroughWire(SolveRequest()), SolveRequest());
  const SolveRequest exact{.demand = {.relative_tolerance = 0.0}};
  EXPECT_EQ(ThroughWire(exact), exact);
}

TEST(SolveTest, ResponseSurvives) {
  const SolveResponse response = {.outcome = SomeOutcome(), .engine = {"1.2.3", "0123456789abcdef"}};
  EXPECT_EQ(ThroughWire(response), response);
  EXPECT_EQ(ThroughWire(SolveResponse()), SolveResponse());
}

TEST(PlanTest, RequestAndResponseSurvive) {
  const PlanRequest request = {
      .scene = PaperScene(),
      .demand = {.relative_tolerance = 0.0, .required = {Effect::kFriction}, .excluded = {Effect::kSlipStop}}};
  EXPECT_EQ(ThroughWire(request), request);
  EXPECT_EQ(ThroughWire(PlanRequest()), PlanRequest());
  const Plan plan = {.model = Model::kPlanar,
                     .relative_tolerance = 1e-3,
                     .neglected = 1e-4,
                     .effects = PlannedEffects(
                         {{Effect::kFriction, Decision::kSimulated, 0.5, "friction changes velocities by at most 0.5"},
                          {Effect::kStaticFriction, Decision::kNegligible, 1e-4, "slip may stop"}}),
                     .arithmetic = {Arithmetic::kCompensated, ArithmeticReason::kSignNotProved, 1e-16}};
  EXPECT_NE(plan, Plan());
  const PlanResponse response = {.plan = plan, .engine = {"1.2.3", "0123456789abcdef"}};
  EXPECT_EQ(ThroughWire(response), response);
}

TEST(CostTest, RequestSurvivesWithAndWithoutItsOptions) {
  EXPECT_EQ(ThroughWire(CostRequest{.scene = PaperScene()}), CostRequest{.scene = PaperScene()});
  const CostRequest request = {.scene = PaperScene(), .time_limit_s = 0.0, .samples = 0};
  EXPECT_EQ(ThroughWire(request), request);
}

TEST(CostTest, RowsSurviveWithAndWithoutTimes) {
  const CostTime time = {
      .median_s = 1e-8, .lower_quartile_s = 9e-9, .upper_quartile_s = 2e-8, .samples = 21, .per_sample = 8};
  const CostRow measured = {.name = "space 1e-06",
                            .method = {.model = Model::kSpatial, .arithmetic = Arithmetic::kPlain, .tolerance = 1e-6},
                            .status = CostStatus::kMeasured,
                            .solve = time,
                            .batch = time,
                            .claimed = {.total = std::numeric_limits<double>::infinity(), .numerical = 1e-7},
                            .achieved = CostError{.total = 1e-8},
                            .velocity_after = {.tangential_m_s = {1.0, -0.0}, .normal_m_s = 2.0},
                            .steps = 3,
                            .right_hand_sides = 60};
  const CostRow late = {.name = "planar", .status = CostStatus::kOutOfTime, .note = "no time was left"};
  const CostChunk chunk = {.first_row = 4,
                           .rows = {measured, late},
                           .rows_done = 6,
                           .rows_total = 9,
                           .summary = CostSummary{.front = {0, 4}, .picks = {{4, 0.0, 1e-3, Model::kSpatial}}},
                           .engine = {"1.2.3", "0123456789abcdef"}};
  EXPECT_EQ(ThroughWire(chunk), chunk);
  EXPECT_EQ(ThroughWire(CostChunk()), CostChunk());
}

TEST(SolveTest, SignOfZeroSurvives) {
  SolveResponse response;
  response.outcome.energy_change_j = -0.0;
  response.outcome.rates_after_rad_s = {-0.0, 0.0};
  const SolveResponse back = ThroughWire(response);
  EXPECT_EQ(Bits({back.outcome.energy_change_j}), Bits({-0.0}));
  EXPECT_EQ(Bits(back.outcome.rates_after_rad_s), Bits({-0.0, 0.0}));
}

TEST(BoundsTest, RequestSurvives) {
  EXPECT_EQ(ThroughWire(BoundsRequest{PaperScene(), {}}), (BoundsRequest{PaperScene(), {}}));
  const BoundsRequest request = {PaperScene(), {{"pendulum.a_m", 0.2, 0.3}, {"", -0.0, kSubnormal}}};
  EXPECT_EQ(ThroughWire(request), request);
}

TEST(BoundsTest, CriticalFrictionOfZeroIsNotUnset) {
  BoundsResponse response;
  using Critical = std::optional<double> CriticalFriction::*;
  for (const Critical member : {&CriticalFriction::stick, &CriticalFriction::stop_compression, &CriticalFriction::stop,
                                &CriticalFriction::reversal, &CriticalFriction::jam}) {
    response.bounds.critical.*member = 0.0;
    EXPECT_EQ(ThroughWire(response), response);
  }
}

TEST(BoundsTest, BoundsByEnergyAloneThatAreAbsentStayAbsent) {
  BoundsResponse response;
  response.bounds.sampled = true;
  EXPECT_EQ(ThroughWire(response), response);
  response.bounds.energy_only.emplace();
  EXPECT_EQ(ThroughWire(response), response);
}

TEST(BoundsTest, EnclosureSurvivesWithInfiniteEnds) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  BoundsResponse response;
  response.enclosure = Enclosure{.outer = {{0.0, 0.7}, {0.0, kInfinity}, {0.0, 1.0}, {-kInfinity, 0.3}, {2.0, 5.0}},
                                 .attained = {{0.1, 0.6}, {0.2, 1.3}, {0.0, 1.0}, {-0.1, 0.2}, {2.1, 4.0}},
                                 .excess = kInfinity,
                                 .boxes = 123};
  EXPECT_EQ(ThroughWire(response), response);
  std::string json;
  ASSERT_TRUE(google::protobuf::util::MessageToJsonString(ToProto(response), &json).ok());
  EXPECT_THAT(json, testing::HasSubstr(R"("excess":"Infinity")"));
}

TEST(BoundsTest, ResponseSurvivesWithAndWithoutFirstOrderForms) {
  const CoefficientBounds limits = {{0.0, 0.7}, {0.0, 1.4}, {0.0, 1.0}, {-0.1, 0.3}, {2.0, 5.0}};
  BoundsResponse response;
  response.bounds.regime = Regime::kRebound;
  response.bounds.sharp = limits;
  EXPECT_EQ(ThroughWire(response), response);
  NearlyVertical& nearly = response.bounds.nearly_vertical.emplace();
  nearly.bounds = limits;
  nearly.newton_error = 0.125;
  EXPECT_EQ(ThroughWire(response), response);
  nearly.coefficients = {0.1, 0.2, 0.3, 0.4};
  nearly.coefficient_errors = {0.5, 0.6, 0.7, 0.8};
  EXPECT_EQ(ThroughWire(response), response);
}

TEST(BoundsTest, CoefficientErrorsAreSentOnlyWithCoefficients) {
  BoundsResponse response;
  response.bounds.nearly_vertical.emplace();
  EXPECT_FALSE(ToProto(response).bounds().nearly_vertical().has_coefficients());
  EXPECT_FALSE(ToProto(response).bounds().nearly_vertical().has_coefficient_errors());
  response.bounds.nearly_vertical->coefficients.emplace();
  EXPECT_TRUE(ToProto(response).bounds().nearly_vertical().has_coefficients());
  EXPECT_TRUE(ToProto(response).bounds().nearly_vertical().has_coefficient_errors());
}

TEST(AuditTest, RequestSurvivesWithEachKindOfObservation) {
  AuditRequest request = {.scene = PaperScene(), .observed = {}, .velocity_uncertainty_m_s = 0.125};
  EXPECT_EQ(ThroughWire(request), request);
  auto& velocity = request.observed.emplace<ContactVelocity>();
  EXPECT_EQ(ThroughWire(request), request);
  velocity.tangential_m_s.assign({1.0, 2.0});
  velocity.normal_m_s = 3.0;
  EXPECT_EQ(ThroughWire(request), request);
  auto& rates = request.observed.emplace<ObservedRates>();
  EXPECT_EQ(ThroughWire(request), request);
  rates.rates_rad_s.assign({0.5, -0.25});
  EXPECT_EQ(ThroughWire(request), request);
}

TEST(AuditTest, ResponsesSurvive) {
  AuditReport report = {.regime = Regime::kSliding, .w_rank = 3, .admissible = true, .distance = kSubnormal};
  report.tangential_impulse = {1.0, -0.0};
  report.limits[static_cast<size_t>(AuditLimit::kCone)] = {1.0, 2.0, -1.0, 0.5, Verdict::kKept};
  const AuditResponse response = {.report = report, .contact_energy_j = 0.5, .engine = {"1.2.3", "0123456789abcdef"}};
  EXPECT_EQ(ThroughWire(response), response);
  EXPECT_EQ(ThroughWire(AuditResponse()), AuditResponse());
  AuditBatchResponse batch = {
      .reports = {report, AuditReport()}, .summary = {.rows = 2, .admissible = 1}, .engine = {}};
  batch.summary.broken[static_cast<size_t>(AuditLimit::kEnergy)] = {1, 0};
  EXPECT_EQ(ThroughWire(batch), batch);
  EXPECT_EQ(ThroughWire(AuditBatchResponse()), AuditBatchResponse());
}

TEST(AuditTest, EmptySummaryHasNoFirstIndices) { EXPECT_EQ(FromProto(v1::AuditBatchResponse()), AuditBatchResponse()); }

TEST(AuditTest, ColumnsSurvive) {
  const AuditBatchRequest request = {
      .scene = PaperScene(),
      .columns = {{1.0}, {2.0}, {3.0}, {4.0, 5.0}, {6.0}, {7.0, kSubnormal}, {}, {0.5}, {{8.0, kSubnormal}, {}}}};
  EXPECT_EQ(ThroughWire(request), request);
}

SweepRequest SomeSweep() {
  return {.grid = {.scene = PaperScene(),
                   .axes = {{"pendulum.b_m", ListValues{{1.0, -0.0, kSubnormal}}},
                            {"pendulum.phi_rad", Linspace{0.25, 3.0, 1'000'000'000}},
                            {"friction.kinetic_coefficient", Logspace{1e-300, 1e300, 7}},
                            {"restitution.newton", std::monostate()}},
                   .combination = Combination::kZip},
          .columns = {"coefficients.newton", "rates_after_rad_s[0]"},
          .with_regime = true,
          .first_index = 5,
          .end_index = int64_t{1} << 53};
}

TEST(SweepTest, RequestSurvivesWithEachKindOfAxis) {
  EXPECT_EQ(ThroughWire(SomeSweep()), SomeSweep());
  EXPECT_EQ(ThroughWire(SweepRequest()), SweepRequest());
}

TEST(SweepTest, EmptyListIsNotAnUnsetAxis) {
  SweepRequest request;
  request.grid.axes = {{"pendulum.b_m", ListValues{}}};
  EXPECT_EQ(ThroughWire(request), request);
}

TEST(SweepTest, EndIndexOfZeroIsNotUnset) {
  SweepRequest request = SomeSweep();
  request.end_index = 0;
  EXPECT_EQ(ThroughWire(request), request);
  request.end_index.reset();
  EXPECT_EQ(ThroughWire(request), request);
}

TEST(SweepTest, UnknownCombinationReachesTheCore) {
  SweepRequest request;
  request.grid.combination = static_cast<Combination>(999);
  EXPECT_EQ(ThroughWire(request), request);
}

SweepSummary SomeSummary() {
  SweepSummary summary;
  summary.points = 10;
  summary.by_regime[static_cast<size_t>(Regime::kRebound)] = {7, 0};
  summary.by_regime[static_cast<size_t>(Regime::kInvalid)] = {3, 4};
  summary.inadmissible = {2, 5};
  summary.elapsed_s = 0.125;
  return summary;
}

TEST(SweepTest, SummarySurvives) {
  EXPECT_EQ(ThroughWire(SomeSummary()), SomeSummary());
  EXPECT_EQ(ThroughWire(SweepSummary()), SweepSummary());
}

TEST(SweepTest, SummaryListsTheRegimesThatOccurredInTheirOrder) {
  const v1::SweepSummary proto = ToProto(SomeSummary());
  ASSERT_EQ(proto.by_regime_size(), 2);
  EXPECT_EQ(proto.by_regime(0).regime(), v1::REGIME_REBOUND);
  EXPECT_EQ(proto.by_regime(0).tally().count(), 7);
  EXPECT_EQ(proto.by_regime(1).regime(), v1::REGIME_INVALID);
  EXPECT_EQ(proto.by_regime(1).tally().first_index(), 4);
}

TEST(SweepTest, EmptySummaryHasNoFirstIndices) {
  const SweepSummary summary = FromProto(v1::SweepSummary());
  EXPECT_EQ(summary, SweepSummary());
  EXPECT_EQ(summary.inadmissible.first_index, -1);
  v1::SweepSummary without_tally;
  without_tally.add_by_regime()->set_regime(v1::REGIME_LOCKED);
  EXPECT_EQ(FromProto(without_tally), SweepSummary());
}

TEST(SweepTest, PointsOfUnknownRegimesAreCountedTogether) {
  v1::SweepSummary proto;
  for (const int number : {999, 998}) {
    v1::RegimeTally& entry = *proto.add_by_regime();
    entry.set_regime(static_cast<v1::Regime>(number));
    entry.mutable_tally()->set_count(number);
    entry.mutable_tally()->set_first_index(2 * number);
  }
  EXPECT_EQ(FromProto(proto).by_regime[0], (Tally{999 + 998, 2 * 998}));
}

TEST(SweepTest, ElapsedOfZeroIsNotUnset) {
  SweepSummary summary;
  summary.elapsed_s = 0.0;
  EXPECT_EQ(ThroughWire(summary), summary);
}

SweepChunk SomeChunk() {
  return {.first_index = 1024,
          .count = 2,
          .values = {1.0, 2.0, 3.0, 4.0},
          .regimes = {Regime::kRebound, Regime::kLocked},
          .statuses = {RowStatus::kInadmissible, RowStatus::kOk},
          .points_done = 1026,
          .points_total = 4096,
          .tallies = SomeSummary(),
          .summary = SomeSummary(),
          .engine = {"1.2.3", "0123456789abcdef"}};
}

TEST(SweepTest, ChunkSurvivesWithAndWithoutASummary) {
  SweepChunk chunk = SomeChunk();
  EXPECT_EQ(ThroughWire(chunk), chunk);
  chunk.summary.reset();
  EXPECT_EQ(ThroughWire(chunk), chunk);
  EXPECT_EQ(ThroughWire(SweepChunk()), SweepChunk());
}

TEST(SweepTest, EveryBitOfAValueSurvives) {
  SweepChunk chunk;
  chunk.values = {std::numeric_limits<double>::quiet_NaN(),
                  -std::numeric_limits<double>::quiet_NaN(),
                  std::bit_cast<double>(uint64_t{0x7ff8'0000'dead'beef}),
                  std::bit_cast<double>(uint64_t{0x7ff0'0000'0000'0001}),
                  std::numeric_limits<double>::infinity(),
                  -0.0,
                  kSubnormal,
                  -std::numeric_limits<double>::min() / 2,
                  std::numeric_limits<double>::max()};
  EXPECT_EQ(Bits(ThroughWire(chunk).values), Bits(chunk.values));
}

TEST(SweepTest, UnknownRegimeOfAPointIsUnspecified) {
  v1::SweepResponse proto;
  proto.set_regimes({static_cast<char>(v1::REGIME_LOCKED), static_cast<char>(v1::Regime_MAX + 1), '\xff'});
  EXPECT_THAT(FromProto(proto).regimes, ElementsAre(Regime::kLocked, Regime::kUnspecified, Regime::kUnspecified));
}

TEST(SweepTest, UnknownStatusOfAPointIsUnspecified) {
  v1::SweepResponse proto;
  proto.set_statuses({static_cast<char>(v1::ROW_STATUS_OK), static_cast<char>(v1::RowStatus_MAX + 1), '\xff'});
  EXPECT_THAT(FromProto(proto).statuses, ElementsAre(RowStatus::kOk, RowStatus::kUnspecified, RowStatus::kUnspecified));
}

// Bytes that were written down from IEEE 754 and the proto's comment, so that every language can read them.
TEST(SweepTest, ValuesAreLittleEndianDoublesAndRegimesAndStatusesAreBytes) {
  v1::SweepResponse proto;
  SweepChunk chunk = SomeChunk();
  chunk.values = {1.0, -2.5};
  ToProto(chunk, proto);
  EXPECT_EQ(proto.values(), std::string("\0\0\0\0\0\0\xf0\x3f\0\0\0\0\0\0\x04\xc0", 16));
  EXPECT_EQ(proto.regimes(), (std::string{v1::REGIME_REBOUND, v1::REGIME_LOCKED}));
  EXPECT_EQ(proto.statuses(), "\x02\x01");
}

TEST(SweepTest, ReusedProtoHoldsNothingOfTheChunkBefore) {
  v1::SweepResponse proto;
  ToProto(SomeChunk(), proto);
  ToProto(SweepChunk(), proto);
  EXPECT_EQ(FromProto(proto), SweepChunk());
  EXPECT_FALSE(proto.has_summary());
  EXPECT_THAT(proto.regimes(), IsEmpty());
  EXPECT_THAT(proto.statuses(), IsEmpty());
}

TEST(SweepTest, ReusedProtoKeepsItsMemory) {
  v1::SweepResponse proto;
  SweepChunk chunk = SomeChunk();
  chunk.values.assign(100'000, 1.5);
  chunk.regimes.assign(10'000, Regime::kRebound);
  ToProto(chunk, proto);
  const char* values = proto.values().data();
  const char* regimes = proto.regimes().data();
  chunk.values.resize(50'000);
  chunk.regimes.resize(5'000);
  ToProto(chunk, proto);
  EXPECT_EQ(proto.values().data(), values);
  EXPECT_EQ(proto.regimes().data(), regimes);
  EXPECT_EQ(proto.values().size(), 50'000 * sizeof(double));
  EXPECT_EQ(proto.regimes().size(), 5'000U);
}

}  // namespace
}  // namespace ricochet
