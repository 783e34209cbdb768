// Columns that are derivatives: those of a Solve of each row, for every system and kind of scene.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/answer/derivative_paths.h"
#include "core/answer/derivatives.h"
#include "core/answer/exact_derivatives.h"
#include "core/base/derivative_name.h"
#include "core/rows/column.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/random_scenes.h"

namespace ricochet {
namespace {

using ::testing::HasSubstr;

constexpr char kMu[] = "friction.kinetic_coefficient";

class EverySystem : public testing::TestWithParam<size_t> {};

TEST_P(EverySystem, ColumnIsTheDerivativeOfASolve) {
  const RandomSystem system = RandomSystems()[GetParam()];
  RandomScenes random(70 + GetParam());
  const LocalSolver solver;
  const std::string normal = "contact_velocity_after.normal_m_s";
  for (const SceneKind& kind : SceneKinds(system)) {
    Scene scene = kind.make(random);
    if (!Validate(scene).empty()) continue;
    if (!scene.compliance.has_value()) scene.friction.static_coefficient = 0.6;
    std::vector<double> mu = {0.0, 0.1, 0.35};
    const std::vector<std::string> columns = {DerivativeName{normal, kMu}.Text(), normal,
                                              DerivativeName{"impulse.normal_total_n_s", kMu}.Text()};
    std::vector<std::vector<double>> outputs(columns.size(), std::vector<double>(mu.size()));
    std::vector<Regime> regimes(mu.size());
    std::vector<RowStatus> statuses(mu.size());
    const std::vector<absl::Span<const double>> inputs = {mu};
    std::vector<absl::Span<double>> places;
    for (auto& column : outputs) places.push_back(absl::MakeSpan(column));
    const BatchSetup setup = {.scene = scene, .fields = {kMu}, .columns = columns};
    const auto summary = solver.SolveBatch(setup, {.inputs = inputs,
                                                   .outputs = places,
                                                   .regimes = absl::MakeSpan(regimes),
                                                   .statuses = absl::MakeSpan(statuses)});
    ASSERT_TRUE(summary.ok()) << kind.name << " " << summary.status();
    for (size_t i = 0; i < mu.size(); ++i) {
      Scene row = scene;
      row.friction.kinetic_coefficient = mu[i];
      const auto solved = solver.Solve(
          {.scene = row, .derivatives = DerivativePaths{.of = {normal, "impulse.normal_total_n_s"}, .by = {kMu}}});
      ASSERT_TRUE(solved.ok()) << kind.name << " " << solved.status();
      bool is_complete = true;
      for (size_t d = 0; d < 2; ++d) {
        const auto& value = solved->outcome.derivatives[d].value;
        const double number = outputs[2 * d][i];
        is_complete &= value.has_value();
        EXPECT_EQ(std::isnan(number), !value.has_value()) << kind.name << " " << mu[i];
        if (!value.has_value()) continue;
        EXPECT_EQ(std::bit_cast<uint64_t>(number), std::bit_cast<uint64_t>(*value)) << kind.name << " " << mu[i];
      }
      EXPECT_EQ(outputs[1][i], solved->outcome.contact_velocity_after.normal_m_s);
      EXPECT_EQ(regimes[i], solved->outcome.regime);
      if (!solved->outcome.admissible || solved->outcome.termination != Termination::kConverged) continue;
      EXPECT_EQ(statuses[i], is_complete ? RowStatus::kOk : RowStatus::kIncomplete);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Systems, EverySystem, testing::Range<size_t>(0, 10));

Scene ContactScene() {
  return {.system = PlanarContact{2.0, 0.5, 1.0, 0.3, -1.0},
          .friction = {.kinetic_coefficient = 0.5},
          .restitution = EnergeticCoefficient{0.6}};
}

std::string Refusal(const std::string& column, const DemandFields& demand = {}) {
  const LocalSolver solver;
  const std::vector<double> mu = {0.1};
  std::vector<double> out(1);
  const std::vector<absl::Span<const double>> inputs = {mu};
  std::vector<absl::Span<double>> outputs = {absl::MakeSpan(out)};
  const BatchSetup setup = {.scene = ContactScene(), .fields = {kMu}, .columns = {column}, .demand = demand};
  return std::string(solver.SolveBatch(setup, {.inputs = inputs, .outputs = outputs}).status().message());
}

TEST(DerivativeColumnsTest, WrongNamesAreRefused) {
  EXPECT_THAT(Refusal("d(coefficients.newtn)/d(friction.kinetic_coefficient)"),
              HasSubstr("must have in its first d() a coefficient, an impulse, a contact velocity"));
  EXPECT_THAT(Refusal("d(coefficients.newton)/d(friction.kinetic)"), HasSubstr("must have in its second d() a number"));
  EXPECT_THAT(Refusal("d(contact.duration_s)/d(friction.kinetic_coefficient)"), HasSubstr("first d()"));
  EXPECT_THAT(Refusal("d(coefficients.newton)/(friction.kinetic_coefficient)"), HasSubstr("be a column of the scene"));
  EXPECT_THAT(Refusal("d(coefficients.newton)/d(friction.kinetic_coefficient)", {.excluded = {Effect::kFriction}}),
              HasSubstr("derivatives leave nothing out"));
}

TEST(DerivativeColumnsTest, SweepHasThem) {
  const SweepRequest request = {.grid = {.scene = ContactScene(), .axes = {{kMu, ListValues{{0.1, 0.2, 0.3}}}}},
                                .columns = {DerivativeName{"coefficients.newton", "restitution.energetic"}.Text()}};
  const LocalSolver solver;
  std::vector<double> found;
  for (absl::StatusOr<SweepChunk>& chunk : solver.Sweep(request)) {
    ASSERT_TRUE(chunk.ok()) << chunk.status();
    found.insert(found.end(), chunk->values.begin(), chunk->values.end());
  }
  ASSERT_EQ(found.size(), 3U);
  for (size_t i = 0; i < 3; ++i) {
    Scene row = ContactScene();
    row.friction.kinetic_coefficient = std::vector{0.1, 0.2, 0.3}[i];
    const DerivativePaths paths = {.of = {"coefficients.newton"}, .by = {"restitution.energetic"}};
    EXPECT_EQ(found[i], *ExactDerivativesOf(row, paths)[0].value);
  }
}

}  // namespace
}  // namespace ricochet
