// Counted: a number of things in words.

#ifndef RICOCHET_CORE_BASE_COUNTED_H_
#define RICOCHET_CORE_BASE_COUNTED_H_

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"

namespace ricochet {

// Returns "1 point" or "3 points" for the noun "point", and "1 entry" or "3 entries" for "entry".
template <typename Integer>
std::string Counted(Integer count, absl::string_view noun) {
  if (count == 1) return absl::StrCat(count, " ", noun);
  const char* const ending = absl::ConsumeSuffix(&noun, "y") ? "ies" : "s";
  return absl::StrCat(count, " ", noun, ending);
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_BASE_COUNTED_H_
