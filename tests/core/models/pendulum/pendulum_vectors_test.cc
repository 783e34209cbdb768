// tests/data/pendulum.csv: 240 impacts computed at 60 digits by an independent implementation.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "tests/support/oracles/arb.h"
#include "tests/support/scenes/laws_by_name.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet::pendulum {
namespace {

using Row = VectorRow;

Problem ProblemOf(const Row& row) {
  const double mu = Number(row, "mu");
  return {.inertia = Number(row, "j0"),
          .a = Number(row, "a"),
          .b = Number(row, "b"),
          .omega_minus = Number(row, "omega_minus"),
          .mu = mu,
          .mu_static = mu,
          .law = LawOf(row.at("law")),
          .coefficient = Number(row, "coefficient")};
}

// The regime of a row: the file calls a locked impact "stick", and every other one "rebound", with friction or without.
bool RegimeAgrees(const Row& row, Regime regime) {
  if (row.at("regime") == "stick") return regime == Regime::kLocked;
  return regime == Regime::kRebound || regime == Regime::kFrictionless;
}

struct Column {
  const char* name;
  Output output;
  double sign;
};
constexpr Column kColumns[] = {
    {"newton", Output::kNewton, 1.0},
    {"poisson", Output::kPoisson, 1.0},
    {"energetic", Output::kEnergetic, 1.0},
    {"omega_plus", Output::kOmegaPlus, 1.0},
    {"tau0", Output::kNormalImpulseCompression, 1.0},
    {"tau1", Output::kNormalImpulse, 1.0},
    {"friction_impulse", Output::kTangentialImpulse, 1.0},
    {"mu_hat", Output::kTangentialCoefficient, 1.0},
    {"work_n_compression", Output::kWorkNormalCompression, 1.0},
    {"work_n_restitution", Output::kWorkNormalRestitution, 1.0},
    {"work_t_compression", Output::kWorkTangentialCompression, 1.0},
    {"work_t_restitution", Output::kWorkTangentialRestitution, 1.0},
    {"energy_dissipated", Output::kEnergyChange, -1.0},
};

// The rounding to 25 printed digits, plus 2^-100 of the scale for an output that changes its sign.
Ball Allowance(const Ball& expected, const Problem& problem, const Impact& impact, Output output) {
  Ball scale(0.0);
  if (output == Output::kTangentialCoefficient) scale = Ball(problem.mu);
  if (output == Output::kTangentialImpulse) {
    scale = Ball(problem.mu) * impact[Output::kNormalImpulseCompression];
  }
  return Abs(expected) * Ball::PowerOfTwo(-80) + scale * Ball::PowerOfTwo(-100);
}

TEST(PendulumVectorsTest, EveryColumnOfEveryRowIsWithinOneUlp) {
  const std::vector<Row> rows = ReadVectors("pendulum.csv");
  ASSERT_EQ(rows.size(), 240U);
  double worst = 0.0;
  for (size_t i = 0; i < rows.size(); ++i) {
    const Problem problem = ProblemOf(rows[i]);
    const Impact impact = Solve(problem);
    EXPECT_TRUE(RegimeAgrees(rows[i], impact.regime)) << "row " << i;
    for (const Column& column : kColumns) {
      const Ball expected = Ball::Parse(rows[i].at(column.name), 200);
      const double error = ErrorInUlps(column.sign * impact[column.output], expected,
                                       Allowance(expected, problem, impact, column.output));
      EXPECT_LE(error, 1.0) << "row " << i << ", " << column.name << " = " << rows[i].at(column.name);
      worst = std::max(worst, error);
    }
  }
  std::printf("  worst error %.4f ulp\n", worst);
}

TEST(PendulumVectorsTest, OneUlpOfErrorWouldBeSeen) {
  const Row row = ReadVectors("pendulum.csv")[1];
  const double tau0 = Solve(ProblemOf(row))[Output::kNormalImpulseCompression];
  const Ball expected = Ball::Parse(row.at("tau0"), 200);
  EXPECT_GT(ErrorInUlps(std::nextafter(std::nextafter(tau0, 2.0), 2.0), expected), 1.0);
}

}  // namespace
}  // namespace ricochet::pendulum
