// Tables of impacts for solve --data: they are read as those of audit --data are, with the same words.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "tests/client/cli/cli_run.h"
#include "tests/support/paths.h"

namespace ricochet::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CliSolveData : public CliTest {
 protected:
  CliResult Solve(const std::string& table, const Arguments& more = {}) const {
    Arguments all = {"solve", "--scene", TestDataPath("scenes/rod_contact.textproto"), "--data", "-"};
    all.insert(all.end(), more.begin(), more.end());
    return Run(all, table);
  }
  CliResult Audit(const std::string& table, const Arguments& more = {}) const {
    Arguments all = {"audit", "--scene", TestDataPath("scenes/rod_contact.textproto"), "--data", "-"};
    all.insert(all.end(), more.begin(), more.end());
    return Run(all, table);
  }
  // Friction of 2 holds this contact for ever.
  void WriteWedge() const {
    Write("wedge.textproto", R"(
      planar_contact { w_tt_per_kg: 1 w_tn_per_kg: 1 w_nn_per_kg: 1 tangential_m_s: 1 normal_m_s: -1 }
      friction { kinetic_coefficient: 2 }
      restitution { energetic: 0.5 })");
  }
};

// The text in the second of two cells, and the words that are said of it after the name of its column.
struct Cell {
  const char* text;
  const char* reason;
};

const Cell kCells[] = {
    {",", " is missing"},
    {",none", " = \"none\": must be a number such as 0.1 or 1e-3"},
    {",0;3", " = \"0;3\": must be a number such as 0.1 or 1e-3"},
    {",\"0,3\"", " = \"0,3\": must be a number with a decimal point, not a comma"},
    {",1e400", " = \"1e400\": must be 0, or a number of a size from 4.95e-324 to 1.7976931348623157e+308"},
    {",1e-400", " = \"1e-400\": must be 0, or a number of a size from"},
    {",1/0", " = \"1/0\": must have a denominator other than 0"},
    {",30deg", " = \"30deg\": must be a number without deg"},
};

TEST_F(CliSolveData, SaysOfEveryCellWhatAuditSays) {
  for (const Cell& cell : kCells) {
    const std::string rows = std::string("0.1,0.2\n\n# A comment.\n0.1") + cell.text + "\n";
    const CliResult solved = Solve("planar_contact.tangential_m_s,planar_contact.normal_m_s\n" + rows);
    const CliResult audited = Audit("tangential_after_m_s,normal_after_m_s\n" + rows);
    EXPECT_THAT(solved.out, HasSubstr(std::string("  row 1 (line 5): planar_contact.normal_m_s") + cell.reason));
    EXPECT_THAT(audited.out, HasSubstr(std::string("  row 1 (line 5): invalid: normal_after_m_s") + cell.reason));
  }
}

// A file that was cut off ends with a row of too few.
TEST_F(CliSolveData, ARowWithMoreOrFewerCellsIsRefusedAsAuditDoes) {
  for (const auto& [row, reason] :
       {std::pair("1,-1,5\n", "has 3 cells: must have 2; a number has a decimal point, not a comma\n"),
        {"1\n", "has 1 cell: must have 2; what is unknown has an empty cell\n"}}) {
    EXPECT_THAT(Solve(std::string("planar_contact.tangential_m_s,planar_contact.normal_m_s\n") + row).out,
                HasSubstr(std::string("  row 0 (line 2): ") + reason));
    EXPECT_THAT(Audit(std::string("tangential_after_m_s,normal_after_m_s\n") + row).out,
                HasSubstr(std::string("  row 0 (line 2): invalid: ") + reason));
  }
}

TEST_F(CliSolveData, BothRefuseTheSameHeaders) {
  for (const char* const table : {"", "a;b\n1;2\n"}) {
    const CliResult solved = Solve(table);
    EXPECT_EQ(solved.exit_code, 2);
    EXPECT_EQ(solved.err, Audit(table).err);
  }
  EXPECT_EQ(Solve("id\n1\n", {"--skip-column", "id"}).err, Audit("id\n1\n", {"--skip-column", "id"}).err);
  EXPECT_EQ(Solve("mu\n1\n", {"--skip-column", "mi"}).err, Audit("mu\n1\n", {"--skip-column", "mi"}).err);
}

TEST_F(CliSolveData, AnAngleBeyondAFullTurnIsNamedOnceUnlessItIsInDegrees) {
  Write("two.textproto",
        "linkage { links { length_m: 1 mass_kg: 1 com_m: 0.5 inertia_com_kg_m2: 0.1 theta_rad: 0.3 "
        "rate_rad_s: -1 } } restitution { energetic: 0.5 }");
  const auto said = [this](const std::string& cells) {
    return Run({"solve", "--scene", "two.textproto", "--data", "-"}, "theta_rad\n" + cells + "\n").err;
  };
  EXPECT_THAT(said("0.3\n-30\n40"), HasSubstr("the angle -30 lies beyond a full turn in radians; write -30deg if"));
  EXPECT_THAT(said("0.3\n-30\n40"), Not(HasSubstr("40")));
  EXPECT_THAT(said("0.3\n-30deg\n6.2\ninf"), Not(HasSubstr("full turn")));
}

