// A program in which other code has functions of SUNDIALS' names, as Simbody's libSimTKmath has, is refused impacts
// that take time; all others are answered.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "ricochet/error.h"
#include "ricochet/solver.h"

// The program finds this function before that of SUNDIALS. It must never be called.
extern "C" void* N_VClone(void* /*vector*/) { std::abort(); }  // NOLINT(readability-identifier-naming)

namespace ricochet {
namespace {

using ::testing::HasSubstr;

TEST(ReplacedLibrary, OnlyImpactsThatTakeTimeAreRefused) {
  const LocalSolver solver;
  SolveRequest request = {.scene = {.system = PlanarContact{.w_tt_per_kg = 3.0,
                                                            .w_tn_per_kg = 0.5,
                                                            .w_nn_per_kg = 1.5,
                                                            .tangential_m_s = 1.0,
                                                            .normal_m_s = -1.0},
                                    .restitution = EnergeticCoefficient{0.5}}};
  ASSERT_TRUE(solver.Solve(request).ok());
  request.scene.compliance = Compliance{.normal = LinearSpring{1e5}};
  const absl::Status refused = solver.Solve(request).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(refused.message(), HasSubstr("compliance.normal is set: must not be, another library"));
}

TEST(ReplacedLibrary, TheEngineSaysWhatItLacks) {
  const auto info = LocalSolver().Info({});
  ASSERT_TRUE(info.ok());
  EXPECT_FALSE(info->finite_duration);
}

}  // namespace
}  // namespace ricochet
