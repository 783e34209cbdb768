// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/planar/columns.cc"
#include "core/models/planar/columns.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>

// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/planar/kernel-inl.h"
#include "core/models/planar/report-inl.h"
#include "core/models/planar/rounding-inl.h"
#include "core/models/planar_outputs-inl.h"
#include "core/numerics/codes-inl.h"
#include "core/numerics/lanes-inl.h"
// clang-format on

#ifndef RICOCHET_CORE_MODELS_PLANAR_COLUMNS_CC_
#define RICOCHET_CORE_MODELS_PLANAR_COLUMNS_CC_
namespace ricochet::planar {

// Problems are solved in blocks of this many.
inline constexpr size_t kBlock = 64;

// The numbers of a problem, in the order of `Inputs`.
enum : size_t { kWtt, kWtn, kWnn, kU0, kV0, kMu, kMuStatic, kCoefficient, kNumbers };

// The problems of a call, and the places of their results.
struct Job {
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  std::array<const double*, kNumbers> numbers = {};
  std::array<double*, kOutputCount> places = {};  // Null for an output that is not wanted.
  unsigned parts = 0;                             // The outputs wanted need these.
  Regime* regimes = nullptr;                      // Null if they are not wanted.
  bool* inadmissible = nullptr;                   // Null if it is not wanted.

  Problem operator[](size_t i) const {
    return {.w = {numbers[kWtt][i], numbers[kWtn][i], numbers[kWnn][i]},
            .u0 = numbers[kU0][i],
            .v0 = numbers[kV0][i],
            .mu = numbers[kMu][i],
            .mu_static = numbers[kMuStatic][i],
            .law = law,
            .coefficient = numbers[kCoefficient][i]};
  }
  bool IsSeparating(size_t i) const { return numbers[kV0][i] >= 0.0; }

  void SetEnd(size_t i, Regime regime, bool breaks_limit) const {
    if (regimes != nullptr) regimes[i] = regime;
    if (inadmissible != nullptr) inadmissible[i] = breaks_limit;
  }
};

// A verdict is the number of a regime, with the flag kInadmissible if a limit is broken, and kUnproved if the
// arithmetic does not prove the problem's results within the tolerance, which then have no meaning.
inline constexpr uint64_t kInadmissible = 64;
inline constexpr uint64_t kUnproved = 128;
using Verdicts = std::array<uint64_t, kBlock>;

}  // namespace ricochet::planar
#endif  // RICOCHET_CORE_MODELS_PLANAR_COLUMNS_CC_

HWY_BEFORE_NAMESPACE();
namespace ricochet::planar::HWY_NAMESPACE {

// The target's widest lanes.
using V = ricochet::HWY_NAMESPACE::Vector;
using VLanes = ricochet::HWY_NAMESPACE::Lanes<V>;
using VCodes = ricochet::HWY_NAMESPACE::Codes<V>;
using Mask = decltype(V() < V());

template <typename N>
HWY_INLINE Inputs<N> LoadInputs(const Job& job, size_t i) {
  return InputsFrom<N>([&](size_t k) HWY_ATTR { return N::Exactly(VLanes::Load(job.numbers[k] + i)); });
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
  return {MakeNumbers(parts, course), CompensatedBounds(course, ErrorsOf(course)).Largest(), all};
}

template <typename N>
HWY_INLINE void Store(const Job& job, size_t i, const Answer<N>& answer) {
  ricochet::HWY_NAMESPACE::ForEachOutput(answer.numbers, VLanes::Fill(0.0), answer.relative_error,
                                         [&](Output output, V value) HWY_ATTR {
                                           double* const place = job.places[static_cast<size_t>(output)];
                                           if (place != nullptr) VLanes::Store(value, place + i);
                                         });
}

// Solves the problems [first, first + count), of which there are at least as many as a vector has lanes. The last
// vector overlaps the one before it, so that it holds no problem beyond them. A result whose bound exceeds `tolerance`
// is not proved.
template <typename N>
HWY_INLINE void SolveAll(const Job& job, size_t first, size_t count, double tolerance, Verdicts& verdicts) {
  const size_t last = count - VLanes::Count();
  for (size_t done = 0;; done = std::min(done + VLanes::Count(), last)) {
    const size_t i = first + done;
    const Inputs<N> in = LoadInputs<N>(job, i);
    const Course<N> course = Follow(job.law, in);
    const Answer<N> answer = Judge(job.parts, course);
    const Mask is_regular = Both(Both(IsNegative(in.v0), Not(course.jammed)), IsModerate(in));
    const Mask serves = Both(is_regular, Both(answer.proved, answer.relative_error <= VLanes::Fill(tolerance)));
    const Mask breaks_limit = Either(answer.numbers.sharp_limit_broken, answer.numbers.energy_limit_broken);
    const VCodes::Type verdict = VCodes::FlagWhere(breaks_limit, kInadmissible, RegimeOf(course));
    VCodes::Store(VCodes::FlagUnless(serves, kUnproved, verdict), verdicts.data() + done);
    Store(job, i, answer);
    if (done == last) break;
  }
}

void SolvePlainBlock(const Job& job, size_t first, size_t count, double tolerance, Verdicts& verdicts) {
  SolveAll<Plain<V>>(job, first, count, tolerance, verdicts);
}

void SolveBlock(const Job& job, size_t count, Verdicts& verdicts) {
  SolveAll<DoubleDouble<V>>(job, 0, count, std::numeric_limits<double>::infinity(), verdicts);
}

size_t CountLanes() { return VLanes::Count(); }

}  // namespace ricochet::planar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet::planar {

