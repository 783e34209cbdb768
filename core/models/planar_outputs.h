// Planar impacts in columns: the problems, the outputs and the places of results that all planar models in SIMD lanes
// share.

#ifndef RICOCHET_CORE_MODELS_PLANAR_OUTPUTS_H_
#define RICOCHET_CORE_MODELS_PLANAR_OUTPUTS_H_

#include <cstddef>
#include <cstdint>

#include "absl/types/span.h"
#include "core/models/planar_problem.h"
#include "core/models/restitution_law.h"
#include "ricochet/outcome.h"

namespace ricochet {

// The numbers of an outcome that the impact determines (ricochet/outcome_numbers.h has their paths).
enum class PlanarOutput : uint8_t {
  kNewton,                     // coefficients.newton
  kPoisson,                    // coefficients.poisson
  kEnergetic,                  // coefficients.energetic
  kTangentialCoefficient,      // coefficients.tangential
  kTangentialVelocityAfter,    // contact_velocity_after.tangential_m_s[0]
  kNormalVelocityAfter,        // contact_velocity_after.normal_m_s
  kNormalImpulseCompression,   // impulse.normal_compression_n_s
  kNormalImpulse,              // impulse.normal_total_n_s
  kTangentialImpulse,          // impulse.tangential_n_s[0]
  kWorkNormalCompression,      // work.normal_compression_j
  kWorkNormalRestitution,      // work.normal_restitution_j
  kWorkTangentialCompression,  // work.tangential_compression_j
  kWorkTangentialRestitution,  // work.tangential_restitution_j
  kWorkNormal,                 // work.normal_total_j
  kWorkTangential,             // work.tangential_total_j
  kFrictionDissipation,        // work.friction_dissipation_j
  kEnergyChange,               // energy_change_j
  kRelativeError,              // accuracy.relative_error of the model's own rounding.
};
inline constexpr int kPlanarOutputCount = 18;

// Problems, column by column. All columns have the length of `wtt`.
struct PlanarProblemColumns {
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  absl::Span<const double> wtt, wtn, wnn;  // 1/kg
  absl::Span<const double> u0, v0;         // m/s
  absl::Span<const double> mu, mu_static;
  absl::Span<const double> coefficient;  // By `law`.

  size_t size() const { return wtt.size(); }
  PlanarProblem operator[](size_t i) const {
    return {.w = {wtt[i], wtn[i], wnn[i]},
            .u0 = u0[i],
            .v0 = v0[i],
            .mu = mu[i],
            .mu_static = mu_static[i],
            .law = law,
            .coefficient = coefficient[i]};
  }
};

// The outputs asked for, each at most once, and the places of the results. `columns[c][i]` receives output `outputs[c]`
// of the i-th problem, `regimes[i]` its regime, and `inadmissible[i]` whether it breaks a limit. `regimes` and
// `inadmissible` may be empty if they are not wanted. No place may overlap with another or with the problems.
struct PlanarSolvedColumns {
  absl::Span<const PlanarOutput> outputs;
  absl::Span<double* const> columns;
  absl::Span<Regime> regimes;
  absl::Span<bool> inadmissible;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_MODELS_PLANAR_OUTPUTS_H_
