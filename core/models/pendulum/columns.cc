// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/pendulum/columns.cc"
#include "core/models/pendulum/columns.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <utility>

#include "core/models/pendulum/parts.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/pendulum/kernel-inl.h"
#include "core/models/pendulum/rounding-inl.h"
#include "core/numerics/codes-inl.h"
#include "core/numerics/lanes-inl.h"
#include "core/numerics/plain-inl.h"
#include "core/numerics/sizes-inl.h"
// clang-format on

#ifndef RICOCHET_CORE_MODELS_PENDULUM_COLUMNS_CC_
#define RICOCHET_CORE_MODELS_PENDULUM_COLUMNS_CC_
namespace ricochet::pendulum {

// Some problems in a row, at least one, and the places of their results.
struct Block {
  static constexpr size_t kCapacity = 64;

  const ProblemColumns& problems;
  const SolvedColumns& solved;
  unsigned parts = 0;
  size_t first = 0;  // In `problems`.
  size_t place = 0;  // Where `solved` has the same problem.
  size_t size = 0;

  // The next `count` problems from the `from`-th on.
  Block Part(size_t from, size_t count) const {
    return {.problems = problems,
            .solved = solved,
            .parts = parts,
            .first = first + from,
            .place = place + from,
            .size = count};
  }
};

// A verdict is the number of a regime, with the flag kInadmissible if a limit is broken, and kUnproved if plain
// arithmetic does not prove the problem's results, which then have no meaning.
inline constexpr uint64_t kInadmissible = 64;
inline constexpr uint64_t kUnproved = 128;

// Says which problems of a block plain arithmetic has proved.
enum class Proof { kNotAll, kAll, kAllReboundWithinLimits };

// A verdict for each problem of a block, as lanes store it. Whole vectors are stored, which may reach beyond the block.
using Verdicts = std::array<uint64_t, Block::kCapacity + ProblemColumns::kMostLanes>;

}  // namespace ricochet::pendulum
#endif  // RICOCHET_CORE_MODELS_PENDULUM_COLUMNS_CC_

HWY_BEFORE_NAMESPACE();
namespace ricochet::pendulum::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::CopySign;
using ricochet::HWY_NAMESPACE::InAllLanes;
using ricochet::HWY_NAMESPACE::Select;
using ricochet::HWY_NAMESPACE::Sizes;

// The target's widest lanes.
using V = ricochet::HWY_NAMESPACE::Vector;
using VLanes = ricochet::HWY_NAMESPACE::Lanes<V>;
using VCodes = ricochet::HWY_NAMESPACE::Codes<V>;
using Mask = decltype(V() < V());

// Loads the problems of a block, as many at a time as a vector has lanes.
class Loader {
 public:
  explicit Loader(const Block& block)
      : is_poisson_(block.problems.law() == RestitutionLaw::kPoisson),
        inertia_(block.problems.inertia() + block.first),
        a_(block.problems.a() + block.first),
        b_(block.problems.b() + block.first),
        omega_(block.problems.omega_minus() + block.first),
        mu_(block.problems.mu() + block.first),
        mu_static_(block.problems.mu_static() + block.first),
        coefficient_(block.problems.coefficient() + block.first) {}

  template <typename N>
  HWY_INLINE Inputs<N, Mask> Load(size_t i) const {
    const V zero = VLanes::Fill(0.0);
    const V b = VLanes::Load(b_ + i);
    const V coefficient = VLanes::Load(coefficient_ + i);
    Inputs<N, Mask> in;
    in.inertia = N::Exactly(VLanes::Load(inertia_ + i));
    in.a = N::Exactly(VLanes::Load(a_ + i));
    in.b = N::Exactly(b);
    in.omega = N::Exactly(VLanes::Load(omega_ + i));
    in.mu = N::Exactly(Select(b == zero, zero, CopySign(VLanes::Load(mu_ + i), b)));
    in.mu_static = N::Exactly(CopySign(VLanes::Load(mu_static_ + i), b));
    in.coefficient = N::Exactly(coefficient);
    in.near_one = is_poisson_ ? coefficient < VLanes::Fill(2.0) : VLanes::Fill(0.5) < coefficient;
    return in;
  }

 private:
  bool is_poisson_;
  const double *inertia_, *a_, *b_, *omega_, *mu_, *mu_static_, *coefficient_;
};

// These parts take a division or a root each.
inline constexpr unsigned kExpensiveParts = kPartOneMinusKappa | kPartEta;

HWY_INLINE VCodes::Type CodeOfRegime(Regime regime) { return VCodes::Fill(static_cast<uint64_t>(regime)); }

