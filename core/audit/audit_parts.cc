#include "core/audit/audit_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <variant>

#include "core/contact/moved_contact.h"
#include "core/plan/scene_problem.h"
#include "core/scene/validate.h"

namespace ricochet::audit {

namespace {

// Lists why no audit can take a contact whose scene keeps its rules.
std::vector<Violation> CheckContact(const Scene& scene, const SceneContact& contact) {
  std::vector<Violation> violations;
  if (std::visit([](const auto& reduction) { return reduction.w.back() == 0.0; }, contact.reduction)) {
    violations.push_back(MakeViolation("system", "makes Wnn = 0",
                                       "be > 0 for an audit, no normal impulse moves the contact",
                                       ViolationKind::kContact));
    return violations;
  }
  const bool is_covered = std::visit(
      [](const auto& reduction) { return reduction.v0 >= 0.0 || VelocityIsInRange(reduction); }, contact.reduction);
  if (!is_covered) {
    violations.push_back(MakeViolation(scene.surface_velocity.has_value() ? "surface_velocity" : "system",
                                       "makes a contact velocity beside the range of W, whose rank is not full",
                                       "lie in it for an "
                                       "audit, which knows no impact of this kind",
                                       ViolationKind::kContact));
  }
  return violations;
}

}  // namespace

std::vector<Violation> CheckScene(const Scene& scene, std::optional<SceneContact>& contact) {
  // An audit does not use the law of speed, whose restitution may be invalid at the observed speed.
  std::optional<Scene> without_law;
  if (scene.restitution_by_speed.has_value()) without_law.emplace(scene).restitution_by_speed.reset();
  std::vector<Violation> violations =
      Validate(without_law.has_value() ? *without_law : scene, RestitutionIs::kOptional, contact);
  if (violations.empty()) RequireRigid(scene, RigidIn::kNormal, "for an audit", violations);
  if (!violations.empty()) return violations;
  if (!contact.has_value()) contact.emplace(scene);
  return CheckContact(scene, *contact);
}

Scene WithoutRestitution(Scene scene) {
  scene.restitution = std::monostate();
  scene.restitution_by_speed.reset();
  scene.impact_law = std::monostate();
  return scene;
}

namespace {

// The share of a velocity that counts as rounding.
constexpr double kRounding = 1e-9;

// Returns the largest speed of the contact along one direction, before and after, with the terms of both.
template <typename Reduction>
double SpeedOf(const Reduction& reduction, const Observation& seen) {
  double speed = std::fabs(reduction.v0) + std::fabs(seen.v1) + seen.v_terms;
  for (size_t a = 0; a < reduction.u0.size(); ++a)
    speed = std::max(speed, std::fabs(reduction.u0[a]) + std::fabs(seen.u1[a]) + seen.u_terms[a]);
  return speed;
}

// Returns the difference between one velocity of the system and `expected`, which the impulse gives it, as the contact
// speed with the same effect; 0 where `uncertainty` of the contact velocity or rounding explains it.
template <typename Reduction>
double DistanceOf(const Reduction& reduction, size_t place, double rate, double expected, double uncertainty,
                  const std::array<double, Reduction::kDirections>& impulse) {
  double size = std::fabs(rate) + std::fabs(reduction.before[place]), by_speed = 0.0;
  for (size_t a = 0; a < Reduction::kDirections; ++a) {
    const double response = reduction.response[place * Reduction::kDirections + a];
    const double mobility = reduction.w[a * Reduction::kDirections - a * (a - 1) / 2];
    size += std::fabs(response * impulse[a]);
    if (mobility > 0.0) by_speed += std::fabs(response) / mobility;
  }
  const double miss = std::fabs(rate - expected);
  if (!(miss > by_speed * uncertainty + kRounding * size)) return 0.0;
  return by_speed > 0.0 ? miss / by_speed : miss;
}

}  // namespace

void AddTerms(const Scene& scene, absl::Span<const double> rates, Observation& seen) {
  const ContactVelocity size = SizeOfTerms(scene, rates);
  for (size_t a = 0; a < size.tangential_m_s.size(); ++a) seen.u_terms[a] += size.tangential_m_s[a];
  seen.v_terms += size.normal_m_s;
}

void AddTermsBefore(const Scene& scene, const AnyReduction& reduction, Observation& seen) {
  std::visit([&](const auto& of) { AddTerms(scene, of.before, seen); }, reduction);
}

void CheckRates(const AnyReduction& reduction, absl::Span<const double> rates, const Observation& seen,
                AuditReport& report) {
  if (report.unexplained || report.regime == Regime::kInvalid) return;
  std::visit(
      [&](const auto& of) {
        using Reduction = std::decay_t<decltype(of)>;
        std::array<double, Reduction::kDirections - 1> tangential;
        std::array<double, Reduction::kDirections> impulse;
        std::copy_n(report.tangential_impulse.begin(), tangential.size(), tangential.begin());
        std::copy(tangential.begin(), tangential.end(), impulse.begin());
        impulse.back() = report.normal_impulse;
        const auto expected = of.After(tangential, report.normal_impulse);
        // What is left where impulses cancel is only the rounding of speeds.
        const double uncertainty = seen.uncertainty + kRounding * SpeedOf(of, seen);
        for (size_t i = 0; i < rates.size(); ++i) {
          const double distance = DistanceOf(of, i, rates[i], expected[i], uncertainty, impulse);
          report.distance = std::max(report.distance, distance);
        }
      },
      reduction);
  report.unexplained = report.distance > 0.0;
  report.admissible = report.admissible && !report.unexplained;
}

AnyProblem MakeProblem(const Scene& scene, const SceneContact& contact, bool from_own_velocity) {
  if (from_own_velocity && HasClosedForm(scene)) return ClosedFormProblem(scene);
  const AnyReduction& any = contact.reduction;
  EffectiveCoefficients effective = contact.coefficients;
  effective.restitution = 0.0;  // The path up to an observed impulse does not depend on it.
  if (const auto* planar = std::get_if<PlanarReduction>(&any)) {
    return planar::MakeProblem(*planar, EnergeticCoefficient(), effective);
  }
  return spatial::MakeProblem(std::get<SpatialReduction>(any), EnergeticCoefficient(), effective,
                              spatial::kStudyTolerance);
}

}  // namespace ricochet::audit
