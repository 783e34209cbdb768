// Made: the outcome that a model's MakeOutcome writes into its argument.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_MADE_OUTCOME_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_MADE_OUTCOME_H_

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/answer/outcome_parts.h"
#include "ricochet/outcome.h"

namespace ricochet {

inline absl::StatusOr<Outcome> Made(absl::FunctionRef<absl::Status(Outcome&)> make) {
  Outcome outcome;
  const absl::Status status = make(outcome);
  if (!status.ok()) return status;
  return outcome;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_MADE_OUTCOME_H_
