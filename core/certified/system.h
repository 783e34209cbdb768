// SystemContact: a system's contact over the number type of a certificate, and the way back from the impulse to the
// system's velocities.
//
//   W = J M^-1 J^T (1/kg),   (u0, v0) = J q' - surface velocity,   q'+ = q' + M^-1 J^T (f, tau)
//
// For a pendulum, bodies and a planar_contact these are rational in the inputs, so they are exact. A linkage needs
// sines and cosines, so its contact is made of intervals. W has rank one by construction for a pendulum and for a
// linkage whose links are all parallel. Two angles that are doubles are parallel only if they are equal, because no
// multiple of pi other than 0 is rational.

#ifndef RICOCHET_CORE_CERTIFIED_SYSTEM_H_
#define RICOCHET_CORE_CERTIFIED_SYSTEM_H_

#include <array>
#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
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
  std::optional<N> lever;                  // Set for one rate w over a surface at rest: w = v/lever.
  bool is_pendulum = false;                // The scene states a pendulum over a surface at rest; its regimes differ.
};

bool AreParallel(const std::vector<Link>& links);

// `scene` is valid and planar; not a linkage.
SystemContact<Surd> ReduceExactly(const Scene& scene, const EffectiveCoefficients& effective);

// `scene` is valid and states a linkage. Returns nothing where `bits` are too few to invert M, or once `stopped`.
std::optional<SystemContact<ArfInterval>> ReduceLinkage(const Scene& scene, const EffectiveCoefficients& effective,
                                                        slong bits, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_SYSTEM_H_
