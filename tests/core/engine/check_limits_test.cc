// A LocalSolver with limits takes a request at each limit and refuses one just above it, by field, size and limit.

#include "core/engine/check_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/error.h"
#include "ricochet/limits.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/multi_contact_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Scene ChainScene(size_t links) {
  return {.system = Chain(links), .friction = {.kinetic_coefficient = 0.1}, .restitution = EnergeticCoefficient{0.5}};
}

// The unit matrix, and a contact that the first coordinate moves.
Scene ArmScene(size_t coordinates) {
  Mechanism arm = {.rates = std::vector<double>(coordinates, -1.0)};
  arm.mass_matrix.resize(coordinates * coordinates);
  for (size_t i = 0; i < coordinates; ++i) arm.mass_matrix[i * coordinates + i] = 1.0;
  arm.jacobian.assign(2 * coordinates, 1.0);
  arm.jacobian[0] = 0.5;
  return With(arm);
}

Scene WithTable(size_t speeds) {
  Scene scene = ChainScene(1);
  SpeedTable table;
  for (size_t i = 0; i < speeds; ++i) {
    table.speed_m_s.push_back(static_cast<double>(i));
    table.factor.push_back(1.0);
  }
  scene.friction.by_speed = table;
  return scene;
}

std::vector<Axis> Axes(size_t count) {
  std::vector<Axis> axes;
  for (size_t i = 0; i < count; ++i) {
    axes.push_back({.path = "linkage.links[" + std::to_string(i) + "].rate_rad_s", .values = Linspace{-1.0, -1.0, 1}});
  }
  return axes;
}

// The status of the call for a request whose size is `size`.
using Ask = std::function<absl::Status(const Solver& solver, size_t size)>;

absl::Status FirstOf(SweepStream stream) { return stream.begin()->status(); }

SweepRequest Sweep(Scene scene, std::vector<Axis> axes, std::vector<std::string> columns) {
  return {.grid = {.scene = std::move(scene), .axes = std::move(axes)}, .columns = std::move(columns)};
}

struct Case {
  std::string name;
  int64_t Limits::*limit;
  int64_t value;
  std::string field;
  Ask ask;
  size_t fields_above = 1;  // Fields that are too large just above the limit.
};

void PrintTo(const Case& tested, std::ostream* out) { *out << tested.name; }