HWY_EXPORT(SolvePlainBlock);
HWY_EXPORT(SolveBlock);
HWY_EXPORT(CountLanes);

std::array<double, kOutputCount> NumbersOf(const ImpactEnd<double>& impact, double relative_error) {
  std::array<double, kOutputCount> numbers = {};
  ricochet::HWY_NAMESPACE::ForEachOutput(
      impact, 0.0, relative_error, [&](Output output, double value) { numbers[static_cast<size_t>(output)] = value; });
  return numbers;
}

namespace {

void Write(const Job& job, size_t i, const Impact& impact, double relative_error) {
  const std::array<double, kOutputCount> numbers = NumbersOf(impact, relative_error);
  for (size_t output = 0; output < numbers.size(); ++output) {
    if (job.places[output] != nullptr) job.places[output][i] = numbers[output];
  }
  job.SetEnd(i, impact.regime, impact.sharp_limit_broken || impact.energy_limit_broken);
}

// Solves any problem in double-double arithmetic, wherever lanes do not serve.
void SolveAlone(const Job& job, size_t i) {
  RoundingErrors errors;
  const Impact impact = Solve(job[i], errors);
  Write(job, i, impact, errors.Largest());
}

// The rank of W is not an output.
void WriteSeparating(const Job& job, size_t i) {
  const Problem problem = job[i];
  Write(job, i, Separating<Impact>(2, problem.u0, problem.v0), 0.0);
}

bool ServesPlainly(const Job& job, size_t i, double tolerance) {
  const PlainImpact plain = SolvePlain(job[i]);
  const double error = plain.errors.Largest();
  const bool serves = plain.proved && error <= tolerance;
  if (serves) Write(job, i, plain.impact, error);
  return serves;
}

void SetVerdict(const Job& job, size_t i, uint64_t verdict) {
  job.SetEnd(i, static_cast<Regime>(verdict & (kInadmissible - 1)), (verdict & kInadmissible) != 0);
}

// Problems wait here for double-double arithmetic until they fill vectors.
class CompensatedQueue {
 public:
  explicit CompensatedQueue(const Job& job) : job_(job), own_{.law = job.law, .parts = job.parts} {
    for (size_t k = 0; k < kNumbers; ++k) own_.numbers[k] = numbers_[k].data();
    for (size_t output = 0; output < kOutputCount; ++output) {
      if (job.places[output] != nullptr) own_.places[output] = results_[output].data();
    }
  }

  // Adds the i-th problem of the job. It must not be separating.
  void Push(size_t i) {
    indices_[size_] = i;
    for (size_t k = 0; k < kNumbers; ++k) numbers_[k][size_] = job_.numbers[k][i];
    if (++size_ == kBlock) SolveAll();
  }

  void SolveAll() {
    const size_t lanes = HWY_DYNAMIC_DISPATCH(CountLanes)();
    // A vector takes about three times as long as a problem alone.
    if (size_ < std::min(lanes, size_t{3})) {
      for (size_t j = 0; j < size_; ++j) SolveAlone(job_, indices_[j]);
    } else {
      SolveInLanes(std::max(size_, lanes));
    }
    size_ = 0;
  }

