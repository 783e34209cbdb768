#include "client/cli/input/connection_input.h"

#include <unistd.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/cli/input/file_option.h"
#include "client/cli/text/number_input.h"
#include "core/base/nearest.h"
#include "core/base/try.h"
#include "ricochet/engine_info.h"

namespace ricochet::cli {
namespace {

struct Setting {
  const char* name;
  std::string ConnectionInput::*value;
  const char* field;  // The name that errors of ClientOptions give it; may be null.
};

constexpr Setting kSettings[] = {{"server", &ConnectionInput::server, "target"},
                                 {"deadline", &ConnectionInput::deadline, nullptr},
                                 {"max-receive", &ConnectionInput::max_receive, nullptr},
                                 {"tls", &ConnectionInput::tls, nullptr},
                                 {"tls-ca", &ConnectionInput::tls_ca, "security.tls_ca"},
                                 {"tls-cert", &ConnectionInput::tls_cert, "security.tls_cert"},
                                 {"tls-key", &ConnectionInput::tls_key, "security.tls_key"},
                                 {"server-name", &ConnectionInput::server_name, "security.server_name"},
                                 {"token-file", &ConnectionInput::token_file, "security.token_file"},
                                 {"token", &ConnectionInput::token, "security.token"}};

std::string VariableOf(const std::string& name) {
  return "RICOCHET_" + absl::AsciiStrToUpper(absl::StrReplaceAll(name, {{"-", "_"}}));
}

std::string FromEnvironment(const std::string& name) {
  const char* const value = std::getenv(VariableOf(name).c_str());
  return value == nullptr ? "" : value;
}

absl::Status IsEmpty(const std::string& source) {
  return absl::InvalidArgumentError(absl::StrCat(source, " is empty: must have a value, or not be set"));
}

// Finds a variable that is nearly one of these, because it would silently do nothing; others may belong to anybody. One
// of these that is empty may stand for a protection that is wanted.
absl::Status CheckEnvironment() {
  std::vector<std::string> known = {VariableOf("config")};
  for (const Setting& setting : kSettings) known.push_back(VariableOf(setting.name));
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string variable(*entry, std::strcspn(*entry, "="));
    if (!absl::StartsWith(variable, "RICOCHET_")) continue;
    if (std::find(known.begin(), known.end(), variable) != known.end()) {
      if (std::strlen(*entry) <= variable.size() + 1) return IsEmpty(variable);
      continue;
    }
    const std::string meant = DidYouMean(variable, known);
    if (meant.empty()) continue;
    return absl::InvalidArgumentError(absl::StrCat(variable, " in the environment is not an option", meant));
  }
  return absl::OkStatus();
}

// Returns the input of the lines in a file.
absl::StatusOr<ConnectionInput> ReadConfig(const std::string& path) {
  ConnectionInput input;
  std::vector<CLI::ConfigItem> lines;
  try {
    lines = CLI::ConfigTOML().from_file(path);
  } catch (const CLI::Error& error) {
    return absl::InvalidArgumentError(absl::StrCat("--config: ", error.what()));
  }
  for (const CLI::ConfigItem& line : lines) {
    if (!line.parents.empty()) {
      return absl::InvalidArgumentError(
          absl::StrCat("--config = ", path, ": [", line.parents.front(), "]: the file must have no sections"));
    }
    const auto setting = std::find_if(std::begin(kSettings), std::end(kSettings),
                                      [&line](const Setting& one) { return line.fullname() == one.name; });
    if (setting == std::end(kSettings) || line.inputs.size() != 1) {
      return absl::InvalidArgumentError(
          absl::StrCat("--config = ", path, ": ", line.fullname(),
                       " must be one of server, deadline, tls, tls-ca, tls-cert, tls-key, server-name, token-file, "
                       "token and max-receive, with one value"));
    }
    if (line.inputs.front().empty()) return IsEmpty(absl::StrCat("--config = ", path, ": ", setting->name));
    input.*(setting->value) = line.inputs.front();
  }
  return input;
}

// Notes the files, whoever named them.
absl::Status UseFiles(const ConnectionInput& input) {
  for (const std::string* path : {&input.config, &input.tls_ca, &input.tls_cert, &input.tls_key, &input.token_file}) {
    if (path->empty()) continue;
    if (absl::Status status = UseFile(FileUse::kRead, "", *path); !status.ok()) return status;
  }
  return absl::OkStatus();
}

// Returns the error for a flag that means nothing without a server.
absl::Status CheckFlagsWithoutServer(const ConnectionInput& flags) {
  for (const Setting& setting : kSettings) {
    if (!(flags.*(setting.value)).empty()) {
      return absl::InvalidArgumentError(absl::StrCat("--", setting.name, " needs --server"));
    }
  }
  return absl::OkStatus();
}

}  // namespace

