// Fuzzes several contacts at once: bytes are a v1::MultiContactRequest.
//
// A valid request is answered, one that breaks a rule is refused with the field. No contact approaches any more in an
// outcome that ended, energy does not rise, works have their signs, and every outcome lies within the ranges of what is
// possible.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "proto/wire/multi_contact.h"
#include "ricochet/error.h"
#include "ricochet/solver.h"
#include "tests/fuzz/fail.h"
#include "tests/fuzz/mutate_message.h"

namespace ricochet {
namespace {

// More take longer than a fuzzer waits.
constexpr size_t kMostContactsTried = 4;
constexpr size_t kMostStates = 2;

// A number may err by this beside the error that it states: the rounding of its sum, on the scale of its terms.
constexpr double kRounding = 0x1p-40;

double LargestOf(const std::vector<double>& numbers) {
  double largest = 0.0;
  for (const double number : numbers) largest = std::max(largest, std::fabs(number));
  return largest;
}

bool HasEnded(const AttainedOutcome& outcome) {
  return outcome.end == MultiContactEnd::kSeparated || outcome.end == MultiContactEnd::kEndless;
}

void CheckEnergy(const MultiContactAnswer& answer, const AttainedOutcome& outcome) {
  const double allowed = outcome.work_error_j + kRounding * answer.energy_before_j;
  if (outcome.energy_change_j > allowed) Fail(absl::StrCat("energy rises by ", outcome.energy_change_j));
  for (const ContactLedger& contact : outcome.contacts) {
    if (contact.work_compression_j > allowed || contact.work_restitution_j < -allowed ||
        contact.work_friction_j > allowed) {
      Fail("a work has the wrong sign");
    }
  }
}

void CheckVelocities(const MultiContactAnswer& answer, const AttainedOutcome& outcome, size_t directions) {
  const double scale = std::max(LargestOf(answer.contact_velocity_before_m_s), LargestOf(outcome.contact_velocity_m_s));
  std::map<std::string, const PossibleRange*> ranges;
  for (const PossibleRange& range : answer.possible) ranges[range.output] = &range;
  const std::vector<std::string> names =
      directions == 2 ? std::vector<std::string>{"t", "n"} : std::vector<std::string>{"t1", "t2", "n"};
  for (size_t i = 0; i < outcome.contact_velocity_m_s.size(); ++i) {
    const double velocity = outcome.contact_velocity_m_s[i];
    const double allowed = outcome.contact_velocity_error_m_s[i] + kRounding * scale;
    const bool is_normal = i % directions == directions - 1;
    if (is_normal && velocity < -allowed) Fail(absl::StrCat("a contact approaches by ", velocity));
    const auto found = ranges.find(absl::StrCat("contact_", i / directions + 1, ".", names[i % directions]));
    if (found == ranges.end()) continue;
    if (velocity < found->second->lower - allowed || velocity > found->second->upper + allowed) {
      Fail(absl::StrCat(found->first, " = ", velocity, " is not possible"));
    }
  }
}

void CheckOutcome(const MultiContactAnswer& answer, const AttainedOutcome& outcome, size_t directions) {
  if (!HasEnded(outcome)) return;
  CheckEnergy(answer, outcome);
  CheckVelocities(answer, outcome, directions);
}

void Run(const v1::MultiContactRequest& proto) {
  const MultiContactRequest request = FromProto(proto);
  if (request.scene.contacts.size() > kMostContactsTried || request.states.size() > kMostStates) return;
  const absl::StatusOr<MultiContactResponse> response = LocalSolver().MultiContact(request);
  if (!response.ok()) {
    if (absl::IsOutOfRange(response.status())) return;  // A number exceeds the largest double.
    if (ViolationsOf(response.status()).empty()) Fail(response.status().ToString());
    return;
  }
  const auto directions = static_cast<size_t>(DirectionsOf(request.scene));
  for (const MultiContactAnswer& answer : response->answers) {
    for (const AttainedOutcome& outcome : answer.orders) CheckOutcome(answer, outcome, directions);
    if (answer.springs.has_value()) CheckOutcome(answer, *answer.springs, directions);
    for (const PossibleRange& range : answer.possible) {
      if (!(range.lower <= range.upper)) Fail(absl::StrCat("the range of ", range.output, " is empty"));
    }
  }
}

}  // namespace

std::unique_ptr<google::protobuf::Message> NewInput() { return std::make_unique<v1::MultiContactRequest>(); }
std::vector<std::string> InputTexts() { return {}; }

}  // namespace ricochet

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ricochet::v1::MultiContactRequest request;
  if (request.ParseFromArray(data, static_cast<int>(size))) ricochet::Run(request);
  return 0;
}
