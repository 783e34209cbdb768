// The report of a path: an Impact in the units of the problem, made from numbers in natural units.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_REPORT_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_REPORT_H_

#include <vector>

#include "core/models/finite_duration/finite_duration.h"
#include "core/models/finite_duration/path.h"
#include "core/models/finite_duration/scaled_contact.h"

namespace ricochet::finite_duration {

// The error, the costs and the history are left to the caller.
Impact MakeImpact(const Problem& problem, const ScaledContact& contact, const Path& path);

std::vector<ForceSample> InUnitsOfScene(const ScaledContact& contact, const std::vector<ForceSample>& samples);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_REPORT_H_
