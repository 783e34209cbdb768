#include "server/options.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "absl/types/span.h"
#include "core/base/nearest.h"
#include "ricochet/engine_info.h"
#include "server/calls/bounded_service.h"
#include "server/security/callers.h"

namespace ricochet::server {
namespace {

// The rule that a value breaks, as "must …"; nothing for a good value.
using BrokenRule = std::optional<std::string>;

constexpr int kMostCalls = 65536;

constexpr char kAddressRule[] =
    "must be HOST:PORT with a port from 0 to 65535, an IPv6 host in brackets, or unix:PATH with at most 107 bytes; "
    "several stand with commas between them";

constexpr int kMostConnections = 1'000'000;

constexpr char kMetricsRule[] = "must be HOST:PORT with a port from 0 to 65535, an IPv6 host in brackets";

constexpr char kEmptyRule[] = "must not be empty";

// The rule for an option without a value, which has taken the name of the next option for it.
constexpr char kOptionForValue[] = "must be a value, not an option; the name of a file may begin with ./";

template <typename Number>
std::optional<Number> ParseNumber(const std::string& text) {
  Number number = {};
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return number;
}

template <typename Integer>
BrokenRule ReadInteger(const std::string& text, Integer most, Integer& integer) {
  const auto value = ParseNumber<Integer>(text);
  if (!value.has_value() || *value < 1 || *value > most) {
    return absl::StrCat("must be an integer from 1 to ", most);
  }
  integer = *value;
  return std::nullopt;
}

BrokenRule ReadSeconds(const std::string& text, std::chrono::milliseconds& time) {
  const auto seconds = ParseNumber<double>(text);
  if (!seconds.has_value() || !(*seconds >= 0.0 && *seconds <= 3600.0)) {
    return "must be a number of seconds from 0 to 3600";
  }
  time = std::chrono::milliseconds(std::llround(*seconds * 1e3));
  return std::nullopt;
}

BrokenRule ReadTimeLimit(const std::string& text, std::chrono::milliseconds& time) {
  if (ReadSeconds(text, time).has_value() || time.count() == 0) return "must be a number of seconds from 0.001 to 3600";
  return std::nullopt;
}

template <typename Value>
using Names = std::vector<std::pair<std::string, Value>>;

template <typename Value>
BrokenRule ReadName(const std::string& text, const Names<Value>& names, Value& value) {
  for (const auto& [name, named] : names) {
    if (text == name) {
      value = named;
      return std::nullopt;
    }
  }
  return "must be one of " +
         absl::StrJoin(names, ", ", [](std::string* out, const auto& entry) { *out += entry.first; });
}

BrokenRule ReadAddresses(const std::string& text, std::vector<ListenAddress>& addresses) {
  addresses.clear();
  for (const auto part : absl::StrSplit(text, ',')) {
    const auto address = ParseListenAddress(std::string(part));
    if (!address.has_value()) return kAddressRule;
    addresses.push_back(*address);
  }
  return std::nullopt;
}

BrokenRule ReadMode(const std::string& text, mode_t& mode) {
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, mode, 8);
  if (result.ec == std::errc() && result.ptr == end && mode <= 0777) return std::nullopt;
  return "must be permissions in octal, from 0 to 777";
}

BrokenRule ReadPath(const std::string& text, std::string& path) {
  path = text;
  if (text.empty()) return kEmptyRule;
  return std::nullopt;
}

struct Setting {
  std::string name;
  std::string value_name;  // Empty for a flag, which may be given without a value.
  std::string help;
  std::function<BrokenRule(const std::string&, Options&)> read;
};

std::vector<Setting> NetworkSettings() {
  return {
      {"listen", "HOST:PORT|unix:PATH,...",
       "Where to take connections, with commas between several; port 0 lets the system choose [127.0.0.1:50051]",
       [](const std::string& text, Options& to) { return ReadAddresses(text, to.listen); }},
      {"reflection", "HOST:PORT|unix:PATH,...",
       "Where clients can read the proto files by gRPC reflection, away from the calls [nowhere]",
       [](const std::string& text, Options& to) { return ReadAddresses(text, to.reflection); }},
      {"metrics", "HOST:PORT",
       "Where HTTP clients can read the metrics, at /metrics, and the health, at /healthz [nowhere]",
       [](const std::string& text, Options& to) -> BrokenRule {
         to.metrics = ParseListenAddress(text);
         if (!to.metrics.has_value() || to.metrics->is_unix()) return kMetricsRule;
         return std::nullopt;
       }},
      {"socket-mode", "OCTAL", "Permissions of the file of a Unix socket [600]",
       [](const std::string& text, Options& to) { return ReadMode(text, to.socket_mode); }},
      {"port-file", "FILE", "Write the bound port to this file once the server takes calls",
       [](const std::string& text, Options& to) { return ReadPath(text, to.port_file); }},
      {"insecure", "",
       "Allow --listen and --metrics addresses that other hosts can reach; only --tls-cert encrypts calls",
       [](const std::string& text, Options& to) {
         return ReadName<bool>(text, {{"true", true}, {"1", true}, {"false", false}, {"0", false}}, to.insecure);
       }},
      {"max-connections", "N", "Connections that may be open at once; each takes two descriptors [4096]",
       [](const std::string& text, Options& to) { return ReadInteger(text, kMostConnections, to.connections.in_all); }},
      {"max-connections-per-peer", "N",
       "The same for one client: an IPv4 address, an IPv6 network of 64 bits, a user of a Unix socket [2048]",
       [](const std::string& text, Options& to) {
         return ReadInteger(text, kMostConnections, to.connections.per_peer);
       }},
      {"transport-memory", "MIB", "Memory for the buffers of all connections together [256]",
       [](const std::string& text, Options& to) {
         return ReadInteger(text, int64_t{1} << 20, to.transport_memory_mib);
       }},
      {"call-memory", "MIB",
       "Memory for the requests and answers of all calls together, of which one client can have three quarters; at "
       "least what the largest batch and its answer need [512, or that]",
       [](const std::string& text, Options& to) { return ReadInteger(text, int64_t{1} << 20, to.call_memory_mib); }},
      {"handshake-timeout", "SECONDS", "Close a connection that does not begin HTTP/2, with TLS, in this time [10]",
       [](const std::string& text, Options& to) { return ReadTimeLimit(text, to.transport_times.handshake); }},
      {"idle-timeout", "SECONDS", "Close a connection that has had no call for this time [300]",
       [](const std::string& text, Options& to) { return ReadTimeLimit(text, to.transport_times.idle); }},
  };
}

std::vector<Setting> SecuritySettings() {
  return {
      {"tls-cert", "FILE", "Serve with TLS, by this certificate chain in PEM form; read again when it changes",
       [](const std::string& text, Options& to) { return ReadPath(text, to.tls.certificate); }},
      {"tls-key", "FILE", "The private key of --tls-cert in PEM form, without a pass phrase",
       [](const std::string& text, Options& to) { return ReadPath(text, to.tls.key); }},
      {"tls-client-ca", "FILE", "Let in only clients with a certificate of these authorities",
       [](const std::string& text, Options& to) { return ReadPath(text, to.tls.client_ca); }},
      {"tokens", "FILE",
       absl::StrCat(
           "Answer only callers of this file, a line each: NAME sha256:HEX|certificate SCOPES, with scopes from ",
           absl::StrJoin(Scopes(), ", "), "; read again when it changes"),
       [](const std::string& text, Options& to) { return ReadPath(text, to.tokens); }},
  };
}

std::vector<Setting> CallSettings() {
  return {
      {"max-live-calls", "N", "Calls that may run or wait at once [1024]",
       [](const std::string& text, Options& to) { return ReadInteger(text, kMostCalls, to.live_calls.calls); }},
      {"max-live-calls-per-peer", "N", "Those of one client [7/8 of max-live-calls]",
       [](const std::string& text, Options& to) {
         return ReadInteger(text, kMostCalls, to.live_calls.calls_per_peer);
       }},
      {"max-streams", "N", "Sweeps and studies of cost among them [1/4 of max-live-calls]",
       [](const std::string& text, Options& to) { return ReadInteger(text, kMostCalls, to.live_calls.streams); }},
      {"max-streams-per-peer", "N", "Those of one client [3/16 of max-live-calls]",
       [](const std::string& text, Options& to) {
         return ReadInteger(text, kMostCalls, to.live_calls.streams_per_peer);
       }},
      {"max-threads", "N", absl::StrCat("Threads [max-live-calls + ", Options::kSpareThreads, "]"),
       [](const std::string& text, Options& to) { return ReadInteger(text, 1 << 20, to.max_threads); }},
      {"compute-threads", "N",
       "Expensive calls that compute at once, and as many parts of streams [the cores that it may use]",
       [](const std::string& text, Options& to) { return ReadInteger(text, 1024, to.compute_threads); }},
      {"max-waiting-calls", "N", "Expensive calls that may wait to compute; more are refused [256]",
       [](const std::string& text, Options& to) { return ReadInteger(text, kMostCalls, to.max_waiting_calls); }},
      {"max-unary-time", "SECONDS", "The longest that a unary call may take, whatever its client allows [60]",
       [](const std::string& text, Options& to) { return ReadTimeLimit(text, to.time_limits.unary_time); }},
      {"max-stream-age", "SECONDS", "The longest that a stream may run; clients go on with a new one [3600]",
       [](const std::string& text, Options& to) { return ReadTimeLimit(text, to.time_limits.stream_age); }},
      {"write-stall-timeout", "SECONDS", "End a call whose client does not read one message in this time [30]",
       [](const std::string& text, Options& to) { return ReadTimeLimit(text, to.unread_limit); }},
  };
}

std::vector<Setting> DrainSettings() {
  return {
      {"drain-grace", "SECONDS", "After a stop signal, announce NOT_SERVING for this time before sweeps are ended [3]",
       [](const std::string& text, Options& to) { return ReadSeconds(text, to.drain_grace); }},
      {"drain-timeout", "SECONDS", "Then wait at most this time for calls to end [5]",
       [](const std::string& text, Options& to) { return ReadSeconds(text, to.drain_timeout); }},
  };
}

// One setting for each limit of a request.
std::vector<Setting> RequestLimitSettings() {
  std::vector<Setting> settings;
  for (const NamedLimit& limit : kLimits) {
    settings.push_back({absl::StrReplaceAll(limit.name, {{"_", "-"}}), "N",
                        absl::StrCat(limit.help, " [", Limits().*limit.value, "]"),
                        [&limit](const std::string& text, Options& to) {
                          return ReadInteger(text, limit.most, to.limits.*limit.value);
                        }});
  }
  return settings;
}

std::vector<Setting> LogSettings() {
  return {
      {"log-format", "FORMAT", "text or json: one record on each line [text]",
       [](const std::string& text, Options& to) {
         return ReadName<LogFormat>(text, {{"text", LogFormat::kText}, {"json", LogFormat::kJson}}, to.log_format);
       }},
      {"log-level", "LEVEL", "debug, info, warning or error; calls are logged at info [info]",
       [](const std::string& text, Options& to) {
         return ReadName<LogLevel>(text,
                                   {{"debug", LogLevel::kDebug},
                                    {"info", LogLevel::kInfo},
                                    {"warning", LogLevel::kWarning},
                                    {"error", LogLevel::kError}},
                                   to.log_level);
       }},
      {"log-file", "FILE", "Append the log to this file, opened anew after SIGHUP [standard error]",
       [](const std::string& text, Options& to) { return ReadPath(text, to.log_file); }},
      {"log-calls", "RULE",
       "all; or failed calls and: errors (no other), slow:SECONDS, one in sample:N, the first rate:N a second "
       "[rate:100]",
       [](const std::string& text, Options& to) -> BrokenRule {
         const auto rule = ParseCallRule(text);
         if (!rule.has_value()) return kCallRuleForm;
         to.log_calls = *rule;
         return std::nullopt;
       }},
  };
}

constexpr char kEnvironmentPrefix[] = "RICOCHETD_";

std::string EnvironmentName(const std::string& name) {
  return kEnvironmentPrefix + absl::AsciiStrToUpper(absl::StrReplaceAll(name, {{"-", "_"}}));
}

std::string FromEnvironment(const std::string& name) {
  const char* const value = std::getenv(EnvironmentName(name).c_str());
  return value == nullptr ? "" : value;
}

// CLI11 ranks the file above the environment, so this removes from the file what the environment sets.
class BelowEnvironment : public CLI::ConfigTOML {
 public:
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
    std::vector<CLI::ConfigItem> entries = CLI::ConfigTOML::from_config(input);
    std::erase_if(entries, [](const auto& entry) { return !FromEnvironment(entry.name).empty(); });
    return entries;
  }
};

