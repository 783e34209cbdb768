// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/plan/planar_models.cc"
#include "core/plan/planar_models.h"

#include <array>
#include <cassert>

// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/numerics/lanes-inl.h"
#include "core/numerics/sizes-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {
namespace planar_models {

constexpr size_t kMostLanes = 64;   // No vector has more lanes.
constexpr double kLimit = 0x1p100;  // The largest magnitude, and the inverse of the least.
// Covers the rounding of both sides of a comparison, and the padding of a size (core/plan/perturbed_path.h).
constexpr double kMargin = 0x1p-19;
// From this slope on the bounds are sure; the sizes of the plan require at least 2^-20 (kLeastSlope).
constexpr double kSureSlope = 0x1p-10;
// Below this slope, which includes a margin, neither model of a straight path serves.
constexpr double kSteep = 0x1p-21;
// Covers the rounding of a slip, relative to its terms, for slopes of at least kSureSlope.
constexpr double kSlipRounding = 0x1p-30;
// 2^-53, enlarged by a quarter as in core/models/sliding/sliding.cc.
constexpr double kUnit = 1.25 * 0x1p-53;

template <typename V>
struct Contact {
  V wtt, wtn, wnn, u0, v0, mu, mu_static, coefficient;
};

template <typename V>
HWY_INLINE Contact<V> Load(const PlanarProblemColumns& problems, size_t i) {
  return {Lanes<V>::Load(&problems.wtt[i]),       Lanes<V>::Load(&problems.wtn[i]),
          Lanes<V>::Load(&problems.wnn[i]),       Lanes<V>::Load(&problems.u0[i]),
          Lanes<V>::Load(&problems.v0[i]),        Lanes<V>::Load(&problems.mu[i]),
          Lanes<V>::Load(&problems.mu_static[i]), Lanes<V>::Load(&problems.coefficient[i])};
}

template <typename V>
HWY_INLINE V Fill(double value) {
  return Lanes<V>::Fill(value);
}

// True where every rule of a scene holds for sure, but for that on v0, of which NaN alone breaks one. A comparison with
// NaN is false.
template <typename V>
HWY_INLINE auto IsSurelyValid(RestitutionLaw law, const Contact<V>& in) {
  const V zero = Fill<V>(0.0);
  const V limit = Fill<V>(kLimit);
  Sizes<V> sizes;
  sizes.Include(in.wtt);
  sizes.Include(in.wtn);
  sizes.Include(in.wnn);
  sizes.Include(in.u0);
  sizes.Include(in.v0);
  sizes.Include(in.mu);
  sizes.Include(in.mu_static);
  sizes.Include(in.coefficient);
  const V most = Fill<V>(law == RestitutionLaw::kEnergetic ? 1.0 : kLimit);
  const auto has_full_rank =
      Both(Both(zero < in.wtt, zero < in.wnn), in.wtn * in.wtn < Fill<V>(0.999) * (in.wtt * in.wnn));
  const auto has_friction = Both(zero <= in.mu, in.mu <= in.mu_static);
  const auto restores = Both(zero <= in.coefficient, in.coefficient <= most);
  return Both(Both(has_full_rank, Both(has_friction, restores)),
              Both(sizes.AreWithin(kLimit), Absolute(in.u0) <= limit));
}

// V times the larger of a model's errors of velocity and impulse.
template <typename V>
HWY_INLINE V ErrorOf(const Contact<V>& in, V velocity, V impulse) {
  return Fill<V>(kUnit) * Larger(Larger(in.coefficient * Absolute(in.v0), velocity), impulse);
}

// V times the error of sliding::FrictionlessErrorsOf.
template <typename V>
HWY_INLINE V FrictionlessError(const Contact<V>& in, V tau1) {
  const V drift = in.wtn * tau1;
  return ErrorOf(in, Absolute(in.u0 + drift) + Fill<V>(2.0) * Absolute(drift), Fill<V>(2.0) * in.wnn * tau1);
}

// V times the error of sliding::ErrorsOf.
template <typename V>
HWY_INLINE V SlidingError(const Contact<V>& in, V tau1) {
  const V u_slope = Fma(CopySign(in.mu, Fill<V>(0.0) - in.u0), in.wtt, in.wtn);
  const V velocity = Absolute(Fma(u_slope, tau1, in.u0)) + tau1 * Fill<V>(4.0) * Absolute(u_slope);
  return ErrorOf(in, velocity, tau1 * Larger(Fill<V>(3.0) * in.wnn, Fill<V>(4.0) * in.wtt * in.mu));
}

// Chooses for contacts that approach, in the scales and letters of core/plan/sizes.cc.
template <typename V>
HWY_INLINE V ChooseApproaching(const Contact<V>& in, double tolerance) {
  const V zero = Fill<V>(0.0);
  const V one = Fill<V>(1.0);
  const auto model = [](Model number) HWY_ATTR { return Fill<V>(static_cast<double>(number)); };
  const V per_nn = one / in.wnn;
  const V w = in.wtn * per_nn;
  const V coupling = Absolute(w);
  const V speed = Absolute(in.v0);
  const V slip = Absolute(in.u0) / speed;
  const V along = Select(in.u0 < zero, zero - w, w);
  const V drive = in.mu * in.wtt * per_nn;
  const V u_terms = drive + coupling;
  const V braking = drive - along;
  const V least_slope = one - in.mu * coupling;
  // This is the tolerance, with a margin, in the scale in which |v0| = 1.
  const V most = Fill<V>(tolerance * (1.0 + kMargin));
  // These bound a tolerated error times V from above and from below.
  const V scale = Larger(Absolute(in.u0), speed);
  const V loose = Fill<V>(tolerance * (1.0 + kMargin)) * scale;
  const V tight = Fill<V>(tolerance * (1.0 - kMargin)) * scale;

  // Beyond these limits neither model of a straight path serves.
  const auto is_steep = Either(one < in.coefficient, least_slope < Fill<V>(kSteep));
  // Friction changes the impact by at least min(drive, coupling) and by drive min(1, slip/u_terms).
  const auto rubs = Both(most < drive, Either(most < coupling, most * u_terms < drive * slip));
  auto is_frictionless = Both(in.mu_static <= zero, in.coefficient <= one);
  auto is_rough = Either(rubs, is_steep);
  if (!InNoLane(is_frictionless)) {
    const V error = FrictionlessError(in, (one + in.coefficient) * speed * per_nn);
    is_rough = Either(is_rough, Both(is_frictionless, loose < error));
    is_frictionless = Both(is_frictionless, error <= tight);
  }

  const V tau1 = (one + in.coefficient) / (one - in.mu * along);
  const V left = slip - braking * tau1;  // The slip at the end of a slide.
  const V slack = Fill<V>(kSlipRounding) * (slip + u_terms * tau1);
  const V beyond = zero - left - slack;  // The way that a slide would go on backwards.
  const auto is_flat = Fill<V>(kSureSlope) <= least_slope;
  const auto rests = Either(in.u0 == zero, in.mu <= zero);
  const auto slides = Both(Both(is_flat, slack < left), Not(Either(rests, is_steep)));
  const auto stops = Both(is_flat, Both(most < beyond, most * u_terms < Fill<V>(2.0) * drive * beyond));
  const V error = SlidingError(in, tau1 * speed * per_nn);
  const auto is_sliding = Both(slides, error <= tight);
  const auto is_not_sliding = Either(Either(Either(rests, is_steep), stops), Both(slides, loose < error));

  V chosen = model(Model::kUnspecified);
  chosen = Select(is_frictionless, model(Model::kFrictionless), chosen);
  chosen = Select(Both(is_rough, is_sliding), model(Model::kSliding), chosen);
  return Select(Both(is_rough, is_not_sliding), model(Model::kPlanar), chosen);
}

template <typename V>
HWY_INLINE void Choose(const PlanarProblemColumns& problems, size_t i, double tolerance, absl::Span<Model> models) {
  const V zero = Fill<V>(0.0);
  const Contact<V> in = Load<V>(problems, i);
  const V unspecified = Fill<V>(static_cast<double>(Model::kUnspecified));
  V chosen = ChooseApproaching(in, tolerance);
  chosen = Select(zero <= in.v0, Fill<V>(static_cast<double>(Model::kNone)), chosen);
  const auto is_sure = Both(IsSurelyValid(problems.law, in), Either(in.v0 < zero, zero <= in.v0));
  std::array<double, kMostLanes> numbers;
  Lanes<V>::Store(Select(is_sure, chosen, unspecified), numbers.data());
  for (size_t lane = 0; lane < Lanes<V>::Count(); ++lane) models[i + lane] = static_cast<Model>(numbers[lane]);
}

}  // namespace planar_models

void ChooseAll(const PlanarProblemColumns& problems, double tolerance, absl::Span<Model> models) {
  size_t i = 0;
  for (; i + Lanes<Vector>::Count() <= models.size(); i += Lanes<Vector>::Count()) {
    planar_models::Choose<Vector>(problems, i, tolerance, models);
  }
  for (; i < models.size(); ++i) planar_models::Choose<double>(problems, i, tolerance, models);
}

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet {

HWY_EXPORT(ChooseAll);

void ModelsOfPlanar(const PlanarProblemColumns& problems, double tolerance, absl::Span<Model> models) {
  assert(models.size() == problems.size());
  HWY_DYNAMIC_DISPATCH(ChooseAll)(problems, tolerance, models);
}

}  // namespace ricochet

#endif  // HWY_ONCE
