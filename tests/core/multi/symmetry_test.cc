// A symmetric scene has a symmetric answer, and the order in which contacts are listed changes nothing but the order of
// the answer: bit for bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

#include "tests/support/scenes/multi_contact_scenes.h"

namespace ricochet {
namespace {

double Random(double low, double high, std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// A body with contacts at random places, in pairs that are images of each other in the y axis, falling straight.
MultiContactScene SymmetricScene(std::mt19937_64& random) {
  MultiContactScene scene;
  scene.system = FreeBodies{.bodies = {{.mass_kg = Random(0.5, 2.0, random),
                                        .inertia_com_kg_m2 = {Random(0.1, 1.0, random)},
                                        .position_m = {0.0, Random(0.2, 1.0, random)},
                                        .linear_m_s = {0.0, -1.0}}}};
  const int pairs = std::uniform_int_distribution<int>(1, 2)(random);
  for (int pair = 0; pair < pairs; ++pair) {
    const double x = Random(0.1, 1.0, random), y = Random(-0.3, 0.3, random), lean = Random(-0.7, 0.7, random);
    MultiContactPoint contact = {.friction = Random(0.0, 1.0, random),
                                 .energetic = Random(0.1, 1.0, random),
                                 .relative_stiffness = Random(0.2, 5.0, random),
                                 .body = 1,
                                 .point_m = {x, y},
                                 .normal = {lean, 1.0}};
    scene.contacts.push_back(contact);
    contact.point_m[0] = -x;
    contact.normal[0] = -lean;
    scene.contacts.push_back(contact);
  }
  return scene;
}

// The scene as a mirror in the y axis shows it.
MultiContactScene Mirrored(MultiContactScene scene) {
  for (FreeBody& body : std::get<FreeBodies>(scene.system).bodies) {
    body.position_m[0] = -body.position_m[0];
    body.linear_m_s[0] = -body.linear_m_s[0];
    if (!body.angular_rad_s.empty()) body.angular_rad_s[0] = -body.angular_rad_s[0];
  }
  for (MultiContactPoint& contact : scene.contacts) {
    contact.point_m[0] = -contact.point_m[0];
    contact.normal[0] = -contact.normal[0];
  }
  return scene;
}

// -0 and 0 are the same number.
void ExpectMirrored(const std::vector<double>& found, const std::vector<double>& image) {
  ASSERT_EQ(found.size(), image.size());
  for (size_t i = 0; i < found.size(); i += 2) {
    EXPECT_EQ(found[i], -image[i]);
    EXPECT_EQ(found[i + 1], image[i + 1]);
  }
}

TEST(SymmetryTest, ASymmetricSceneHasSymmetricSpringsAndBounds) {
  std::mt19937_64 random(1);
  for (int number = 0; number < 1000; ++number) {
    const MultiContactAnswer answer = AnswerTo({.scene = SymmetricScene(random)});
    const AttainedOutcome& springs = *answer.springs;
    for (size_t pair = 0; pair < springs.contact_velocity_m_s.size(); pair += 4) {
      EXPECT_EQ(springs.contact_velocity_m_s[pair], -springs.contact_velocity_m_s[pair + 2]) << number;
      EXPECT_EQ(springs.contact_velocity_m_s[pair + 1], springs.contact_velocity_m_s[pair + 3]) << number;
      EXPECT_EQ(springs.impulse_n_s[pair], -springs.impulse_n_s[pair + 2]) << number;
      EXPECT_EQ(springs.impulse_n_s[pair + 1], springs.impulse_n_s[pair + 3]) << number;
    }
    EXPECT_EQ(springs.velocity[0], 0.0) << number;
    EXPECT_EQ(springs.velocity[2], 0.0) << number;
    // Orders break the symmetry in pairs: each has its mirror image.
    if (answer.orders.size() == 2) {
      EXPECT_EQ(answer.orders[0].velocity[1], answer.orders[1].velocity[1]) << number;
      EXPECT_EQ(answer.orders[0].velocity[2], -answer.orders[1].velocity[2]) << number;
    }
  }
}

TEST(SymmetryTest, TheMirrorImageOfASceneHasTheMirrorImageOfItsAnswer) {
  std::mt19937_64 random(2);
  for (int number = 0; number < 300; ++number) {
    MultiContactScene scene = SymmetricScene(random);
    FreeBody& body = std::get<FreeBodies>(scene.system).bodies.front();
    body.linear_m_s[0] = Random(-1.0, 1.0, random);
    body.angular_rad_s = {Random(-1.0, 1.0, random)};
    const MultiContactAnswer answer = AnswerTo({.scene = scene});
    const MultiContactAnswer image = AnswerTo({.scene = Mirrored(scene)});
    EXPECT_EQ(answer.verdict, image.verdict);
    ExpectMirrored(answer.springs->contact_velocity_m_s, image.springs->contact_velocity_m_s);
    ExpectMirrored(answer.springs->impulse_n_s, image.springs->impulse_n_s);
    ASSERT_EQ(answer.orders.size(), image.orders.size());
    for (size_t i = 0; i < answer.orders.size(); ++i) {
      EXPECT_EQ(answer.orders[i].orders, image.orders[i].orders);
      ExpectMirrored(answer.orders[i].contact_velocity_m_s, image.orders[i].contact_velocity_m_s);
    }
    for (size_t j = 0; j < 2 * scene.contacts.size(); ++j) {
      const bool is_normal = j % 2 == 1;
      EXPECT_EQ(answer.possible[j].lower, is_normal ? image.possible[j].lower : -image.possible[j].upper);
      EXPECT_EQ(answer.possible[j].upper, is_normal ? image.possible[j].upper : -image.possible[j].lower);
    }
  }
}

TEST(SymmetryTest, PermutingTheContactsPermutesTheAnswer) {
  std::mt19937_64 random(3);
  for (int number = 0; number < 300; ++number) {
    MultiContactScene scene = SymmetricScene(random);
    FreeBody& body = std::get<FreeBodies>(scene.system).bodies.front();
    body.linear_m_s[0] = Random(-1.0, 1.0, random);
    body.angular_rad_s = {Random(-1.0, 1.0, random)};
    std::vector<size_t> from(scene.contacts.size());
    std::iota(from.begin(), from.end(), size_t{0});
    std::shuffle(from.begin(), from.end(), random);
    MultiContactScene permuted = scene;
    for (size_t i = 0; i < from.size(); ++i) permuted.contacts[i] = scene.contacts[from[i]];
    const MultiContactAnswer answer = AnswerTo({.scene = scene});
    const MultiContactAnswer other = AnswerTo({.scene = permuted});
    EXPECT_EQ(answer.verdict, other.verdict);
    EXPECT_EQ(answer.difference, other.difference);
    EXPECT_EQ(answer.springs->velocity, other.springs->velocity);
    ASSERT_EQ(answer.orders.size(), other.orders.size());
    std::vector<std::vector<double>> outcomes, others;
    for (const AttainedOutcome& outcome : answer.orders) outcomes.push_back(outcome.velocity);
    for (const AttainedOutcome& outcome : other.orders) others.push_back(outcome.velocity);
    std::sort(outcomes.begin(), outcomes.end());
    std::sort(others.begin(), others.end());
    EXPECT_EQ(outcomes, others);
    for (size_t i = 0; i < from.size(); ++i) {
      EXPECT_EQ(other.springs->impulse_n_s[2 * i], answer.springs->impulse_n_s[2 * from[i]]);
      EXPECT_EQ(other.springs->contacts[i], answer.springs->contacts[from[i]]);
      EXPECT_EQ(other.possible[2 * i].lower, answer.possible[2 * from[i]].lower);
      EXPECT_EQ(other.possible[2 * i + 1].upper, answer.possible[2 * from[i] + 1].upper);
    }
  }
}

}  // namespace
}  // namespace ricochet
