// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/planar/columns.cc"
#include "core/models/planar/columns.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/planar/kernel-inl.h"
#include "core/models/planar/report-inl.h"
#include "core/models/planar/rounding-inl.h"
#include "core/numerics/lanes-inl.h"
#include "core/numerics/sizes-inl.h"
// clang-format on

#ifndef RICOCHET_CORE_MODELS_PLANAR_COLUMNS_CC_
#define RICOCHET_CORE_MODELS_PLANAR_COLUMNS_CC_
namespace ricochet::planar {

// Problems are solved in blocks of this many, whose intermediate results stay in the cache.
inline constexpr size_t kBlock = 64;

inline constexpr size_t kNumbers = 8;

// Some problems in a row, and the places of their results.
struct Block {
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  std::array<const double*, kNumbers> numbers = {};  // wtt, wtn, wnn, u0, v0, mu, mu_static, coefficient.
  std::array<double*, kOutputCount> places = {};     // Null for an output that is not wanted.
  unsigned parts = 0;                                // Those of the outputs wanted.
  bool* is_inadmissible = nullptr;
  Regime* regimes = nullptr;
  size_t size = 0;

  Problem operator[](size_t i) const {
    return {.w = {numbers[0][i], numbers[1][i], numbers[2][i]},
            .u0 = numbers[3][i],
            .v0 = numbers[4][i],
            .mu = numbers[5][i],
            .mu_static = numbers[6][i],
            .law = law,
            .coefficient = numbers[7][i]};
  }
  double v0(size_t i) const { return numbers[4][i]; }
};

// A verdict is the number of a regime, plus kInadmissible if a limit is broken, plus kUnproved if the arithmetic does not
// prove the problem's results within the tolerance, which then have no meaning.
inline constexpr int kInadmissible = 64;
inline constexpr int kUnproved = 128;
using Verdicts = std::array<double, kBlock>;

}  // namespace ricochet::planar
#endif  // RICOCHET_CORE_MODELS_PLANAR_COLUMNS_CC_

