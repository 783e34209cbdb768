// tests/data/compliant.csv: 60 impacts with tangential compliance computed at 40 digits and more by an independent
// implementation, with the sequence of modes of each.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/models/compliant/compliant.h"
#include "tests/support/scenes/compliant_scenes.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet::compliant {
namespace {

// The file puts this mark between two sections on different branches of the normal spring, or of different sign of v.
std::string Between(const Section& before, const Section& after) {
  if (before.first_loading != after.first_loading) return before.first_loading ? " |" : " /";
  if (before.indenting != after.indenting) return before.indenting ? " _" : " ^";
  return "";
}

std::string ModesOf(const Impact& impact) {
  std::string modes;
  const Section* before = nullptr;
  for (const Section& section : impact.sections) {
    if (before != nullptr) modes += Between(*before, section) + " ";
    switch (section.friction) {
      case FrictionState::kStick:
        modes += "stick";
        break;
      case FrictionState::kSlideForward:
        modes += "slide+";
        break;
      case FrictionState::kSlideBackward:
        modes += "slide-";
        break;
    }
    before = &section;
  }
  return modes;
}

// Returns the largest error of a velocity over max(|u0|, |v0|).
double VelocityError(const VectorRow& row, const Problem& problem, const Impact& impact) {
  return std::max(std::fabs(impact.u1 - Number(row, "u1")), std::fabs(impact.v1 - Number(row, "v1"))) /
         std::max(std::fabs(problem.contact.u0), std::fabs(problem.contact.v0));
}

double ImpulseError(const VectorRow& row, const Impact& impact) {
  return std::max({std::fabs(impact.tau_compression - Number(row, "tau_compression")),
                   std::fabs(impact.tau1 - Number(row, "tau1")),
                   std::fabs(impact.f1 - Number(row, "friction_impulse"))}) /
         Number(row, "tau1");
}

// Returns the largest error of a work over the largest work.
double WorkError(const VectorRow& row, const Impact& impact) {
  const double compression = Number(row, "work_n_compression");
  const double restitution = Number(row, "work_n_restitution");
  const double tangential = Number(row, "work_t");
  const double size = std::max({std::fabs(compression), std::fabs(restitution), std::fabs(tangential)});
  return std::max({std::fabs(impact.work_normal_compression - compression),
                   std::fabs(impact.work_normal_restitution - restitution),
                   std::fabs(impact.work_tangential_compression + impact.work_tangential_restitution - tangential)}) /
         size;
}

// The promise is 1e-11; rounding leaves a thousandth of that.
constexpr double kTolerance = 1e-14;

TEST(CompliantVectorsTest, EveryRowHasTheModesOfTheFileAndItsNumbersToSomeRoundings) {
  const std::vector<VectorRow> rows = ReadVectors("compliant.csv");
  ASSERT_EQ(rows.size(), 60U);
  double worst = 0.0;
  for (size_t i = 0; i < rows.size(); ++i) {
    const Problem problem = ProblemOf(rows[i]);
    const Impact impact = Solve(problem);
    EXPECT_EQ(ModesOf(impact), rows[i].at("modes")) << "row " << i;
    const double error =
        std::max({VelocityError(rows[i], problem, impact), ImpulseError(rows[i], impact), WorkError(rows[i], impact)});
    EXPECT_LE(error, kTolerance) << "row " << i;
    worst = std::max(worst, error);
  }
  std::printf("  worst error %.2e\n", worst);
}

TEST(CompliantVectorsTest, TheErrorEstimateIsAboveTheErrorAndBelowATrillionth) {
  double largest = 0.0;
  for (const VectorRow& row : ReadVectors("compliant.csv")) {
    const Problem problem = ProblemOf(row);
    const Impact impact = Solve(problem);
    EXPECT_LE(VelocityError(row, problem, impact), impact.error_estimate);
    EXPECT_LE(impact.error_estimate, 1e-12);
    largest = std::max(largest, impact.error_estimate);
  }
  std::printf("  largest estimate %.2e\n", largest);
}

TEST(CompliantVectorsTest, AnErrorOfTwiceTheToleranceWouldBeSeen) {
  const VectorRow row = ReadVectors("compliant.csv")[0];
  Impact impact = Solve(ProblemOf(row));
  impact.tau1 *= 1.0 + 2.0 * kTolerance;
  EXPECT_GT(ImpulseError(row, impact), kTolerance);
}

}  // namespace
}  // namespace ricochet::compliant
