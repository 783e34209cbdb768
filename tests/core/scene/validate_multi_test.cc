// Requests are refused that break a rule of ricochet/multi_contact.h.

#include "core/scene/validate_multi.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/scenes/multi_contact_scenes.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Texts of the violations: "field description".
std::vector<std::string> TextsOf(const MultiContactRequest& request) {
  std::optional<MultiReduction> reduction;
  std::vector<std::string> texts;
  for (const Violation& violation : Validate(request, reduction)) {
    texts.push_back(violation.field + ' ' + violation.description);
  }
  EXPECT_EQ(reduction.has_value(), texts.empty() || reduction.has_value());
  return texts;
}

// Two contacts of a W of full rank.
MultiContactScene MatrixScene() {
  MultiContactScene scene;
  scene.system = ContactMatrix{
      .w_per_kg = {2.0, 0.25, 1.0, 0.25, 0.25, 1.5, -0.25, -0.5, 1.0, -0.25, 2.0, 0.25, 0.25, -0.5, 0.25, 1.5},
      .velocity_m_s = {0.5, -1.0, 0.5, 0.0}};
  scene.contacts.assign(2, {.friction = 0.3, .energetic = 0.5});
  return scene;
}

TEST(ValidateMultiTest, TakesScenesOfEverySystem) {
  EXPECT_THAT(TextsOf({.scene = MatrixScene()}), IsEmpty());
  EXPECT_THAT(TextsOf({.scene = FallingBlock(0.5, 0.5)}), IsEmpty());
  EXPECT_THAT(TextsOf({.scene = SpatialBox()}), IsEmpty());
}

TEST(ValidateMultiTest, AnEmptyRequestLacksSystemAndContacts) {
  EXPECT_THAT(TextsOf({}), ElementsAre("system is not set: must be one of contact_matrix, free_bodies, mechanism",
                                       "contacts has 0 entries: must have 1 to 16"));
}

TEST(ValidateMultiTest, AMatrixIsSymmetricSemidefiniteAndHoldsTheVelocityInItsRange) {
  MultiContactRequest request = {.scene = MatrixScene()};
  auto& matrix = std::get<ContactMatrix>(request.scene.system);
  matrix.w_per_kg[4] = 0.26;
  EXPECT_THAT(TextsOf(request), ElementsAre("contact_matrix.w_per_kg[4] = 0.26: must be that of its transpose, 0.25; "
                                            "take (W + W^T)/2 if they differ by rounding"));
  matrix.w_per_kg[4] = 0.25;
  matrix.w_per_kg[0] *= -1.0;
  EXPECT_THAT(TextsOf(request), ElementsAre(testing::MatchesRegex(
                                    "contact_matrix.w_per_kg\\[0\\] = -.*: must be >= 0, as it is on the diagonal")));
  matrix.w_per_kg[0] *= -1.0;
  matrix.w_per_kg[7] = matrix.w_per_kg[13] = -1.6;
  ASSERT_EQ(TextsOf(request).size(), 1U);
  EXPECT_THAT(TextsOf(request).front(), testing::HasSubstr("must be positive semidefinite"));
  // A wedge: both walls move together.
  request.scene = MatrixScene();
  std::get<ContactMatrix>(request.scene.system) = {.w_per_kg = {0, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, 0, -1, 0, 1},
                                                   .velocity_m_s = {0, -1, 0, 0.5}};
  // How fast the ball is does not matter, down to speeds whose squares are 0.
  for (const double speed : {1.0, 1e-200}) {
    std::get<ContactMatrix>(request.scene.system).velocity_m_s = {0, -speed, 0, 0.5 * speed};
    ASSERT_EQ(TextsOf(request).size(), 1U) << speed;
    EXPECT_THAT(TextsOf(request).front(), testing::HasSubstr("beside the range of W"));
  }
  std::get<ContactMatrix>(request.scene.system).velocity_m_s = {0, -1, 0, 1};
  EXPECT_THAT(TextsOf(request), IsEmpty());
}

