#include "core/models/pendulum.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <variant>

#include "core/models/pendulum_kernel.h"
#include "core/numerics/double_double.h"
#include "core/numerics/wide.h"

namespace ricochet::pendulum {
namespace {

constexpr int64_t kBlock = 64;  // Solutions of a block stay in the first-level cache.

// Zero or of moderate size.
bool Moderate(double value, double limit) {
  const double size = std::fabs(value);
  return size == 0.0 || (size >= 1.0 / limit && size <= limit);
}

// Whether no product of the kernel can leave the range in which DoubleDouble is exact: the largest is below 2^700, the
// smallest above 2^-890, its low half 2^-106 of that.
bool FitsDoubleDouble(const Problem& problem) {
  constexpr double kLimit = 0x1p100;
  constexpr double kCoefficientLimit = 0x1p40;
  return Moderate(problem.inertia, kLimit) && Moderate(problem.a, kLimit) && Moderate(problem.b, kLimit) &&
         Moderate(problem.omega_minus, kLimit) && Moderate(problem.mu, kLimit) && Moderate(problem.mu_static, kLimit) &&
         Moderate(problem.coefficient, kCoefficientLimit);
}

bool Separating(const Problem& problem) { return problem.omega_minus >= 0.0; }

// A contact that does not approach: velocities as before, all else 0.
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

unsigned PartsOf(absl::Span<const Output> outputs) {
  unsigned parts = 0;
  for (const Output output : outputs) parts |= PartsOf(output);
  return parts;
}

// Adding 0 turns -0 into 0: an impulse or velocity that vanishes has no sign.
RICOCHET_INLINE double Unsigned0(double value) { return value + 0.0; }

// What a block of problems writes to, and which outputs.
struct Target {
  absl::Span<const Output> outputs;
  absl::Span<double* const> columns;
  absl::Span<Regime> regimes;
  absl::Span<bool> inadmissible;
};

template <typename N>
RICOCHET_INLINE void SolveBlock(absl::Span<const Problem> problems, int64_t first, unsigned parts,
                                const Target& target) {
  assert(static_cast<int64_t>(problems.size()) <= kBlock);
  std::array<Solution<N>, kBlock> solutions;
  for (size_t i = 0; i < problems.size(); ++i) {
    const size_t point = static_cast<size_t>(first) + i;
    SolveParts<N>(problems[i], parts, solutions[i]);
    target.regimes[point] = solutions[i].regime;
    target.inadmissible[point] = Sign(solutions[i].one_minus_eta_squared) < 0;
  }
  for (size_t c = 0; c < target.outputs.size(); ++c) {
    double* const column = target.columns[c] + first;
    const Output output = target.outputs[c];
    for (size_t i = 0; i < problems.size(); ++i) {
      column[i] = Unsigned0(Evaluate(solutions[i], output));
    }
  }
}

// The same code for machines with a hardware fma and without; the bits are the same.
[[gnu::target("avx2,fma")]] void SolveBlockFma(absl::Span<const Problem> problems, int64_t first, unsigned parts,
                                               const Target& target) {
  SolveBlock<DoubleDouble>(problems, first, parts, target);
}

void SolveBlockPortable(absl::Span<const Problem> problems, int64_t first, unsigned parts, const Target& target) {
  SolveBlock<DoubleDouble>(problems, first, parts, target);
}

void SolveModerateBlock(absl::Span<const Problem> problems, int64_t first, unsigned parts, const Target& target) {
  static const bool has_fma = __builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2");
  (has_fma ? SolveBlockFma : SolveBlockPortable)(problems, first, parts, target);
}

void SolveSeparating(const Problem& problem, int64_t i, const Target& target) {
  target.regimes[static_cast<size_t>(i)] = Regime::kSeparating;
  target.inadmissible[static_cast<size_t>(i)] = false;
  for (size_t c = 0; c < target.outputs.size(); ++c) {
    target.columns[c][i] = SeparatingOutput(problem, target.outputs[c]);
  }
}

template <typename N>
RICOCHET_INLINE Impact SolveOne(const Problem& problem) {
  Solution<N> solution;
  SolveParts<N>(problem, kPartAll, solution);
  Impact impact;
  impact.regime = solution.regime;
  impact.sharp_limit_broken = Sign(solution.one_minus_eta_squared) < 0;
  impact.energy_limit_broken = solution.energy_limit_broken;
  for (int i = 0; i < kOutputCount; ++i) {
    impact.values[static_cast<size_t>(i)] = Unsigned0(Evaluate(solution, static_cast<Output>(i)));
  }
  return impact;
}

[[gnu::target("avx2,fma")]] Impact SolveOneFma(const Problem& problem) { return SolveOne<DoubleDouble>(problem); }
Impact SolveOnePortable(const Problem& problem) { return SolveOne<DoubleDouble>(problem); }

Impact SolveOneSeparating(const Problem& problem) {
  Impact impact;
  impact.regime = Regime::kSeparating;
  for (int i = 0; i < kOutputCount; ++i) {
    impact.values[static_cast<size_t>(i)] = SeparatingOutput(problem, static_cast<Output>(i));
  }
  return impact;
}

}  // namespace

Problem MakeProblem(const Scene& scene) {
  const auto& pendulum = std::get<Pendulum>(scene.system);
  Problem problem = {.inertia = pendulum.inertia_kg_m2,
                     .a = pendulum.a_m,
                     .b = pendulum.b_m,
                     .omega_minus = pendulum.omega_minus_rad_s,
                     .mu = scene.friction.kinetic_coefficient,
                     .mu_static = scene.friction.static_coefficient.value_or(scene.friction.kinetic_coefficient)};
  if (const auto* newton = std::get_if<NewtonCoefficient>(&scene.restitution)) {
    problem.law = Law::kNewton;
    problem.coefficient = newton->value;
  } else if (const auto* poisson = std::get_if<PoissonCoefficient>(&scene.restitution)) {
    problem.law = Law::kPoisson;
    problem.coefficient = poisson->value;
  } else if (const auto* energetic = std::get_if<EnergeticCoefficient>(&scene.restitution)) {
    problem.law = Law::kEnergetic;
    problem.coefficient = energetic->value;
  }
  return problem;
}

Impact Solve(const Problem& problem) {
  if (Separating(problem)) return SolveOneSeparating(problem);
  if (!FitsDoubleDouble(problem)) return SolveOne<Wide>(problem);
  static const bool has_fma = __builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2");
  return has_fma ? SolveOneFma(problem) : SolveOnePortable(problem);
}

void SolveColumns(absl::Span<const Problem> problems, absl::Span<const Output> outputs,
                  absl::Span<double* const> columns, absl::Span<Regime> regimes, absl::Span<bool> inadmissible) {
  assert(outputs.size() == columns.size());
  const Target target = {outputs, columns, regimes, inadmissible};
  const unsigned parts = PartsOf(outputs);
  const auto count = static_cast<int64_t>(problems.size());
  for (int64_t first = 0; first < count;) {
    const Problem& problem = problems[static_cast<size_t>(first)];
    int64_t run = 1;
    if (Separating(problem)) {
      SolveSeparating(problem, first, target);
    } else if (!FitsDoubleDouble(problem)) {
      SolveBlock<Wide>(problems.subspan(static_cast<size_t>(first), 1), first, parts, target);
    } else {
      const auto moderate = [&](int64_t i) {
        const Problem& next = problems[static_cast<size_t>(i)];
        return !Separating(next) && FitsDoubleDouble(next);
      };
      while (run < kBlock && first + run < count && moderate(first + run)) ++run;
      SolveModerateBlock(problems.subspan(static_cast<size_t>(first), static_cast<size_t>(run)), first, parts, target);
    }
    first += run;
  }
}

Instant At(const Problem& problem, double tau) {
  Solution<Wide> x;
  SolveGeometry(problem, x);
  const Wide momentum = x.inertia * x.omega;
  const Wide impulse(tau);
  // J w(tau) of compression; from compression's end on, the slope is d instead of s.
  const Wide compression = momentum + x.s * impulse;
  if (Sign(compression) <= 0) {
    return {Unsigned0(ToDouble(compression / x.inertia)), Unsigned0(ToDouble(x.mu * impulse))};
  }
  const Wide two(2.0);
  return {Unsigned0(ToDouble(x.d / x.s * compression / x.inertia)),
          Unsigned0(ToDouble(-x.mu * (two * momentum + x.s * impulse) / x.s))};
}

}  // namespace ricochet::pendulum
