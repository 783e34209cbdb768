#include "client/cli/input/fit_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include "absl/algorithm/container.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/input/short_name.h"
#include "client/cli/io/csv_table.h"
#include "client/cli/text/number_input.h"
#include "core/base/nearest.h"
#include "core/base/try.h"
#include "core/rows/column.h"
#include "core/scene/field.h"
#include "ricochet/error.h"

namespace ricochet::cli {
namespace {

constexpr char kSigmaEnding[] = ".sigma";

// A column of the table: its use, its path and its cells.
struct Column {
  enum class Use { kInput, kMeasured, kSigma } use = Use::kInput;
  std::string path;
  std::vector<double> values;
};

absl::Status GivenTwice(const std::string& option, const std::string& name) {
  return absl::InvalidArgumentError(absl::StrCat(option, " ", name, ": must be given once"));
}

absl::StatusOr<Column> ColumnOf(const std::string& name, const Scene& scene) {
  const std::vector<std::string> numbers = ColumnPlaces(scene);
  std::vector<std::string> known = FieldPaths(scene);
  known.insert(known.end(), numbers.begin(), numbers.end());
  RICOCHET_TRY(std::string path, FullName(name, known, "--data, column"));
  if (!absl::c_linear_search(known, path)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "--data has the column \"", absl::CEscape(name), "\": must be a number of the scene, one of the outcome, or ",
        "either with .sigma", DidYouMean(name, known), "; --skip-column leaves a column out"));
  }
  const auto use = absl::c_linear_search(numbers, path) ? Column::Use::kMeasured : Column::Use::kInput;
  return Column{.use = use, .path = std::move(path), .values = {}};
}

// `others` are the paths of the columns that may have sigmas.
absl::StatusOr<Column> SigmaColumnOf(const std::string& name, const std::vector<std::string>& others) {
  const std::string bare(absl::StripSuffix(name, kSigmaEnding));
  RICOCHET_TRY(std::string path, FullName(bare, others, "--data, column"));
  if (absl::c_linear_search(others, path)) return Column{.use = Column::Use::kSigma, .path = path, .values = {}};
  return absl::InvalidArgumentError(
      absl::StrCat("--data has ", absl::CEscape(name), " but not ", absl::CEscape(bare), DidYouMean(bare, others)));
}

// Finds what the columns of the table are. Those that are skipped have no value.
absl::StatusOr<std::vector<std::optional<Column>>> ColumnsOf(const CsvReader& reader, const Scene& scene) {
  std::vector<std::optional<Column>> columns(reader.header().size());
  std::set<std::pair<Column::Use, std::string>> given;
  std::vector<std::string> paths;
  for (const bool for_sigmas : {false, true}) {
    for (size_t i = 0; i < columns.size(); ++i) {
      const std::string& name = reader.header()[i];
      if (reader.IsSkipped(i) || absl::EndsWith(name, kSigmaEnding) != for_sigmas) continue;
      RICOCHET_TRY(Column column, for_sigmas ? SigmaColumnOf(name, paths) : ColumnOf(name, scene));
      if (!given.emplace(column.use, column.path).second) return GivenTwice("--data, column", name);
      if (!for_sigmas) paths.push_back(column.path);
      columns[i] = std::move(column);
    }
  }
  return columns;
}

