// tests/data/multi_contact.json: every sequence of single impacts of 84 scenes, computed at 50 digits by an independent
// implementation.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/multi/orders.h"
#include "tests/support/scenes/multi_contact_vectors.h"

namespace ricochet::multi {
namespace {

// The largest distance of a component of the velocity from the expected one, over the error that it claims.
double ErrorOverClaim(const Problem& problem, const Attained& found, const std::vector<double>& expected) {
  double worst = 0.0;
  for (int j = 0; j < found.v.size(); ++j) {
    const double error = std::abs(found.v(j) - expected[static_cast<size_t>(j)]);
    worst = std::max(worst, error == 0.0 ? 0.0 : error / found.ErrorOf(problem, j));
  }
  return worst;
}

TEST(OrdersVectorsTest, EverySequenceEndsWithAnOutcomeThatIsFoundWithinItsError) {
  int sequences = 0;
  for (const auto& scene : ReadMultiContactVectors()) {
    if (!scene["orders"].contains("outcomes")) continue;  // The reference gave up.
    const Problem problem = ProblemOf(scene);
    const Orders orders = FindOrders(problem, [] { return false; });
    EXPECT_TRUE(orders.complete) << scene["id"];
    for (const auto& expected : scene["orders"]["outcomes"]) {
      const std::vector<double> v = NumbersOf(expected["v"]);
      double nearest = 1e300;
      for (const DistinctOutcome& outcome : orders.outcomes) {
        nearest = std::min(nearest, ErrorOverClaim(problem, outcome.attained, v));
      }
      EXPECT_LE(nearest, 1.0) << scene["id"] << ' ' << expected["order"];
      ++sequences;
    }
  }
  EXPECT_EQ(sequences, 344);
}

TEST(OrdersVectorsTest, ErrorsAreSmall) {
  for (const auto& scene : ReadMultiContactVectors()) {
    const Problem problem = ProblemOf(scene);
    for (const DistinctOutcome& outcome : FindOrders(problem, [] { return false; }).outcomes) {
      for (int j = 0; j < problem.v.size(); ++j) {
        EXPECT_LE(outcome.attained.ErrorOf(problem, j), problem.d == 2 ? 1e-12 : 1e-10) << scene["id"];
      }
    }
  }
}

TEST(OrdersVectorsTest, OutcomesOfTwoContactsHaveTheOrderImpulsesAndWorksOfTheReference) {
  for (const auto& scene : ReadMultiContactVectors()) {
    if (scene["k"] != 2 || scene["d"] != 2) continue;
    const Problem problem = ProblemOf(scene);
    const Orders orders = FindOrders(problem, [] { return false; });
    for (const auto& expected : scene["orders"]["outcomes"]) {
      if (expected["endless"]) continue;
      std::vector<int> order = expected["order"];
      for (int& contact : order) --contact;
      const auto found = std::find_if(orders.outcomes.begin(), orders.outcomes.end(), [&](const DistinctOutcome& one) {
        return std::find(one.orders.begin(), one.orders.end(), order) != one.orders.end();
      });
      ASSERT_NE(found, orders.outcomes.end()) << scene["id"] << ' ' << expected["order"];
      if (found->attained.order != order) continue;
      const Attained& attained = found->attained;
      const std::vector<double> p = NumbersOf(expected["p"]);
      for (int i = 0; i < 2; ++i) {
        const auto place = static_cast<size_t>(i);
        const std::vector<double> works = NumbersOf(expected["works"][place]);
        const double error = attained.ErrorOfNormalImpulse(problem, i);
        EXPECT_NEAR(attained.p(2 * i + 1), p[2 * place + 1], error) << scene["id"];
        EXPECT_NEAR(attained.works[place].compression, works[0], attained.work_error + 1e-30) << scene["id"];
        EXPECT_NEAR(attained.works[place].restitution, works[1], attained.work_error + 1e-30) << scene["id"];
        EXPECT_NEAR(attained.works[place].friction, works[2], attained.work_error + 1e-30) << scene["id"];
      }
    }
  }
}

}  // namespace
}  // namespace ricochet::multi
