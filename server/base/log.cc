#include "server/base/log.h"

#include <grpc/support/log.h>
#include <spdlog/details/log_msg.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/formatter.h>
#include <spdlog/pattern_formatter.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <type_traits>
#include <utility>

#include "absl/strings/match.h"
#include "core/base/utf8.h"

namespace ricochet::server {
namespace {

constexpr char kTextPattern[] = "%Y-%m-%dT%H:%M:%S.%eZ %l %v";
constexpr char kJsonPattern[] = R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v})";

spdlog::level::level_enum ToSpdlog(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      break;
  }
  return spdlog::level::err;
}

// Returns `text` as a JSON string. Bytes that are not UTF-8 become U+FFFD.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (size_t i = 0; i < text.size();) {
    const char c = text[i];
    const size_t length = Utf8Length(text, i);
    if (length == 0) {
      quoted += "\xEF\xBF\xBD";
    } else if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      quoted.append(text, i, length);
    }
    i += std::max<size_t>(length, 1);
  }
  return quoted + "\"";
}

// Returns `text` for a text line, quoted unless it is plain ASCII without spaces, quotes, backslashes and equals signs.
std::string QuotedIfNeeded(const std::string& text) {
  const bool bare = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return c > ' ' && c < 0x7F && c != '"' && c != '\\' && c != '=';
  });
  return bare ? text : Quoted(text);
}

std::string ToText(const LogField& field, LogFormat format) {
  return std::visit(
      [format](const auto& value) -> std::string {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::string>) {
          return format == LogFormat::kJson ? Quoted(value) : QuotedIfNeeded(value);
        } else if constexpr (std::is_same_v<Value, double>) {
          return std::isfinite(value) ? fmt::format("{:.3f}", value) : "null";
        } else {
          return fmt::format("{}", value);
        }
      },
      field.value);
}

// The log that receives gRPC's own messages.
std::atomic<const Log*> grpc_log = nullptr;

// A failed handshake is not an error of the server; server/security/handshakes.h logs whose it was.
constexpr char kHandshakeFailed[] = "Handshake failed with fatal error";

LogLevel LevelOf(const gpr_log_func_args& message) {
  if (message.severity == GPR_LOG_SEVERITY_INFO) return LogLevel::kInfo;
  if (message.severity != GPR_LOG_SEVERITY_ERROR) return LogLevel::kDebug;
  return absl::StartsWith(message.message, kHandshakeFailed) ? LogLevel::kInfo : LogLevel::kError;
}

void WriteGrpcMessage(gpr_log_func_args* message) {
  Log::WriteForGrpc(LevelOf(*message), "grpc", {{"message", message->message}});
}

}  // namespace

std::string Clipped(const std::string& text) {
  constexpr size_t kMostBytes = 256;
  return text.size() <= kMostBytes ? text : text.substr(0, kMostBytes) + "...";
}

Log::Log(LogFormat format, LogLevel level, std::function<void(absl::string_view)> put)
    : format_(format),
      level_(level),
      formatter_(std::make_unique<spdlog::pattern_formatter>(format == LogFormat::kJson ? kJsonPattern : kTextPattern,
                                                             spdlog::pattern_time_type::utc)),
      put_(std::move(put)) {
  grpc_log = this;
  gpr_set_log_function(WriteGrpcMessage);
}

Log::Log(LogFormat format, LogLevel level, std::ostream& out)
    : Log(format, level, [this, &out](absl::string_view line) {
        const std::lock_guard lock(mutex_);
        out << line << std::flush;
      }) {}

Log::Log(LogFormat format, LogLevel level, std::unique_ptr<LogWriter> writer)
    : Log(format, level, [to = writer.get()](absl::string_view line) { to->Push(line); }) {
  writer_ = std::move(writer);
  writer_->SetNotice([this](int64_t dropped) {
    return Line(LogLevel::kWarning, "log lines dropped", {{"count", dropped}});
  });
}

Log::~Log() {
  const Log* self = this;
  grpc_log.compare_exchange_strong(self, nullptr);
}

std::string Log::Line(LogLevel level, const std::string& event, const std::vector<LogField>& fields) const {
  std::string record = format_ == LogFormat::kJson ? "\"event\":" + Quoted(event) : event;
  for (const LogField& field : fields) {
    record += format_ == LogFormat::kJson ? ",\"" + field.name + "\":" : " " + field.name + "=";
    record += ToText(field, format_);
  }
  const spdlog::details::log_msg message("", ToSpdlog(level), spdlog::string_view_t(record));
  spdlog::memory_buf_t line;
  const std::lock_guard lock(mutex_);
  formatter_->format(message, line);
  return {line.data(), line.size()};
}

void Log::Write(LogLevel level, const std::string& event, const std::vector<LogField>& fields) const {
  if (level >= level_) put_(Line(level, event, fields));
}

void Log::WriteForGrpc(LogLevel level, const std::string& event, const std::vector<LogField>& fields) {
  const Log* const log = grpc_log;
  if (log != nullptr) log->Write(level, event, fields);
}

bool Log::Flush(std::chrono::milliseconds time) const { return writer_ == nullptr || writer_->Flush(time); }

absl::Status Log::Reopen() const {
  absl::Status status = writer_ == nullptr ? absl::OkStatus() : writer_->Reopen();
  if (!status.ok()) Write(LogLevel::kError, "log not reopened", {{"message", std::string(status.message())}});
  return status;
}

int64_t Log::dropped() const { return writer_ == nullptr ? 0 : writer_->dropped(); }

}  // namespace ricochet::server
