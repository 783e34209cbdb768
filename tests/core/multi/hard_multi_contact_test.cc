// Scenes of several contacts that tempt a solver to loop, to lose a digit, or to answer where there is no answer.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "core/multi/energy.h"
#include "core/multi/orders.h"
#include "core/multi/possible.h"
#include "core/multi/springs.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/multi_contact_scenes.h"
#include "tests/support/scenes/random_multi_contact.h"

namespace ricochet::multi {
namespace {

const auto kNever = [] { return false; };

// A ball that fills a slot: two walls that face each other.
Problem Slot(double e1, double e2) {
  Problem slot = {.d = 2, .k = 2, .w = Eigen::MatrixXd::Zero(4, 4), .v = Vector::Zero(4)};
  slot.laws = {{.e = e1}, {.e = e2}};
  slot.w(1, 1) = slot.w(3, 3) = 2.0;
  slot.w(1, 3) = slot.w(3, 1) = -2.0;
  slot.v(1) = -1.0;
  slot.v(3) = 1.0;
  return slot;
}

// A slider locks itself while a ball goes on between two walls that it is not coupled to.
TEST(HardMultiContactTest, AContactThatJamsEndsNothingElsewhere) {
  Problem scene = {.d = 2, .k = 3, .w = Eigen::MatrixXd::Zero(6, 6), .v = Vector::Zero(6)};
  scene.laws = {{.mu = 2.0, .e = 0.5, .stiffness = 100.0}, {.e = 0.5}, {.e = 0.5}};
  scene.w.topLeftCorner(2, 2) << 1.0, -1.0, -1.0, 1.0;
  scene.w(3, 3) = scene.w(5, 5) = 1.0;
  scene.w(3, 5) = scene.w(5, 3) = -1.0;
  scene.v << 1.0, -1.0, 0.0, -1.0, 0.0, 1.0;
  const Attained springs = FindSprings(scene, std::nullopt, kNever);
  EXPECT_NE(springs.end, MultiContactEnd::kWedged);
  EXPECT_NEAR(springs.v(3), 0.0, 1e-4);
  EXPECT_NEAR(springs.v(5), 0.0, 1e-4);
}

// Two plastic contacts that push each other on come to rest: nothing can hold a force where W is regular and there is
// no friction, and all energy of the contacts is lost.
TEST(HardMultiContactTest, PlasticContactsThatPushEachOtherOnComeToRest) {
  for (const double coupling : {0.05, 0.2, 0.5, 0.9}) {
    for (const double second : {0.5, 0.7, 1.3}) {
      MultiContactScene scene;
      scene.system = ContactMatrix{.w_per_kg = {1, 0, 0, 0, 0, 1, 0, -coupling, 0, 0, 1, 0, 0, -coupling, 0, 1},
                                   .velocity_m_s = {0, -1, 0, -second}};
      scene.contacts = {{.energetic = 0.0}, {.energetic = 0.0}};
      const MultiContactAnswer answer = AnswerTo({.scene = scene});
      const AttainedOutcome& springs = *answer.springs;
      EXPECT_EQ(springs.end, MultiContactEnd::kEndless) << coupling << " " << second;
      EXPECT_EQ(answer.verdict, MultiContactVerdict::kOrdersAgree) << coupling << " " << second;
      const double energy = (1.0 + 2.0 * coupling * second + second * second) / (1.0 - coupling * coupling) / 2.0;
      EXPECT_NEAR(springs.energy_change_j, -energy, 1e-11) << coupling << " " << second;
    }
  }
}

// The energy of contacts that jam is that of their velocities.
TEST(HardMultiContactTest, AWedgedOutcomeHasTheEnergyOfItsVelocities) {
  MultiContactScene scene;
  scene.system =
      ContactMatrix{.w_per_kg = {1, -1, 0, 0, -1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, .velocity_m_s = {1, -1, 0, 1}};
  scene.contacts = {{.friction = 2.0, .energetic = 0.5}, {.energetic = 0.5}};
  const AttainedOutcome springs = AnswerTo({.scene = scene}).springs.value();
  EXPECT_EQ(springs.end, MultiContactEnd::kWedged);
  EXPECT_NEAR(springs.energy_change_j, -0.5, 1e-12);
  EXPECT_TRUE(std::isinf(springs.work_error_j));
}

// A plank of 1 kg on two feet below a box of r kg on two others. W has rank 6 and loses digits of the box to rounding;
// the velocities of bodies lie in its range all the same.
TEST(HardMultiContactTest, HeavyBodiesOnLightOnesAreAnswered) {
  for (const double mass : {1e2, 1e3, 1e4, 1e6}) {
    MultiContactScene scene;
    scene.system = FreeBodies{.bodies = {{.mass_kg = 1.0, .inertia_com_kg_m2 = {0.14}, .position_m = {0.0, 0.05}},
                                         {.mass_kg = mass,
                                          .inertia_com_kg_m2 = {0.16 * mass},
                                          .position_m = {0.1, 0.6},
                                          .linear_m_s = {0.3, -1.0},
                                          .angular_rad_s = {0.1}}}};
    for (const double x : {-0.65, 0.65}) {
      scene.contacts.push_back(
          {.friction = 0.5, .energetic = 0.3, .body = 1, .point_m = {x, 0.0}, .normal = {0.0, 1.0}});
    }
    for (const double x : {-0.4, 0.6}) {
      scene.contacts.push_back(
          {.friction = 0.5, .energetic = 0.3, .body = 2, .other_body = 1, .point_m = {x, 0.1}, .normal = {0.0, 1.0}});
    }
    const MultiContactAnswer answer =
        AnswerTo({.scene = scene, .methods = {MultiContactMethod::kOrders, MultiContactMethod::kPossible}});
    for (const AttainedOutcome& outcome : answer.orders) {
      if (outcome.end == MultiContactEnd::kBudgetUsedUp) continue;
      for (size_t j = 0; j < outcome.contact_velocity_m_s.size(); ++j) {
        const double v = outcome.contact_velocity_m_s[j], error = outcome.contact_velocity_error_m_s[j];
        EXPECT_LE(answer.possible[j].lower, v + error) << mass << " " << j;
        EXPECT_GE(answer.possible[j].upper, v - error) << mass << " " << j;
      }
    }
  }
}

// Each two impacts multiply the speed by e1 e2, so that the impulses are geometric sums.
TEST(HardMultiContactTest, ABallInASlotComesToRest) {
  const Problem slot = Slot(0.5, 0.8);
  const Orders orders = FindOrders(slot, kNever);
  ASSERT_EQ(orders.outcomes.size(), 1U);
  const Attained& rest = orders.outcomes.front().attained;
  EXPECT_EQ(rest.end, MultiContactEnd::kEndless);
  EXPECT_EQ(rest.v(1), 0.0);
  EXPECT_EQ(rest.v(3), 0.0);
  EXPECT_NEAR(rest.p(1), 1.5 / 2.0 / (1.0 - 0.4), 1e-15);
  EXPECT_NEAR(rest.p(3), 1.8 * 0.5 / 2.0 / (1.0 - 0.4), 1e-15);
  EXPECT_EQ(PushApart(slot, MetricOf(slot)).size(), 0);
  const Attained springs = FindSprings(slot, std::nullopt, kNever);
  EXPECT_NEAR(springs.v(1), 0.0, springs.ErrorOf(slot, 1) + 1e-12);
}

// A plastic wall ends the motion, whichever of the two it is.
TEST(HardMultiContactTest, ABallInASlotStopsAtAPlasticWall) {
  for (const bool is_first : {true, false}) {
    const Orders orders = FindOrders(is_first ? Slot(0.0, 0.5) : Slot(0.5, 0.0), kNever);
    ASSERT_EQ(orders.outcomes.size(), 1U);
    const Attained& rest = orders.outcomes.front().attained;
    EXPECT_EQ(rest.end, MultiContactEnd::kSeparated);
    EXPECT_EQ(rest.order, is_first ? std::vector<int>({0}) : std::vector<int>({0, 1}));
    EXPECT_EQ(rest.v(1), 0.0);
    EXPECT_EQ(rest.v(3), 0.0);
  }
}

// The contacts 1 and 3 strike each other in turn without end, and every other of their speeds rises. An enumeration in
// 50 digits gives the limits.
TEST(HardMultiContactTest, EachLimitIsStatedWithinItsError) {
  Problem problem = {.d = 2, .k = 3, .w = Eigen::MatrixXd::Zero(6, 6), .v = Vector::Zero(6)};
  problem.laws = {{.e = 0.0}, {.e = 0.5}, {.e = 0.0}};
  problem.w << 5, -4, 5, 0, 5, 6, -4, 5, -4, 1, -4, -5, 5, -4, 5, 0, 5, 6, 0, 1, 0, 1, 0, 1, 5, -4, 5, 0, 5, 6, 6, -5,
      6, 1, 6, 10;
  problem.v << 0, 1, 0, -1, 0, -4;
  const double limit[] = {2, 0, 2, 0, 2, 0};
  const Orders orders = FindOrders(problem, kNever);
  const auto is_limit = [&](const DistinctOutcome& outcome) {
    for (int j = 0; j < 6; ++j) {
      if (std::abs(outcome.attained.v(j) - limit[j]) > outcome.attained.ErrorOf(problem, j)) return false;
    }
    return true;
  };
  EXPECT_TRUE(std::any_of(orders.outcomes.begin(), orders.outcomes.end(), is_limit));
}

// Errors that grow with each of some hundred impacts, until they exceed all there is, are not stated.
TEST(HardMultiContactTest, AnErrorBeyondAllEnergyIsUnknown) {
  const MultiContactRequest request = {
      .scene = {.system = FreeBodies{.bodies = {FreeBody{.mass_kg = 0.5,
                                                         .inertia_com_kg_m2 = {0.0002},
                                                         .position_m = {0.0, 0.0},
                                                         .linear_m_s = {2.0, 0.3}}}},
                .contacts = {{.energetic = 0.8, .body = 1, .point_m = {-0.03, 0.0}, .normal = {1.0, 0.0}},
                             {.energetic = 0.8, .body = 1, .point_m = {0.03, 0.0}, .normal = {-1.0, 0.0}}}}};
  const MultiContactResponse response = *LocalSolver().MultiContact(request);
  ASSERT_TRUE(response.answers[0].springs.has_value());
  const AttainedOutcome& springs = *response.answers[0].springs;
  EXPECT_NEAR(springs.impulse_n_s[1], 4.0, 1e-9);  // The sum of a geometric series.
  EXPECT_TRUE(springs.normal_impulse_error_n_s.empty());
  EXPECT_TRUE(std::isinf(springs.work_error_j));
}

// The condition for a sequence without end holds with equality in a slot, which no rounding may decide.
TEST(HardMultiContactTest, EverySlotHasAProvedLimit) {
  for (int i = 1; i < 20; ++i) {
    for (int j = 1; j <= 20; ++j) {
      const double e1 = 0.05 * i, e2 = j == 20 ? 1.0 : 0.05 * j;
      const Orders orders = FindOrders(Slot(e1, e2), kNever);
      ASSERT_EQ(orders.outcomes.size(), 1U);
      const Attained& rest = orders.outcomes.front().attained;
      EXPECT_EQ(rest.end, MultiContactEnd::kEndless) << e1 << " " << e2;
      EXPECT_TRUE(rest.error_is_proved);
      EXPECT_LE(rest.events, 2) << e1 << " " << e2;
      EXPECT_NEAR(rest.p(1), (1.0 + e1) / 2.0 / (1.0 - e1 * e2), 1e-14 / (1.0 - e1 * e2));
    }
  }
}

// Walls that part carry the ball away, however slowly: this is no slot.
TEST(HardMultiContactTest, WallsThatPartHaveNoLimitBetweenThem) {
  for (const double parting : {5e-7, -5e-7}) {
    Problem slot = Slot(0.5, 0.5);
    slot.v(3) += parting;
    for (const DistinctOutcome& outcome : FindOrders(slot, kNever).outcomes) {
      EXPECT_NE(outcome.attained.end, MultiContactEnd::kEndless) << parting;
    }
  }
  // One that loses next to nothing comes to rest all the same.
  const Orders nearly_elastic = FindOrders(Slot(1.0 - 1e-10, 1.0 - 1e-10), kNever);
  EXPECT_EQ(nearly_elastic.outcomes.front().attained.end, MultiContactEnd::kEndless);
}

TEST(HardMultiContactTest, AnElasticBallInASlotHasNoLimit) {
  const Orders orders = FindOrders(Slot(1.0, 1.0), kNever, 200);
  EXPECT_FALSE(orders.complete);
  EXPECT_EQ(orders.outcomes.front().attained.end, MultiContactEnd::kBudgetUsedUp);
  EXPECT_EQ(FindSprings(Slot(1.0, 1.0), std::nullopt, kNever, 500).end, MultiContactEnd::kBudgetUsedUp);
  const auto verdict = [](double e, std::vector<MultiContactMethod> methods) {
    MultiContactScene scene;
    scene.system =
        ContactMatrix{.w_per_kg = {0, 0, 0, 0, 0, 2, 0, -2, 0, 0, 0, 0, 0, -2, 0, 2}, .velocity_m_s = {0, -1, 0, 1}};
    scene.contacts = {{.energetic = 1.0}, {.energetic = e}};
    return AnswerTo({.scene = scene, .methods = std::move(methods)}).verdict;
  };
  for (const std::vector<MultiContactMethod>& methods :
       {std::vector<MultiContactMethod>{}, {MultiContactMethod::kPossible}}) {
    EXPECT_EQ(verdict(1.0, methods), MultiContactVerdict::kUnspecified);
    EXPECT_EQ(verdict(0.5, methods), MultiContactVerdict::kSingle);  // Its limit is rest.
  }
}

// A sequence that comes back to a state before goes on for ever: a ball in a slot one of whose walls is two contacts,
// and a ball between three walls at 60 degrees.
TEST(HardMultiContactTest, ASequenceThatComesBackIsNoOrderThatAgrees) {
  MultiContactScene slot;
  slot.system =
      FreeBodies{{{.mass_kg = 1.0, .inertia_com_kg_m2 = {0.1}, .position_m = {0.0, 0.0}, .linear_m_s = {1.0, 0.3}}}};
  for (const double side : {-1.0, 1.0, -1.0}) {
    slot.contacts.push_back({.energetic = 1.0, .body = 1, .point_m = {0.5 * side, 0.0}, .normal = {-side, 0.0}});
  }
  slot.contacts.back().energetic = 0.0;
  MultiContactScene walls;
  walls.system = ContactMatrix{.w_per_kg = {1, 0,    0, 0, 0, 0,    0, 1, 0, -0.5, 0, -0.5, 0, 0,    1, 0,    0, 0,
                                            0, -0.5, 0, 1, 0, -0.5, 0, 0, 0, 0,    1, 0,    0, -0.5, 0, -0.5, 0, 1},
                               .velocity_m_s = {0, 1, 0, -0.25, 0, -0.75}};
  walls.contacts = {{.energetic = 1.0}, {.energetic = 1.0}, {.energetic = 1.0}};
  for (const MultiContactScene& scene : {slot, walls}) {
    for (const std::vector<MultiContactMethod>& methods :
         {std::vector<MultiContactMethod>{},
          {MultiContactMethod::kOrders},
          {MultiContactMethod::kOrders, MultiContactMethod::kPossible}}) {
      const MultiContactAnswer answer = AnswerTo({.scene = scene, .methods = methods});
      EXPECT_EQ(answer.verdict, MultiContactVerdict::kUnspecified);
      EXPECT_TRUE(std::any_of(answer.orders.begin(), answer.orders.end(), [](const AttainedOutcome& order) {
        return order.end == MultiContactEnd::kBudgetUsedUp;
      }));
    }
  }
}

// Contact 1 sticks and is plastic, which ends all motion of two coordinates: what is left is rounding. It may be struck
// again, and then comes back to itself, but is an end all the same.
TEST(HardMultiContactTest, ASequenceThatComesBackToRestHasEnded) {
  MultiContactScene scene;
  scene.system = Mechanism{.mass_matrix = {1.6012, 0.7654, 0.7654, 0.366},
                           .jacobian = {-0.4, 0.5, -0.93, -0.25, 0.69, 0.46, 0.51, -0.35, -1.02, 0.58, 0.28, -0.33},
                           .rates = {0.31, 1.35}};
  scene.contacts = {{.friction = 1.0, .energetic = 0.0}, {.friction = 0.1, .energetic = 1.0}, {.energetic = 1.0}};
  for (const double part : {0.8, 0.9, 1.0, 1.1, 1.2}) {
    std::get<Mechanism>(scene.system).rates[0] = 0.31 * part;
    const MultiContactAnswer answer = AnswerTo({.scene = scene, .methods = {MultiContactMethod::kOrders}});
    EXPECT_TRUE(std::any_of(answer.orders.begin(), answer.orders.end(), [](const AttainedOutcome& order) {
      const bool has_end = order.end == MultiContactEnd::kSeparated || order.end == MultiContactEnd::kEndlessEstimate;
      return has_end && std::hypot(order.velocity[0], order.velocity[1]) < 1e-9;
    })) << part;
  }
}

// The scene above has a fourth contact, which moves a coordinate of its own: no order ends before it has been struck.
TEST(HardMultiContactTest, ASequenceThatComesBackToRestLeavesNoOtherContactOut) {
  for (const double approach : {-1.0, -100.0}) {
    MultiContactScene scene;
    scene.system = Mechanism{.mass_matrix = {1.6012, 0.7654, 0.0, 0.7654, 0.366, 0.0, 0.0, 0.0, 1.0},
                             .jacobian = {-0.4,  0.5,  0.0, -0.93, -0.25, 0.0, 0.69, 0.46, 0.0, 0.51, -0.35, 0.0,
                                          -1.02, 0.58, 0.0, 0.28,  -0.33, 0.0, 0.0,  0.0,  0.0, 0.0,  0.0,   1.0},
                             .rates = {0.31, 1.35, approach}};
    scene.contacts = {{.friction = 1.0, .energetic = 0.0},
                      {.friction = 0.1, .energetic = 1.0},
                      {.energetic = 1.0},
                      {.energetic = 0.5}};
    const MultiContactAnswer answer = AnswerTo({.scene = scene, .methods = {MultiContactMethod::kOrders}});
    EXPECT_FALSE(answer.orders.empty());
    for (const AttainedOutcome& order : answer.orders) {
      if (order.end == MultiContactEnd::kBudgetUsedUp) continue;
      EXPECT_NEAR(order.velocity[2], -0.5 * approach, 1e-9) << order.orders.front();
    }
  }
}

// Contacts that rest are at rest in every frame, and nothing strikes.
TEST(HardMultiContactTest, ABoxThatSlidesIsNotStruckByRounding) {
  for (int degrees = 0; degrees < 360; degrees += 7) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const std::vector<double> t = {std::cos(angle), std::sin(angle)}, n = {-t[1], t[0]};
    MultiContactScene scene;
    scene.system = FreeBodies{{{.mass_kg = 1.0,
                                .inertia_com_kg_m2 = {0.4},
                                .position_m = {0.5 * n[0], 0.5 * n[1]},
                                .linear_m_s = {2.0 * t[0], 2.0 * t[1]}}}};
    for (const double side : {-0.7, 0.7}) {
      scene.contacts.push_back(
          {.friction = 0.3, .energetic = 0.5, .body = 1, .point_m = {side * t[0], side * t[1]}, .normal = n});
    }
    const MultiContactAnswer answer = AnswerTo({.scene = scene});
    EXPECT_EQ(answer.verdict, MultiContactVerdict::kSingle) << degrees;
    EXPECT_EQ(answer.springs->events, 0) << degrees;
  }
}

// A ball falls on a block that stands on two feet. The foot below it is pressed, and the other one is pulled open while
// its velocity is still 0. The reference was integrated by matrix exponentials from event to event.
TEST(HardMultiContactTest, AFootThatIsPulledOpenFromRestOpens) {
  const auto springs_at = [](double foot) {
    MultiContactScene scene;
    scene.system = FreeBodies{
        {{.mass_kg = 1.0, .inertia_com_kg_m2 = {5.0 / 12.0}, .position_m = {0.0, 0.5}},
         {.mass_kg = 1.0, .inertia_com_kg_m2 = {0.1}, .position_m = {-0.9, 1.5}, .linear_m_s = {0.0, -1.0}}}};
    std::get<FreeBodies>(scene.system).bodies.front().linear_m_s = {0.0, foot};
    scene.contacts = {{.energetic = 1.0, .body = 1, .point_m = {-1.0, 0.0}, .normal = {0.0, 1.0}},
                      {.energetic = 1.0, .body = 1, .point_m = {1.0, 0.0}, .normal = {0.0, 1.0}},
                      {.energetic = 1.0, .body = 2, .other_body = 1, .point_m = {-0.9, 1.0}, .normal = {0.0, 1.0}}};
    return *AnswerTo({.scene = scene}).springs;
  };
  for (const double foot : {0.0, 1e-12, -1e-12}) {
    const AttainedOutcome springs = springs_at(foot);
    EXPECT_NEAR(springs.contact_velocity_m_s[1], 0.69257339, 1e-7) << foot;
    EXPECT_NEAR(springs.contact_velocity_m_s[3], 0.18883053, 1e-7) << foot;
    EXPECT_NEAR(springs.contact_velocity_m_s[5], 0.21542108, 1e-7) << foot;
  }
}

// The feet of a wide box on a smooth floor: after the first impact both strike without end, and both orders agree.
TEST(HardMultiContactTest, TwoPlasticFeetStrikeWithoutEndAndComeToRestTogether) {
  Problem feet = {.d = 2, .k = 2, .w = Eigen::MatrixXd::Zero(4, 4), .v = Vector::Zero(4), .laws = {{}, {}}};
  feet.w(1, 1) = feet.w(3, 3) = 1.0;
  feet.w(1, 3) = feet.w(3, 1) = -0.6;
  feet.v(1) = -1.0;
  feet.v(3) = -0.8;
  const Orders orders = FindOrders(feet, kNever);
  ASSERT_EQ(orders.outcomes.size(), 1U);
  EXPECT_EQ(orders.outcomes.front().order_count, 2);
  const Attained& rest = orders.outcomes.front().attained;
  EXPECT_EQ(rest.end, MultiContactEnd::kEndless);
  // P = -W^-1 v
  EXPECT_NEAR(rest.p(1), (1.0 + 0.6 * 0.8) / 0.64, 4e-15);
  EXPECT_NEAR(rest.p(3), (0.8 + 0.6 * 1.0) / 0.64, 4e-15);
}

// All feet let go at one instant, at which nothing moves: no ratio of their coefficients matters.
TEST(HardMultiContactTest, PlasticFeetThatLandFlatStay) {
  const std::vector<std::vector<double>> boxes = {{-0.5, 0.0, 0.5}, {-0.5, -0.2, 0.2, 0.5}};
  std::vector<MultiContactScene> scenes;
  for (const std::vector<double>& feet : boxes) {
    MultiContactScene& scene = scenes.emplace_back(FallingBlock(0.5, 0.0));
    scene.contacts.clear();
    for (const double x : feet) {
      scene.contacts.push_back(
          {.friction = 0.5, .energetic = 0.0, .body = 1, .point_m = {x, 0.0}, .normal = {0.0, 1.0}});
    }
  }
  MultiContactScene& two = scenes.emplace_back(FallingBlock(0.5, 0.0));
  auto& bodies = std::get<FreeBodies>(two.system).bodies;
  bodies.push_back(bodies.front());
  bodies.back().position_m = {5.0, 1.0};
  for (const double x : {4.5, 5.5}) {
    two.contacts.push_back({.friction = 0.5, .energetic = 0.0, .body = 2, .point_m = {x, 0.0}, .normal = {0.0, 1.0}});
  }
  for (const MultiContactScene& scene : scenes) {
    const auto response = LocalSolver().MultiContact({.scene = scene, .methods = {MultiContactMethod::kSprings}});
    ASSERT_TRUE(response.ok()) << response.status();
    const AttainedOutcome& springs = *response->answers.front().springs;
    EXPECT_EQ(springs.end, MultiContactEnd::kSeparated);
    for (const double velocity : springs.velocity) EXPECT_NEAR(velocity, 0.0, 1e-14);
  }
}

TEST(HardMultiContactTest, PlasticSpringsAreTheLimitOfSpringsThatAreNearlyPlastic) {
  std::mt19937_64 random(21);
  int compared = 0;
  for (int scene = 0; scene < 60; ++scene) {
    Problem problem = RandomMultiContact(random, true);
    if (problem.k != 2 || PushApart(problem, MetricOf(problem)).size() == 0) continue;
    const auto with = [&](double e) {
      for (ContactLaw& law : problem.laws) law.e = e;
      return FindSprings(problem, std::nullopt, kNever);
    };
    const Attained plastic = with(0.0);
    const Attained nearly = with(1e-4);
    if (plastic.end == MultiContactEnd::kUndetermined || nearly.end == MultiContactEnd::kBudgetUsedUp) continue;
    ++compared;
    EXPECT_LE((plastic.v - nearly.v).cwiseAbs().maxCoeff(), 1e-2) << scene;
    const Attained far = with(1e-2);
    const double scale = 1e-9 + (far.v - plastic.v).cwiseAbs().maxCoeff();
    EXPECT_LE((plastic.v - nearly.v).cwiseAbs().maxCoeff(), 0.2 * scale + 1e-7) << scene;
  }
  EXPECT_GE(compared, 10);
}

// The rebound of such a coefficient is smaller than the rounding of the velocities, or its square is no double.
TEST(HardMultiContactTest, ACoefficientBelowRoundingIsPlastic) {
  std::mt19937_64 random(22);
  int compared = 0;
  for (int scene = 0; scene < 60; ++scene) {
    Problem problem = RandomMultiContact(random, true);
    if (problem.k != 2 || PushApart(problem, MetricOf(problem)).size() == 0) continue;
    const auto with = [&](double e) {
      problem.laws[0].e = e;
      return FindSprings(problem, std::nullopt, kNever);
    };
    const Attained plastic = with(0.0);
    for (const double e : {1e-9, 1e-11, 1e-12, 1e-13, 1e-14, 1e-40, 1e-170, 1e-310}) {
      const Attained nearly = with(e);
      if (plastic.end == MultiContactEnd::kUndetermined) continue;
      EXPECT_EQ(nearly.end, plastic.end) << scene << " " << e;
      ++compared;
      for (int i = 0; i < 4; ++i) {
        const double error = plastic.ErrorOf(problem, i) + nearly.ErrorOf(problem, i);
        EXPECT_NEAR(nearly.v(i), plastic.v(i), error + 100.0 * e) << scene << " " << e;
      }
    }
  }
  EXPECT_GE(compared, 80);
}

// A plastic contact falls more than once here, between elastic ones.
TEST(HardMultiContactTest, APlasticContactBetweenElasticOnesIsTheLimitOfOneThatIsNearlyPlastic) {
  Eigen::MatrixXd j(6, 7);
  j << 3, -2, 1, -3, 2, 0, -3,   //
      -2, -2, -3, -1, 2, -1, 0,  //
      2, 0, -2, -2, -2, 0, 0,    //
      3, 2, 1, 0, 1, 2, 2,       //
      -1, -1, -1, 2, 0, -3, -2,  //
      -2, -1, -1, -1, 1, 1, -1;
  Eigen::VectorXd rates(7);
  rates << 3, -1, -2, 2, -2, -1, -1;
  Problem problem = {.d = 2, .k = 3, .w = j * j.transpose(), .v = j * rates};
  const auto with = [&](double e) {
    problem.laws = {{.mu = 0.5, .e = 1.0, .stiffness = 10.0}, {.mu = 0.3, .e = e}, {.mu = 2.0, .e = 1.0}};
    return FindSprings(problem, std::nullopt, kNever);
  };
  const Attained plastic = with(0.0);
  const Attained nearly = with(1e-6);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(plastic.v(i), nearly.v(i), plastic.ErrorOf(problem, i) + nearly.ErrorOf(problem, i) + 1e-5) << i;
    EXPECT_LE(plastic.ErrorOf(problem, i), 1e-2) << i;
  }
}

// In space friction and the joints lock this contact, of whose works nothing is known.
TEST(HardMultiContactTest, AContactThatLocksInSpaceHasAnAnswer) {
  const Mechanism mechanism = {
      .mass_matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .jacobian = {0, 2, -1, 0, 2, 2, 0, 2, 0}, .rates = {-2, -1, 1}};
  const LocalSolver solver;
  const auto response =
      solver.MultiContact({.scene = {.system = mechanism, .contacts = {{.friction = 1.0, .energetic = 0.5}}},
                           .methods = {MultiContactMethod::kOrders}});
  ASSERT_TRUE(response.ok()) << response.status();
  const AttainedOutcome& outcome = response->answers.front().orders.front();
  const auto one = solver.Solve(
      {.scene = {
           .system = mechanism, .friction = {.kinetic_coefficient = 1.0}, .restitution = EnergeticCoefficient{0.5}}});
  ASSERT_TRUE(one.ok()) << one.status();
  EXPECT_NEAR(outcome.contact_velocity_m_s[2], one->outcome.contact_velocity_after.normal_m_s, 1e-9);
  EXPECT_LT(outcome.contact_velocity_error_m_s[2], 1e-6);
  EXPECT_TRUE(std::isinf(outcome.work_error_j));
}

// Contacts 1 and 2 strike one after the other as their stiffnesses part, and chatter in between.
TEST(HardMultiContactTest, StiffnessRatiosFromAMillionthToAMillion) {
  for (int exponent = -6; exponent <= 6; ++exponent) {
    const MultiContactAnswer answer = AnswerTo({.scene = FallingBlock(0.3, 0.6, std::pow(10.0, exponent))});
    ASSERT_TRUE(answer.springs.has_value());
    const AttainedOutcome& springs = *answer.springs;
    EXPECT_EQ(springs.end, MultiContactEnd::kSeparated) << exponent;
    EXPECT_LE(springs.contact_velocity_error_m_s[1], 1e-9) << exponent;
    EXPECT_LE(springs.energy_change_j, springs.work_error_j) << exponent;
    if (std::abs(exponent) < 6) continue;
    // The stiff contact strikes first, and the soft one is not pressed again: the difference is of the order 1e-6.
    const std::string order = exponent > 0 ? "2" : "1";
    const auto same = std::find_if(answer.orders.begin(), answer.orders.end(),
                                   [&](const AttainedOutcome& one) { return one.orders.front().rfind(order, 0) == 0; });
    ASSERT_NE(same, answer.orders.end());
    EXPECT_NEAR(same->velocity[2], springs.velocity[2], 1e-4) << exponent;
  }
}

TEST(HardMultiContactTest, ACradleOfTenBallsEndsOnSprings) {
  const MultiContactScene scene =
      RowOfBalls(std::vector<double>(10, 1.0), {1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, std::vector<double>(9, 1.0));
  const MultiContactAnswer answer = AnswerTo({.scene = scene});
  ASSERT_TRUE(answer.springs.has_value());
  EXPECT_EQ(answer.springs->end, MultiContactEnd::kSeparated);
  EXPECT_NEAR(answer.springs->energy_change_j, 0.0, answer.springs->work_error_j);
  ASSERT_EQ(answer.refused.size(), 1U);
  EXPECT_EQ(answer.refused.front().method, MultiContactMethod::kOrders);
  EXPECT_EQ(answer.possible.size(), 18U + 30U);
}

// A state on the way says nothing of the outcome. Samples are named apart from the springs of the scene itself.
TEST(HardMultiContactTest, SamplesThatHaveNotEndedMakeNoJump) {
  const MultiContactScene cradle = RowOfBalls({1, 1, 1}, {1, 0, 0}, {1, 1});
  const MultiContactAnswer wide =
      AnswerTo({.scene = cradle, .stiffness_range = StiffnessRange{.contact = 2, .low = 1.0, .high = 1e12}});
  const auto unended =
      std::count_if(wide.stiffness_samples.begin(), wide.stiffness_samples.end(),
                    [](const StiffnessSample& sample) { return sample.outcome.end == MultiContactEnd::kBudgetUsedUp; });
  EXPECT_GT(unended, 0);
  EXPECT_TRUE(wide.stiffness_jumps.empty());
  const MultiContactAnswer narrow =
      AnswerTo({.scene = cradle, .stiffness_range = StiffnessRange{.contact = 1, .low = 0.01, .high = 1.0}});
  EXPECT_EQ(narrow.verdict, MultiContactVerdict::kOrdersAgreeSpringsDiffer);
  EXPECT_EQ(narrow.outcome_2.rfind("springs at the relative stiffness ", 0), 0U) << narrow.outcome_2;
}

// Feet on one floor share friction in any way. One after the other reaches its cone, and then all slip. The numbers are
// those of small steps (explicit, h -> 0), to some 1e-2, and of the same scene with one foot raised by 1e-9 m.
TEST(HardMultiContactTest, FeetThatReachTheirConesOneAfterTheOtherSlipAtLast) {
  struct Foot {
    double x, mu, e, stiffness;
  };
  struct Fall {
    double inertia, height, u, rate;
    std::vector<Foot> feet;
    std::array<double, 3> after;
  };
  const std::vector<Fall> falls = {
      {1.0 / 6.0, 0.5, 0.3, -0.3, {{-0.5, 0.3, 1, 2}, {0, 0.3, 1, 1}, {0.5, 0.3, 1, 0.5}}, {0.2314, 1.0154, -0.1831}},
      {0.5, 1.5, -1, 0, {{-0.9, 0.2, 1, 0.5}, {0.2, 0.2, 0.5, 0.25}, {1, 1, 1, 1}}, {-0.6143, 1.0615, -0.3941}}};
  for (const Fall& fall : falls) {
    MultiContactScene scene;
    FreeBodies bodies;
    bodies.bodies.push_back({.mass_kg = 1.0,
                             .inertia_com_kg_m2 = {fall.inertia},
                             .position_m = {0.0, fall.height},
                             .linear_m_s = {fall.u, -1.0},
                             .angular_rad_s = {fall.rate}});
    scene.system = std::move(bodies);
    for (const Foot& foot : fall.feet) {
      scene.contacts.push_back({.friction = foot.mu,
                                .energetic = foot.e,
                                .relative_stiffness = foot.stiffness,
                                .body = 1,
                                .point_m = {foot.x, 0.0},
                                .normal = {0.0, 1.0}});
    }
    const MultiContactAnswer answer = AnswerTo({.scene = scene, .methods = {MultiContactMethod::kSprings}});
    ASSERT_TRUE(answer.springs.has_value());
    EXPECT_EQ(answer.springs->end, MultiContactEnd::kSeparated);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(answer.springs->velocity[i], fall.after[i], 1e-4);
    EXPECT_FALSE(answer.springs->friction_split_is_unique);
  }
}

// Three feet on one floor: W has rank 2 in the normals, and the impulses of springs are still unique.
TEST(HardMultiContactTest, ThreeFeetShareTheLoadOfEqualSprings) {
  MultiContactScene scene = FallingBlock(0.5, 0.5);
  scene.contacts.push_back(scene.contacts.front());
  scene.contacts.back().point_m = {0.0, 0.0};
  const MultiContactAnswer answer = AnswerTo({.scene = scene});
  ASSERT_TRUE(answer.springs.has_value());
  const AttainedOutcome& springs = *answer.springs;
  for (const size_t n : {1U, 3U, 5U}) EXPECT_NEAR(springs.impulse_n_s[n], 0.5, 1e-14);
  EXPECT_FALSE(springs.friction_split_is_unique);
  EXPECT_NEAR(springs.velocity[2], 0.0, 1e-15);
}

// Feet that stop to slip together share friction as feet that never slip do, and not as if one of them slipped on.
TEST(HardMultiContactTest, FeetThatStopTogetherShareFrictionLikeThoseThatNeverSlip) {
  const auto springs_at = [](double slip) {
    MultiContactScene scene = FallingBlock(0.5, 0.5);
    std::get<FreeBodies>(scene.system).bodies.front().linear_m_s[0] = slip;
    return *AnswerTo({.scene = scene}).springs;
  };
  const AttainedOutcome still = springs_at(0.0);
  for (const double slip : {1e-9, 1e-6, 1e-3, 0.1}) {
    const AttainedOutcome moving = springs_at(slip);
    EXPECT_FALSE(moving.friction_split_is_unique) << slip;
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(moving.impulse_n_s[i], still.impulse_n_s[i], 2.0 * slip) << slip << i;
  }
}

// The second contact moves along the floor at first: v_n = 0, and it is pressed only by what the first does.
TEST(HardMultiContactTest, ASecondContactThatGrazes) {
  Problem problem = {.d = 2, .k = 2, .w = Eigen::MatrixXd::Zero(4, 4), .v = Vector::Zero(4)};
  problem.laws = {{.mu = 0.3, .e = 0.5}, {.mu = 0.3, .e = 0.5}};
  problem.w << 2.0, 0.25, 1.0, 0.25, 0.25, 1.5, -0.25, -0.5, 1.0, -0.25, 2.0, 0.25, 0.25, -0.5, 0.25, 1.5;
  problem.v << 0.5, -1.0, 0.5, 0.0;
  const Orders orders = FindOrders(problem, kNever);
  EXPECT_TRUE(orders.complete);
  const Attained springs = FindSprings(problem, std::nullopt, kNever);
  EXPECT_EQ(springs.end, MultiContactEnd::kSeparated);
  EXPECT_GT(springs.p(3), 0.0);
  for (int i = 0; i < 2; ++i) EXPECT_GE(springs.v(2 * i + 1), -springs.ErrorOf(problem, 2 * i + 1));
}

// Both slide all the way: with f = -0.3 tau each impulse changes (u, v) by W (0.2, 0.85) tau, and v ends at 0.5.
TEST(HardMultiContactTest, ContactsWhoseMassesDifferBy138PowersOfTen) {
  MultiContactScene scene;
  scene.system = ContactMatrix{.w_per_kg = {1e-138, 5e-139, 0, 0, 5e-139, 1e-138, 0, 0, 0, 0, 1, 0.5, 0, 0, 0.5, 1},
                               .velocity_m_s = {1, -1, 1, -1}};
  scene.contacts.assign(2, {.friction = 0.3, .energetic = 0.5});
  const MultiContactAnswer answer = AnswerTo({.scene = scene});
  EXPECT_EQ(answer.verdict, MultiContactVerdict::kSingle);
  ASSERT_EQ(answer.orders.size(), 1U);
  for (const AttainedOutcome* const outcome : {&answer.orders.front(), &*answer.springs}) {
    for (size_t i = 0; i < 4; i += 2) {
      EXPECT_NEAR(outcome->contact_velocity_m_s[i], 1.0 + 0.3 / 0.85, 1e-14);
      EXPECT_NEAR(outcome->contact_velocity_m_s[i + 1], 0.5, 1e-14);
    }
  }
  for (const PossibleRange& range : answer.possible) EXPECT_LE(range.lower, range.upper) << range.output;
}

// Balls of 1 kg in a row on the right of a wall, which all touch, with these speeds. The last contact is the wall's.
MultiContactScene BallsAtAWall(const std::vector<double>& speeds) {
  MultiContactScene scene;
  FreeBodies bodies;
  for (size_t i = 0; i < speeds.size(); ++i) {
    const auto x = static_cast<double>(i);
    const auto number = static_cast<int32_t>(i + 1);
    bodies.bodies.push_back(
        {.mass_kg = 1.0, .inertia_com_kg_m2 = {1.0}, .position_m = {x, 0.0}, .linear_m_s = {speeds[i], 0.0}});
    scene.contacts.push_back(
        {.energetic = 1.0, .body = number, .other_body = number - 1, .point_m = {x - 0.5, 0.0}, .normal = {1.0, 0.0}});
  }
  scene.system = bodies;
  return scene;
}

// Whatever comes first, elastic balls that are equal exchange their speeds until they are sorted.
TEST(HardMultiContactTest, ATreeThatTheBudgetHoldsIsFollowedToItsEnds) {
  const MultiContactAnswer answer =
      AnswerTo({.scene = BallsAtAWall({-1.0, -2.0, -3.0, -4.0}), .methods = {MultiContactMethod::kOrders}});
  EXPECT_EQ(answer.verdict, MultiContactVerdict::kOrdersAgree);
  ASSERT_EQ(answer.orders.size(), 1U);
  EXPECT_EQ(answer.orders.front().end, MultiContactEnd::kSeparated);
  for (size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(answer.orders.front().velocity[3 * i], 1.0 + static_cast<double>(i), 1e-12);
}

// True if some order ends with these velocities of balls, up to `most`.
bool HasEnd(const MultiContactAnswer& answer, const std::vector<double>& end, double most) {
  return std::any_of(answer.orders.begin(), answer.orders.end(), [&](const AttainedOutcome& outcome) {
    for (size_t i = 0; i < end.size(); ++i) {
      if (std::fabs(outcome.velocity[3 * i] - end[i]) > most) return false;
    }
    return true;
  });
}

// With one contact that is not elastic, the two orders below end apart.
TEST(HardMultiContactTest, OrdersThatWereNotFollowedDoNotAgree) {
  MultiContactScene scene = BallsAtAWall({2.0, -1.0, 1.0, -2.0, -2.0});
  scene.contacts[4].energetic = 0.5;
  const MultiContactAnswer answer = AnswerTo({.scene = scene});
  EXPECT_EQ(answer.verdict, MultiContactVerdict::kOrderMatters);
  for (const std::vector<double>& end :
       {std::vector<double>{0.6875, 1.0, 1.25, 1.671875, 1.890625}, std::vector<double>{1.0, 1.0, 1.0, 1.25, 1.75}}) {
    EXPECT_TRUE(HasEnd(answer, end, 1e-12)) << end[0];
  }
}

// The velocities of balls in a row after the impacts that an order such as "1-2-1" names.
std::vector<double> AfterOrder(const std::string& order, const std::vector<double>& masses,
                               const std::vector<double>& energetic, std::vector<double> v) {
  for (const absl::string_view contact : absl::StrSplit(order, '-')) {
    size_t i = 0;
    EXPECT_TRUE(absl::SimpleAtoi(contact, &i)) << order;
    --i;
    EXPECT_GT(v[i], v[i + 1]) << order;
    const double impulse = (1.0 + energetic[i]) * (v[i] - v[i + 1]) / (1.0 / masses[i] + 1.0 / masses[i + 1]);
    v[i] -= impulse / masses[i];
    v[i + 1] += impulse / masses[i + 1];
  }
  return v;
}

// Adds the velocities at the end of each sequence of at most `most` impacts of balls in a row.
void AddEnds(const std::vector<double>& masses, const std::vector<double>& energetic, const std::vector<double>& v,
             int64_t most, std::vector<std::vector<double>>& ends) {
  bool ended = true;
  for (size_t i = 0; i + 1 < v.size(); ++i) {
    if (!(v[i] > v[i + 1])) continue;
    ended = false;
    if (most > 0) AddEnds(masses, energetic, AfterOrder(absl::StrCat(i + 1), masses, energetic, v), most - 1, ends);
  }
  if (ended) ends.push_back(v);
}

// A tree that is followed whole, with more than 256 outcomes.
TEST(HardMultiContactTest, OfTooManyOutcomesThoseWithTheFewestImpactsAreListed) {
  const std::vector<double> masses = {1.5, 1.0, 1.0, 1.0, 2.0, 2.0}, velocities = {1.1, 2.0, 1.4, 0.7, -1.7, 0.1};
  const std::vector<double> energetic = {0.96, 0.7, 0.99, 0.82, 0.76};
  const MultiContactRequest request = {.scene = RowOfBalls(masses, velocities, energetic),
                                       .methods = {MultiContactMethod::kOrders}};
  const MultiContactAnswer answer = AnswerTo(request);
  ASSERT_EQ(answer.orders.size(), kMostOutcomes);
  ASSERT_EQ(answer.refused.size(), 1U);
  EXPECT_EQ(answer.refused[0].reason, "outcomes of orders beyond the 256 with the fewest impacts");
  int64_t most = 0;
  for (const AttainedOutcome& outcome : answer.orders) most = std::max(most, outcome.events);
  std::vector<std::vector<double>> ends;
  AddEnds(masses, energetic, velocities, most - 1, ends);
  EXPECT_GT(ends.size(), 100U);
  for (const std::vector<double>& end : ends) {
    EXPECT_TRUE(HasEnd(answer, end, 1e-9)) << testing::PrintToString(end);
  }
}

TEST(HardMultiContactTest, OfATreeBeyondTheBudgetManyOrdersAreFollowedToTheirEnds) {
  const std::vector<double> masses = {1.0, 2.0, 1.5, 3.0, 1.0, 2.5, 1.0}, velocities = {4, 2, 1, 0, -1, -2, -4};
  const std::vector<double> energetic = {0.9, 0.6, 0.6, 0.8, 0.5, 0.7};
  const MultiContactRequest request = {.scene = RowOfBalls(masses, velocities, energetic),
                                       .methods = {MultiContactMethod::kOrders}};
  const MultiContactAnswer answer = AnswerTo(request);
  ASSERT_EQ(answer.refused.size(), 1U);
  EXPECT_EQ(answer.refused[0].reason, "orders beyond those that 4096 impacts can follow to their ends");
  EXPECT_GT(answer.orders.size(), 50U);
  for (const AttainedOutcome& outcome : answer.orders) {
    EXPECT_EQ(outcome.end, MultiContactEnd::kSeparated);
    const std::vector<double> v = AfterOrder(outcome.orders[0], masses, energetic, velocities);
    for (size_t i = 0; i < v.size(); ++i) {
      EXPECT_NEAR(outcome.velocity[3 * i], v[i], 1e-12);
      if (i > 0) {
        EXPECT_GE(v[i], v[i - 1] - 1e-12);
      }
    }
  }
}

// A lever of 3e17 m leaves W the rank one, and the smallest doubles round the velocity of the contact out of its range.
TEST(HardMultiContactTest, AVelocityThatRoundingTakesOutOfTheRangeOfWIsRefused) {
  for (const auto& [speed, is_answered] : {std::pair(1.0, true), std::pair(1.5e-323, false)}) {
    MultiContactScene scene = {.contacts = {{.friction = 0.3,
                                             .energetic = 0.0,
                                             .body = 1,
                                             .point_m = {-2.8823037615171174e17, 0.0},
                                             .normal = {1.2223455849564906, 1.0}}}};
    scene.system = FreeBodies{.bodies = {{.mass_kg = 1.0,
                                          .inertia_com_kg_m2 = {5.0 / 12.0},
                                          .position_m = {0.0, 1.0048828125},
                                          .linear_m_s = {0.0, speed}}}};
    EXPECT_EQ(LocalSolver().MultiContact({.scene = scene}).ok(), is_answered) << speed;
  }
}

// A pendulum whose tip locks: k = 1 is the planar model, which says that it stays.
TEST(HardMultiContactTest, ALockedPendulumStays) {
  Problem locked = {.d = 2, .k = 1, .w = Eigen::MatrixXd(2, 2), .v = Vector(2), .laws = {{.mu = 1.0, .e = 1.0}}};
  locked.w << 1.0, 0.5, 0.5, 0.25;
  locked.v << -1.0, -0.5;
  const Orders orders = FindOrders(locked, kNever);
  EXPECT_EQ(orders.outcomes.front().attained.v, Vector::Zero(2));
  const Attained springs = FindSprings(locked, std::nullopt, kNever);
  EXPECT_EQ(springs.v, Vector::Zero(2));
  EXPECT_EQ(springs.end, MultiContactEnd::kWedged);
  // Beside a contact that it is not coupled to it takes the way through all events of springs.
  Problem beside = {.d = 2, .k = 2, .w = Eigen::MatrixXd::Identity(4, 4), .v = Vector::Ones(4)};
  beside.laws = {locked.laws.front(), locked.laws.front()};
  beside.w.topLeftCorner(2, 2) = locked.w;
  beside.v.head(2) = locked.v;
  EXPECT_EQ(FindSprings(beside, std::nullopt, kNever).end, MultiContactEnd::kWedged);
}

MultiContactScene PairOfContacts(double w, double coupling, double v) {
  return {.system = ContactMatrix{.w_per_kg = {w, 0, 0, 0, 0, w, 0, coupling, 0, 0, w, 0, 0, coupling, 0, w},
                                  .velocity_m_s = {0, -v, 0, -0.75 * v}},
          .contacts = {{.energetic = 0.5}, {.energetic = 0.5}}};
}

TEST(HardMultiContactTest, OnlyTheRatioOfStiffnessesMatters) {
  MultiContactScene scene = PairOfContacts(1.0, -0.5, 1.0);
  const std::vector<double> known = AnswerTo({.scene = scene}).springs->contact_velocity_m_s;
  for (const int power : {1022, 512, 2, -512, -1074}) {
    for (MultiContactPoint& contact : scene.contacts) contact.relative_stiffness = std::ldexp(1.0, power);
    EXPECT_EQ(AnswerTo({.scene = scene}).springs->contact_velocity_m_s, known) << power;
  }
}

// A unit of mass or of speed that is a power of two changes no digit, at the ends of the doubles, too.
TEST(HardMultiContactTest, TheUnitsChangeNoDigit) {
  const MultiContactAnswer known = AnswerTo({.scene = PairOfContacts(1.0, -0.5, 1.0)});
  for (const auto& [w, v] : std::vector<std::pair<int, int>>{{300, 520}, {-1000, -600}, {1023, 1}, {1023, 1000}}) {
    const double mass = std::ldexp(1.0, w), speed = std::ldexp(1.0, v);
    const MultiContactAnswer answer = AnswerTo({.scene = PairOfContacts(mass, -0.5 * mass, speed)});
    EXPECT_EQ(answer.verdict, known.verdict) << w << " " << v;
    EXPECT_EQ(answer.energy_before_j, std::ldexp(known.energy_before_j, 2 * v - w)) << w << " " << v;
    ASSERT_EQ(answer.orders.size(), known.orders.size()) << w << " " << v;
    for (size_t i = 0; i < answer.orders.size(); ++i) {
      const AttainedOutcome& here = answer.orders[i];
      const AttainedOutcome& there = known.orders[i];
      for (const size_t row : {1U, 3U}) {
        EXPECT_EQ(here.contact_velocity_m_s[row], std::ldexp(there.contact_velocity_m_s[row], v)) << w << " " << v;
      }
      EXPECT_EQ(here.energy_change_j, std::ldexp(there.energy_change_j, 2 * v - w)) << w << " " << v;
    }
  }
}

TEST(HardMultiContactTest, ANumberTooLargeForADoubleIsNamed) {
  const auto response =
      LocalSolver().MultiContact({.scene = PairOfContacts(1.0, -0.5, 1.0),
                                  .methods = {MultiContactMethod::kPossible},
                                  .outputs = {{.name = "body_sum", .coefficients = {1e308, 1e308, 1e308, 1e308}}}});
  EXPECT_EQ(response.status().code(), absl::StatusCode::kOutOfRange);
  EXPECT_THAT(std::string(response.status().message()), testing::HasSubstr("answers.possible"));
}

// The same contact beside another that is not coupled to it takes the way through all events of springs.
TEST(HardMultiContactTest, SpringsOfOneContactAreThePlanarModel) {
  std::mt19937_64 random(31);
  for (int scene = 0; scene < 200; ++scene) {
    const Problem several = RandomMultiContact(random, true);
    Problem one = {.d = 2, .k = 1, .w = several.w.topLeftCorner(2, 2), .v = several.v.head(2)};
    one.laws = {several.laws.front()};
    if (!(one.v(1) < 0.0) || PushApart(one, MetricOf(one)).size() == 0) continue;
    Problem beside = {.d = 2, .k = 2, .w = Eigen::MatrixXd::Identity(4, 4), .v = Vector::Ones(4)};
    beside.laws = {one.laws.front(), one.laws.front()};
    beside.w.topLeftCorner(2, 2) = one.w;
    beside.v.head(2) = one.v;
    const Attained planar = FindSprings(one, std::nullopt, kNever);
    const Attained springs = FindSprings(beside, std::nullopt, kNever);
    for (int j = 0; j < 2; ++j) {
      EXPECT_NEAR(springs.v(j), planar.v(j), springs.ErrorOf(beside, j) + planar.ErrorOf(one, j)) << scene;
    }
  }
}

}  // namespace
}  // namespace ricochet::multi