 private:
  // The first problem is repeated until there are `count`.
  void SolveInLanes(size_t count) {
    for (auto& numbers : numbers_) std::fill(numbers.begin() + size_, numbers.begin() + count, numbers[0]);
    Verdicts verdicts;
    HWY_DYNAMIC_DISPATCH(SolveBlock)(own_, count, verdicts);
    for (size_t j = 0; j < size_; ++j) {
      const uint64_t verdict = verdicts[j];
      if (verdict >= kUnproved) {
        SolveAlone(job_, indices_[j]);
      } else {
        SetVerdict(job_, indices_[j], verdict);
        CopyBack(j);
      }
    }
  }

  void CopyBack(size_t j) const {
    for (size_t output = 0; output < kOutputCount; ++output) {
      if (job_.places[output] != nullptr) job_.places[output][indices_[j]] = results_[output][j];
    }
  }

  const Job& job_;
  Job own_;  // The problems that wait.
  size_t size_ = 0;
  std::array<size_t, kBlock> indices_;
  std::array<std::array<double, kBlock>, kNumbers> numbers_;
  std::array<std::array<double, kBlock>, kOutputCount> results_;
};

// Solves the problems [first, first + count) as far as plain arithmetic serves. Returns the number of problems for
// which it does not.
size_t SolveSome(const Job& job, size_t first, size_t count, double tolerance, CompensatedQueue& waiting) {
  Verdicts verdicts;
  HWY_DYNAMIC_DISPATCH(SolvePlainBlock)(job, first, count, tolerance, verdicts);
  size_t unproved = 0;
  for (size_t i = 0; i < count; ++i) {
    const uint64_t verdict = verdicts[i];
    if (verdict < kUnproved) {
      SetVerdict(job, first + i, verdict);
    } else if (job.IsSeparating(first + i)) {
      WriteSeparating(job, first + i);
    } else {
      waiting.Push(first + i);
      ++unproved;
    }
  }
  return unproved;
}

size_t SolvePlainFirst(const Job& job, size_t count, double tolerance) {
  const size_t lanes = HWY_DYNAMIC_DISPATCH(CountLanes)();
  CompensatedQueue waiting(job);
  size_t unproved = 0;
  if (count < lanes) {
    for (size_t i = 0; i < count; ++i) {
      if (ServesPlainly(job, i, tolerance)) continue;
      waiting.Push(i);
      ++unproved;
    }
  } else {
    for (size_t done = 0, size = 0; done < count; done += size) {
      const size_t left = count - done;
      // No block has fewer problems than a vector has lanes.
      size = left > kBlock && left < kBlock + lanes ? kBlock / 2 : std::min(left, kBlock);
      unproved += SolveSome(job, done, size, tolerance, waiting);
    }
  }
  waiting.SolveAll();
  return unproved;
}

void SolveCompensated(const Job& job, size_t count) {
  CompensatedQueue waiting(job);
  for (size_t i = 0; i < count; ++i) {
    if (job.IsSeparating(i)) {
      WriteSeparating(job, i);
    } else {
      waiting.Push(i);
    }
  }
  waiting.SolveAll();
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

size_t SolveColumns(const ProblemColumns& problems, double tolerance, const SolvedColumns& solved) {
  assert(solved.outputs.size() == solved.columns.size());
  const std::array columns = {problems.wtt, problems.wtn, problems.wnn,       problems.u0,
                              problems.v0,  problems.mu,  problems.mu_static, problems.coefficient};
  Job job = {.law = problems.law, .parts = PartsOf(solved.outputs)};
  for (size_t k = 0; k < kNumbers; ++k) job.numbers[k] = columns[k].data();
  for (size_t c = 0; c < solved.outputs.size(); ++c) {
    job.places[static_cast<size_t>(solved.outputs[c])] = solved.columns[c];
  }
  if (!solved.regimes.empty()) job.regimes = solved.regimes.data();
  if (!solved.inadmissible.empty()) job.inadmissible = solved.inadmissible.data();
  if (tolerance > 0.0) return SolvePlainFirst(job, problems.size(), tolerance);
  SolveCompensated(job, problems.size());
  return problems.size();
}

}  // namespace ricochet::planar

#endif  // HWY_ONCE
