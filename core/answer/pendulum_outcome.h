// MakeOutcome for a pendulum: contact velocities, works, timeline, and the limits broken.

#ifndef RICOCHET_CORE_ANSWER_PENDULUM_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_PENDULUM_OUTCOME_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/models/pendulum/pendulum.h"
#include "ricochet/outcome.h"

namespace ricochet::pendulum {

// The path of an output in ricochet.v1.Outcome, such as "coefficients.newton"; empty if it is not in an outcome.
std::string OutputPath(Output output);

// The result of a model of the pendulum.
struct Findings {
  Impact impact;
  double error = 0.0;                                 // Proved bound for the contact velocity over max(|u0|, |v0|).
  Instant (*at)(const Problem& problem, double tau);  // State at tau; not called if the contact separates.
};

// Errors: OUT_OF_RANGE names the first output that exceeds the largest double; INVALID_ARGUMENT for each
// history_at_n_s that is not in [0, tau1].
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const Findings& findings,
                                    absl::Span<const double> history_at_n_s, Detail detail);

// Makes the outcome of the exact model.
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, absl::Span<const double> history_at_n_s,
                                    Detail detail = Detail::kAll);

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_ANSWER_PENDULUM_OUTCOME_H_
