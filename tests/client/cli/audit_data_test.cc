// Tables of observed impacts as laboratories have them: how cells are read, and what is said of rows that are wrong.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/client/cli/cli_run.h"
#include "tests/support/paths.h"

namespace ricochet::cli {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class CliAuditData : public CliTest {
 protected:
  CliResult Audit(const std::string& table, const Arguments& more = {}) const {
    Arguments all = {"audit", "--scene", TestDataPath("scenes/double_pendulum.textproto"), "--data", "-"};
    all.insert(all.end(), more.begin(), more.end());
    return Run(all, table);
  }
};

constexpr char kHeader[] = "tangential_after_m_s,normal_after_m_s,friction\n";

TEST_F(CliAuditData, AnInvalidRowHasItsReasonInEveryFormat) {
  const std::string table = std::string(kHeader) + "0,0.0386,0.7\n0,none,0.7\n\n0,0.03,-1\n0,,0.7\n";
  const CliResult text = Audit(table);
  EXPECT_THAT(text.out, HasSubstr("  row 1 (line 3): invalid: normal_after_m_s = \"none\": must be a number such as "
                                  "0.1 or 1e-3, or a fraction such as 1/3\n"));
  EXPECT_THAT(text.out, HasSubstr("  row 2 (line 5): invalid: friction = -1: must be >= 0\n"));
  EXPECT_THAT(text.out, HasSubstr("  row 3 (line 6): invalid: normal_after_m_s is missing\n"));
  const CliResult csv = Audit(table, {"--format", "csv"});
  EXPECT_THAT(csv.out, HasSubstr(",invalid_reason\n"));
  EXPECT_THAT(
      csv.out,
      HasSubstr(
          ",\"normal_after_m_s = \"\"none\"\": must be a number such as 0.1 or 1e-3, or a fraction such as 1/3\"\n"));
  const CliResult json = Audit(table, {"--format", "json"});
  EXPECT_THAT(json.out, HasSubstr(R"("invalid_reason":"friction = -1: must be >= 0")"));
}

TEST_F(CliAuditData, ACellThatIsNotFiniteIsNamed) {
  EXPECT_THAT(Audit(std::string(kHeader) + "0,nan,0.7\n").out, HasSubstr("normal_after_m_s = nan: must be finite\n"));
  EXPECT_THAT(Audit("rates_after_rad_s[0],rates_after_rad_s[1]\n0,inf\n").out,
              HasSubstr("rates_after_rad_s[1] = inf: must be finite\n"));
}

// Two spheres of radius R slide throughout, with e = 1/2: v' = -e v, u' = u - mu (1 + e) |v| and
// omega' = -mu (1 + e) |v| m R/I, in exact fractions. The third row lacks a number.
TEST_F(CliAuditData, ARowMayStateTheVelocitiesOfTheBodyBefore) {
  const std::string table =
      "velocity_t_m_s,velocity_n_m_s,"
      "bodies_after[0].linear_m_s[0],bodies_after[0].linear_m_s[1],bodies_after[0].angular_rad_s[0]\n"
      "3,-1,2.862,0.5,-137.99989324140748\n"
      "4,-2,3.724,1,-275.99978648281495\n"
      "4,,3.724,1,-276\n";
  const CliResult text = Run({"audit", "--scene", TestDataPath("scenes/sphere_20.textproto"), "--data", "-"}, table);
  EXPECT_THAT(text.out, HasSubstr("3 rows\n"));
  EXPECT_THAT(text.out, ContainsRegex("admissible +2\n"));
  EXPECT_THAT(text.out, HasSubstr("  row 2 (line 4): invalid: velocity_n_m_s is missing\n"));
}

TEST_F(CliAuditData, NamesOfColumnsMeanOneNumber) {
  const auto in_space = [this](const std::string& table) {
    return Run({"audit", "--scene", TestDataPath("scenes/spatial_body.json"), "--data", "-"}, table);
  };
  EXPECT_THAT(in_space("linear_m_s[0],normal_after_m_s\n1,1\n").err,
              HasSubstr("must name one of\n  bodies_after[0].linear_m_s[0]\n  spatial_body.linear_m_s[0]"));
  EXPECT_THAT(Audit("linkage.links[0].masss_kg,normal_after_m_s\n1,1\n").err,
              HasSubstr("did you mean linkage.links[0].mass_kg?"));
  EXPECT_THAT(Audit("normal,tangential_after_m_s,normal_after_m_s\n-1,0,1\n").err, HasSubstr("column \"normal\""));
  EXPECT_THAT(Audit("links[0].theta_rad,tangential_after_m_s,normal_after_m_s\n30deg,0,1\n").out, HasSubstr("1 row\n"));
  EXPECT_THAT(Audit("restitution.energetic,tangential_after_m_s,normal_after_m_s\n1,0,1\n").err,
              HasSubstr("column restitution.energetic = \"restitution.energetic\": must be another number"));
}

// "mu" is the kinetic coefficient of the scene here as everywhere, beside which the static one stays.
TEST_F(CliAuditData, MuIsTheKineticCoefficient) {
  const CliResult csv = Run({"audit", "--a", "0.3", "--b", "1", "--mu-static", "0.5", "--data", "-", "--format", "csv"},
                            "mu,rates_after_rad_s[0]\n0.1,0.5\n");
  const CliResult one = Run({"audit", "--a", "0.3", "--b", "1", "--mu", "0.1", "--mu-static", "0.5", "--observed-rate",
                             "0.5", "--format", "csv"});
  EXPECT_THAT(csv.out, HasSubstr(one.out.substr(one.out.find('\n') + 1, 40)));
}

TEST_F(CliAuditData, AnInputThatBreaksARuleOfTheSceneIsNamed) {
  EXPECT_THAT(Audit("linkage.links[0].mass_kg,tangential_after_m_s,normal_after_m_s\n-1,0,1\n").out,
              HasSubstr("  row 0 (line 2): invalid: linkage.links[0].mass_kg = -1: must be > 0\n"));
}

// The velocities of the system after the impact follow from those before it, which a contact velocity does not tell.
TEST_F(CliAuditData, RatesStandBesideNoVelocityOfTheContact) {
  for (const char* column : {"tangential_m_s", "normal_m_s", "tangential_after_m_s", "normal_after_m_s"}) {
    EXPECT_THAT(Audit(std::string("rates_after_rad_s[0],rates_after_rad_s[1],") + column + "\n0,1,-1\n").err,
                HasSubstr(std::string("column ") + column + " is set: must not be beside rates_after"));
  }
}

TEST_F(CliAuditData, TabsUtf16AndArraysAreNamed) {
  EXPECT_THAT(Audit(std::string("\x93NUMPY\x01", 7) + std::string(1, '\0') + "v\n\"\n").err,
              HasSubstr("is an array of NumPy: must be CSV with a header"));
  EXPECT_THAT(Audit("normal_after_m_s\tfriction\n0.1\t0\n").err, HasSubstr("separates its columns by tabs: must use"));
  EXPECT_THAT(Audit(std::string("\xFF\xFEn\0o\0", 6)).err, HasSubstr("is in UTF-16: must be in UTF-8"));
}

TEST_F(CliAuditData, ADecimalCommaIsNeverReadAsTwoCells) {
  const CliResult bare = Audit(std::string(kHeader) + "0,7,0,2,0,7\n");
  EXPECT_THAT(bare.out, HasSubstr("row 0 (line 2): invalid: has 6 cells: must have 3; a number has a decimal point"));
  const CliResult quoted = Audit(std::string(kHeader) + "\"0,7\",0.2,0.7\n");
  EXPECT_THAT(quoted.out,
              HasSubstr("tangential_after_m_s = \"0,7\": must be a number with a decimal point, not a comma"));
}

TEST_F(CliAuditData, ASkippedColumnMayHoldAnything) {
  const std::string with = "id," + std::string(kHeader) + "\"a, b\",0,0.0386,0.7\n\"7\"\"\",0,0.0386,0.7\n";
  const std::string without = std::string(kHeader) + "0,0.0386,0.7\n0,0.0386,0.7\n";
  EXPECT_EQ(Audit(with, {"--skip-column", "id"}).out, Audit(without).out);
  EXPECT_THAT(Audit("id\n1\n", {"--skip-column", "id"}).err, HasSubstr("has no column that is not left out"));
}

TEST_F(CliAuditData, ListsEveryRowThatIsNotAdmissible) {
  std::string table = kHeader;
  for (int i = 0; i < 12; ++i) table += "x,0.1,0.7\n";
  table += "0,0.0386,0.7\n-0.05,-0.01,0.7\n";
  const CliResult brief = Audit(table);
  EXPECT_THAT(brief.out, HasSubstr("row 7 (line 9)"));
  EXPECT_THAT(brief.out, Not(HasSubstr("row 8 (line 10)")));
  EXPECT_THAT(brief.out, HasSubstr("and 4 more invalid rows; --list names all"));
  const CliResult list = Audit(table, {"--list"});
  EXPECT_THAT(list.out, HasSubstr("row 11 (line 13): invalid"));
  EXPECT_THAT(list.out, Not(HasSubstr("row 12 ")));
  EXPECT_THAT(list.out, HasSubstr("row 13 (line 15): the surface pulls with an impulse of "));
}

TEST_F(CliAuditData, StrictFailsAfterWritingEverything) {
  const std::string good = std::string(kHeader) + "0,0.0386,0.7\n";
  EXPECT_EQ(Audit(good, {"--strict"}).exit_code, 0);
  const std::string bad = good + "0,0.2,0.7\n,0.1,0.7\n";
  const CliResult result = Audit(bad, {"--strict"});
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("2 of 3 rows are not admissible"));
  EXPECT_EQ(result.out, Audit(bad).out);
  const CliResult one = Run({"audit", "--a", "0.3", "--b", "1", "--mu", "0.1", "--observed-rate", "0.9", "--strict"});
  EXPECT_EQ(one.exit_code, 42);
  EXPECT_THAT(one.out, HasSubstr("Inadmissible"));
}

TEST_F(CliAuditData, OptionsOfATableNeedOne) {
  const CliResult result = Run({"audit", "--a", "0.3", "--mu", "0.1", "--observed-rate", "0.9", "--list"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--list and --skip-column need --data FILE.csv"));
}

}  // namespace
}  // namespace ricochet::cli