// Reads the cells of a row into the columns.
absl::Status ReadRow(const CsvReader& reader, const std::vector<std::string>& cells,
                     std::vector<std::optional<Column>>& columns) {
  const auto wrong = [&reader](const std::string& column, const std::string& what) {
    return absl::InvalidArgumentError(absl::StrCat("--data, line ", reader.line(), ": ", column, " ", what));
  };
  if (const std::string rule = reader.WhyNoRow(cells); !rule.empty()) return wrong("the row", rule);
  for (size_t i = 0; i < columns.size(); ++i) {
    if (!columns[i].has_value()) continue;
    double value = std::numeric_limits<double>::quiet_NaN();
    const std::string& cell = cells[i];
    const std::string rule = cell.empty() ? "" : ReadNumber(cell, SpellingOf(columns[i]->path), value);
    if (rule.empty() && !cell.empty() && std::isnan(value)) {
      return wrong(reader.header()[i], "= nan: must be finite; what was not measured has an empty cell");
    }
    if (!rule.empty()) return wrong(reader.header()[i], absl::StrCat("= \"", absl::CEscape(cell), "\": must ", rule));
    if (cell.empty() && columns[i]->use == Column::Use::kInput) return wrong(reader.header()[i], "is missing");
    columns[i]->values.push_back(value);
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<Column>> ReadTable(const FitDataOptions& options, const Scene& scene) {
  RICOCHET_TRY(const std::string text, ReadText(options.file));
  std::istringstream stream(text);
  RICOCHET_TRY(CsvReader reader, CsvReader::Open(stream, options.file == "-" ? "standard input" : options.file));
  if (absl::Status status = reader.Skip(options.skipped_columns); !status.ok()) return status;
  RICOCHET_TRY(std::vector<std::optional<Column>> columns, ColumnsOf(reader, scene));
  bool has_rows = false;
  std::vector<std::string> cells;
  while (true) {
    RICOCHET_TRY(const bool has_row, reader.NextRow(cells));
    if (!has_row) break;
    has_rows = true;
    if (absl::Status status = ReadRow(reader, cells, columns); !status.ok()) return status;
  }
  if (!has_rows) return absl::InvalidArgumentError("--data has a header but no rows: must have one at least");
  std::vector<Column> kept;
  for (std::optional<Column>& column : columns) {
    if (column.has_value()) kept.push_back(*std::move(column));
  }
  return kept;
}

// Splits NAME=TEXT and finds which of the names it means.
absl::StatusOr<std::pair<std::string, std::string>> ReadPair(const std::string& option, const std::string& typed,
                                                             const std::vector<std::string>& known) {
  const size_t equals = typed.find('=');
  RICOCHET_TRY(const std::string name, FullName(typed.substr(0, equals), known, option));
  return std::pair(name, equals == std::string::npos ? "" : typed.substr(equals + 1));
}

absl::Status ReadUnknowns(const FitDataOptions& options, const Scene& scene, FitRequest& request) {
  std::vector<std::string> paths;
  for (const std::string& typed : options.unknowns) {
    RICOCHET_TRY(const auto pair, ReadPair("--unknown", typed, FieldPaths(scene)));
    FitUnknown& unknown = request.unknowns.emplace_back();
    unknown.path = pair.first;
    paths.push_back(unknown.path);
    if (pair.second.empty()) continue;
    RICOCHET_TRY(unknown.start,
                 ParseNumber(pair.second, absl::StrCat("--unknown ", unknown.path), SpellingOf(unknown.path)));
  }
  std::set<std::string> bounded;
  for (const std::string& typed : options.bounds) {
    RICOCHET_TRY(const auto pair, ReadPair("--bound", typed, paths));
    const size_t colon = pair.second.find(':');
    const auto at = static_cast<size_t>(std::find(paths.begin(), paths.end(), pair.first) - paths.begin());
    if (at == paths.size() || colon == std::string::npos) {
      return InputError("--bound", typed, "be NAME=LOW:HIGH with the name of an unknown");
    }
    FitUnknown& unknown = request.unknowns[at];
    if (!bounded.insert(unknown.path).second) return GivenTwice("--bound", unknown.path);
    for (const auto& [text, bound] : {std::pair(pair.second.substr(0, colon), &unknown.low),
                                      std::pair(pair.second.substr(colon + 1), &unknown.high)}) {
      if (text.empty()) continue;
      RICOCHET_TRY(*bound, ParseNumber(text, absl::StrCat("--bound ", unknown.path), SpellingOf(unknown.path)));
    }
  }
  for (const std::string& typed : options.region) {
    RICOCHET_TRY(const std::string name, FullName(typed, paths, "--region"));
    request.region.push_back(name);
  }
  return absl::OkStatus();
}

// The columns of the table that may have sigmas, by their paths: where these stand.
std::vector<std::pair<std::string, std::vector<double>*>> SigmasOf(FitRequest& request) {
  std::vector<std::pair<std::string, std::vector<double>*>> sigmas;
  for (FitMeasured& measured : request.measured) sigmas.emplace_back(measured.path, &measured.sigma);
  for (FitInput& input : request.inputs) sigmas.emplace_back(input.path, &input.sigma);
  return sigmas;
}

absl::Status ReadSigmas(const FitDataOptions& options, FitRequest& request) {
  const auto sigmas = SigmasOf(request);
  std::vector<std::string> paths;
  for (const auto& [path, sigma] : sigmas) paths.push_back(path);
  std::set<std::string> given;
  for (const std::string& typed : options.sigmas) {
    RICOCHET_TRY(const auto pair, ReadPair("--sigma", typed, paths));
    const auto at = static_cast<size_t>(std::find(paths.begin(), paths.end(), pair.first) - paths.begin());
    if (at == paths.size()) {
      return InputError("--sigma", typed,
                        absl::StrCat("be NAME=SIGMA with the name of a column (", absl::StrJoin(paths, ", "), ")",
                                     DidYouMean(pair.first, paths)));
    }
    RICOCHET_TRY(const double sigma,
                 ParseNumber(pair.second, absl::StrCat("--sigma ", pair.first), SpellingOf(pair.first)));
    if (!given.insert(pair.first).second) return GivenTwice("--sigma", pair.first);
    if (!sigmas[at].second->empty()) {
      return absl::InvalidArgumentError(
          absl::StrCat("--sigma ", pair.first, " cannot be combined with a column ", pair.first, kSigmaEnding));
    }
    *sigmas[at].second = {sigma};
  }
  for (const FitMeasured& measured : request.measured) {
    if (!measured.sigma.empty()) continue;
    return absl::InvalidArgumentError(absl::StrCat("no sigma for ", measured.path, ": give --sigma ", measured.path,
                                                   "=X or a column ", measured.path, kSigmaEnding));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<FitRequest> ReadFit(const FitDataOptions& options, const Scene& scene) {
  RICOCHET_TRY(std::vector<Column> columns, ReadTable(options, scene));
  FitRequest request = {.scene = scene};
  for (Column& column : columns) {
    if (column.use == Column::Use::kInput) {
      request.inputs.push_back({column.path, std::move(column.values), {}});
    } else if (column.use == Column::Use::kMeasured) {
      request.measured.push_back({column.path, std::move(column.values), {}});
    }
  }
  const auto sigmas = SigmasOf(request);
  for (Column& column : columns) {
    if (column.use != Column::Use::kSigma) continue;
    const auto own = absl::c_find_if(sigmas, [&column](const auto& sigma) { return sigma.first == column.path; });
    const auto measured = absl::c_find_if(request.measured, [&](const auto& m) { return m.path == column.path; });
    for (size_t row = 0; row < column.values.size(); ++row) {
      const bool has_number = measured == request.measured.end() || !std::isnan(measured->values[row]);
      if (!has_number || !std::isnan(column.values[row])) continue;
      return absl::InvalidArgumentError(absl::StrCat("--data, row ", row, ": ", column.path, kSigmaEnding,
                                                     " is missing: must be there where ", column.path, " is"));
    }
    *own->second = std::move(column.values);
  }
  if (absl::Status status = ReadUnknowns(options, scene, request); !status.ok()) return status;
  if (absl::Status status = ReadSigmas(options, request); !status.ok()) return status;
  return request;
}

absl::Status InTheTable(const FitRequest& request, const absl::Status& status) {
  std::vector<Violation> violations = ViolationsOf(status);
  static const std::regex pattern(R"((inputs|measured)\[(\d+)\]\.(values|sigma)(?:\[(\d+)\])?)");
  bool is_changed = false;
  for (Violation& violation : violations) {
    const std::string field = violation.field;
    std::smatch parts;
    if (!std::regex_match(field, parts, pattern)) continue;
    const bool is_input = parts[1] == "inputs", is_sigma = parts[3] == "sigma";
    size_t place = 0;
    const bool is_known = absl::SimpleAtoi(parts[2].str(), &place) &&
                          place < (is_input ? request.inputs.size() : request.measured.size());
    if (!is_known) continue;
    const std::string& path = is_input ? request.inputs[place].path : request.measured[place].path;
    const std::vector<double>& sigma = is_input ? request.inputs[place].sigma : request.measured[place].sigma;
    const bool is_option = is_sigma && sigma.size() == 1;
    is_changed = true;
    violation.field = is_option
                          ? absl::StrCat("--sigma ", path)
                          : absl::StrCat("--data, ", parts[4].matched ? absl::StrCat("row ", parts[4].str(), ", ") : "",
                                         path, is_sigma ? kSigmaEnding : "");
  }
  return is_changed ? WithViolations(status, violations) : status;
}

}  // namespace ricochet::cli
