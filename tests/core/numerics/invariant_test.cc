// CheckInvariant stops in every build.

#include "core/base/invariant.h"

#include <gtest/gtest.h>

namespace ricochet {
namespace {

TEST(InvariantDeathTest, ABrokenOneStopsWithItsMessageAndPlace) {
  CheckInvariant(true, "holds");
  EXPECT_DEATH(CheckInvariant(1 + 1 == 3, "two is not three"), "invariant_test.cc:[0-9]+: two is not three");
}

}  // namespace
}  // namespace ricochet
