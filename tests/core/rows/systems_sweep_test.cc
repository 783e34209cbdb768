// Sweeps over every system drive its fields by path, give its outcome by path, and have the bits of Solve.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/engine/sweep_run.h"
#include "core/rows/column.h"
#include "core/scene/field.h"
#include "core/scene/validate.h"
#include "ricochet/outcome_numbers.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/pendulum_columns.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

struct Points {
  std::vector<std::vector<double>> values;  // One vector a point, one number a column.
  std::vector<Regime> regimes;
};

Points RunAll(const SweepRequest& request) {
  Points points;
  SweepRequest with_regime = request;
  with_regime.with_regime = true;
  const LocalSolver solver;
  for (absl::StatusOr<SweepChunk>& chunk : solver.Sweep(with_regime)) {
    EXPECT_TRUE(chunk.ok()) << chunk.status();
    if (!chunk.ok()) return points;
    for (int64_t i = 0; i < chunk->count; ++i) {
      std::vector<double>& row = points.values.emplace_back();
      for (size_t c = 0; c < request.columns.size(); ++c) {
        row.push_back(chunk->values[c * static_cast<size_t>(chunk->count) + static_cast<size_t>(i)]);
      }
    }
    points.regimes.insert(points.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
  }
  return points;
}

absl::Status FailureOf(const SweepRequest& request) { return SweepRun::Make(request).status(); }

TEST(SystemsSweepTest, EveryColumnOfEverySystemHasTheBitsOfSolve) {
  const std::vector<double> frictions = {0.0, 0.1, 0.4, 1.5};
  for (const System& system : Systems()) {
    Scene scene = With(system);
    const std::vector<std::string> columns = Columns(scene);
    const Points points =
        RunAll({.grid = {.scene = scene, .axes = {{"friction.kinetic_coefficient", ListValues{frictions}}}},
                .columns = columns});
    ASSERT_EQ(points.values.size(), frictions.size());
    for (size_t i = 0; i < frictions.size(); ++i) {
      scene.friction.kinetic_coefficient = frictions[i];
      const absl::StatusOr<SolveResponse> response = LocalSolver().Solve({.scene = scene});
      ASSERT_TRUE(response.ok()) << response.status();
      EXPECT_EQ(points.regimes[i], response->outcome.regime);
      std::vector<double> numbers;
      ColumnReader(scene, columns).Read(response->outcome, numbers);
      for (size_t c = 0; c < columns.size(); ++c) {
        EXPECT_EQ(std::bit_cast<uint64_t>(points.values[i][c]), std::bit_cast<uint64_t>(numbers[c])) << columns[c];
      }
    }
  }
}

TEST(SystemsSweepTest, EveryFieldOfEverySystemCanBeDriven) {
  for (const System& system : Systems()) {
    const std::vector<std::string> paths = FieldPaths(With(system));
    EXPECT_GE(paths.size(), 10U);
    for (const std::string& path : paths) {
      Scene scene = With(system);
      const absl::StatusOr<Field> field = ResolveField(path, scene);
      ASSERT_TRUE(field.ok()) << path;
      const Scene before = scene;
      field->Set(7.25);
      EXPECT_NE(scene, before) << path;
    }
  }
}

// The axis drives each number of each system across its own rules, and across those that tie it to others.
TEST(SystemsSweepTest, APointIsInvalidExactlyWhereSolveRefusesItsScene) {
  const std::vector<double> values = {-2.0, -0.5, -0.0, 0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 4.0};
  int valid = 0, invalid = 0;
  for (const System& system : Systems()) {
    Scene base = With(system);
    base.friction.static_coefficient = 0.75;
    base.friction.by_speed = SpeedTable{{0.5, 1.0}, {1.0, 0.5}};
    base.restitution_by_speed = PowerLaw{-0.5, 1.0};
    for (const std::string& path : FieldPaths(base)) {
      const Points points = RunAll(
          {.grid = {.scene = base, .axes = {{path, ListValues{values}}}}, .columns = {"impulse.normal_total_n_s"}});
      ASSERT_EQ(points.regimes.size(), values.size()) << path;
      Scene scene = base;
      const absl::StatusOr<Field> field = ResolveField(path, scene);
      for (size_t i = 0; i < values.size(); ++i) {
        field->Set(values[i]);
        const bool is_valid = Validate(scene).empty();
        ASSERT_EQ(points.regimes[i] != Regime::kInvalid, is_valid) << path << " = " << values[i];
        ++(is_valid ? valid : invalid);
      }
    }
  }
  EXPECT_GT(valid, 500);
  EXPECT_GT(invalid, 100);
}

TEST(SystemsSweepTest, PathsAreSpelledAsInTheProto) {
  EXPECT_THAT(FieldPaths(With(Chain())), IsSupersetOf({"linkage.links[1].theta_rad", "surface_velocity.normal_m_s",
                                                       "friction.static_coefficient", "restitution.newton"}));
  EXPECT_THAT(FieldPaths(With(Contact())), Contains("planar_contact.w_tn_per_kg"));
  EXPECT_THAT(FieldPaths(With(ContactInSpace())),
              IsSupersetOf({"spatial_contact.w_per_kg[3]", "surface_velocity.tangential_m_s[1]"}));
  EXPECT_THAT(FieldPaths(With(Flat())), Contains("planar_body.offset_t_m"));
  EXPECT_THAT(FieldPaths(With(BodyPair{SpatialPair{Body(), Body()}})),
              Contains("body_pair.spatial.body_2.angular_rad_s[2]"));
  EXPECT_THAT(FieldPaths(With(BodyPair{SpatialPair{Body(), Body()}})), Not(Contains(HasSubstr("surface_velocity"))));
  Scene law = With(Contact());
  law.restitution = std::monostate();
  law.impact_law = BrachLaw{0.5, 0.1};
  EXPECT_THAT(FieldPaths(law), Contains("brach.mu_hat"));
  EXPECT_THAT(FieldPaths(law), Not(Contains("restitution.newton")));
  Scene by_speed = With(Contact());
  by_speed.friction.by_speed = SpeedTable{{1.0, 2.0}, {1.0, 0.5}};
  EXPECT_THAT(FieldPaths(by_speed), Contains("friction.by_speed.table.factor[1]"));
}

TEST(SystemsSweepTest, ColumnsFollowTheSystem) {
  EXPECT_THAT(Columns(With(Chain())), Contains("rates_after_rad_s[1]"));
  EXPECT_THAT(Columns(With(Flat())), Contains("bodies_after[0].linear_m_s[1]"));
  EXPECT_THAT(Columns(With(BodyPair{SpatialPair{Body(), Body()}})), Contains("bodies_after[1].angular_rad_s[2]"));
  EXPECT_THAT(Columns(With(ContactInSpace())), Contains("contact_velocity_after.tangential_m_s[1]"));
  EXPECT_THAT(Columns(With(Contact())), Not(Contains("rates_after_rad_s[0]")));
  EXPECT_THAT(Columns(With(Pendulum{})), IsSupersetOf(PendulumColumns()));
}

TEST(SystemsSweepTest, AColumnOfAnotherSystemIsRefused) {
  const absl::Status status = FailureOf({.grid = {.scene = With(Flat())}, .columns = {"rates_after_rad_s[0]"}});
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()),
              HasSubstr("columns[0] = \"rates_after_rad_s[0]\": must be a column of the scene"));
}

