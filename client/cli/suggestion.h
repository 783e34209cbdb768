// Suggestions: the known name that a misspelt one probably means.

#ifndef RICOCHET_CLIENT_CLI_SUGGESTION_H_
#define RICOCHET_CLIENT_CLI_SUGGESTION_H_

#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace ricochet::cli {

// Returns the known name that takes the fewest letters to be inserted, deleted or replaced to become `name`, if they are
// at most a third of its letters, or two. Otherwise returns an empty text.
std::string NearestName(absl::string_view name, const std::vector<std::string>& known);

// Returns "; did you mean NEAREST?", or an empty text if no known name is near.
std::string DidYouMean(absl::string_view name, const std::vector<std::string>& known);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SUGGESTION_H_
