// Numbers, times, axes and ranges are read as people type them, and progress is shown as people read it.

#include <gtest/gtest.h>

#include <chrono>

#include "client/cli/axis_input.h"
#include "client/cli/label.h"
#include "client/cli/number_input.h"
#include "client/cli/progress.h"
#include "client/cli/table.h"

namespace ricochet::cli {
namespace {

using std::chrono::milliseconds;

TEST(ParseNumber, TakesDecimalsAndFractions) {
  EXPECT_EQ(ParseNumber("0.1", "x").value(), 0.1);
  EXPECT_EQ(ParseNumber("+1e-3", "x").value(), 1e-3);
  EXPECT_EQ(ParseNumber("1/3", "x").value(), 1.0 / 3.0);
  EXPECT_EQ(ParseNumber("-2/0.5", "x").value(), -4.0);
}

TEST(ParseNumber, TakesNothingElse) {
  for (const char* text : {"", "/", "1/", "/2", "1 2", "0x10", "1,5", "pi", "1/2/3", "1e999"}) {
    EXPECT_EQ(ParseNumber(text, "x").status().code(), absl::StatusCode::kInvalidArgument) << text;
  }
}

TEST(ParseCount, TakesWholeNumbersInEitherForm) {
  EXPECT_EQ(ParseCount("1000000000", "x").value(), 1'000'000'000);
  EXPECT_EQ(ParseCount("1e9", "x").value(), 1'000'000'000);
  EXPECT_EQ(ParseCount("-1", "x").value(), -1);
  EXPECT_FALSE(ParseCount("1e17", "x").ok());
  EXPECT_FALSE(ParseCount("1/2", "x").ok());
}

TEST(ParseDuration, TakesUnits) {
  EXPECT_EQ(ParseDuration("250ms", "x").value(), milliseconds(250));
  EXPECT_EQ(ParseDuration("1.5", "x").value(), milliseconds(1500));
  EXPECT_EQ(ParseDuration("30s", "x").value(), milliseconds(30'000));
  EXPECT_EQ(ParseDuration("5m", "x").value(), milliseconds(300'000));
  EXPECT_EQ(ParseDuration("2h", "x").value(), milliseconds(7'200'000));
  for (const char* text : {"", "s", "-1s", "0.1ms", "1d", "9000h"}) EXPECT_FALSE(ParseDuration(text, "x").ok()) << text;
}

TEST(ParseAxis, TakesListsLinspacesAndLogspaces) {
  EXPECT_EQ(ParseAxis("friction.kinetic_coefficient=0.1,1/3").value(),
            (Axis{"friction.kinetic_coefficient", ListValues{{0.1, 1.0 / 3.0}}}));
  EXPECT_EQ(ParseAxis("pendulum.a_m=lin:0:1/2:1e3").value(), (Axis{"pendulum.a_m", Linspace{0.0, 0.5, 1000}}));
  EXPECT_EQ(ParseAxis("pendulum.a_m=log:1e-3:1:4").value(), (Axis{"pendulum.a_m", Logspace{1e-3, 1.0, 4}}));
}

TEST(ParseRange, MayLeaveEitherEndOpen) {
  EXPECT_EQ(ParseRange("3:8").value().first, 3);
  EXPECT_EQ(ParseRange("3:8").value().end, 8);
  EXPECT_EQ(ParseRange(":8").value().first, 0);
  EXPECT_EQ(ParseRange("3:").value().end, std::nullopt);
}

TEST(ParseFieldRange, TakesAPathAndTwoNumbers) {
  EXPECT_EQ(ParseFieldRange("pendulum.b_m=-1/2:1e-3").value(), (FieldRange{"pendulum.b_m", -0.5, 1e-3}));
  for (const char* text : {"", "pendulum.b_m", "=1:2", "pendulum.b_m=1", "pendulum.b_m=:1", "pendulum.b_m=1:2:3"}) {
    EXPECT_FALSE(ParseFieldRange(text).ok()) << text;
  }
}

TEST(ProgressLine, TellsPartRateAndTimeLeft) {
  EXPECT_EQ(ProgressLine(500, 1000, 2.0), "[####################                    ]  50 %   250 points/s   2 s left");
  EXPECT_EQ(ProgressLine(0, 0, 0.0), "[########################################] 100 %   0 points/s   0 s left");
  EXPECT_EQ(ProgressLine(500, 1000, 2.0, 45), "[#####      ]  50 %   250 points/s   2 s left");
}

TEST(ProgressLine, FitsEveryWidth) {
  for (size_t width = 0; width < 200; ++width) {
    for (const int64_t total : {1L, 1000L, 1'000'000'000'000L}) {
      EXPECT_LE(ProgressLine(total / 3, total, 7.0, width).size(), width);
    }
  }
}

TEST(Table, AlignsByCharactersNotBytes) {
  Table table;
  table.Add({"", "m²"});
  table.Add({"ω", "1234"});
  EXPECT_EQ(table.Render(1), "       m²\n ω   1234\n");
}

TEST(Rounded, ShowsSixDigitsAndNoNegativeZero) {
  EXPECT_EQ(Rounded(1.0 / 3.0), "0.333333");
  EXPECT_EQ(Rounded(-0.0), "0");
}

TEST(LabelOf, KnowsSymbolsAndUnits) {
  EXPECT_EQ(WithUnit(LabelOf("rates_after_rad_s[1]")), "angular velocity after, ω+[1] [rad/s]");
  EXPECT_EQ(WithUnit(LabelOf("pendulum.inertia_kg_m2")), "moment of inertia J [kg m²]");
  EXPECT_EQ(WithUnit(LabelOf("work.normal_total_j")), "work normal total [J]");
  EXPECT_EQ(WithUnit(LabelOf("friction.kinetic_coefficient")), "kinetic friction μ");
}

// A unit is not the end of a name: a stiffness is no length.
TEST(LabelOf, KnowsTheUnitsThatANameDoesNotEndIn) {
  EXPECT_EQ(LabelOf("compliance.linear.stiffness_n_m").unit, "N/m");
  EXPECT_EQ(LabelOf("compliance.hunt_crossley.damping_s_m").unit, "s/m");
  EXPECT_EQ(LabelOf("pin_moment.moment_n_m").unit, "N m");
  EXPECT_EQ(LabelOf("contact.peak_normal_n").unit, "N");
  EXPECT_EQ(LabelOf("contact.duration_s").unit, "s");
}

TEST(LabelOf, ShowsIndices) {
  EXPECT_EQ(WithUnit(LabelOf("linkage.links[1].theta_rad")), "linkage links[1] theta [rad]");
  EXPECT_EQ(WithUnit(LabelOf("bodies_after[0].linear_m_s[1]")), "bodies after[0] linear[1] [m/s]");
}

}  // namespace
}  // namespace ricochet::cli