TEST_F(CliSolveData, ARowThatBreaksARuleHasItsLine) {
  EXPECT_THAT(Solve("friction.kinetic_coefficient\n\n-0.1\n").out,
              HasSubstr("row 0 (line 3): friction.kinetic_coefficient = -0.1: must be >= 0"));
}

TEST_F(CliSolveData, TheSummaryInJsonHasTheSameReasons) {
  const CliResult result = Solve("mu,planar_contact.normal_m_s\n0.1,\n0.1,-1,5\n", {"--format", "json"});
  EXPECT_THAT(result.out, HasSubstr(R"("field":"planar_contact.normal_m_s","description":"is missing")"));
  EXPECT_THAT(result.out, HasSubstr(R"("field":"","description":"has 3 cells: must have 2)"));
}

TEST_F(CliSolveData, ShortNamesMeanTheFieldsOfTheScene) {
  const Arguments columns = {"--column", "normal_total_n_s,newton", "--format", "csv"};
  const CliResult full = Solve("friction.kinetic_coefficient,planar_contact.normal_m_s\n0.1,-1\n0.4,-2\n",
                               {"--column", "impulse.normal_total_n_s,coefficients.newton", "--format", "csv"});
  EXPECT_EQ(full.exit_code, 0) << full.err;
  EXPECT_EQ(Solve("mu,planar_contact.normal_m_s\n0.1,-1\n0.4,-2\n", columns).out, full.out);
  EXPECT_EQ(Solve("kinetic_coefficient,planar_contact.normal\n0.1,-1\n0.4,-2\n", columns).out, full.out);
  EXPECT_THAT(Solve("normal_m_s\n-1\n").err,
              HasSubstr("must name one of\n  planar_contact.normal_m_s\n  surface_velocity.normal_m_s"));
  EXPECT_THAT(Solve("kinetc_coefficient\n0.1\n").err, HasSubstr("did you mean friction.kinetic_coefficient?"));
  EXPECT_THAT(Solve("friction.kinetc_coefficient\n0.1\n").err, HasSubstr("did you mean friction.kinetic_coefficient?"));
  EXPECT_THAT(Solve("Mu\n0.1\n").err, HasSubstr("Mu: names nothing; did you mean mu?"));
  EXPECT_THAT(Solve("mu\n0.1\n", {"--column", "nweton"}).err, HasSubstr("did you mean coefficients.newton?"));
}

TEST_F(CliSolveData, AuditTakesTheLetterOfFriction) {
  EXPECT_EQ(Audit("normal_after_m_s,tangential_after_m_s,mu\n0.5,0,0.4\n").out,
            Audit("normal_after_m_s,tangential_after_m_s,friction\n0.5,0,0.4\n").out);
}

// 45 degrees are 0.785398... radians.
TEST_F(CliSolveData, AnglesMayBeInDegrees) {
  const std::string scene = TestDataPath("scenes/double_pendulum.textproto");
  const auto solve = [&](const std::string& angle) {
    return Run({"solve", "--scene", scene, "--data", "-", "--format", "csv"}, "links[0].theta\n" + angle + "\n").out;
  };
  EXPECT_EQ(solve("45deg"), solve("0.78539816339744830962"));
  EXPECT_NE(solve("45deg"), solve("45"));
}

TEST_F(CliSolveData, ASkippedColumnMayHoldAnything) {
  const CliResult all = Solve("id,mu\n\"a, b\",0.1\n7,0.2\n", {"--skip-column", "id", "--format", "csv"});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(all.out, Solve("mu\n0.1\n0.2\n", {"--format", "csv"}).out);
}

TEST_F(CliSolveData, ACellInQuotesMayHaveLineEnds) {
  const Arguments csv = {"--skip-column", "note", "--format", "csv"};
  const CliResult result = Solve("mu,note\n0.1,\"a\n0.5\nb\"\n0.2,c\n", csv);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, Solve("mu\n0.1\n0.2\n", {"--format", "csv"}).out);
  EXPECT_THAT(Solve("mu,note\n0.1,\"a\n0.5\nb\"\n-1,c\n", {"--skip-column", "note"}).out, HasSubstr("row 1 (line 5)"));
  const CliResult open = Solve("mu,note\n0.1,\"a\n0.2,c\n", {"--skip-column", "note"});
  EXPECT_EQ(open.exit_code, 2);
  EXPECT_THAT(open.err, HasSubstr("line 2 begins a cell in quotes that does not end, which has all lines after it"));
  EXPECT_THAT(Solve("\"mu\n0.1\n").err, HasSubstr("line 1 begins a cell in quotes that does not end"));
}