// An option that was given by flag, environment or file; its value is still text.
struct Given {
  const Setting* setting;
  CLI::Option* option;
};

std::vector<Given> AddOptions(const std::vector<Setting>& settings, const std::string& group, CLI::App& app) {
  std::vector<Given> added;
  for (const Setting& setting : settings) {
    const std::string flag = "--" + setting.name;
    CLI::Option* const option =
        setting.value_name.empty() ? app.add_flag(flag, setting.help) : app.add_option(flag, setting.help);
    option->group(group)->envname(EnvironmentName(setting.name));
    option->option_text(setting.value_name.empty() ? " " : setting.value_name);
    added.push_back({&setting, option});
  }
  return added;
}

std::string Violated(const std::string& name, const std::string& value, const std::string& rule) {
  return absl::StrCat("--", name, " = ", value, ": ", rule);
}

// Names an option that was given by what has set it.
std::string SourceOf(const std::string& name, absl::Span<const char* const> arguments) {
  const std::string flag = "--" + name;
  const auto sets = [&flag](const char* argument) {
    return argument == flag || absl::StartsWith(argument, flag + "=");
  };
  if (std::any_of(arguments.begin(), arguments.end(), sets)) return flag;
  return FromEnvironment(name).empty() ? absl::StrCat("--config: ", name) : EnvironmentName(name);
}

