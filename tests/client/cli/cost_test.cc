// Tests of `ricochet cost`. Times differ from run to run; everything else is looked at.

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "ricochet/v1/cost.pb.h"
#include "tests/client/cli/cli_run.h"
#include "tests/support/processes/server_process.h"

namespace ricochet::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr char kCost[] = "\"$R\" cost --a 0.3 --b 1 --mu 0.1 --energetic 1 --time-limit 500ms ";

std::string Cost(const std::string& options) { return kCost + options; }

std::vector<std::string> Lines(const std::string& text) { return absl::StrSplit(text, '\n', absl::SkipEmpty()); }

v1::CostResponse Study(const std::string& json) {
  v1::CostResponse response;
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(json, &response).ok()) << json;
  return response;
}

const v1::CostRow* Find(const v1::CostResponse& study, v1::Model model, v1::Arithmetic arithmetic) {
  for (const v1::CostRow& row : study.rows()) {
    if (row.method().model() == model && row.method().arithmetic() == arithmetic) return &row;
  }
  return nullptr;
}

class CliCost : public CliTest {};

TEST_F(CliCost, TheTableNamesEveryMethodAndFitsIn100Columns) {
  const CliResult result = RunShell(Cost("--html page.html"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const std::string& line : Lines(result.out)) {
    const auto is_first_byte = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    EXPECT_LE(std::count_if(line.begin(), line.end(), is_first_byte), 100) << line;
  }
  EXPECT_THAT(result.out, HasSubstr("Method that the plan picks\n"));
  EXPECT_THAT(result.out, HasSubstr("Answers that err by more than they claim: 0 of "));
}

// By the paper's equations (28) and (29), an elastic pendulum with x = 1/3 rebounds with 1/sqrt(2) of omega-, and
// without friction with omega- itself. The contact velocity is omega times (b, a), and its larger component before is b
// omega-.
TEST_F(CliCost, LeavingFrictionOutCostsWhatThePaperSays) {
  const v1::CostResponse study = Study(RunShell(Cost("--format json")).out);
  EXPECT_EQ(study.rows_size(), study.rows_total());
  EXPECT_EQ(study.summary().deceived(), 0);
  const v1::CostRow* frictionless = Find(study, v1::MODEL_FRICTIONLESS, v1::ARITHMETIC_PLAIN);
  ASSERT_NE(frictionless, nullptr);
  EXPECT_NEAR(frictionless->achieved().modelling(), 1.0 - 0.7071067811865476, 1e-12);
  const v1::CostRow* closed_form = Find(study, v1::MODEL_PENDULUM, v1::ARITHMETIC_COMPENSATED);
  ASSERT_NE(closed_form, nullptr);
  EXPECT_EQ(closed_form->status(), v1::CostRow::STATUS_MEASURED);
  EXPECT_LE(closed_form->achieved().total(), 2.3e-16);
  EXPECT_GT(closed_form->solve().median_s(), 0.0);
}

TEST_F(CliCost, SeveralContactsHaveTheirOwnMethods) {
  const CliResult result = RunShell("\"$R\" scene template box_on_two_feet | \"$R\" cost --scene - --time-limit 500ms");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* text : {"3 methods for one impact", "  orders ", "  springs ", "  possible ", "2 outcomes up to"}) {
    EXPECT_THAT(result.out, HasSubstr(text));
  }
  EXPECT_THAT(result.out, Not(HasSubstr("plan picks")));
}

TEST_F(CliCost, CsvHasARowForEachMethod) {
  const std::vector<std::string> lines = Lines(RunShell(Cost("--format csv")).out);
  ASSERT_GT(lines.size(), 5);
  EXPECT_THAT(lines[0], StartsWith("index,name,status,method.model,"));
  for (size_t i = 1; i < lines.size(); ++i) EXPECT_THAT(lines[i], StartsWith(absl::StrCat(i - 1, ",\"")));
}

TEST_F(CliCost, AServerAnswersTheSameMethods) {
  const ServerProcess server;
  const auto names = [](const std::string& json) {
    std::vector<std::string> all;
    const v1::CostResponse study = Study(json);
    for (const v1::CostRow& row : study.rows()) all.push_back(row.name());
    return all;
  };
  const CliResult asked = RunShell(Cost("--format json --server " + server.address()));
  EXPECT_EQ(asked.exit_code, 0) << asked.err;
  EXPECT_EQ(names(asked.out), names(RunShell(Cost("--format json")).out));
}

TEST_F(CliCost, DrawsBothPicturesIntoOneFile) {
  EXPECT_EQ(RunShell(Cost("--plot cost.svg -o cost.txt")).exit_code, 0);
  const std::string svg = Read("cost.svg");
  for (const char* label : {"time of one solve", "error made", "error claimed", "Pareto front", "made = claimed"}) {
    EXPECT_THAT(svg, HasSubstr(label));
  }
  EXPECT_EQ(RunShell(Cost("--plot cost.png -o cost.txt")).exit_code, 0);
  EXPECT_THAT(Read("cost.png"), StartsWith("\x89PNG"));
  EXPECT_THAT(Files(), ElementsAre("cost.png", "cost.svg", "cost.txt"));
}

TEST_F(CliCost, AnInterruptedStudyLeavesNoFile) {
  const CliResult result = RunShell(
      "timeout --preserve-status -s INT 1 \"$R\" cost --a 0.3 --b 1 --mu 0.1 --energetic 1 --time-limit 60s --samples "
      "1001 "
      "--html page.html --plot cost.svg -o cost.txt");
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_THAT(result.err, HasSubstr("interrupted"));
  EXPECT_THAT(Files(), IsEmpty());
}

TEST_F(CliCost, SaysThatGnuplotIsMissing) {
  const CliResult result = RunShell("PATH=/nonexistent\n" + Cost("--html page.html -o cost.txt"));
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("pictures need gnuplot, which is not installed"));
  EXPECT_THAT(Files(), ElementsAre("cost.txt"));
}

}  // namespace
}  // namespace ricochet::cli
