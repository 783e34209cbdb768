// Nearest: the known name that a misspelled one most likely means.

#ifndef RICOCHET_CORE_BASE_NEAREST_H_
#define RICOCHET_CORE_BASE_NEAREST_H_

#include <cstddef>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace ricochet {

// Returns the Levenshtein distance: the fewest characters to be changed, added or removed to make one text the other.
size_t EditDistance(absl::string_view a, absl::string_view b);

// Returns the entry "NAME[0]", whose index is missing, else the only path among `known` that ends in `name` after a
// dot. If there is neither, it returns the entry to which `name` has the least distance, the first of several, if that
// is at most two, or a third of the characters of `name` after those with which both begin. Returns an empty text if no
// entry is so near, or if `name` is longer than any name.
std::string NearestName(absl::string_view name, const std::vector<std::string>& known);

// Returns "; did you mean NEAREST?", or an empty text if no known name is near.
std::string DidYouMean(absl::string_view name, const std::vector<std::string>& known);

}  // namespace ricochet

#endif  // RICOCHET_CORE_BASE_NEAREST_H_
