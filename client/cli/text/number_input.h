// Reads numbers and times as a user types them.

#ifndef RICOCHET_CLIENT_CLI_TEXT_NUMBER_INPUT_H_
#define RICOCHET_CLIENT_CLI_TEXT_NUMBER_INPUT_H_

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace ricochet::cli {

// Says how a number may be written: "0.1", "-1e-3", or a fraction of two such numbers, "1/3". An angle may also be
// given in degrees, "45deg" or "180/7deg", which become the radians nearest to them.
enum class Spelling { kNumber, kAngle };

// Reads a number into `value`. Returns the rule that the text breaks, such as "be a number such as 0.1"; empty if it
// breaks none.
std::string ReadNumber(const std::string& text, Spelling spelling, double& value);

// Returns the first angle beyond a full turn that the functions of this file have read without "deg"; empty if there
// is none.
const std::string& LargeAngleRead();

// Reads a number. `what` names the input in the error. Errors: INVALID_ARGUMENT, here and below.
absl::StatusOr<double> ParseNumber(const std::string& text, const std::string& what,
                                   Spelling spelling = Spelling::kNumber);
// Reads numbers between commas.
absl::StatusOr<std::vector<double>> ParseNumbers(const std::string& text, const std::string& what,
                                                 Spelling spelling = Spelling::kNumber);

// Reads a whole number of at most 2^53: "1000", "1e6".
absl::StatusOr<int64_t> ParseCount(const std::string& text, const std::string& what);
// Reads such a number from 1 to `most`.
absl::StatusOr<int64_t> ParseCount(const std::string& text, const std::string& what, int64_t most);

// Reads "250ms", "30s", "5m", "2h"; a bare number is in seconds. At least one millisecond, at most a year.
absl::StatusOr<std::chrono::milliseconds> ParseDuration(const std::string& text, const std::string& what);

// Returns the error INVALID_ARGUMENT "WHAT = TEXT: must RULE".
absl::Status InputError(const std::string& what, const std::string& text, const std::string& rule);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_NUMBER_INPUT_H_
