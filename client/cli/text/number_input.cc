#include "client/cli/text/number_input.h"

#include <charconv>
#include <cmath>
#include <numbers>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "core/base/try.h"
#include "ricochet/error.h"

namespace ricochet::cli {
namespace {

constexpr double kMostCount = 9007199254740992.0;  // 2^53: every whole number up to here is a double.
constexpr double kYearMs = 365.0 * 24 * 3600 * 1000;
constexpr double kFullTurn = 2.0 * std::numbers::pi;

std::string large_angle;  // LargeAngleRead returns it.

constexpr char kNumberRule[] = "be a number such as 0.1 or 1e-3, or a fraction such as 1/3";
constexpr char kRangeRule[] = "be 0, or a number of a size from 4.95e-324 to 1.7976931348623157e+308";

// Puts the double nearest to `text` into `value`, and returns the rule that the text breaks. The option parser itself
// would use strtold, which rounds twice.
std::string ReadDecimal(absl::string_view text, double& value) {
  const char* first = text.data();
  const char* const last = first + text.size();
  if (absl::StartsWith(text, "+") && !absl::StartsWith(text, "+-")) ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  if (end == last && error == std::errc::result_out_of_range) {
    return kRangeRule;
  }
  if (error == std::errc() && end == last) return "";
  if (absl::StrContains(text, ',')) return "be a number with a decimal point, not a comma";
  return kNumberRule;
}

// Converts a fraction of degrees. It rounds to a double once, so that 180 degrees are the one nearest to pi.
double Radians(double numerator, double denominator) {
  constexpr long double kDegree = std::numbers::pi_v<long double> / 180.0L;
  return static_cast<double>(static_cast<long double>(numerator) / denominator * kDegree);
}

}  // namespace

absl::Status InputError(const std::string& what, const std::string& text, const std::string& rule) {
  constexpr size_t kMostShown = 200;
  const std::string shown =
      text.size() <= kMostShown ? text : absl::StrCat(text.substr(0, kMostShown), "... (", text.size(), " characters)");
  return InvalidRequest({{what, absl::StrCat("= ", shown, ": must ", rule)}});
}

std::string ReadNumber(const std::string& text, Spelling spelling, double& value) {
  absl::string_view number = text;
  const bool in_degrees = absl::ConsumeSuffix(&number, "deg");
  if (in_degrees && spelling != Spelling::kAngle) return "be a number without deg, because it is no angle";
  const size_t slash = number.find('/');
  double denominator = 1.0;
  std::string rule = ReadDecimal(number.substr(0, slash), value);
  if (rule.empty() && slash != absl::string_view::npos) rule = ReadDecimal(number.substr(slash + 1), denominator);
  if (!rule.empty()) return rule;
  if (denominator == 0.0) return "have a denominator other than 0";
  const bool is_zero = value == 0.0;
  const bool is_fraction = slash != absl::string_view::npos;
  if (is_fraction && !(std::isfinite(value) && std::isfinite(denominator))) return kNumberRule;
  value = in_degrees ? Radians(value, denominator) : value / denominator;
  const bool is_large = std::fabs(value) > kFullTurn && std::isfinite(value);
  if (spelling == Spelling::kAngle && !in_degrees && is_large && large_angle.empty()) large_angle = text;
  if ((is_fraction || in_degrees) && (!std::isfinite(value) || (value == 0.0 && !is_zero))) return kRangeRule;
  return "";
}

const std::string& LargeAngleRead() { return large_angle; }

absl::StatusOr<double> ParseNumber(const std::string& text, const std::string& what, Spelling spelling) {
  double value = 0.0;
  const std::string rule = ReadNumber(text, spelling, value);
  if (rule.empty()) return value;
  return InputError(what, text, rule);
}

absl::StatusOr<std::vector<double>> ParseNumbers(const std::string& text, const std::string& what, Spelling spelling) {
  std::vector<double> numbers;
  for (const auto part : absl::StrSplit(text, ',')) {
    RICOCHET_TRY(const double number, ParseNumber(std::string(part), what, spelling));
    numbers.push_back(number);
  }
  return numbers;
}

absl::StatusOr<int64_t> ParseCount(const std::string& text, const std::string& what) {
  double value = 0.0;
  if (!ReadDecimal(text, value).empty() || std::trunc(value) != value || std::abs(value) > kMostCount) {
    return InputError(what, text, "be a whole number of at most 2^53");
  }
  return static_cast<int64_t>(value);
}

absl::StatusOr<int64_t> ParseCount(const std::string& text, const std::string& what, int64_t most) {
  absl::StatusOr<int64_t> count = ParseCount(text, what);
  if (count.ok() && (*count < 1 || *count > most)) return InputError(what, text, absl::StrCat("be in [1, ", most, "]"));
  return count;
}

absl::StatusOr<std::chrono::milliseconds> ParseDuration(const std::string& text, const std::string& what) {
  const size_t unit_at = text.find_first_not_of("0123456789.");
  const std::string unit = unit_at == std::string::npos ? "s" : text.substr(unit_at);
  double value = 0.0;
  const bool is_read = ReadDecimal(absl::string_view(text).substr(0, unit_at), value).empty();
  const double factor = unit == "ms" ? 1.0 : unit == "s" ? 1e3 : unit == "m" ? 6e4 : unit == "h" ? 3.6e6 : 0.0;
  const double milliseconds = (is_read ? value : 0.0) * factor;
  if (!(milliseconds >= 1.0 && milliseconds <= kYearMs)) {
    return InputError(what, text, "be a time from 1ms to a year, such as 250ms, 30s, 5m or 2h");
  }
  return std::chrono::milliseconds(std::llround(milliseconds));
}

}  // namespace ricochet::cli
