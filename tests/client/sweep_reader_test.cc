// Sweeps that break off: when and where they are taken up again, and that nothing of them is lost or doubled.

#include "client/sweep_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "proto/wire/status.h"
#include "proto/wire/sweep.h"
#include "ricochet/error.h"
#include "ricochet/solver.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

constexpr int64_t kPoints = 100'000;

// Points of several regimes, some of them invalid.
SweepRequest Request() {
  SweepRequest request;
  request.grid.scene.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  request.grid.scene.restitution = EnergeticCoefficient{1.0};
  request.grid.axes = {{"friction.kinetic_coefficient", Linspace{-0.1, 0.4, kPoints}}};
  request.columns = {"coefficients.newton", "energy_change_j"};
  request.with_regime = true;
  return request;
}

// One call: it sends this many chunks, and then this status.
struct Call {
  int chunks;
  absl::Status end;
  std::function<void(v1::SweepResponse&)> damage = {};
};

class FakeCall final : public SweepReader::Call {
 public:
  FakeCall(Call call, const v1::SweepRequest& request)
      : call_(std::move(call)),
        seal_(FromProto(request)),
        stream_(LocalSolver().Sweep(FromProto(request))),
        next_(stream_.begin()) {}

  bool Read(v1::SweepResponse* message) override {
    if (call_.chunks-- <= 0 || next_ == stream_.end()) return false;
    ToProto(**next_, *message);
    seal_.Put(*message);
    if (call_.damage) call_.damage(*message);
    ++next_;
    return true;
  }
  bool NextMessageSize(uint32_t* /*size*/) override { return true; }
  void WaitForInitialMetadata() override {}
  grpc::Status Finish() override { return ToGrpcStatus(call_.end); }

 private:
  Call call_;
  ChunkSeal seal_;
  SweepStream stream_;
  SweepStream::Iterator next_;
};

// The joined chunks of a sweep, and how it ended.
struct Joint {
  std::vector<uint64_t> newton;  // The bits of one column.
  std::vector<Regime> regimes;
  std::optional<SweepSummary> summary;
  absl::Status end;
};