const std::vector<Case>& Cases() {
  static const std::vector<Case> cases = {
      {"LinksOfASolve", &Limits::max_links, 3, "linkage.links",
       [](const Solver& solver, size_t n) { return solver.Solve({.scene = ChainScene(n)}).status(); }},
      {"CoordinatesOfASolve", &Limits::max_links, 3, "mechanism.rates",
       [](const Solver& solver, size_t n) { return solver.Solve({.scene = ArmScene(n)}).status(); },
       /*fields_above=*/2},
      {"LinksOfAPlan", &Limits::max_links, 3, "linkage.links",
       [](const Solver& solver, size_t n) { return solver.Plan({.scene = ChainScene(n)}).status(); }},
      {"LinksOfBounds", &Limits::max_links, 3, "linkage.links",
       [](const Solver& solver, size_t n) { return solver.Bounds({.scene = ChainScene(n)}).status(); }},
      {"LinksOfAnAudit", &Limits::max_links, 3, "linkage.links",
       [](const Solver& solver, size_t n) {
         return solver.Audit({.scene = ChainScene(n), .observed = ObservedRates{Components(n, 0.0)}}).status();
       },
       2},
      {"RatesOfAnAudit", &Limits::max_links, 3, "rates.values",
       [](const Solver& solver, size_t n) {
         return solver
             .Audit({.scene = ChainScene(std::min<size_t>(n, 3)), .observed = ObservedRates{Components(n, 0.0)}})
             .status();
       }},
      {"LinksOfABatch", &Limits::max_links, 3, "linkage.links",
       [](const Solver& solver, size_t n) { return solver.AuditBatch({.scene = ChainScene(n)}).status(); }},
      {"LinksOfASweep", &Limits::max_links, 3, "linkage.links",
       [](const Solver& solver, size_t n) {
         return FirstOf(solver.Sweep(Sweep(ChainScene(n), {}, {"coefficients.newton"})));
       }},
      {"LinksOfAStudyOfCost", &Limits::max_links, 3, "linkage.links",
       [](const Solver& solver, size_t n) {
         auto stream = solver.Cost({.scene = ChainScene(n), .time_limit_s = kLeastCostTimeLimitS});
         return stream.begin()->status();
       }},
      {"BodiesOfAStudyOfCost", &Limits::max_links, 2, "free_bodies.bodies",
       [](const Solver& solver, size_t n) {
         auto stream =
             solver.Cost({.time_limit_s = kLeastCostTimeLimitS,
                          .multi_contact = RowOfBalls(std::vector<double>(n, 1.0), std::vector<double>(n, 0.0),
                                                      std::vector<double>(n - 1, 0.5))});
         return stream.begin()->status();
       }},
      {"NumbersOfATable", &Limits::max_list_numbers, 5, "friction.by_speed.table.speed_m_s",
       [](const Solver& solver, size_t n) { return solver.Solve({.scene = WithTable(n)}).status(); }, 2},
      {"Ranges", &Limits::max_ranges, 2, "ranges",
       [](const Solver& solver, size_t n) {
         std::vector<FieldRange> ranges;
         for (const Axis& axis : Axes(n)) ranges.push_back({axis.path, -1.0, -1.0});
         return solver.Bounds({.scene = ChainScene(3), .ranges = ranges}).status();
       }},
      {"Axes", &Limits::max_axes, 2, "axes",
       [](const Solver& solver, size_t n) {
         return FirstOf(solver.Sweep(Sweep(ChainScene(3), Axes(n), {"coefficients.newton"})));
       }},
      {"ValuesOfAnAxis", &Limits::max_axis_values, 9, "axes[0].list.values",
       [](const Solver& solver, size_t n) {
         const Axis axis = {.path = "friction.kinetic_coefficient", .values = ListValues{std::vector<double>(n, 0.1)}};
         return FirstOf(solver.Sweep(Sweep(ChainScene(1), {axis}, {"coefficients.newton"})));
       }},
      {"Columns", &Limits::max_columns, 1, "columns",
       [](const Solver& solver, size_t n) {
         std::vector<std::string> columns = {"coefficients.newton", "coefficients.poisson"};
         columns.resize(n);
         return FirstOf(solver.Sweep(Sweep(ChainScene(1), {}, columns)));
       }},
      {"Digits", &Limits::max_digits_times_links, 60, "certified_digits",
       [](const Solver& solver, size_t n) {
         return solver.Solve({.scene = ChainScene(2), .certified_digits = static_cast<int32_t>((n + 1) / 2)}).status();
       }},
      {"DigitsOfBounds", &Limits::max_digits_times_links, 20, "certified_digits",
       [](const Solver& solver, size_t n) {
         return solver.Bounds({.scene = ChainScene(1), .certified_digits = static_cast<int32_t>(n)}).status();
       }},
      {"StatesOfAHistory", &Limits::max_history_numbers, 30, "history_at_n_s",
       [](const Solver& solver, size_t n) {
         const std::vector<double> history((n + 4) / 5, 0.0);
         return solver.Solve({.scene = ChainScene(1), .history_at_n_s = history}).status();
       }},
      {"StepsOfAHistory", &Limits::max_history_numbers, 30, "history_intervals",
       [](const Solver& solver, size_t n) {
         return solver.Solve({.scene = ChainScene(2), .history_intervals = static_cast<int64_t>((n + 5) / 6) - 1})
             .status();
       }},
      {"Derivatives", &Limits::max_derivatives, 6, "derivatives.of",
       [](const Solver& solver, size_t n) {
         const DerivativePaths paths = {.of = std::vector<std::string>((n + 1) / 2, "coefficients.newton"),
                                        .by = {"friction.kinetic_coefficient", "linkage.links[0].mass_kg"}};
         return solver.Solve({.scene = ChainScene(1), .derivatives = paths}).status();
       }},
      {"DerivativesOfBounds", &Limits::max_derivatives, 6, "derivatives.of",
       [](const Solver& solver, size_t n) {
         const DerivativePaths paths = {.of = std::vector<std::string>((n + 1) / 2, "sharp.newton.upper"),
                                        .by = {"friction.kinetic_coefficient", "linkage.links[0].mass_kg"}};
         return solver.Bounds({.scene = ChainScene(1), .derivatives = paths}).status();
       }},
      {"RowsOfABatch", &Limits::max_audit_rows, 7, "columns.friction",
       [](const Solver& solver, size_t n) {
         AuditBatchRequest request = {.scene = ChainScene(1)};
         request.columns.friction.assign(n, 0.1);
         request.columns.rates_after = {{0.0}};
         return solver.AuditBatch(request).status();
       }},
      {"WorkOfAFit", &Limits::max_fit_work, 192, "measured",
       [](const Solver& solver, size_t n) {
         FitRequest request = {.scene = ChainScene(1), .starts = 1, .max_iterations = 1};
         request.unknowns = {{.path = "friction.kinetic_coefficient"}};
         request.measured = {{"rates_after_rad_s[0]", std::vector<double>((n + 31) / 32, 0.0), {1.0}}};
         return solver.Fit(request).status();
       }},
      {"BodiesThatTouch", &Limits::max_links, 2, "free_bodies.bodies",
       [](const Solver& solver, size_t n) {
         return solver
             .MultiContact({.scene = RowOfBalls(std::vector<double>(n, 1.0), std::vector<double>(n, 0.0),
                                                std::vector<double>(n - 1, 0.5))})
             .status();
       }},
      {"StatesOfSeveralContacts", &Limits::max_contact_states, 5, "states",
       [](const Solver& solver, size_t n) {
         MultiContactRequest request = {.scene = FallingBlock(0.5, 0.5)};
         request.scene.contacts.resize(1);
         request.states.assign(n, {.velocity = {0.0, -1.0, 0.0}});
         return solver.MultiContact(request).status();
       }},
      {"OutputsOfSeveralContacts", &Limits::max_columns, 3, "outputs",
       [](const Solver& solver, size_t n) {
         MultiContactRequest request = {.scene = FallingBlock(0.5, 0.5)};
         while (request.outputs.size() < n) {
           request.outputs.push_back({std::string(request.outputs.size() + 1, 'x'), {1.0, 0.0, -1.0}});
         }
         return solver.MultiContact(request).status();
       }},
      {"RatesOfABatch", &Limits::max_audit_rows, 7, "columns.rates_after[0].values",
       [](const Solver& solver, size_t n) {
         AuditBatchRequest request = {.scene = ChainScene(1)};
         request.columns.rates_after = {std::vector<double>(n, 0.0)};
         return solver.AuditBatch(request).status();
       }},
  };
  return cases;
}

