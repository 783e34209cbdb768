#include "tests/hard_cases/hard_case_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "absl/strings/str_format.h"

namespace ricochet {
namespace {

std::string Number(double value) {
  if (value == kOtherRegime) return "another regime";
  if (std::isnan(value)) return "NaN";
  constexpr double kAllIsLost = 1e100;
  if (value > kAllIsLost) return "> 10¹⁰⁰";
  return absl::StrFormat("%.2g", value);
}

std::string Markdown(const std::string& unit, const std::vector<HardCaseResult>& results) {
  std::string text =
      "| case | why it is hard | naive, " + unit + " | promised | seen |\n| --- | --- | --- | --- | --- |\n";
  for (const HardCaseResult& result : results) {
    text += "| " + result.name + " | " + result.why + " | " + Number(result.naive) + " | " + Number(result.promised) +
            " | " + Number(result.seen) + " |\n";
  }
  return text;
}

std::string ReadFile(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

void CheckPage(const std::string& model, const std::string& table) {
  const std::string path = RICOCHET_ACCURACY_PAGE;
  std::string page = ReadFile(path);
  const std::string head = "<!-- hard cases: " + model + " -->\n";
  const size_t begin = page.find(head);
  ASSERT_NE(begin, std::string::npos) << head;
  const size_t from = begin + head.size();
  const size_t to = page.find("<!-- end -->", from);
  ASSERT_NE(to, std::string::npos) << head;
  if (std::getenv("RICOCHET_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(path) << page.replace(from, to - from, table);
    return;
  }
  EXPECT_EQ(page.substr(from, to - from), table);
}

}  // namespace

void CheckTable(const std::string& model, const std::string& unit, const std::vector<HardCaseResult>& results) {
  for (const HardCaseResult& result : results) {
    EXPECT_LE(result.seen, result.promised) << model << ", " << result.name;
  }
  const std::string table = Markdown(unit, results);
  std::printf("%s\n", table.c_str());
  CheckPage(model, table);
}

}  // namespace ricochet
