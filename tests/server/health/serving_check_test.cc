#include "server/health/serving_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace ricochet::server {
namespace {

using testing::HasSubstr;

constexpr std::chrono::milliseconds kSoon(200);
constexpr std::chrono::milliseconds kLate(20'000);

// An acceptor that listens, on TCP and a Unix socket, but accepts only once it is started; and a scheduler.
class ServingCheckTest : public testing::Test {
 protected:
  ServingCheckTest() {
    std::vector<Listener> listeners = *Listener::Open({.host = "127.0.0.1", .port = 0, .path = ""}, 0600);
    const std::string path = testing::TempDir() + "/serving_check_" + std::to_string(getpid()) + ".sock";
    std::vector<Listener> unix_listeners = *Listener::Open({.host = "", .port = 0, .path = path}, 0600);
    listeners.push_back(std::move(unix_listeners.front()));
    for (const Listener& listener : listeners) addresses_.push_back(listener.address());
    acceptor_ = std::make_unique<Acceptor>(std::move(listeners), ConnectionLimits(), log_);
  }

  void StartToAccept() {
    ASSERT_TRUE(acceptor_->Start([](int descriptor) { close(descriptor); }).ok());
  }

  absl::Status Check(std::chrono::milliseconds patience) {
    return CheckServing(addresses_, *acceptor_, scheduler_, patience, stop_.get_token());
  }

  std::ostringstream logged_;
  const Log log_{LogFormat::kText, LogLevel::kInfo, logged_};
  std::vector<ListenAddress> addresses_;
  std::unique_ptr<Acceptor> acceptor_;
  std::stop_source drain_;
  Scheduler scheduler_{1, 1, drain_.get_token()};
  std::stop_source stop_;
};

TEST_F(ServingCheckTest, PassesWhileEveryAddressAcceptsAndTheGateIsFree) {
  StartToAccept();
  EXPECT_EQ(Check(kLate), absl::OkStatus());
  EXPECT_EQ(acceptor_->counts().accepted, 2);
}

TEST_F(ServingCheckTest, FailsWhereTheKernelConnectsButNobodyAccepts) {
  const absl::Status status = Check(kSoon);
  EXPECT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("no connection was accepted"));
}

TEST_F(ServingCheckTest, FailsWhereNobodyListens) {
  StartToAccept();
  acceptor_->StopAccepting();
  const absl::Status status = Check(kSoon);
  EXPECT_TRUE(absl::IsUnavailable(status)) << status;
}

TEST_F(ServingCheckTest, FailsWhileNoCheapCallGetsItsTurn) {
  StartToAccept();
  std::promise<void> release;
  const std::shared_future<void> released = release.get_future().share();
  {
    std::vector<std::jthread> holders;
    // More calls than the scheduler has slots for cheap ones.
    for (int i = 0; i < 100; ++i) {
      holders.emplace_back([&] {
        const ComputeRequest turn = {
            .peer = "holder", .deadline = {}, .is_gone = [] { return false; }, .cost = RequestCost()};
        EXPECT_TRUE(scheduler_.Compute(turn, [&] { released.wait(); }).ok());
      });
    }
    while (scheduler_.waiting() == 0 || scheduler_.waiting() + scheduler_.computing() < 100) std::this_thread::yield();
    const absl::Status status = Check(kSoon);
    EXPECT_TRUE(absl::IsUnavailable(status)) << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("turn to compute"));
    release.set_value();
  }
  EXPECT_EQ(Check(kLate), absl::OkStatus());
}

TEST_F(ServingCheckTest, EndsEarlyOnceItIsStopped) {
  stop_.request_stop();
  EXPECT_EQ(Check(kLate), absl::OkStatus());
}

}  // namespace
}  // namespace ricochet::server
