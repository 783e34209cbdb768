// The motion of core/models/finite_duration/finite_duration.h in natural units: forces, rates, what ends a mode and which comes next.
//
// Units: velocity |v0|, mass 1/Wnn, and the time T in which they make the spring's own force, k Wnn |v0|^(p-1) T^(p+1)
// = 1 for N = k d^p, or in which a_n > 0 alone would turn v around, |v0|/a_n, if that is less. Then v0 = -1, Wnn = 1,
// a_n <= 1 and N = K x^p (1 - c v), K <= 1 the spring's stiffness and x the d of the curve of loading or
// (d - (1 - eta^2) d_max)/eta^2 on that of unloading: x' = -v or -v/eta^2.
//
// Two changes of variables keep the equations smooth and of size 1. For p != 1, x = q^2 and dt = 2 q ds: q' = -v and
// all rates are polynomials for p a multiple of 1/2, where x^p itself has no derivatives at first and last touch. On
// the curve of unloading dt has the factor eta as well, which is the size of v and of the time there.
//
// A mode is a line of the normal spring and a grip of friction. It lasts while its guards are >= 0. The turning points
// of what may leave and come back within one step, and those of the forces, are watched too.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_MOTION_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_MOTION_H_

#include <array>
#include <cstddef>

#include "core/models/finite_duration/finite_duration.h"

namespace ricochet::finite_duration {

struct Acceleration {
  double u = 0.0, v = 0.0;
};

struct Contact {
  double wtt = 0.0, wtn = 0.0;
  // d(u, v)/dtau of slip towards +t and -t: differences that may cancel, each rounded once.
  Acceleration forward_slope, backward_slope;
  double stick_slope = 0.0;  // det W/Wtt, v' of a contact that sticks over N.
  double u0 = 0.0;
  double at = 0.0, an = 0.0;
  double mu = 0.0, mu_static = 0.0;
  double stiffness = 1.0;  // K
  double exponent = 1.0;   // p
  bool rooted = false;     // p != 1: x = q^2.
  bool damped = false;     // Hunt and Crossley.
  double damping = 0.0;    // c
  double eta = 1.0;        // 1 for Hunt and Crossley: loading and unloading are one curve.
  bool compliant = false;
  double ratio_squared = 0.0;
  bool smooth = false;                         // No friction force: mu_s = 0 or Wtt = 0.
  bool coupled = false;                        // Rank one with the forces in its range: u = wtn v throughout.
  bool holds_freely = false;                   // mu_s Wtt >= |Wtn|: sticks where no finite force pulls.
  double speed = 0.0, time = 0.0, mass = 0.0;  // The units.

  double Length() const { return speed * time; }
  double Force() const { return mass * speed / time; }
  double Impulse() const { return mass * speed; }
  double Energy() const { return mass * speed * speed; }
};

int RankOf(const Problem& problem);
// v0 < 0.
Contact MakeContact(const Problem& problem);

// What is integrated. Impulses, works and losses from first touch on.
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
  kParts
};
using Motion = std::array<double, kParts>;
// What forces make: as soft as the spring.
inline constexpr Part kOfForces[] = {kSpringForce, kNormal,      kTangential,   kNormalMoment, kTangentMoment,
                                     kNormalWork,  kTangentWork, kFrictionLoss, kDampingLoss};

enum class Line { kLoading, kUnloading, kReloading };
// What friction does: nothing, hold, or act on slip towards +t or -t.
enum class Grip { kNone, kStick, kForward, kBackward };

struct Mode {
  Line line = Line::kLoading;
  Grip grip = Grip::kNone;
  double largest = 0.0;  // Place at the largest indentation so far.
};

struct Forces {
  double normal = 0.0, tangential = 0.0;
};

inline double Square(double x) { return x * x; }
double SlipSign(Grip grip);
double Indentation(const Contact& contact, const Mode& mode, const Motion& y);
Forces ForcesAt(const Contact& contact, const Mode& mode, const Motion& y);
Acceleration AccelerationAt(const Contact& contact, const Mode& mode, const Forces& forces);
// d/ds of every part.
Motion RatesAt(const Contact& contact, const Mode& mode, const Motion& y);
// dt/ds over that of loading with p = 1.
double Pace(const Contact& contact, const Mode& mode);

// The first kModeGuards end the mode where they fall below 0; the others have a turning point at 0.
enum Guard : size_t {
  kTurn,     // v is about to change sign.
  kLineEnd,  // Unloading: the spring is free. Reloading: d_max is reached again.
  kTension,  // Hunt and Crossley: N is about to pull.
  kUpper,    // Slip, the particle's slip, or the upper side of the friction cone.
  kLower,    // The lower side of the friction cone.
  kModeGuards,
  kTurnExtreme = kModeGuards,
  kUpperExtreme,
  kLowerExtreme,
  kForceExtreme,
  kGuards
};
using Guards = std::array<double, kGuards>;
// 1 for what does not apply.
Guards GuardsAt(const Contact& contact, const Mode& mode, const Motion& y);

// The motion and its mode at first touch.
Motion StartOf(const Contact& contact);
Grip GripAtStart(const Contact& contact);
// The grip of a tangentially rigid contact whose slip is 0.
Grip GripAtRest(const Contact& contact, double normal);
// The grip after kUpper or kLower has fallen; that of `mode` if it goes on.
Grip GripAfter(const Contact& contact, const Mode& mode, const Motion& y, Guard fallen);
// Whether v < 0 will fall for ever: nothing but forces that press drives a contact of rank one that friction holds.
bool NeverTurns(const Contact& contact, const Mode& mode, const Motion& y);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_MOTION_H_