// pandas writes the index of a frame so.
TEST_F(CliSolveData, AColumnWithoutANameCanBeSkipped) {
  const CliResult result = Solve(",mu\n0,0.1\n1,0.2\n", {"--skip-column", "", "--format", "csv"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, Solve("mu\n0.1\n0.2\n", {"--format", "csv"}).out);
}

TEST_F(CliSolveData, AnUnknownColumnIsNamedByItsPlace) {
  EXPECT_THAT(Solve("mu,note,id\n0.1,1,2\n", {"--skip-column", "note"}).err,
              AllOf(HasSubstr("--data, column 3 = \"id\": must be a field that the scene states"),
                    HasSubstr("--skip-column leaves a column out")));
}

TEST_F(CliSolveData, AnInvalidRowOfAnAuditHasNoVerdicts) {
  const CliResult result = Audit("tangential_after_m_s,normal_after_m_s\nx,0.5\n", {"--format", "csv"});
  EXPECT_THAT(result.out, HasSubstr("\n0,nan,INVALID,nan,"));
  EXPECT_THAT(result.out, Not(HasSubstr("false")));
}

TEST_F(CliSolveData, StrictFailsAfterWritingEverything) {
  EXPECT_EQ(Solve("mu\n0.1\n", {"--strict"}).exit_code, 0);
  const CliResult result = Solve("mu\n0.1\n-1\nx\n", {"--strict"});
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("2 of 3 rows are invalid, inadmissible or have no end"));
  EXPECT_EQ(result.out, Solve("mu\n0.1\n-1\nx\n").out);
}

TEST_F(CliSolveData, StrictFailsIfALawHasNoSolution) {
  Write("law.textproto", R"(
    planar_contact { w_tt_per_kg: 2.5 w_tn_per_kg: -1.5 w_nn_per_kg: 1 tangential_m_s: 1 normal_m_s: -1 }
    brach { e: 0.5 mu_hat: 1 })");
  const CliResult one = Run({"solve", "--scene", "law.textproto", "--strict"});
  EXPECT_EQ(one.exit_code, 42);
  EXPECT_THAT(one.err, HasSubstr("FAILED_PRECONDITION: the impact law has no solution for this contact"));
  const CliResult rows = Run({"solve", "--scene", "law.textproto", "--data", "-", "--strict"}, "brach.mu_hat\n0\n1\n");
  EXPECT_EQ(rows.exit_code, 42);
  EXPECT_THAT(rows.err, HasSubstr("1 of 2 rows are invalid, inadmissible or have no end"));
}

TEST_F(CliSolveData, StrictFailsIfAnImpactHasNoEnd) {
  WriteWedge();
  const CliResult one = Run({"solve", "--scene", "wedge.textproto", "--strict"});
  EXPECT_EQ(one.exit_code, 42);
  EXPECT_THAT(one.err, HasSubstr("FAILED_PRECONDITION: the contact has no end that is known"));
  const CliResult rows = Run({"solve", "--scene", "wedge.textproto", "--data", "-", "--strict"}, "mu\n0.1\n2\n");
  EXPECT_EQ(rows.exit_code, 42);
  EXPECT_THAT(rows.out, HasSubstr("2 rows, 0 without numbers, 0 inadmissible, 1 without an end or a solution"));
  EXPECT_THAT(rows.err, HasSubstr("1 of 2 rows are invalid, inadmissible or have no end"));
}

TEST_F(CliSolveData, ARowLessAccurateThanAskedIsCounted) {
  const CliResult result =
      Run({"solve", "--scene", TestDataPath("scenes/turning_contact.textproto"), "--tolerance", "1e-17", "--data", "-"},
          "mu\n0.3\n");
  EXPECT_THAT(result.out, HasSubstr("0 without an end or a solution, 1 less accurate than asked"));
}

TEST_F(CliSolveData, AnAngleOutOfItsRangeIsNamed) {
  for (const char* const angle : {"7", "30", "0"}) {
    const Arguments pendulum = {"solve", "--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1", "--data", "-"};
    EXPECT_THAT(Run(pendulum, absl::StrCat("phi\n", angle, "\n")).out,
                HasSubstr(absl::StrCat("pendulum.phi_rad = ", angle, ": must be in (0, pi), in radians")));
  }
}

// A sweep says so whether it prints the regimes or not.
TEST_F(CliSolveData, ASweepCountsPointsThatAreNoSoundAnswer) {
  WriteWedge();
  const Arguments wedge = {"sweep", "--scene", "wedge.textproto", "--axis", "mu=0.1,2", "--column", "newton"};
  for (const char* const format : {"text", "csv", "json", "jsonl"}) {
    Arguments arguments = wedge;
    arguments.insert(arguments.end(), {"--format", format});
    const CliResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("1 point did not converge, at index 1: the impact has no end that is known"));
    arguments.push_back("--strict");
    const CliResult strict = Run(arguments);
    EXPECT_EQ(strict.exit_code, 42);
    EXPECT_THAT(strict.err, HasSubstr("of 2 points 0 are inadmissible, and 1 are invalid or have no end"));
  }
  const Arguments sharp = {"sweep",  "--a",          "0.3",      "--b",    "1",        "--newton", "0.9",
                           "--axis", "mu=0,0.1,0.2", "--column", "newton", "--format", "csv"};
  EXPECT_THAT(Run(sharp).err, HasSubstr("2 points are inadmissible, the first at index 1\n"));
}

}  // namespace
}  // namespace ricochet::cli
