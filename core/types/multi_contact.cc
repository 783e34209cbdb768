#include "core/types/multi_contact.h"

#include <variant>

#include "absl/strings/str_cat.h"

namespace ricochet {

// Takes the number of directions that most lists of a scene of bodies have, so that a wrong list does not accuse the
// others. Returns 0 if none has 2 or 3.
static int DirectionsOf(const FreeBodies& free, const std::vector<MultiContactPoint>& contacts) {
  int in_plane = 0, in_space = 0;
  const auto count = [&](size_t size) {
    if (size == 2) ++in_plane;
    if (size == 3) ++in_space;
  };
  for (const FreeBody& body : free.bodies) {
    count(body.position_m.size());
    count(body.linear_m_s.size());
  }
  for (const MultiContactPoint& contact : contacts) {
    count(contact.point_m.size());
    count(contact.normal.size());
  }
  if (in_plane == 0 && in_space == 0) return 0;
  return in_plane >= in_space ? 2 : 3;
}

int DirectionsOf(const MultiContactScene& scene) {
  struct Finder {
    const std::vector<MultiContactPoint>& contacts;
    // Counts the lists of `each` in `numbers`.
    int Rows(size_t numbers, size_t each) const {
      if (numbers == 2 * contacts.size() * each) return 2;
      return numbers == 3 * contacts.size() * each ? 3 : 0;
    }
    int operator()(std::monostate) const { return 0; }
    int operator()(const ContactMatrix& matrix) const { return Rows(matrix.velocity_m_s.size(), 1); }
    int operator()(const FreeBodies& free) const { return DirectionsOf(free, contacts); }
    int operator()(const Mechanism& mechanism) const { return Rows(mechanism.jacobian.size(), mechanism.rates.size()); }
  };
  return std::visit(Finder{scene.contacts}, scene.system);
}

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
  const auto* const mechanism = std::get_if<Mechanism>(&system);
  for (size_t i = 1; mechanism != nullptr && i <= mechanism->rates.size(); ++i) {
    names.push_back(absl::StrCat("rate_", i));
  }
  return names;
}

}  // namespace ricochet
