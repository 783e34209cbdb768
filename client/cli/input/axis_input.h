// Reads axes and ranges of a sweep, and ranges of fields, as a user types them; prints the names that they may have
// where the user types a question mark: `--axis ?`, `--column ?` and `--range ?`.

#ifndef RICOCHET_CLIENT_CLI_INPUT_AXIS_INPUT_H_
#define RICOCHET_CLIENT_CLI_INPUT_AXIS_INPUT_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/input/command_options.h"
#include "client/cli/input/scene_input.h"
#include "ricochet/scene.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

// Reads "PATH=0.1,1/3,0.5", "PATH=lin:START:STOP:COUNT" or "PATH=log:START:STOP:COUNT" for an axis of the scene. PATH
// may be short (client/cli/input/short_name.h), and values of an angle may be in degrees, "10deg".
// Errors: INVALID_ARGUMENT for another form, and those of FullName. The solver checks that the path exists and the
// values are valid.
absl::StatusOr<Axis> ParseAxis(const std::string& text, const Scene& scene);

// Reads "FIRST:END" into the range of `request`; an end that is empty stays as it is. Errors: INVALID_ARGUMENT.
absl::Status ReadRange(const std::string& text, SweepRequest& request);

// Reads "PATH=LOW:HIGH" by the rules of ParseAxis.
absl::StatusOr<FieldRange> ParseFieldRange(const std::string& text, const Scene& scene);

// True if an option was given once, as a question mark.
bool AsksForNames(const std::vector<std::string>& values);

// Prints the names of the scene, one a line; without a scene those of a pendulum.
// Errors: INVALID_ARGUMENT for another format than text, and those of ReadScene and Output.
absl::Status ListNames(const CommonOptions& common, const SceneOptions& options,
                       std::vector<std::string> (*names_of)(const Scene&));

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_AXIS_INPUT_H_