void Read(const std::vector<Given>& given, absl::Span<const char* const> arguments, Options& options,
          std::vector<std::string>& violations) {
  for (const auto& [setting, option] : given) {
    if (option->count() == 0) continue;
    const std::string& text = option->results().back();
    const BrokenRule broken = absl::StartsWith(text, "--") ? kOptionForValue : setting->read(text, options);
    if (broken.has_value()) {
      violations.push_back(absl::StrCat(SourceOf(setting->name, arguments), " = ", text, ": ", *broken));
    }
  }
}

void CheckNotOpen(const std::string& name, const std::vector<ListenAddress>& addresses, const Options& options,
                  std::vector<std::string>& violations) {
  if (!options.tls.certificate.empty()) return;
  for (const ListenAddress& address : addresses) {
    if (IsLocal(address)) continue;
    if (!options.insecure) {
      violations.push_back(Violated(name, ToString(address),
                                    "must be a loopback address (localhost, 127.0.0.0/8, [::1]) or a Unix socket "
                                    "without --tls-cert or --insecure; nothing would be encrypted"));
    } else if (!options.tokens.empty()) {
      violations.push_back(Violated(name, ToString(address), "needs --tls-cert, as --tokens would travel unencrypted"));
    }
  }
}

// The page is never encrypted, whatever the service is, and no token travels to it.
void CheckMetrics(const Options& options, std::vector<std::string>& violations) {
  if (!options.metrics.has_value() || options.insecure || IsLocal(*options.metrics)) return;
  violations.push_back(Violated("metrics", ToString(*options.metrics),
                                "must be a loopback address (localhost, 127.0.0.0/8, [::1]) without --insecure; the "
                                "page is not encrypted"));
}

