// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/pendulum/pendulum.cc"
#include "core/models/pendulum/pendulum.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <variant>
#include <vector>

#include "core/models/pendulum/parts.h"
#include "core/models/restitution_law.h"
// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/pendulum/kernel-inl.h"
#include "core/models/pendulum/rounding-inl.h"
#include "core/models/pendulum/sizes-inl.h"
#include "core/numerics/lanes-inl.h"
#include "core/numerics/plain-inl.h"
// clang-format on

#ifndef RICOCHET_CORE_MODELS_PENDULUM_CC_
#define RICOCHET_CORE_MODELS_PENDULUM_CC_
namespace ricochet::pendulum {

// A Block holds problems of one law, column by column, for vectors to load.
struct Block {
  static constexpr size_t kCapacity = 64;

  RestitutionLaw law = RestitutionLaw::kEnergetic;
  size_t size = 0;
  std::array<double, kCapacity> inertia, a, b, omega, mu, mu_static, coefficient;
  std::array<double, kCapacity> friction;      // The stated mu, even if the directions are not coupled.
  std::array<double, kCapacity> locked;        // Output: 1 if locked, else 0.
  std::array<double, kCapacity> inadmissible;  // Output: 1 if eta > 1, else 0.

  void Append(const Problem& problem) {
    assert(size < kCapacity);
    inertia[size] = problem.inertia;
    a[size] = problem.a;
    b[size] = problem.b;
    omega[size] = problem.omega_minus;
    mu[size] = SignedFriction(problem);
    mu_static[size] = std::copysign(problem.mu_static, problem.b);
    coefficient[size] = problem.coefficient;
    friction[size] = problem.mu;
    ++size;
  }

  // Repeats the last problem, so that whole vectors can be loaded.
  void PadTo(size_t padded) {
    for (auto* column : {&inertia, &a, &b, &omega, &mu, &mu_static, &coefficient, &friction}) {
      std::fill(column->begin() + static_cast<int64_t>(size), column->begin() + static_cast<int64_t>(padded),
                (*column)[size - 1]);
    }
  }
};

}  // namespace ricochet::pendulum
#endif  // RICOCHET_CORE_MODELS_PENDULUM_CC_

HWY_BEFORE_NAMESPACE();
namespace ricochet::pendulum::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::InAllLanes;

// The target's widest lanes.
using V = ricochet::HWY_NAMESPACE::Vector;
using N = ricochet::HWY_NAMESPACE::DoubleDouble<V>;
using VLanes = ricochet::HWY_NAMESPACE::Lanes<V>;
using Mask = decltype(IsPositive(N()));

// Adding 0 turns -0 into 0: an impulse or velocity that vanishes has no sign.
template <typename T>
HWY_INLINE T Unsigned0(T value) {
  return value + ricochet::HWY_NAMESPACE::Lanes<T>::Fill(0.0);
}

HWY_INLINE Inputs<N, Mask> LoadInputs(const Block& block, size_t i) {
  const auto exactly = [i](const auto& column) { return N::Exactly(VLanes::Load(column.data() + i)); };
  const V coefficient = VLanes::Load(block.coefficient.data() + i);
  Inputs<N, Mask> in;
  in.inertia = exactly(block.inertia);
  in.a = exactly(block.a);
  in.b = exactly(block.b);
  in.omega = exactly(block.omega);
  in.mu = exactly(block.mu);
  in.mu_static = exactly(block.mu_static);
  in.coefficient = N::Exactly(coefficient);
  in.near_one =
      block.law == RestitutionLaw::kPoisson ? coefficient < VLanes::Fill(2.0) : VLanes::Fill(0.5) < coefficient;
  return in;
}

// Stores the first `count` lanes of `value` at `to`.
HWY_INLINE void StoreFirst(V value, size_t count, double* to) {
  if (count >= VLanes::Count()) {
    VLanes::Store(value, to);
    return;
  }
  double lanes[Block::kCapacity];
  VLanes::Store(value, lanes);
  std::copy_n(lanes, count, to);
}

