// Log: writes one line for each record, as text for people or as JSON for programs.
//
//   2026-01-31T12:00:00.000Z info call peer=ipv4:127.0.0.1:40000 method=/ricochet.v1.ImpactService/Solve status=OK …
//   {"time":"2026-01-31T12:00:00.000Z","level":"info","event":"call","peer":"ipv4:127.0.0.1:40000",…}
//
// Times are UTC. Strings are escaped, so that a record never breaks its line and every JSON line parses.

#ifndef RICOCHET_SERVER_BASE_LOG_H_
#define RICOCHET_SERVER_BASE_LOG_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "server/base/log_writer.h"

namespace spdlog {
class formatter;
}

namespace ricochet::server {

enum class LogFormat { kText, kJson };
enum class LogLevel { kDebug, kInfo, kWarning, kError };

struct LogField {
  std::string name;  // May contain letters, digits and underscores.
  std::variant<std::string, int64_t, double> value;
};

// Returns a text that a caller sent, or its first 256 bytes and "...", so that no call fills the log.
std::string Clipped(const std::string& text);

// Thread safety: Write may be called from several threads at once.
class Log {
 public:
  // Writes records of `level` and above to `out`, which must outlive it, before Write returns. gRPC's own messages go
  // to the log that was made last.
  Log(LogFormat format, LogLevel level, std::ostream& out);
  // Hands records of `level` and above to `writer`, so that Write never waits. Lines that the writer drops are reported
  // by a record "log lines dropped".
  Log(LogFormat format, LogLevel level, std::unique_ptr<LogWriter> writer);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  void Write(LogLevel level, const std::string& event, const std::vector<LogField>& fields) const;

  // Writes to the log that gRPC's own messages go to; does nothing if there is none.
  static void WriteForGrpc(LogLevel level, const std::string& event, const std::vector<LogField>& fields);

  // These three are those of the writer. A log without one has nothing to wait for, to reopen or to drop.
  bool Flush(std::chrono::milliseconds time) const;
  // Also reports an error in the log.
  absl::Status Reopen() const;
  int64_t dropped() const;

 private:
  Log(LogFormat format, LogLevel level, std::function<void(absl::string_view)> put);
  std::string Line(LogLevel level, const std::string& event, const std::vector<LogField>& fields) const;

  const LogFormat format_;
  const LogLevel level_;
  mutable std::mutex mutex_;  // Guards the formatter, and the stream of a log without a writer.
  const std::unique_ptr<spdlog::formatter> formatter_;
  const std::function<void(absl::string_view)> put_;
  // The last member, so that its thread ends before what it uses.
  std::unique_ptr<LogWriter> writer_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_LOG_H_