void CheckTls(const Options& options, std::vector<std::string>& violations) {
  if (options.tls.certificate.empty() != options.tls.key.empty()) {
    violations.push_back(options.tls.key.empty() ? Violated("tls-cert", options.tls.certificate, "needs --tls-key")
                                                 : Violated("tls-key", options.tls.key, "needs --tls-cert"));
  }
  if (options.tls.certificate.empty() && !options.tls.client_ca.empty()) {
    violations.push_back(Violated("tls-client-ca", options.tls.client_ca, "needs --tls-cert"));
  }
}

// A limit above the one that it is a part of would never take effect.
void CheckLimitsFit(const Options& options, std::vector<std::string>& violations) {
  const auto check = [&violations](const char* part, int limit, const char* whole, int most) {
    if (limit <= most) return;
    violations.push_back(Violated(part, absl::StrCat(limit), absl::StrCat("must be <= ", most, ", that of --", whole)));
  };
  const LiveCallLimits& calls = options.live_calls;
  check("max-live-calls-per-peer", calls.calls_per_peer, "max-live-calls", calls.calls);
  check("max-streams", calls.streams, "max-live-calls", calls.calls);
  check("max-streams-per-peer", calls.streams_per_peer, "max-streams", calls.streams);
  check("max-connections-per-peer", options.connections.per_peer, "max-connections", options.connections.in_all);
}

