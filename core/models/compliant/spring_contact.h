// SpringContact: the constants of a compliant contact, and the slopes of its velocities while the particle slides.
//
// Units are those of a path (core/models/compliant/path.h): the stiffness of first loading is k = 1. `side` is 1 or -1
// and names the direction in which the particle slides. docs/theory/compliant.md derives the formulas.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_SPRING_CONTACT_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_SPRING_CONTACT_H_

#include "core/models/compliant/compliant.h"

namespace ricochet::compliant {

inline constexpr double kEps = 0x1p-52;

// The normal spring is loaded for the first time, or lies below its largest indentation so far.
enum class LoadingBranch { kFirstLoading, kUnloading };

// The contact at one instant.
struct ContactState {
  double normal_force = 0.0;  // N
  double spring_force = 0.0;  // p = -F, the force that holds the tangential spring.
  double u = 0.0, v = 0.0;
  double tau = 0.0, f = 0.0;   // Impulses since the start.
  double friction_loss = 0.0;  // Work that friction has dissipated since the start.

  bool IsFinite() const;
};

struct SpringContact {
  double wtt = 0.0, wtn = 0.0, wnn = 0.0;
  double determinant = 0.0;  // det W, exactly 0 where the rank is one.
  int rank = 2;
  bool u_follows_v = false;  // PlanarDelassus::UFollowsV of (u0, v0), so that u = v Wtn/Wnn throughout.
  double mu = 0.0;
  double ratio_squared = 0.0;
  double eta = 0.0;  // 0 below kLeastEnergetic.

  double NormalStiffness(LoadingBranch branch) const {
    return branch == LoadingBranch::kFirstLoading ? 1.0 : 1.0 / (eta * eta);
  }
  double RootOfStiffness(LoadingBranch branch) const {
    return branch == LoadingBranch::kFirstLoading ? 1.0 : 1.0 / eta;
  }
  // B = dv/dtau.
  double NormalSlope(int side) const;
  // A = dS/dtau; 0 where it is no larger than the rounding of its terms.
  double SlipSlope(LoadingBranch branch, int side) const;
  // S, the speed of the particle towards `side` while it slides.
  double SlipSpeed(LoadingBranch branch, int side, const ContactState& state) const;
  // S at first touch. Its sign is exact down to 2^-104 of mu ratio^2 |v0|.
  double SlipSpeedAtStart(int side, const ContactState& state) const;
  // The energy in the tangential spring.
  double SpringEnergy(const ContactState& state) const {
    return 0.5 * ratio_squared * state.spring_force * state.spring_force;
  }
};

// `problem.coefficient` is the energetic one.
SpringContact MakeSpringContact(const PlanarProblem& problem, double ratio_squared);

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_SPRING_CONTACT_H_