std::string FlagOfConnection(const std::string& field) {
  for (const Setting& setting : kSettings) {
    if (setting.field == nullptr || field != setting.field) continue;
    // A token is never a flag.
    return setting.value == &ConnectionInput::token ? VariableOf(setting.name) : absl::StrCat("--", setting.name);
  }
  return "";
}

void AddConnectionOptions(CLI::App& app, ConnectionInput& input) {
  app.add_option("--server", input.server,
                 "Ask the ricochetd at this address, or the first that answers, instead of computing here")
      ->type_name("HOST:PORT|unix:PATH,...");
  app.add_option(
         "--deadline", input.deadline,
         "Give up a call after this time (250ms, 30s, 5m; a bare number is in seconds); needs --server [10s, but none "
         "for sweep, cost and the tables of solve]")
      ->type_name("TIME");
  app.add_option("--max-receive", input.max_receive, "Refuse a larger message of an answer; needs --server [4194304]")
      ->type_name("BYTES");
  app.add_flag_callback(
      "--tls", [&input] { input.tls = "true"; },
      "Encrypt, and make sure of the server by the system's authorities; --tls-ca, --tls-cert and --server-name imply "
      "it");
  const auto add_file = [&app](const char* name, std::string& path, const char* help) {
    MarkFile(FileUse::kRead, app.add_option(name, path, help))->type_name("FILE");
  };
  add_file("--tls-ca", input.tls_ca, "Make sure of the server by the authorities in this PEM file instead");
  add_file("--tls-cert", input.tls_cert, "This client's certificate, a PEM file");
  add_file("--tls-key", input.tls_key, "The private key of --tls-cert, a PEM file");
  app.add_option("--server-name", input.server_name,
                 "The name that the server's certificate must have, if it is not that of --server")
      ->type_name("NAME");
  add_file("--token-file", input.token_file, "Send the token in this file; RICOCHET_TOKEN may hold it instead");
  add_file("--config", input.config,
           "Read these options from a file; each can also be set in the environment, as RICOCHET_TLS_CA=FILE");
}

absl::StatusOr<ConnectionInput> Resolve(ConnectionInput input) {
  if (absl::Status unknown = CheckEnvironment(); !unknown.ok()) return unknown;
  const ConnectionInput flags = input;
  ConnectionInput file;
  if (input.config.empty()) input.config = FromEnvironment("config");
  if (!input.config.empty()) {
    RICOCHET_TRY(file, ReadConfig(input.config));
  }
  for (const Setting& setting : kSettings) {
    std::string& value = input.*(setting.value);
    if (value.empty()) value = FromEnvironment(setting.name);
    if (value.empty()) value = file.*(setting.value);
  }
  if (absl::Status used = UseFiles(input); !used.ok()) return used;
  if (input.server.empty()) {
    if (absl::Status unused = CheckFlagsWithoutServer(flags); !unused.ok()) return unused;
  }
  return input;
}

absl::StatusOr<ClientOptions> ClientOptionsOf(const ConnectionInput& input) {
  if (!input.tls.empty() && input.tls != "true" && input.tls != "false") {
    return InputError("--tls", input.tls, "be true or false");
  }
  ClientOptions client{.target = input.server, .user_agent = absl::StrCat("ricochet-cli/", ThisVersion())};
  client.security = {
      .tls = input.tls == "true" || !input.tls_ca.empty() || !input.tls_cert.empty() || !input.server_name.empty(),
      .tls_ca = input.tls_ca,
      .tls_cert = input.tls_cert,
      .tls_key = input.tls_key,
      .server_name = input.server_name,
      .token = input.token,
      .token_file = input.token_file};
  if (!input.max_receive.empty()) {
    RICOCHET_TRY(client.max_receive_bytes, ParseCount(input.max_receive, "--max-receive", kMostReceiveBytes));
  }
  if (!input.deadline.empty()) {
    RICOCHET_TRY(const auto deadline, ParseDuration(input.deadline, "--deadline"));
    client.deadline = deadline;
    client.sweep_deadline = deadline;
  }
  return client;
}

}  // namespace ricochet::cli
