// One sweep over several real servers, some of which die, stand still, or were never there.

#include "client/sweep_fan_out.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "client/channel.h"
#include "ricochet/client.h"
#include "ricochet/error.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "tests/client/collected_sweep.h"
#include "tests/support/processes/eventually.h"
#include "tests/support/processes/server_process.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int64_t kPoints = 1'000'000;
constexpr char kNobody[] = "127.0.0.1:1";
// Small, so that there are many ranges.
constexpr FanOut kSmall = {.buffer_bytes = 1 << 20, .slow_after = milliseconds(300)};

std::string Listed(const std::vector<std::string>& addresses) {
  std::string list;
  for (const std::string& address : addresses) list += (list.empty() ? "" : ",") + address;
  return list;
}

// The deadline is below the time after which a connection to a server that stands still counts as broken.
Client FanOutOver(const std::vector<std::string>& addresses) {
  return Client::Connect({.target = Listed(addresses), .sweep_deadline = std::chrono::seconds(35), .fan_out = kSmall})
      .value();
}

const CollectedSweep& Undisturbed() {
  static const CollectedSweep sweep = Collect(LocalSolver().Sweep(MixedSweep(kPoints)));
  return sweep;
}

class SweepFanOutTest : public testing::Test {
 protected:
  std::vector<std::string> Addresses() const {
    std::vector<std::string> all;
    for (const ServerProcess& server : servers_) all.push_back(server.address());
    return all;
  }
  // Reads a sweep over all servers, one of which receives `signal` at a chunk.
  CollectedSweep ReadWithSignal(int signal) {
    return Collect(FanOutOver(Addresses()).Sweep(MixedSweep(kPoints)), [&](int chunk) {
      if (chunk == 15) servers_[1].Signal(signal);
    });
  }

  std::array<ServerProcess, 3> servers_;
};

TEST_F(SweepFanOutTest, HasTheBitsAndTheSummaryOfOneServerAndOfTheEmbeddedEngine) {
  const CollectedSweep shared = Collect(FanOutOver(Addresses()).Sweep(MixedSweep(kPoints)));
  EXPECT_TRUE(shared.end.ok()) << shared.end;
  EXPECT_TRUE(shared == Undisturbed());
  const Client one = Client::Connect({.target = servers_[0].address()}).value();
  EXPECT_TRUE(shared == Collect(one.Sweep(MixedSweep(kPoints))));
  for (const ServerProcess& server : servers_) server.WaitForLog("Sweep");
}

