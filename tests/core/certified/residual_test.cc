// Residuals of decimals whose digits are known.

#include "core/certified/residual.h"

#include <gtest/gtest.h>

#include <string>

namespace ricochet::certified {
namespace {

TEST(ResidualTest, TellsADecimalFromItsNearestDouble) {
  // The double nearest to 0.1 is 0.1000000000000000055511151231257827...
  EXPECT_EQ(Residual("0.1", 0.1), -5.551115123125783e-18);
  EXPECT_EQ(Residual("-0.1", -0.1), 5.551115123125783e-18);
  EXPECT_EQ(Residual("0.5", 0.5), 0.0);
}

TEST(ResidualTest, SeesTheLastOf300Digits) {
  const std::string most(299, '3');
  EXPECT_DOUBLE_EQ(Residual("0." + most + "4", "0." + most + "3"), 1e-300);
}

TEST(ResidualTest, ReadsEveryExponent) {
  EXPECT_DOUBLE_EQ(Residual("1.5e+300", "1.25e+300"), 0.25e300);
  EXPECT_DOUBLE_EQ(Residual("1.5e-300", "1.25e-300"), 0.25e-300);
}

}  // namespace
}  // namespace ricochet::certified
