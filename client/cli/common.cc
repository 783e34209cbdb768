#include "client/cli/common.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <array>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "client/cli/file_option.h"
#include "client/cli/json/json_text.h"
#include "client/cli/number_input.h"
#include "client/cli/output.h"
#include "client/cli/shard_input.h"
#include "client/cli/table.h"
#include "core/engine/engine.h"
#include "proto/wire/outcome.h"
#include "proto/wire/sweep.h"
#include "ricochet/client.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

void AddServerOptions(CLI::App& app, CommonOptions& options) { AddConnectionOptions(app, options.connection); }

void AddOutputOptions(CLI::App& app, CommonOptions& options, absl::Span<const Format> formats) {
  options.format = formats.front();
  if (formats.size() > 1) {
    const auto append_meaning = [](std::string* text, Format format) {
      absl::StrAppend(text, FormatName(format), ": ", FormatMeaning(format));
    };
    std::vector<std::string> names;
    for (const Format format : formats) names.push_back(FormatName(format));
    app.add_option_function<std::string>(
           "--format",
           [&options, formats](const std::string& name) {
             options.named_format = name;
             options.format = *ChooseFormat(formats, name, "");
           },
           absl::StrCat(absl::StrJoin(formats, "; ", append_meaning), " [what FILE ends in, else ", names.front(), "]"))
        ->check(CLI::IsMember(names))
        ->option_text(absl::StrJoin(names, "|"));
  }
  const auto take = [&app, &options, formats](const std::string& path) {
    if (!IsStandardOutput(path)) options.output = path;
    if (WritesShard(app)) return;
    const absl::StatusOr<Format> format = ChooseFormat(formats, options.named_format, options.output);
    const std::string flag = FlagForFile(path);
    if (!format.ok()) {
      const bool has_flag = !flag.empty() && app.get_option_no_throw(flag) != nullptr;
      throw CLI::ValidationError(absl::StrCat(format.status().message(),
                                              has_flag ? absl::StrCat("; did you mean ", flag, " ", path, "?") : ""));
    }
    options.format = *format;
    if (!options.output.empty() && !IsDevice(path)) ForgetTerminalWidth();
  };
  MarkFile(FileUse::kWritten,
           app.add_option_function<std::string>("-o,--output", take,
                                                "Write to this file, which is replaced only when the output is "
                                                "complete; - for standard output"))
      ->type_name("FILE");
}

absl::StatusOr<int64_t> RowsOfTable(const CommonOptions& options, int64_t rows) {
  constexpr int64_t kShown = 40;
  constexpr int64_t kMost = 100'000;
  if (options.output.empty() || IsDevice(options.output)) return std::min(rows, kShown);
  if (rows <= kMost) return rows;
  return absl::InvalidArgumentError(absl::StrCat("-o ", options.output, ": a table for people of ", rows,
                                                 " rows: must have at most ", kMost, ", or be csv"));
}

namespace {

absl::Status CheckThreads(const ConnectionInput& connection, std::optional<int> threads) {
  if (!threads.has_value()) return absl::OkStatus();
  return InputError(
      "--threads", absl::StrCat(*threads),
      absl::StrCat("not be given with the server ", connection.server, ", which computes with threads of its own"));
}

absl::StatusOr<std::unique_ptr<Solver>> Connect(const ClientOptions& options) {
  absl::StatusOr<Client> client = Client::Connect(options);
  if (!client.ok()) return client.status();
  return std::make_unique<Client>(*std::move(client));
}

}  // namespace

absl::StatusOr<ClientOptions> MakeClientOptions(const CommonOptions& options) {
  const absl::StatusOr<ConnectionInput> connection = Resolve(options.connection);
  if (!connection.ok()) return connection.status();
  if (connection->server.empty()) return absl::InvalidArgumentError("--server is required");
  return ClientOptionsOf(*connection);
}

absl::StatusOr<std::unique_ptr<Solver>> MakeSolver(const CommonOptions& options, std::optional<int> threads) {
  const absl::StatusOr<ConnectionInput> connection = Resolve(options.connection);
  if (!connection.ok()) return connection.status();
  if (connection->server.empty()) {
    return std::make_unique<LocalSolver>(Limits::None(), threads.value_or(AvailableCores()));
  }
  if (absl::Status status = CheckThreads(*connection, threads); !status.ok()) return status;
  const absl::StatusOr<ClientOptions> client = ClientOptionsOf(*connection);
  if (!client.ok()) return client.status();
  return Connect(*client);
}

absl::StatusOr<std::unique_ptr<Solver>> MakeFanOut(const CommonOptions& options, std::optional<int> threads) {
  const absl::StatusOr<ConnectionInput> connection = Resolve(options.connection);
  if (!connection.ok()) return connection.status();
  if (connection->server.empty()) return absl::InvalidArgumentError("--fan-out needs --server A,B,...");
  if (!absl::StrContains(connection->server, ',')) {
    return InputError("--server", connection->server, "name at least two servers, separated by commas, for --fan-out");
  }
  if (absl::Status status = CheckThreads(*connection, threads); !status.ok()) return status;
  absl::StatusOr<ClientOptions> client = ClientOptionsOf(*connection);
  if (!client.ok()) return client.status();
  client->fan_out.emplace();
  return Connect(*client);
}

absl::Status WriteOutput(const CommonOptions& options, const std::string& text) {
  return WriteFile(options.output, text);
}

std::string Json(const google::protobuf::Message& message) { return JsonOf(message) + "\n"; }

namespace {

// Returns the names of all values of an enum that counts from 0, as the protos have them, without their prefix.
template <typename Enum, size_t kCount, typename ProtoName>
std::array<std::string, kCount> NamesOf(ProtoName proto_name, absl::string_view prefix) {
  std::array<std::string, kCount> names;
  for (size_t i = 0; i < kCount; ++i) {
    names[i] = std::string(absl::StripPrefix(proto_name(ToProto(static_cast<Enum>(i))), prefix));
  }
  return names;
}

}  // namespace

const std::string& RegimeName(Regime regime) {
  static const auto names = NamesOf<Regime, kRegimeCount>(v1::Regime_Name<v1::Regime>, "REGIME_");
  return names.at(static_cast<size_t>(regime));
}

const std::string& StatusName(RowStatus status) {
  static const auto names = NamesOf<RowStatus, kRowStatusCount>(v1::RowStatus_Name<v1::RowStatus>, "ROW_STATUS_");
  return names.at(static_cast<size_t>(status));
}

std::string RegimeText(Regime regime) {
  return absl::StrReplaceAll(absl::AsciiStrToLower(RegimeName(regime)), {{"_", " "}});
}

}  // namespace ricochet::cli
