// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/sliding/columns.cc"
#include "core/models/sliding/columns.h"

#include <algorithm>
#include <array>
#include <cassert>

// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/planar_outputs-inl.h"
#include "core/numerics/lanes-inl.h"
// clang-format on

#ifndef RICOCHET_CORE_MODELS_SLIDING_COLUMNS_CC_
#define RICOCHET_CORE_MODELS_SLIDING_COLUMNS_CC_
namespace ricochet::sliding {

// No vector has more lanes.
inline constexpr size_t kMostLanes = 64;

// The problems of a call, and the places of their results.
struct Job {
  const PlanarProblemColumns& problems;
  std::array<double*, kPlanarOutputCount> places = {};  // Null for an output that is not wanted.
  bool* inadmissible = nullptr;                         // Null if it is not wanted.
};

}  // namespace ricochet::sliding
#endif  // RICOCHET_CORE_MODELS_SLIDING_COLUMNS_CC_

HWY_BEFORE_NAMESPACE();
namespace ricochet::sliding::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::Both;
using ricochet::HWY_NAMESPACE::CopySign;
using ricochet::HWY_NAMESPACE::Fma;
using ricochet::HWY_NAMESPACE::Lanes;
using ricochet::HWY_NAMESPACE::Select;

// The target's widest lanes.
using Widest = ricochet::HWY_NAMESPACE::Vector;

// The names are those of ImpactEnd.
template <typename V>
struct Answer {
  V newton, poisson, energetic, tangential;
  V u1, v1, tau_compression, tau1, f1;
  V work_normal_compression, work_normal_restitution;
  V work_tangential_compression, work_tangential_restitution;
  V energy_change;
};

// Sets what does not depend on the friction impulse, operation by operation as core/models/sliding/sliding.cc does.
template <typename V>
HWY_INLINE Answer<V> MakeAnswer(const PlanarProblemColumns& problems, size_t i, V u_slope, V v_slope) {
  const V zero = Lanes<V>::Fill(0.0);
  const V half = Lanes<V>::Fill(0.5);
  const V v0 = Lanes<V>::Load(&problems.v0[i]);
  const V c = Lanes<V>::Load(&problems.coefficient[i]);
  const V speed = zero - v0;
  Answer<V> x;
  x.newton = x.poisson = x.energetic = c;
  x.tau_compression = speed / v_slope;
  x.tau1 = Fma(c, x.tau_compression, x.tau_compression);
  x.u1 = Fma(u_slope, x.tau1, Lanes<V>::Load(&problems.u0[i])) + zero;
  x.v1 = c * speed;
  x.work_normal_compression = half * x.tau_compression * v0;
  x.work_normal_restitution = zero - c * c * x.work_normal_compression;
  x.energy_change = half * x.tau1 * ((Lanes<V>::Fill(1.0) - c) * v0) + zero;
  x.tangential = x.f1 = x.work_tangential_compression = x.work_tangential_restitution = zero;
  return x;
}

template <typename V>
HWY_INLINE void Store(const Job& job, size_t i, const Answer<V>& answer) {
  const V zero = Lanes<V>::Fill(0.0);
  ricochet::HWY_NAMESPACE::ForEachOutput(answer, zero, zero, [&](PlanarOutput output, V value) HWY_ATTR {
    double* const place = job.places[static_cast<size_t>(output)];
    if (place != nullptr) Lanes<V>::Store(value, place + i);
  });
}

