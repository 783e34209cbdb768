// IntervalReduction: what an impact depends on (core/contact/reduction.h), over all scenes of a box.
//
//   planar body   Wtt = 1/m + sn^2/J, Wtn = -st sn/J, Wnn = 1/m + st^2/J, C = 1/m + st^2/(J + m sn^2)
//   pair          the sums over both bodies; with M = 1/m1 + 1/m2, T and N the sums of sn^2/J and st^2/J,
//                 C = M + N/(1 + T/M) + X^2/(M + T), X^2 = (sn1 st2 - st1 sn2)^2/(J1 J2)
//   linkage       M = L D L^T, y = L^-1 J^T, W = y^T D^-1 y, C Wtt = sum_{i<j} (yt_i yn_j - yt_j yn_i)^2/(D_i D_j)
//   pendulum, linkage of one link   W of rank one: inertia about the pin and the lever arms
//
// with st, sn the offsets, J the inertia, and C = Wnn - Wtn^2/Wtt = det W/Wtt, the slope of v while the contact sticks,
// free of the difference: it tells a W of full rank from others where its entries do not.
// Contained is the contact of every scene of the box, as exact arithmetic has it; every operation is rounded outward.
// Each of these depends on the box's parameters to first order (core/numerics/slope_form.h) and is too wide by the
// square of the box's size at most; a pendulum's are no wider than they must be.

#ifndef RICOCHET_CORE_CONTACT_INTERVAL_REDUCTION_H_
#define RICOCHET_CORE_CONTACT_INTERVAL_REDUCTION_H_

#include <optional>
#include <variant>

#include "core/numerics/interval.h"
#include "core/numerics/slope_form.h"
#include "ricochet/scene.h"

namespace ricochet {

// All scenes whose every number lies between that of `low` and that of `high`; these differ in numbers alone.
struct SceneBox {
  Scene low;
  Scene high;
  std::optional<Interval> phi;  // A pendulum's angle: a = R sin(phi), b = R cos(phi), R = sqrt(a^2 + b^2) of `low`.
};

struct IntervalPendulum {
  Interval inertia, a, b;         // a of either sign; empty where no pendulum of the box has an a > 0.
  std::optional<Interval> slope;  // b/a, where more is known of it than from the two.
  Interval omega_minus;
};

struct ContactForm {
  SlopeForm wtt, wtn, wnn;
  SlopeForm stick_slope;  // C
  SlopeForm u0, v0;       // Relative to the surface.
};

using IntervalReduction = std::variant<IntervalPendulum, ContactForm>;

// Whether the system's W has rank one by its nature: a pendulum, a linkage of one link.
bool IsOfRankOne(const System& system);

// The scenes' system is planar and set; where IsOfRankOne, the surface is at rest. The numbers that differ become
// `parameters`.
IntervalReduction Reduce(const SceneBox& box, SlopeParameters& parameters);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_INTERVAL_REDUCTION_H_
