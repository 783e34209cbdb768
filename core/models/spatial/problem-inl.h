// The problem of the spatial solver, scaled by powers of two so that no product overflows.
//
// The largest of |u0| and |v0|, and the largest diagonal entry of W, come to lie in [1/2, 1). Scaling is exact. A
// contact that grazes is over before friction has changed its slip by what a double holds: v and the normal impulse
// then have a unit of their own, in which |v0| lies in [1/2, 1), and slip keeps its direction.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_PROBLEM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_PROBLEM_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_PROBLEM_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_PROBLEM_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/contact/reduction.h"
#include "core/models/restitution_law.h"
#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/spatial.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// Numbers are given to a double's precision, however wide T is.
template <typename T>
inline constexpr T kEpsilon = std::numeric_limits<double>::epsilon();
template <typename T>
inline constexpr T kInfinity = std::numeric_limits<T>::infinity();
// A contact may graze if |v0| is so many powers of two below slip.
inline constexpr int kGrazingBits = 60;

namespace internal {

// A power of two that may lie outside the range of doubles, as a product of three factors that do not.
struct PowerOfTwo {
  double first, second, third;

  explicit PowerOfTwo(int exponent = 0) {
    constexpr int kMost = 1000;
    const auto factor = [](int e) { return std::bit_cast<double>(static_cast<int64_t>(e + 1023) << 52); };
    const int first_part = std::clamp(exponent, -kMost, kMost);
    const int second_part = std::clamp(exponent - first_part, -kMost, kMost);
    first = factor(first_part);
    second = factor(second_part);
    third = factor(std::clamp(exponent - first_part - second_part, -kMost, kMost));
  }

  template <typename T>
  T operator*(T value) const {
    return value * first * second * third;
  }
};

inline int Exponent(double value) {
  int exponent = 0;
  (void)std::frexp(value, &exponent);
  return exponent;
}

}  // namespace internal

// The numbers of the problem that steps of slip read. T is a floating type or a LaneNumber.
template <typename T>
struct Contact {
  // A frame of which mu must not be 0, and the slopes while slip has the direction e.
  Frame<T> FrameAt(const Direction<T>& e) const;
  Slopes<T> SlopesAlong(const Direction<T>& e) const;

  Matrix<T> w;
  T mu;
  T velocity;       // max(|u0|, |v0|), to which errors of u are relative
  T approach;       // |v0|
  T rate;           // mu |Wtt| + |wtn|, the unit of 1/xi
  T largest_root;   // square roots of the eigenvalues of Wtt, the smaller one not below rounding
  T smallest_root;  // of those along which impulses move slip
  T keeps_part;     // 1 if Wtt is singular and u has a part that no impulse moves, else 0
  T normal_root;    // sqrt(Wnn)
  T steepest;       // the largest |dv/dtau| of slip
};

template <typename T>
struct ScaledProblem : Contact<T> {
  using Contact<T>::w, Contact<T>::mu, Contact<T>::velocity, Contact<T>::approach, Contact<T>::rate,
      Contact<T>::largest_root, Contact<T>::smallest_root, Contact<T>::keeps_part, Contact<T>::normal_root,
      Contact<T>::steepest, Contact<T>::FrameAt, Contact<T>::SlopesAlong;

  // `rank` is the rank of the problem's W.
  ScaledProblem(const Problem& problem, int rank);

  // The direction near that of `frame` in which slip does not turn and which attracts its neighbours, if there is one.
  std::optional<Direction<T>> AttractingDirectionNear(const Frame<T>& frame) const;

  bool HasNoFriction() const { return mu == T{0} || (w.HasNoTangentialMobility() && u1 == T{0} && u2 == T{0}); }
  // Where Wtt is singular and slip lies in its range, slip knows one direction only.
  bool SlipHasOneDirection() const { return w.tangent_is_singular && velocity_in_range; }
  // Where friction and the joints lock the body, u and v vanish together. Beside the range of W they do not: a contact
  // that sticks keeps its v.
  bool Locks(const Sticking<T>& sticking) const { return sticking.v_slope == T{0} && velocity_in_range; }

