// Tangent: the derivative of a planar impact along a direction of its problem, from the side to which it points.
//
// The kernel of core/models/planar/planar.h runs over dual numbers (core/numerics/dual-inl.h) in double-double
// arithmetic, or in arithmetic with wide exponents where the inputs ask for it. A problem on a threshold between two
// courses follows the one that begins in that direction. Each rate is right to a few ulp, beside what the direction's
// own errors change; one that does not exist, because the number jumps or its slope is vertical, is not finite.
// docs/theory/derivatives.md derives this. The problem must be valid; it may separate.

#ifndef RICOCHET_CORE_MODELS_PLANAR_TANGENT_H_
#define RICOCHET_CORE_MODELS_PLANAR_TANGENT_H_

#include <array>

#include "absl/types/span.h"
#include "core/contact/delassus.h"
#include "core/models/planar/planar.h"
#include "core/models/planar_outputs.h"
#include "ricochet/regime.h"

namespace ricochet::planar {

// The derivatives of the problem's numbers.
struct Direction {
  PlanarDelassus w;
  double u0 = 0.0, v0 = 0.0, mu = 0.0, mu_static = 0.0, coefficient = 0.0;
};

// A Branch tells which course an impact takes.
struct Branch {
  Regime regime = Regime::kUnspecified;
  bool approaches = false;
  int slip_before = 0;  // The sign of u as the impact begins.
  bool stops = false, sticks = false, held = false;
  bool stops_in_compression = false, stops_in_restitution = false;
};

struct Tangent {
  std::array<double, kPlanarOutputCount> value = {}, rate = {};  // By PlanarOutput.
  Branch branch;
  int w_rank = 0;
  bool leaves_range = false;  // W has rank one and the velocity moves out of its range.
};

// A problem, a direction of it, and its tangent along that.
struct Along {
  Problem problem;
  Direction direction;
  Tangent tangent;
};

// Sets the tangent of each, several at once. All problems have the same law.
void SetTangents(absl::Span<Along> all);

}  // namespace ricochet::planar

#endif  // RICOCHET_CORE_MODELS_PLANAR_TANGENT_H_
