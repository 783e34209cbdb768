// Nearest: the known name that a misspelled one most likely means.

#ifndef RICOCHET_CORE_SCENE_NEAREST_H_
#define RICOCHET_CORE_SCENE_NEAREST_H_

#include <cstddef>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace ricochet {

// Returns the Levenshtein distance: the fewest characters to be changed, added or removed to make one text the other.
size_t EditDistance(absl::string_view a, absl::string_view b);

// Names the entry of `known` that takes the fewest changed, added or removed characters: "; the nearest is \"...\"". The
// first of several equally near ones counts. Returns an empty text if `known` is empty or `text` is longer than any name.
std::string NearestHint(const std::string& text, const std::vector<std::string>& known);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_NEAREST_H_
