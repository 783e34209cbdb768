// Columns: many pendulums of one law at once, in SIMD lanes, and only the outputs asked for.
//
// Each output is that of the first arithmetic whose bound on its rounding error is within the tolerance: plain double
// arithmetic (SolvePlain), or double-double arithmetic (Solve), with the same bits. At tolerance 0 it is the latter.
// A block of problems is solved plainly; those whose bound or signs are not proved are solved once more. No result
// depends on the neighbours of a problem.

#ifndef RICOCHET_CORE_MODELS_PENDULUM_COLUMNS_H_
#define RICOCHET_CORE_MODELS_PENDULUM_COLUMNS_H_

#include <array>
#include <cstddef>

#include "absl/types/span.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "hwy/aligned_allocator.h"

namespace ricochet::pendulum {

// Problems of one law, column by column, as lanes read them.
class ProblemColumns {
 public:
  ProblemColumns() = default;
  // Until they are set, the problems separate.
  ProblemColumns(RestitutionLaw law, size_t size);

  // The problem's law must be that of all.
  void Set(size_t i, const Problem& problem);
  Problem operator[](size_t i) const;

  size_t size() const { return size_; }
  RestitutionLaw law() const { return law_; }

  // The columns may be read for kMostLanes entries beyond the last problem, because vectors are loaded whole.
  static constexpr size_t kMostLanes = 64;
  const double* inertia() const { return numbers_[0].get(); }
  const double* a() const { return numbers_[1].get(); }
  const double* b() const { return numbers_[2].get(); }
  const double* omega_minus() const { return numbers_[3].get(); }
  const double* mu() const { return numbers_[4].get(); }
  const double* mu_static() const { return numbers_[5].get(); }
  const double* coefficient() const { return numbers_[6].get(); }

  // The n-th of the columns above.
  static constexpr size_t kNumbers = 7;
  double* numbers(size_t n) { return numbers_[n].get(); }
  const double* numbers(size_t n) const { return numbers_[n].get(); }

 private:
  RestitutionLaw law_ = RestitutionLaw::kEnergetic;
  size_t size_ = 0;
  // Each begins a cache line, because a load that crosses two lines takes twice as long.
  std::array<hwy::AlignedFreeUniquePtr<double[]>, kNumbers> numbers_;
};

// The outputs asked for, each at most once, and the places of the results. `columns[c][i]` receives output `outputs[c]`
// of the i-th problem solved, `regimes[i]` its regime, and `inadmissible[i]` whether it breaks a limit.
struct SolvedColumns {
  absl::Span<const Output> outputs;
  absl::Span<double* const> columns;
  absl::Span<Regime> regimes;
  absl::Span<bool> inadmissible;
};

// Solves the problems [first, first + count). The tolerance is in [0, 1) and means what PlainImpact::relative_error
// does. Returns true if plain arithmetic has shown that all of them rebound, keep all limits and have finite outputs,
// as in most blocks of a sweep. Otherwise nothing is known.
bool SolveColumns(const ProblemColumns& problems, size_t first, size_t count, double tolerance,
                  const SolvedColumns& solved);

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_MODELS_PENDULUM_COLUMNS_H_
