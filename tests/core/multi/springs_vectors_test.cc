// tests/data/multi_contact.json: the limit of stiff springs of 64 planar scenes, computed at 34 digits by an
// independent implementation.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/multi/springs.h"
#include "tests/support/scenes/multi_contact_vectors.h"

namespace ricochet::multi {
namespace {

TEST(SpringsVectorsTest, VelocitiesImpulsesAndWorksAreFoundWithinTheirErrors) {
  int scenes = 0;
  for (const auto& scene : ReadMultiContactVectors()) {
    if (!scene.contains("springs")) continue;
    SCOPED_TRACE(scene["id"].dump());
    ++scenes;
    const SortedProblem sorted = Sort(ProblemOf(scene));
    const Problem& problem = sorted.problem;
    const Attained found = FindSprings(problem, sorted.mirror, [] { return false; });
    EXPECT_EQ(found.end, MultiContactEnd::kSeparated);
    const std::vector<double> v = NumbersOf(scene["springs"]["v"]);
    const std::vector<double> p = NumbersOf(scene["springs"]["p"]);
    for (int i = 0; i < problem.k; ++i) {
      const auto place = static_cast<size_t>(i);
      const auto from = static_cast<size_t>(sorted.from[place]);
      EXPECT_NEAR(found.v(2 * i), sorted.sign[place] * v[2 * from], found.ErrorOf(problem, 2 * i));
      EXPECT_NEAR(found.v(2 * i + 1), v[2 * from + 1], found.ErrorOf(problem, 2 * i + 1));
      EXPECT_NEAR(found.p(2 * i + 1), p[2 * from + 1], found.ErrorOfNormalImpulse(problem, i) + 1e-30);
      const auto work = [&](const char* name) { return NumberOf(scene["springs"][name][from]); };
      EXPECT_NEAR(found.works[place].compression, work("work_compression"), found.work_error);
      EXPECT_NEAR(found.works[place].restitution, work("work_restitution"), found.work_error);
      if (scene["friction_split_unique"]) {
        EXPECT_NEAR(found.works[place].friction, work("work_tangential"), found.work_error);
      }
    }
  }
  EXPECT_EQ(scenes, 64);
}

TEST(SpringsVectorsTest, MostErrorsAreProvedAndSmall) {
  std::vector<double> errors;
  for (const auto& scene : ReadMultiContactVectors()) {
    if (!scene.contains("springs")) continue;
    const SortedProblem sorted = Sort(ProblemOf(scene));
    const Attained found = FindSprings(sorted.problem, sorted.mirror, [] { return false; });
    double error = 0.0;
    for (int j = 0; j < found.v.size(); ++j) error = std::max(error, found.ErrorOf(sorted.problem, j));
    EXPECT_LE(error, 1e-8) << scene["id"];
    if (found.error_is_proved) errors.push_back(error);
  }
  EXPECT_GE(errors.size(), 60U);
  std::nth_element(errors.begin(), errors.begin() + 30, errors.end());
  EXPECT_LE(errors[30], 2e-12);
}

}  // namespace
}  // namespace ricochet::multi
