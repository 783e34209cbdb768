#include "server/health/self_test.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/server/fake_solver.h"

namespace ricochet::server {
namespace {

TEST(SelfTest, EngineOfThisBuildPasses) { EXPECT_TRUE(TestSolver(LocalSolver()).ok()); }

TEST(SelfTest, SolverWithAWrongAnswerFails) {
  const absl::Status status = TestSolver(FakeSolver());
  EXPECT_EQ(status.code(), absl::StatusCode::kInternal);
  EXPECT_THAT(std::string(status.message()), testing::HasSubstr("Newton's coefficient is 0, must be 0.5"));
}

}  // namespace
}  // namespace ricochet::server
