// The two solvers that must give the same answers, and scenes for them.

#ifndef RICOCHET_TESTS_CONTRACT_SOLVERS_H_
#define RICOCHET_TESTS_CONTRACT_SOLVERS_H_

#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "ricochet/solver.h"

namespace ricochet {

const Solver& Local();
// Returns a client of a ricochetd that was started for this process.
const Solver& Remote();

// Returns the scene of this problem (core/models/pendulum/pendulum.h).
Scene MakeScene(const pendulum::Problem& problem);

// Returns the elastic pendulum of Lubarda (2009), sec. 4: mu = 0.1, a/b = 0.3, x = 1/3, r = 1/2.
Scene PaperScene();

// Reads every element of a sweep, including the error.
std::vector<absl::StatusOr<SweepChunk>> Collect(SweepStream stream);

// Expects that two statuses are equal in every part: code, message, reason and violations.
void ExpectSameStatus(const absl::Status& one, const absl::Status& other);

}  // namespace ricochet

#endif  // RICOCHET_TESTS_CONTRACT_SOLVERS_H_
