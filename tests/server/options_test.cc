#include "server/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "ricochet/engine_info.h"
#include "ricochet/limits.h"
#include "tests/support/paths.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::StartsWith;

// The command line, the environment and the file with which a server is started.
struct Given {
  std::vector<std::string> flags;
  std::vector<std::pair<std::string, std::string>> environment;
  std::string file;  // The contents of the file of --config; empty if the flag is not given.
};

class Environment {
 public:
  explicit Environment(const std::vector<std::pair<std::string, std::string>>& variables) {
    for (const auto& [name, value] : variables) {
      names_.push_back(name);
      setenv(name.c_str(), value.c_str(), 1);
    }
  }
  ~Environment() {
    for (const std::string& name : names_) unsetenv(name.c_str());
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::vector<std::string> names_;
};

std::string WriteConfig(const std::string& name, const std::string& contents) {
  std::string path = testing::TempDir() + "ricochetd_" + name + ".toml";
  std::ofstream(path) << contents;
  return path;
}

absl::StatusOr<std::variant<Options, Notice>> Parse(const std::string& name, const Given& given) {
  const Environment environment(given.environment);
  std::vector<std::string> arguments = {"ricochetd"};
  if (!given.file.empty()) {
    arguments.insert(arguments.end(), {"--config", WriteConfig(name, given.file)});
  }
  arguments.insert(arguments.end(), given.flags.begin(), given.flags.end());
  std::vector<const char*> argv;
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  return ParseCommandLine(static_cast<int>(argv.size()), argv.data());
}

ListenAddress Tcp(const char* host, int port) { return {.host = host, .port = port, .path = ""}; }

struct GoodCase {
  std::string name;
  Given given;
  std::function<void(Options&)> expect;  // Changes the defaults to what is expected.
};

class GoodOptions : public testing::TestWithParam<GoodCase> {};

TEST_P(GoodOptions, AreTaken) {
  Options expected;
  GetParam().expect(expected);
  const auto parsed = Parse(GetParam().name, GetParam().given);
  ASSERT_TRUE(parsed.ok()) << parsed.status();
  ASSERT_TRUE(std::holds_alternative<Options>(*parsed));
  EXPECT_TRUE(std::get<Options>(*parsed) == expected);
}

std::vector<GoodCase> GoodCases() {
  return {
      {"Defaults", {}, [](Options&) {}},
      {"Listen", {.flags = {"--listen", "localhost:0"}}, [](Options& o) { o.listen = {Tcp("localhost", 0)}; }},
      {"ListenIpv6", {.flags = {"--listen=[::1]:7"}}, [](Options& o) { o.listen = {Tcp("::1", 7)}; }},
      {"OpenIfInsecure",
       {.flags = {"--listen", "0.0.0.0:65535", "--insecure"}},
       [](Options& o) {
         o.listen = {Tcp("0.0.0.0", 65535)};
         o.insecure = true;
       }},
      {"InsecureByEnvironment",
       {.flags = {"--listen", "[::]:1"}, .environment = {{"RICOCHETD_INSECURE", "1"}}},
       [](Options& o) {
         o.listen = {Tcp("::", 1)};
         o.insecure = true;
       }},
      {"InsecureByFile",
       {.file = "insecure = true\nlisten = \"ricochet.example:1\"\n"},
       [](Options& o) {
         o.listen = {Tcp("ricochet.example", 1)};
         o.insecure = true;
       }},
      {"Several",
       {.file = "listen = \"127.0.0.1:0,unix:/run/r.sock\"\nsocket-mode = 660\n"},
       [](Options& o) {
         o.listen = {Tcp("127.0.0.1", 0), {.host = "", .path = "/run/r.sock"}};
         o.socket_mode = 0660;
       }},
      {"Reflection",
       {.flags = {"--reflection", "unix:/run/r.sock"}},
       [](Options& o) { o.reflection = {{.host = "", .path = "/run/r.sock"}}; }},
      {"OpenByTls",
       {.flags = {"--listen", "0.0.0.0:1", "--tls-cert", "c", "--tls-key", "k", "--tls-client-ca", "a", "--tokens",
                  "t"}},
       [](Options& o) {
         o.listen = {Tcp("0.0.0.0", 1)};
         o.tls = {.certificate = "c", .key = "k", .client_ca = "a"};
         o.tokens = "t";
       }},
      {"Connections",
       {.flags = {"--max-connections", "9", "--max-connections-per-peer", "8", "--transport-memory", "7",
                  "--call-memory", "160"}},
       [](Options& o) {
         o.connections = {.in_all = 9, .per_peer = 8};
         o.transport_memory_mib = 7;
         o.call_memory_mib = 160;
       }},
      {"PortFile", {.flags = {"--port-file", "/run/a b"}}, [](Options& o) { o.port_file = "/run/a b"; }},
      {"ThreadsFollowCalls",
       {.flags = {"--max-live-calls", "1"}},
       [](Options& o) {
         o.live_calls = {.calls = 1, .calls_per_peer = 1, .streams = 1, .streams_per_peer = 1};
         o.max_threads = 129;
       }},
      {"FewestThreads",
       {.flags = {"--max-live-calls", "16", "--max-threads", "144"}},
       [](Options& o) {
         o.live_calls = {.calls = 16, .calls_per_peer = 14, .streams = 4, .streams_per_peer = 3};
         o.max_threads = 144;
       }},
      {"Places",
       {.flags = {"--max-live-calls-per-peer", "5", "--max-streams", "7", "--max-streams-per-peer", "6"}},
       [](Options& o) { o.live_calls = {.calls = 1024, .calls_per_peer = 5, .streams = 7, .streams_per_peer = 6}; }},
      {"StreamsOfAPeerFollowStreams",
       {.flags = {"--max-streams", "100"}},
       [](Options& o) {
         o.live_calls.streams = 100;
         o.live_calls.streams_per_peer = 75;
       }},
      {"ConnectionsOfAPeerFollowConnections",
       {.flags = {"--max-connections", "10"}},
       [](Options& o) { o.connections = {.in_all = 10, .per_peer = 10}; }},
      {"Compute",
       {.flags = {"--compute-threads", "3", "--max-waiting-calls", "4"}},
       [](Options& o) {
         o.compute_threads = 3;
         o.max_waiting_calls = 4;
       }},
      {"TimeLimits",
       {.flags = {"--max-unary-time", "0.001", "--max-stream-age", "60", "--write-stall-timeout", "2.5"}},
       [](Options& o) {
         o.time_limits = {.unary_time = milliseconds(1), .stream_age = milliseconds(60'000)};
         o.unread_limit = milliseconds(2500);
       }},
      {"TransportTimes",
       {.flags = {"--handshake-timeout", "0.5"}, .file = "idle-timeout = 3600\n"},
       [](Options& o) { o.transport_times = {.handshake = milliseconds(500), .idle = milliseconds(3'600'000)}; }},
      {"MostPoints",
       {.flags = {"--max-points-per-sweep", "9007199254740992"}},
       [](Options& o) { o.limits.max_points_per_sweep = int64_t{1} << 53; }},
      {"LimitsOfARequest",
       {.flags = {"--max-links", "7"}, .file = "max-history-numbers = 12\n"},
       [](Options& o) {
         o.limits.max_links = 7;
         o.limits.max_history_numbers = 12;
       }},
      {"Log",
       {.flags = {"--log-format", "json", "--log-level", "debug", "--log-file", "a b", "--log-calls", "slow:2"}},
       [](Options& o) {
         o.log_format = LogFormat::kJson;
         o.log_level = LogLevel::kDebug;
         o.log_file = "a b";
         o.log_calls = {.kind = CallRule::Kind::kSlow, .count = 100, .slow = milliseconds(2000)};
       }},
      {"Metrics", {.flags = {"--metrics", "[::1]:9464"}}, [](Options& o) { o.metrics = Tcp("::1", 9464); }},
      {"OpenMetricsBesideTokens",
       {.flags = {"--metrics", "0.0.0.0:1", "--insecure", "--tokens", "tok"}},
       [](Options& o) {
         o.metrics = Tcp("0.0.0.0", 1);
         o.insecure = true;
         o.tokens = "tok";
       }},
      {"Drain",
       {.flags = {"--drain-grace", "0", "--drain-timeout", "0.25"}},
       [](Options& o) {
         o.drain_grace = milliseconds(0);
         o.drain_timeout = milliseconds(250);
       }},
      {"Environment",
       {.environment = {{"RICOCHETD_DRAIN_GRACE", "7"}}},
       [](Options& o) { o.drain_grace = milliseconds(7000); }},
      {"File",
       {.file = "# comment\ndrain-grace = 6.5\nlog-level = \"error\"\n"},
       [](Options& o) {
         o.drain_grace = milliseconds(6500);
         o.log_level = LogLevel::kError;
       }},
      {"FlagBeforeEnvironmentBeforeFile",
       {.flags = {"--drain-grace", "1"},
        .environment = {{"RICOCHETD_DRAIN_GRACE", "2"}, {"RICOCHETD_DRAIN_TIMEOUT", "2"}},
        .file = "drain-grace = 3\ndrain-timeout = 3\nlog-level = \"error\"\n"},
       [](Options& o) {
         o.drain_grace = milliseconds(1000);
         o.drain_timeout = milliseconds(2000);
         o.log_level = LogLevel::kError;
       }},
  };
}

INSTANTIATE_TEST_SUITE_P(Table, GoodOptions, testing::ValuesIn(GoodCases()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Options, ConfigFileIsNamedByTheEnvironmentToo) {
  const std::string path = WriteConfig("environment", "max-live-calls = 5\n");
  const auto parsed = Parse("", {.environment = {{"RICOCHETD_CONFIG", path}}});
  ASSERT_TRUE(parsed.ok()) << parsed.status();
  EXPECT_EQ(std::get<Options>(*parsed).live_calls.calls, 5);
}

struct BadCase {
  std::string name;
  Given given;
  std::vector<std::string> message;  // Texts that the error message contains.
};

class BadOptions : public testing::TestWithParam<BadCase> {};

TEST_P(BadOptions, AreNamedWithValueAndRule) {
  const auto parsed = Parse(GetParam().name, GetParam().given);
  ASSERT_EQ(parsed.status().code(), absl::StatusCode::kInvalidArgument);
  for (const std::string& part : GetParam().message) {
    EXPECT_THAT(std::string(parsed.status().message()), HasSubstr(part));
  }
}

std::vector<BadCase> BadCases() {
  return {
      {"NoPort", {.flags = {"--listen", "localhost"}}, {"--listen = localhost: must be HOST:PORT"}},
      {"PortTooLarge", {.flags = {"--listen", "localhost:65536"}}, {"--listen = localhost:65536: must"}},
      {"MinusZeroAsPort", {.flags = {"--listen=localhost:-0"}}, {"--listen = localhost:-0: must"}},
      {"NegativePort", {.flags = {"--listen=localhost:-1"}}, {"--listen = localhost:-1: must"}},
      {"NoHost", {.flags = {"--listen", ":1"}}, {"--listen = :1: must be HOST:PORT"}},
      {"BareIpv6", {.flags = {"--listen", "::1:1"}}, {"--listen = ::1:1: must", "in brackets"}},
      {"NotIpv6", {.flags = {"--listen", "[1]:1"}}, {"--listen = [1]:1: must"}},
      {"OneOfSeveral", {.flags = {"--listen", "localhost:1,,"}}, {"--listen = localhost:1,,: must be HOST:PORT"}},
      {"UnixWithoutPath", {.flags = {"--listen", "unix:"}}, {"--listen = unix:: must be HOST:PORT", "unix:PATH"}},
      {"SocketMode", {.flags = {"--socket-mode", "0668"}}, {"--socket-mode = 0668: must be permissions in octal"}},
      {"PortOfAUnixSocket",
       {.flags = {"--listen", "unix:/run/r.sock", "--port-file", "/run/port"}},
       {"--port-file = /run/port: needs HOST:PORT in --listen"}},
      {"SecondIsOpen",
       {.flags = {"--listen", "127.0.0.1:1,0.0.0.0:1"}},
       {"--listen = 0.0.0.0:1: must be a loopback address"}},
      {"ReflectionIsOpen",
       {.flags = {"--reflection", "0.0.0.0:1"}},
       {"--reflection = 0.0.0.0:1: must be a loopback address"}},
      {"TokensUnencrypted",
       {.flags = {"--listen", "0.0.0.0:1", "--insecure", "--tokens", "t"}},
       {"--listen = 0.0.0.0:1: needs --tls-cert, as --tokens would travel unencrypted"}},
      {"CertificateWithoutKey", {.flags = {"--tls-cert", "c"}}, {"--tls-cert = c: needs --tls-key"}},
      {"KeyWithoutCertificate", {.flags = {"--tls-key", "k"}}, {"--tls-key = k: needs --tls-cert"}},
      {"ClientsWithoutTls", {.flags = {"--tls-client-ca", "a"}}, {"--tls-client-ca = a: needs --tls-cert"}},
      {"NoConnections",
       {.flags = {"--max-connections", "0"}},
       {"--max-connections = 0: must be an integer from 1 to 1000000"}},
      {"OpenButNotInsecure",
       {.flags = {"--listen", "0.0.0.0:1"}},
       {"--listen = 0.0.0.0:1: must be a loopback address", "--insecure"}},
      {"NameButNotInsecure",
       {.flags = {"--listen", "localhost.example:1"}},
       {"--listen = localhost.example:1: must be a loopback address"}},
      {"InsecureNoBoolean",
       {.environment = {{"RICOCHETD_INSECURE", "maybe"}}},
       {"RICOCHETD_INSECURE = maybe: must be one of true"}},
      {"NoCalls", {.flags = {"--max-live-calls", "0"}}, {"--max-live-calls = 0: must be an integer from 1 to 65536"}},
      {"CallsNoNumber", {.flags = {"--max-live-calls", "10x"}}, {"--max-live-calls = 10x: must"}},
      {"CallsOverflow", {.flags = {"--max-live-calls", "4294967297"}}, {"--max-live-calls = 4294967297: must"}},
      {"TooFewThreads", {.flags = {"--max-threads", "1151"}}, {"--max-threads = 1151: must be >= 1152"}},
      {"NoUnaryTime",
       {.flags = {"--max-unary-time", "0"}},
       {"--max-unary-time = 0: must be a number of seconds from 0.001 to 3600"}},
      {"NoStallTimeout", {.flags = {"--write-stall-timeout", "never"}}, {"--write-stall-timeout = never: must"}},
      {"NoIdleTimeout", {.flags = {"--idle-timeout", "0"}}, {"--idle-timeout = 0: must be a number of sec"}},
      {"LongHandshake", {.flags = {"--handshake-timeout", "3601"}}, {"--handshake-timeout = 3601: must"}},
      {"NoComputeThreads", {.flags = {"--compute-threads", "0"}}, {"--compute-threads = 0: must be an integer"}},
      {"PointsNoInteger",
       {.flags = {"--max-points-per-sweep", "1e6"}},
       {"--max-points-per-sweep = 1e6: must be an integer from 1 to 9007199254740992"}},
      {"NegativeGrace", {.flags = {"--drain-grace=-1"}}, {"--drain-grace = -1: must be a number of seconds"}},
      {"GraceNan", {.flags = {"--drain-grace", "nan"}}, {"--drain-grace = nan: must"}},
      {"TimeoutTooLong", {.flags = {"--drain-timeout", "3601"}}, {"--drain-timeout = 3601: must"}},
      {"LogFormat", {.flags = {"--log-format", "xml"}}, {"--log-format = xml: must be one of text, json"}},
      {"LogLevelInFile", {.file = "log-level = loud\n"}, {"--config: log-level = loud: must be one of debug"}},
      {"MetricsOnAUnixSocket", {.flags = {"--metrics", "unix:/run/m"}}, {"--metrics = unix:/run/m: must be HOST"}},
      {"OpenMetrics", {.flags = {"--metrics", "0.0.0.0:9464"}}, {"--metrics = 0.0.0.0:9464: must be a loop"}},
      {"OpenMetricsBesideTls",
       {.flags = {"--metrics", "[::]:9464", "--tls-cert", "c.pem", "--tls-key", "k.pem"}},
       {"--metrics = [::]:9464: must be a loop"}},
      {"EmptyLogFile", {.flags = {"--log-file", ""}}, {"--log-file = : must not be empty"}},
      {"LogCalls", {.flags = {"--log-calls", "some"}}, {"--log-calls = some: must be all, errors, slow:"}},
      {"EmptyPortFile", {.flags = {"--port-file", ""}}, {"--port-file = : must not be empty"}},
      {"EmptyAfterEquals",
       {.flags = {"--port-file=", "--tls-client-ca=ca.pem", "--insecure="}},
       {"--port-file = : must not be empty\n--insecure = : must not be empty"}},
      {"OptionForValue",
       {.flags = {"--log-file", "--tokens=tok"}},
       {"--log-file = --tokens=tok: must be a value, not an option"}},
      {"EmptyVariables",
       {.environment = {{"RICOCHETD_TOKENS", ""}, {"RICOCHETD_CONFIG", ""}, {"RICOCHETD_INSECURE", ""}},
        .file = "tokens = \"tok\"\n"},
       {"RICOCHETD_TOKENS = : must not be empty", "RICOCHETD_CONFIG = : must not be empty",
        "RICOCHETD_INSECURE = : must not be empty"}},
      {"AllAtOnce",
       {.flags = {"--listen", "nowhere"},
        .environment = {{"RICOCHETD_MAX_LIVE_CALLS", "many"}},
        .file = "drain-grace = soon\n"},
       {"--listen = nowhere", "\nRICOCHETD_MAX_LIVE_CALLS = many", "\n--config: drain-grace = soon"}},
      {"UnknownFlag",
       {.flags = {"--max-live-call", "1"}},
       {"--max-live-call is not an option; did you mean --max-live-calls?"}},
      {"UnknownKey",
       {.file = "max_live_calls = 1\n"},
       {"--config: max_live_calls is not an option; did you mean max-live-calls?"}},
      {"UnknownVariable",
       {.environment = {{"RICOCHETD_MAX_LIVE_CALL", "1"}}},
       {"RICOCHETD_MAX_LIVE_CALL in the environment is not an option; did you mean RICOCHETD_MAX_LIVE_CALLS?"}},
      {"Positional", {.flags = {"localhost:1"}}, {"localhost:1 is not expected: must follow an option"}},
      {"Twice", {.flags = {"--drain-grace", "1", "--drain-grace", "2"}}, {"--drain-grace: must be given once, with"}},
      {"NoValue", {.flags = {"--drain-grace"}}, {"--drain-grace: must be given once, with a value"}},
      {"Section", {.file = "[limits]\ndrain-grace = 1\n"}, {"--config: [limits]: the file must have no sec"}},
      {"NoSuchFile", {.flags = {"--config", "/nonexistent.toml"}}, {"/nonexistent.toml"}},
      {"NoSuchFileByEnvironment", {.environment = {{"RICOCHETD_CONFIG", "/nonexistent.toml"}}}, {"/nonexistent.toml"}},
  };
}

INSTANTIATE_TEST_SUITE_P(Table, BadOptions, testing::ValuesIn(BadCases()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Options, TakesNoVariableOfKubernetesForAnOption) {
  const auto parsed = Parse("", {.environment = {{"RICOCHETD_SERVICE_HOST", "10.0.0.1"},
                                                 {"RICOCHETD_SERVICE_PORT_GRPC", "50051"},
                                                 {"RICOCHETD_PORT", "tcp://10.0.0.1:50051"},
                                                 {"RICOCHETD_PORT_50051_TCP_ADDR", "10.0.0.1"}}});
  EXPECT_TRUE(parsed.ok()) << parsed.status();
}

// The range of every option that is a number, as server/options.h and ricochet/limits.h state it; the default of the
// other options allows all of them.
std::map<std::string, std::pair<std::string, std::string>> Ranges() {
  std::map<std::string, std::pair<std::string, std::string>> ranges;
  for (const char* const name :
       {"max-live-calls", "max-live-calls-per-peer", "max-streams", "max-streams-per-peer", "max-waiting-calls"}) {
    ranges[name] = {"1", "65536"};
  }
  for (const char* const name : {"max-connections", "max-connections-per-peer"}) ranges[name] = {"1", "1000000"};
  for (const char* const name :
       {"handshake-timeout", "idle-timeout", "max-unary-time", "max-stream-age", "write-stall-timeout"}) {
    ranges[name] = {"0.001", "3600"};
  }
  for (const char* const name : {"drain-grace", "drain-timeout"}) ranges[name] = {"0", "3600"};
  ranges["max-threads"] = {"1152", "1048576"};
  ranges["compute-threads"] = {"1", "1024"};
  ranges["transport-memory"] = {"1", "1048576"};
  ranges["call-memory"] = {"96", "1048576"};
  for (const NamedLimit& limit : kLimits) {
    ranges[absl::StrReplaceAll(limit.name, {{"_", "-"}})] = {"1", std::to_string(limit.most)};
  }
  return ranges;
}

TEST(Options, TheLimitsThatAServerStatesAreThoseItKeeps) {
  const auto stated = [](const char* bytes) {
    const auto parsed = Parse("", {.flags = {"--max-request-bytes", bytes}});
    return parsed.ok() ? ServerLimitsOf(std::get<Options>(*parsed)).max_message_bytes : -1;
  };
  EXPECT_EQ(stated("2000"), 2000);
  EXPECT_EQ(stated("16777216"), int64_t{1} << 20) << "a request that is no batch";
}

TEST(Options, TheMemoryOfCallsHoldsTheLargestBatchAndItsAnswer) {
  const auto large = Parse("", {.flags = {"--max-request-bytes", "268435456"}});
  ASSERT_TRUE(large.ok()) << large.status();
  EXPECT_EQ(std::get<Options>(*large).call_memory_mib, 736) << "4/3 of twice 256 MiB and 40 MiB";
  const auto small = Parse("", {.flags = {"--max-request-bytes", "1048576", "--call-memory", "56"}});
  EXPECT_TRUE(small.ok()) << small.status();
  const auto wrong = Parse("", {.flags = {"--max-request-bytes", "1048576", "--call-memory", "55"}});
  EXPECT_EQ(wrong.status().message(),
            "--call-memory = 55: must be >= 56: three quarters of it must hold the largest batch, by "
            "--max-request-bytes, and its answer, by --max-batch-numbers");
  const auto tiny =
      Parse("", {.flags = {"--max-request-bytes", "1", "--max-batch-numbers", "1", "--call-memory", "31"}});
  EXPECT_THAT(std::string(tiny.status().message()), HasSubstr("must be >= 32"));
}

TEST(Options, EveryNumberIsTakenFromItsLeastToItsMostAndNotBeyond) {
  const std::string help = std::get<Notice>(Parse("", {.flags = {"--help"}}).value()).text;
  const std::regex line(R"(--([a-z-]+) (N|MIB|SECONDS)\b)");
  const auto ranges = Ranges();
  int found = 0;
  for (std::sregex_iterator match(help.begin(), help.end(), line), end; match != end; ++match, ++found) {
    const std::string name = (*match)[1];
    ASSERT_TRUE(ranges.contains(name)) << name;
    const auto& [least, most] = ranges.at(name);
    const bool is_time = (*match)[2] == "SECONDS";
    const std::string below = is_time ? (least == "0" ? "-0.001" : "0.0004") : std::to_string(std::stoll(least) - 1);
    const std::string above = is_time ? "3600.001" : std::to_string(std::stoll(most) + 1);
    const auto is_taken = [&name](const std::string& value) {
      std::vector<std::string> flags = {absl::StrCat("--", name, "=", value)};
      // A part may be as large as the whole.
      if (name == "max-streams-per-peer") flags.emplace_back("--max-streams=65536");
      if (name == "max-live-calls-per-peer" || name.starts_with("max-streams"))
        flags.emplace_back("--max-live-calls=65536");
      if (name == "max-connections-per-peer") flags.emplace_back("--max-connections=1000000");
      return Parse("", {.flags = flags}).ok();
    };
    for (const std::string& value : {least, most}) EXPECT_TRUE(is_taken(value)) << name << " " << value;
    for (const std::string& value : {below, above}) EXPECT_FALSE(is_taken(value)) << name << " " << value;
  }
  EXPECT_EQ(found, static_cast<int>(ranges.size()));
}

TEST(Options, APartBeyondItsWholeIsRefused) {
  const char* const pairs[][2] = {{"max-live-calls-per-peer", "max-live-calls"},
                                  {"max-streams", "max-live-calls"},
                                  {"max-streams-per-peer", "max-streams"},
                                  {"max-connections-per-peer", "max-connections"}};
  for (const auto& [part, whole] : pairs) {
    const auto parsed = Parse("", {.flags = {absl::StrCat("--", whole, "=10"), absl::StrCat("--", part, "=11")}});
    EXPECT_THAT(std::string(parsed.status().message()),
                testing::HasSubstr(absl::StrCat("--", part, " = 11: must be <= 10, that of --", whole)));
  }
}

TEST(Options, PermissionsAreThoseOfNineBits) {
  for (const char* const mode : {"0", "600", "0777"}) EXPECT_TRUE(Parse("", {.flags = {"--socket-mode", mode}}).ok());
  for (const char* const mode : {"1000", "4755", "-1", "", "0o600"}) {
    EXPECT_FALSE(Parse("", {.flags = {std::string("--socket-mode=") + mode}}).ok()) << mode;
  }
  EXPECT_EQ(Options().socket_mode, 0600U);
}

TEST(Options, HelpNamesEveryOption) {
  const auto parsed = Parse("", {.flags = {"--help"}});
  ASSERT_TRUE(parsed.ok() && std::holds_alternative<Notice>(*parsed));
  for (const char* option : {"--config",
                             "--listen",
                             "--port-file",
                             "--insecure",
                             "--tls-cert",
                             "--tls-key",
                             "--tls-client-ca",
                             "--tokens",
                             "--socket-mode",
                             "--reflection",
                             "--max-connections",
                             "--max-connections-per-peer",
                             "--transport-memory",
                             "--call-memory",
                             "--handshake-timeout",
                             "--idle-timeout",
                             "--max-live-calls",
                             "--max-live-calls-per-peer",
                             "--max-streams",
                             "--max-streams-per-peer",
                             "--max-threads",
                             "--compute-threads",
                             "--max-waiting-calls",
                             "--max-unary-time",
                             "--max-stream-age",
                             "--write-stall-timeout",
                             "--max-points-per-sweep",
                             "--max-links",
                             "--max-audit-rows",
                             "--drain-grace",
                             "--drain-timeout",
                             "--log-format",
                             "--log-level",
                             "--log-file",
                             "--log-calls",
                             "--version"}) {
    EXPECT_THAT(std::get<Notice>(*parsed).text, HasSubstr(option));
  }
}

TEST(Options, TheTableOfLimitsInTheReadmeHasEachFlagWithItsDefault) {
  std::ifstream file(SourceRoot() + "/deploy/README.md");
  const std::string readme((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  for (const NamedLimit& limit : kLimits) {
    std::string flag = limit.name;
    std::replace(flag.begin(), flag.end(), '_', '-');
    const std::string row = "| `--" + flag + " N` | " + std::to_string(Limits().*limit.value) + " |";
    EXPECT_THAT(readme, HasSubstr(row));
  }
}

TEST(Options, VersionIsThatOfTheEngine) {
  const auto parsed = Parse("", {.flags = {"--version"}});
  ASSERT_TRUE(parsed.ok() && std::holds_alternative<Notice>(*parsed));
  EXPECT_THAT(std::get<Notice>(*parsed).text, StartsWith("ricochetd " + ThisEngine().version));
}

}  // namespace
}  // namespace ricochet::server
