// ricochet scene: templates that solve, files made of flags, and lists of fields and columns.

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <string>

#include "client/cli/input/scene_templates.h"
#include "ricochet/v1/scene.pb.h"
#include "tests/client/cli/cli_run.h"
#include "tests/support/paths.h"

namespace ricochet::cli {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::StartsWith;

using CliScene = CliTest;

TEST_F(CliScene, EverySystemHasATemplateThatSolvesAsTextprotoAndAsJson) {
  const auto* systems = v1::Scene::descriptor()->FindOneofByName("system");
  ASSERT_EQ(static_cast<int>(SceneTemplates().size()), systems->field_count());
  for (const SceneTemplate& one : SceneTemplates()) {
    ASSERT_NE(systems->containing_type()->FindFieldByName(one.system), nullptr) << one.system;
    const CliResult as_text = RunShell("\"$R\" scene template " + one.system + " | \"$R\" solve --scene -");
    const CliResult as_json = RunShell("\"$R\" scene template --json " + one.system + " | \"$R\" solve --scene -");
    EXPECT_EQ(as_text.exit_code, 0) << as_text.err;
    EXPECT_THAT(as_text.out, HasSubstr("Admissible.")) << one.system;
    EXPECT_THAT(one.text, HasSubstr("#")) << one.system;
    EXPECT_EQ(as_json.out, as_text.out) << as_json.err;
  }
}

TEST_F(CliScene, ListNamesEverySystem) {
  const CliResult list = Run({"scene", "list"});
  EXPECT_EQ(list.exit_code, 0) << list.err;
  for (const SceneTemplate& one : SceneTemplates()) EXPECT_THAT(list.out, HasSubstr(one.system));
  EXPECT_THAT(list.out, HasSubstr("A planar chain of links."));
  EXPECT_THAT(Run({"scene", "list", "--json"}).out,
              StartsWith(R"([{"system":"pendulum","meaning":"A pendulum, the system of Lubarda (2009)."})"));
}

TEST_F(CliScene, ATemplateOfNoSystemNamesTheNearest) {
  const CliResult result = Run({"scene", "template", "planar_bdy"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("planar_bdy is not a system; did you mean planar_body?"));
}

TEST_F(CliScene, FlagsBecomeAFileOfTheSameScene) {
  const Arguments flags = {"--a", "0.3", "--b", "1", "--mu", "1/3", "--mu-static", "0.5", "--poisson", "0.7"};
  Arguments solve = {"solve"};
  solve.insert(solve.end(), flags.begin(), flags.end());
  for (const std::string file : {"scene.textproto", "scene.txt", "scene.JSON"}) {
    Arguments print = {"scene", "print", "-o", file};
    print.insert(print.end(), flags.begin(), flags.end());
    ASSERT_EQ(Run(print).exit_code, 0);
    EXPECT_EQ(Run({"solve", "--scene", file}).out, Run(solve).out);
  }
  EXPECT_THAT(Read("scene.textproto"), HasSubstr("kinetic_coefficient: 0.3333333333333333"));
  EXPECT_THAT(Read("scene.JSON"), HasSubstr("\"kinetic_coefficient\": 0.3333333333333333"));
}

TEST_F(CliScene, AByteOrderMarkBeforeAFileIsSkipped) {
  for (const Arguments& format : {Arguments{}, Arguments{"--json"}}) {
    Arguments print = {"scene", "print", "--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1"};
    print.insert(print.end(), format.begin(), format.end());
    const std::string text = Run(print).out;
    const CliResult marked = Run({"solve", "--scene", "-"}, "\xEF\xBB\xBF" + text);
    EXPECT_EQ(marked.exit_code, 0) << marked.err;
    EXPECT_EQ(marked.out, Run({"solve", "--scene", "-"}, text).out);
  }
}

TEST_F(CliScene, AFileWhoseNameTellsTheOtherFormIsRefusedWithItsOwn) {
  ASSERT_EQ(Run({"scene", "template", "pendulum", "-o", "scene.txtpb"}).exit_code, 0);
  Write("text.json", Read("scene.txtpb"));
  EXPECT_THAT(Run({"solve", "--scene", "text.json"}).err,
              HasSubstr("text.json is in textproto, whose files are named .txtpb"));
  Write("json.txtpb", Run({"scene", "print", "--scene", "scene.txtpb", "--json"}).out);
  EXPECT_THAT(Run({"solve", "--scene", "json.txtpb"}).err,
              HasSubstr("json.txtpb is in JSON, whose files are named .json"));
}

TEST_F(CliScene, AFileThatHoldsNoObjectIsToldWhatItsKindBeginsWith) {
  for (const char* text : {"[]", "3"}) {
    Write("list.json", text);
    EXPECT_THAT(Run({"solve", "--scene", "list.json"}).err, HasSubstr("must be an object: {\"pendulum\": ..., ...}"));
    EXPECT_THAT(Run({"sweep", "--request", "list.json"}).err, HasSubstr("must be an object: {\"scene\": ..., ...}"));
  }
}

TEST_F(CliScene, PrintKeepsScenesWithSeveralContacts) {
  for (const SceneTemplate& one : MultiContactTemplates()) {
    const std::string name = one.system;
    ASSERT_EQ(Run({"scene", "template", name, "-o", "several.textproto"}).exit_code, 0);
    const CliResult answer = Run({"multicontact", "--scene", "several.textproto"});
    for (const std::string file : {"printed.textproto", "printed.json"}) {
      const CliResult printed = Run({"scene", "print", "--scene", "several.textproto", "-o", file});
      EXPECT_EQ(printed.exit_code, 0) << printed.err;
      EXPECT_EQ(Run({"multicontact", "--scene", file}).out, answer.out) << name;
    }
  }
}

TEST_F(CliScene, FunctionsOfSeveralContactsHaveTheirBoundsInCsv) {
  ASSERT_EQ(Run({"scene", "template", "box_on_two_feet", "-o", "box.textproto"}).exit_code, 0);
  const CliResult csv =
      Run({"multicontact", "--scene", "box.textproto", "--function", "twice, x=2,0,0", "--format", "csv"});
  EXPECT_EQ(csv.exit_code, 0) << csv.err;
  EXPECT_THAT(csv.out, HasSubstr(",energy_change_j,\"twice, x\"\n0,\"1\","));
  EXPECT_THAT(csv.out,
              ContainsRegex("0,\"possible, lower\",.*,-1\\.766[0-9]*\n0,\"possible, upper\",.*,1\\.766[0-9]*\n"));
}

TEST_F(CliScene, PrintRefusesWhatNoSolverWouldTake) {
  const CliResult result = Run({"scene", "print", "--a", "-1", "--energetic", "1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("pendulum.a_m = -1: must be > 0"));
}

TEST_F(CliScene, FieldsHaveUnitRangeAndMeaning) {
  const CliResult fields = Run({"scene", "fields"});
  EXPECT_EQ(fields.exit_code, 0) << fields.err;
  EXPECT_THAT(fields.out, HasSubstr("pendulum.a_m  [m]\n    a, horizontal distance from the pin to the contact point"));
  EXPECT_THAT(fields.out, HasSubstr("compliance.linear.stiffness_n_m  [N/m]\n"));
  EXPECT_THAT(fields.out, HasSubstr("pin_moment.moment_n_m  [N m]\n"));
  const std::string chain = TestDataPath("scenes/double_pendulum.textproto");
  EXPECT_THAT(Run({"scene", "fields", "--scene", chain}).out, HasSubstr("linkage.links[1].theta_rad  [rad]\n"));
  EXPECT_THAT(Run({"scene", "fields", "--json"}).out,
              HasSubstr(R"({"path":"restitution.energetic","unit":"","range":"0 <= value <= 1",)"));
}

TEST_F(CliScene, ColumnsAreThoseOfTheScene) {
  EXPECT_THAT(Run({"scene", "columns"}).out, HasSubstr("rates_after_rad_s[0]  [rad/s]\n"));
  const std::string pair = TestDataPath("scenes/body_pair.textproto");
  EXPECT_THAT(Run({"scene", "columns", "--scene", pair, "--json"}).out,
              HasSubstr(R"({"path":"bodies_after[1].linear_m_s[0]","unit":"m/s")"));
}

}  // namespace
}  // namespace ricochet::cli
