#include "server/base/log.h"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <grpc/support/log.h>
#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace ricochet::server {
namespace {

using google::protobuf::Struct;
using testing::EndsWith;
using testing::HasSubstr;
using testing::MatchesRegex;

std::vector<std::string> Lines(const std::ostringstream& out) {
  std::vector<std::string> lines;
  std::istringstream in(out.str());
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

Struct ParseJson(const std::string& line) {
  Struct record;
  const auto status = google::protobuf::util::JsonStringToMessage(line, &record);
  EXPECT_TRUE(status.ok()) << status.ToString() << ": " << line;
  return record;
}

TEST(Log, TextLineHasTimeLevelEventAndFields) {
  std::ostringstream out;
  const Log log(LogFormat::kText, LogLevel::kInfo, out);
  log.Write(LogLevel::kInfo, "call", {{"peer", "ipv4:127.0.0.1:1"}, {"duration_ms", 1.25}, {"points", int64_t{7}}});
  ASSERT_EQ(Lines(out).size(), 1U);
  EXPECT_THAT(Lines(out)[0], MatchesRegex("[0-9]+-[0-9]+-[0-9]+T[0-9]+:[0-9]+:[0-9]+\\.[0-9]+Z info call "
                                          "peer=ipv4:127.0.0.1:1 duration_ms=1.250 points=7"));
}

TEST(Log, TextValueThatCouldMisleadIsQuoted) {
  std::ostringstream out;
  const Log log(LogFormat::kText, LogLevel::kInfo, out);
  log.Write(LogLevel::kInfo, "x", {{"a", "b c=d"}, {"e", ""}, {"f", "line\nbreak"}});
  ASSERT_EQ(Lines(out).size(), 1U);
  EXPECT_THAT(Lines(out)[0], EndsWith(R"(x a="b c=d" e="" f="line\nbreak")"));
}

TEST(Log, EveryJsonLineParsesToWhatWasWritten) {
  const std::string values[] = {"",
                                "plain",
                                R"(say "hi" \ %v {})",
                                "line\nbreak\r\ttab",
                                std::string("nul\0bell\a\x1f\x7f", 11),
                                "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80"};
  std::ostringstream out;
  const Log log(LogFormat::kJson, LogLevel::kInfo, out);
  for (const std::string& value : values) log.Write(LogLevel::kWarning, value, {{"text", value}});
  const auto lines = Lines(out);
  ASSERT_EQ(lines.size(), std::size(values));
  for (size_t i = 0; i < lines.size(); ++i) {
    const Struct record = ParseJson(lines[i]);
    EXPECT_EQ(record.fields().at("event").string_value(), values[i]);
    EXPECT_EQ(record.fields().at("text").string_value(), values[i]);
    EXPECT_EQ(record.fields().at("level").string_value(), "warning");
    EXPECT_THAT(record.fields().at("time").string_value(), EndsWith("Z"));
  }
}

TEST(Log, JsonNumbersAreNumbers) {
  std::ostringstream out;
  const Log log(LogFormat::kJson, LogLevel::kInfo, out);
  log.Write(LogLevel::kInfo, "x",
            {{"points", int64_t{10'000'000'000}},
             {"duration_ms", 0.125},
             {"none", std::numeric_limits<double>::quiet_NaN()}});
  const Struct record = ParseJson(Lines(out).at(0));
  EXPECT_EQ(record.fields().at("points").number_value(), 1e10);
  EXPECT_EQ(record.fields().at("duration_ms").number_value(), 0.125);
  EXPECT_TRUE(record.fields().at("none").has_null_value());
}

TEST(Log, BytesThatAreNotUtf8AreReplaced) {
  // The cases are a lone continuation byte, an overlong slash, a surrogate, a code above U+10FFFF, a cut character.
  const std::string values[] = {"\x80", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82"};
  std::ostringstream out;
  const Log log(LogFormat::kJson, LogLevel::kInfo, out);
  for (const std::string& value : values) log.Write(LogLevel::kInfo, "x", {{"text", value}});
  for (const std::string& line : Lines(out)) {
    EXPECT_THAT(ParseJson(line).fields().at("text").string_value(), HasSubstr("\xEF\xBF\xBD")) << line;
  }
}

TEST(Log, RecordsBelowTheLevelAreLeftOut) {
  std::ostringstream out;
  const Log log(LogFormat::kText, LogLevel::kWarning, out);
  log.Write(LogLevel::kInfo, "quiet", {});
  log.Write(LogLevel::kError, "loud", {});
  ASSERT_EQ(Lines(out).size(), 1U);
  EXPECT_THAT(Lines(out)[0], EndsWith("error loud"));
}

TEST(Log, GrpcsOwnMessagesAreRecords) {
  std::ostringstream out;
  const Log log(LogFormat::kJson, LogLevel::kInfo, out);
  gpr_set_log_verbosity(GPR_LOG_SEVERITY_ERROR);
  gpr_log(GPR_ERROR, "two\n%s", "\"lines\"");
  const Struct record = ParseJson(Lines(out).at(0));
  EXPECT_EQ(record.fields().at("event").string_value(), "grpc");
  EXPECT_EQ(record.fields().at("message").string_value(), "two\n\"lines\"");
}

TEST(Log, LinesOfManyThreadsDoNotMix) {
  std::ostringstream out;
  const Log log(LogFormat::kJson, LogLevel::kInfo, out);
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&log] {
        for (int k = 0; k < 500; ++k) log.Write(LogLevel::kInfo, "call", {{"peer", "somebody"}});
      });
    }
  }
  const auto lines = Lines(out);
  ASSERT_EQ(lines.size(), 2000U);
  for (const std::string& line : lines) {
    ASSERT_EQ(ParseJson(line).fields().at("peer").string_value(), "somebody");
  }
}

}  // namespace
}  // namespace ricochet::server
