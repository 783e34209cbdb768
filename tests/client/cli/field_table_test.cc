// The field table: each number of a scene and an outcome has its unit and its meaning.

#include "client/cli/text/field_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/rows/column.h"
#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet::cli {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<FieldInfo> AllFields() {
  std::vector<FieldInfo> all = SceneFieldTable();
  all.insert(all.end(), OutcomeFieldTable().begin(), OutcomeFieldTable().end());
  return all;
}

TEST(FieldTable, TellsApartUnitsThatAreSpelledAlike) {
  const std::pair<const char*, const char*> units[] = {
      {"compliance.linear.stiffness_n_m", "N/m"},
      {"compliance.hertz.stiffness_n_m1_5", "N/m^1.5"},
      {"compliance.hunt_crossley.stiffness_n_m_p", "N/m^p"},
      {"compliance.hunt_crossley.damping_s_m", "s/m"},
      {"pin_moment.moment_n_m", "N m"},
      {"planar_body.offset_n_m", "m"},
      {"planar_body.velocity_n_m_s", "m/s"},
      {"gravity.normal_m_s2", "m/s²"},
      {"planar_contact.w_tn_per_kg", "1/kg"},
      {"contact.peak_normal_n", "N"},
      {"contact.duration_s", "s"},
      {"impulse.normal_total_n_s", "N s"},
      {"work.normal_total_j", "J"},
      {"friction.kinetic_coefficient", ""},
      {"compliance.tangential_ratio_squared", ""},
  };
  for (const auto& [path, unit] : units) {
    ASSERT_NE(FindFieldInfo(path), nullptr) << path;
    EXPECT_EQ(FindFieldInfo(path)->unit, unit) << path;
  }
}

// Beside pure numbers only those of a mechanism in its coordinates have no unit, as their comments say.
TEST(FieldTable, TellsNumbersInCoordinatesFromPureOnes) {
  std::set<std::string> in_coordinates;
  for (const FieldInfo& info : AllFields()) {
    if (!IsInCoordinates(info.path)) continue;
    in_coordinates.insert(info.path);
    EXPECT_EQ(info.unit, "") << info.path;
  }
  EXPECT_THAT(in_coordinates,
              ElementsAre("errors.momentum_change", "errors.rates_after", "free_end.errors.momentum_change",
                          "free_end.errors.rates_after", "free_end.rates_after", "mechanism.jacobian",
                          "mechanism.mass_matrix", "mechanism.rates", "momentum_change", "rates_after"));
  for (const FieldInfo& info : AllFields()) {
    EXPECT_TRUE(!absl::StrContains(info.comment, "units of") || IsInCoordinates(info.path)) << info.comment;
  }
  EXPECT_TRUE(IsInCoordinates("d(rates_after[0])/d(friction.kinetic_coefficient)"));
  EXPECT_TRUE(IsInCoordinates("d(coefficients.newton)/d(mechanism.rates[1])"));
  EXPECT_FALSE(IsInCoordinates("d(coefficients.newton)/d(friction.kinetic_coefficient)"));
}

// The comments were written for readers of the protos, and so do not follow from the endings of names.
TEST(FieldTable, EveryUnitIsThatOfTheComment) {
  std::set<std::string> units;
  for (const FieldInfo& info : AllFields()) units.insert(info.unit);
  const auto states = [](const FieldInfo& info, const std::string& unit) {
    for (const char* after : {".", ":", ","}) {
      if (absl::StrContains(info.comment, absl::StrCat(", ", unit, after))) return true;
    }
    return false;
  };
  for (const FieldInfo& info : AllFields()) {
    for (const std::string& unit : units) {
      if (unit.empty()) continue;
      EXPECT_EQ(states(info, unit), unit == info.unit) << info.path << ": " << info.comment;
    }
  }
}

