// tests/data/planar.csv: 240 impacts of a raw planar contact computed at 40 digits by an independent implementation.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/models/planar/planar.h"
#include "tests/support/scenes/laws_by_name.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet::planar {
namespace {

Problem ProblemOf(const VectorRow& row) {
  const double mu = Number(row, "mu");
  return {.w = {Number(row, "wtt"), Number(row, "wtn"), Number(row, "wnn")},
          .u0 = Number(row, "u0"),
          .v0 = Number(row, "v0"),
          .mu = mu,
          .mu_static = mu,
          .law = LawOf(row.at("law")),
          .coefficient = Number(row, "coefficient")};
}

// The largest error over a row's columns, each over max(|value|, scale).
class RowErrors {
 public:
  explicit RowErrors(const VectorRow& row) : row_(row) {}

  void Add(const char* column, double computed, double scale) {
    const double expected = Number(row_, column);
    worst_ = std::max(worst_, std::fabs(computed - expected) / std::max(std::fabs(expected), scale));
  }
  double worst() const { return worst_; }

 private:
  const VectorRow& row_;
  double worst_ = 0.0;
};

double ErrorOf(const VectorRow& row, const Problem& problem, const Impact& impact) {
  const double speed = std::max(std::fabs(problem.u0), std::fabs(problem.v0));
  const double tau1 = Number(row, "tau1");
  double work = 0.0;
  for (const char* column : {"work_n_compression", "work_n_restitution", "work_t"}) {
    work = std::max(work, std::fabs(Number(row, column)));
  }
  RowErrors errors(row);
  errors.Add("u1", impact.u1, speed);
  errors.Add("v1", impact.v1, speed);
  errors.Add("tau_compression", impact.tau_compression, tau1);
  errors.Add("tau1", impact.tau1, tau1);
  errors.Add("friction_impulse", impact.f1, tau1);
  errors.Add("work_n_compression", impact.work_normal_compression, work);
  errors.Add("work_n_restitution", impact.work_normal_restitution, work);
  errors.Add("work_t", impact.work_tangential_compression + impact.work_tangential_restitution, work);
  errors.Add("newton", impact.newton, 1.0);
  errors.Add("poisson", impact.poisson, 1.0);
  errors.Add("energetic", impact.energetic, 1.0);
  return errors.worst();
}

// These rows include det W down to 1e-14 of Wtt Wnn.
TEST(PlanarVectorsTest, EveryColumnOfEveryRowIsWithinFourRoundings) {
  const std::vector<VectorRow> rows = ReadVectors("planar.csv");
  ASSERT_EQ(rows.size(), 240U);
  double worst = 0.0;
  for (size_t i = 0; i < rows.size(); ++i) {
    const Problem problem = ProblemOf(rows[i]);
    const double error = ErrorOf(rows[i], problem, Solve(problem));
    EXPECT_LE(error, 0x1p-51) << "row " << i;
    worst = std::max(worst, error);
  }
  std::printf("  worst error %.3g\n", worst);
}

TEST(PlanarVectorsTest, AnErrorOfATenthOfTheToleranceWouldBeSeen) {
  const VectorRow row = ReadVectors("planar.csv")[0];
  const Problem problem = ProblemOf(row);
  Impact impact = Solve(problem);
  impact.tau1 *= 1.0 + 1e-14;
  EXPECT_GT(ErrorOf(row, problem, impact), 0x1p-51);
}

}  // namespace
}  // namespace ricochet::planar