HWY_BEFORE_NAMESPACE();
namespace ricochet::planar::HWY_NAMESPACE {

// The target's widest lanes.
using V = ricochet::HWY_NAMESPACE::Vector;
using VLanes = ricochet::HWY_NAMESPACE::Lanes<V>;
using Mask = decltype(V() < V());

// True where no number on the path can leave the range in which the arithmetic is exact (kMostModerate).
HWY_INLINE Mask AreModerate(const Block& block, size_t i) {
  ricochet::HWY_NAMESPACE::Sizes<V> sizes;
  for (const double* numbers : block.numbers) sizes.TakeIn(VLanes::Load(numbers + i));
  return sizes.AreWithin(kMostModerate);
}

template <typename N>
HWY_INLINE Inputs<N> LoadInputs(const Block& block, size_t i) {
  const auto load = [&](size_t k) HWY_ATTR { return N::Exactly(VLanes::Load(block.numbers[k] + i)); };
  Inputs<N> in;
  in.wtt = load(0);
  in.wtn = load(1);
  in.wnn = load(2);
  in.u0 = load(3);
  in.v0 = load(4);
  in.mu = load(5);
  in.mu_static = load(6);
  in.coefficient = load(7);
  CompleteInputs(in);
  return in;
}

// The numbers of a vector of problems, their bound, and where they are proved.
template <typename N>
struct Answer {
  Numbers<N> numbers;
  V relative_error;
  Mask proved;
};

HWY_INLINE Answer<Plain<V>> Judge(unsigned parts, const Course<Plain<V>>& course) {
  using N = Plain<V>;
  const EndErrors<N> errors = ErrorsOf(course);
  Answer<N> answer = {MakeNumbers(parts, course), PlainBounds(course, errors).Largest(), PathIsSure(course, errors)};
  const Mask keeps_limits = KeepsLimits(course);
  KeepLimits(keeps_limits, course, answer.numbers);
  if (!InAllLanes(keeps_limits)) {
    answer.proved = Both(answer.proved, Either(keeps_limits, LimitsAreSure(course, errors)));
  }
  return answer;
}

HWY_INLINE Answer<DoubleDouble<V>> Judge(unsigned parts, const Course<DoubleDouble<V>>& course) {
  const Mask all = VLanes::Fill(0.0) == VLanes::Fill(0.0);
  return {MakeNumbers(parts, course), CompensatedBounds(course).Largest(), all};
}

template <typename N>
HWY_INLINE void Store(const Block& block, size_t i, const Answer<N>& answer) {
  const Numbers<N>& x = answer.numbers;
  const auto store = [&](Output output, V value) HWY_ATTR {
    double* const place = block.places[static_cast<size_t>(output)];
    if (place != nullptr) VLanes::Store(value, place + i);
  };
  const V work_tangential = x.work_tangential_compression + x.work_tangential_restitution;
  store(Output::kNewton, x.newton);
  store(Output::kPoisson, x.poisson);
  store(Output::kEnergetic, x.energetic);
  store(Output::kTangentialCoefficient, x.tangential);
  store(Output::kTangentialVelocityAfter, x.u1);
  store(Output::kNormalVelocityAfter, x.v1);
  store(Output::kNormalImpulseCompression, x.tau_compression);
  store(Output::kNormalImpulse, x.tau1);
  store(Output::kTangentialImpulse, x.f1);
  store(Output::kWorkNormalCompression, x.work_normal_compression);
  store(Output::kWorkNormalRestitution, x.work_normal_restitution);
  store(Output::kWorkTangentialCompression, x.work_tangential_compression);
  store(Output::kWorkTangentialRestitution, x.work_tangential_restitution);
  store(Output::kWorkNormal, x.work_normal_compression + x.work_normal_restitution);
  store(Output::kWorkTangential, work_tangential);
  store(Output::kFrictionDissipation, VLanes::Fill(0.0) - work_tangential);
  store(Output::kEnergyChange, x.energy_change);
  store(Output::kRelativeError, answer.relative_error);
}

// Solves all problems of a block, of which there are at least as many as a vector has lanes. The last vector overlaps the one
// before it, so that it holds no problem beyond the block. A result whose bound exceeds `tolerance` is not proved.
template <typename N>
HWY_INLINE void SolveAll(const Block& block, double tolerance, Verdicts& verdicts) {
  const V zero = VLanes::Fill(0.0);
  const size_t last = block.size - VLanes::Count();
  for (size_t i = 0;; i = std::min(i + VLanes::Count(), last)) {
    const Inputs<N> in = LoadInputs<N>(block, i);
    const Course<N> course = Follow(block.law, in);
    const Answer<N> answer = Judge(block.parts, course);
    const Mask is_regular = Both(IsNegative(in.v0), AreModerate(block, i));
    const Mask serves = Both(is_regular, Both(answer.proved, answer.relative_error <= VLanes::Fill(tolerance)));
    const Mask breaks_limit = Either(answer.numbers.sharp_limit_broken, answer.numbers.energy_limit_broken);
    const V verdict = RegimeOf(course) + Select(breaks_limit, VLanes::Fill(kInadmissible), zero);
    VLanes::Store(verdict + Select(serves, zero, VLanes::Fill(kUnproved)), verdicts.data() + i);
    Store(block, i, answer);
    if (i == last) break;
  }
}

void SolvePlainBlock(const Block& block, double tolerance, Verdicts& verdicts) {
  SolveAll<Plain<V>>(block, tolerance, verdicts);
}

void SolveBlock(const Block& block, Verdicts& verdicts) {
  SolveAll<DoubleDouble<V>>(block, std::numeric_limits<double>::infinity(), verdicts);
}

size_t CountLanes() { return VLanes::Count(); }

}  // namespace ricochet::planar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet::planar {

HWY_EXPORT(SolvePlainBlock);
HWY_EXPORT(SolveBlock);
HWY_EXPORT(CountLanes);