HWY_INLINE bool FitsDoubleDouble(const Block& block) {
  Sizes<V> sizes;
  Sizes<V> coefficients;
  for (size_t i = 0; i < block.size; i += VLanes::Count()) {
    for (const auto* column : {&block.inertia, &block.a, &block.b, &block.omega, &block.friction, &block.mu_static}) {
      sizes.TakeIn(VLanes::Load(column->data() + i));
    }
    coefficients.TakeIn(VLanes::Load(block.coefficient.data() + i));
  }
  return InAllLanes(sizes.AreWithin(kLimit)) && InAllLanes(coefficients.AreWithin(kCoefficientLimit));
}

// Returns false and writes nothing if a number is beyond the limits.
bool SolveBlock(Block& block, unsigned parts, absl::Span<const Output> outputs, absl::Span<double* const> columns) {
  block.PadTo((block.size + VLanes::Count() - 1) / VLanes::Count() * VLanes::Count());
  if (!FitsDoubleDouble(block)) return false;
  const V zero = VLanes::Fill(0.0);
  const V one = VLanes::Fill(1.0);
  for (size_t i = 0; i < block.size; i += VLanes::Count()) {
    Solution<N, Mask> x;
    SolveParts(block.law, LoadInputs(block, i), parts, x);
    VLanes::Store(Select(x.locked, one, zero), block.locked.data() + i);
    VLanes::Store(Select(IsNegative(x.one_minus_eta_squared), one, zero), block.inadmissible.data() + i);
    for (size_t c = 0; c < outputs.size(); ++c) {
      StoreFirst(Unsigned0(Evaluate(x, outputs[c])), block.size - i, columns[c] + i);
    }
  }
  return true;
}

template <typename T>
HWY_INLINE Impact ImpactOf(const Problem& problem, const Solution<T, bool>& x) {
  Impact impact;
  impact.regime = RegimeOf(problem, x.locked);
  impact.sharp_limit_broken = IsNegative(x.one_minus_eta_squared);
  impact.energy_limit_broken = IsNegative(x.one_minus_kappa_hat);
  for (int i = 0; i < kOutputCount; ++i) {
    impact.values[static_cast<size_t>(i)] = Unsigned0(Evaluate(x, static_cast<Output>(i)));
  }
  return impact;
}

template <typename T>
HWY_INLINE Impact SolveOne(const Problem& problem) {
  Solution<T, bool> x;
  SolveParts(problem.law, MakeInputs<T>(problem), kPartAll, x);
  return ImpactOf(problem, x);
}

Impact SolveModerate(const Problem& problem) {
  return SolveOne<ricochet::HWY_NAMESPACE::DoubleDouble<double>>(problem);
}

// The problem must not separate.
void SolvePlainly(const Problem& problem, PlainImpact& plain) {
  const auto in = MakeInputs<Plain<double>>(problem);
  plain.proved = IsModerate(in);
  if (!plain.proved) return;
  Solution<Plain<double>, bool> x;
  SolveParts(problem.law, in, kPartAll, x);
  plain.proved = SignsAreProved(problem.law, x);
  if (!plain.proved) return;
  plain.relative_error = RelativeError(x);
  plain.impact = ImpactOf(problem, x);
}

}  // namespace ricochet::pendulum::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "core/models/pendulum/wide.h"

