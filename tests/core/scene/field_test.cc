// The fields that an axis can drive.

#include "core/scene/field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/base/nearest.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Scene BaseScene() {
  return {.system = Pendulum{.inertia_kg_m2 = 2.0, .a_m = 3.0, .b_m = -4.0, .omega_minus_rad_s = -3.0},
          .friction = {.kinetic_coefficient = 0.1, .static_coefficient = std::nullopt},
          .restitution = EnergeticCoefficient{0.5}};
}

Scene SceneWith(const std::string& path, double value) {
  Scene scene = BaseScene();
  const absl::StatusOr<Field> field = ResolveField(path, scene);
  EXPECT_TRUE(field.ok()) << field.status();
  if (field.ok()) field->Set(value);
  return scene;
}

TEST(FieldTest, EachPathSetsItsOwnField) {
  EXPECT_EQ(std::get<Pendulum>(SceneWith("pendulum.inertia_kg_m2", 7.0).system).inertia_kg_m2, 7.0);
  EXPECT_EQ(std::get<Pendulum>(SceneWith("pendulum.a_m", 7.0).system).a_m, 7.0);
  EXPECT_EQ(std::get<Pendulum>(SceneWith("pendulum.b_m", 7.0).system).b_m, 7.0);
  EXPECT_EQ(std::get<Pendulum>(SceneWith("pendulum.omega_minus_rad_s", 7.0).system).omega_minus_rad_s, 7.0);
  EXPECT_EQ(SceneWith("friction.kinetic_coefficient", 7.0).friction.kinetic_coefficient, 7.0);
  EXPECT_EQ(SceneWith("friction.static_coefficient", 7.0).friction.static_coefficient, 7.0);
}

TEST(FieldTest, APathSetsNothingElse) {
  Scene expected = BaseScene();
  std::get<Pendulum>(expected.system).b_m = 7.0;
  EXPECT_EQ(SceneWith("pendulum.b_m", 7.0), expected);
}

TEST(FieldTest, ARestitutionPathSwitchesTheLaw) {
  EXPECT_EQ(SceneWith("restitution.newton", 0.7).restitution, Restitution(NewtonCoefficient{0.7}));
  EXPECT_EQ(SceneWith("restitution.poisson", 0.7).restitution, Restitution(PoissonCoefficient{0.7}));
  EXPECT_EQ(SceneWith("restitution.energetic", 0.7).restitution, Restitution(EnergeticCoefficient{0.7}));
}

// Fig. 4: phi = arctan(a/b) at constant distance from the pin, here 5.
TEST(FieldTest, PhiTurnsTheContactAboutThePinAtConstantDistance) {
  for (const double phi : {0.1, 0.7, 1.5, 2.5}) {
    const Scene scene = SceneWith("pendulum.phi_rad", phi);
    const auto& pendulum = std::get<Pendulum>(scene.system);
    EXPECT_NEAR(std::atan2(pendulum.a_m, pendulum.b_m), phi, 1e-15);
    EXPECT_NEAR(std::hypot(pendulum.a_m, pendulum.b_m), 5.0, 1e-14);
  }
}

TEST(FieldTest, PhiKeepsTheDistanceOfTheBaseSceneHoweverOftenItIsSet) {
  Scene scene = BaseScene();
  const absl::StatusOr<Field> field = ResolveField("pendulum.phi_rad", scene);
  ASSERT_TRUE(field.ok());
  for (int i = 1; i < 1'000; ++i) EXPECT_TRUE(field->Set(0.001 * i));
  field->Set(0.5);
  EXPECT_EQ(std::get<Pendulum>(scene.system).a_m, 5.0 * std::sin(0.5));
  EXPECT_THAT(field->sets(), ElementsAre("pendulum.a_m", "pendulum.b_m"));
}

// 45 is an angle in degrees; its sine is positive, so that the distances alone do not show the mistake.
TEST(FieldTest, PhiKeepsItsRuleOnlyBetweenZeroAndPi) {
  Scene scene = BaseScene();
  const absl::StatusOr<Field> field = ResolveField("pendulum.phi_rad", scene);
  ASSERT_TRUE(field.ok());
  EXPECT_TRUE(field->Set(1e-300));
  EXPECT_TRUE(field->Set(std::numbers::pi));
  for (const double phi : {0.0, -1.0, 3.2, 45.0, 200.0}) EXPECT_FALSE(field->Set(phi)) << phi;
}

TEST(FieldTest, EveryListedPathCanBeDriven) {
  for (const std::string& path : FieldPaths(BaseScene())) {
    Scene scene = BaseScene();
    EXPECT_TRUE(ResolveField(path, scene).ok()) << path;
  }
}

TEST(FieldTest, TheEndOfOnePathIsTakenForItAndTheEndOfSeveralForNone) {
  const auto message = [](const char* path) {
    Scene scene = BaseScene();
    return std::string(ResolveField(path, scene).status().message());
  };
  EXPECT_THAT(message("kinetic_coefficient"), HasSubstr("; did you mean friction.kinetic_coefficient?"));
  EXPECT_THAT(message("newton"), HasSubstr("; did you mean restitution.newton?"));
  EXPECT_EQ(NearestName("mass_kg", {"links[0].mass_kg", "links[1].mass_kg"}), "");
  EXPECT_EQ(NearestName("", {"a.", "b"}), "");
  // The error of an impulse is spelled almost as the impulse whose index is missing.
  EXPECT_EQ(NearestName("impulse.tangential_n_s", {"errors.tangential_n_s", "impulse.tangential_n_s[0]"}),
            "impulse.tangential_n_s[0]");
}

TEST(FieldTest, UnknownPathsAreRefusedAndLeaveTheSceneAsItWas) {
  for (const char* path : {"", "pendulum", "pendulum.c_m", "a_m", "pendulum.a_m ", "friction.mu", "restitution",
                           "restitution.coefficient", "surface_velocity.x_m_s", "surface_velocity.tangential_m_s[1]"}) {
    Scene scene = BaseScene();
    const absl::StatusOr<Field> field = ResolveField(path, scene);
    ASSERT_FALSE(field.ok()) << path;
    EXPECT_EQ(field.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(field.status().message()),
                HasSubstr("must be a field that the scene states; `ricochet sweep --axis '?'` lists them"));
    EXPECT_EQ(scene, BaseScene());
  }
}

}  // namespace
}  // namespace ricochet