// Solves the problem at i, or those from i on that fill a vector.
template <typename V>
HWY_INLINE void SolveSliding(const Job& job, size_t i) {
  const PlanarProblemColumns& problems = job.problems;
  const V zero = Lanes<V>::Fill(0.0);
  const V half = Lanes<V>::Fill(0.5);
  const V u0 = Lanes<V>::Load(&problems.u0[i]);
  const V wtn = Lanes<V>::Load(&problems.wtn[i]);
  const V f = CopySign(Lanes<V>::Load(&problems.mu[i]), zero - u0);
  const V u_slope = Fma(f, Lanes<V>::Load(&problems.wtt[i]), wtn);
  const V v_slope = Fma(f, wtn, Lanes<V>::Load(&problems.wnn[i]));
  Answer<V> x = MakeAnswer(problems, i, u_slope, v_slope);
  const V u_middle = Fma(u_slope, x.tau_compression, u0) + zero;
  const V f_compression = f * x.tau_compression;
  const V f_restitution = Lanes<V>::Load(&problems.coefficient[i]) * f_compression;
  x.f1 = f * x.tau1;
  x.tangential = f;
  x.work_tangential_compression = half * (f_compression * (u0 + u_middle)) + zero;
  x.work_tangential_restitution = half * (f_restitution * (u_middle + x.u1)) + zero;
  x.energy_change = x.energy_change + half * (x.f1 * (u0 + x.u1));
  Store(job, i, x);
  if (job.inadmissible == nullptr) return;
  const V friction_gives = x.work_tangential_compression + x.work_tangential_restitution;
  const auto breaks_limit = Both(zero < friction_gives, zero < x.energy_change);
  std::array<double, kMostLanes> broken;
  Lanes<V>::Store(Select(breaks_limit, Lanes<V>::Fill(1.0), zero), broken.data());
  for (size_t lane = 0; lane < Lanes<V>::Count(); ++lane) job.inadmissible[i + lane] = broken[lane] != 0.0;
}

template <typename V>
HWY_INLINE void SolveSmooth(const Job& job, size_t i) {
  const PlanarProblemColumns& problems = job.problems;
  Store(job, i, MakeAnswer(problems, i, Lanes<V>::Load(&problems.wtn[i]), Lanes<V>::Load(&problems.wnn[i])));
}

void SolveAllSliding(const Job& job) {
  const size_t count = job.problems.size();
  size_t i = 0;
  for (; i + Lanes<Widest>::Count() <= count; i += Lanes<Widest>::Count()) SolveSliding<Widest>(job, i);
  for (; i < count; ++i) SolveSliding<double>(job, i);
}

void SolveAllSmooth(const Job& job) {
  const size_t count = job.problems.size();
  size_t i = 0;
  for (; i + Lanes<Widest>::Count() <= count; i += Lanes<Widest>::Count()) SolveSmooth<Widest>(job, i);
  for (; i < count; ++i) SolveSmooth<double>(job, i);
}

}  // namespace ricochet::sliding::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet::sliding {

HWY_EXPORT(SolveAllSliding);
HWY_EXPORT(SolveAllSmooth);

namespace {

Job MakeJob(const PlanarProblemColumns& problems, const PlanarSolvedColumns& solved, Regime regime) {
  assert(solved.outputs.size() == solved.columns.size());
  Job job = {.problems = problems};
  for (size_t c = 0; c < solved.outputs.size(); ++c) {
    assert(solved.outputs[c] != PlanarOutput::kRelativeError);
    job.places[static_cast<size_t>(solved.outputs[c])] = solved.columns[c];
  }
  if (!solved.inadmissible.empty()) job.inadmissible = solved.inadmissible.data();
  std::fill(solved.regimes.begin(), solved.regimes.end(), regime);
  return job;
}

}  // namespace

void SolveColumns(const PlanarProblemColumns& problems, const PlanarSolvedColumns& solved) {
  HWY_DYNAMIC_DISPATCH(SolveAllSliding)(MakeJob(problems, solved, Regime::kSliding));
}

void SolveFrictionlessColumns(const PlanarProblemColumns& problems, const PlanarSolvedColumns& solved) {
  std::fill(solved.inadmissible.begin(), solved.inadmissible.end(), false);
  HWY_DYNAMIC_DISPATCH(SolveAllSmooth)(MakeJob(problems, solved, Regime::kFrictionless));
}

}  // namespace ricochet::sliding

#endif  // HWY_ONCE