class CheckLimitsTest : public testing::TestWithParam<Case> {};

TEST_P(CheckLimitsTest, TakesARequestAtTheLimitAndRefusesOneAbove) {
  const Case& tested = GetParam();
  Limits limits;
  limits.*tested.limit = tested.value;
  const LocalSolver limited(limits);
  const auto at_limit = static_cast<size_t>(tested.value);
  EXPECT_TRUE(tested.ask(limited, at_limit).ok()) << tested.ask(limited, at_limit);
  const absl::Status refused = tested.ask(limited, at_limit + 1);
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted) << refused;
  EXPECT_EQ(ReasonOf(refused), ErrorReason::kLimitExceeded);
  ASSERT_EQ(ViolationsOf(refused).size(), tested.fields_above);
  EXPECT_EQ(ViolationsOf(refused)[0].field, tested.field);
  EXPECT_THAT(ViolationsOf(refused)[0].description,
              AllOf(HasSubstr(std::to_string(tested.value)), HasSubstr("the limit max_")));
}

TEST_P(CheckLimitsTest, WithoutLimitsTheSameRequestIsNotRefusedForItsSize) {
  const Case& tested = GetParam();
  const absl::Status status = tested.ask(LocalSolver(), static_cast<size_t>(tested.value) + 1);
  EXPECT_FALSE(absl::IsResourceExhausted(status)) << status;
}

