// Errors of the core: a bad request names every field that is wrong, its value and what would be right.
//
// A failure that is the caller's travels as an absl::Status with a Reason and, for bad requests, the list of
// violations. A numerical outcome (inadmissible, locked, separating) is not an error: see ricochet/outcome.h.

#ifndef RICOCHET_ERROR_H_
#define RICOCHET_ERROR_H_

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace ricochet {

// Why a request failed, in a form that a program can act on. The numbers are those of ricochet.v1.ErrorReason.
enum class ErrorReason {
  kUnspecified = 0,
  kInvalidRequest = 1,       // INVALID_ARGUMENT: every violation is listed.
  kOutputOverflow = 2,       // OUT_OF_RANGE: an exact result lies above the largest double; the message names it.
  kInadmissibleOutcome = 3,  // FAILED_PRECONDITION: the caller asked that an inadmissible outcome be an error.
  kTooManyCalls = 4,         // RESOURCE_EXHAUSTED: the server's limit on live calls; try again after a while.
  kSweepTooLarge = 5,        // RESOURCE_EXHAUSTED: more points than the server allows in one call; ask for sub-ranges.
  kDraining = 6,             // UNAVAILABLE: the server is shutting down; another one, or a later try, will do.
  kNotEnded = 7,             // OUT_OF_RANGE: an impact that bounds rest on has not ended within its model's steps.
};

// What could make a violation good.
enum class ViolationKind {
  kShape,    // Setting or leaving out a field, or another length of a list.
  kValue,    // Another number in the field, or in one that the rule ties it to.
  kContact,  // Another number in any field that shapes the contact or its velocity.
};

// One wrong field of a request.
struct Violation {
  // Path of the field as the proto spells it: fields of the scene from the scene on ("friction.kinetic_coefficient"),
  // all others from the request on ("axes[0].linspace.count").
  std::string field;
  // The value found and the rule it breaks: "= -0.1: must be >= 0". Text of the caller's in it is escaped.
  std::string description;

  // For the core alone: neither a status nor a comparison has them.
  ViolationKind kind = ViolationKind::kShape;
  std::vector<std::string> tied_to = {};  // kValue: the other numbers that the rule takes in, by path.

  friend bool operator==(const Violation& a, const Violation& b) {
    return a.field == b.field && a.description == b.description;
  }
};

// "= VALUE: must RULE", VALUE in the shortest form that reads back as the same double; of kind kValue.
Violation MakeViolation(std::string field, double value, const std::string& rule,
                        std::vector<std::string> tied_to = {});

// A status with a reason. `code` must not be OK.
absl::Status MakeError(absl::StatusCode code, ErrorReason reason, const std::string& message);

// INVALID_ARGUMENT that lists every violation, in the message and as data. `violations` must not be empty.
absl::Status InvalidRequest(const std::vector<Violation>& violations);

// OUT_OF_RANGE naming the output, a path such as "outcome.work.normal_compression_j".
absl::Status OutputOverflow(const std::string& path);

// What the functions above put into a status; empty or kUnspecified where there is none.
ErrorReason ReasonOf(const absl::Status& status);
std::vector<Violation> ViolationsOf(const absl::Status& status);

// When a retry may succeed; absent where a retry of the same call cannot.
void SetRetryDelay(std::chrono::milliseconds delay, absl::Status& status);
std::optional<std::chrono::milliseconds> RetryDelayOf(const absl::Status& status);

}  // namespace ricochet

#endif  // RICOCHET_ERROR_H_
