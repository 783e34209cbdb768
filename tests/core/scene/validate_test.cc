// Validation: each rule of ricochet/scene.h gives a message with the field, the value and the rule.

#include "core/scene/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "absl/strings/match.h"

namespace ricochet {

// The test framework finds this function by its name.
static void PrintTo(const Violation& violation, std::ostream* out) {
  *out << violation.field << " " << violation.description;
}

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr char kOneOfTheSystems[] =
    "is not set: must be one of pendulum, planar_body, spatial_body, body_pair, linkage, planar_contact, "
    "spatial_contact, mechanism";

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSmallest = std::numeric_limits<double>::denorm_min();

Scene ValidScene() {
  return {.system = Pendulum{.inertia_kg_m2 = 2.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -3.0},
          .friction = {.kinetic_coefficient = 0.1, .static_coefficient = std::nullopt},
          .restitution = EnergeticCoefficient{0.5}};
}

Pendulum& PendulumOf(Scene& scene) { return std::get<Pendulum>(scene.system); }

struct BadScene {
  std::string name;
  std::function<void(Scene&)> spoil;
  std::string field;
  std::string description;
};

void PrintTo(const BadScene& bad, std::ostream* out) { *out << bad.name; }

class BadSceneTest : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneTest, IsReportedWithFieldValueAndRule) {
  Scene scene = ValidScene();
  GetParam().spoil(scene);
  const std::vector<Violation> violations = Validate(scene);
  ASSERT_THAT(violations, ElementsAre(Violation{GetParam().field, GetParam().description}));
  EXPECT_FALSE(violations.front().rule.empty());
  EXPECT_TRUE(absl::EndsWith(GetParam().description, ": must " + violations.front().rule));
}

// Lists every number of a scene, so that each is tried with values that are not finite.
struct NumberField {
  std::string name;
  std::string path;
  std::function<void(Scene&, double)> set;
};

std::vector<NumberField> NumberFields() {
  return {
      {"Inertia", "pendulum.inertia_kg_m2", [](Scene& s, double x) { PendulumOf(s).inertia_kg_m2 = x; }},
      {"A", "pendulum.a_m", [](Scene& s, double x) { PendulumOf(s).a_m = x; }},
      {"B", "pendulum.b_m", [](Scene& s, double x) { PendulumOf(s).b_m = x; }},
      {"Omega", "pendulum.omega_minus_rad_s", [](Scene& s, double x) { PendulumOf(s).omega_minus_rad_s = x; }},
      {"Kinetic", "friction.kinetic_coefficient", [](Scene& s, double x) { s.friction.kinetic_coefficient = x; }},
      {"Static", "friction.static_coefficient", [](Scene& s, double x) { s.friction.static_coefficient = x; }},
      {"Newton", "restitution.newton", [](Scene& s, double x) { s.restitution = NewtonCoefficient{x}; }},
      {"Poisson", "restitution.poisson", [](Scene& s, double x) { s.restitution = PoissonCoefficient{x}; }},
      {"Energetic", "restitution.energetic", [](Scene& s, double x) { s.restitution = EnergeticCoefficient{x}; }},
  };
}

std::vector<BadScene> NotFinite() {
  std::vector<BadScene> scenes;
  for (const NumberField& field : NumberFields()) {
    const auto add = [&](const std::string& name, double value, const std::string& text) {
      const auto set = field.set;
      scenes.push_back({field.name + name, [set, value](Scene& scene) { set(scene, value); }, field.path,
                        "= " + text + ": must be finite"});
    };
    add("Nan", kNan, "nan");
    add("Infinite", kInfinity, "inf");
    add("NegativeInfinite", -kInfinity, "-inf");
  }
  return scenes;
}

std::vector<BadScene> BrokenRules() {
  return {
      {"NoSystem", [](Scene& s) { s.system = std::monostate(); }, "system", kOneOfTheSystems},
      {"NoRestitution", [](Scene& s) { s.restitution = std::monostate(); }, "restitution.coefficient",
       "is not set: must be one of newton, poisson, energetic"},
      {"ZeroInertia", [](Scene& s) { PendulumOf(s).inertia_kg_m2 = 0.0; }, "pendulum.inertia_kg_m2",
       "= 0: must be > 0"},
      {"NegativeInertia", [](Scene& s) { PendulumOf(s).inertia_kg_m2 = -2.5; }, "pendulum.inertia_kg_m2",
       "= -2.5: must be > 0"},
      {"ZeroA", [](Scene& s) { PendulumOf(s).a_m = 0.0; }, "pendulum.a_m", "= 0: must be > 0"},
      {"NegativeZeroA", [](Scene& s) { PendulumOf(s).a_m = -0.0; }, "pendulum.a_m", "= -0: must be > 0"},
      {"NegativeA", [](Scene& s) { PendulumOf(s).a_m = -1e-300; }, "pendulum.a_m", "= -1e-300: must be > 0"},
      {"NegativeKinetic", [](Scene& s) { s.friction.kinetic_coefficient = -0.1; }, "friction.kinetic_coefficient",
       "= -0.1: must be >= 0"},
      {"StaticBelowKinetic", [](Scene& s) { s.friction.static_coefficient = 0.05; }, "friction.static_coefficient",
       "= 0.05: must be >= friction.kinetic_coefficient = 0.1"},
      {"StaticOneUlpBelowKinetic", [](Scene& s) { s.friction.static_coefficient = std::nextafter(0.1, 0.0); },
       "friction.static_coefficient", "= 0.09999999999999999: must be >= friction.kinetic_coefficient = 0.1"},
      {"NegativeNewton", [](Scene& s) { s.restitution = NewtonCoefficient{-1e-9}; }, "restitution.newton",
       "= -1e-09: must be >= 0"},
      {"NegativePoisson", [](Scene& s) { s.restitution = PoissonCoefficient{-2.0}; }, "restitution.poisson",
       "= -2: must be >= 0"},
      {"NegativeEnergetic", [](Scene& s) { s.restitution = EnergeticCoefficient{-0.5}; }, "restitution.energetic",
       "= -0.5: must be in [0, 1]"},
      {"EnergeticOneUlpAboveOne", [](Scene& s) { s.restitution = EnergeticCoefficient{1.0 + 0x1p-52}; },
       "restitution.energetic", "= 1.0000000000000002: must be in [0, 1]"},
  };
}

