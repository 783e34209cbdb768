// The two solvers that must not differ, and the scenes to try them on.

#ifndef RICOCHET_TESTS_CONTRACT_SOLVERS_H_
#define RICOCHET_TESTS_CONTRACT_SOLVERS_H_

#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "ricochet/solver.h"

namespace ricochet {

const Solver& Local();
// Of a ricochetd that was started for this process.
const Solver& Remote();

// The scene whose problem (core/models/pendulum/pendulum.h) this is.
Scene MakeScene(const pendulum::Problem& problem);

// mu = 0.1, a/b = 0.3, elastic: x = 1/3, r = 1/2. Lubarda (2009), sec. 4.
Scene PaperScene();

// Every element of a sweep, the error included.
std::vector<absl::StatusOr<SweepChunk>> Collect(SweepStream stream);

// Everything that tells two failures apart.
void ExpectSameStatus(const absl::Status& one, const absl::Status& other);

}  // namespace ricochet

#endif  // RICOCHET_TESTS_CONTRACT_SOLVERS_H_
