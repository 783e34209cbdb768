// Rooms: which room may include which, read off the #include lines of every source file.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

// Our own folders and the libraries of others that a room may include. Standard headers are free to all but the core,
// which the second test looks after.
struct Room {
  std::string folder;
  std::vector<std::string> prefixes;
};

const std::vector<Room>& Rooms() {
  static const std::vector<Room> rooms = {
      {"core",
       {"core/", "ricochet/", "absl/container/", "absl/functional/", "absl/status/", "absl/strings/", "absl/types/",
        "hwy/", "Eigen/", "cvode/", "nvector/", "sundials/", "sunnonlinsol/"}},
      {"core/include/ricochet", {"ricochet/", "absl/"}},
      {"core/certified",
       {"core/", "ricochet/", "absl/functional/", "absl/status/", "absl/strings/", "absl/types/", "flint/"}},
      {"proto/wire", {"proto/wire/", "ricochet/", "core/", "absl/", "google/", "grpc/", "grpcpp/", "isa-l/"}},
      {"proto/comments", {"proto/comments/", "absl/", "google/"}},
      {"client", {"client/", "proto/wire/", "ricochet/", "core/", "absl/", "google/", "grpc/", "grpcpp/", "openssl/"}},
      {"client/cli",
       {"client/", "proto/comments/", "proto/wire/", "ricochet/", "core/", "absl/", "google/", "grpc/", "grpcpp/",
        "CLI/", "spdlog/"}},
      {"client/cli/json",
       {"client/cli/", "proto/comments/", "core/numerics/decimal.h", "core/scene/nearest.h", "absl/", "google/",
        "nlohmann/"}},
      {"server",
       {"server/", "proto/wire/", "ricochet/", "core/", "absl/", "google/", "grpc/", "grpcpp/", "CLI/", "spdlog/",
        "openssl/", "prometheus/"}},
  };
  return rooms;
}

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
constexpr char kLastWords[] = "core/numerics/invariant.cc";

// Some files compare the deadline of a call with the clock, some how long a call has lasted before
// others help it, one how soon the reader of a stream comes back, and two measure the time that a method takes.
const std::set<std::string>& ReadersOfTheClock() {
  static const std::set<std::string> files = {"core/include/ricochet/call_options.h",
                                              "core/engine/call_watch.h",
                                              "core/engine/call_watch.cc",
                                              "core/engine/chunk_size.h",
                                              "core/engine/local_solver.cc",
                                              "core/engine/parallel_batch.cc",
                                              "core/engine/sweep_run.cc",
                                              "core/study/stopwatch.h",
                                              "core/study/stopwatch.cc"};
  return files;
}

// The files of the threads that help a sweep or a batch, and of what these share.
const std::set<std::string>& KeepersOfThreads() {
  static const std::set<std::string> files = {"core/engine/helper_threads.h", "core/engine/helper_threads.cc",
                                              "core/engine/parallel_batch.h", "core/engine/parallel_batch.cc",
                                              "core/engine/sweep_run.cc"};
  return files;
}

