#include "client/cli/common.h"

#include <CLI/App.hpp>
#include <array>
#include <map>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "client/cli/json/json_text.h"
#include "client/cli/number_input.h"
#include "client/cli/output.h"
#include "core/engine/engine.h"
#include "proto/wire/outcome.h"
#include "proto/wire/sweep.h"
#include "ricochet/client.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

void AddServerOptions(CLI::App& app, CommonOptions& options) { AddConnectionOptions(app, options.connection); }

void AddOutputOptions(CLI::App& app, CommonOptions& options, bool has_lines) {
  std::map<std::string, Format> formats;
  for (const Format format : {Format::kText, Format::kJson, Format::kCsv}) formats[FormatName(format)] = format;
  if (has_lines) formats[FormatName(Format::kJsonLines)] = Format::kJsonLines;
  app.add_option_function<std::string>(
         "--format", [&options, formats](const std::string& name) { options.format = formats.at(name); },
         has_lines ? "text: tables; json: one document; jsonl: an object on each line; csv: rows at full precision"
                   : "text: tables; json: the response message; csv: rows at full precision")
      ->check(CLI::IsMember(formats))
      ->option_text(has_lines ? "text|json|jsonl|csv" : "text|json|csv");
  app.add_option("-o,--output", options.output,
                 "Write to this file, which is replaced only when the output is complete")
      ->type_name("FILE");
}

void AddSweepOutputOptions(CLI::App& app, CommonOptions& options) {
  struct Choice {
    Format format;
    ArrayFormat array;
  };
  const std::map<std::string, Choice> formats = {
      {"text", {Format::kText, ArrayFormat::kNone}},       {"json", {Format::kJson, ArrayFormat::kNone}},
      {"jsonl", {Format::kJsonLines, ArrayFormat::kNone}}, {"csv", {Format::kCsv, ArrayFormat::kNone}},
      {"npy", {Format::kText, ArrayFormat::kNpy}},         {"netcdf", {Format::kText, ArrayFormat::kNetcdf}}};
  app.add_option_function<std::string>(
         "--format",
         [&options, formats](const std::string& name) {
           options.format = formats.at(name).format;
           options.array = formats.at(name).array;
           options.has_format = true;
         },
         "text: tables; json: one document; jsonl: an object on each line; csv: rows at full precision; npy: records "
         "for "
         "NumPy; netcdf: a NetCDF-4 file. Default: npy or netcdf if FILE ends in .npy or .nc, else text")
      ->check(CLI::IsMember(formats))
      ->option_text("text|json|jsonl|csv|npy|netcdf");
  app.add_option("-o,--output", options.output,
                 "Write to this file, which is replaced only when the output is complete")
      ->type_name("FILE");
}

ArrayFormat ArrayFormatOf(const CommonOptions& options) {
  if (options.has_format) return options.array;
  if (absl::EndsWith(options.output, ".npy")) return ArrayFormat::kNpy;
  return absl::EndsWith(options.output, ".nc") ? ArrayFormat::kNetcdf : ArrayFormat::kNone;
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
  absl::StatusOr<Output> output = Output::Open(options.output);
  if (!output.ok()) return output.status();
  if (absl::Status status = output->Write(text); !status.ok()) return status;
  return output->Commit();
}

std::string Json(const google::protobuf::Message& message) { return JsonOf(message) + "\n"; }

std::string FormatName(Format format) {
  switch (format) {
    case Format::kText:
      return "text";
    case Format::kJson:
      return "json";
    case Format::kJsonLines:
      return "jsonl";
    case Format::kCsv:
      break;
  }
  return "csv";
}

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
