// The times in comments were measured with the engine of 2026 on one core.

#include "server/admission/request_cost.h"

#include <gtest/gtest.h>

#include "tests/support/scenes/multi_contact_scenes.h"

namespace ricochet::server {
namespace {

Scene Chain(size_t links) {
  Scene scene;
  scene.system = Linkage{.links = std::vector<Link>(links)};
  return scene;
}

Scene Sprung() {
  Scene scene;
  scene.compliance = Compliance{.tangential_ratio_squared = {}, .normal = HertzSpring{.stiffness_n_m1_5 = 1e9}};
  return scene;
}

TEST(RequestCost, EverydayRequestsAreCheap) {
  EXPECT_TRUE(CostOf(SolveRequest()).is_cheap());
  EXPECT_TRUE(CostOf(SolveRequest{.scene = Chain(8), .history_intervals = 1000}).is_cheap());  // 0.1 ms
  EXPECT_TRUE(CostOf(PlanRequest{.scene = Sprung(), .demand = {}}).is_cheap());                // 1 us
  EXPECT_TRUE(CostOf(BoundsRequest{.scene = Chain(32)}).is_cheap());                           // 0.1 ms
  EXPECT_TRUE(CostOf(AuditRequest()).is_cheap());
  EXPECT_TRUE(CostOf(AuditBatchRequest{.scene = {}, .columns = {.normal_m_s = std::vector<double>(64)}}).is_cheap());
}

TEST(RequestCost, EachCauseMakesACallDear) {
  EXPECT_EQ(CostOf(SolveRequest{.certified_digits = 1}).cause, CostCause::kCertificate);
  EXPECT_EQ(CostOf(BoundsRequest{.scene = {}, .ranges = {}, .certified_digits = 20}).cause, CostCause::kCertificate);
  EXPECT_EQ(CostOf(BoundsRequest{.scene = {}, .ranges = {{"friction.kinetic_coefficient", 0, 1}}}).cause,
            CostCause::kEnclosure);
  EXPECT_EQ(CostOf(SolveRequest{.scene = Sprung()}).cause, CostCause::kDuration);  // 2 ms to seconds
  EXPECT_EQ(CostOf(SolveRequest{.force_intervals = 65535}).cause, CostCause::kDuration);
  EXPECT_EQ(CostOf(SolveRequest{.demand = {.relative_tolerance = {}, .required = {Effect::kFiniteDuration}}}).cause,
            CostCause::kDuration);
  EXPECT_EQ(CostOf(SolveRequest{.history_intervals = 65535}).cause, CostCause::kHistory);  // 40 ms
  EXPECT_EQ(CostOf(SolveRequest{.history_at_n_s = std::vector<double>(65535)}).cause, CostCause::kHistory);
  EXPECT_EQ(CostOf(SolveRequest{.scene = Chain(128)}).cause, CostCause::kLinks);  // 1 ms
  Scene arm;
  arm.system = Mechanism{.rates = std::vector<double>(64)};
  EXPECT_EQ(CostOf(SolveRequest{.scene = arm}).cause, CostCause::kLinks);
  EXPECT_EQ(CostOf(AuditRequest{.scene = Chain(128), .observed = {}}).cause, CostCause::kLinks);
  EXPECT_EQ(CostOf(AuditBatchRequest{.inputs = {{.path = {}, .values = std::vector<double>(8192)}}}).cause,
            CostCause::kRows);
  EXPECT_EQ(CostOf(AuditBatchRequest{.scene = {}, .columns = {.rates_after = {std::vector<double>(8192)}}}).cause,
            CostCause::kRows);                                                                // 130 ms
  EXPECT_EQ(CostOf(MultiContactRequest{.scene = SpatialBox()}).cause, CostCause::kContacts);  // 10 ms
  const auto by = [](size_t numbers) {
    const std::vector<std::string> paths(numbers, "friction.kinetic_coefficient");
    return SolveRequest{.derivatives = DerivativePaths{.of = {"coefficients.newton"}, .by = paths}};
  };
  EXPECT_TRUE(CostOf(by(8)).is_cheap());
  EXPECT_EQ(CostOf(by(9)).cause, CostCause::kDerivatives);
  MultiContactRequest block = {.scene = FallingBlock(0.5, 0.5)};
  EXPECT_TRUE(CostOf(block).is_cheap());
  block.states.resize(64);
  EXPECT_EQ(CostOf(block).cause, CostCause::kContacts);  // 10 ms
}

TEST(RequestCost, CallsOfOneSizeShareAnOctaveAndLargerOnesAreApart) {
  const auto certificate = [](size_t links, int digits) {
    return CostOf(SolveRequest{.scene = Chain(links), .certified_digits = digits});
  };
  EXPECT_EQ(certificate(1, 50), certificate(1, 63));
  EXPECT_NE(certificate(1, 50), certificate(1, 200));
  EXPECT_EQ(certificate(8, 64).octave - certificate(4, 64).octave, 3) << "a certificate takes the cube of the links";
}

// The cost is asked before any limit is applied, and 2^1100 is no double.
TEST(RequestCost, AnyNumberOfRangesHasACost) {
  const auto with_ranges = [](size_t count) {
    return CostOf(BoundsRequest{.scene = {}, .ranges = std::vector<FieldRange>(count)});
  };
  EXPECT_EQ(with_ranges(10).octave, 10);
  EXPECT_EQ(with_ranges(1100).octave, with_ranges(16'000).octave);
  EXPECT_GT(with_ranges(1100).octave, with_ranges(900).octave);
}

TEST(RequestCostTest, AFitIsNeverCheapAndGrowsWithRowsUnknownsStartsAndIterations) {
  FitRequest request = {.unknowns = {{.path = "mu"}}, .measured = {{.path = "x", .values = {1.0, 2.0}}}};
  request.max_iterations = 16;
  EXPECT_EQ(CostOf(request), (RequestCost{CostCause::kFit, 6}));
  request.starts = 4;
  EXPECT_EQ(CostOf(request).octave, 8);
  request.measured[0].values.resize(8);
  EXPECT_EQ(CostOf(request).octave, 10);
}

}  // namespace
}  // namespace ricochet::server
