// Counted: a number of things in words.

#ifndef RICOCHET_CORE_BASE_COUNTED_H_
#define RICOCHET_CORE_BASE_COUNTED_H_

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace ricochet {

// Returns "1 point" or "3 points" for the noun "point".
template <typename Integer>
std::string Counted(Integer count, absl::string_view noun) {
  return absl::StrCat(count, " ", noun, count == 1 ? "" : "s");
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_BASE_COUNTED_H_
