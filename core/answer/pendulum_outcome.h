// A pendulum's impact as an Outcome: contact velocities, ledger, timeline, limits broken.

#ifndef RICOCHET_CORE_ANSWER_PENDULUM_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_PENDULUM_OUTCOME_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/models/pendulum/pendulum.h"
#include "ricochet/outcome.h"

namespace ricochet::pendulum {

// Where an output stands in ricochet.v1.Outcome: "coefficients.newton". Empty for those that stand nowhere.
std::string OutputPath(Output output);

// What a model of the pendulum found.
struct Findings {
  Impact impact;
  double error = 0.0;                                 // Proved, of the contact velocity over max(|u0|, |v0|).
  Instant (*at)(const Problem& problem, double tau);  // The contact on the way, where it does not separate.
};

// Errors: OUT_OF_RANGE naming the first output that exceeds the largest double; INVALID_ARGUMENT for each
// history_at_n_s that is not in [0, tau1].
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const Findings& findings,
                                    absl::Span<const double> history_at_n_s, Detail detail);

// The exact impact.
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, absl::Span<const double> history_at_n_s,
                                    Detail detail = Detail::kAll);

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_ANSWER_PENDULUM_OUTCOME_H_