void CheckTogether(const Options& options, std::vector<std::string>& violations) {
  CheckTls(options, violations);
  CheckNotOpen("listen", options.listen, options, violations);
  CheckNotOpen("reflection", options.reflection, options, violations);
  CheckMetrics(options, violations);
  const bool only_unix = std::all_of(options.listen.begin(), options.listen.end(),
                                     [](const ListenAddress& address) { return address.is_unix(); });
  if (only_unix && !options.port_file.empty()) {
    violations.push_back(
        Violated("port-file", options.port_file, "needs HOST:PORT in --listen; a Unix socket has no port"));
  }
  CheckLimitsFit(options, violations);
  const int64_t memory = LeastCallMemoryMib(options.limits);
  if (options.call_memory_mib < memory) {
    violations.push_back(Violated("call-memory", absl::StrCat(options.call_memory_mib),
                                  absl::StrCat("must be >= ", memory,
                                               ": three quarters of it must hold the largest batch, by "
                                               "--max-request-bytes, and its answer, by --max-batch-numbers")));
  }
  const int threads = options.live_calls.calls + Options::kSpareThreads;
  if (options.max_threads < threads) {
    violations.push_back(
        Violated("max-threads", absl::StrCat(options.max_threads),
                 absl::StrCat("must be >= ", threads, ", --max-live-calls + ", Options::kSpareThreads)));
  }
}

std::vector<std::string> OptionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  }
  return names;
}

std::vector<std::string> WithPrefix(const std::string& prefix, const std::vector<std::string>& names) {
  std::vector<std::string> longer;
  for (const std::string& name : names) longer.push_back(prefix + name);
  return longer;
}

// The message of an error of the parser, which names what it does not know.
std::string InWords(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> extras = app.remaining();
  const std::vector<std::string> names = OptionNames(app);
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && !extras.empty()) {
    const std::string word = extras.front().substr(0, extras.front().find('='));
    if (!absl::StartsWith(word, "-")) return absl::StrCat(word, " is not expected: must follow an option");
    return absl::StrCat(word, " is not an option", DidYouMean(word, WithPrefix("--", names)));
  }
  absl::string_view what = error.what();
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ArgumentMismatch)) {
    return absl::StrCat(what.substr(0, what.find(": ")), ": must be given once, with a value");
  }
  if (absl::ConsumePrefix(&what, "INI was not able to parse ")) {
    if (absl::ConsumeSuffix(&what, ".++"))
      return absl::StrCat("--config: [", what, "]: the file must have no sections");
    return absl::StrCat("--config: ", what, " is not an option", DidYouMean(what, names));
  }
  return error.what();
}

