// This file is compiled once for each SIMD target (foreach_target.h includes it again), so that fma is an instruction
// on targets that have one. The target is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/planar/tangent.cc"
#include "core/models/planar/tangent.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/numerics/moderate.h"
// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/planar/kernel-inl.h"
#include "core/models/planar/report-inl.h"
#include "core/models/planar_outputs-inl.h"
#include "core/numerics/dual-inl.h"
// clang-format on

#ifndef RICOCHET_CORE_MODELS_PLANAR_TANGENT_CC_
#define RICOCHET_CORE_MODELS_PLANAR_TANGENT_CC_
namespace ricochet::planar {

// No vector of any target has more lanes.
inline constexpr size_t kMostLanes = 32;

// A code is the number of a regime with the flags that hold.
inline constexpr uint64_t kRegimes = 0xff;
enum Flag : uint64_t {
  kApproaches = 1 << 8,
  kSlipsForward = 1 << 9,
  kSlipsBackward = 1 << 10,
  kStops = 1 << 11,
  kSticks = 1 << 12,
  kHeld = 1 << 13,
  kStopsInCompression = 1 << 14,
  kStopsInRestitution = 1 << 15,
  kRankOne = 1 << 16,
  kLeavesRange = 1 << 17,
};

}  // namespace ricochet::planar
#endif  // RICOCHET_CORE_MODELS_PLANAR_TANGENT_CC_

HWY_BEFORE_NAMESPACE();
namespace ricochet::planar::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::Codes;
using ricochet::HWY_NAMESPACE::DoubleDouble;
using ricochet::HWY_NAMESPACE::Dual;
using ricochet::HWY_NAMESPACE::Lanes;
using ricochet::HWY_NAMESPACE::Vector;

// V is what N computes with: the problems of its lanes are all[0], all[1], ...
template <typename N, typename V>
HWY_INLINE Inputs<Dual<N>> InputsOf(Along* const* all) {
  std::array<std::array<double, kMostLanes>, 8> values, rates;
  for (size_t lane = 0; lane < Lanes<V>::Count(); ++lane) {
    const std::array<double, 8> value = AsArray(all[lane]->problem);
    const std::array<double, 8> rate = AsArray(all[lane]->direction);
    for (size_t k = 0; k < value.size(); ++k) {
      values[k][lane] = value[k];
      rates[k][lane] = rate[k];
    }
  }
  return InputsFrom<Dual<N>>([&](size_t k) HWY_ATTR {
    return Dual<N>(N::Exactly(Lanes<V>::Load(values[k].data())), N::Exactly(Lanes<V>::Load(rates[k].data())));
  });
}

// True where u0 Wnn - v0 Wtn is 0 and changes along the direction by more than the direction's own rounding.
template <typename N>
HWY_INLINE auto LeavesRange(const Course<Dual<N>>& course) {
  using ricochet::HWY_NAMESPACE::Absolute;
  using V = decltype(Rounded(N()));
  const Inputs<Dual<N>>& in = course.in;
  const Dual<N>& u0 = in.stated_u0;
  const V rate = Absolute(Rounded((u0 * in.wnn - in.v0 * in.wtn).rate));
  const V size = Absolute(Rounded(u0.rate * in.wnn.value)) + Absolute(Rounded(u0.value * in.wnn.rate)) +
                 Absolute(Rounded(in.v0.rate * in.wtn.value)) + Absolute(Rounded(in.v0.value * in.wtn.rate));
  return Both(Both(in.rank_one, in.u_follows_v), Lanes<V>::Fill(0x1p-40) * size < rate);
}

template <typename N>
HWY_INLINE auto CodesOf(const Course<Dual<N>>& course) {
  using C = Codes<decltype(Rounded(N()))>;
  auto code = RegimeOf(course);
  const auto flag = [&code](const auto& holds, Flag one) HWY_ATTR { code = C::FlagWhere(holds, one, code); };
  flag(IsNegative(course.in.v0), kApproaches);
  flag(IsPositive(course.in.u0), kSlipsForward);
  flag(IsNegative(course.in.u0), kSlipsBackward);
  flag(course.path.stops, kStops);
  flag(Both(course.path.stops, course.path.sticks), kSticks);
  flag(course.held, kHeld);
  flag(course.x.stops_in_compression, kStopsInCompression);
  flag(course.x.stops_in_restitution, kStopsInRestitution);
  flag(course.in.rank_one, kRankOne);
  flag(LeavesRange(course), kLeavesRange);
  return code;
}

