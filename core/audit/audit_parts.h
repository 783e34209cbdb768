// The parts of an audit of a scene that one impact and a batch share.

#ifndef RICOCHET_CORE_AUDIT_AUDIT_PARTS_H_
#define RICOCHET_CORE_AUDIT_AUDIT_PARTS_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "core/audit/audit.h"
#include "core/contact/scene_contact.h"
#include "ricochet/audit.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet::audit {

// Lists what makes the scene no contact to audit. Its restitution and impact law may be left unset.
// `contact` is that of a scene without violations.
std::vector<Violation> CheckScene(const Scene& scene, std::optional<SceneContact>& contact);

// Removes the restitution and the impact law, which an audit does not use.
Scene WithoutRestitution(Scene scene);

// Adds the terms of the velocity of the contact at these rates of the scene's system.
void AddTerms(const Scene& scene, absl::Span<const double> rates, Observation& seen);
// Adds the terms before the impact.
void AddTermsBefore(const Scene& scene, const AnyReduction& reduction, Observation& seen);

// Calls a report of what was seen unexplained if its impulse does not make these velocities of the system, to within
// rounding and what the uncertainty of the contact velocity changes in them.
void CheckRates(const AnyReduction& reduction, absl::Span<const double> rates, const Observation& seen,
                AuditReport& report);

// Makes the problem whose path an observation is held against: a pendulum's closed form where the scene has one and its
// own velocity is meant, else the scene's contact.
AnyProblem MakeProblem(const Scene& scene, const SceneContact& contact, bool from_own_velocity);

}  // namespace ricochet::audit

#endif  // RICOCHET_CORE_AUDIT_AUDIT_PARTS_H_