TEST(FieldTable, EveryFieldHasAMeaningOnOneLine) {
  for (const FieldInfo& info : AllFields()) {
    EXPECT_GE(info.meaning.size(), 4) << info.path;
    EXPECT_FALSE(absl::StrContains(info.comment, "\n")) << info.path;
    EXPECT_TRUE(info.unit.empty() || !absl::EndsWith(info.meaning, ", " + info.unit)) << info.meaning;
  }
}

// Scenes that have every number of a scene and an outcome between them.
std::vector<Scene> ScenesWithEveryNumber() {
  std::vector<Scene> scenes = {With(Pendulum{1.0, 0.3, 1.0, -1.0})};
  for (const System& system : Systems()) scenes.push_back(With(system));
  const Scene flat = With(Flat());
  for (const ImpactLaw& law : {ImpactLaw(WhittakerLaw()), ImpactLaw(KaneLevinsonLaw()), ImpactLaw(BrachLaw()),
                               ImpactLaw(ChatterjeeRuinaLaw())}) {
    scenes.push_back(flat);
    scenes.back().impact_law = law;
  }
  const auto add = [&](const auto& spring, const FiniteForces& forces, const SpeedDependence& by_speed) {
    Scene& scene = scenes.emplace_back(flat);
    scene.compliance = Compliance{.tangential_ratio_squared = 1.2, .normal = spring};
    scene.finite_forces = forces;
    scene.friction.by_speed = by_speed;
    scene.restitution_by_speed = by_speed;
  };
  add(LinearSpring(), Gravity(), PowerLaw());
  add(HertzSpring(), PinMoment(), SpeedTable{{1.0}, {1.0}});
  add(HuntCrossleySpring(), ContactAcceleration(), PowerLaw());
  return scenes;
}

TEST(FieldTable, KnowsEveryAxisAndColumn) {
  std::set<const FieldInfo*> seen;
  std::vector<std::string> unknown;
  for (const Scene& scene : ScenesWithEveryNumber()) {
    std::vector<std::string> paths = FieldPaths(scene);
    for (const std::string& column : Columns(scene)) paths.push_back(column);
    for (const std::string& path : paths) {
      seen.insert(FindFieldInfo(path));
      if (FindFieldInfo(path) == nullptr) unknown.push_back(path);
    }
  }
  EXPECT_THAT(unknown, IsEmpty());
  for (const FieldInfo& info : SceneFieldTable()) EXPECT_TRUE(seen.contains(&info)) << info.path;
  EXPECT_EQ(FindFieldInfo("pendulum.c_m"), nullptr);
}

const char* RangeText(NumberRule rule) {
  switch (rule) {
    case NumberRule::kFinite:
      return "";
    case NumberRule::kAngle:
      return "";
    case NumberRule::kPositive:
      return "> 0";
    case NumberRule::kNotNegative:
      return ">= 0";
    case NumberRule::kUnitInterval:
      return "0 <= value <= 1";
    case NumberRule::kPlusMinusOne:
      return "-1 <= value <= 1";
    case NumberRule::kOneToFour:
      return "1 <= value <= 4";
    case NumberRule::kRatioSquared:
      return "In [1e-9, 1e9]";
    case NumberRule::kHalfTurn:
      return "In (0, pi)";
  }
  return "?";
}

TEST(FieldTable, EveryRangeIsTheRuleThatValidationChecks) {
  for (const Scene& scene : ScenesWithEveryNumber()) {
    VisitNumbers(scene, [](const NumberPath& path, double /*value*/, NumberRule rule) {
      EXPECT_EQ(FindFieldInfo(path.Text())->range, RangeText(rule)) << path.Text();
    });
  }
}

TEST(FieldTable, TakesPathsWithIndices) {
  EXPECT_EQ(FindFieldInfo("linkage.links[12].theta_rad"), FindFieldInfo("linkage.links.theta_rad"));
  EXPECT_EQ(FindFieldInfo("bodies_after[1].linear_m_s[0]")->unit, "m/s");
}

}  // namespace
}  // namespace ricochet::cli
