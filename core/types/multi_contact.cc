#include "core/types/multi_contact.h"

#include <variant>

#include "absl/strings/str_cat.h"

namespace ricochet {

std::vector<std::string> ContactOutputNames(size_t contacts, int directions) {
  std::vector<std::string> names;
  for (size_t contact = 1; contact <= contacts; ++contact) {
    for (int t = 1; t < directions; ++t) {
      names.push_back(absl::StrCat("contact_", contact, ".t", directions == 2 ? "" : absl::StrCat(t)));
    }
    names.push_back(absl::StrCat("contact_", contact, ".n"));
  }
  return names;
}

std::vector<std::string> SystemOutputNames(const MultiContactSystem& system, int directions) {
  std::vector<std::string> names;
  const auto* const free = std::get_if<FreeBodies>(&system);
  for (size_t body = 1; free != nullptr && body <= free->bodies.size(); ++body) {
    const auto add = [&](const char* name) { names.push_back(absl::StrCat("body_", body, ".", name)); };
    if (directions == 2) {
      for (const char* name : {"x", "y", "rate"}) add(name);
    } else {
      for (const char* name : {"x", "y", "z", "rate_x", "rate_y", "rate_z"}) add(name);
    }
  }
  return names;
}

}  // namespace ricochet
