// Rooms: which room may include which, as the tables of docs/architecture.md say, held against the #include lines of
// every source file.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHouses[] = {"core", "proto/wire", "proto/text", "proto/comments", "client", "python", "server"};

// The core must not include these standard headers: it knows no stream, file, environment, process, thread or clock.
const std::set<std::string>& BarredFromCore() {
  static const std::set<std::string> barred = {"iostream", "istream",  "ostream",      "fstream",
                                               "sstream",  "cstdio",   "filesystem",   "thread",
                                               "mutex",    "future",   "ctime",        "csignal",
                                               "stdio.h",  "time.h",   "unistd.h",     "locale",
                                               "random",   "regex",    "atomic",       "condition_variable",
                                               "cstdlib",  "stdlib.h", "shared_mutex", "syncstream"};
  return barred;
}

// This file writes the reason why the process aborts, and needs a stream for it.
constexpr char kLastWords[] = "core/base/invariant.cc";

// Some files compare the deadline of a call with the clock, some how long a call has lasted before
// others help it, one how soon the reader of a stream comes back, and two measure the time that a method takes.
const std::set<std::string>& ReadersOfTheClock() {
  static const std::set<std::string> files = {"core/include/ricochet/call_options.h",
                                              "core/engine/call_control.h",
                                              "core/engine/call_control.cc",
                                              "core/engine/chunk_size.h",
                                              "core/engine/local_solver.cc",
                                              "core/engine/helped_run.h",
                                              "core/engine/helped_run.cc",
                                              "core/engine/sweep_run.cc",
                                              "core/cost/stopwatch.h",
                                              "core/cost/stopwatch.cc"};
  return files;
}

// The files of the threads that help a sweep or a batch, and of what these share.
const std::set<std::string>& KeepersOfThreads() {
  static const std::set<std::string> files = {"core/engine/helped_run.h",      "core/engine/helper_threads.h",
                                              "core/engine/helper_threads.cc", "core/engine/piece_run.h",
                                              "core/engine/piece_run.cc",      "core/engine/pool.h",
                                              "core/engine/sweep_run.cc"};
  return files;
}

const std::set<std::string>& HeadersOfThreads() {
  static const std::set<std::string> headers = {"atomic",  "condition_variable", "mutex", "sys/types.h", "thread",
                                                "unistd.h"};
  return headers;
}

struct Include {
  std::string file;
  std::string header;
};

fs::path Root() { return fs::path(SourceRoot()); }

std::string RelativePath(const fs::path& path) { return fs::relative(path, Root()).generic_string(); }

bool IsSource(const fs::path& path) { return path.extension() == ".h" || path.extension() == ".cc"; }

std::vector<fs::path> SourcesOf(const std::string& folder) {
  std::vector<fs::path> sources;
  for (const auto& entry : fs::recursive_directory_iterator(Root() / folder)) {
    if (entry.is_regular_file() && IsSource(entry.path())) sources.push_back(entry.path());
  }
  std::sort(sources.begin(), sources.end());
  return sources;
}

std::vector<Include> IncludesOf(const std::string& folder) {
  static const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  for (const fs::path& path : SourcesOf(folder)) {
    std::ifstream file(path);
    std::smatch match;
    for (std::string line; std::getline(file, line);) {
      if (std::regex_search(line, match, pattern)) includes.push_back({RelativePath(path), match[1]});
    }
  }
  return includes;
}

bool StartsWithAny(const std::string& text, const std::vector<std::string>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const std::string& prefix) { return text.rfind(prefix, 0) == 0; });
}

// Standard C++ headers have no folder, but some headers of POSIX have.
bool IsSystemHeader(const std::string& header) {
  return header.find('/') == std::string::npos || StartsWithAny(header, {"arpa/", "netinet/", "sys/"});
}

// A room: a folder, its floor, and what it may include beside lower floors of its own table.
struct Room {
  std::string table;
  int floor = 0;
  std::vector<std::string> allowed;
};

// Returns all texts in backticks.
std::vector<std::string> Quoted(const std::string& cell) {
  static const std::regex pattern("`([^`]+)`");
  std::vector<std::string> texts;
  for (std::sregex_iterator match(cell.begin(), cell.end(), pattern), end; match != end; ++match) {
    texts.push_back((*match)[1]);
  }
  return texts;
}

