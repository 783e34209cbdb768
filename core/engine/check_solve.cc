#include "core/engine/check_solve.h"

#include <string>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/answer/derivative_paths.h"
#include "core/base/counted.h"
#include "core/certified/certified.h"
#include "core/plan/number_demand.h"

namespace ricochet {
namespace {

// The number of an outcome that force_intervals asks for.
constexpr char kForces[] = "contact.history";

void CheckIntervals(const char* field, int64_t intervals, std::vector<Violation>& violations) {
  if (intervals >= 0 && intervals <= kMostIntervals) return;
  violations.push_back(
      MakeViolation(field, absl::StrCat("= ", intervals), absl::StrCat("be in [0, ", kMostIntervals, "]")));
}

void CheckForceIntervals(const SolveRequest& request, std::optional<SceneContact>& contact,
                         std::vector<Violation>& violations) {
  const int64_t intervals = request.force_intervals;
  CheckIntervals("force_intervals", intervals, violations);
  if (!violations.empty()) return;
  for (const std::string& reason : WhyNoNumber(request.scene, contact, ToDemand(request.demand), kForces)) {
    violations.push_back({"force_intervals", absl::StrCat("= ", intervals, ": ", reason)});
  }
}

// Says why no impact of the scene has a history by normal impulse; null if it may have one. The reason does not depend
// on the tolerance, although the model that the plan chooses does.
const char* WhyNoHistory(const Scene& scene) {
  if (!std::holds_alternative<std::monostate>(scene.impact_law)) return "for an impact law, which has no path";
  if (TangentialDirections(scene.system) == 2) return "for a system in space";
  if (!scene.compliance.has_value()) return nullptr;
  return std::holds_alternative<std::monostate>(scene.compliance->normal)
             ? "for a contact with tangential compliance"
             : "for a contact with a normal spring; force_intervals asks for its forces";
}

void CheckHistory(const SolveRequest& request, std::vector<Violation>& violations) {
  const size_t count = request.history_at_n_s.size();
  const int64_t intervals = request.history_intervals;
  CheckIntervals("history_intervals", intervals, violations);
  const char* const why_none = WhyNoHistory(request.scene);
  const std::string entries = absl::StrCat("has ", Counted(count, "entry"));
  if (count > 0 && why_none != nullptr) {
    violations.push_back(MakeViolation("history_at_n_s", entries, absl::StrCat("be empty ", why_none)));
  } else if (count > 0 && intervals != 0) {
    violations.push_back(MakeViolation("history_at_n_s", entries, "be empty, with history_intervals"));
  } else if (count > static_cast<size_t>(kMostIntervals) + 1) {
    violations.push_back(MakeViolation("history_at_n_s", entries, absl::StrCat("have at most ", kMostIntervals + 1)));
  }
  if (intervals > 0 && why_none != nullptr) {
    violations.push_back(
        MakeViolation("history_intervals", absl::StrCat("= ", intervals), absl::StrCat("be 0 ", why_none)));
  }
}

void CheckCertified(const SolveRequest& request, std::vector<Violation>& violations) {
  CheckDigits(request.scene, request.certified_digits, violations);
  if (request.demand.excluded.empty()) return;
  violations.push_back(
      MakeViolation("excluded", "is set", "not be, with certified_digits: certificates leave nothing out"));
}

void CheckBothEnds(const SolveRequest& request, std::vector<Violation>& violations) {
  if (HoldsCoordinates(request.scene.system)) return;
  violations.push_back(
      MakeViolation("both_ends", "is set", "not be but for a mechanism with kept_coordinates or composite"));
}

}  // namespace

Demand DemandOf(const SolveRequest& request) {
  const Demand demand = ToDemand(request.demand);
  return request.force_intervals > 0 ? WithNumbers(demand, {kForces}) : demand;
}

std::vector<Violation> CheckSolve(const SolveRequest& request) {
  std::vector<Violation> violations = CheckDemand(request.demand);
  CheckIntervals("force_intervals", request.force_intervals, violations);
  CheckIntervals("history_intervals", request.history_intervals, violations);
  return violations;
}

std::vector<Violation> CheckSolve(const SolveRequest& request, std::optional<SceneContact>& contact) {
  std::vector<Violation> violations = CheckDemand(request.scene, contact, request.demand);
  // Most requests ask for none of these.
  if (request.force_intervals != 0) CheckForceIntervals(request, contact, violations);
  if (!request.history_at_n_s.empty() || request.history_intervals != 0) CheckHistory(request, violations);
  if (request.both_ends) CheckBothEnds(request, violations);
  if (violations.empty() && request.derivatives.has_value()) {
    violations = CheckDerivatives(request.scene, request.demand, *request.derivatives);
  }
  if (violations.empty() && request.certified_digits != 0) CheckCertified(request, violations);
  return violations;
}

void CheckDigits(const Scene& scene, int digits, std::vector<Violation>& violations) {
  if (digits == 0) return;
  for (Violation& violation : CheckCertifiable(scene, digits)) violations.push_back(std::move(violation));
}

}  // namespace ricochet