namespace {

std::array<double, kOutputCount> NumbersOf(const Impact& impact, double relative_error) {
  const double work_tangential = impact.work_tangential_compression + impact.work_tangential_restitution;
  std::array<double, kOutputCount> numbers = {};
  const auto set = [&](Output output, double value) { numbers[static_cast<size_t>(output)] = value; };
  set(Output::kNewton, impact.newton);
  set(Output::kPoisson, impact.poisson);
  set(Output::kEnergetic, impact.energetic);
  set(Output::kTangentialCoefficient, impact.tangential);
  set(Output::kTangentialVelocityAfter, impact.u1);
  set(Output::kNormalVelocityAfter, impact.v1);
  set(Output::kNormalImpulseCompression, impact.tau_compression);
  set(Output::kNormalImpulse, impact.tau1);
  set(Output::kTangentialImpulse, impact.f1);
  set(Output::kWorkNormalCompression, impact.work_normal_compression);
  set(Output::kWorkNormalRestitution, impact.work_normal_restitution);
  set(Output::kWorkTangentialCompression, impact.work_tangential_compression);
  set(Output::kWorkTangentialRestitution, impact.work_tangential_restitution);
  set(Output::kWorkNormal, impact.work_normal_compression + impact.work_normal_restitution);
  set(Output::kWorkTangential, work_tangential);
  set(Output::kFrictionDissipation, 0.0 - work_tangential);
  set(Output::kEnergyChange, impact.energy_change);
  set(Output::kRelativeError, relative_error);
  return numbers;
}

// Solves any problem, wherever lanes do not serve, in double-double arithmetic.
void SolveAlone(const Block& block, size_t i) {
  RoundingErrors errors;
  const Impact impact = Solve(block[i], errors);
  const std::array<double, kOutputCount> numbers = NumbersOf(impact, errors.Largest());
  for (size_t output = 0; output < numbers.size(); ++output) {
    if (block.places[output] != nullptr) block.places[output][i] = numbers[output];
  }
  block.regimes[i] = impact.regime;
  block.is_inadmissible[i] = impact.sharp_limit_broken || impact.energy_limit_broken;
}

void SetVerdict(const Block& block, size_t i, int verdict) {
  block.regimes[i] = static_cast<Regime>(verdict & (kInadmissible - 1));
  block.is_inadmissible[i] = (verdict & kInadmissible) != 0;
}

// Some problems of a block, brought together so that they fill vectors. The last one is repeated until they do.
class Gathered {
 public:
  Gathered(const Block& block, absl::Span<const size_t> indices)
      : block_(block), indices_(indices), own_{.law = block.law, .parts = block.parts} {
    const size_t lanes = HWY_DYNAMIC_DISPATCH(CountLanes)();
    own_.size = std::max(lanes, indices.size());
    for (size_t k = 0; k < kNumbers; ++k) {
      for (size_t j = 0; j < own_.size; ++j) {
        numbers_[k][j] = block.numbers[k][indices[std::min(j, indices.size() - 1)]];
      }
      own_.numbers[k] = numbers_[k].data();
    }
    for (size_t output = 0; output < kOutputCount; ++output) {
      if (block.places[output] != nullptr) own_.places[output] = results_[output].data();
    }
  }

  const Block& problems() const { return own_; }

  // Copies the results back.
  void Scatter() const {
    for (size_t output = 0; output < kOutputCount; ++output) {
      if (block_.places[output] == nullptr) continue;
      for (size_t j = 0; j < indices_.size(); ++j) block_.places[output][indices_[j]] = results_[output][j];
    }
  }

