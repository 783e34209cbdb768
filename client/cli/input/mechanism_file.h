// Mechanism file: a mechanism as numpy.savez or numpy.savez_compressed writes it, with the arrays M (n x n), J (2 x n
// or 3 x n, for each contact) and qdot (n), of any real floating type or integers, in C or Fortran order.

#ifndef RICOCHET_CLIENT_CLI_INPUT_MECHANISM_FILE_H_
#define RICOCHET_CLIENT_CLI_INPUT_MECHANISM_FILE_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "ricochet/system.h"

namespace ricochet::cli {

// Reads the mechanism. Its shapes fit together; its numbers are left to the solver.
// Errors: INVALID_ARGUMENT that names the file, and the array that is missing, or its type or shape and what is right.
absl::StatusOr<Mechanism> ReadMechanism(const std::string& path, int64_t contacts = 1);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_MECHANISM_FILE_H_
