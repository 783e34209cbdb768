// Compliant: an impact in a plane whose contact gives way along the surface as well as into it (W. J. Stronge's lumped
// contact, Impact Mechanics, 2000, chapter 5).
//
// A massless particle between the body and the rough surface is held to the body by a normal and a tangential spring;
// friction on it obeys |F| <= mu N. Solve computes velocities and impulses after the impact from W, (u0, v0), mu, the
// energetic coefficient eta and ratio^2, the tangential over the normal compliance; no stiffness is needed. SI units.
// Method: slides are algebra in the normal impulse, sticks two sinusoids in time, without a step size.
// Accuracy: error_estimate, 1e-16 to 1e-14 for everyday contacts; infinite where the impact has no end (wedged).
// Inputs or ratios of inputs beyond 1e100 either way may overflow: what is not finite then is not known.
// Bad input: none gets here (core/scene/validate.h).
// Model, regimes, derivations and limits: docs/theory/compliant.md.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_COMPLIANT_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_COMPLIANT_H_

#include <vector>

#include "core/models/impact_end.h"
#include "core/models/impact_errors.h"
#include "core/models/planar_problem.h"

namespace ricochet::compliant {

// The law is energetic and static friction the same as kinetic friction: `law` and `mu_static` are not read.
struct Problem {
  PlanarProblem contact;       // eta = 0 needs mu |Wtn| < Wnn.
  double ratio_squared = 0.0;  // Tangential over normal compliance, > 0
};

// Smaller coefficients of restitution are computed as 0, which no velocity can tell.
inline constexpr double kLeastEnergetic = 0x1p-200;

// The state of the particle under friction.
enum class FrictionState { kStick, kSlideForward, kSlideBackward };

// A section of the path: one friction state, on one branch of the normal spring, in one direction of v.
struct Section {
  FrictionState friction = FrictionState::kStick;
  bool first_loading = true;                    // False on the branch of unloading.
  bool indenting = true;                        // v < 0; true on first loading.
  double tau = 0.0, f = 0.0, u = 0.0, v = 0.0;  // Where it starts.
};

// An impact that has not ended after so many sections is wedged.
inline constexpr int kMaxSections = 100'000;

// Smaller values can use up the budget: here random everyday contacts have 73,000 sections at most.
inline constexpr double kLeastRatioSquared = 1e-9;

// No limit of a coefficient or of the energy is ever broken. Compression ends at the last time that d = d_max.
struct Impact : ImpactEnd<double> {
  double f_compression = 0.0;
  double work_normal = 0.0;           // Net work of the normal force, <= 0, accurate to its last digits for any eta.
  double friction_dissipation = 0.0;  // >= 0
  double spring_energy = 0.0;         // Lost with the tangential spring, >= 0.
  double error_estimate = 0.0;        // Error of the velocities over max(|u0|, |v0|).
  ImpactErrors errors;                // Works and impulses have none if W has rank one.
  std::vector<Section> sections;      // Empty for a separating contact.
};

Impact Solve(const Problem& problem);

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_COMPLIANT_H_