 private:
  const Block& block_;
  absl::Span<const size_t> indices_;
  Block own_;
  std::array<std::array<double, kBlock>, kNumbers> numbers_;
  std::array<std::array<double, kBlock>, kOutputCount> results_;
};

// Solves the problems of these indices in double-double arithmetic.
void SolveCompensated(const Block& block, absl::Span<const size_t> indices) {
  if (indices.empty()) return;
  Gathered gathered(block, indices);
  Verdicts verdicts;
  HWY_DYNAMIC_DISPATCH(SolveBlock)(gathered.problems(), verdicts);
  gathered.Scatter();
  for (size_t j = 0; j < indices.size(); ++j) {
    const int verdict = static_cast<int>(verdicts[j]);
    if (verdict < kUnproved) {
      SetVerdict(block, indices[j], verdict);
    } else {
      SolveAlone(block, indices[j]);
    }
  }
}

void SolvePlainly(const Block& block, double tolerance, Verdicts& verdicts) {
  const size_t lanes = HWY_DYNAMIC_DISPATCH(CountLanes)();
  if (block.size >= lanes) return HWY_DYNAMIC_DISPATCH(SolvePlainBlock)(block, tolerance, verdicts);
  std::array<size_t, kBlock> all;
  for (size_t i = 0; i < block.size; ++i) all[i] = i;
  Gathered gathered(block, absl::MakeConstSpan(all).first(block.size));
  HWY_DYNAMIC_DISPATCH(SolvePlainBlock)(gathered.problems(), tolerance, verdicts);
  gathered.Scatter();
}

// Returns the number of problems for which plain arithmetic does not serve.
size_t SolveOneBlock(const Block& block, double tolerance) {
  Verdicts verdicts;
  verdicts.fill(kUnproved);
  if (tolerance > 0.0) SolvePlainly(block, tolerance, verdicts);
  std::array<size_t, kBlock> unproved;
  size_t count = 0;
  size_t separating = 0;
  for (size_t i = 0; i < block.size; ++i) {
    const int verdict = static_cast<int>(verdicts[i]);
    if (verdict < kUnproved) {
      SetVerdict(block, i, verdict);
    } else if (block.v0(i) >= 0.0) {
      SolveAlone(block, i);
      ++separating;
    } else {
      unproved[count++] = i;
    }
  }
  SolveCompensated(block, absl::MakeConstSpan(unproved).first(count));
  return tolerance > 0.0 ? count : count + separating;
}

unsigned PartsOf(absl::Span<const Output> outputs) {
  unsigned parts = 0;
  for (const Output output : outputs) {
    if (output == Output::kNewton) parts |= HWY_NAMESPACE::kPartNewton;
    if (output == Output::kPoisson) parts |= HWY_NAMESPACE::kPartPoisson;
    if (output == Output::kEnergetic) parts |= HWY_NAMESPACE::kPartEnergetic;
    if (output == Output::kTangentialCoefficient) parts |= HWY_NAMESPACE::kPartTangential;
  }
  return parts;
}

}  // namespace

Problem ProblemColumns::operator[](size_t i) const {
  return {.w = {wtt[i], wtn[i], wnn[i]},
          .u0 = u0[i],
          .v0 = v0[i],
          .mu = mu[i],
          .mu_static = mu_static[i],
          .law = law,
          .coefficient = coefficient[i]};
}

size_t SolveColumns(const ProblemColumns& problems, double tolerance, const SolvedColumns& solved) {
  assert(solved.outputs.size() == solved.columns.size());
  const unsigned parts = PartsOf(solved.outputs);
  const std::array columns = {problems.wtt, problems.wtn, problems.wnn,       problems.u0,
                              problems.v0,  problems.mu,  problems.mu_static, problems.coefficient};
  std::array<Regime, kBlock> own_regimes;
  std::array<bool, kBlock> own_inadmissible;
  size_t compensated = 0;
  for (size_t first = 0; first < problems.size(); first += kBlock) {
    Block block = {
        .law = problems.law,
        .parts = parts,
        .is_inadmissible = solved.inadmissible.empty() ? own_inadmissible.data() : &solved.inadmissible[first],
        .regimes = solved.regimes.empty() ? own_regimes.data() : &solved.regimes[first],
        .size = std::min(kBlock, problems.size() - first)};
    for (size_t k = 0; k < kNumbers; ++k) block.numbers[k] = columns[k].data() + first;
    for (size_t c = 0; c < solved.outputs.size(); ++c) {
      block.places[static_cast<size_t>(solved.outputs[c])] = solved.columns[c] + first;
    }
    compensated += SolveOneBlock(block, tolerance);
  }
  return compensated;
}

}  // namespace ricochet::planar

#endif  // HWY_ONCE