// Two contacts that do not affect each other; `share` is what the first has of the W of the second.
MultiContactRequest Spread(double share) {
  MultiContactRequest request = {.scene = MatrixScene()};
  const double half = 0.5 * share;
  std::get<ContactMatrix>(request.scene.system) = {
      .w_per_kg = {share, half, 0, 0, half, share, 0, 0, 0, 0, 1, 0.5, 0, 0, 0.5, 1}, .velocity_m_s = {1, -1, 1, -1}};
  return request;
}

TEST(ValidateMultiTest, AContactIsNotLostBesideOneOfMuchLessMass) {
  EXPECT_THAT(TextsOf(Spread(1e-200)),
              testing::Each(testing::MatchesRegex(
                  "contacts\\[0\\] has 1e-200 1/kg on the diagonal of W: must have 0 or at least 3.*e-139 times the "
                  "largest, 1")));
  EXPECT_EQ(TextsOf(Spread(1e-200)).size(), 2U);
  EXPECT_THAT(TextsOf(Spread(1e-138)), IsEmpty());
}

TEST(ValidateMultiTest, ListsHaveTheLengthsOfTheSystem) {
  MultiContactRequest request = {.scene = FallingBlock(0.5, 0.5),
                                 .states = {{{0.0, -1.0}}, {{0.0, std::numeric_limits<double>::infinity(), 0.0}}},
                                 .outputs = {{.name = "", .coefficients = {1.0}}}};
  EXPECT_THAT(
      TextsOf(request),
      ElementsAre("states[0].velocity has 2 entries: must have 3", "states[1].velocity[1] = inf: must be finite",
                  "outputs[0].coefficients has 1 entry: must have 3", "outputs[0].name is empty: must not be"));
  request = {.scene = request.scene};
  std::get<FreeBodies>(request.scene.system).bodies.front().position_m.push_back(0.0);
  EXPECT_THAT(TextsOf(request), ElementsAre("free_bodies.bodies[0].position_m has 3 entries: must have 2"));
}

TEST(ValidateMultiTest, AContactOfAMatrixHasNoPlace) {
  MultiContactRequest request = {.scene = MatrixScene()};
  request.scene.contacts[1].body = 1;
  EXPECT_THAT(TextsOf(request), ElementsAre("contacts[1] has a body, a point or a normal: must have none, the system "
                                            "states no bodies"));
}

TEST(ValidateMultiTest, AMethodThatTheSceneDoesNotAllowIsRefusedIfItIsAskedFor) {
  MultiContactRequest request = {.scene = SpatialBox(),
                                 .methods = {MultiContactMethod::kPossible, MultiContactMethod::kSprings},
                                 .stiffness_range = StiffnessRange{.contact = 5, .low = 1.0, .high = 1.0}};
  EXPECT_THAT(TextsOf(request), ElementsAre("methods[1] = springs: springs are computed in a plane only",
                                            "stiffness_range is set: springs are computed in a plane only",
                                            "stiffness_range.contact = 5: must be in [1, 4]",
                                            "stiffness_range.high = 1: must be above low and at most 1e+12 times it"));
  request = {.scene = RowOfBalls(std::vector<double>(8, 1.0), std::vector<double>(8, 0.0), std::vector<double>(7, 0.5)),
             .methods = {MultiContactMethod::kOrders}};
  EXPECT_THAT(TextsOf(request), ElementsAre("methods[0] = orders: orders are searched for at most 6 contacts"));
}

TEST(ValidateMultiTest, ABodyInSpaceHasTheInertiaOfABody) {
  MultiContactRequest request = {.scene = SpatialBox()};
  std::get<FreeBodies>(request.scene.system).bodies.front().inertia_com_kg_m2 = {1, 0, 0, 1, 0, 3};
  ASSERT_EQ(TextsOf(request).size(), 1U);
  EXPECT_THAT(TextsOf(request).front(), testing::HasSubstr("its largest principal moment"));
}

}  // namespace
}  // namespace ricochet
