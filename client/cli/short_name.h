// Short names of fields and columns: "newton" for coefficients.newton, "mu" for friction.kinetic_coefficient.

#ifndef RICOCHET_CLIENT_CLI_SHORT_NAME_H_
#define RICOCHET_CLIENT_CLI_SHORT_NAME_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "ricochet/scene.h"

namespace ricochet::cli {

// Returns the entry of `known` that `name` means: itself, or the only one that ends in it, with or without its unit
// ("theta", "links[1].theta"). Letters of the paper and names of flags (mu, phi, omega) mean their fields. A name that
// means none is returned as it is, for the solver to refuse.
// Errors: INVALID_ARGUMENT, led by `what`, for a name that means several, which are listed one a line, or that is nearly
// the last part of a known name.
absl::StatusOr<std::string> FullName(const std::string& name, const std::vector<std::string>& known,
                                     const std::string& what);

// Puts the full path of a field of the scene in place of a short name. Errors: those of FullName.
absl::Status ExpandField(const Scene& scene, const std::string& what, std::string& path);

// Returns the columns of the scene that `names` mean; "coefficients.*" means all that start with "coefficients.", and
// spaces around a name do not count. Errors: those of FullName.
absl::StatusOr<std::vector<std::string>> FullColumns(const Scene& scene, const std::vector<std::string>& names);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SHORT_NAME_H_
