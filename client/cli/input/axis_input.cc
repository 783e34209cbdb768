#include "client/cli/input/axis_input.h"

#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/cli/input/short_name.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

using Values = decltype(Axis::values);

std::vector<std::string> Split(const std::string& text, char separator) { return absl::StrSplit(text, separator); }

// Reads START, STOP and COUNT of a Linspace or a Logspace.
template <typename Space>
absl::StatusOr<Values> ParseSpace(const std::vector<std::string>& parts, const std::string& what, Spelling spelling) {
  if (parts.size() != 4) {
    return InputError(what, absl::StrCat(parts[0], " with ", parts.size() - 1, " parts"),
                      absl::StrCat("be ", parts[0], ":START:STOP:COUNT"));
  }
  RICOCHET_TRY(const double start, ParseNumber(parts[1], absl::StrCat(what, ", START"), spelling));
  RICOCHET_TRY(const double stop, ParseNumber(parts[2], absl::StrCat(what, ", STOP"), spelling));
  RICOCHET_TRY(const int64_t count, ParseCount(parts[3], absl::StrCat(what, ", COUNT")));
  return Values(Space{start, stop, count});
}

absl::StatusOr<Values> ParseValues(const std::string& text, const std::string& what, Spelling spelling) {
  const std::vector<std::string> parts = Split(text, ':');
  if (parts[0] == "lin") return ParseSpace<Linspace>(parts, what, spelling);
  if (parts[0] == "log") return ParseSpace<Logspace>(parts, what, spelling);
  if (parts.size() > 1) {
    return InputError(what, text, "be a list such as 0.1,1/3 or lin:START:STOP:COUNT or log:START:STOP:COUNT");
  }
  RICOCHET_TRY(std::vector<double> list, ParseNumbers(text, what, spelling));
  return Values(ListValues{std::move(list)});
}

}  // namespace

absl::StatusOr<Axis> ParseAxis(const std::string& text, const Scene& scene) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return InputError("--axis", text, "be PATH=VALUES, such as friction.kinetic_coefficient=0.1,1/3");
  }
  RICOCHET_TRY(std::string path, FullField(scene, text.substr(0, equals), "--axis"));
  Axis axis{.path = std::move(path), .values = {}};
  RICOCHET_TRY(axis.values,
               ParseValues(text.substr(equals + 1), absl::StrCat("--axis ", axis.path), SpellingOf(axis.path)));
  return axis;
}

absl::StatusOr<FieldRange> ParseFieldRange(const std::string& text, const Scene& scene) {
  const size_t equals = text.find('=');
  const size_t colon = text.find(':', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || equals == 0 || colon == std::string::npos) {
    return InputError("--range", text, "be PATH=LOW:HIGH, such as friction.kinetic_coefficient=0.09:0.11");
  }
  RICOCHET_TRY(std::string path, FullField(scene, text.substr(0, equals), "--range"));
  FieldRange range{.path = std::move(path)};
  const auto parse = [&](const std::string& end, const char* name) {
    return ParseNumber(end, absl::StrCat("--range ", range.path, ", ", name), SpellingOf(range.path));
  };
  RICOCHET_TRY(const double low, parse(text.substr(equals + 1, colon - equals - 1), "LOW"));
  RICOCHET_TRY(const double high, parse(text.substr(colon + 1), "HIGH"));
  range.low = low;
  range.high = high;
  return range;
}

absl::Status ReadRange(const std::string& text, SweepRequest& request) {
  const std::vector<std::string> parts = Split(text, ':');
  if (parts.size() != 2) return InputError("--range", text, "be FIRST:END");
  if (!parts[0].empty()) {
    RICOCHET_TRY(request.first_index, ParseCount(parts[0], "--range, FIRST"));
  }
  if (!parts[1].empty()) {
    RICOCHET_TRY(request.end_index, ParseCount(parts[1], "--range, END"));
  }
  return absl::OkStatus();
}

bool AsksForNames(const std::vector<std::string>& values) { return values == std::vector<std::string>{"?"}; }

absl::Status ListNames(const CommonOptions& common, const SceneOptions& options,
                       std::vector<std::string> (*names_of)(const Scene&)) {
  if (common.format != Format::kText) {
    return InputError("--format", FormatName(common.format), "be text, because ? lists names");
  }
  RICOCHET_TRY(const Scene scene, options.any() ? ReadScene(options) : Scene{.system = Pendulum()});
  std::string text;
  for (const std::string& name : names_of(scene)) absl::StrAppend(&text, name, "\n");
  return WriteOutput(common, text);
}

}  // namespace ricochet::cli
