// Errors: the message for a bad request names every field that is wrong, its value and what would be right.
//
// A failure that the caller can cure travels as an absl::Status with an ErrorReason and, for a bad request, the list of
// violations. A numerical outcome (inadmissible, locked, separating) is not an error: see ricochet/outcome.h.

#ifndef RICOCHET_ERROR_H_
#define RICOCHET_ERROR_H_

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace ricochet {

// Says why a request failed, in a form that a program can act on. The numbers are those of ricochet.v1.ErrorReason.
enum class ErrorReason {
  kUnspecified = 0,
  kInvalidRequest = 1,       // INVALID_ARGUMENT: the message lists every violation.
  kOutputOverflow = 2,       // OUT_OF_RANGE: an exact result lies above the largest double; the message names it.
  kInadmissibleOutcome = 3,  // FAILED_PRECONDITION: the caller asked that an inadmissible outcome be an error.
  kTooManyCalls = 4,         // RESOURCE_EXHAUSTED: too many live calls, or unread answers; try again later.
  kSweepTooLarge = 5,        // RESOURCE_EXHAUSTED: more points than the server allows in one call; ask for sub-ranges.
  kDraining = 6,             // UNAVAILABLE: the server is shutting down; ask another one, or try again later.
  kNotEnded = 7,             // OUT_OF_RANGE: an impact that bounds or an audit need did not end in its steps.
  kLimitExceeded = 8,        // RESOURCE_EXHAUSTED: larger than ricochet/limits.h allows here; the violations say where.
  kOverloaded = 9,           // RESOURCE_EXHAUSTED: too much work waits to be computed; try again later.
  kTimeLimit = 10,           // DEADLINE_EXCEEDED: the call took longer than the server allows any call of its kind.
  kAgeLimit = 11,     // UNAVAILABLE: a stream has reached the greatest age that the server allows; ask for the rest.
  kUnreadLimit = 12,  // CANCELLED: the caller did not read what it was sent, or sent no batch.
};

// The change to a request that could cure a violation.
enum class ViolationKind {
  kShape,    // Set or leave out a field, or change the length of a list.
  kValue,    // Change the number in the field, or a number that the rule ties it to.
  kContact,  // Change a number in any field that determines the contact or its velocity.
};

// One wrong field of a request.
struct Violation {
  // Path of the field as the proto spells it. The path of a field of the scene starts at the scene
  // ("friction.kinetic_coefficient"), any other path at the request ("axes[0].linspace.count").
  std::string field;
  // The value found and the rule it breaks: "= -0.1: must be >= 0". Text that came from the caller is escaped.
  std::string description;

  // The core alone uses these members: a status does not carry them, and comparisons ignore them.
  ViolationKind kind = ViolationKind::kShape;
  std::vector<std::string> tied_to = {};  // kValue: the paths of the other numbers that the rule involves.
  std::string rule = {};                  // It follows "must " in the description: "be >= 0". MakeViolation sets it.

  friend bool operator==(const Violation& a, const Violation& b) {
    return a.field == b.field && a.description == b.description;
  }
};

// A status lists no more violations than this number. Validation stops once it has found more.
inline constexpr size_t kMostViolations = 20;

// True once there are more violations than a status lists, so that looking for others is of no use.
inline bool IsFull(const std::vector<Violation>& violations) { return violations.size() > kMostViolations; }

// Makes a violation with the description "FOUND: must RULE".
Violation MakeViolation(std::string field, const std::string& found, std::string rule,
                        ViolationKind kind = ViolationKind::kShape, std::vector<std::string> tied_to = {});

// Makes a violation of kind kValue with the description "= VALUE: must RULE". VALUE is the shortest decimal that reads
// back as the same double.
Violation MakeViolation(std::string field, double value, std::string rule, std::vector<std::string> tied_to = {});

// Makes a status with a reason. `code` must not be OK.
absl::Status MakeError(absl::StatusCode code, ErrorReason reason, const std::string& message);

// Makes an INVALID_ARGUMENT that lists the violations, in the message and as data. If there are more than
// kMostViolations, it lists that many and the last one says that there are more. `violations` must not be empty.
absl::Status InvalidRequest(const std::vector<Violation>& violations);

// Makes a RESOURCE_EXHAUSTED that lists the fields that are too large in the same way.
absl::Status LimitExceeded(const std::vector<Violation>& violations);

// Makes a status like `from`, which lists violations, that lists these in their place. `violations` must not be empty.
absl::Status WithViolations(const absl::Status& from, const std::vector<Violation>& violations);

// Makes an OUT_OF_RANGE that names the output by its path, such as "outcome.work.normal_compression_j".
absl::Status OutputOverflow(const std::string& path);

// These two read what the functions above have put into a status: kUnspecified or empty if there is nothing.
ErrorReason ReasonOf(const absl::Status& status);
std::vector<Violation> ViolationsOf(const absl::Status& status);

// The retry delay says after which time the same call may succeed; it is absent if a retry cannot succeed.
void SetRetryDelay(std::chrono::milliseconds delay, absl::Status& status);
std::optional<std::chrono::milliseconds> RetryDelayOf(const absl::Status& status);

}  // namespace ricochet

#endif  // RICOCHET_ERROR_H_
