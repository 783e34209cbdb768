// Chunks that do not fit together, are damaged or belong elsewhere, as a broken server or proxy may send them.

#include "client/chunk_checker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>
#include <string>

#include "proto/wire/sweep.h"

namespace ricochet {
namespace {

constexpr auto kRebound = static_cast<size_t>(Regime::kRebound);
constexpr auto kSliding = static_cast<size_t>(Regime::kSliding);
constexpr auto kInvalid = static_cast<size_t>(Regime::kInvalid);
constexpr auto kPendulum = static_cast<size_t>(Model::kPendulum);

SweepRequest Sweep(bool with_regime = false) {
  SweepRequest request;
  request.grid.scene.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  request.grid.scene.restitution = EnergeticCoefficient{1.0};
  request.grid.axes = {{"friction.kinetic_coefficient", Linspace{0.0, 0.4, 100}}};
  request.columns = {"coefficients.newton", "coefficients.poisson"};
  request.with_regime = with_regime;
  return request;
}

// Points that all rebound, in a call that starts at point `start`.
SweepChunk Chunk(int64_t first, int64_t count, bool last, int64_t start = 0) {
  SweepChunk chunk{.first_index = first, .count = count, .values = {}, .regimes = {}, .points_total = 100};
  for (int64_t i = 0; i < 2 * count; ++i) chunk.values.push_back(0.25 * static_cast<double>(i));
  chunk.tallies.points = first + count - start;
  chunk.tallies.by_regime[kRebound] = chunk.tallies.by_model[kPendulum] = {chunk.tallies.points, start};
  if (last) chunk.summary = chunk.tallies;
  chunk.engine = {"1.2.3", "0123456789abcdef"};
  return chunk;
}

v1::SweepResponse Sealed(const SweepChunk& chunk, const SweepRequest& request) {
  v1::SweepResponse message;
  ToProto(chunk, message);
  ChunkSeal(request).Put(message);
  return message;
}

v1::SweepResponse Sealed(const SweepChunk& chunk) { return Sealed(chunk, Sweep()); }

absl::StatusCode CodeOf(const absl::StatusOr<SweepChunk>& chunk) { return chunk.status().code(); }

struct BadSecondChunk {
  const char* name;
  std::function<void(SweepChunk&)> damage;
};

void PrintTo(const BadSecondChunk& bad, std::ostream* stream) { *stream << bad.name; }

class ChunkCheckerRefuses : public testing::TestWithParam<BadSecondChunk> {};

INSTANTIATE_TEST_SUITE_P(
    Chunks, ChunkCheckerRefuses,
    testing::Values(
        BadSecondChunk{"AGap", [](SweepChunk& chunk) { chunk.first_index = 41; }},
        BadSecondChunk{"ARepeat", [](SweepChunk& chunk) { chunk.first_index = 0; }},
        BadSecondChunk{"TooFewValues", [](SweepChunk& chunk) { chunk.values.pop_back(); }},
        BadSecondChunk{"TooManyValues", [](SweepChunk& chunk) { chunk.values.resize(124); }},
        BadSecondChunk{"ANegativeCount", [](SweepChunk& chunk) { chunk.count = -60; }},
        BadSecondChunk{"PointsBeyondTheEnd", [](SweepChunk& chunk) { chunk = Chunk(40, 61, true); }},
        BadSecondChunk{"ACountThatOverflows", [](SweepChunk& chunk) { chunk.count = int64_t{1} << 62; }},
        BadSecondChunk{"RegimesNotAskedFor", [](SweepChunk& chunk) { chunk.regimes.resize(60); }},
        BadSecondChunk{"NoSummaryAtTheEnd", [](SweepChunk& chunk) { chunk.summary.reset(); }},
        BadSecondChunk{"ASummaryTooEarly", [](SweepChunk& chunk) { chunk = Chunk(40, 10, true); }},
        BadSecondChunk{"AnotherEngine", [](SweepChunk& chunk) { chunk.engine.fingerprint = "fedcba9876543210"; }},
        BadSecondChunk{"ASummaryUnlikeItsTallies", [](SweepChunk& chunk) { ++chunk.summary->points; }},
        BadSecondChunk{"TooManyPointsCounted",
                       [](SweepChunk& chunk) { chunk.summary->points = ++chunk.tallies.points; }},
        BadSecondChunk{"APointLost",
                       [](SweepChunk& chunk) {
                         --chunk.tallies.by_regime[kRebound].count;
                         chunk.summary = chunk.tallies;
                       }},
        BadSecondChunk{"APointWithoutAModel",
                       [](SweepChunk& chunk) {
                         --chunk.tallies.by_model[kPendulum].count;
                         chunk.summary = chunk.tallies;
                       }},
        BadSecondChunk{"AnInvalidPointWithAModel",
                       [](SweepChunk& chunk) {
                         --chunk.tallies.by_regime[kRebound].count;
                         chunk.tallies.by_regime[kInvalid] = {1, 50};
                         chunk.summary = chunk.tallies;
                       }},
        BadSecondChunk{"CountsThatOverflow",
                       [](SweepChunk& chunk) {
                         chunk.tallies.by_regime[kSliding] = chunk.tallies.by_regime[kInvalid] = {int64_t{1} << 62, 40};
                         chunk.summary = chunk.tallies;
                       }},
        BadSecondChunk{"AFirstPointThatIsNotNew",
                       [](SweepChunk& chunk) {
                         chunk.tallies.by_regime[kRebound].count = 99;
                         chunk.tallies.by_regime[kSliding] = {1, 39};
                         chunk.summary = chunk.tallies;
                       }},
        BadSecondChunk{"ATallyWithoutPoints",
                       [](SweepChunk& chunk) {
                         chunk.tallies.inadmissible = {0, 7};
                         chunk.summary = chunk.tallies;
                       }},
        BadSecondChunk{"MoreInadmissiblePointsThanPoints",
                       [](SweepChunk& chunk) {
                         chunk.tallies.inadmissible = {61, 40};
                         chunk.summary = chunk.tallies;
                       }}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

TEST_P(ChunkCheckerRefuses, AsDataLoss) {
  ChunkChecker checker(Sweep());
  ASSERT_TRUE(checker.Accept(Sealed(Chunk(0, 40, false))).ok());
  SweepChunk second = Chunk(40, 60, true);
  ASSERT_TRUE(ChunkChecker(checker).Accept(Sealed(second)).ok());
  GetParam().damage(second);
  EXPECT_EQ(CodeOf(checker.Accept(Sealed(second))), absl::StatusCode::kDataLoss);
}

TEST(ChunkChecker, RefusesAnEndBeforeTheLastPoint) {
  ChunkChecker checker(Sweep());
  EXPECT_EQ(checker.CheckEnd().code(), absl::StatusCode::kDataLoss);
  ASSERT_TRUE(checker.Accept(Sealed(Chunk(0, 40, false))).ok());
  EXPECT_EQ(checker.CheckEnd().code(), absl::StatusCode::kDataLoss);
  ASSERT_TRUE(checker.Accept(Sealed(Chunk(40, 60, true))).ok());
  EXPECT_TRUE(checker.CheckEnd().ok());
}

TEST(ChunkChecker, HoldsASubRangeToItsOwnEnds) {
  SweepRequest request = Sweep();
  request.first_index = 10;
  request.end_index = 30;
  ChunkChecker checker(request);
  EXPECT_EQ(CodeOf(ChunkChecker(request).Accept(Sealed(Chunk(0, 20, true)))), absl::StatusCode::kDataLoss);
  EXPECT_TRUE(checker.Accept(Sealed(Chunk(10, 20, true, 10))).ok());
}

TEST(ChunkChecker, CountsTheRegimesThatTheRequestAskedFor) {
  const SweepRequest request = Sweep(true);
  SweepChunk chunk = Chunk(0, 100, true);
  EXPECT_EQ(CodeOf(ChunkChecker(request).Accept(Sealed(chunk, request))), absl::StatusCode::kDataLoss);
  chunk.regimes.resize(100, Regime::kRebound);
  EXPECT_EQ(CodeOf(ChunkChecker(request).Accept(Sealed(chunk, request))), absl::StatusCode::kDataLoss);
  chunk.statuses.resize(100, RowStatus::kOk);
  EXPECT_TRUE(ChunkChecker(request).Accept(Sealed(chunk, request)).ok());
  chunk.regimes[7] = Regime::kSliding;
  EXPECT_EQ(CodeOf(ChunkChecker(request).Accept(Sealed(chunk, request))), absl::StatusCode::kDataLoss);
}

TEST(ChunkChecker, CountsTheInadmissiblePoints) {
  const SweepRequest request = Sweep(true);
  SweepChunk chunk = Chunk(0, 100, true);
  chunk.regimes.resize(100, Regime::kRebound);
  chunk.statuses.resize(100, RowStatus::kOk);
  chunk.statuses[7] = RowStatus::kInadmissible;
  EXPECT_EQ(CodeOf(ChunkChecker(request).Accept(Sealed(chunk, request))), absl::StatusCode::kDataLoss);
  chunk.tallies.inadmissible = chunk.summary->inadmissible = {1, 7};
  EXPECT_TRUE(ChunkChecker(request).Accept(Sealed(chunk, request)).ok());
}

TEST(ChunkChecker, RefusesEveryFlippedBitOfTheData) {
  const SweepRequest request = Sweep(true);
  SweepChunk chunk = Chunk(0, 100, true);
  chunk.regimes.resize(100, Regime::kRebound);
  chunk.statuses.resize(100, RowStatus::kOk);
  const v1::SweepResponse whole = Sealed(chunk, request);
  for (int bit = 0; bit < 64; ++bit) {
    v1::SweepResponse damaged = whole;
    char& byte = damaged.mutable_values()->at(25 * static_cast<size_t>(bit));
    byte = static_cast<char>(byte ^ 1 << bit % 8);
    EXPECT_EQ(CodeOf(ChunkChecker(request).Accept(damaged)), absl::StatusCode::kDataLoss) << bit;
  }
  v1::SweepResponse swapped = whole;
  char* const second = swapped.mutable_values()->data() + sizeof(double);
  std::swap_ranges(second, second + sizeof(double), second + sizeof(double));
  ASSERT_NE(swapped.values(), whole.values());
  EXPECT_THAT(std::string(ChunkChecker(request).Accept(swapped).status().message()), testing::HasSubstr("checksum"));
}

TEST(ChunkChecker, RefusesAPartOfADouble) {
  v1::SweepResponse message = Sealed(Chunk(0, 40, false));
  message.mutable_values()->append("1234567");
  ChunkSeal(Sweep()).Put(message);
  const absl::Status status = ChunkChecker(Sweep()).Accept(message).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(status.message()), testing::HasSubstr("647 bytes of values, which are no whole doubles"));
}

TEST(ChunkChecker, RefusesTheChunkOfAnotherRequest) {
  SweepRequest other = Sweep();
  other.grid.axes[0].values = Linspace{0.0, 0.5, 100};
  EXPECT_EQ(CodeOf(ChunkChecker(Sweep()).Accept(Sealed(Chunk(0, 40, false), other))), absl::StatusCode::kDataLoss);
  EXPECT_TRUE(ChunkChecker(other).Accept(Sealed(Chunk(0, 40, false), other)).ok());
}

}  // namespace
}  // namespace ricochet