std::string WithoutSlash(const std::string& folder) { return folder.substr(0, folder.find_last_not_of('/') + 1); }

// The rooms by their folders, read off the tables of docs/architecture.md.
std::map<std::string, Room> ReadRooms() {
  static const std::regex row(R"(^\| (\d+) \| ([^|]*) \|[^|]*\|([^|]*)\|$)");
  std::map<std::string, Room> rooms;
  std::ifstream file(Root() / "docs/architecture.md");
  std::string table;
  std::smatch match;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("###", 0) == 0) table = line;
    if (!std::regex_match(line, match, row)) continue;
    for (const std::string& folder : Quoted(match[2])) {
      rooms[WithoutSlash(folder)] = {.table = table, .floor = std::stoi(match[1]), .allowed = Quoted(match[3])};
    }
  }
  return rooms;
}

const std::map<std::string, Room>& Rooms() {
  static const std::map<std::string, Room> rooms = ReadRooms();
  return rooms;
}

std::string FolderOf(const std::string& file) { return file.substr(0, file.rfind('/')); }

// The path of one of our own headers.
std::string FileOf(const std::string& header) {
  if (header.rfind("ricochet/", 0) != 0) return header;
  return (fs::exists(Root() / "client/include" / header) ? "client/include/" : "core/include/") + header;
}

// True if the table of rooms lets `from` include the header.
bool MayInclude(const Room& from, const Include& include) {
  if (StartsWithAny(include.header, {"absl/"}) || StartsWithAny(include.header, from.allowed)) return true;
  const auto to = Rooms().find(FolderOf(FileOf(include.header)));
  if (to == Rooms().end()) return IsSystemHeader(include.header);
  if (to->first == FolderOf(include.file)) return true;
  if (to->second.table == from.table) return to->second.floor < from.floor;
  const bool is_of_the_client = include.file.rfind("client/", 0) == 0;
  return to->first == "core/include/ricochet" || (to->first == "client/include/ricochet" && is_of_the_client);
}

TEST(RoomsTest, AnIncludeStaysInItsRoomOrGoesDownOrWhereTheTableSays) {
  for (const std::string folder : kHouses) {
    for (const Include& include : IncludesOf(folder)) {
      const auto room = Rooms().find(FolderOf(include.file));
      ASSERT_NE(room, Rooms().end()) << include.file << " lies in a folder that docs/architecture.md does not list";
      EXPECT_TRUE(MayInclude(room->second, include)) << include.file << " includes " << include.header;
    }
  }
}

TEST(RoomsTest, EveryRoomOfTheTablesHasSources) {
  EXPECT_EQ(Rooms().size(), 48U);
  for (const auto& [folder, room] : Rooms()) EXPECT_FALSE(SourcesOf(folder).empty()) << folder;
}

// Everything that can be reached along `edges`, by its start.
std::map<std::string, std::set<std::string>> Closure(std::map<std::string, std::set<std::string>> edges) {
  for (size_t i = 0; i < edges.size(); ++i) {
    bool has_grown = false;
    for (auto& [from, all] : edges) {
      const size_t before = all.size();
      for (const std::string& to : std::set<std::string>(all)) {
        if (const auto next = edges.find(to); next != edges.end()) all.insert(next->second.begin(), next->second.end());
      }
      has_grown = has_grown || all.size() > before;
    }
    if (!has_grown) break;
  }
  return edges;
}

TEST(RoomsTest, NoHeadersAndNoFoldersIncludeEachOther) {
  std::map<std::string, std::set<std::string>> headers;
  std::map<std::string, std::set<std::string>> folders;
  for (const std::string folder : kHouses) {
    for (const Include& include : IncludesOf(folder)) {
      const std::string to = FileOf(include.header);
      if (!Rooms().contains(FolderOf(to))) continue;
      if (fs::path(include.file).extension() == ".h") headers[include.file].insert(to);
      if (FolderOf(include.file) != FolderOf(to)) folders[FolderOf(include.file)].insert(FolderOf(to));
    }
  }
  for (const auto& edges : {headers, folders}) {
    for (const auto& [from, all] : Closure(edges)) EXPECT_FALSE(all.contains(from)) << from << " reaches itself";
  }
}

