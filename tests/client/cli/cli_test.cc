// Tests of the command line: files, pictures, exit codes and signals.

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "ricochet/engine_info.h"
#include "ricochet/v1/impact_service.pb.h"
#include "tests/client/cli/cli_run.h"
#include "tests/support/paths.h"
#include "tests/support/processes/server_process.h"

namespace ricochet::cli {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr char kSolve[] = "\"$R\" solve --a 0.3 --b 1 --mu 0.1 --energetic 1";
constexpr char kSweep[] = "\"$R\" sweep --a 0.3 --b 1 --energetic 1 --axis friction.kinetic_coefficient=lin:0:0.4:";

std::string Solve(const std::string& options) { return std::string(kSolve) + " " + options; }
std::string Sweep(const std::string& points, const std::string& options) { return kSweep + points + " " + options; }

class Cli : public CliTest {};

// --- Input ---

TEST_F(Cli, ReadsASceneAsJsonOrTextprotoFromAFileOrStandardInput) {
  const std::string json = R"({"pendulum": {"inertiaKgM2": 1, "a_m": 0.3, "bM": 1, "omegaMinusRadS": -1},)"
                           R"( "friction": {"kineticCoefficient": 0.1}, "restitution": {"energetic": 1}})";
  const std::string text =
      "# The paper's pendulum.\npendulum { inertia_kg_m2: 1 a_m: 0.3 b_m: 1 omega_minus_rad_s: -1 }\n"
      "friction { kinetic_coefficient: 0.1 } restitution { energetic: 1 }";
  Write("scene.json", json);
  Write("scene.textproto", text);
  const std::string expected = RunShell(kSolve).out;
  EXPECT_THAT(expected, HasSubstr("0.707107"));
  EXPECT_EQ(Run({"solve", "--scene", "scene.json"}).out, expected);
  EXPECT_EQ(Run({"solve", "--scene", "scene.textproto"}).out, expected);
  EXPECT_EQ(Run({"solve", "--scene", "-"}, json).out, expected);
  EXPECT_EQ(Run({"solve", "--scene", "-"}, text).out, expected);
}

TEST_F(Cli, ReadsAWholeSweepRequest) {
  const CliResult result = Run({"sweep", "--request", "-", "--format", "csv"},
                               "scene { pendulum { inertia_kg_m2: 1 a_m: 1 omega_minus_rad_s: -1 } }\n"
                               "axes { path: 'restitution.newton' list { values: [0.25, 0.5] } }\n"
                               "columns: 'rates_after_rad_s[0]'");
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out, "index,restitution.newton,rates_after_rad_s[0]\n0,0.25,0.25\n1,0.5,0.5\n");
}

TEST_F(Cli, ReadsEveryNumberAsTheNearestDouble) {
  // These lie half-way between doubles, so that a longer format in between would round them the wrong way.
  const CliResult result = Run({"sweep", "--a", "1", "--newton", "0", "--axis",
                                "pendulum.b_m=0.1,1/3,9007199254740993,1.00000000000000011102230246251565404",
                                "--column", "coefficients.newton", "--format", "csv"});
  EXPECT_EQ(result.out,
            "index,pendulum.b_m,coefficients.newton\n0,0.1,0\n1,0.3333333333333333,0\n2,9007199254740992,0\n3,1,0\n");
}

TEST_F(Cli, ListsTheAxesAndColumnsThereAre) {
  EXPECT_THAT(Run({"sweep", "--axis", "?"}).out, HasSubstr("pendulum.phi_rad\n"));
  EXPECT_THAT(Run({"sweep", "--column", "?"}).out, HasSubstr("coefficients.newton\n"));
}

TEST_F(Cli, ListsTheAxesAndColumnsOfTheSceneGiven) {
  const std::string scene = TestDataPath("scenes/double_pendulum.textproto");
  EXPECT_THAT(Run({"sweep", "--scene", scene, "--axis", "?"}).out, HasSubstr("linkage.links[1].theta_rad\n"));
  EXPECT_THAT(Run({"sweep", "--scene", scene, "--column", "?"}).out, HasSubstr("rates_after_rad_s[1]\n"));
}

// The sphere's springs are computed in doubles, whose rounding is above 1e-16. Tolerance 0 asks for no error that it
// could miss.
TEST_F(Cli, SaysThatAToleranceWasMissed) {
  const std::string scene = TestDataPath("scenes/sphere_20.textproto");
  EXPECT_THAT(Run({"solve", "--scene", scene, "--tolerance", "1e-16"}).out,
              HasSubstr("above the tolerance of 1e-16\n"));
  EXPECT_THAT(Run({"solve", "--scene", scene, "--tolerance", "1e-9"}).out, Not(HasSubstr("above the tolerance")));
  EXPECT_THAT(Run({"solve", "--scene", scene, "--tolerance", "0"}).out, Not(HasSubstr("above the tolerance")));
}