void Append(const absl::StatusOr<SweepChunk>& chunk, Joint& joint) {
  joint.end = chunk.status();
  if (!chunk.ok()) return;
  EXPECT_EQ(chunk->first_index, static_cast<int64_t>(joint.newton.size()));
  for (int64_t i = 0; i < chunk->count; ++i) {
    joint.newton.push_back(std::bit_cast<uint64_t>(chunk->values[static_cast<size_t>(i)]));
  }
  joint.regimes.insert(joint.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
  joint.summary = chunk->summary;
  EXPECT_EQ(chunk->points_done, static_cast<int64_t>(joint.newton.size()));
  EXPECT_EQ(chunk->points_total, kPoints);
  EXPECT_EQ(chunk->tallies.points, chunk->points_done);
}

const Joint& Undisturbed() {
  static const Joint joint = [] {
    Joint whole;
    for (const auto& chunk : LocalSolver().Sweep(Request())) Append(chunk, whole);
    return whole;
  }();
  return joint;
}

class SweepReaderTest : public testing::Test {
 protected:
  // Reads a sweep whose calls go as `calls` say, one after another; all later calls go well.
  Joint Read(std::vector<Call> calls, size_t servers = 2, CallOptions options = {}) {
    PreferredServer preferred(servers);
    SweepReader reader(
        Request(),
        [this, calls](size_t server, grpc::ClientContext* /*context*/, const v1::SweepRequest& request) {
          const size_t call = asked_.size();
          asked_.push_back(server);
          starts_.push_back(request.first_index());
          return std::make_unique<FakeCall>(call < calls.size() ? calls[call] : Call{1000, {}}, request);
        },
        preferred, policy_, std::nullopt, options,
        [this](milliseconds time, const CallOptions& given) {
          waits_.push_back(time);
          return !given.stop.stop_requested();
        });
    Joint joint;
    while (const auto chunk = reader.Next()) {
      Append(*chunk, joint);
      if (!chunk->ok()) break;
    }
    return joint;
  }

  RetryPolicy policy_{.max_attempts = 3, .max_resumes = 4};
  std::vector<size_t> asked_;
  std::vector<int64_t> starts_;
  std::vector<milliseconds> waits_;
};

absl::Status Busy(milliseconds delay) {
  absl::Status status = MakeError(absl::StatusCode::kResourceExhausted, ErrorReason::kTooManyCalls, "busy");
  SetRetryDelay(delay, status);
  return status;
}

TEST_F(SweepReaderTest, JoinsTheBitsAndTheSummaryOfAnUndisturbedSweep) {
  const Joint joint = Read({{1, absl::UnavailableError("gone")},
                            {2, absl::UnknownError("a proxy's word for gone")},
                            {0, absl::InternalError("another proxy's")},
                            {1, absl::CancelledError("a drain's")}});
  EXPECT_TRUE(joint.end.ok()) << joint.end;
  EXPECT_EQ(joint.newton, Undisturbed().newton);
  EXPECT_EQ(joint.regimes, Undisturbed().regimes);
  EXPECT_EQ(joint.summary, Undisturbed().summary);
  EXPECT_GT(joint.summary->by_regime[static_cast<size_t>(Regime::kInvalid)].count, 0);
  EXPECT_THAT(asked_, ElementsAre(0, 1, 0, 1, 0));
  EXPECT_EQ(starts_[2], starts_[3]);
  EXPECT_LT(starts_[3], starts_[4]);
}

TEST_F(SweepReaderTest, AnErrorThatAnotherCallCannotCureEndsTheSweep) {
  for (const absl::Status& error :
       {absl::InvalidArgumentError("bad"), absl::DataLossError("lost"), absl::DeadlineExceededError("late"),
        absl::ResourceExhaustedError("too large"), Busy(std::chrono::hours(1))}) {
    asked_.clear();
    EXPECT_EQ(Read({{1, error}}).end.code(), error.code());
    EXPECT_THAT(asked_, SizeIs(1)) << error;
  }
}

TEST_F(SweepReaderTest, WaitsAsLongAsTheServerAsks) {
  EXPECT_TRUE(Read({{1, Busy(milliseconds(7000))}}, 1).end.ok());
  ASSERT_THAT(waits_, SizeIs(1));
  EXPECT_GT(waits_[0], milliseconds(6000));
  EXPECT_LE(waits_[0], milliseconds(7000));
}

TEST_F(SweepReaderTest, AnotherServerNeedNotBeWaitedFor) {
  EXPECT_TRUE(Read({{1, Busy(milliseconds(7000))}}, 2).end.ok());
  ASSERT_THAT(waits_, SizeIs(1));
  EXPECT_LE(waits_[0], policy_.initial_backoff);
}

TEST_F(SweepReaderTest, GivesUpAfterTheMostFailuresInARow) {
  const Call down = {0, absl::UnavailableError("down")};
  EXPECT_EQ(Read({{1, down.end}, down, down, down, down, down}).end.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(asked_, SizeIs(5));
}

TEST_F(SweepReaderTest, ANewPointStartsTheCountAnew) {
  const Call down = {0, absl::UnavailableError("down")};
  const Call once = {1, absl::UnavailableError("down")};
  EXPECT_TRUE(Read({once, down, down, down, once, down, down, down}).end.ok());
}

TEST_F(SweepReaderTest, BeforeItsFirstPointASweepIsTriedAsOftenAsOtherCalls) {
  const Call down = {0, absl::UnavailableError("down")};
  EXPECT_EQ(Read({down, down, down, down}).end.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(asked_, SizeIs(3));
}

TEST_F(SweepReaderTest, WaitsAreRandomAndTheirLimitGrows) {
  policy_ = {.max_resumes = 6, .initial_backoff = milliseconds(1 << 20), .max_backoff = milliseconds(4 << 20)};
  const Call down = {0, absl::UnavailableError("down")};
  Read({{1, down.end}, down, down, down, down, down});
  ASSERT_THAT(waits_, SizeIs(6));
  int64_t limit = 1 << 20;
  for (const milliseconds wait : waits_) {
    EXPECT_LE(wait.count(), limit);
    limit = std::min<int64_t>(2 * limit, 4 << 20);
  }
  // Equal waits are as likely as two equal draws out of a million.
  EXPECT_NE(waits_[3], waits_[4]);
}

TEST_F(SweepReaderTest, AnotherEngineIsRefused) {
  const Joint joint =
      Read({{1, absl::UnavailableError("gone")},
            {1000, {}, [](v1::SweepResponse& message) { message.mutable_engine()->set_fingerprint("new"); }}});
  EXPECT_EQ(joint.end.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(joint.end.message()), HasSubstr("must not be mixed"));
}

TEST_F(SweepReaderTest, ADamagedChunkIsDataLoss) {
  const Joint joint =
      Read({{2, absl::UnavailableError("gone")},
            {1000, {}, [](v1::SweepResponse& message) { message.mutable_values()->at(5 * sizeof(double)) ^= 1; }}});
  EXPECT_EQ(joint.end.code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(asked_, SizeIs(2));
}

TEST_F(SweepReaderTest, AStopIsNotTakenForAFailure) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(Read({{0, absl::CancelledError("stopped")}}, 2, {.stop = stop.get_token()}).end.code(),
            absl::StatusCode::kCancelled);
  EXPECT_THAT(asked_, SizeIs(1));
}

TEST_F(SweepReaderTest, AFailureAfterTheSummaryLosesNothing) {
  const Joint joint = Read({{1000, absl::UnavailableError("gone")}});
  EXPECT_TRUE(joint.end.ok()) << joint.end;
  EXPECT_EQ(joint.summary, Undisturbed().summary);
  EXPECT_THAT(asked_, SizeIs(1));
}

}  // namespace
}  // namespace ricochet