// Returns the verdicts of problems, none of which may be separating.
template <typename N>
HWY_INLINE VCodes::Type VerdictsOf(const Solution<N, Mask>& x) {
  const VCodes::Type slips = VCodes::Select(Rounded(x.mu) == VLanes::Fill(0.0), CodeOfRegime(Regime::kFrictionless),
                                            CodeOfRegime(Regime::kRebound));
  const VCodes::Type regime = VCodes::Select(x.locked, CodeOfRegime(Regime::kLocked), slips);
  return VCodes::FlagWhere(IsNegative(x.one_minus_eta_squared), kInadmissible, regime);
}

HWY_INLINE void StoreVerdicts(const Block& block, const Verdicts& verdicts) {
  Regime* const regimes = block.solved.regimes.data() + block.place;
  bool* const inadmissible = block.solved.inadmissible.data() + block.place;
  for (size_t i = 0; i < block.size; ++i) {
    const uint64_t verdict = verdicts[i];
    regimes[i] = static_cast<Regime>(verdict & (kInadmissible - 1));
    inadmissible[i] = (verdict & kInadmissible) != 0;
  }
}

// Stores the outputs asked for of whole vectors of problems: those of a block that is smaller than a vector go to a
// place of their own first.
class Storer {
 public:
  explicit Storer(const Block& block) : block_(block), size_(block.size) {
    for (size_t c = 0; c < block.solved.outputs.size(); ++c) {
      const auto output = static_cast<size_t>(block.solved.outputs[c]);
      wanted_ |= 1U << output;
      places_[output] = IsSmall() ? own_[output].data() : block.solved.columns[c] + block.place;
    }
  }

  // The first problem of the last vector. That vector overlaps the one before it, so that it holds no problem beyond
  // the block.
  HWY_INLINE size_t Last() const { return IsSmall() ? 0 : size_ - VLanes::Count(); }

  template <typename N>
  HWY_INLINE void Store(size_t i, const Solution<N, Mask>& x) const {
    const unsigned wanted = wanted_;  // A copy, which no store of a vector can change.
    StoreGroup<0>(wanted, i, x, std::make_index_sequence<kGroup>());
    StoreGroup<kGroup>(wanted, i, x, std::make_index_sequence<kGroup>());
    StoreGroup<2 * kGroup>(wanted, i, x, std::make_index_sequence<kGroup>());
    StoreGroup<3 * kGroup>(wanted, i, x, std::make_index_sequence<kOutputCount - 3 * kGroup>());
  }

  void End() const {
    if (!IsSmall()) return;
    for (size_t c = 0; c < block_.solved.outputs.size(); ++c) {
      const auto output = static_cast<size_t>(block_.solved.outputs[c]);
      std::copy_n(own_[output].data(), size_, block_.solved.columns[c] + block_.place);
    }
  }

 private:
  HWY_INLINE bool IsSmall() const { return size_ < VLanes::Count(); }

  // Outputs whose bits are tested together first.
  static constexpr size_t kGroup = 5;

  // Each output has its bit and its own place in the code: a jump to a place that is looked up costs more than an
  // output.
  template <size_t kFirst, typename N, size_t... kInGroup>
  HWY_INLINE void StoreGroup(unsigned wanted, size_t i, const Solution<N, Mask>& x,
                             std::index_sequence<kInGroup...> /*group*/) const {
    if ((wanted & ((1U << kFirst << sizeof...(kInGroup)) - (1U << kFirst))) == 0) return;
    ((wanted & (1U << (kFirst + kInGroup)) ? StoreOne<static_cast<Output>(kFirst + kInGroup)>(i, x) : void()), ...);
  }

  // Adding 0 turns -0 into 0: an impulse or velocity that vanishes has no sign.
  template <Output kOutput, typename N>
  HWY_INLINE void StoreOne(size_t i, const Solution<N, Mask>& x) const {
    VLanes::Store(Evaluate(x, kOutput) + VLanes::Fill(0.0), places_[static_cast<size_t>(kOutput)] + i);
  }

  const Block& block_;
  size_t size_;
  unsigned wanted_ = 0;  // One bit for each output.
  std::array<double*, kOutputCount> places_;
  std::array<std::array<double, ProblemColumns::kMostLanes>, kOutputCount> own_;
};

// RelativeError is within the tolerance if kappa is at most this number, which is rounded down.
double MostKappa(double tolerance) { return (tolerance - kErrorOfOne) / kErrorOfKappa * (1.0 - 0x1p-40); }