const std::set<std::string>& HeadersOfThreads() {
  static const std::set<std::string> headers = {"atomic", "condition_variable", "mutex", "thread"};
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

// The innermost room that a file lies in.
const Room& RoomOf(const std::string& file) {
  const Room* innermost = nullptr;
  for (const Room& room : Rooms()) {
    const bool inside = file.rfind(room.folder + "/", 0) == 0;
    if (inside && (innermost == nullptr || room.folder.size() > innermost->folder.size())) innermost = &room;
  }
  return *innermost;
}

// The core's rooms from the ground up. Rooms on one floor do not see each other.
const std::vector<std::vector<std::string>>& Floors() {
  static const std::vector<std::vector<std::string>> floors = {
      {"core/numerics"},
      {"core/include/ricochet"},
      {"core/vocabulary"},  // The functions that the public headers declare.
      {"core/contact"},
      {"core/scene"},
      {"core/models"},
      {"core/models/pendulum", "core/models/planar", "core/models/sliding", "core/models/spatial",
       "core/models/compliant", "core/models/finite_duration", "core/models/laws"},
      {"core/problem"},
      {"core/bounds", "core/certified"},
      {"core/plan"},
      {"core/answer"},
      {"core/study", "core/sweep"},
      {"core/batch"},
      {"core/engine"},
  };
  return floors;
}

// The floor of a folder; -1 if no floor lists it.
int FloorOf(const std::string& folder) {
  for (size_t i = 0; i < Floors().size(); ++i) {
    if (std::find(Floors()[i].begin(), Floors()[i].end(), folder) != Floors()[i].end()) return static_cast<int>(i);
  }
  return -1;
}

std::string FolderOf(const std::string& file) { return file.substr(0, file.rfind('/')); }

// The path of one of our own headers that a source of the core includes.
std::string FileOf(const std::string& header) {
  return header.rfind("ricochet/", 0) == 0 ? "core/include/" + header : header;
}

bool IsOfTheCore(const std::string& header) { return StartsWithAny(header, {"core/", "ricochet/"}); }

TEST(FloorsTest, AnIncludeInTheCoreStaysInItsRoomOrGoesToALowerFloor) {
  for (const Include& include : IncludesOf("core")) {
    const std::string from = FolderOf(include.file);
    ASSERT_GE(FloorOf(from), 0) << include.file << " lies in a folder that is on no floor";
    if (!IsOfTheCore(include.header)) continue;
    const std::string to = FolderOf(FileOf(include.header));
    EXPECT_TRUE(from == to || FloorOf(to) < FloorOf(from))
        << include.file << " includes " << include.header << ", which lies on floor " << FloorOf(to)
        << ", not below its own, " << FloorOf(from);
  }
}

// Floors imply that there is no circle. This test also finds a circle among rooms that share a floor.
TEST(FloorsTest, NoTwoFoldersOfTheCoreReachEachOther) {
  std::map<std::string, std::set<std::string>> reach;
  for (const Include& include : IncludesOf("core")) {
    const std::string from = FolderOf(include.file);
    if (IsOfTheCore(include.header)) reach[from].insert(FolderOf(FileOf(include.header)));
  }
  for (size_t i = 0; i < reach.size(); ++i) {
    for (auto& [from, all] : reach) {
      for (const std::string& to : std::set<std::string>(all)) all.insert(reach[to].begin(), reach[to].end());
    }
  }
  int circles = 0;
  for (const auto& [from, all] : reach) {
    for (const std::string& to : all) {
      if (from >= to || !reach[to].contains(from)) continue;
      ++circles;
      ADD_FAILURE() << from << " and " << to << " reach each other";
    }
  }
  std::cout << "folder circles in the core: " << circles << "\n";
}

// An installed header must not include one that is not installed.
TEST(FloorsTest, PublicHeadersIncludePublicHeadersAlone) {
  for (const std::string folder : {"core/include", "client/include"}) {
    for (const Include& include : IncludesOf(folder)) {
      EXPECT_TRUE(IsSystemHeader(include.header) || StartsWithAny(include.header, {"ricochet/", "absl/"}))
          << include.file << " includes " << include.header;
      EXPECT_FALSE(StartsWithAny(include.header, {"ricochet/v1/"})) << include.file << " includes " << include.header;
    }
  }
}

TEST(RoomsTest, NoRoomIncludesWhatItsDoorsDoNotAllow) {
  for (const std::string folder : {"core", "proto/wire", "client", "server"}) {
    for (const Include& include : IncludesOf(folder)) {
      const Room& room = RoomOf(include.file);
      EXPECT_TRUE(IsSystemHeader(include.header) || StartsWithAny(include.header, room.prefixes))
          << include.file << " includes " << include.header << ", which " << room.folder << "/ may not";
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

// Only one room may include each of these libraries.
TEST(RoomsTest, LibrariesAreIncludedOnlyBehindTheirDoors) {
  struct Library {
    std::string prefix;
    std::vector<std::string> doors;
  };
  const std::vector<Library> libraries = {
      {"spdlog/", {"server/", "client/cli/"}},
      {"CLI/", {"server/", "client/cli/"}},
      {"nlohmann/", {"client/cli/json/"}},
      {"hwy/", {"core/models/", "core/numerics/", "core/plan/pendulum_models.", "core/plan/planar_models."}},
      {"Eigen/", {"core/contact/"}},
      {"cvode/", {"core/models/finite_duration/integrator."}},
      {"nvector/", {"core/models/finite_duration/integrator."}},
      {"sundials/", {"core/models/finite_duration/integrator."}},
      {"sunnonlinsol/", {"core/models/finite_duration/integrator."}},
      {"netcdf.h", {"client/cli/netcdf_file.cc", "client/cli/netcdf_table.cc"}},
      {"sleef.h", {"core/numerics/elementary.cc"}},
      {"flint/", {"core/certified/"}},
      {"arb", {"core/certified/"}},
      {"arf", {"core/certified/"}},
      {"grpcpp/", {"proto/wire/", "server/", "client/"}},
      {"isa-l/", {"proto/wire/crc32c.cc"}},
      {"openssl/", {"client/tls_files.cc", "server/callers.cc", "server/handshakes.cc", "server/tls_files.cc"}},
      {"prometheus/", {"server/metrics."}},
      {"civetweb.h", {"server/metrics_page.cc"}},
      {"ricochet/v1/", {"proto/wire/", "server/", "client/"}},
  };
  for (const std::string folder : {"core", "proto/wire", "client", "server"}) {
    for (const Include& include : IncludesOf(folder)) {
      for (const Library& library : libraries) {
        if (include.header.rfind(library.prefix, 0) != 0) continue;
        EXPECT_TRUE(StartsWithAny(include.file, library.doors)) << include.file << " includes " << include.header;
      }
    }
  }
}

TEST(RoomsTest, TheTestSeesTheRoomsItSpeaksOf) {
  for (const std::string folder : {"core", "proto/wire", "client", "server"}) {
    EXPECT_FALSE(IncludesOf(folder).empty()) << folder;
  }
}

}  // namespace
}  // namespace ricochet