  // Conversions to the units of the caller; adding 0.0 turns -0 into 0.
  double Velocity(T value) const { return static_cast<double>(velocity_unit * value) + 0.0; }
  double NormalVelocity(T value) const { return static_cast<double>(normal_velocity_unit * value) + 0.0; }
  double Impulse(T value) const { return static_cast<double>(impulse_unit * value) + 0.0; }
  double FrictionWork(T value) const { return static_cast<double>(friction_work_unit * value) + 0.0; }
  double NormalWork(T value) const { return static_cast<double>(normal_work_unit * value) + 0.0; }

  internal::PowerOfTwo velocity_unit, normal_velocity_unit, impulse_unit, friction_work_unit, normal_work_unit;
  T u1, u2, v;  // before the impact
  bool grazes;
  T graze;  // the unit of v over that of u; 1 if the contact does not graze
  T mu_static;
  RestitutionLaw law;
  T coefficient;
  bool may_jam;            // dv/dtau < 0 is possible.
  bool velocity_in_range;  // (u0, v0) lies in the range of W.

 private:
  // True if slip changes by less than 2^-58 of itself until the impact ends, and v' with it.
  bool EndsBeforeSlipChanges() const;
};

template <typename T>
ScaledProblem<T>::ScaledProblem(const Problem& problem, int rank)
    : mu_static(problem.mu_static), law(problem.law), coefficient(problem.coefficient) {
  mu = problem.mu;
  const double largest_velocity =
      std::max(std::max(std::fabs(problem.u0[0]), std::fabs(problem.u0[1])), std::fabs(problem.v0));
  const int velocity_exponent = internal::Exponent(largest_velocity);
  const int normal_exponent = internal::Exponent(problem.v0);
  const int matrix_exponent = internal::Exponent(std::max(std::max(problem.w11, problem.w22), problem.w33));
  velocity_unit = internal::PowerOfTwo(velocity_exponent);
  const internal::PowerOfTwo to_matrix(-matrix_exponent);
  const internal::PowerOfTwo to_velocity(-velocity_exponent);
  w = Matrix<T>(to_matrix * problem.w11, to_matrix * problem.w12, to_matrix * problem.w13, to_matrix * problem.w22,
                to_matrix * problem.w23, to_matrix * problem.w33, rank);
  u1 = static_cast<T>(to_velocity * problem.u0[0]);
  u2 = static_cast<T>(to_velocity * problem.u0[1]);
  const T coupling = std::sqrt(w.w13 * w.w13 + w.w23 * w.w23);
  const T largest = w.LargestTangentEigenvalue();
  rate = mu * largest + coupling;
  largest_root = std::sqrt(largest);
  velocity_in_range =
      rank == 3 || VelocityIsInRange(SpatialReduction{.w = problem.Delassus().w, .u0 = problem.u0, .v0 = problem.v0});
  // Where Wtt = 0 friction moves nothing, and any number serves.
  const T smallest = w.tangent_is_singular ? largest : w.TangentDeterminant() / largest;
  // A contact that moves in a plane through the normal has no slip beside it, whatever moves v besides impulses.
  const bool in_plane = problem.w12 == 0.0 && ((problem.w22 == 0.0 && problem.w23 == 0.0 && problem.u0[1] == 0.0) ||
                                               (problem.w11 == 0.0 && problem.w13 == 0.0 && problem.u0[0] == 0.0));
  keeps_part = w.tangent_is_singular && !velocity_in_range && !in_plane ? T{1} : T{0};
  smallest_root = largest > T{0} ? std::sqrt(std::max(smallest, kEpsilon<T> * largest)) : T{1};
  normal_root = std::sqrt(w.w33);
  steepest = w.w33 + mu * coupling;
  may_jam = mu * coupling >= w.w33;
  graze = internal::PowerOfTwo(normal_exponent - velocity_exponent) * T{1};
  v = static_cast<T>(internal::PowerOfTwo(-normal_exponent) * problem.v0);
  grazes = normal_exponent < velocity_exponent - kGrazingBits && EndsBeforeSlipChanges();
  if (grazes) {
    constexpr T kMost{1e300};
    normal_root = std::min(normal_root / graze, kMost);
  } else {
    graze = T{1};
    v = static_cast<T>(to_velocity * problem.v0);
  }
  const int unit_exponent = grazes ? normal_exponent : velocity_exponent;
  normal_velocity_unit = internal::PowerOfTwo(unit_exponent);
  impulse_unit = internal::PowerOfTwo(unit_exponent - matrix_exponent);
  friction_work_unit = internal::PowerOfTwo(velocity_exponent + unit_exponent - matrix_exponent);
  normal_work_unit = internal::PowerOfTwo(2 * unit_exponent - matrix_exponent);
  approach = std::fabs(v);
  velocity = std::max(std::sqrt(u1 * u1 + u2 * u2), std::fabs(v) * graze);
}

