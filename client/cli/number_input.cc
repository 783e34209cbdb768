#include "client/cli/number_input.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "absl/strings/str_cat.h"
#include "ricochet/error.h"

namespace ricochet::cli {
namespace {

constexpr double kMostCount = 9007199254740992.0;  // 2^53: every whole number up to here is a double.
constexpr double kYearMs = 365.0 * 24 * 3600 * 1000;

// Returns the double nearest to `text`. The option parser itself would use strtold, which rounds twice.
std::optional<double> ToDouble(const std::string& text) {
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+') ++first;
  double value = 0.0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc() || end != last) return std::nullopt;
  return value;
}

}  // namespace

absl::Status InputError(const std::string& what, const std::string& text, const std::string& rule) {
  return InvalidRequest({{what, absl::StrCat("= ", text, ": must ", rule)}});
}

absl::StatusOr<double> ParseNumber(const std::string& text, const std::string& what) {
  const size_t slash = text.find('/');
  const std::optional<double> numerator = ToDouble(text.substr(0, slash));
  const std::optional<double> denominator =
      slash == std::string::npos ? std::optional<double>(1.0) : ToDouble(text.substr(slash + 1));
  if (!numerator.has_value() || !denominator.has_value()) {
    return InputError(what, text, "be a number such as 0.1 or 1e-3, or a fraction such as 1/3");
  }
  if (*denominator == 0.0) return InputError(what, text, "have a denominator other than 0");
  return *numerator / *denominator;
}

absl::StatusOr<int64_t> ParseCount(const std::string& text, const std::string& what) {
  const std::optional<double> value = ToDouble(text);
  if (!value.has_value() || std::trunc(*value) != *value || std::abs(*value) > kMostCount) {
    return InputError(what, text, "be a whole number of at most 2^53");
  }
  return static_cast<int64_t>(*value);
}

absl::StatusOr<std::chrono::milliseconds> ParseDuration(const std::string& text, const std::string& what) {
  const size_t unit_at = text.find_first_not_of("0123456789.");
  const std::string unit = unit_at == std::string::npos ? "s" : text.substr(unit_at);
  const std::optional<double> value = ToDouble(text.substr(0, unit_at));
  const double factor = unit == "ms" ? 1.0 : unit == "s" ? 1e3 : unit == "m" ? 6e4 : unit == "h" ? 3.6e6 : 0.0;
  const double milliseconds = value.value_or(0.0) * factor;
  if (!(milliseconds >= 1.0 && milliseconds <= kYearMs)) {
    return InputError(what, text, "be a time from 1ms to a year, such as 250ms, 30s, 5m or 2h");
  }
  return std::chrono::milliseconds(std::llround(milliseconds));
}

}  // namespace ricochet::cli