TEST(SystemsSweepTest, DrivingTheSurfaceMakesItMove) {
  const std::string path = "surface_velocity.tangential_m_s[0]";
  const Points points = RunAll({.grid = {.scene = With(Flat()), .axes = {{path, ListValues{{0.0, 0.5}}}}},
                                .columns = {"contact_velocity_after.tangential_m_s[0]", "coefficients.tangential"}});
  Scene scene = With(Flat());
  scene.surface_velocity = SurfaceVelocity{{0.5}, 0.0};
  const absl::StatusOr<SolveResponse> response = LocalSolver().Solve({.scene = scene});
  ASSERT_TRUE(response.ok());
  EXPECT_EQ(points.values[1][0], response->outcome.contact_velocity_after.tangential_m_s[0]);
}

// An overflow leaves not even the regime known, so the point is invalid whichever column is asked for.
TEST(SystemsSweepTest, ACompliantPathThatOverflowsMakesItsPointInvalidAsSolveRefusesIt) {
  Scene scene = With(PlanarContact{2.0, -0.9, 1.5, -1.2e152, -0.85});
  scene.restitution = EnergeticCoefficient{0.15};
  scene.compliance = {.tangential_ratio_squared = 2.9, .normal = {}};
  const std::vector<double> frictions = {0.3, 1.7e305};
  const Points points =
      RunAll({.grid = {.scene = scene, .axes = {{"friction.kinetic_coefficient", ListValues{frictions}}}},
              .columns = {"impulse.normal_total_n_s"}});
  EXPECT_NE(points.regimes[0], Regime::kInvalid);
  EXPECT_EQ(points.regimes[1], Regime::kInvalid);
  EXPECT_TRUE(std::isnan(points.values[1][0]));
  scene.friction.kinetic_coefficient = frictions[1];
  EXPECT_EQ(LocalSolver().Solve({.scene = scene}).status().code(), absl::StatusCode::kOutOfRange);
}

