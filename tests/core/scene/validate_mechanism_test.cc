// Bad mechanisms are refused with the rule that they break.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/scene/validate.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

struct BadMechanism {
  std::string field;
  std::string description;
  std::function<void(Mechanism&)> spoil;
};

TEST(ValidateMechanismTest, NamesWhatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<BadMechanism> all = {
      {"mechanism.rates", "has 0 entries: must have at least one", [](Mechanism& m) { m.rates.clear(); }},
      {"mechanism.mass_matrix", "has 8 entries: must have n x n = 9 for the 3 of rates",
       [](Mechanism& m) { m.mass_matrix.pop_back(); }},
      {"mechanism.jacobian", "has 5 entries: must have 2 x n = 6 in a plane or 3 x n = 9 in space",
       [](Mechanism& m) { m.jacobian.pop_back(); }},
      {"mechanism.mass_matrix[3]", "= 0.7: must be equal to the entry across the diagonal, [1] = 0.6 (row 0, column 1)",
       [](Mechanism& m) { m.mass_matrix[3] = 0.7; }},
      {"mechanism.mass_matrix[4]", "= -1: must be > 0", [](Mechanism& m) { m.mass_matrix[4] = -1.0; }},
      // The eigenvalues of [2 3; 3 1.2], scaled by powers of two to [2 3; 3 1.2], are 1.6 +- 3.03.
      {"mechanism.mass_matrix", "has the eigenvalue -1.4",
       [](Mechanism& m) { m.mass_matrix[1] = m.mass_matrix[3] = 3.0; }},
      {"mechanism.mass_matrix[2]", "= nan: must be finite", [nan](Mechanism& m) { m.mass_matrix[2] = nan; }},
      {"mechanism.jacobian[1]", "= nan: must be finite", [nan](Mechanism& m) { m.jacobian[1] = nan; }},
      {"mechanism.rates[0]", "= inf: must be finite",
       [](Mechanism& m) { m.rates[0] = std::numeric_limits<double>::infinity(); }},
      {"mechanism.kept_coordinates[1]", "= 3: must be in [0, 3)",
       [](Mechanism& m) {
         m.kept_coordinates = {0, 3};
       }},
      {"mechanism.kept_coordinates[0]", "= -1: must be in [0, 3)", [](Mechanism& m) { m.kept_coordinates = {-1}; }},
      {"mechanism.kept_coordinates[1]", "= 2: must be named once",
       [](Mechanism& m) {
         m.kept_coordinates = {2, 2};
       }},
      {"mechanism.kept_coordinates", "is set beside composite",
       [](Mechanism& m) {
         m.kept_coordinates = {2};
         m.composite = true;
       }},
      {"mechanism.composite", "must not be without a floating base", [](Mechanism& m) { m.composite = true; }},
      // Nothing is free to move.
      {"system", "where W_nn = 0",
       [](Mechanism& m) {
         m.kept_coordinates = {0, 1, 2};
       }},
  };
  for (const BadMechanism& bad : all) {
    SCOPED_TRACE(bad.field + " " + bad.description);
    Mechanism mechanism = Arm();
    bad.spoil(mechanism);
    const std::vector<Violation> violations = Validate(With(mechanism));
    bool found = false;
    for (const Violation& violation : violations) {
      found =
          found || (violation.field == bad.field && violation.description.find(bad.description) != std::string::npos);
      EXPECT_THAT(violation.description, HasSubstr("must"));
    }
    EXPECT_TRUE(found) << (violations.empty() ? "valid" : violations[0].field + " " + violations[0].description);
  }
}

TEST(ValidateMechanismTest, ListsEveryEntryThatIsNotSymmetric) {
  Mechanism arm = Arm();
  arm.mass_matrix[3] = 0.7;
  arm.mass_matrix[7] = 0.31;
  EXPECT_EQ(Validate(With(arm)).size(), 2U);
}

TEST(ValidateMechanismTest, TakesMechanismsOfAnyConditionThatDoublesResolve) {
  Mechanism two = {.mass_matrix = {1.0, 1.0, 1.0, 1.0 + 1e-12}, .jacobian = {1, 0, 0, 1}, .rates = {-1, -1}};
  EXPECT_THAT(Validate(With(two)), IsEmpty());
  two.mass_matrix[3] = 1.0;
  EXPECT_FALSE(Validate(With(two)).empty());
}

TEST(ValidateMechanismTest, MayNotHaveForcesOrCertificates) {
  Scene scene = With(Arm());
  EXPECT_FALSE(LocalSolver().Solve({.scene = scene, .certified_digits = 10}).ok());
  scene.finite_forces = Gravity{0.0, -9.81};
  EXPECT_EQ(Validate(scene).size(), 1U);
}

}  // namespace
}  // namespace ricochet
