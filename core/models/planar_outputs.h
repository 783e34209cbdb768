// Planar impacts in columns: the problems, the outputs and the places of results that all planar models in SIMD lanes
// share.

#ifndef RICOCHET_CORE_MODELS_PLANAR_OUTPUTS_H_
#define RICOCHET_CORE_MODELS_PLANAR_OUTPUTS_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "absl/types/span.h"
#include "core/models/planar_problem.h"
#include "core/models/restitution_law.h"
#include "ricochet/outcome.h"

namespace ricochet {

// The numbers of an outcome that the impact determines.
enum class PlanarOutput : uint8_t {
  kNewton,
  kPoisson,
  kEnergetic,
  kTangentialCoefficient,
  kTangentialVelocityAfter,
  kNormalVelocityAfter,
  kNormalImpulseCompression,
  kNormalImpulse,
  kTangentialImpulse,
  kWorkNormalCompression,
  kWorkNormalRestitution,
  kWorkTangentialCompression,
  kWorkTangentialRestitution,
  kWorkNormal,
  kWorkTangential,
  kFrictionDissipation,
  kEnergyChange,
  kRelativeError,  // accuracy.relative_error of the model's own rounding
};

// Their paths (ricochet/outcome_numbers.h), as far as they are columns of lanes.
inline constexpr std::array kPlanarOutputPaths = {"coefficients.newton",
                                                  "coefficients.poisson",
                                                  "coefficients.energetic",
                                                  "coefficients.tangential",
                                                  "contact_velocity_after.tangential_m_s[0]",
                                                  "contact_velocity_after.normal_m_s",
                                                  "impulse.normal_compression_n_s",
                                                  "impulse.normal_total_n_s",
                                                  "impulse.tangential_n_s[0]",
                                                  "work.normal_compression_j",
                                                  "work.normal_restitution_j",
                                                  "work.tangential_compression_j",
                                                  "work.tangential_restitution_j",
                                                  "work.normal_total_j",
                                                  "work.tangential_total_j",
                                                  "work.friction_dissipation_j",
                                                  "energy_change_j"};
inline constexpr int kPlanarOutputCount = kPlanarOutputPaths.size() + 1;

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
