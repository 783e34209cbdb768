// The self-test: a server proves that it computes before it says that it serves.

#ifndef RICOCHET_SERVER_HEALTH_SELF_TEST_H_
#define RICOCHET_SERVER_HEALTH_SELF_TEST_H_

#include "absl/status/status.h"
#include "ricochet/solver.h"

namespace ricochet::server {

// Solves one impact whose answer is known exactly, and compares. A build for another processor, or a broken one, fails.
// Errors: INTERNAL, with the answer expected and the one found; those of the solver.
absl::Status TestSolver(const Solver& solver);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_HEALTH_SELF_TEST_H_
