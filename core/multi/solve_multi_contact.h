// SolveMultiContact: the answer to a request about several contacts, from its scene reduced to W.
//
// It scales each state by powers of two, sorts its contacts (core/multi/mirror.h), asks for orders, springs and the
// possible outcomes, compares them and says whether the order matters. Bad input: none gets here
// (core/scene/validate_multi.h). Errors: OUT_OF_RANGE if a number of the answer lies above the largest double,
// CANCELLED once `stopped` says true.

#ifndef RICOCHET_CORE_MULTI_SOLVE_MULTI_CONTACT_H_
#define RICOCHET_CORE_MULTI_SOLVE_MULTI_CONTACT_H_

#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/contact/multi_reduction.h"
#include "ricochet/multi_contact.h"

namespace ricochet {

absl::StatusOr<std::vector<MultiContactAnswer>> SolveMultiContact(const MultiContactRequest& request,
                                                                  const MultiReduction& reduction,
                                                                  absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_MULTI_SOLVE_MULTI_CONTACT_H_
