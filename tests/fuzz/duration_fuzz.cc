// Fuzzes impacts that take time: bytes are a v1::SolveRequest, which is solved if its plan chooses that model. This
// target is separate, because an impact that never parts takes a thousand times as long as others until its budget is
// used up.
//
// The target checks the claims of tests/fuzz/outcome_claims.h, and that the history has its length and a converged
// impact has no negative duration or peak.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/wire/requests.h"
#include "ricochet/solver.h"
#include "tests/fuzz/fail.h"
#include "tests/fuzz/mutate_message.h"
#include "tests/fuzz/outcome_claims.h"

namespace ricochet {
namespace {

void Run(const v1::SolveRequest& proto) {
  const SolveRequest request = FromProto(proto);
  if (request.force_intervals > 1000 || !TakesTime(request)) return;
  const absl::StatusOr<SolveResponse> response = SolveAndCheck(request);
  if (!response.ok() || !response->outcome.contact.has_value()) return;
  const ContactDuration& contact = *response->outcome.contact;
  const bool negative = contact.duration_s < 0.0 || contact.peak_normal_n < 0.0 || contact.peak_tangential_n < 0.0 ||
                        contact.indentation_m < 0.0;
  if (negative && std::isfinite(response->outcome.accuracy.relative_error)) Fail("a negative duration or peak");
  const size_t samples = request.force_intervals == 0 ? 0 : static_cast<size_t>(request.force_intervals) + 1;
  if (response->outcome.regime != Regime::kSeparating && contact.history.size() != samples) {
    Fail("a history of another length");
  }
}

}  // namespace

std::unique_ptr<google::protobuf::Message> NewInput() { return std::make_unique<v1::SolveRequest>(); }
std::vector<std::string> InputTexts() { return {}; }

}  // namespace ricochet

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ricochet::v1::SolveRequest request;
  if (request.ParseFromArray(data, static_cast<int>(size))) ricochet::Run(request);
  return 0;
}