template <typename T>
bool ScaledProblem<T>::EndsBeforeSlipChanges() const {
  if (HasNoFriction()) return true;
  const T slip = std::sqrt(u1 * u1 + u2 * u2);
  const T v_slope = SlopesAlong({u1 / slip, u2 / slip}).v;
  const T length = graze * (T{1} + coefficient) * std::fabs(v) / v_slope;
  return v_slope > T{0} && rate * length * steepest <= T{0x1p-58} * (v_slope * slip);
}

template <typename T>
HWY_INLINE Frame<T> Contact<T>::FrameAt(const Direction<T>& e) const {
  const T c = e.c;
  const T s = e.s;
  const T along = c * w.w11 + s * w.w12;  // Wtt e
  const T across = c * w.w12 + s * w.w22;
  const T a = -mu / rate;
  return {.c = c,
          .s = s,
          .a11 = a * (c * along + s * across),
          .a12 = a * (c * across - s * along),
          .a22 = a * (s * s * w.w11 + c * c * w.w22 - T{2} * c * s * w.w12),
          .w1 = (c * w.w13 + s * w.w23) / rate,
          .w2 = (c * w.w23 - s * w.w13) / rate};
}

template <typename T>
HWY_INLINE Slopes<T> Contact<T>::SlopesAlong(const Direction<T>& e) const {
  return {.u1 = w.w13 - mu * (w.w11 * e.c + w.w12 * e.s),
          .u2 = w.w23 - mu * (w.w12 * e.c + w.w22 * e.s),
          .v = w.w33 - mu * (w.w13 * e.c + w.w23 * e.s)};
}

template <typename T>
std::optional<Direction<T>> ScaledProblem<T>::AttractingDirectionNear(const Frame<T>& frame) const {
  Frame<T> there = frame;
  // A turn left over changes the growth of slip by its square. Where the entries of Wtt are so unequal that the growth
  // is far smaller than Wtt itself, the smaller component of the direction needs all its digits.
  const auto is_found = [&there](T turn) {
    return std::fabs(turn) <= kEpsilon<T> && turn * turn <= kEpsilon<T> * std::fabs(there.Growth());
  };
  constexpr int kEnough = 50;
  for (int i = 0; i < kEnough; ++i) {
    const T turn = -there.Turn() / there.TurnSlope();
    if (is_found(turn)) break;
    there = FrameAt(Normalized(there.c - turn * there.s, there.s + turn * there.c));
  }
  const T left = T{1} - (there.c * frame.c + there.s * frame.s);
  if (!(left < T{0.1}) || !(there.TurnSlope() < T{0}) || !(std::fabs(there.Turn()) < T{1e-12})) return std::nullopt;
  return Direction<T>{there.c, there.s};
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