// Points where W is indefinite are invalid, and they alone.
TEST(SystemsSweepTest, ABadPointDoesNotEndTheSweep) {
  const Points points = RunAll(
      {.grid = {.scene = With(Contact()), .axes = {{"planar_contact.w_tn_per_kg", ListValues{{0.5, 2.0, -0.5}}}}},
       .columns = {"impulse.normal_total_n_s"}});
  EXPECT_EQ(points.regimes[1], Regime::kInvalid);
  EXPECT_TRUE(std::isnan(points.values[1][0]));
  EXPECT_NE(points.regimes[0], Regime::kInvalid);
  EXPECT_NE(points.regimes[2], Regime::kInvalid);
}

TEST(SystemsSweepTest, ARuleBetweenFieldsIsAMatterOfEachPointWhereAnAxisDrivesOneOfThem) {
  PlanarContact indefinite = Contact();
  indefinite.w_tt_per_kg = 0.0;
  const Axis tangential = {"planar_contact.w_tt_per_kg", ListValues{{2.0}}};
  const Axis friction = {"friction.kinetic_coefficient", ListValues{{0.5}}};
  EXPECT_TRUE(
      FailureOf({.grid = {.scene = With(indefinite), .axes = {tangential}}, .columns = {"energy_change_j"}}).ok());
  EXPECT_FALSE(
      FailureOf({.grid = {.scene = With(indefinite), .axes = {friction}}, .columns = {"energy_change_j"}}).ok());
  SpatialContact matrix = ContactInSpace();
  matrix.w_per_kg[3] = 0.0;
  const Axis entry = {"spatial_contact.w_per_kg[3]", ListValues{{2.0}}};
  EXPECT_TRUE(FailureOf({.grid = {.scene = With(matrix), .axes = {entry}}, .columns = {"energy_change_j"}}).ok());
  EXPECT_FALSE(FailureOf({.grid = {.scene = With(matrix), .axes = {friction}}, .columns = {"energy_change_j"}}).ok());
}

TEST(SystemsSweepTest, DrivingEitherOfTwoMirroredEntriesOfAMassMatrixCuresBoth) {
  Mechanism arm = {.jacobian = {1.0, 0.0, 0.0, 1.0}, .rates = {0.3, -1.0}};
  const std::vector<double> indefinite = {2.0, 3.0, 3.0, 1.2}, skew = {2.0, 3.0, 0.5, 1.2};
  for (const std::vector<double>& mass : {indefinite, skew}) {
    arm.mass_matrix = mass;
    for (const char* path : {"mechanism.mass_matrix[1]", "mechanism.mass_matrix[2]"}) {
      const Axis entry = {path, ListValues{{3.0, 0.4}}};
      const Points points = RunAll({.grid = {.scene = With(arm), .axes = {entry}}, .columns = {"energy_change_j"}});
      ASSERT_EQ(points.regimes.size(), 2) << path;
      EXPECT_EQ(points.regimes[0], Regime::kInvalid) << path;
      EXPECT_NE(points.regimes[1], Regime::kInvalid) << path;
    }
  }
}

TEST(SystemsSweepTest, ARuleBetweenFieldsDoesNotExcuseANumberThatBreaksItsOwn) {
  PlanarContact contact = Contact();
  contact.w_tn_per_kg = std::nan("");
  const Axis tangential = {"planar_contact.w_tt_per_kg", ListValues{{2.0}}};
  EXPECT_THAT(
      std::string(FailureOf({.grid = {.scene = With(contact), .axes = {tangential}}, .columns = {"energy_change_j"}})
                      .message()),
      HasSubstr("planar_contact.w_tn_per_kg = nan: must be finite"));
}

