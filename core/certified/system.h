// What a system's contact is, exactly, and the way back from its impulse to the system's velocities.
//
//   W = J M^-1 J^T,   (u0, v0) = J q' - surface velocity,   q'+ = q' + M^-1 J^T (f, tau)
//
// Of a pendulum, of bodies and of a contact these are rational in the inputs. A linkage's take sines and cosines:
// intervals. W has rank one by nature where all that moves turns as one: for a pendulum, and for a linkage whose links
// are all parallel, which two doubles can only be by being equal, no multiple of pi but 0 being rational.

#ifndef RICOCHET_CORE_CERTIFIED_SYSTEM_H_
#define RICOCHET_CORE_CERTIFIED_SYSTEM_H_

#include <array>
#include <optional>
#include <vector>

#include "core/certified/contact_path.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet::certified {

enum class Velocities { kNone, kRates, kBodies };

template <typename N>
struct SystemContact {
  Contact<N> contact;
  Velocities velocities = Velocities::kNone;
  std::vector<N> before;                   // q'
  std::vector<std::array<N, 2>> response;  // M^-1 J^T
  std::optional<N> lever;                  // Where one rate w is all there is, over a surface at rest: w = v/lever.
  bool is_pendulum = false;                // Stated as one, over a surface at rest: it has regimes of its own.
};

// `scene` is valid and planar; not a linkage.
SystemContact<Surd> ReduceExactly(const Scene& scene, const EffectiveCoefficients& effective);

// `scene` is valid and states a linkage. Nothing where `bits` are too few to solve with M.
std::optional<SystemContact<ArfInterval>> ReduceLinkage(const Scene& scene, const EffectiveCoefficients& effective,
                                                        slong bits);

// The contact of a pendulum over a surface at rest, by its numbers.
template <typename N>
SystemContact<N> ReducePendulum(const N& inertia, const N& a, const N& b, const N& omega) {
  SystemContact<N> system;
  system.contact.wtt = Square(b) / inertia;
  system.contact.wtn = a * b / inertia;
  system.contact.wnn = Square(a) / inertia;
  system.contact.det = N(0.0);
  system.contact.rho = b / a;
  system.contact.u0 = b * omega;
  system.contact.v0 = a * omega;
  system.contact.rank_one = true;
  system.velocities = Velocities::kRates;
  system.before = {omega};
  system.response = {{b / inertia, a / inertia}};
  system.lever = a;
  system.is_pendulum = true;
  return system;
}

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_SYSTEM_H_
