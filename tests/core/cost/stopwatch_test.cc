// Times are those of one unit of work, and a stop ends them.

#include "core/cost/stopwatch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

namespace ricochet {
namespace {

bool Never() { return false; }

void Sleep(int64_t milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }

TEST(StopwatchTest, MeasuresTheTimeOfOneUnit) {
  const auto time = TimeOf([](int64_t units) { Sleep(2 * units); }, {.samples = 5, .budget_s = 10.0}, Never);
  ASSERT_TRUE(time.has_value());
  EXPECT_EQ(time->samples, 5);
  EXPECT_EQ(time->per_sample, 1);
  EXPECT_GE(time->lower_quartile_s, 2e-3);
  EXPECT_LE(time->lower_quartile_s, time->median_s);
  EXPECT_LE(time->median_s, time->upper_quartile_s);
}

TEST(StopwatchTest, RepeatsShortWorkUntilASampleIsLongEnough) {
  int64_t done = 0;
  const auto time = TimeOf(
      [&done](int64_t units) {
        for (int64_t i = 0; i < units; ++i) asm volatile("" : "+r"(done));
      },
      {.samples = 3, .budget_s = 10.0}, Never);
  ASSERT_TRUE(time.has_value());
  EXPECT_GE(time->per_sample, 100);  // A unit takes about a nanosecond, a sample at least 20 us.
}

TEST(StopwatchTest, TakesOneSampleEvenWithoutABudget) {
  const auto time = TimeOf([](int64_t) { Sleep(1); }, {.samples = 100, .budget_s = 0.0}, Never);
  ASSERT_TRUE(time.has_value());
  EXPECT_EQ(time->samples, 1);
}

TEST(StopwatchTest, GoesThroughAListAsAWholeInParts) {
  std::vector<int> times(10, 0);
  const auto time = TimeOfList(
      [&times](int64_t first, int64_t count) {
        for (int64_t i = first; i < first + count; ++i) ++times[static_cast<size_t>(i)];
        Sleep(1);
      },
      10, 4, {.samples = 2, .budget_s = 10.0}, Never);
  ASSERT_TRUE(time.has_value());
  EXPECT_EQ(times, std::vector<int>(10, 3));  // Two samples, after one that warms the caches.
  EXPECT_EQ(time->per_sample, 10);
  EXPECT_GE(time->median_s, 3e-4);  // Three parts of 1 ms for ten units.
}

TEST(StopwatchTest, AStopGivesNoTime) {
  int asked = 0;
  EXPECT_FALSE(TimeOf([](int64_t) { Sleep(1); }, {.samples = 9, .budget_s = 10.0}, [&] { return ++asked == 3; }));
  EXPECT_FALSE(TimeOfList([](int64_t, int64_t) {}, 10, 1, {.samples = 9, .budget_s = 10.0}, [] { return true; }));
}

}  // namespace
}  // namespace ricochet
