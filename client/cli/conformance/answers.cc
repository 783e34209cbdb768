#include "client/cli/conformance/answers.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/io/csv_table.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

using Json = nlohmann::json;

// Adds an answer after checking it. `where` names its place in the file.
absl::Status Add(const std::string& where, const std::string& name, const std::string& law,
                 const std::vector<double>& velocity, SimulatorAnswers& all) {
  RICOCHET_TRY(const ConformanceCase* asked, FindConformanceCase(name, absl::StrCat(where, ".case")));
  if (absl::Status status = CheckConformanceLaw(law, absl::StrCat(where, ".law")); !status.ok()) return status;
  const auto answers_it = [&](const SimulatorAnswer& answer) { return answer.asked == asked; };
  if (std::any_of(all.answers.begin(), all.answers.end(), answers_it)) {
    return absl::InvalidArgumentError(absl::StrCat(where, ".case = ", name, ": must not be answered twice"));
  }
  const std::vector<std::string>& coordinates = asked->coordinates;
  if (velocity.size() != coordinates.size()) {
    return absl::InvalidArgumentError(absl::StrCat(where, ".velocity_after of ", name, " has ", velocity.size(),
                                                   " numbers: must have ", coordinates.size(), ", ",
                                                   absl::StrJoin(coordinates, ", ")));
  }
  // Below 1e100 neither energies nor impulses overflow.
  if (!std::all_of(velocity.begin(), velocity.end(), [](double x) { return std::fabs(x) < 1e100; })) {
    return absl::InvalidArgumentError(absl::StrCat(
        where, ".velocity_after of ", name, ": must have numbers of a size below 1e100; leave out a case without any"));
  }
  all.answers.push_back(
      {.asked = asked,
       .law = law,
       .velocity_after = Eigen::VectorXd::Map(velocity.data(), static_cast<Eigen::Index>(velocity.size()))});
  return absl::OkStatus();
}

// Returns an error for a key that is none of `known`.
absl::Status CheckKeys(const Json& object, const std::string& where, const std::vector<std::string>& known) {
  if (!object.is_object()) return absl::InvalidArgumentError(absl::StrCat(where, ": must be an object"));
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      return absl::InvalidArgumentError(
          absl::StrCat(where, ".", key, ": is unknown; must be ", absl::StrJoin(known, ", ")));
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<std::string> Text(const Json& object, const char* key, const std::string& where) {
  if (!object.contains(key)) return std::string();
  if (object[key].is_string()) return object[key].get<std::string>();
  return absl::InvalidArgumentError(absl::StrCat(where, ".", key, ": must be a text"));
}

absl::Status AddJson(const Json& object, const std::string& where, const std::string& general_law,
                     SimulatorAnswers& all) {
  if (absl::Status status = CheckKeys(object, where, {"case", "law", "velocity_after"}); !status.ok()) return status;
  RICOCHET_TRY(const std::string name, Text(object, "case", where));
  RICOCHET_TRY(const std::string law, Text(object, "law", where));
  const Json velocity = object.value("velocity_after", Json());
  const auto is_number = [](const Json& x) { return x.is_number(); };
  if (!velocity.is_array() || !std::all_of(velocity.begin(), velocity.end(), is_number)) {
    return absl::InvalidArgumentError(absl::StrCat(where, ".velocity_after: must be a list of numbers"));
  }
  return Add(where, name, law.empty() ? general_law : law, velocity.get<std::vector<double>>(), all);
}

// Reads JSON whose objects have no key twice.
absl::Status ParseWithoutTwins(const std::string& text, const std::string& name, Json& json) {
  std::vector<std::set<std::string>> keys;
  std::string twin;
  bool is_deep = false;  // Copies of values that nest without end would fill the stack.
  const auto note = [&](int depth, Json::parse_event_t event, Json& part) {
    constexpr int kMostLevels = 100;
    if (depth > kMostLevels) is_deep = true;
    if (is_deep) return false;
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(part.get<std::string>()).second) twin = part.dump();
    return true;
  };
  try {
    json = Json::parse(text, note);
    // The parser takes a NUL for the end of the text.
    if (absl::StrContains(text, '\0')) return absl::InvalidArgumentError(absl::StrCat(name, " has a NUL byte"));
    if (is_deep) return absl::InvalidArgumentError(absl::StrCat(name, " nests more than 100 levels deep"));
    if (twin.empty()) return absl::OkStatus();
    return absl::InvalidArgumentError(absl::StrCat(name, ": ", twin, " is given twice in one object"));
  } catch (const Json::parse_error& error) {
    return absl::InvalidArgumentError(
        error.byte > text.size()
            ? absl::StrCat(name, " ends within its JSON, at byte ", text.size(), "; is it whole?")
            : absl::StrCat(name, " is not JSON from byte ", error.byte, " of ", text.size(), " on; is it whole?"));
  } catch (const Json::exception&) {  // The only other exception is that of a number out of range.
    return absl::InvalidArgumentError(absl::StrCat(name, " has a number that exceeds the largest double"));
  }
}

