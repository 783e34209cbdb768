// Pendulum oracle: the closed forms as Lubarda (2009) prints them, in ball arithmetic, to test the core's kernel.
//
// Nothing here guards against cancellation. Instead the precision is raised until every result is known to 100 bits or,
// if it cancels, to 2^-170 of its scale. Thresholds are decided in exact arithmetic. No code is shared with core/.

#ifndef RICOCHET_TESTS_SUPPORT_ORACLES_PENDULUM_ORACLE_H_
#define RICOCHET_TESTS_SUPPORT_ORACLES_PENDULUM_ORACLE_H_

#include <array>
#include <cstddef>

#include "core/models/pendulum/pendulum.h"
#include "tests/support/oracles/arb.h"

namespace ricochet::pendulum {

struct ExactImpact {
  Regime regime = Regime::kUnspecified;
  bool sharp_limit_broken = false;
  bool energy_limit_broken = false;
  std::array<Ball, kOutputCount> values;
  // The scale of an output that changes sign inside its domain; 0 for all other outputs.
  std::array<Ball, kOutputCount> scales;

  const Ball& operator[](Output output) const { return values[static_cast<size_t>(output)]; }
};

ExactImpact SolveExactly(const Problem& problem);

// Error of output `i` in ulp. An output that changes its sign is allowed 2^-100 of its scale in addition.
double OutputError(const ExactImpact& exact, size_t i, double computed);

struct ExactInstant {
  Ball omega;
  Ball tangential_impulse;
  Ball omega_scale;    // |omega-|
  Ball impulse_scale;  // mu tau0
};

// The state at tau >= 0. Beyond tau1 the line of restitution is continued.
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

#endif  // RICOCHET_TESTS_SUPPORT_ORACLES_PENDULUM_ORACLE_H_