std::string NameOf(const testing::TestParamInfo<BadScene>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(NotFinite, BadSceneTest, testing::ValuesIn(NotFinite()), NameOf);
INSTANTIATE_TEST_SUITE_P(BrokenRule, BadSceneTest, testing::ValuesIn(BrokenRules()), NameOf);

TEST(ValidateTest, AValidSceneHasNoViolations) { EXPECT_THAT(Validate(ValidScene()), IsEmpty()); }

TEST(ValidateTest, TheEdgesOfEveryRuleAreValid) {
  std::vector<Scene> scenes(9, ValidScene());
  PendulumOf(scenes[0]).a_m = kSmallest;
  PendulumOf(scenes[1]).inertia_kg_m2 = kSmallest;
  PendulumOf(scenes[2]).b_m = -0.0;
  PendulumOf(scenes[3]).omega_minus_rad_s = 4.0;
  scenes[4].friction.kinetic_coefficient = 0.0;
  scenes[5].friction.static_coefficient = 0.1;
  scenes[6].restitution = EnergeticCoefficient{1.0};
  scenes[7].restitution = NewtonCoefficient{0.0};
  scenes[8].restitution = PoissonCoefficient{std::numeric_limits<double>::max()};
  for (const Scene& scene : scenes) {
    EXPECT_THAT(Validate(scene), IsEmpty());
    std::optional<SceneContact> contact;
    EXPECT_TRUE(KeepsRelations(scene, nullptr, contact));
  }
}

TEST(ValidateTest, APowerLawBeyondTheDoublesIsRefusedUnlessNothingFollowsFromIt) {
  Scene scene = ValidScene();
  scene.friction.by_speed = PowerLaw{.alpha = 0.0, .exponent = 3e7};
  PendulumOf(scene).a_m = 1.0;
  // W of a pendulum with such a lever exceeds the doubles, too.
  for (const double b : {1.0, 5e263}) {
    PendulumOf(scene).b_m = b;
    std::get<PowerLaw>(*scene.friction.by_speed).alpha = 0.0;
    EXPECT_THAT(Validate(scene), IsEmpty());
    std::get<PowerLaw>(*scene.friction.by_speed).alpha = 0.1;
    const std::vector<Violation> violations = Validate(scene);
    ASSERT_EQ(violations.size(), 1u);
    EXPECT_EQ(violations.front().field, "friction.by_speed");
  }
}

TEST(ValidateTest, AllViolationsAreReportedAtOnceInFieldOrder) {
  const Scene scene = {
      .system = Pendulum{.inertia_kg_m2 = 0.0, .a_m = -1.0, .b_m = kNan, .omega_minus_rad_s = kInfinity},
      .friction = {.kinetic_coefficient = -0.1, .static_coefficient = -0.2},
      .restitution = EnergeticCoefficient{2.0}};
  std::vector<std::string> fields;
  for (const Violation& violation : Validate(scene)) fields.push_back(violation.field);
  EXPECT_THAT(fields,
              ElementsAre("pendulum.inertia_kg_m2", "pendulum.a_m", "pendulum.b_m", "pendulum.omega_minus_rad_s",
                          "friction.kinetic_coefficient", "friction.static_coefficient", "restitution.energetic"));
}

TEST(ValidateTest, AnEmptySceneMissesItsSystemAndItsRestitution) {
  EXPECT_THAT(Validate(Scene()), ElementsAre(Violation{"system", kOneOfTheSystems},
                                             Violation{"restitution.coefficient",
                                                       "is not set: must be one of newton, poisson, energetic"}));
}

TEST(ValidateTest, BoundsDoNotNeedARestitutionButCheckOneThatIsThere) {
  Scene scene = ValidScene();
  scene.restitution = std::monostate();
  EXPECT_THAT(Validate(scene, RestitutionIs::kOptional), IsEmpty());
  scene.restitution = EnergeticCoefficient{2.0};
  EXPECT_THAT(Validate(scene, RestitutionIs::kOptional),
              ElementsAre(Violation{"restitution.energetic", "= 2: must be in [0, 1]"}));
}

TEST(ValidateTest, StopsLookingOnceTheListIsFull) {
  Scene scene;
  scene.system = Linkage{std::vector<Link>(100'000, Link{})};
  const std::vector<Violation> violations = Validate(scene);
  EXPECT_TRUE(IsFull(violations));
  EXPECT_EQ(violations.size(), kMostViolations + 1);
}

}  // namespace
}  // namespace ricochet
