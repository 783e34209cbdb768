// CheckShape: checks that the lists of an answer have the lengths that its request asks for, so that a caller may rely
// on them whatever a server sends.

#ifndef RICOCHET_CLIENT_ANSWER_SHAPE_H_
#define RICOCHET_CLIENT_ANSWER_SHAPE_H_

#include "absl/status/status.h"
#include "ricochet/fit.h"
#include "ricochet/multi_contact.h"
#include "ricochet/solver.h"

namespace ricochet {

// Errors: DATA_LOSS that names the list, its length and the right one.
absl::Status CheckShape(const SolveRequest& request, const SolveResponse& response);
absl::Status CheckShape(const FitRequest& request, const FitResponse& response);
absl::Status CheckShape(const MultiContactRequest& request, const MultiContactResponse& response);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_ANSWER_SHAPE_H_