TEST_F(SweepFanOutTest, ComputesPartsOfAGridAndSweepsOfFewPoints) {
  SweepRequest request = MixedSweep(kPoints);
  request.first_index = 123'456;
  for (const int64_t points : {0, 1, 2, 5, 10'000}) {
    request.end_index = request.first_index + points;
    EXPECT_TRUE(Collect(FanOutOver(Addresses()).Sweep(request)) == Collect(LocalSolver().Sweep(request))) << points;
  }
}

TEST_F(SweepFanOutTest, AKilledServerChangesNothing) {
  const CollectedSweep shared = ReadWithSignal(SIGKILL);
  EXPECT_TRUE(shared.end.ok()) << shared.end;
  EXPECT_TRUE(shared == Undisturbed());
}

TEST_F(SweepFanOutTest, ADrainedServerChangesNothing) {
  const CollectedSweep shared = ReadWithSignal(SIGTERM);
  EXPECT_TRUE(shared.end.ok()) << shared.end;
  EXPECT_TRUE(shared == Undisturbed());
}

TEST_F(SweepFanOutTest, AServerThatStandsStillChangesNothing) {
  const CollectedSweep shared = ReadWithSignal(SIGSTOP);
  EXPECT_TRUE(shared.end.ok()) << shared.end;
  EXPECT_TRUE(shared == Undisturbed());
}

TEST_F(SweepFanOutTest, AnAddressWithoutAServerChangesNothing) {
  for (const size_t place : {0u, 1u}) {
    std::vector<std::string> addresses = {servers_[0].address(), servers_[1].address()};
    addresses.insert(addresses.begin() + static_cast<std::ptrdiff_t>(place), kNobody);
    const CollectedSweep shared = Collect(FanOutOver(addresses).Sweep(MixedSweep(kPoints)));
    EXPECT_TRUE(shared.end.ok()) << shared.end;
    EXPECT_TRUE(shared == Undisturbed());
  }
}

TEST_F(SweepFanOutTest, FailsOnceAllServersAreDead) {
  const Client client = Client::Connect({.target = Listed(Addresses()),
                                         .retry = {.max_resumes = 2, .max_backoff = milliseconds(200)},
                                         .fan_out = kSmall})
                            .value();
  const CollectedSweep shared = Collect(client.Sweep(MixedSweep(kPoints)), [&](int chunk) {
    if (chunk != 15) return;
    for (const ServerProcess& server : servers_) server.Signal(SIGKILL);
  });
  EXPECT_EQ(shared.end.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(
      std::string(shared.end.message()),
      AllOf(HasSubstr("none of the 3 servers goes on with the sweep at point "), HasSubstr("the last error: ")));
}

TEST_F(SweepFanOutTest, PassesOnWhatIsWrongWithTheRequest) {
  SweepRequest request = MixedSweep(kPoints);
  request.columns = {"coefficients.newtin"};
  const CollectedSweep shared = Collect(FanOutOver(Addresses()).Sweep(request));
  EXPECT_THAT(ViolationsOf(shared.end), ElementsAre(testing::Field(&Violation::field, "columns[0]")));
  request.grid.axes = {{"friction.kinetic_coefficient", Linspace{0.0, 1.0, -1}}};
  EXPECT_EQ(Collect(FanOutOver(Addresses()).Sweep(request)).end.code(), absl::StatusCode::kInvalidArgument);
}

TEST_F(SweepFanOutTest, EndsByAStopOrADeadlineAlthoughNoServerMoves) {
  const Client client = FanOutOver(Addresses());
  std::stop_source stop;
  std::jthread stopper;
  const auto stand_still = [&](int chunk) {
    if (chunk != 3) return;
    for (const ServerProcess& server : servers_) server.Signal(SIGSTOP);
    stopper = std::jthread([&stop] {
      std::this_thread::sleep_for(milliseconds(100));
      stop.request_stop();
    });
  };
  EXPECT_EQ(Collect(client.Sweep(MixedSweep(100 * kPoints), {.stop = stop.get_token()}), stand_still).end.code(),
            absl::StatusCode::kCancelled);
  EXPECT_EQ(Collect(client.Sweep(MixedSweep(kPoints), {.is_stopped = [] { return true; }})).end.code(),
            absl::StatusCode::kCancelled);
  const auto soon = std::chrono::steady_clock::now() + milliseconds(100);
  EXPECT_EQ(Collect(client.Sweep(MixedSweep(kPoints), {.deadline = soon})).end.code(),
            absl::StatusCode::kDeadlineExceeded);
}

TEST_F(SweepFanOutTest, EndsWithItsStream) {
  const Client client = FanOutOver(Addresses());
  SweepStream stream = client.Sweep(MixedSweep(1000 * kPoints));
  EXPECT_TRUE((*stream.begin()).ok());
}

// A SweepFanOut over the servers, which tells what waits in it.
class Direct {
 public:
  Direct(const SweepRequest& request, const std::vector<std::string>& addresses, const FanOut& fan_out,
         std::function<std::unique_ptr<SweepReader::Call>(size_t, std::unique_ptr<SweepReader::Call>)> change = {}) {
    const auto channels = MakeChannels({.target = Listed(addresses)}).value();
    for (const auto& channel : channels) {
      stubs_.push_back(v1::ImpactService::NewStub(channel));
    }
    reader_.emplace(
        request,
        SweepFanOut::Servers{.start =
                                 [this, change = std::move(change)](size_t server, grpc::ClientContext* context,
                                                                    const v1::SweepRequest& part) {
                                   std::unique_ptr<SweepReader::Call> call = stubs_[server]->Sweep(context, part);
                                   return change ? change(server, std::move(call)) : std::move(call);
                                 },
                             .count = addresses.size(),
                             .retry = {},
                             .fan_out = fan_out},
        CallOptions());
  }
  SweepFanOut& reader() { return *reader_; }

 private:
  std::vector<std::unique_ptr<v1::ImpactService::StubInterface>> stubs_;
  std::optional<SweepFanOut> reader_;
};

TEST_F(SweepFanOutTest, HoldsNoMoreThanItsBufferHoweverSlowItsReaderIs) {
  constexpr FanOut kTiny = {.buffer_bytes = 100'000, .slow_after = milliseconds(60'000)};
  SweepRequest request = MixedSweep(kPoints);
  request.end_index = kPoints;
  Direct direct(request, Addresses(), kTiny);
  CollectedSweep shared;
  int64_t chunks = 0;
  while (const auto chunk = direct.reader().Next()) {
    AddTo(shared, *chunk);
    if (!chunk->ok()) break;
    // The servers run ahead until more than half of the buffer is full.
    if (++chunks == 100) {
      EXPECT_TRUE(Eventually([&] { return direct.reader().most_waiting_bytes() > 50'000; }));
    }
  }
  EXPECT_TRUE(shared == Undisturbed()) << shared.end;
  EXPECT_LE(direct.reader().most_waiting_bytes(), kTiny.buffer_bytes);
}

// A call whose messages name another engine.
class OtherEngineCall final : public SweepReader::Call {
 public:
  explicit OtherEngineCall(std::unique_ptr<SweepReader::Call> call) : call_(std::move(call)) {}
  bool Read(v1::SweepResponse* message) override {
    if (!call_->Read(message)) return false;
    message->mutable_engine()->set_fingerprint("new");
    return true;
  }
  bool NextMessageSize(uint32_t* size) override { return call_->NextMessageSize(size); }
  void WaitForInitialMetadata() override { call_->WaitForInitialMetadata(); }
  grpc::Status Finish() override { return call_->Finish(); }

 private:
  std::unique_ptr<SweepReader::Call> call_;
};

TEST_F(SweepFanOutTest, RefusesToMixEngines) {
  SweepRequest request = MixedSweep(kPoints);
  request.end_index = kPoints;
  Direct direct(request, Addresses(), kSmall,
                [](size_t server, std::unique_ptr<SweepReader::Call> call) -> std::unique_ptr<SweepReader::Call> {
                  if (server != 1) return call;
                  return std::make_unique<OtherEngineCall>(std::move(call));
                });
  absl::Status end;
  while (const auto chunk = direct.reader().Next()) {
    end = chunk->status();
    if (!end.ok()) break;
  }
  EXPECT_EQ(end.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(end.message()), HasSubstr("must not be mixed"));
}

TEST_F(SweepFanOutTest, AServerWhoseLimitIsTooLowChangesNothing) {
  const ServerProcess strict({"--max-points-per-sweep", "1000"});
  const CollectedSweep shared =
      Collect(FanOutOver({servers_[0].address(), strict.address()}).Sweep(MixedSweep(kPoints)));
  EXPECT_TRUE(shared.end.ok()) << shared.end;
  EXPECT_TRUE(shared == Undisturbed());
}

TEST_F(SweepFanOutTest, NamesTheLimitThatIsTooLowOnAllServers) {
  const ServerProcess strict({"--max-columns", "1"});
  SweepRequest request = MixedSweep(1000 * kPoints);
  request.columns.emplace_back("coefficients.poisson");
  const CollectedSweep sweep = Collect(FanOutOver({strict.address(), strict.address()}).Sweep(request));
  EXPECT_EQ(ReasonOf(sweep.end), ErrorReason::kLimitExceeded);
  const std::vector<Violation> violations = ViolationsOf(sweep.end);
  ASSERT_EQ(violations.size(), 1U) << sweep.end;
  EXPECT_EQ(violations[0].field, "columns");
  EXPECT_THAT(violations[0].description,
              HasSubstr("has 2 entries: must have at most 1, the limit max_columns (server "));
}

TEST(FanOutOptions, AreRefusedByName) {
  const absl::Status status =
      Client::Connect({.target = "a:1,b:1", .fan_out = FanOut{.buffer_bytes = 0, .slow_after = milliseconds(0)}})
          .status();
  EXPECT_THAT(ViolationsOf(status),
              ElementsAre(Violation{"fan_out.buffer_bytes", "= 0: must be > 0"},
                          Violation{"fan_out.slow_after", "= 0 ms: must be > 0 and at most a year"}));
}

}  // namespace
}  // namespace ricochet
