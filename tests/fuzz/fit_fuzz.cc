// Fuzzes fits: bytes are a v1::FitRequest.
//
// A valid request is answered, one that breaks a rule is refused with the field. The best fit lies within its bounds
// and its intervals, no search is better than it, chi2 is the sum of its squared residuals unless inputs have errors,
// shares add up to 1, and data that say nothing about an unknown give it no end.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "proto/wire/fit.h"
#include "ricochet/error.h"
#include "ricochet/solver.h"
#include "tests/fuzz/fail.h"
#include "tests/fuzz/mutate_message.h"

namespace ricochet {
namespace {

// More take longer than a fuzzer waits.
constexpr size_t kMostRowsTried = 8;
constexpr size_t kMostUnknownsTried = 3;
constexpr int32_t kMostStartsTried = 2;
constexpr int32_t kMostIterationsTried = 20;
// A search for an end without bound goes to extreme numbers, whose impacts take wide arithmetic.
constexpr int32_t kMostIterationsTriedIfUncertain = 2;

// Impacts of larger numbers take wide arithmetic, a fit whose inputs have errors some million impacts.
constexpr double kLargestUncertain = 1e6;

// Sums of squares may differ by this through rounding.
constexpr double kRounding = 1e-9;

// A search that is better by less has found the same fit.
constexpr double kAsGood = 1e-6;

bool IsExact(const FitRequest& request) {
  return std::none_of(request.inputs.begin(), request.inputs.end(),
                      [](const FitInput& input) { return !input.sigma.empty(); });
}

bool IsModerate(const FitInput& input) {
  return input.sigma.empty() || std::all_of(input.values.begin(), input.values.end(),
                                            [](double value) { return !(std::fabs(value) > kLargestUncertain); });
}

bool IsSmall(const FitRequest& request) {
  return std::all_of(request.inputs.begin(), request.inputs.end(), IsModerate) &&
         request.unknowns.size() <= kMostUnknownsTried && !TakesTime(request.scene) &&
         std::all_of(request.measured.begin(), request.measured.end(),
                     [](const FitMeasured& measured) { return measured.values.size() <= kMostRowsTried; });
}

void CheckEnd(const FitEstimate& estimate, const FitEnd& end, double sign) {
  const bool has_value = end.kind == FitEndKind::kFound || end.kind == FitEndKind::kCutByBound;
  if (end.value.has_value() != has_value) Fail(absl::StrCat(estimate.path, ": an end without its value"));
  if (!estimate.seen && end.kind == FitEndKind::kUnbounded) Fail(absl::StrCat(estimate.path, " is not seen"));
  if (has_value && sign * (*end.value - estimate.value) < 0.0) {
    Fail(absl::StrCat(estimate.path, " = ", estimate.value, " is not in its interval, which ends at ", *end.value));
  }
}

void CheckEstimate(const FitUnknown& unknown, const FitEstimate& estimate) {
  if (estimate.value < unknown.low.value_or(estimate.value) || estimate.value > unknown.high.value_or(estimate.value)) {
    Fail(absl::StrCat(estimate.path, " = ", estimate.value, " is not within its bounds"));
  }
  const bool is_between = estimate.low.kind == FitEndKind::kFound && estimate.high.kind == FitEndKind::kFound;
  if (estimate.sigma.has_value() && !estimate.seen) Fail(absl::StrCat(estimate.path, " has a sigma, but is not seen"));
  if (estimate.seen && !estimate.sigma.has_value() && !is_between) {
    Fail(absl::StrCat(estimate.path, " is seen, but has neither a sigma nor both ends"));
  }
  CheckEnd(estimate, estimate.low, -1.0);
  CheckEnd(estimate, estimate.high, 1.0);
  const auto rises = [](const FitProfilePoint& a, const FitProfilePoint& b) { return a.value < b.value; };
  if (!std::is_sorted(estimate.profile.begin(), estimate.profile.end(), rises)) Fail("a profile is not in order");
  const double shares = std::accumulate(estimate.row_shares.begin(), estimate.row_shares.end(), 0.0);
  if (!estimate.row_shares.empty() && std::fabs(shares - 1.0) > kRounding) Fail(absl::StrCat("shares: ", shares));
}

void CheckSums(const FitRequest& request, const FitResponse& fit) {
  double chi2 = 0.0;
  for (const FitRow& row : fit.rows) {
    for (const double residual : row.residuals) chi2 += std::isnan(residual) ? 0.0 : residual * residual;
  }
  // Errors of inputs make residuals count together.
  if (IsExact(request) && std::fabs(chi2 - fit.chi2) > kRounding * std::max(chi2, 1.0))
    Fail(absl::StrCat("chi2 ", fit.chi2, ", ", chi2));
  for (const FitStart& start : fit.starts) {
    if (start.objective < fit.objective - kAsGood) Fail("a search is better than the best fit");
  }
  for (const double number : fit.correlation) {
    if (std::fabs(number) > 1.0 + kRounding) Fail(absl::StrCat("a correlation of ", number));
  }
}

void Run(const v1::FitRequest& proto) {
  FitRequest request = FromProto(proto);
  if (!IsSmall(request)) return;
  if (request.starts.value_or(1) > kMostStartsTried) request.starts = kMostStartsTried;
  const int32_t most = IsExact(request) ? kMostIterationsTried : kMostIterationsTriedIfUncertain;
  request.max_iterations = std::min(request.max_iterations.value_or(kFitIterations), most);
  const absl::StatusOr<FitResponse> fit = LocalSolver().Fit(request);
  if (!fit.ok()) {
    if (absl::IsOutOfRange(fit.status())) return;  // No start has an outcome, or a number exceeds the largest double.
    if (ViolationsOf(fit.status()).empty()) Fail(fit.status().ToString());
    return;
  }
  for (size_t i = 0; i < request.unknowns.size(); ++i) CheckEstimate(request.unknowns[i], fit->unknowns[i]);
  CheckSums(request, *fit);
}

}  // namespace

std::unique_ptr<google::protobuf::Message> NewInput() { return std::make_unique<v1::FitRequest>(); }
std::vector<std::string> InputTexts() {
  return {"friction.kinetic_coefficient", "restitution.energetic", "contact_velocity_after.normal_m_s",
          "contact_velocity_after.tangential_m_s[0]", "impulse.normal_total_n_s"};
}

}  // namespace ricochet

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ricochet::v1::FitRequest request;
  if (request.ParseFromArray(data, static_cast<int>(size))) ricochet::Run(request);
  return 0;
}