// True where a problem rebounds, keeps all limits and is proved with room to spare, as most problems of a sweep are.
// This takes a third of the operations that tell the other problems apart.
template <typename N>
HWY_INLINE Mask ReboundWithinLimits(RestitutionLaw law, const Inputs<N, Mask>& in, const Solution<N, Mask>& x,
                                    V most_kappa) {
  const V zero = VLanes::Fill(0.0);
  const Mask rebounds = zero < Smaller(Smaller(Rounded(x.margin), Rounded(x.d)), Rounded(x.q));
  const bool is_exact = law == RestitutionLaw::kEnergetic;
  V to_limit = Rounded(x.one_minus_eta_squared);
  if (law == RestitutionLaw::kPoisson) to_limit = Smaller(to_limit, Rounded(x.one_minus_kappa_hat));
  const Mask keeps_limits = VLanes::Fill(is_exact ? 0.0 : kLeastSure) <= to_limit;
  return Both(Both(rebounds, keeps_limits), Both(Rounded(x.kappa) <= most_kappa, IsModerate(in)));
}

// Solves each problem plainly. The law and the parts are constants, because telling them apart takes as long as
// computing them.
template <RestitutionLaw kLaw, unsigned kParts>
HWY_INLINE Proof SolvePlainBlockOf(const Block& block, double tolerance, Verdicts& verdicts) {
  using N = Plain<V>;
  const unsigned parts = kParts | (block.parts & kExpensiveParts);
  const Loader loader(block);
  Storer storer(block);
  const V most_kappa = VLanes::Fill(MostKappa(tolerance));
  Mask all = VLanes::Fill(0.0) == VLanes::Fill(0.0);
  bool all_within = true;
  const size_t last = storer.Last();
  for (size_t i = 0;; i = std::min(i + VLanes::Count(), last)) {
    const auto in = loader.Load<N>(i);
    Solution<N, Mask> x;
    SolveUnlocked(kLaw, in, parts, x);
    if (!InAllLanes(ReboundWithinLimits(kLaw, in, x, most_kappa))) [[unlikely]] {
      if (all_within) verdicts.fill(static_cast<uint64_t>(Regime::kRebound));
      all_within = false;
      OverrideLocked(x);
      const Mask is_right = Both(SignsAreProved(kLaw, x), RelativeError(x) <= VLanes::Fill(tolerance));
      const Mask is_proved = Both(IsModerate(in), is_right);
      VCodes::Store(VCodes::FlagUnless(is_proved, kUnproved, VerdictsOf(x)), verdicts.data() + i);
      all = Both(all, is_proved);
    }
    storer.Store(i, x);
    if (i == last) break;
  }
  storer.End();
  if (all_within) {
    std::fill_n(block.solved.regimes.data() + block.place, block.size, Regime::kRebound);
    std::fill_n(block.solved.inadmissible.data() + block.place, block.size, false);
    return Proof::kAllReboundWithinLimits;
  }
  StoreVerdicts(block, verdicts);
  return InAllLanes(all) ? Proof::kAll : Proof::kNotAll;
}

template <RestitutionLaw kLaw>
Proof SolvePlainBlockOf(const Block& block, double tolerance, Verdicts& verdicts) {
  constexpr unsigned kFew = kPartKappa | kPartKappaHat;
  if ((block.parts & ~kFew) == 0) return SolvePlainBlockOf<kLaw, kFew>(block, tolerance, verdicts);
  return SolvePlainBlockOf<kLaw, kPartAll & ~kExpensiveParts>(block, tolerance, verdicts);
}

Proof SolvePlainBlock(const Block& block, double tolerance, Verdicts& verdicts) {
  switch (block.problems.law()) {
    case RestitutionLaw::kNewton:
      return SolvePlainBlockOf<RestitutionLaw::kNewton>(block, tolerance, verdicts);
    case RestitutionLaw::kPoisson:
      return SolvePlainBlockOf<RestitutionLaw::kPoisson>(block, tolerance, verdicts);
    case RestitutionLaw::kEnergetic:
      return SolvePlainBlockOf<RestitutionLaw::kEnergetic>(block, tolerance, verdicts);
  }
  return Proof::kNotAll;
}

HWY_INLINE bool FitsDoubleDouble(const Block& block) {
  const ProblemColumns& problems = block.problems;
  Sizes<V> sizes;
  Sizes<V> coefficients;
  for (size_t i = block.first; i < block.first + block.size; i += VLanes::Count()) {
    for (const double* column : {problems.inertia(), problems.a(), problems.b(), problems.omega_minus(), problems.mu(),
                                 problems.mu_static()}) {
      sizes.Include(VLanes::Load(column + i));
    }
    coefficients.Include(VLanes::Load(problems.coefficient() + i));
  }
  return InAllLanes(sizes.AreWithin(kLimit)) && InAllLanes(coefficients.AreWithin(kCoefficientLimit));
}

