// The pendulum's closed forms as the paper prints them, evaluated in ball arithmetic: the oracle of the core's kernel.
//
// Lubarda (2009). Nothing here guards against cancellation; precision is raised until every result is known to 100 bits
// or, where it cancels, to 2^-170 of its scale. Thresholds are decided in exact arithmetic. Shares no code with core/.

#ifndef RICOCHET_TESTS_SUPPORT_PENDULUM_ORACLE_H_
#define RICOCHET_TESTS_SUPPORT_PENDULUM_ORACLE_H_

#include <array>
#include <cstddef>

#include "core/models/pendulum/pendulum.h"
#include "tests/support/arb.h"

namespace ricochet::pendulum {

struct ExactImpact {
  Regime regime = Regime::kUnspecified;
  bool sharp_limit_broken = false;
  bool energy_limit_broken = false;
  std::array<Ball, kOutputCount> values;
  // What an output that changes sign inside its domain is measured by; 0 for those that do not.
  std::array<Ball, kOutputCount> scales;

  const Ball& operator[](Output output) const { return values[static_cast<size_t>(output)]; }
};

ExactImpact SolveExactly(const Problem& problem);

// Error of output `i` in ulp, beyond the 2^-100 of its scale granted where it changes sign.
double OutputError(const ExactImpact& exact, size_t i, double computed);

struct ExactInstant {
  Ball omega;
  Ball tangential_impulse;
  Ball omega_scale;    // |w-|
  Ball impulse_scale;  // mu tau0
};

// tau >= 0; beyond tau1 the restitution line is continued.
ExactInstant ExactlyAt(const Problem& problem, double tau);

struct ExactRange {
  Ball lower;
  Ball upper;
};

struct ExactCoefficientBounds {
  ExactRange newton;
  ExactRange poisson;
  ExactRange energetic;
  ExactRange tangential;
  ExactRange normal_total;
};

struct ExactBounds {
  Regime regime = Regime::kUnspecified;
  Ball friction_ratio;
  Ball slope_ratio;
  ExactCoefficientBounds sharp;
  ExactCoefficientBounds energy_only;
};

ExactBounds SolveBoundsExactly(const Problem& problem);

// Names of the outputs for messages, in the order of the enumeration.
const std::array<const char*, kOutputCount>& OutputNames();

}  // namespace ricochet::pendulum

#endif  // RICOCHET_TESTS_SUPPORT_PENDULUM_ORACLE_H_