INSTANTIATE_TEST_SUITE_P(Limit, CheckLimitsTest, testing::ValuesIn(Cases()),
                         [](const auto& tested) { return tested.param.name; });

TEST(CheckLimits, ForceIntervals) {
  Limits limits;
  limits.max_force_intervals = 10;
  SolveRequest request = {.scene = ChainScene(1), .force_intervals = 11};
  const absl::Status refused = CheckLimits(request, limits);
  EXPECT_EQ(ReasonOf(refused), ErrorReason::kLimitExceeded);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("force_intervals = 11: must be at most 10"));
  request.force_intervals = 10;
  EXPECT_TRUE(CheckLimits(request, limits).ok());
}

TEST(CheckLimits, PointsOfASweepAreThoseOfItsRange) {
  Limits limits;
  limits.max_points_per_sweep = 1000;
  const LocalSolver limited(limits);
  const Axis axis = {.path = "friction.kinetic_coefficient", .values = Linspace{0.1, 0.2, 1001}};
  SweepRequest request = Sweep(ChainScene(1), {axis}, {"coefficients.newton"});
  const absl::Status refused = FirstOf(limited.Sweep(request));
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(refused), ErrorReason::kSweepTooLarge);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("1001 points"));
  request.first_index = 1;
  EXPECT_TRUE(FirstOf(limited.Sweep(request)).ok());
}

TEST(CheckLimits, AnEnclosureWithFewBoxesIsWiderButHoldsTheOneWithMany) {
  BoundsRequest request = {.scene = ChainScene(2)};
  request.ranges = {{"friction.kinetic_coefficient", 0.0, 0.4}, {"linkage.links[0].theta_rad", 0.2, 0.6}};
  const auto whole = LocalSolver().Bounds(request);
  Limits limits;
  limits.max_boxes = 100;
  const auto cut = LocalSolver(limits).Bounds(request);
  ASSERT_TRUE(whole.ok() && cut.ok()) << whole.status() << cut.status();
  EXPECT_LE(cut->enclosure->boxes, 100);
  EXPECT_GT(whole->enclosure->boxes, 100);
  EXPECT_GT(cut->enclosure->excess, whole->enclosure->excess);
  EXPECT_GE(cut->enclosure->outer.poisson.upper, whole->enclosure->outer.poisson.upper);
  EXPECT_LE(cut->enclosure->outer.tangential.lower, whole->enclosure->outer.tangential.lower);
  EXPECT_GE(cut->enclosure->outer.normal_total_n_s.upper, whole->enclosure->outer.normal_total_n_s.upper);
}

TEST(CheckLimits, EveryFieldThatIsTooLargeIsNamed) {
  Limits limits;
  limits.max_links = 1;
  limits.max_axes = 1;
  limits.max_columns = 1;
  const absl::Status refused = FirstOf(
      LocalSolver(limits).Sweep(Sweep(ChainScene(2), Axes(2), {"coefficients.newton", "coefficients.poisson"})));
  EXPECT_EQ(ViolationsOf(refused).size(), 3) << refused;
}

TEST(CheckLimits, AMechanismIsRefusedWhereNoLinkIsAllowed) {
  Limits limits;
  limits.max_links = 0;
  const absl::Status refused = LocalSolver(limits).Solve({.scene = ArmScene(1)}).status();
  EXPECT_EQ(ReasonOf(refused), ErrorReason::kLimitExceeded) << refused;
}

TEST(Limits, NoneIsTheLargestNumberForEachNamedLimit) {
  const Limits none = Limits::None();
  for (const NamedLimit& limit : kLimits) {
    EXPECT_EQ(none.*limit.value, std::numeric_limits<int64_t>::max()) << limit.name;
    EXPECT_GE(Limits().*limit.value, 1) << limit.name;
    EXPECT_LE(Limits().*limit.value, limit.most) << limit.name;
  }
  EXPECT_EQ(std::size(kLimits) * sizeof(int64_t), sizeof(Limits)) << "every limit has a name";
}

}  // namespace
}  // namespace ricochet
