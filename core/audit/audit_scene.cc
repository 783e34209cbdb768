#include "core/audit/audit_scene.h"

#include <cmath>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/answer/scene_outcome.h"
#include "core/audit/audit.h"
#include "core/audit/audit_parts.h"
#include "core/contact/moved_contact.h"
#include "core/contact/reduction.h"
#include "core/scene/check.h"
#include "core/scene/system_velocities.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

void CheckVelocity(const ContactVelocity& velocity, size_t directions, std::vector<Violation>& violations) {
  const Components& tangential = velocity.tangential_m_s;
  if (tangential.size() != directions) {
    violations.push_back(CountViolation("contact_velocity.tangential_m_s", tangential.size(), directions));
  }
  for (size_t i = 0; i < tangential.size() && !IsFull(violations); ++i) {
    if (std::isfinite(tangential[i])) continue;
    violations.push_back(
        MakeViolation(absl::StrCat("contact_velocity.tangential_m_s[", i, "]"), tangential[i], "be finite"));
  }
  if (!std::isfinite(velocity.normal_m_s)) {
    violations.push_back(MakeViolation("contact_velocity.normal_m_s", velocity.normal_m_s, "be finite"));
  }
}

void CheckRates(const Components& rates, const System& system, std::vector<Violation>& violations) {
  const size_t wanted = SystemVelocityPaths(system).size();
  if (wanted == 0) {
    violations.push_back(MakeViolation("rates", "is set", "not be for a contact alone, give contact_velocity"));
    return;
  }
  if (rates.size() != wanted) violations.push_back(CountViolation("rates.values", rates.size(), wanted));
  for (size_t i = 0; i < rates.size() && !IsFull(violations); ++i) {
    if (std::isfinite(rates[i])) continue;
    violations.push_back(MakeViolation(absl::StrCat("rates.values[", i, "]"), rates[i], "be finite"));
  }
}

std::vector<Violation> ValidateRequest(const AuditRequest& request, std::optional<SceneContact>& contact) {
  std::vector<Violation> violations = audit::CheckScene(request.scene, contact);
  const bool has_system = !std::holds_alternative<std::monostate>(request.scene.system);
  if (std::holds_alternative<std::monostate>(request.observed)) {
    violations.push_back(MakeViolation("observed", "is not set", "be one of contact_velocity, rates"));
  } else if (const auto* velocity = std::get_if<ContactVelocity>(&request.observed); velocity != nullptr) {
    if (has_system) CheckVelocity(*velocity, TangentialDirections(request.scene.system), violations);
  } else if (has_system) {
    CheckRates(std::get<ObservedRates>(request.observed).values, request.scene.system, violations);
  }
  const double uncertainty = request.velocity_uncertainty_m_s;
  if (!(uncertainty >= 0.0) || !std::isfinite(uncertainty)) {
    violations.push_back(MakeViolation("velocity_uncertainty_m_s", uncertainty, "be finite and >= 0"));
  }
  return violations;
}

ContactVelocity VelocityOf(const Observed& observed, const Scene& scene) {
  const auto* velocity = std::get_if<ContactVelocity>(&observed);
  return velocity != nullptr ? *velocity : ContactVelocityAt(scene, std::get<ObservedRates>(observed).values);
}

}  // namespace

absl::StatusOr<AuditResponse> AuditScene(const AuditRequest& request, absl::FunctionRef<bool()> stopped) {
  std::optional<SceneContact> contact;
  const std::vector<Violation> violations = ValidateRequest(request, contact);
  if (!violations.empty()) return InvalidRequest(violations);
  const Scene scene = audit::WithoutRestitution(request.scene);
  const ContactVelocity seen = VelocityOf(request.observed, scene);
  const Components& tangential = seen.tangential_m_s;
  if (!FitsDoubles(contact->reduction) || !std::isfinite(seen.normal_m_s) || !std::isfinite(tangential[0]))
    return ContactOverflow();
  audit::Observation observation = {.u1 = {tangential[0], tangential.size() > 1 ? tangential[1] : 0.0},
                                    .v1 = seen.normal_m_s,
                                    .uncertainty = request.velocity_uncertainty_m_s};
  audit::AddTermsBefore(scene, contact->reduction, observation);
  const auto* const rates = std::get_if<ObservedRates>(&request.observed);
  if (rates != nullptr) audit::AddTerms(scene, rates->values, observation);
  absl::StatusOr<AuditReport> report =
      audit::Audit(audit::MakeProblem(scene, *contact, /*from_own_velocity=*/true), observation, stopped);
  if (!report.ok()) return report.status();
  if (rates != nullptr) audit::CheckRates(contact->reduction, rates->values, observation, *report);
  if (const char* path = audit::OverflowIn(*report); path != nullptr) return OutputOverflow(path);
  return AuditResponse{.report = *report, .contact_energy_j = ContactEnergy(contact->reduction), .engine = {}};
}

}  // namespace ricochet
