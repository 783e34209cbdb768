// Impulse changes: bounds on what small errors of a contact make of the impulses of a rigid impact.
//
// A is the impact that was computed, B the one whose W, velocity before and coefficients differ by no more than the
// errors stated. Friction opposes slip, so that u and v of B stay near those of A at every normal impulse, in whatever
// way slip stops, turns or starts again. What is left is how far that moves the ends of compression and restitution: an
// error of v over the slope of v there. docs/theory/mechanism.md derives the bound. It takes no further impact.
//
// In a plane it is proved. In space it takes the slopes of v at the two ends alone, which proves it unless v almost
// returns to 0 in between. The errors of A itself come on top. No bound is known, and it is infinite, where the model
// is not that of a rigid contact under Coulomb's law, where static friction alone holds the contact or may do so, where
// rounding may decide whether the contact approaches or locks, and where Wtt is singular by anything but rows that are
// 0 and a single free coordinate. One or two free coordinates alone lock where B surely does.

#ifndef RICOCHET_CORE_ANSWER_IMPULSE_CHANGES_H_
#define RICOCHET_CORE_ANSWER_IMPULSE_CHANGES_H_

#include <array>
#include <cstddef>
#include <optional>

#include "core/contact/reduction.h"
#include "core/models/restitution_law.h"
#include "ricochet/outcome.h"

namespace ricochet {

// Bounds on errors, all >= 0. A row of W that is 0 has none.
template <size_t kTangential>
struct ContactErrors {
  std::array<std::array<double, kTangential + 1>, kTangential + 1> w = {};  // 1/kg, both triangles
  std::array<double, kTangential + 1> velocity = {};                        // u0, then v0, m/s
  EffectiveCoefficients coefficients;                                       // 0 where a coefficient is constant.
};

// Impulses along t, or t1 and t2, then n, in N s.
template <size_t kTangential>
using Impulses = std::array<double, kTangential + 1>;

// Freedom says what moves the contact point of A and of B.
enum class Freedom {
  kMany,             // Two free coordinates or more.
  kTwoAlone,         // Two, where nothing else moves: v is a multiple of the part of u along one direction.
  kOneBesideOthers,  // One free coordinate, so that W = y y^T. Coordinates that are held, or the surface, move, too.
  kOneAlone,         // Nothing else moves: (u, v) = y q', and both impacts lock where one does.
};

// The outcome is that of the reduction, with its timeline and its effective coefficients. Returns nothing if B surely
// ends with all free coordinates at rest.
template <size_t kTangential>
std::optional<Impulses<kTangential>> ImpulseChanges(const Reduction<kTangential>& reduction, RestitutionLaw law,
                                                    const ContactErrors<kTangential>& errors, Freedom freedom,
                                                    const Outcome& outcome);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_IMPULSE_CHANGES_H_