HWY_INLINE void SetBranch(uint64_t code, Along& x) {
  Tangent& tangent = x.tangent;
  tangent.w_rank = (code & kRankOne) != 0 ? 1 : 2;
  tangent.leaves_range = false;
  if ((code & kApproaches) == 0) {
    tangent.value = tangent.rate = {};
    tangent.branch = {.regime = Regime::kSeparating};
    const auto set = [&tangent](PlanarOutput output, double value, double rate) {
      tangent.value[static_cast<size_t>(output)] = value;
      tangent.rate[static_cast<size_t>(output)] = rate;
    };
    set(PlanarOutput::kTangentialVelocityAfter, x.problem.u0, x.direction.u0);
    set(PlanarOutput::kNormalVelocityAfter, x.problem.v0, x.direction.v0);
    return;
  }
  tangent.leaves_range = (code & kLeavesRange) != 0;
  tangent.branch = {.regime = static_cast<Regime>(code & kRegimes),
                    .approaches = true,
                    .slip_before = (code & kSlipsForward) != 0    ? 1
                                   : (code & kSlipsBackward) != 0 ? -1
                                                                  : 0,
                    .stops = (code & kStops) != 0,
                    .sticks = (code & kSticks) != 0,
                    .held = (code & kHeld) != 0,
                    .stops_in_compression = (code & kStopsInCompression) != 0,
                    .stops_in_restitution = (code & kStopsInRestitution) != 0};
}

// Sets the tangents of the first `count` of `all`, of which there is one for each lane.
template <typename N, typename V>
HWY_INLINE void SetIn(Along* const* all, size_t count) {
  using Out = Dual<Plain<V>>;
  const Course<Dual<N>> course = Follow<Dual<N>>(all[0]->problem.law, InputsOf<N, V>(all));
  std::array<double, kMostLanes> values, rates;
  const auto set = [&](PlanarOutput output, const Out& number) HWY_ATTR {
    Lanes<V>::Store(number.value.value, values.data());
    Lanes<V>::Store(number.rate.value, rates.data());
    for (size_t lane = 0; lane < count; ++lane) {
      all[lane]->tangent.value[static_cast<size_t>(output)] = values[lane];
      all[lane]->tangent.rate[static_cast<size_t>(output)] = rates[lane];
    }
  };
  ForEachOutput(MakeNumbers(kAllParts, course), Out::Constant(0.0), Out::Constant(0.0), set);
  std::array<uint64_t, kMostLanes> codes;
  Codes<V>::Store(CodesOf(course), codes.data());
  for (size_t lane = 0; lane < count; ++lane) SetBranch(codes[lane], *all[lane]);
}

void SetModerate(Along* const* all, size_t count) { SetIn<DoubleDouble<Vector>, Vector>(all, count); }

size_t CountTangentLanes() { return Lanes<Vector>::Count(); }

}  // namespace ricochet::planar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "core/numerics/wide.h"

namespace ricochet::planar {
namespace {

HWY_EXPORT(SetModerate);
HWY_EXPORT(CountTangentLanes);

// True if no product of a few of the numbers leaves the range of doubles.
bool IsModerate(const Along& x) {
  using HWY_NAMESPACE::AsArray;
  return AreModerate(AsArray(x.problem), 0x1p60) && AreModerate(AsArray(x.direction), 0x1p60);
}

}  // namespace

void SetTangents(absl::Span<Along> all) {
  const size_t lanes = HWY_DYNAMIC_DISPATCH(CountTangentLanes)();
  std::array<Along*, kMostLanes> waiting;
  size_t count = 0;
  const auto set_waiting = [&] {
    if (count == 0) return;
    std::fill(waiting.begin() + count, waiting.begin() + lanes, waiting[0]);
    HWY_DYNAMIC_DISPATCH(SetModerate)(waiting.data(), count);
    count = 0;
  };
  for (Along& one : all) {
    Along* const alone = &one;
    if (!IsModerate(one)) {
      HWY_NAMESPACE::SetIn<Wide, double>(&alone, 1);
      continue;
    }
    waiting[count++] = alone;
    if (count == lanes) set_waiting();
  }
  set_waiting();
}

}  // namespace ricochet::planar
#endif  // HWY_ONCE
