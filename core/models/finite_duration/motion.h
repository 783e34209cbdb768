// Motion: the state that is integrated, in natural units, with its forces and rates.
//
// A mode is a branch of the normal spring and a state of friction. N = K x^p (1 - c v), where x is the d of the curve
// of loading, or (d - (1 - eta^2) d_max)/eta^2 on that of unloading: x' = -v or -v/eta^2. Two changes of variables keep
// the equations smooth and of size 1 (docs/theory/finite_duration.md, "Variables").

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_MOTION_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_MOTION_H_

#include <array>
#include <cstddef>

#include "core/models/finite_duration/scaled_contact.h"

namespace ricochet::finite_duration {

// Impulses, works and losses count from first touch on.
enum Part : size_t {
  kPlace,  // q, or x where p = 1
  kU,
  kV,
  kSpringForce,  // F of the tangential spring while its particle sticks.
  kTime,
  kNormal,         // tau
  kTangential,     // f
  kNormalMoment,   // Integral of tau dt.
  kTangentMoment,  // Integral of f dt.
  kNormalWork,
  kTangentWork,
  kFrictionLoss,
  kDampingLoss,
  kStretch,  // 1 - c v, the factor of damping in N, where a pull makes it matter how close to 0 that comes.
  kParts
};
using Motion = std::array<double, kParts>;
// These parts scale with the forces, which are small where the spring is soft.
inline constexpr Part kForceParts[] = {kSpringForce, kNormal,      kTangential,   kNormalMoment, kTangentMoment,
                                       kNormalWork,  kTangentWork, kFrictionLoss, kDampingLoss};

enum class LoadingBranch { kLoading, kUnloading, kReloading };
// kNone: there is no friction force. Slip is towards +t or -t.
enum class FrictionState { kNone, kStick, kSlipForward, kSlipBackward };

struct Mode {
  LoadingBranch branch = LoadingBranch::kLoading;
  FrictionState friction = FrictionState::kNone;
  double largest_place = 0.0;  // kPlace at the largest indentation so far.

  bool Sticks() const { return friction == FrictionState::kStick; }
  bool Unloads() const { return branch == LoadingBranch::kUnloading; }
};

struct Forces {
  double normal = 0.0, tangential = 0.0;
};

// 1, -1 or, without slip, 0.
double SlipSign(FrictionState friction);
FrictionState SlipTowards(double direction);
double LoadingCurve(const ScaledContact& contact, double place);
// The speed, towards `direction`, of a particle that slides, where the contact's velocity is (u, v). Its acceleration
// follows from that of the contact in the same way.
double ParticleSpeed(const ScaledContact& contact, const Mode& mode, double direction, double u, double v);

// 1 - c v
double Stretch(const ScaledContact& contact, const Motion& y);

Motion MotionAtStart(const ScaledContact& contact);
double Indentation(const ScaledContact& contact, const Mode& mode, const Motion& y);
Forces ForcesAt(const ScaledContact& contact, const Mode& mode, const Motion& y);
Acceleration AccelerationAt(const ScaledContact& contact, const Mode& mode, const Forces& forces);
// d/ds of every part.
Motion RatesAt(const ScaledContact& contact, const Mode& mode, const Motion& y);
// dt/ds, relative to that of loading with p = 1.
double Pace(const ScaledContact& contact, const Mode& mode);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_MOTION_H_