TEST_F(Cli, ShowsBothDirectionsOfAnImpactInSpace) {
  const CliResult result = Run({"solve", "--scene", TestDataPath("scenes/spatial_body.json")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, testing::ContainsRegex("u1 .m/s. +u2 .m/s. +v .m/s."));
  EXPECT_THAT(result.out, HasSubstr("Bodies after"));
  EXPECT_THAT(result.out, HasSubstr("v1 [m/s]"));
}

TEST_F(Cli, RangesOfASystemThatHasNoEnclosureNameTheSystem) {
  const CliResult result = Run({"bounds", "--scene", TestDataPath("scenes/spatial_body.json"), "--range",
                                "friction.kinetic_coefficient=0.1:0.2"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err,
              HasSubstr("system has no enclosure: must be one of pendulum, planar_body, body_pair.planar, linkage, "
                        "planar_contact, mechanism in a plane, with ranges"));
}

TEST_F(Cli, TellsItsVersionAndEngine) {
  EXPECT_THAT(Run({"--version"}).out, testing::MatchesRegex("ricochet [0-9.]+, engine [0-9a-f]+\n"));
}

TEST_F(Cli, InfoSaysThatThisProgramTakesRequestsOfAnySize) {
  const CliResult text = Run({"info"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, StartsWith("engine    " + ThisEngine().version + ", fingerprint " + ThisEngine().fingerprint));
  EXPECT_THAT(text.out, HasSubstr("systems   pendulum, planar_body, "));
  EXPECT_THAT(text.out,
              HasSubstr("  max_links               unlimited  Links of a linkage, or coordinates of a mechanism\n"));
  EXPECT_THAT(text.out, Not(HasSubstr("Limits of the server")));
  EXPECT_THAT(Run({"info", "--format", "csv"}).out, HasSubstr("\nmax_axes,unlimited\n"));
}

TEST_F(Cli, InfoTellsTheLimitsOfAServer) {
  const ServerProcess server({"--max-links", "12", "--max-unary-time", "1.5"});
  const CliResult text = Run({"info", "--server", server.address()});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, testing::ContainsRegex("  max_links +12  Links of a linkage, or coordinates of a mechanism\n"));
  EXPECT_THAT(text.out, testing::ContainsRegex("  max_unary_time_ms +1500  The longest that a unary call may take\n"));
  const CliResult csv = Run({"info", "--server", server.address(), "--format", "csv"});
  EXPECT_THAT(csv.out, StartsWith("name,value\nversion,\"" + ThisEngine().version + "\"\n"));
  EXPECT_THAT(csv.out, HasSubstr("\nmax_links,12\n"));
  EXPECT_THAT(csv.out, HasSubstr("\nmax_unary_time_ms,1500\n"));
  v1::InfoResponse message;
  const CliResult json = Run({"info", "--server", server.address(), "--format", "json"});
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(json.out, &message).ok()) << json.out;
  EXPECT_EQ(message.limits().max_links(), 12);
  EXPECT_EQ(message.server_limits().max_unary_time_ms(), 1500);
  EXPECT_EQ(message.engine().fingerprint(), ThisEngine().fingerprint);
}

TEST_F(Cli, ShortNamesMeanTheFieldsAndColumnsThatEndInThem) {
  const Arguments sweep = {"sweep", "--a", "0.3", "--b", "1", "--energetic", "1", "--format", "csv"};
  const auto with = [&sweep](const Arguments& more) {
    Arguments all = sweep;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const CliResult full =
      Run(with({"--axis", "friction.kinetic_coefficient=0,0.1", "--axis", "pendulum.inertia_kg_m2=1,2", "--column",
                "coefficients.newton,energy_change_j,rates_after_rad_s[0]"}));
  const CliResult brief =
      Run(with({"--axis", "mu=0,0.1", "--axis", "inertia=1,2", "--column", "newton, energy_change,rates_after[0]"}));
  EXPECT_EQ(brief.exit_code, 0) << brief.err;
  EXPECT_EQ(brief.out, full.out);
  EXPECT_THAT(Run(with({"--axis", "mu=0,0.1", "--column", "coefficients.*"})).out,
              StartsWith("index,friction.kinetic_coefficient,coefficients.newton,coefficients.poisson,"
                         "coefficients.energetic,coefficients.tangential\n"));
  const Arguments bounds = {"bounds", "--a", "0.3", "--b", "1", "--range"};
  const auto over = [&bounds](const std::string& range) {
    Arguments all = bounds;
    all.push_back(range);
    return all;
  };
  EXPECT_EQ(Run(over("mu=0.1:0.2")).out, Run(over("friction.kinetic_coefficient=0.1:0.2")).out);
}

TEST_F(Cli, ASweepWithoutAnAxisSaysSo) {
  const CliResult result = Run({"sweep", "--a", "0.3", "--energetic", "1"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, StartsWith("The sweep is one point, because it has no --axis"));
}

TEST_F(Cli, HelpOfEachSubcommandHasAnExampleThatRuns) {
  for (const std::string subcommand : {"solve", "bounds", "sweep", "audit", "cost", "info"}) {
    const CliResult help = Run({subcommand, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    const size_t start = help.out.find("$ ricochet ");
    ASSERT_NE(start, std::string::npos) << subcommand;
    std::string example = help.out.substr(start + 2);
    size_t end = example.find('\n');
    while (end > 0 && example[end - 1] == '\\') end = example.find('\n', end + 1);
    const std::string command = example.substr(0, end);
    const CliResult result = RunShell("\"$R\"" + command.substr(std::string("ricochet").size()));
    EXPECT_EQ(result.exit_code, 0) << command << result.err;
    const std::string shown = example.substr(end + 3, example.find('\n', end + 1) - end - 3);
    EXPECT_THAT(result.out, HasSubstr(shown)) << command;
  }
}

// Commands of an example can be copied line by line, also where a long sentence stands before them.
TEST_F(Cli, EveryPromptOfHelpBeginsItsLine) {
  for (const std::string subcommand : {"solve", "bounds", "sweep", "merge", "plot", "audit", "fit", "multicontact",
                                       "conformance", "cost", "scene", "explore", "health", "info"}) {
    const CliResult help = Run({subcommand, "--help"});
    EXPECT_EQ(help.exit_code, 0) << subcommand;
    for (size_t at = help.out.find("  $ "); at != std::string::npos; at = help.out.find("  $ ", at + 1)) {
      EXPECT_EQ(help.out[at - 1], '\n') << subcommand;
    }
  }
}

// A terminal would obey it, and a server can send it.
TEST_F(Cli, NoErrorHasAControlCharacter) {
  const CliResult result = Run({"solve", "--scene", "\x1b[31m.json"});
  EXPECT_THAT(result.err, HasSubstr("[31m.json"));
  EXPECT_THAT(result.err, Not(HasSubstr("\x1b")));
}

TEST_F(Cli, HelpThatCannotBeWrittenIsNoSuccess) {
  EXPECT_EQ(RunShell("\"$R\" solve --help > /dev/full").exit_code, 75);
  EXPECT_EQ(RunShell("\"$R\" --version > /dev/full").exit_code, 75);
}

// --- Fits of tables ---

TEST_F(Cli, FitSaysWhatIsWrongWithItsTableAndItsOptions) {
  Write("hit.textproto",
        "planar_contact { w_tt_per_kg: 3 w_nn_per_kg: 1 normal_m_s: -1 } "
        "friction { kinetic_coefficient: 0.2 } restitution { poisson: 0.5 }");
  const std::string table = "planar_contact.tangential_m_s,contact_velocity_after.normal_m_s\n1,0.5\n2,0.51\n";
  const auto error = [&](const std::string& data, const Arguments& more) {
    Arguments words = {"fit", "--scene", "hit.textproto", "--data", "-"};
    words.insert(words.end(), more.begin(), more.end());
    const CliResult result = Run(words, data);
    EXPECT_EQ(result.exit_code, 2) << result.out;
    return result.err;
  };
  const std::string sigma = "contact_velocity_after.normal_m_s=0.01";
  EXPECT_THAT(error(table, {"--unknown", "poisson"}), HasSubstr("no sigma for contact_velocity_after.normal_m_s"));
  EXPECT_THAT(error(table, {"--unknown", "poison", "--sigma", sigma}), HasSubstr("did you mean restitution.poisson?"));
  EXPECT_THAT(error(table, {"--unknown", "poisson", "--sigma", sigma, "--bound", "mu=0:1"}), HasSubstr("--bound"));
  EXPECT_THAT(error(table, {"--unknown", "poisson", "--sigma", sigma, "--loss", "tukey"}), HasSubstr("be squares"));
  EXPECT_THAT(error(table, {"--unknown", "poisson", "--sigma", sigma, "--sigma", sigma}), HasSubstr("be given once"));
  EXPECT_THAT(error(table, {"--unknown", "mu", "--bound", "mu=0:1", "--bound", "kinetic_coefficient=0:0.5"}),
              HasSubstr("--bound friction.kinetic_coefficient: must be given once"));
  EXPECT_THAT(error("contact_velocity_after.normal_m_s,contact_velocity_after.normal_m_s.sigma\n0.5,0.01\n",
                    {"--unknown", "poisson", "--sigma", sigma}),
              HasSubstr("cannot be combined with a column contact_velocity_after.normal_m_s.sigma"));
  EXPECT_THAT(error("mu,kinetic_coefficient\n0.1,0.1\n", {"--unknown", "poisson"}),
              HasSubstr("--data, column kinetic_coefficient: must be given once"));
  EXPECT_THAT(error("contact_velocity_after.normal_m_s\n", {"--unknown", "poisson", "--sigma", sigma}),
              HasSubstr("--data has a header but no rows"));
  EXPECT_THAT(error("contact_velocity_after.normal_m_s,contact_velocity_after.normal_m_s.sigma\n0.5,1\n0.6,\n",
                    {"--unknown", "poisson"}),
              HasSubstr("--data, row 1: contact_velocity_after.normal_m_s.sigma is missing"));
  EXPECT_THAT(error(table, {"--unknown", "poisson", "--rows"}), HasSubstr("--rows needs --format csv"));
  EXPECT_THAT(error(table, {"--unknown", "mu", "--unknown", "poisson", "--region", "mu,poisson", "--format", "csv"}),
              HasSubstr("--region needs --format json or --plot FILE"));
  EXPECT_THAT(error(table, {"--unknown", "poisson", "--sigma", "contact_velocity_after.normal_m_s=0"}),
              HasSubstr("--sigma contact_velocity_after.normal_m_s = 0: must be > 0"));
  EXPECT_THAT(error("mass\n1\n", {"--unknown", "poisson"}), HasSubstr("--data has the column \"mass\""));
  EXPECT_THAT(error("planar_contact.tangential_m_s\n1\n", {"--unknown", "poisson"}), HasSubstr("measured is empty"));
  EXPECT_THAT(error(table + "x,0.5\n", {"--unknown", "poisson", "--sigma", sigma}),
              HasSubstr("line 4: planar_contact.tangential_m_s = \"x\": must"));
  EXPECT_THAT(error(table + ",0.5\n", {"--unknown", "poisson", "--sigma", sigma}), HasSubstr("is missing"));
}

TEST_F(Cli, FitSaysThatTheDataRefuseThePhysicsBesideCsvAsWell) {
  const CliResult result = Run({"fit", "--a", "0.3", "--b", "1", "--energetic", "1", "--data", "-", "--unknown",
                                "energetic", "--sigma", "rates_after_rad_s[0]=0.01", "--format", "csv"},
                               "rates_after_rad_s[0]\n0.5\n0.7\n");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("REFUSED: chi2 "));
  EXPECT_THAT(result.err, HasSubstr("The data refuse the physics"));
}

TEST_F(Cli, FitReadsSigmasOfRowsAndLeavesOutWhatWasNotMeasured) {
  Write("hit.textproto",
        "planar_contact { w_tt_per_kg: 3 w_nn_per_kg: 1 normal_m_s: -1 } "
        "friction { kinetic_coefficient: 0.2 } restitution { poisson: 0.5 }");
  const CliResult result =
      Run({"fit", "--scene", "hit.textproto", "--data", "-", "--unknown", "poisson", "--format", "csv", "--rows"},
          "contact_velocity_after.normal_m_s,contact_velocity_after.normal_m_s.sigma\n"
          "0.5,0.01\n,\n0.6,1\n");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("\n1,FRICTIONLESS,,\n"));
}

// --- Audits of tables ---

constexpr char kKane[] =
    "linkage { links { length_m: 1 mass_kg: 1 com_m: 0.5 inertia_com_kg_m2: 0.0833333333333333 "
    "theta_rad: 0.349 rate_rad_s: -0.1 } links { length_m: 1 mass_kg: 1 com_m: 0.5 "
    "inertia_com_kg_m2: 0.0833333333333333 theta_rad: 0.524 rate_rad_s: -0.2 } } "
    "friction { kinetic_coefficient: 0.7 }";

TEST_F(Cli, SaysWhichExcludedEffectAPointOfASweepNeeds) {
  const CliResult result = Run({"sweep", "--a", "1", "--b", "1", "--energetic", "0.5", "--exclude", "higher-order",
                                "--axis", "friction.kinetic_coefficient=0.25,0.75", "--format", "csv", "--regime"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("INVALID: excluded[0] = higher_order: must be left in: the first-order form needs"));
  EXPECT_THAT(result.err, HasSubstr("excluded[0]: must be left in: the first-order form needs mu |b|/a <= 0.5"));
}

TEST_F(Cli, ShowsTheRateBeforeAnImpactThatTakesTime) {
  Write("spring.json", R"({"pendulum":{"inertia_kg_m2":1,"a_m":0.6,"b_m":0.3,"omega_minus_rad_s":-2},)"
                       R"("restitution":{"energetic":0.8},"compliance":{"linear":{"stiffness_n_m":1e6}}})");
  const CliResult result = Run({"solve", "--scene", "spring.json", "--require", "finite-duration"});
  EXPECT_THAT(result.out, testing::ContainsRegex("angular velocity .rad/s. +-2 +1.6\n"));
}

TEST_F(Cli, AuditsEveryRowOfATableAndFlagsTheBadOnes) {
  Write("kane.textproto", kKane);
  const CliResult result =
      RunShell("\"$R\" audit --scene kane.textproto --data - --skip-column id --format csv 2> summary",
               "# seen\nid,normal_after_m_s,tangential_after_m_s\r\n"
               "a,0.02,-0.1\r\nb,none,-0.1\n\nc,0.5\nd,5e-1,1\n");
  EXPECT_EQ(result.exit_code, 0) << Read("summary");
  EXPECT_THAT(result.out, StartsWith("index,admissible,regime,unexplained,distance_m_s,coefficients.newton,"));
  EXPECT_THAT(result.out, HasSubstr("\n1,nan,INVALID,nan,nan,nan,"));
  EXPECT_THAT(result.out, HasSubstr("\n2,nan,INVALID,nan,nan,nan,"));
  EXPECT_THAT(result.out, testing::ContainsRegex("\n3,false,[A-Z_]+,false,0,"));
  EXPECT_THAT(Read("summary"), StartsWith("4 rows\n"));
  EXPECT_THAT(Read("summary"), testing::ContainsRegex("invalid +2 +1\n"));
}

TEST_F(Cli, AuditsATableOfMoreRowsThanOneCallTakes) {
  Write("kane.textproto", kKane);
  std::string table = "tangential_after_m_s,normal_after_m_s\n";
  for (int i = 0; i < 10'000; ++i) table += i == 9'000 ? "x,1\n" : "0.1,0.02\n";
  const CliResult result = Run({"audit", "--scene", "kane.textproto", "--data", "-"}, table);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("10000 rows\n"));
  EXPECT_THAT(result.out, testing::ContainsRegex("invalid +1 +9000\n"));
}

TEST_F(Cli, AuditsATableOfRatesAsItAuditsEachRow) {
  Write("kane.textproto", kKane);
  const CliResult table = Run({"audit", "--scene", "kane.textproto", "--data", "-", "--format", "csv"},
                              "rates_after_rad_s[1],rates_after_rad_s[0]\n0.25,-0.5\n0.5,-0.25\n");
  EXPECT_EQ(table.exit_code, 0) << table.err;
  const CliResult one = Run({"audit", "--scene", "kane.textproto", "--observed-rate=-0.25,0.5", "--format", "csv"});
  const size_t start = one.out.find('\n') + 1;
  // A row of a table ends in the reason for which it is invalid; this one has none.
  EXPECT_THAT(table.out, HasSubstr("\n1," + one.out.substr(start, one.out.size() - 1 - start) + ",\n"));
}

TEST_F(Cli, AnswersATableOfManyCallsAsJsonOfOneResponse) {
  Write("kane.textproto", kKane);
  std::string table = "tangential_after_m_s,normal_after_m_s\n";
  for (int i = 0; i < 8'193; ++i) table += i == 8'192 ? "x,1\n" : "0.1,0.02\n";
  const CliResult result = Run({"audit", "--scene", "kane.textproto", "--data", "-", "--format", "json"}, table);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  v1::AuditBatchResponse response;
  google::protobuf::util::JsonParseOptions options;
  options.ignore_unknown_fields = true;  // The reason of an invalid row.
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(result.out, &response, options).ok());
  EXPECT_THAT(result.out, HasSubstr(R"("invalid_reason":"tangential_after_m_s = \"x\": must be a number such as)"));
  ASSERT_EQ(response.reports_size(), 8'193);
  EXPECT_EQ(response.reports(8'192).regime(), v1::REGIME_INVALID);
  EXPECT_EQ(response.summary().rows(), 8'193);
  EXPECT_EQ(response.summary().invalid().count(), 1);
  EXPECT_EQ(response.summary().invalid().first_index(), 8'192);
  EXPECT_FALSE(response.engine().version().empty());
}

TEST_F(Cli, AuditsATableAsSpreadsheetsSaveIt) {
  Write("kane.textproto", kKane);
  const Arguments audit = {"audit", "--scene", "kane.textproto", "--data", "-", "--format", "csv"};
  const CliResult plain = Run(audit, "tangential_after_m_s,normal_after_m_s\n0.7,0.2\n");
  const CliResult saved = Run(audit, "\xEF\xBB\xBF\"tangential_after_m_s\",normal_after_m_s\r\n\"0.7\", \"0.2\"\r\n");
  EXPECT_EQ(saved.exit_code, 0) << saved.err;
  EXPECT_EQ(saved.out, plain.out);
}

TEST_F(Cli, RefusesATableWithoutAKnownHeaderAndAnAuditOfNothing) {
  Write("kane.textproto", kKane);
  const Arguments audit = {"audit", "--scene", "kane.textproto"};
  const auto with = [&audit](const Arguments& more) {
    Arguments all = audit;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  EXPECT_EQ(Run(audit).exit_code, 2);
  EXPECT_THAT(Run(audit).err, HasSubstr("no observation"));
  EXPECT_THAT(Run(with({"--data", "-"}), "1,2\n").err,
              HasSubstr("has the column \"1\": must be one of tangential_m_s"));
  EXPECT_THAT(Run(with({"--data", "-"}), "normal_after_m_s,velocity_uncertainty\n").err,
              HasSubstr("has the column \"velocity_uncertainty\": must be one of"));
  EXPECT_THAT(Run(with({"--data", "-"}), "normal_after_m_s,frictoin\n").err, HasSubstr("did you mean friction?"));
  EXPECT_THAT(Run(with({"--data", "-", "--skip-column", "idd"}), "id,friction\n").err,
              HasSubstr("--skip-column = idd: must be a column of standard input; did you mean id?"));
  EXPECT_THAT(Run(with({"--data", "-"}), "friction;normal_after_m_s\n0,3;1,0\n").err,
              HasSubstr("separates its columns by semicolons: must use commas"));
  EXPECT_THAT(Run(with({"--data", "-"}), "").err, HasSubstr("has no header"));
  EXPECT_THAT(Run(with({"--data", "-"}), "friction,friction\n").err, HasSubstr("friction twice"));
  EXPECT_THAT(Run(with({"--data", "-"}), "rates_after_rad_s[0],rates_after_rad_s[0]\n").err, HasSubstr("twice"));
  EXPECT_THAT(Run(with({"--data", "-"}), "rates_after_rad_s[1],rates_after_rad_s[2]\n").err,
              HasSubstr("has the column \"rates_after_rad_s[2]\": must be one of"));
  EXPECT_THAT(Run(with({"--data", "-"}), "rates_after_rad_s[0]\n1\n").err,
              HasSubstr("has some velocities of the system after the impact but not rates_after_rad_s[1]: must have"));
  EXPECT_THAT(Run(with({"--data", "-"}), "normal_after_m_s\n1\n").err,
              HasSubstr("column tangential_after_m_s is not set"));
  EXPECT_THAT(Run(with({"--observed-rate", "1"})).err, HasSubstr("rates.values has 1 entry: must have 2"));
  EXPECT_THAT(Run(with({"--observed-velocity", "1,x"})).err, HasSubstr("--observed-velocity = x"));
}

// --- Files ---

TEST_F(Cli, WritesAFileWholeAndNothingBesideIt) {
  const CliResult result = RunShell(Solve("--format csv -o result.csv"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(Read("result.csv"), RunShell(Solve("--format csv")).out);
  EXPECT_THAT(Files(), ElementsAre("result.csv"));
}

TEST_F(Cli, AFileHasTheUsualModeAndALinkStaysOne) {
  const CliResult result = RunShell("umask 027; echo old > target; ln -s target link.txt\n" + Solve("-o link.txt") +
                                    "\nstat -c '%A' target; ls");
  EXPECT_EQ(result.out, "-rw-r-----\nlink.txt\ntarget\n");
  EXPECT_THAT(Read("target"), HasSubstr("Rebound"));
}

TEST_F(Cli, WritesToADeviceInPlace) {
  EXPECT_THAT(RunShell(Solve("-o /dev/stdout") + " | cat").out, HasSubstr("Rebound"));
  EXPECT_EQ(RunShell(Solve("-o /dev/null") + " && test -c /dev/null").exit_code, 0);
}

TEST_F(Cli, AFailureHalfWayLeavesTheOldFileAndNothingElse) {
  Write("result.csv", "old\n");
  const CliResult result = RunShell("ulimit -f 10\n" + Sweep("100000", "--format csv -o result.csv"));
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("cannot write the output"));
  EXPECT_EQ(Read("result.csv"), "old\n");
  EXPECT_THAT(Files(), ElementsAre("result.csv"));
}

TEST_F(Cli, ABadRequestLeavesTheOldFileAndNothingElse) {
  Write("result.csv", "old\n");
  EXPECT_EQ(RunShell(Sweep("0", "-o result.csv")).exit_code, 2);
  EXPECT_EQ(Read("result.csv"), "old\n");
  EXPECT_THAT(Files(), ElementsAre("result.csv"));
}

TEST_F(Cli, ATableForPeopleIsWholeInAFileOrRefused) {
  EXPECT_EQ(RunShell(Sweep("100000", "-o t.txt")).exit_code, 0);
  EXPECT_THAT(Read("t.txt"), HasSubstr("\n99999 "));
  EXPECT_THAT(RunShell(Sweep("100000", "")).out, HasSubstr("... and 99960 more points; --format csv has them all\n"));
  const CliResult longer = RunShell(Sweep("100001", "-o longer.txt"));
  EXPECT_EQ(longer.exit_code, 2);
  EXPECT_THAT(longer.err, HasSubstr("a table for people of 100001 rows: must have at most 100000, or be csv"));
  EXPECT_THAT(Files(), ElementsAre("t.txt"));
}

TEST_F(Cli, AFileDoesNotDependOnTheWidthOfTheTerminal) {
  EXPECT_EQ(RunShell("COLUMNS=30 " + Solve("-o narrow.txt") + " && " + Solve("-o wide.txt")).exit_code, 0);
  EXPECT_EQ(Read("narrow.txt"), Read("wide.txt"));
}

TEST_F(Cli, AnUnwritableFileIsAnError) {
  const CliResult result = RunShell(Solve("-o no/such/directory/result.txt"));
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("cannot write no/such/directory/result.txt"));
  EXPECT_EQ(RunShell("mkdir folder.txt\n" + Solve("-o folder.txt")).exit_code, 42);
}

TEST_F(Cli, EndsQuietlyWhenItsReaderHasEnough) {
  const CliResult result = RunShell("{ " + Sweep("1e12", "--format csv") + "; echo $? > code; } | head -n 2");
  EXPECT_THAT(result.out, StartsWith("index,friction.kinetic_coefficient,"));
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(Read("code"), "0\n");
}

// --- Pictures ---

TEST_F(Cli, DrawsFigure4) {
  const CliResult result = Run({"sweep", "--a", "0.6", "--b", "0.8", "--energetic", "1", "--axis",
                                "friction.kinetic_coefficient=0.1,1/3,0.5,2/3,1", "--axis",
                                "pendulum.phi_rad=lin:0.01:1.5707963267948966:400", "--column", "coefficients.newton",
                                "--plot", "fig4.svg"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const std::string svg = Read("fig4.svg");
  EXPECT_THAT(svg, StartsWith("<?xml"));
  EXPECT_THAT(svg, EndsWith("</svg>\n\n"));
  EXPECT_THAT(svg, HasSubstr("angle φ = arctan(a/b) [rad]"));
  EXPECT_THAT(svg, HasSubstr("Newton's coefficient of restitution"));
  for (const std::string curve : {"μ = 0.1", "μ = 0.333333", "μ = 0.5", "μ = 0.666667", "μ = 1"}) {
    EXPECT_THAT(svg, HasSubstr(curve));
  }
  EXPECT_THAT(Files(), ElementsAre("fig4.svg"));
}

TEST_F(Cli, DrawsFigures3And5) {
  EXPECT_EQ(RunShell(Solve("--plot impact.svg")).exit_code, 0);
  const std::string svg = Read("impact.svg");
  for (const std::string label : {"ω [rad/s]", "F/N", "f [N s]", "normal impulse τ [N s]"}) {
    EXPECT_THAT(svg, HasSubstr(label));
  }
}

TEST_F(Cli, DrawsPng) {
  EXPECT_EQ(RunShell(Solve("--plot impact.png")).exit_code, 0);
  EXPECT_THAT(Read("impact.png"), StartsWith("\x89PNG"));
}

TEST_F(Cli, SaysThatGnuplotIsMissing) {
  const CliResult result = RunShell("PATH=/nonexistent\n" + Solve("--plot impact.svg -o result.txt"));
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("the numbers are complete, but impact.svg was not drawn: pictures need gnuplot, "
                                    "which is not installed"));
  EXPECT_THAT(Files(), ElementsAre("result.txt"));
  EXPECT_EQ(Read("result.txt"), RunShell(Solve("")).out);
}

TEST_F(Cli, ARefusedPictureLeavesTheNumbers) {
  const CliResult long_sweep = RunShell(Sweep("1000001", "--plot p.svg --summary-only -o r.txt"));
  EXPECT_EQ(long_sweep.exit_code, 42);
  EXPECT_THAT(long_sweep.err, HasSubstr("more than a picture can show"));
  EXPECT_THAT(Read("r.txt"), HasSubstr("1000001 points"));
  EXPECT_EQ(RunShell(Sweep("100", "--axis pendulum.b_m=1 --plot p.svg --format csv -o r.csv")).exit_code, 42);
  EXPECT_THAT(RunShell(Sweep("100", "--axis pendulum.b_m=1 --plot p.svg")).err, HasSubstr("more than 49 curves"));
  EXPECT_THAT(Run({"sweep", "--a", "1", "--newton", "1", "--plot", "p.svg"}).err, HasSubstr("without an axis"));
  const CliResult separating = Run({"solve", "--a", "1", "--omega", "1", "--newton", "1", "--plot", "p.svg"});
  EXPECT_EQ(separating.exit_code, 42);
  EXPECT_THAT(separating.err, HasSubstr("nothing to draw"));
  EXPECT_THAT(separating.out, HasSubstr("Separating"));
  EXPECT_THAT(Files(), ElementsAre("r.csv", "r.txt"));
}

// --- Exit codes ---

TEST_F(Cli, AnInadmissibleOutcomeFailsOnlyUnderStrict) {
  const Arguments inadmissible = {"solve", "--a", "0.3", "--b", "1", "--mu", "0.1", "--newton", "0.9"};
  EXPECT_EQ(Run(inadmissible).exit_code, 0);
  Arguments strict = inadmissible;
  strict.push_back("--strict");
  const CliResult result = Run(strict);
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("the outcome is inadmissible: its energetic coefficient 1.27"));
}

TEST_F(Cli, AResultAboveTheLargestDoubleFails) {
  const CliResult result = Run({"solve", "--a", "1", "--inertia", "1e308", "--omega", "-1e10", "--newton", "1"});
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("OUT_OF_RANGE"));
}

TEST_F(Cli, AnAbsentServerMeansTryAgain) {
  const std::string absent = "--server 127.0.0.1:1 --deadline 2s";
  for (const std::string& command : {Solve(absent), Sweep("3", absent), "\"$R\" health " + absent}) {
    const CliResult result = RunShell(command);
    EXPECT_EQ(result.exit_code, 75) << command;
    EXPECT_THAT(result.err, HasSubstr("UNAVAILABLE"));
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(Cli, ALateServerMeansTryAgain) {
  const ServerProcess server;
  const CliResult result = RunShell(Sweep("1e9", "--summary-only --deadline 200ms --server " + server.address()));
  EXPECT_EQ(result.exit_code, 75);
  EXPECT_THAT(result.err, HasSubstr("DEADLINE_EXCEEDED"));
}

TEST_F(Cli, ASweepAboveTheServersLimitFails) {
  const ServerProcess server({"--max-points-per-sweep", "1000"});
  EXPECT_EQ(RunShell(Sweep("1000", "--server " + server.address())).exit_code, 0);
  const CliResult result = RunShell(Sweep("1001", "--server " + server.address()));
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("RESOURCE_EXHAUSTED"));
}

TEST_F(Cli, RowsAboveTheServersLimitAreAskedInParts) {
  const ServerProcess server({"--max-batch-numbers", "10", "--max-audit-rows", "2"});
  std::string impacts = "mu\n", observed = "rates_after_rad_s[0]\n";
  for (int i = 0; i < 12; ++i) {
    impacts += absl::StrCat(0.01 * i, "\n");
    observed += absl::StrCat(0.1 * i, "\n");
  }
  Write("impacts.csv", impacts);
  Write("observed.csv", observed);
  const std::string pendulum = " --a 0.3 --b 1 --mu 0.1 --energetic 1";
  const std::string commands[] = {"solve" + pendulum + " --data impacts.csv --column newton",
                                  "audit --a 0.3 --b 1 --mu 0.1 --data observed.csv"};
  for (const std::string& command : commands) {
    const CliResult here = RunShell("\"$R\" " + command + " --format csv");
    const CliResult there = RunShell("\"$R\" " + command + " --format csv --server " + server.address());
    ASSERT_EQ(here.exit_code, 0) << here.err;
    EXPECT_EQ(there.exit_code, 0) << there.err;
    EXPECT_EQ(there.out, here.out);
  }
}

TEST_F(Cli, HealthIsZeroOnlyWhereServing) {
  const ServerProcess server;
  const CliResult serving = Run({"health", "--server", server.address()});
  EXPECT_EQ(serving.exit_code, 0) << serving.err;
  EXPECT_EQ(serving.out, "SERVING\n");
  EXPECT_EQ(Run({"health", "--server", server.address(), "--service", ""}).exit_code, 0);
  EXPECT_EQ(Run({"health", "--server", server.address(), "--service", "no.such.Service"}).exit_code, 75);
}

}  // namespace
}  // namespace ricochet::cli