absl::StatusOr<SimulatorAnswers> ReadJson(const std::string& text, const std::string& name) {
  SimulatorAnswers all;
  Json json;
  if (absl::Status status = ParseWithoutTwins(text, name, json); !status.ok()) return status;
  if (absl::Status status = CheckKeys(json, name, {"simulator", "law", "answers"}); !status.ok()) return status;
  RICOCHET_TRY(const std::string simulator, Text(json, "simulator", name));
  RICOCHET_TRY(const std::string law, Text(json, "law", name));
  if (absl::Status status = CheckConformanceLaw(law, absl::StrCat(name, ".law")); !status.ok()) return status;
  all.simulator = simulator;
  const Json answers = json.value("answers", Json());
  if (!answers.is_array()) return absl::InvalidArgumentError(absl::StrCat(name, ".answers: must be a list"));
  for (const Json& answer : answers) {
    const std::string where = absl::StrCat("answers[", all.answers.size(), "]");
    if (absl::Status status = AddJson(answer, where, law, all); !status.ok()) return status;
  }
  return all;
}

absl::StatusOr<SimulatorAnswers> ReadCsv(const std::string& text, const std::string& name) {
  SimulatorAnswers all;
  std::istringstream stream(text);
  RICOCHET_TRY(CsvReader reader, CsvReader::Open(stream, name));
  const std::vector<std::string> header = {"case", "law", "velocity_after"};
  if (reader.header() != header) {
    return absl::InvalidArgumentError(absl::StrCat(name, " has the header ", absl::StrJoin(reader.header(), ","),
                                                   ": must have case,law,velocity_after"));
  }
  std::vector<std::string> cells;
  while (true) {
    RICOCHET_TRY(const bool has_row, reader.NextRow(cells));
    if (!has_row) return all;
    const std::string where = absl::StrCat("line ", reader.line());
    std::vector<double> velocity;
    for (size_t i = 2; i < cells.size(); ++i) {
      RICOCHET_TRY(const double number, ParseNumber(cells[i], absl::StrCat(where, ", cell ", i + 1)));
      velocity.push_back(number);
    }
    absl::Status status = Add(where, cells[0], cells.size() > 1 ? cells[1] : "", velocity, all);
    if (!status.ok()) return status;
  }
}

}  // namespace

absl::Status CheckConformanceLaw(const std::string& law, const std::string& what) {
  const bool known = std::find(kConformanceLaws.begin(), kConformanceLaws.end(), law) != kConformanceLaws.end();
  if (law.empty() || known) return absl::OkStatus();
  return InputError(what, law, absl::StrCat("be ", absl::StrJoin(kConformanceLaws, ", ")));
}

absl::StatusOr<SimulatorAnswers> ReadSimulatorAnswers(const std::string& text, const std::string& name) {
  const absl::string_view start = absl::StripLeadingAsciiWhitespace(text);
  if (start.empty()) return absl::InvalidArgumentError(absl::StrCat(name, " is empty: must have answers"));
  absl::StatusOr<SimulatorAnswers> all =
      start[0] == '{' || start[0] == '[' ? ReadJson(text, name) : ReadCsv(text, name);
  if (all.ok() && all->answers.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(name, " has no answer: must have one at least"));
  }
  return all;
}

}  // namespace ricochet::cli
