// Mirror: a symmetry of a scene that swaps contacts, and the order in which its contacts are computed.
//
// A symmetric scene has a symmetric answer, but rounding breaks the tie. Averaging a state with its mirror image keeps
// it symmetric bit for bit. Contacts are computed in an order that their numbers give, and not their places in the
// scene, so that permuting the contacts permutes the answer.

#ifndef RICOCHET_CORE_MULTI_MIRROR_H_
#define RICOCHET_CORE_MULTI_MIRROR_H_

#include <array>
#include <optional>

#include "core/multi/problem.h"

namespace ricochet::multi {

// Contact i is the image of contact `image[i]`, and its tangential direction that of the other times `sign[i]`. Twice
// the map is the identity.
struct Mirror {
  std::array<int, kMostContacts> image{};
  std::array<double, kMostContacts> sign{};

  // Averages the kd = 2k numbers of the contacts of a plane with their image.
  void Average(Vector& x) const;
  // Averages numbers of which each contact has one that does not change its sign.
  void Average(std::array<double, kMostContacts>& x) const;
};

// A problem in a plane whose contacts are sorted by their numbers, and whose tangential directions are turned so that
// slip is not negative.
struct SortedProblem {
  Problem problem;
  std::array<int, kMostContacts> from{};     // The place of each contact in the scene.
  std::array<double, kMostContacts> sign{};  // 1, or -1 if its tangential direction was turned.
  std::optional<Mirror> mirror;              // In space there is none.

  // Numbers of the contacts in the order of the scene, and back.
  Vector InScene(const Vector& sorted) const;
  Vector FromScene(const Vector& scene) const;
};

SortedProblem Sort(const Problem& problem);

// Returns the mirror of a problem, in the order of its own contacts; nothing in space or if it has none.
std::optional<Mirror> MirrorOf(const Problem& problem);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_MIRROR_H_