// Kubernetes tells a pod of a Service that is called ricochetd by RICOCHETD_SERVICE_HOST, RICOCHETD_PORT_50051_TCP and
// so on.
bool IsOfKubernetes(absl::string_view rest) {
  if (absl::StartsWith(rest, "SERVICE_") || rest == "PORT") return true;
  return absl::ConsumePrefix(&rest, "PORT_") && !rest.empty() &&
         absl::ascii_isdigit(static_cast<unsigned char>(rest.front()));
}

// Finds variables that look like options and are none. Those that are empty may stand for a protection that is wanted.
void CheckEnvironment(const CLI::App& app, std::vector<std::string>& violations) {
  std::vector<std::string> known;
  for (const std::string& name : OptionNames(app)) known.push_back(EnvironmentName(name));
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const absl::string_view variable(*entry, std::strcspn(*entry, "="));
    absl::string_view rest = variable;
    if (!absl::ConsumePrefix(&rest, kEnvironmentPrefix) || IsOfKubernetes(rest)) continue;
    const bool is_known = std::find(known.begin(), known.end(), variable) != known.end();
    const bool is_empty = absl::string_view(*entry).size() <= variable.size() + 1;
    if (is_known && is_empty) violations.push_back(absl::StrCat(variable, " = : ", kEmptyRule));
    if (is_known) continue;
    violations.push_back(absl::StrCat(variable, " in the environment is not an option", DidYouMean(variable, known)));
  }
}

// Finds "--name=", for whose value CLI11 would take the next argument.
void CheckArguments(int argc, const char* const* argv, std::vector<std::string>& violations) {
  for (int i = 1; i < argc; ++i) {
    absl::string_view name = argv[i];
    if (!absl::ConsumePrefix(&name, "--") || name.empty() || name.find('=') != name.size() - 1) continue;
    violations.push_back(Violated(std::string(absl::StripSuffix(name, "=")), "", kEmptyRule));
  }
}

absl::StatusOr<std::variant<Options, Notice>> Parse(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return Notice{app.help()};
  } catch (const CLI::CallForVersion& version) {
    return Notice{absl::StrCat(version.what(), "\n")};
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(absl::StrCat(InWords(app, error), "\nRun with --help for more."));
  }
  return Options();
}

// The options as the command line has them. An element of `given` points into `settings`.
struct CommandLine {
  std::unique_ptr<CLI::App> app;
  std::vector<std::vector<Setting>> settings;
  std::vector<Given> given;
};

CommandLine DeclareOptions() {
  CommandLine line;
  line.app = std::make_unique<CLI::App>(
      "ricochetd: answers what happens when something hits a surface with friction.\n"
      "Each option can also be set in the environment, as RICOCHETD_MAX_LIVE_CALLS=10, "
      "or in the file of --config, as max-live-calls = 10; a flag overrides the environment, "
      "which overrides the file.\n\nExample: ricochetd --listen 127.0.0.1:50051 --log-format json\n",
      "ricochetd");
  CLI::App& app = *line.app;
  app.set_help_flag("--help", "Print this help and exit");
  app.set_version_flag("--version",
                       absl::StrCat("ricochetd ", ThisEngine().version, " (engine ", ThisEngine().fingerprint, ")"));
  app.config_formatter(std::make_shared<BelowEnvironment>());
  app.allow_config_extras(CLI::config_extras_mode::error);
  const std::string file = FromEnvironment("config");
  app.set_config("--config", file, "Read options from this file (RICOCHETD_CONFIG)", !file.empty())
      ->option_text("FILE");

  line.settings = {NetworkSettings(), SecuritySettings(), RequestLimitSettings(),
                   CallSettings(),    DrainSettings(),    LogSettings()};
  const char* const groups[] = {"Network", "Security", "Limits of a request", "Calls", "Drain", "Log"};
  for (size_t i = 0; i < line.settings.size(); ++i) {
    const std::vector<Given> added = AddOptions(line.settings[i], groups[i], app);
    line.given.insert(line.given.end(), added.begin(), added.end());
  }
  return line;
}

}  // namespace

