#include "proto/wire/info.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/program.h"
#include "client/cli/text/enum_names.h"
#include "core/base/try.h"
#include "proto/wire/plan.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] = R"(Example: what this program can compute beside its models.
  $ ricochet info | grep features
  features  certified
This program takes requests of any size. With --server the answer is about a server, and has its limits.
CSV has one row for each property and each limit; several values of one property stand with spaces between them.
Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again.)";

// One property or limit: its name, its value, and for a limit what it limits.
struct Row {
  std::string name;
  std::string value;
  std::string help;
};

std::string Features(const InfoResponse& info, const char* separator) {
  std::vector<std::string> features;
  if (info.certified) features.emplace_back("certified");
  return absl::StrJoin(features, separator);
}

std::string Models(const InfoResponse& info, const char* separator) {
  return absl::StrJoin(info.models, separator,
                       [](std::string* out, Model model) { *out += absl::AsciiStrToLower(EnumName(model)); });
}

std::vector<Row> RequestLimits(const Limits& limits) {
  std::vector<Row> rows;
  for (const NamedLimit& limit : kLimits) {
    const int64_t value = limits.*limit.value;
    const bool is_unlimited = value == std::numeric_limits<int64_t>::max();
    rows.push_back({limit.name, is_unlimited ? "unlimited" : absl::StrCat(value), limit.help});
  }
  return rows;
}

std::vector<Row> LimitsOfServer(const InfoResponse& info) {
  std::vector<Row> rows;
  if (!info.server_limits.has_value()) return rows;
  for (const NamedServerLimit& limit : kServerLimits) {
    rows.push_back({limit.name, absl::StrCat((*info.server_limits).*limit.value), limit.help});
  }
  return rows;
}

// Returns names in a column, values aligned to the right, and what each row means.
std::string Aligned(const std::vector<Row>& rows) {
  size_t name_width = 0;
  size_t value_width = 0;
  for (const Row& row : rows) {
    name_width = std::max(name_width, row.name.size());
    value_width = std::max(value_width, row.value.size());
  }
  std::string text;
  for (const Row& row : rows) {
    absl::StrAppend(&text, "  ", row.name,
                    std::string(name_width + 2 + value_width - row.name.size() - row.value.size(), ' '), row.value,
                    "  ", row.help, "\n");
  }
  return text;
}

std::string InfoText(const InfoResponse& info) {
  const std::string features = Features(info, ", ");
  std::string text = absl::StrCat("engine    ", info.engine.version, ", fingerprint ", info.engine.fingerprint,  //
                                  "\nfeatures  ", features.empty() ? "none" : features,                          //
                                  "\nsystems   ", absl::StrJoin(info.systems, ", "),                             //
                                  "\nmodels    ", Models(info, ", "),                                            //
                                  "\n\nLimits of a request\n", Aligned(RequestLimits(info.limits)));
  const std::vector<Row> of_server = LimitsOfServer(info);
  if (!of_server.empty()) absl::StrAppend(&text, "\nLimits of the server\n", Aligned(of_server));
  return text;
}

std::string InfoCsv(const InfoResponse& info) {
  std::vector<Row> rows = {{"version", CsvQuoted(info.engine.version), ""},
                           {"fingerprint", CsvQuoted(info.engine.fingerprint), ""},
                           {"features", CsvQuoted(Features(info, " ")), ""},
                           {"systems", CsvQuoted(absl::StrJoin(info.systems, " ")), ""},
                           {"models", CsvQuoted(Models(info, " ")), ""}};
  for (const std::vector<Row>& more : {RequestLimits(info.limits), LimitsOfServer(info)}) {
    rows.insert(rows.end(), more.begin(), more.end());
  }
  std::string text = "name,value\n";
  for (const Row& row : rows) absl::StrAppend(&text, row.name, ",", row.value, "\n");
  return text;
}

absl::Status RunInfo(const CommonOptions& options) {
  RICOCHET_TRY(const std::unique_ptr<Solver> solver, MakeSolver(options));
  RICOCHET_TRY(const InfoResponse info, solver->Info());
  return WriteAnswer(
      options, info, [&] { return InfoText(info); }, [&] { return InfoCsv(info); });
}

}  // namespace

void AddInfo(CLI::App& app, Command& command) {
  const auto [sub, options] = AddCommand<CommonOptions>(app, "info", "The engine, what it can compute, and its limits",
                                                        kExample, RunInfo, command);
  AddConnectionOptions(*sub, options->connection);
  AddOutputOptions(*sub, *options, kMessageFormats);
}

}  // namespace ricochet::cli
