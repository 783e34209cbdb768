// Numbers, times, axes and ranges are read as people type them, and progress is shown as people read it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "client/cli/input/axis_input.h"
#include "client/cli/report/solve_report.h"
#include "client/cli/terminal/progress.h"
#include "client/cli/text/label.h"
#include "client/cli/text/number_input.h"
#include "client/cli/text/table.h"

namespace ricochet::cli {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

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

TEST(ParseNumber, TakesDegreesForAnglesAlone) {
  const auto angle = [](const char* text) { return ParseNumber(text, "x", Spelling::kAngle).value(); };
  // The decimals are those of pi and its parts to 20 digits.
  EXPECT_EQ(angle("180deg"), 3.1415926535897932385);
  EXPECT_EQ(angle("45deg"), 0.78539816339744830962);
  EXPECT_EQ(angle("-30deg"), -0.52359877559829887308);
  EXPECT_EQ(angle("180/7deg"), 0.44879895051282760550);
  EXPECT_EQ(angle("0.5"), 0.5);
  for (const char* text : {"deg", "45 deg", "45degrees", "45degdeg", "1/0deg", "45rad"}) {
    EXPECT_FALSE(ParseNumber(text, "x", Spelling::kAngle).ok()) << text;
  }
  EXPECT_EQ(ParseNumber("45deg", "x").status().message(),
            "x = 45deg: must be a number without deg, because it is no angle");
}

TEST(ParseNumber, SaysThatANumberIsNoDoubleOrHasADecimalComma) {
  constexpr char kSize[] = "must be 0, or a number of a size from 4.95e-324 to 1.7976931348623157e+308";
  EXPECT_THAT(ParseNumber("1e400", "x").status().message(), HasSubstr(kSize));
  EXPECT_THAT(ParseNumber("-1e-400", "x").status().message(), HasSubstr(kSize));
  EXPECT_EQ(ParseNumber("5e-324", "x").value(), std::numeric_limits<double>::denorm_min());
  EXPECT_THAT(ParseNumber("0,7", "x").status().message(), HasSubstr("with a decimal point, not a comma"));
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

const Scene kPendulum = {.system = Pendulum()};

TEST(ParseAxis, TakesListsLinspacesAndLogspaces) {
  EXPECT_EQ(ParseAxis("friction.kinetic_coefficient=0.1,1/3", kPendulum).value(),
            (Axis{"friction.kinetic_coefficient", ListValues{{0.1, 1.0 / 3.0}}}));
  EXPECT_EQ(ParseAxis("pendulum.a_m=lin:0:1/2:1e3", kPendulum).value(),
            (Axis{"pendulum.a_m", Linspace{0.0, 0.5, 1000}}));
  EXPECT_EQ(ParseAxis("a=log:1e-3:1:4", kPendulum).value(), (Axis{"pendulum.a_m", Logspace{1e-3, 1.0, 4}}));
}

// The decimals are those of pi/4 and pi/3 to 20 digits.
TEST(ParseAxis, TakesDegreesWhereTheFieldIsAnAngle) {
  EXPECT_EQ(ParseAxis("phi=45deg,1", kPendulum).value(),
            (Axis{"pendulum.phi_rad", ListValues{{0.78539816339744830962, 1.0}}}));
  EXPECT_EQ(ParseAxis("phi=lin:45deg:60deg:15", kPendulum).value(),
            (Axis{"pendulum.phi_rad", Linspace{0.78539816339744830962, 1.0471975511965977462, 15}}));
  EXPECT_EQ(ParseFieldRange("phi=45deg:60deg", kPendulum).value(),
            (FieldRange{"pendulum.phi_rad", 0.78539816339744830962, 1.0471975511965977462}));
  // A rate is no angle, and neither is a length.
  for (const char* text : {"omega=45deg", "a=45deg", "mu=lin:0deg:1:3", "phi=lin:0:1:3deg"}) {
    EXPECT_FALSE(ParseAxis(text, kPendulum).ok()) << text;
  }
  EXPECT_FALSE(ParseFieldRange("a=1deg:2", kPendulum).ok());
}

TEST(ReadRange, MayLeaveEitherEndOpen) {
  const auto read = [](const char* text) {
    SweepRequest request;
    EXPECT_TRUE(ReadRange(text, request).ok()) << text;
    return std::pair(request.first_index, request.end_index);
  };
  EXPECT_EQ(read("3:8"), std::pair(int64_t{3}, std::optional<int64_t>(8)));
  EXPECT_EQ(read(":8").first, 0);
  EXPECT_EQ(read("3:").second, std::nullopt);
}

TEST(ParseFieldRange, TakesAPathAndTwoNumbers) {
  EXPECT_EQ(ParseFieldRange("pendulum.b_m=-1/2:1e-3", kPendulum).value(), (FieldRange{"pendulum.b_m", -0.5, 1e-3}));
  for (const char* text : {"", "pendulum.b_m", "=1:2", "pendulum.b_m=1", "pendulum.b_m=:1", "pendulum.b_m=1:2:3"}) {
    EXPECT_FALSE(ParseFieldRange(text, kPendulum).ok()) << text;
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

TEST(SolveText, ShowsTheNotesOfAnOutcomeBelowItsVerdict) {
  Outcome outcome = {.admissible = true};
  outcome.notes = {{.text = "The duration was left out."}, {.text = "An angle lies beyond a full turn."}};
  EXPECT_THAT(SolveText(outcome, false),
              HasSubstr("Admissible.\nNote: The duration was left out.\nNote: An angle lies beyond a full turn.\n\n"));
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
