// Columns: many planar impacts of one law of restitution at once, in SIMD lanes, and only the outputs asked for.
//
//   const std::array outputs = {Output::kTangentialVelocityAfter, Output::kNormalVelocityAfter};
//   const std::array columns = {u_after.data(), v_after.data()};
//   SolveColumns({.law = law, .wtt = wtt, .wtn = wtn, .wnn = wnn, .u0 = u0, .v0 = v0, .mu = mu, .mu_static = mu_static,
//                 .coefficient = coefficient},
//                1e-12, {.outputs = outputs, .columns = columns, .regimes = regimes, .inadmissible = inadmissible});
//
// Each output is that of the first arithmetic whose bound on its rounding error is within the tolerance: plain double
// arithmetic (SolvePlain), or double-double arithmetic (Solve), with the same bits. At tolerance 0 it is the latter. No
// result depends on the other problems of the call. Nothing is allocated, and calls may run in parallel.

#ifndef RICOCHET_CORE_MODELS_PLANAR_COLUMNS_H_
#define RICOCHET_CORE_MODELS_PLANAR_COLUMNS_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "absl/types/span.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "ricochet/outcome.h"

namespace ricochet::planar {

// The numbers of an outcome that the impact determines (ricochet/outcome_numbers.h has their paths).
enum class Output : uint8_t {
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
  kRelativeError,              // accuracy.relative_error, rounding alone: the largest of RoundingErrors.
};
inline constexpr int kOutputCount = 18;

// Problems, column by column. All columns have the length of `wtt`, and the problems are valid, as those of Solve are; one
// that is not is given v0 = 0 and Wnn = 1 instead, so that it separates, and its results are overwritten afterwards.
struct ProblemColumns {
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  absl::Span<const double> wtt, wtn, wnn;  // 1/kg
  absl::Span<const double> u0, v0;         // m/s
  absl::Span<const double> mu, mu_static;
  absl::Span<const double> coefficient;  // By `law`.

  size_t size() const { return wtt.size(); }
  Problem operator[](size_t i) const;
};

// The outputs asked for, each at most once, and the places of the results. `columns[c][i]` receives output `outputs[c]` of
// the i-th problem, `regimes[i]` its regime, and `inadmissible[i]` whether it breaks a limit. `regimes` and `inadmissible`
// may be empty if they are not wanted. No place may overlap with another or with the problems.
struct SolvedColumns {
  absl::Span<const Output> outputs;
  absl::Span<double* const> columns;
  absl::Span<Regime> regimes;
  absl::Span<bool> inadmissible;
};

// Every output of an impact, at the number of the output.
std::array<double, kOutputCount> NumbersOf(const ImpactEnd<double>& impact, double relative_error);

// The tolerance is in [0, 1) and means what RoundingErrors::Largest does. Returns the number of problems for which plain
// arithmetic did not serve.
size_t SolveColumns(const ProblemColumns& problems, double tolerance, const SolvedColumns& solved);

}  // namespace ricochet::planar

#endif  // RICOCHET_CORE_MODELS_PLANAR_COLUMNS_H_