int64_t LeastCallMemoryMib(const Limits& limits) {
  constexpr int64_t kMiB = int64_t{1} << 20;
  constexpr int64_t kLeastMib = 32;
  // A batch takes at most twice its bytes. Its answer is held as a message and as bytes, and in each of them a
  // number takes 8 bytes and a regime at most 2.
  const int64_t of_peer = 2 * limits.max_request_bytes + 20 * limits.max_batch_numbers;
  return std::max(kLeastMib, (of_peer * 4 / 3 + kMiB - 1) / kMiB);
}

std::unique_ptr<CLI::App> MakeCommandLine() { return DeclareOptions().app; }

absl::StatusOr<std::variant<Options, Notice>> ParseCommandLine(int argc, const char* const* argv) {
  const CommandLine line = DeclareOptions();
  CLI::App& app = *line.app;
  std::vector<std::string> violations;
  CheckArguments(argc, argv, violations);
  if (!violations.empty()) return absl::InvalidArgumentError(absl::StrJoin(violations, "\n"));
  auto parsed = Parse(app, argc, argv);
  if (!parsed.ok() || std::holds_alternative<Notice>(*parsed)) return parsed;
  auto& options = std::get<Options>(*parsed);
  CheckEnvironment(app, violations);
  Read(line.given, absl::MakeConstSpan(argv, static_cast<size_t>(argc)), options, violations);
  LiveCallLimits& calls = options.live_calls;
  const auto or_default = [&app](const char* flag, int default_limit, int& limit) {
    if (app.count(flag) == 0) limit = default_limit;
  };
  or_default("--max-live-calls-per-peer", CallsPerPeerFor(calls.calls), calls.calls_per_peer);
  or_default("--max-streams", StreamsFor(calls.calls), calls.streams);
  or_default("--max-streams-per-peer", StreamsPerPeerFor(calls.streams), calls.streams_per_peer);
  or_default("--max-connections-per-peer", std::min(options.connections.per_peer, options.connections.in_all),
             options.connections.per_peer);
  or_default("--max-threads", calls.calls + Options::kSpareThreads, options.max_threads);
  if (app.count("--call-memory") == 0) {
    options.call_memory_mib = std::max(options.call_memory_mib, LeastCallMemoryMib(options.limits));
  }
  CheckTogether(options, violations);
  if (!violations.empty()) return absl::InvalidArgumentError(absl::StrJoin(violations, "\n"));
  return parsed;
}

ServerLimits ServerLimitsOf(const Options& options) {
  return {.max_message_bytes = std::min(kMostBytes, options.limits.max_request_bytes),
          .max_metadata_bytes = kMaxMetadataBytes,
          .max_calls_per_connection = kMaxCallsPerConnection,
          .max_connections = options.connections.in_all,
          .max_connections_per_peer = options.connections.per_peer,
          .max_live_calls = options.live_calls.calls,
          .max_live_calls_per_peer = options.live_calls.calls_per_peer,
          .max_streams = options.live_calls.streams,
          .max_streams_per_peer = options.live_calls.streams_per_peer,
          .max_waiting_calls = options.max_waiting_calls,
          .max_unary_time_ms = options.time_limits.unary_time.count(),
          .max_stream_age_ms = options.time_limits.stream_age.count(),
          .write_stall_timeout_ms = options.unread_limit.count()};
}

}  // namespace ricochet::server
