// Log: writes one line for each record, as text for people or as JSON for programs.
//
//   2026-01-31T12:00:00.000Z info call peer=ipv4:127.0.0.1:40000 method=/ricochet.v1.ImpactService/Solve status=OK …
//   {"time":"2026-01-31T12:00:00.000Z","level":"info","event":"call","peer":"ipv4:127.0.0.1:40000",…}
//
// Times are UTC. Strings are escaped, so that a record never breaks its line and every JSON line parses.

#ifndef RICOCHET_SERVER_LOG_H_
#define RICOCHET_SERVER_LOG_H_

#include <cstdint>
#include <memory>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

namespace spdlog {
class logger;
}

namespace ricochet::server {

enum class LogFormat { kText, kJson };
enum class LogLevel { kDebug, kInfo, kWarning, kError };

struct LogField {
  std::string name;  // May contain letters, digits and underscores.
  std::variant<std::string, int64_t, double> value;
};

// Thread safety: Write may be called from several threads at once.
class Log {
 public:
  // Writes records of `level` and above to `out`, which must outlive it. gRPC's own messages go to the log that was
  // made last.
  Log(LogFormat format, LogLevel level, std::ostream& out);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  void Write(LogLevel level, const std::string& event, const std::vector<LogField>& fields) const;

 private:
  const LogFormat format_;
  const std::unique_ptr<spdlog::logger> logger_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_LOG_H_
