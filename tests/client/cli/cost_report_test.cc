// Tests of the texts and pictures of a cost study, on a made one (tests/client/cli/made_cost.h).

#include "client/cli/report/cost_report.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_split.h"
#include "client/cli/report/cost_page.h"
#include "client/cli/report/cost_picture.h"
#include "client/cli/report/html_page.h"
#include "ricochet/v1/cost.pb.h"
#include "tests/client/cli/cli_run.h"
#include "tests/client/cli/made_cost.h"
#include "tests/support/paths.h"

namespace ricochet::cli {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;
using testing::StartsWith;

std::vector<std::string> Lines(const std::string& text) { return absl::StrSplit(text, '\n', absl::SkipEmpty()); }

// Characters, not bytes.
long Width(const std::string& line) {
  return std::count_if(line.begin(), line.end(),
                       [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
}

std::string LineOf(const std::string& text, const std::string& name) {
  for (const std::string& line : Lines(text)) {
    if (line.find(name) != std::string::npos) return line;
  }
  return "";
}

const Curve* Find(const Plot& plot, const std::string& title) {
  for (const Curve& curve : plot.panels.at(0).curves) {
    if (curve.title == title) return &curve;
  }
  return nullptr;
}

TEST(CostReportTest, IsPrintedWordForWord) {
  const std::pair<std::string, std::string> printed[] = {{"cost_made.txt", CostText(MadeCost())},
                                                         {"cost_made.csv", CostCsv(MadeCost())}};
  for (const auto& [name, text] : printed) {
    const std::string path = TestDataPath("golden/" + name);
    if (std::getenv("RICOCHET_UPDATE_GOLDEN") != nullptr) std::ofstream(path) << text;
    EXPECT_EQ(text, ReadFile(path)) << name;
  }
}

TEST(CostReportTest, TimesHaveThreeDigits) {
  EXPECT_EQ(TimeText(8e-10), "0.80 ns");
  EXPECT_EQ(TimeText(8e-9), "8.00 ns");
  EXPECT_EQ(TimeText(2.54e-8), "25.4 ns");
  EXPECT_EQ(TimeText(1.604e-7), "160 ns");
  EXPECT_EQ(TimeText(9.996e-7), "1.00 µs");
  EXPECT_EQ(TimeText(1.2e-4), "120 µs");
  EXPECT_EQ(TimeText(0.0345), "34.5 ms");
  EXPECT_EQ(TimeText(2.0), "2.00 s");
}

TEST(CostReportTest, TheSpreadIsHalfTheDistanceOfTheQuartiles) {
  EXPECT_EQ(SpreadText({.median_s = 1e-6, .lower_quartile_s = 0.9e-6, .upper_quartile_s = 1.3e-6}), "20 %");
  EXPECT_EQ(SpreadText({.median_s = 2.0, .lower_quartile_s = 2.0, .upper_quartile_s = 2.0, .samples = 1}), "once");
}

TEST(CostReportTest, TheTableFitsIn100ColumnsWithTheLongestNames) {
  CostChunk study = MadeCost();
  for (CostRow& row : study.rows) {
    row.name.resize(32, 'x');
    row.note = "A sentence of many words that goes on for longer than a line of a terminal has room for, and then on.";
    row.steps = 99'999;
    row.solve = CostTime{1.604e-7, 1e-8, 3.3e-7, 21, 1000};
    row.batch = row.solve;
    row.claimed = {1e-16, 1e-16, 1e-16};
    row.achieved = row.claimed;
    row.status = CostStatus::kMeasured;
  }
  for (const std::string& line : Lines(CostText(study))) EXPECT_LE(Width(line), 100) << line;
}

TEST(CostReportTest, TheTableShowsWhatEachMethodTakesAndErrsBy) {
  const std::string text = CostText(MadeCost());
  EXPECT_THAT(text, StartsWith("8 methods for one impact. The exact answer: certified to 64 digits.\n\n"));
  EXPECT_THAT(LineOf(text, "* pendulum plain"),
              testing::MatchesRegex(R"(\* pendulum plain +25.0 ns +3 % +12.5 ns +1.7e-15 +1.1e-16 +1.1e-16 +0)"));
  EXPECT_THAT(LineOf(text, "  space 1e-06"), testing::EndsWith(" 12"));
  EXPECT_THAT(LineOf(text, "* frictionless"), HasSubstr("unknown"));
  EXPECT_THAT(LineOf(text, "  compliant"), testing::MatchesRegex("  compliant[ -]+"));
  EXPECT_THAT(text, HasSubstr("  1e-14 to 0.01      pendulum plain, which claims 1.7e-15\n"));
  EXPECT_THAT(text, HasSubstr("  0.1                first order\n"));
  EXPECT_THAT(text, HasSubstr("Answers that err by more than they claim: 1 of 6."));
  EXPECT_THAT(text, HasSubstr("Processor 1, AVX3, GCC 12.2.0; ricochet 0.1.0, engine 0123456789abcdef\n"));
}

TEST(CostReportTest, TimesOfABuildThatDoesNotOptimizeAreNotTrusted) {
  CostChunk study = MadeCost();
  study.summary->machine.optimized = false;
  EXPECT_THAT(CostText(study), HasSubstr("without optimization: these times say little"));
}

TEST(CostReportTest, CsvHasOneRowForEachMethod) {
  const std::vector<std::string> lines = Lines(CostCsv(MadeCost()));
  ASSERT_EQ(lines.size(), 9);
  EXPECT_THAT(lines[2], StartsWith("1,\"pendulum plain\",MEASURED,PENDULUM,PLAIN,,0,0,2.5e-08,"));
  EXPECT_THAT(lines[6], testing::EndsWith("say < 1 & > 0.\""));
}

// Returns true if `path` leads to a field of ricochet.v1.CostRow.
bool IsField(const std::string& path) {
  const google::protobuf::Descriptor* message = v1::CostRow::descriptor();
  for (const std::string& name : std::vector<std::string>(absl::StrSplit(path, '.'))) {
    const auto* field = message == nullptr ? nullptr : message->FindFieldByName(name);
    if (field == nullptr) return false;
    message = field->message_type();
  }
  return true;
}

TEST(CostReportTest, ColumnsOfCsvAreFieldsOfTheProtoAndFourMore) {
  const std::string header = Lines(CostCsv(MadeCost())).front();
  std::vector<std::string> others;
  for (const std::string& column : std::vector<std::string>(absl::StrSplit(header, ','))) {
    if (!IsField(column)) others.push_back(column);
  }
  EXPECT_THAT(others, ElementsAre("index", "deceived", "on_front", "picked_for_tolerances"));
}

TEST(CostPictureTest, APointIsTheErrorMadeAndTheTime) {
  const Plot plot = CostTimePlot(MadeCost(), PictureWidth::kWide);
  ASSERT_NE(Find(plot, "pendulum plain"), nullptr);
  EXPECT_THAT(Find(plot, "pendulum plain")->points, ElementsAre(Pair(1.1e-16, 2.5e-8)));
  // A tolerance is left out of the name of its line.
  EXPECT_NE(Find(plot, "space"), nullptr);
}

TEST(CostPictureTest, AnErrorThatNoDoubleShowsStandsAtTheEdge) {
  const Plot plot = CostTimePlot(MadeCost(), PictureWidth::kWide);
  EXPECT_THAT(Find(plot, "pendulum compensated")->points, ElementsAre(Pair(1e-17, 1.6e-7)));
  EXPECT_THAT(Find(plot, "certified")->points, ElementsAre(Pair(1e-17, 1.2e-4)));
}

TEST(CostPictureTest, FailuresAreVisible) {
  const Plot plot = CostTimePlot(MadeCost(), PictureWidth::kWide);
  EXPECT_THAT(Find(plot, "errs more than it claims")->points, ElementsAre(Pair(3e-15, 8e-8)));
  EXPECT_THAT(Find(plot, "misses its tolerance")->points, ElementsAre(Pair(2e-6, 1.5e-6)));
  EXPECT_EQ(Find(plot, "gave no answer")->points.size(), 1);
  EXPECT_THAT(plot.panels[0].settings, HasSubstr("'no answer' 1000"));
}

TEST(CostPictureTest, AStudyWithoutFailuresHasNoMarksOfThem) {
  CostChunk study = MadeCost();
  study.rows.resize(3);
  const Plot plot = CostTimePlot(study, PictureWidth::kWide);
  for (const char* mark : {"errs more than it claims", "misses its tolerance", "gave no answer"}) {
    EXPECT_EQ(Find(plot, mark), nullptr) << mark;
  }
  EXPECT_THAT(plot.panels[0].settings, Not(HasSubstr("no answer")));
}

TEST(CostPictureTest, TheTimesLieBetweenLabelledPowersOfTen) {
  const std::string settings = CostTimePlot(MadeCost(), PictureWidth::kWide).panels[0].settings;
  EXPECT_THAT(settings, HasSubstr("set ytics ('1 ns' 1e-9, '10 ns' 1e-8, '100 ns' 1e-7, '1 µs' 1e-6, '10 µs' 1e-5, "
                                  "'100 µs' 1e-4, '1 ms' 1e-3)\nset yrange [1e-9:1e-3]\n"));
}

TEST(CostPictureTest, AClaimWithoutABoundStandsBeyondAllClaims) {
  const Plot plot = CostClaimPlot(MadeCost(), PictureWidth::kNarrow);
  EXPECT_THAT(Find(plot, "frictionless")->points, ElementsAre(Pair(1e3, 0.05)));
  EXPECT_THAT(Find(plot, "pendulum plain")->points, ElementsAre(Pair(1.7e-15, 1.1e-16)));
  EXPECT_THAT(plot.panels[0].settings, HasSubstr("'no bound' 1000"));
}

TEST(CostPictureTest, TheTwoPicturesOfAFileShareOneLegend) {
  const Plot plot = CostPlot(MadeCost(), "title");
  ASSERT_EQ(plot.panels.size(), 2);
  EXPECT_THAT(plot.panels[0].settings, HasSubstr("unset key\n"));
  for (const Curve& curve : plot.panels[0].curves) {
    EXPECT_THAT(plot.panels[1].curves, Contains(Field(&Curve::title, curve.title)));
  }
}

TEST(CostPictureTest, TheLegendStandsBelowWhereThereIsNoRoomBeside) {
  const Plot wide = CostPlot(MadeCost(), "title");
  EXPECT_THAT(wide.panels[1].settings, HasSubstr("set key at screen 0.80, 0.88 "));
  const Plot narrow = CostPlot(MadeCost(), "title", 480, 360);
  EXPECT_EQ(narrow.width, 480);
  EXPECT_EQ(narrow.height, 360);
  const std::string& settings = narrow.panels[1].settings;
  EXPECT_THAT(settings, HasSubstr("set rmargin at screen 0.985\n"));
  const auto number_after = [&settings](const std::string& text) {
    const size_t at = settings.rfind(text);
    return at == std::string::npos ? NAN : std::stod(settings.substr(at + text.size()));
  };
  const double legend = number_after(" 0.02325, ");
  EXPECT_GT(legend, 0.1);
  EXPECT_LT(legend + 3.0 * 9.0 / 360.0, number_after("set bmargin at screen "));
}

TEST(CostPageTest, ShowsEveryMethodAndBothPicturesInTwoWidths) {
  Scene scene;
  scene.system = PlanarBody{.mass_kg = 2.0};
  const absl::StatusOr<std::string> page = CostPage(scene, MadeCost(), "2009-07-01 12:00 UTC");
  ASSERT_TRUE(page.ok()) << page.status();
  EXPECT_THAT(*page, HasSubstr("<title>What accuracy costs: one impact, planar body</title>"));
  for (const CostRow& row : MadeCost().rows) EXPECT_THAT(*page, HasSubstr(">" + row.name + "</td>"));
  EXPECT_THAT(*page, HasSubstr("say &lt; 1 &amp; &gt; 0."));
  EXPECT_THAT(*page, HasSubstr("2009-07-01 12:00 UTC"));
  EXPECT_THAT(*page, HasSubstr("mass_kg: 2\n"));
  EXPECT_THAT(*page, HasSubstr("Errors claimed and made: 1 of 6 claim too little"));
  size_t pictures = 0;
  for (size_t at = page->find("<svg"); at != std::string::npos; at = page->find("<svg", at + 1)) ++pictures;
  EXPECT_EQ(pictures, 4);
  EXPECT_THAT(*page, Not(HasSubstr("http")));
}

TEST(InlineSvgTest, NamesNoAddressAndSharesNoId) {
  const std::string file =
      "<?xml version=\"1.0\"?>\n<svg width=\"960\" viewBox=\"0 0 960 620\" xmlns=\"http://www.w3.org/2000/svg\">\n"
      "<title>Gnuplot</title>\n<desc>Produced by GNUPLOT</desc>\n<path id='gpPt0'/><g id=\"plot_1\">"
      "<use xlink:href='#gpPt0' fill='url(#gpPat)'/></g>\n</svg>\n";
  EXPECT_EQ(InlineSvg(file, "a-", "x < y"),
            "<svg viewBox=\"0 0 960 620\" role=\"img\"><title>x &lt; y</title>\n\n\n<path id='a-gpPt0'/>"
            "<g id=\"a-plot_1\"><use href='#a-gpPt0' fill='url(#a-gpPat)'/></g>\n</svg>\n");
  EXPECT_THAT(InlineSvg("no picture", "a-", ""), IsEmpty());
}

}  // namespace
}  // namespace ricochet::cli
