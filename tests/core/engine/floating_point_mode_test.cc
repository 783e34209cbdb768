// The floating-point mode of a caller changes no bit of an answer, and the caller has it again afterwards.

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <cfenv>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "ricochet/solver.h"
#include "tests/core/fit/fit_cases.h"
#include "tests/support/scenes/multi_contact_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

constexpr unsigned kRaised = 0x3f;  // The exceptions that have occurred.

struct Mode {
  std::string name;
  std::function<void()> set;
};

void PrintTo(const Mode& mode, std::ostream* out) { *out << mode.name; }

std::vector<Mode> Modes() {
  return {{"FlushesSubnormals", [] { _mm_setcsr(_mm_getcsr() | 0x8040); }},
          {"RoundsUp", [] { std::fesetround(FE_UPWARD); }},
          {"RoundsDown", [] { std::fesetround(FE_DOWNWARD); }},
          {"RoundsTowardZero", [] { std::fesetround(FE_TOWARDZERO); }},
          {"Traps", [] { feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW | FE_UNDERFLOW); }}};
}

// Every system, a pendulum among them, then three scenes whose numbers are subnormal on their way.
std::vector<Scene> Scenes() {
  std::vector<Scene> scenes = {With(Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0})};
  for (const System& system : Systems()) scenes.push_back(With(system));
  scenes.push_back(With(Pendulum{.inertia_kg_m2 = 3e40, .a_m = 3e-90, .b_m = 1e-150, .omega_minus_rad_s = -2e-200}));
  scenes.push_back(With(PlanarContact{2e-160, 0.5e-160, 1e-160, 1e-158, -1.1e-158}));
  scenes.push_back(With(SpatialContact{{2e-160, 0, 0.7e-160, 3e-160, 0, 1e-160}, {1e-158, 0.3e-158}, -1.1e-158}));
  return scenes;
}

// The answers of each call of a LocalSolver, but for the times that a study of cost measures.
struct Answers {
  std::vector<Outcome> outcomes;
  std::vector<Plan> plans;
  std::vector<Bounds> bounds;
  std::vector<AuditResponse> audits;
  std::vector<AuditBatchResponse> audited;
  FitResponse fit;
  std::vector<double> batch, sweep;
  std::vector<MultiContactAnswer> several;
  std::vector<std::optional<ContactVelocity>> studied;
  friend bool operator==(const Answers&, const Answers&) = default;
};

// So many impacts take longer than a millisecond, so that a helper computes a part.
constexpr size_t kRows = 4096;

std::vector<double> BatchOf(const LocalSolver& solver, const Scene& scene) {
  std::vector<double> friction(kRows), after(kRows);
  for (size_t i = 0; i < kRows; ++i) friction[i] = static_cast<double>(i) / static_cast<double>(kRows);
  const BatchSetup setup = {
      .scene = scene, .fields = {"friction.kinetic_coefficient"}, .columns = {"contact_velocity_after.normal_m_s"}};
  EXPECT_TRUE(solver.SolveBatch(setup, {.inputs = {friction}, .outputs = {absl::MakeSpan(after)}}).ok());
  return after;
}

std::vector<double> SweepOf(const LocalSolver& solver, const Scene& scene) {
  const Axis axis = {.path = "friction.kinetic_coefficient", .values = Linspace{0.0, 1.0, kRows}};
  std::vector<double> values;
  for (const auto& chunk : solver.Sweep({.grid = {.scene = scene, .axes = {axis}}, .columns = {"energy_change_j"}})) {
    values.insert(values.end(), chunk.value().values.begin(), chunk.value().values.end());
  }
  return values;
}

struct Questions {
  std::vector<Scene> scenes = Scenes();
  MultiContactScene box = SpatialBox();
  FitRequest fit = fit::Noiseless(fit::ContactCase());
};

Answers AnswersTo(const Questions& questions, const LocalSolver& solver) {
  const std::vector<Scene>& scenes = questions.scenes;
  Answers answers = {.fit = solver.Fit(questions.fit).value()};
  for (const Scene& scene : scenes) {
    answers.outcomes.push_back(solver.Solve({.scene = scene}).value().outcome);
    answers.plans.push_back(solver.Plan({.scene = scene}).value().plan);
    answers.bounds.push_back(solver.Bounds({.scene = scene}).value().bounds);
    const ContactVelocity& after = answers.outcomes.back().contact_velocity_after;
    answers.audits.push_back(solver.Audit({.scene = scene, .observed = after}).value());
    AuditColumns columns = {.tangential_after_m_s = {after.tangential_m_s[0]}, .normal_after_m_s = {after.normal_m_s}};
    if (after.tangential_m_s.size() == 2) columns.tangential_2_after_m_s = {after.tangential_m_s[1]};
    answers.audited.push_back(solver.AuditBatch({.scene = scene, .columns = columns}).value());
  }
  answers.batch = BatchOf(solver, scenes.back());
  answers.sweep = SweepOf(solver, scenes.back());
  answers.several = solver.MultiContact({.scene = questions.box}).value().answers;
  for (const auto& part : solver.Cost({.scene = scenes.front(), .time_limit_s = 30.0, .samples = 1})) {
    for (const CostRow& row : part.value().rows) answers.studied.push_back(row.velocity_after);
  }
  return answers;
}

class ModeTest : public testing::TestWithParam<Mode> {};

TEST_P(ModeTest, ChangesNoBitAndIsKept) {
  // They are made here, because their own arithmetic has the mode of the test.
  const Questions questions;
  const Answers expected = AnswersTo(questions, LocalSolver(Limits::None(), /*threads=*/2));
  std::fenv_t before;
  std::fegetenv(&before);
  std::feclearexcept(FE_ALL_EXCEPT);
  GetParam().set();
  const unsigned mode = _mm_getcsr() & ~kRaised;
  const Answers answers = AnswersTo(questions, LocalSolver(Limits::None(), /*threads=*/2));
  const unsigned mode_afterwards = _mm_getcsr() & ~kRaised;
  std::fesetenv(&before);
  EXPECT_EQ(mode_afterwards, mode);
  EXPECT_TRUE(answers == expected);
}

INSTANTIATE_TEST_SUITE_P(Callers, ModeTest, testing::ValuesIn(Modes()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace ricochet
