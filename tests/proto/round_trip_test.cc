// The conversion core -> proto -> bytes -> proto -> core keeps every value, and an unset value stays unset.

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
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

// tests/proto/every_field_test.cc looks after fields that are set. These structs are as their constructors leave them.
TEST(RoundTripTest, DefaultsSurvive) {
  EXPECT_EQ(ThroughWire(SolveRequest()), SolveRequest());
  EXPECT_EQ(ThroughWire(SolveResponse()), SolveResponse());
  EXPECT_EQ(ThroughWire(PlanRequest()), PlanRequest());
  EXPECT_EQ(ThroughWire(PlanResponse()), PlanResponse());
  EXPECT_EQ(ThroughWire(BoundsRequest()), BoundsRequest());
  EXPECT_EQ(ThroughWire(AuditResponse()), AuditResponse());
  EXPECT_EQ(ThroughWire(AuditBatchRequest()), AuditBatchRequest());
  EXPECT_EQ(ThroughWire(AuditBatchResponse()), AuditBatchResponse());
  EXPECT_EQ(ThroughWire(SweepRequest()), SweepRequest());
  EXPECT_EQ(ThroughWire(CostRequest()), CostRequest());
  EXPECT_EQ(ThroughWire(CostChunk()), CostChunk());
}

TEST(SceneTest, SurvivesWithEachSystem) {
  const PlanarBody flat = {1.0, 0.1, 0.2, -0.3, 1.0, -2.0, 0.5};
  const SpatialBody body = {1.0, {0.3, 0.1, 0.0, 0.2, 0.0, 0.4}, {0.1, 0.2, -0.3}, {1, 2, -3}, {0, 0, 1}};
  Scene scene = PaperScene();
  for (const System& system :
       {System(std::monostate()), System(flat), System(body), System(BodyPair()),
        System(BodyPair{PlanarPair{flat, {2.0, 0.2}}}), System(BodyPair{SpatialPair{body, {2.0}}}), System(Linkage()),
        System(Linkage{{{1.0, 2.0, 0.5, 0.1, 0.3, -1.0}, {1.5}}}), System(PlanarContact{2.0, 0.5, 1.0, 1.0, -1.0}),
        System(SpatialContact{{1, 2, 3, 4, 5, 6}, {7, 8}, -9}), System(SpatialContact{{1.0}, {}, 0.0}),
        System(Mechanism{{2.0, 0.5, 0.5, 1.0}, {1, 2, 3, 4}, {-1, 0.5}, {1}, true}), System(Mechanism())}) {
    scene.system = system;
    EXPECT_EQ(ThroughWire(scene), scene) << "system " << system.index();
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

TEST(SolveTest, SignOfZeroSurvives) {
  SolveResponse response;
  response.outcome.energy_change_j = -0.0;
  response.outcome.rates_after_rad_s = {-0.0, 0.0};
  const SolveResponse back = ThroughWire(response);
  EXPECT_EQ(Bits({back.outcome.energy_change_j}), Bits({-0.0}));
  EXPECT_EQ(Bits(back.outcome.rates_after_rad_s), Bits({-0.0, 0.0}));
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
  rates.values.assign({0.5, -0.25});
  EXPECT_EQ(ThroughWire(request), request);
}

TEST(AuditTest, EmptySummaryHasNoFirstIndices) { EXPECT_EQ(FromProto(v1::AuditBatchResponse()), AuditBatchResponse()); }

TEST(SweepTest, EmptyListIsNotAnUnsetAxis) {
  SweepRequest request;
  request.grid.axes = {{"pendulum.b_m", ListValues{}}};
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
  summary.not_converged = {1, 6};
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
  EXPECT_EQ(summary.not_converged.first_index, -1);
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