// An installed header must not include one that is not installed.
TEST(FloorsTest, PublicHeadersIncludePublicHeadersAlone) {
  for (const std::string folder : {"core/include", "client/include"}) {
    for (const Include& include : IncludesOf(folder)) {
      const bool is_adaptor = include.file == "core/include/ricochet/eigen.h" && include.header == "Eigen/Core";
      EXPECT_TRUE(IsSystemHeader(include.header) || StartsWithAny(include.header, {"ricochet/", "absl/"}) || is_adaptor)
          << include.file << " includes " << include.header;
      EXPECT_FALSE(StartsWithAny(include.header, {"ricochet/v1/"})) << include.file << " includes " << include.header;
    }
  }
}

TEST(RoomsTest, TheCoreKnowsNoStreamFileEnvironmentThreadOrClock) {
  for (const Include& include : IncludesOf("core")) {
    if (include.file == kLastWords) continue;
    const bool barred =
        BarredFromCore().contains(include.header) || StartsWithAny(include.header, {"arpa/", "netinet/", "sys/"});
    const bool is_excused = KeepersOfThreads().contains(include.file) && HeadersOfThreads().contains(include.header);
    EXPECT_FALSE(barred && !is_excused) << include.file << " includes " << include.header;
  }
}

TEST(RoomsTest, TheCoreAsksNoClockAndNoEnvironment) {
  const std::regex calls(R"(\b(getenv|system_clock|steady_clock|high_resolution_clock|printf|cout|cerr)\b)");
  for (const fs::path& path : SourcesOf("core")) {
    if (RelativePath(path) == kLastWords || ReadersOfTheClock().contains(RelativePath(path))) continue;
    std::ifstream file(path);
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
      EXPECT_FALSE(std::regex_search(line, calls)) << RelativePath(path) << ":" << number << ": " << line;
    }
  }
}

// The C library's functions depend on the processor; those of core/numerics/elementary.h do not.
TEST(RoomsTest, TheCoreTakesNoElementaryFunctionFromTheCLibrary) {
  const std::regex calls(R"(\bstd::(a?(sin|cos|tan)h?|atan2|exp[2m]?1?|log(10|2|1p)?|pow|hypot|cbrt)\()");
  for (const fs::path& path : SourcesOf("core")) {
    std::ifstream file(path);
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
      EXPECT_FALSE(std::regex_search(line, calls)) << RelativePath(path) << ":" << number << ": " << line;
    }
  }
}

// Where a library has one door in its room, only that file includes it.
TEST(RoomsTest, LibrariesAreIncludedOnlyBehindTheirDoors) {
  const std::map<std::string, std::vector<std::string>> doors = {
      {"hwy/",
       {"core/contact/mechanism_lanes.", "core/models/", "core/numerics/", "core/plan/pendulum_models.",
        "core/plan/planar_models."}},
      {"boost/", {"core/models/finite_duration/integrator.cc"}},
      {"flint/", {"core/certified/"}},
      {"arb", {"core/certified/"}},
      {"arf", {"core/certified/"}},
      {"sleef.h", {"core/numerics/elementary.cc"}},
      {"netcdf.h", {"client/cli/sweep/netcdf_library.h"}},
      {"isa-l/", {"proto/wire/crc32c.cc"}},
      {"nlohmann/",
       {"client/cli/text/json_text.cc", "proto/text/json_errors.cc", "proto/text/json_matrices.cc",
        "client/cli/report/scene_schema.cc", "client/cli/sweep/sweep_json.cc", "client/cli/conformance/"}},
      {"openssl/",
       {"proto/wire/pem.h", "client/credentials.cc", "server/security/callers.cc", "server/security/handshakes.cc",
        "server/security/tls_files.cc"}},
      {"prometheus/", {"server/telemetry/metrics."}},
      {"civetweb.h", {"server/telemetry/metrics_page.cc", "client/cli/explore/web_server.cc"}},
      {"pybind11/", {"python/module/"}},
  };
  for (const std::string folder : kHouses) {
    for (const Include& include : IncludesOf(folder)) {
      for (const auto& [library, files] : doors) {
        if (include.header.rfind(library, 0) != 0) continue;
        EXPECT_TRUE(StartsWithAny(include.file, files)) << include.file << " includes " << include.header;
      }
    }
  }
}

}  // namespace
}  // namespace ricochet