namespace ricochet::pendulum {

HWY_EXPORT(SolveBlock);
HWY_EXPORT(SolveModerate);
HWY_EXPORT(SolvePlainly);

namespace {

using HWY_NAMESPACE::kCoefficientLimit;
using HWY_NAMESPACE::kLimit;

bool FitsDoubleDouble(const Problem& problem) {
  const auto moderate = [](double value, double limit) {
    const double size = std::fabs(value);
    return size == 0.0 || (size >= 1.0 / limit && size <= limit);
  };
  return moderate(problem.inertia, kLimit) && moderate(problem.a, kLimit) && moderate(problem.b, kLimit) &&
         moderate(problem.omega_minus, kLimit) && moderate(problem.mu, kLimit) && moderate(problem.mu_static, kLimit) &&
         moderate(problem.coefficient, kCoefficientLimit);
}

bool Separating(const Problem& problem) { return problem.omega_minus >= 0.0; }

// The output for a contact that does not approach: velocities stay the same, all other outputs are 0.
double SeparatingOutput(const Problem& problem, Output output) {
  switch (output) {
    case Output::kOmegaPlus:
      return problem.omega_minus;
    case Output::kTangentialVelocityAfter:
      return problem.b * problem.omega_minus;
    case Output::kNormalVelocityAfter:
      return problem.a * problem.omega_minus;
    case Output::kEnergeticExcess:
      return -1.0;
    default:
      return 0.0;
  }
}

Impact SolveSeparating(const Problem& problem) {
  Impact impact;
  impact.regime = Regime::kSeparating;
  for (int i = 0; i < kOutputCount; ++i) {
    impact.values[static_cast<size_t>(i)] = SeparatingOutput(problem, static_cast<Output>(i));
  }
  return impact;
}

unsigned PartsOf(absl::Span<const Output> outputs) {
  unsigned parts = 0;
  for (const Output output : outputs) parts |= PartsOf(output);
  return parts;
}

}  // namespace

Impact Solve(const Problem& problem) {
  if (Separating(problem)) return SolveSeparating(problem);
  if (!FitsDoubleDouble(problem)) return HWY_NAMESPACE::SolveOne<Wide>(problem);
  return HWY_DYNAMIC_DISPATCH(SolveModerate)(problem);
}

PlainImpact SolvePlain(const Problem& problem) {
  PlainImpact plain;
  if (Separating(problem)) {
    plain.impact = SolveSeparating(problem);
    plain.relative_error = HWY_NAMESPACE::kUnitRoundoff;
    plain.proved = true;
  } else {
    HWY_DYNAMIC_DISPATCH(SolvePlainly)(problem, plain);
  }
  return plain;
}

void SolveColumns(absl::Span<const Problem> problems, absl::Span<const Output> outputs,
                  absl::Span<double* const> columns, absl::Span<Regime> regimes, absl::Span<bool> inadmissible) {
  assert(outputs.size() == columns.size());
  const unsigned parts = PartsOf(outputs);
  std::vector<double*> ends(columns.begin(), columns.end());
  for (size_t first = 0; first < problems.size();) {
    Block block;
    block.law = problems[first].law;
    for (size_t i = first; i < problems.size() && block.size < Block::kCapacity; ++i) {
      if (problems[i].law != block.law || Separating(problems[i])) break;
      block.Append(problems[i]);
    }
    const bool in_lanes = block.size > 0 && HWY_DYNAMIC_DISPATCH(SolveBlock)(block, parts, outputs, ends);
    const size_t count = std::max<size_t>(block.size, 1);
    for (size_t i = 0; i < count; ++i) {
      const Problem& problem = problems[first + i];
      if (in_lanes) {
        regimes[first + i] = RegimeOf(problem, block.locked[i] != 0.0);
        inadmissible[first + i] = block.inadmissible[i] != 0.0;
        continue;
      }
      const Impact impact = Solve(problem);
      regimes[first + i] = impact.regime;
      inadmissible[first + i] = impact.sharp_limit_broken;
      for (size_t c = 0; c < outputs.size(); ++c) ends[c][i] = impact[outputs[c]];
    }
    for (double*& end : ends) end += count;
    first += count;
  }
}

Instant At(const Problem& problem, double tau) {
  const WideSolution x = SolveGeometry(problem);
  const Wide momentum = x.inertia * x.omega;
  const Wide impulse = Wide::Exactly(tau);
  // J omega(tau) in compression. From the end of compression on the slope is d instead of s.
  const Wide compression = momentum + x.s * impulse;
  if (!IsPositive(compression)) {
    return {Rounded(compression / x.inertia) + 0.0, Rounded(x.mu * impulse) + 0.0};
  }
  const Wide two = Wide::Constant(2.0);
  return {Rounded(x.d / x.s * compression / x.inertia) + 0.0,
          Rounded(-x.mu * (two * momentum + x.s * impulse) / x.s) + 0.0};
}

}  // namespace ricochet::pendulum

#endif  // HWY_ONCE