TEST(SystemsSweepTest, WhatFollowsFromTheWholeContactIsAMatterOfEachPointWhateverAxisThereIs) {
  Scene scene = With(Pendulum{.inertia_kg_m2 = 1.0, .a_m = 1.0, .b_m = 0.5, .omega_minus_rad_s = -2.0});
  scene.friction.kinetic_coefficient = 0.1;
  scene.restitution_by_speed = PowerLaw{.alpha = -1.0, .exponent = 1.0};  // The coefficient is negative above 1 m/s.
  EXPECT_FALSE(FailureOf({.grid = {.scene = scene}, .columns = {"energy_change_j"}}).ok());
  const Axis angle = {"pendulum.phi_rad", ListValues{{1.0, 0.25}}};  // a = R sin phi
  const Points points = RunAll({.grid = {.scene = scene, .axes = {angle}}, .columns = {"energy_change_j"}});
  EXPECT_THAT(points.regimes, testing::ElementsAre(Regime::kInvalid, Regime::kRebound));
}

// The plan of the base scene keeps slip in a straight line; with the second friction slip would stop.
TEST(SystemsSweepTest, APointThatNeedsAnExcludedEffectIsInvalidAndSaysWhy) {
  Scene scene = With(Contact());
  scene.restitution = EnergeticCoefficient{0.5};
  SpatialContact turning = ContactInSpace();
  turning.tangential_m_s = {1.0, 0.0};
  turning.normal_m_s = -1.0;
  scene.system = turning;
  const std::vector<double> frictions = {0.01, 1e130};
  const BatchSetup setup = {.scene = scene,
                            .fields = {"friction.kinetic_coefficient"},
                            .columns = {"impulse.normal_total_n_s"},
                            .demand = {.excluded = {Effect::kSlipTurn}}};
  std::vector<double> impulses(2);
  std::vector<RowStatus> statuses(2);
  const absl::StatusOr<BatchResponse> response =
      LocalSolver().SolveBatch(setup, {.inputs = {frictions},
                                       .outputs = {absl::MakeSpan(impulses)},
                                       .regimes = {},
                                       .statuses = absl::MakeSpan(statuses)});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_THAT(statuses, testing::ElementsAre(RowStatus::kOk, RowStatus::kInvalid));
  ASSERT_EQ(response->summary.bad_rows.size(), 1U);
  EXPECT_EQ(response->summary.bad_rows[0].field, "excluded[0]");
  EXPECT_THAT(response->summary.bad_rows[0].description, HasSubstr("slip in a straight line needs"));
}

TEST(SystemsSweepTest, AListOfTheWrongLengthIsNotCuredByDrivingOneOfItsEntries) {
  SpatialContact contact = ContactInSpace();
  contact.w_per_kg.pop_back();
  const Axis entry = {"spatial_contact.w_per_kg[3]", ListValues{{2.0}}};
  EXPECT_THAT(
      std::string(
          FailureOf({.grid = {.scene = With(contact), .axes = {entry}}, .columns = {"energy_change_j"}}).message()),
      HasSubstr("has 5 entries: must have 6"));
}

// An integrated point may take long, so a stop is looked for before each one.
TEST(SystemsSweepTest, AStopEndsASweepOfIntegratedPointsAtTheNextPoint) {
  Scene with_springs = With(Contact());
  with_springs.compliance = {.tangential_ratio_squared = 1.2, .normal = LinearSpring{1e6}};
  Scene with_damping = With(Contact());
  with_damping.restitution = std::monostate();
  with_damping.compliance = {.tangential_ratio_squared = {}, .normal = HuntCrossleySpring{1e6, 1.5, 0.1}};
  for (const Scene& scene : {With(ContactInSpace()), with_springs, with_damping}) {
    absl::StatusOr<SweepRun> run =
        SweepRun::Make({.grid = {.scene = scene, .axes = {{"friction.kinetic_coefficient", Linspace{0.1, 1.0, 1000}}}},
                        .columns = {"energy_change_j"}});
    ASSERT_TRUE(run.ok()) << run.status();
    int looks = 0;
    const absl::StatusOr<SweepChunk> chunk = run->NextChunk([&looks] { return ++looks > 5; });
    EXPECT_EQ(chunk.status().code(), absl::StatusCode::kCancelled);
    EXPECT_EQ(looks, 6);
    EXPECT_LT(run->points_done(), looks);
  }
}

}  // namespace
}  // namespace ricochet
