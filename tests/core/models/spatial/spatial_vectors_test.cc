// tests/data/spatial.csv: 48 impacts computed at 40 digits and more by an independent implementation.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "core/models/spatial/spatial.h"
#include "tests/support/scenes/laws_by_name.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet::spatial {
namespace {

using Row = VectorRow;

Problem ProblemOf(const Row& row, double tolerance) {
  const double mu = Number(row, "mu");
  return {.w11 = Number(row, "w11"),
          .w12 = Number(row, "w12"),
          .w13 = Number(row, "w13"),
          .w22 = Number(row, "w22"),
          .w23 = Number(row, "w23"),
          .w33 = Number(row, "w33"),
          .u0 = {Number(row, "u0_1"), Number(row, "u0_2")},
          .v0 = Number(row, "v0"),
          .mu = mu,
          .mu_static = mu,
          .law = LawOf(row.at("law")),
          .coefficient = Number(row, "coefficient"),
          .tolerance = tolerance};
}

Regime RegimeOf(const Row& row) {
  const std::map<std::string, Regime> regimes = {{"slip+slip", Regime::kSliding},
                                                 {"slip+stick+stick", Regime::kStickInCompression},
                                                 {"slip+slip+stick", Regime::kStickInRestitution},
                                                 {"slip+restart", Regime::kReversalInCompression}};
  return regimes.at(row.at("phases"));
}

// The largest error of a velocity over max(|u0|, |v0|).
double VelocityError(const Row& row, const Problem& problem, const Impact& impact) {
  const double scale = std::max(std::hypot(problem.u0[0], problem.u0[1]), std::fabs(problem.v0));
  return std::max(std::hypot(impact.u1[0] - Number(row, "u1_1"), impact.u1[1] - Number(row, "u1_2")),
                  std::fabs(impact.v1 - Number(row, "v1"))) /
         scale;
}

struct Column {
  const char* name;
  double value;
};

class SpatialVectorsTest : public testing::TestWithParam<double> {};

TEST_P(SpatialVectorsTest, EveryRowIsWithinTheToleranceAskedAndTheEstimate) {
  const std::vector<Row> rows = ReadVectors("spatial.csv");
  ASSERT_EQ(rows.size(), 48U);
  double worst = 0.0;
  for (size_t i = 0; i < rows.size(); ++i) {
    const Problem problem = ProblemOf(rows[i], GetParam());
    const Impact impact = Solve(problem);
    const double error = VelocityError(rows[i], problem, impact);
    EXPECT_EQ(impact.regime, RegimeOf(rows[i])) << "row " << i;
    EXPECT_TRUE(impact.Converged()) << "row " << i;
    EXPECT_LE(error, GetParam()) << "row " << i;
    EXPECT_LE(error, impact.error_estimate) << "row " << i;
    EXPECT_LE(impact.error_estimate, GetParam()) << "row " << i;
    worst = std::max(worst, error);
  }
  std::printf("  worst error %.2e for a tolerance of %.0e\n", worst, GetParam());
}

TEST_P(SpatialVectorsTest, ImpulsesAndWorksAreWithinTenTimesTheTolerance) {
  const std::vector<Row> rows = ReadVectors("spatial.csv");
  for (size_t i = 0; i < rows.size(); ++i) {
    const Impact impact = Solve(ProblemOf(rows[i], GetParam()));
    const double impulse = 10.0 * GetParam() * Number(rows[i], "tau1");
    EXPECT_NEAR(impact.tau_compression, Number(rows[i], "tau_compression"), impulse) << "row " << i;
    EXPECT_NEAR(impact.tau1, Number(rows[i], "tau1"), impulse) << "row " << i;
    const Column works[] = {{"work_n_compression", impact.work_normal_compression},
                            {"work_n_restitution", impact.work_normal_restitution},
                            {"work_t", impact.work_tangential_compression + impact.work_tangential_restitution}};
    double scale = 0.0;
    for (const Column& work : works) scale = std::max(scale, std::fabs(Number(rows[i], work.name)));
    for (const Column& work : works) {
      EXPECT_NEAR(work.value, Number(rows[i], work.name), 10.0 * GetParam() * scale)
          << "row " << i << ", " << work.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Tolerances, SpatialVectorsTest, testing::Values(1e-4, 1e-6, 1e-9, 1e-12));

}  // namespace
}  // namespace ricochet::spatial
