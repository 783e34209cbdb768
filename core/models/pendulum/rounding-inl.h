// The pendulum's kernel in plain arithmetic proves two things of its own answer: a bound on its rounding error, and the
// signs that it is sure of. docs/theory/rounding.md derives every constant.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_PENDULUM_ROUNDING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_PENDULUM_ROUNDING_INL_H_
#undef RICOCHET_CORE_MODELS_PENDULUM_ROUNDING_INL_H_
#else
#define RICOCHET_CORE_MODELS_PENDULUM_ROUNDING_INL_H_
#endif

#include "core/models/pendulum/kernel-inl.h"
#include "core/models/restitution_law.h"
#include "core/numerics/plain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::pendulum::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::Absolute;
using ricochet::HWY_NAMESPACE::Both;
using ricochet::HWY_NAMESPACE::Lanes;
using ricochet::HWY_NAMESPACE::Larger;
using ricochet::HWY_NAMESPACE::Plain;
using ricochet::HWY_NAMESPACE::Smaller;

// No product of the kernel leaves the range in which DoubleDouble is exact if every number is 0 or has a size between
// 1/kLimit and kLimit: the largest product is below 2^700, the smallest above 2^-890, its low half 2^-106 of that.
inline constexpr double kLimit = 0x1p100;
inline constexpr double kCoefficientLimit = 0x1p40;

inline constexpr double kUnitRoundoff = 0x1p-53;
// The bound is the larger of kLeastError and kErrorOfOne + kErrorOfKappa kappa.
inline constexpr double kLeastError = 15.0 * kUnitRoundoff;
inline constexpr double kErrorOfOne = 9.0 * kUnitRoundoff;
inline constexpr double kErrorOfKappa = 15.5 * kUnitRoundoff;
// 1 - eta^2 and 1 - kappa_hat have the sign of their exact values if they are at least this large.
inline constexpr double kLeastSure = 8.0 * kUnitRoundoff;

// The bound on the relative error of the answer (PlainImpact in core/models/pendulum/pendulum.h). kappa must have been
// computed.
template <typename V, typename Mask>
HWY_INLINE V RelativeError(const Solution<Plain<V>, Mask>& x) {
  const V least = Lanes<V>::Fill(kLeastError);
  const V error = Lanes<V>::Fill(kErrorOfOne) + Lanes<V>::Fill(kErrorOfKappa) * Rounded(x.kappa);
  return Larger(least, error);
}

template <typename V>
HWY_INLINE auto IsSure(Plain<V> difference) {
  return Lanes<V>::Fill(kLeastSure) <= Absolute(Rounded(difference));
}

// True where the signs that decide on broken limits are those of the exact values. A coefficient that the law states
// itself has an exact sign. A sign of a - mu_s |b| needs no check, because it is that of a sum that is rounded once.
template <typename V, typename Mask>
HWY_INLINE Mask SignsAreProved(RestitutionLaw law, const Solution<Plain<V>, Mask>& x) {
  // inverse_s and inverse_d have no meaning if d = 0.
  const Mask invertible = Lanes<V>::Fill(0.0) < Absolute(Rounded(x.d));
  switch (law) {
    case RestitutionLaw::kNewton:
      return Both(invertible, IsSure(x.one_minus_eta_squared));
    case RestitutionLaw::kPoisson:
      return Both(invertible, Both(IsSure(x.one_minus_eta_squared), IsSure(x.one_minus_kappa_hat)));
    case RestitutionLaw::kEnergetic:
      return invertible;
  }
  return invertible;
}

// True where the contact approaches and no product leaves the range of doubles. b, mu and the coefficient may be as
// small as they like.
template <typename V, typename Mask>
HWY_INLINE Mask IsModerate(const Inputs<Plain<V>, Mask>& in) {
  const V omega = Lanes<V>::Fill(0.0) - in.omega.value;
  const V least = Smaller(Smaller(in.inertia.value, in.a.value), omega);
  const V lengths = Larger(in.a.value, Absolute(in.b.value));
  const V most = Larger(Larger(in.inertia.value, omega), Larger(lengths, Absolute(in.mu.value)));
  return Both(Lanes<V>::Fill(1.0 / kLimit) <= least, most <= Lanes<V>::Fill(kLimit));
}

}  // namespace ricochet::pendulum::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
