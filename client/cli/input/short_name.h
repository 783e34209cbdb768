// Short names of fields and columns: "newton" for coefficients.newton, "mu" for friction.kinetic_coefficient.

#ifndef RICOCHET_CLIENT_CLI_INPUT_SHORT_NAME_H_
#define RICOCHET_CLIENT_CLI_INPUT_SHORT_NAME_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/io/csv_table.h"
#include "client/cli/text/number_input.h"
#include "ricochet/scene.h"

namespace ricochet::cli {

// Returns the entry of `known` that `name` means: itself, or the only one that ends in it, with or without its unit
// ("theta", "links[1].theta"). Letters of the paper and names of flags (mu, phi, omega) mean their fields. A name that
// means none is returned as it is, for the solver to refuse.
// Errors: INVALID_ARGUMENT, led by `what`, for a name that means several, which are listed one a line, or that is
// nearly the last part of a known name.
absl::StatusOr<std::string> FullName(const std::string& name, const std::vector<std::string>& known,
                                     const std::string& what);

// Returns the full path of the field of the scene that `name` means. Errors: those of FullName.
absl::StatusOr<std::string> FullField(const Scene& scene, const std::string& name, const std::string& what);

// Says how the number at the path of a field may be written.
Spelling SpellingOf(const std::string& path);
CellKind CellKindOf(const std::string& path);

// Returns the columns of the scene that `names`, the values of --column, mean; "coefficients.*" means all that start
// with "coefficients.", and spaces around a name do not count. Errors: those of FullName.
absl::StatusOr<std::vector<std::string>> FullColumns(const Scene& scene, const std::vector<std::string>& names);

// Looks among the columns of a file: "*" stands for those that are `known`, a name for one of `places`.
absl::StatusOr<std::vector<std::string>> FullColumns(const std::vector<std::string>& known,
                                                     const std::vector<std::string>& places,
                                                     const std::vector<std::string>& names);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_SHORT_NAME_H_
