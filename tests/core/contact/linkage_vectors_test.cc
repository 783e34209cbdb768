// Chains, compared with tests/data/linkage.csv, which an independent implementation computed with 40 digits.
//
// Rates, velocities and impulses agree to 1e-12 of the largest number of their kind.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/solver.h"
#include "tests/support/scenes/linkage_rows.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet {
namespace {

constexpr double kTolerance = 1e-12;

double Largest(const std::vector<double>& numbers) {
  double largest = 0.0;
  for (const double number : numbers) largest = std::max(largest, std::abs(number));
  return largest;
}

TEST(LinkageVectorsTest, EveryRowHolds) {
  const std::vector<VectorRow> rows = ReadVectors("linkage.csv");
  ASSERT_EQ(rows.size(), 66U);
  for (size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(i);
    const VectorRow& row = rows[i];
    const absl::StatusOr<SolveResponse> response = LocalSolver().Solve({.scene = ChainOf(row)});
    ASSERT_TRUE(response.ok()) << response.status();
    const Outcome& outcome = response->outcome;
    const std::vector<double> rates = NumbersIn(row.at("rate_after"));
    ASSERT_EQ(outcome.rates_after_rad_s.size(), rates.size());
    for (size_t k = 0; k < rates.size(); ++k) {
      EXPECT_NEAR(outcome.rates_after_rad_s[k], rates[k], kTolerance * std::max(Largest(rates), 1.0));
    }
    const double u0 = Number(row, "u0");
    const double v0 = Number(row, "v0");
    const double tau1 = Number(row, "tau1");
    const double speed = std::max(std::abs(u0), std::abs(v0));
    const ContactVelocity& before = outcome.timeline.front().state.contact_velocity;
    EXPECT_NEAR(before.tangential_m_s[0], u0, kTolerance * speed);
    EXPECT_NEAR(before.normal_m_s, v0, kTolerance * speed);
    EXPECT_NEAR(outcome.impulse.normal_total_n_s, tau1, kTolerance * tau1);
    EXPECT_NEAR(outcome.impulse.tangential_n_s[0], Number(row, "friction_impulse"), kTolerance * tau1);
    EXPECT_NEAR(outcome.energy_change_j, Number(row, "energy_change"), kTolerance * std::max(tau1 * speed, 1.0));
    const Coefficients& coefficients = outcome.coefficients;
    for (const auto& [name, value] :
         {std::pair("newton", coefficients.newton), std::pair("poisson", *coefficients.poisson),
          std::pair("energetic", *coefficients.energetic)}) {
      EXPECT_NEAR(value, Number(row, name), kTolerance * std::max(1.0, Number(row, name))) << name;
    }
  }
}

}  // namespace
}  // namespace ricochet