// Solves problems that approach in double-double arithmetic. Returns false and writes nothing if a number is beyond the
// limits.
bool SolveBlock(const Block& block) {
  using N = ricochet::HWY_NAMESPACE::DoubleDouble<V>;
  if (!FitsDoubleDouble(block)) return false;
  const Loader loader(block);
  Storer storer(block);
  Verdicts verdicts;
  const size_t last = storer.Last();
  for (size_t i = 0;; i = std::min(i + VLanes::Count(), last)) {
    Solution<N, Mask> x;
    SolveParts(block.problems.law(), loader.Load<N>(i), block.parts, x);
    VCodes::Store(VerdictsOf(x), verdicts.data() + i);
    storer.Store(i, x);
    if (i == last) break;
  }
  storer.End();
  StoreVerdicts(block, verdicts);
  return true;
}

}  // namespace ricochet::pendulum::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet::pendulum {

HWY_EXPORT(SolveBlock);
HWY_EXPORT(SolvePlainBlock);

namespace {

unsigned PartsOf(absl::Span<const Output> outputs) {
  unsigned parts = 0;
  for (const Output output : outputs) parts |= PartsOf(output);
  return parts;
}

// Solves any problem, wherever lanes do not serve.
void SolveAlone(const Block& block, size_t i) {
  const Impact impact = Solve(block.problems[block.first + i]);
  const SolvedColumns& solved = block.solved;
  solved.regimes[block.place + i] = impact.regime;
  solved.inadmissible[block.place + i] = impact.sharp_limit_broken;
  for (size_t c = 0; c < solved.outputs.size(); ++c) {
    solved.columns[c][block.place + i] = impact[solved.outputs[c]];
  }
}

// Solves the block in double-double arithmetic.
void SolveCompensated(const Block& block) {
  const double* const omega = block.problems.omega_minus() + block.first;
  for (size_t from = 0; from < block.size;) {
    size_t to = from;
    while (to < block.size && omega[to] < 0.0) ++to;
    if (to > from && HWY_DYNAMIC_DISPATCH(SolveBlock)(block.Part(from, to - from))) {
      from = to;
    } else {
      for (to = std::max(to, from + 1); from < to; ++from) SolveAlone(block, from);
    }
  }
}

// Returns true if all problems rebound within the limits (ReboundWithinLimits).
bool SolvePlainFirst(const Block& block, double tolerance) {
  Verdicts verdicts;
  const Proof proof = HWY_DYNAMIC_DISPATCH(SolvePlainBlock)(block, tolerance, verdicts);
  if (proof != Proof::kNotAll) return proof == Proof::kAllReboundWithinLimits;
  const auto is_proved = [&verdicts](size_t i) { return verdicts[i] < kUnproved; };
  for (size_t from = 0; from < block.size;) {
    size_t to = from;
    while (to < block.size && is_proved(to) == is_proved(from)) ++to;
    if (!is_proved(from)) SolveCompensated(block.Part(from, to - from));
    from = to;
  }
  return false;
}

}  // namespace

ProblemColumns::ProblemColumns(RestitutionLaw law, size_t size) : law_(law), size_(size) {
  for (auto& column : numbers_) {
    column = hwy::AllocateAligned<double>(size + kMostLanes);
    std::fill_n(column.get(), size + kMostLanes, 0.0);
  }
}

void ProblemColumns::Set(size_t i, const Problem& problem) {
  assert(i < size_ && problem.law == law_);
  const double numbers[] = {problem.inertia, problem.a,         problem.b,          problem.omega_minus,
                            problem.mu,      problem.mu_static, problem.coefficient};
  for (size_t n = 0; n < kNumbers; ++n) numbers_[n][i] = numbers[n];
}

Problem ProblemColumns::operator[](size_t i) const {
  return {.inertia = inertia()[i],
          .a = a()[i],
          .b = b()[i],
          .omega_minus = omega_minus()[i],
          .mu = mu()[i],
          .mu_static = mu_static()[i],
          .law = law_,
          .coefficient = coefficient()[i]};
}

bool SolveColumns(const ProblemColumns& problems, size_t first, size_t count, double tolerance,
                  const SolvedColumns& solved) {
  assert(first + count <= problems.size() && solved.outputs.size() == solved.columns.size());
  const bool may_be_plain = tolerance >= HWY_NAMESPACE::kLeastError;
  // The bound on the rounding error needs kappa.
  const unsigned parts = PartsOf(solved.outputs) | (may_be_plain ? kPartKappa : 0U);
  bool all_within = may_be_plain;
  for (size_t done = 0; done < count; done += Block::kCapacity) {
    const Block block = {.problems = problems,
                         .solved = solved,
                         .parts = parts,
                         .first = first + done,
                         .place = done,
                         .size = std::min(Block::kCapacity, count - done)};
    if (may_be_plain) {
      all_within &= SolvePlainFirst(block, tolerance);
    } else {
      SolveCompensated(block);
    }
  }
  return all_within;
}

}  // namespace ricochet::pendulum

#endif  // HWY_ONCE
