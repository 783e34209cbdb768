// Crew: impacts in progress, one in each SIMD lane, that take their steps together.
//
// A step costs far more than all else on a path, and it is the same for every impact: only its numbers differ. Between
// steps each impact goes its own way (Solver::Accept and GoOn). A lane whose impact has ended takes the next problem.
// Steps are those of TakeStep in LaneNumbers, so that each impact has the bits of one that is solved alone.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_CREW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_CREW_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_CREW_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_CREW_INL_H_
#endif

#include <array>
#include <cstddef>
#include <optional>

#include "absl/types/span.h"
#include "core/models/spatial/attempts.h"
#include "core/models/spatial/solver-inl.h"
#include "core/models/spatial/step_columns-inl.h"

#if RICOCHET_SIMD
HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

class Crew {
 public:
  // Those of the problems are solved whose series have `order` terms at their tolerance.
  Crew(int order, absl::Span<const Problem> problems, absl::Span<Impact> impacts)
      : order_(order), problems_(problems), impacts_(impacts) {}

  void Run() {
    for (size_t lane = 0; lane < kLanes; ++lane) TakeNext(lane);
    while (busy_ > 0) {
      step_.Take(order_);
      for (size_t lane = 0; lane < kLanes; ++lane) {
        if (solvers_[lane].has_value()) GoOn(lane);
      }
    }
  }

 private:
  // Takes over the step of a lane, and what follows up to its next one.
  void GoOn(size_t lane) {
    Solver<double>& solver = *solvers_[lane];
    solver.Accept(step_.EndOf(lane));
    const bool goes_on = solver.IsUnderWay() && (!step_.Pauses(lane) || solver.GoOn().has_value());
    if (goes_on) return step_.SetPath(lane, solver.path().WayAhead());
    Finish(solver, at_[lane]);
    solvers_[lane].reset();
    --busy_;
    TakeNext(lane);
  }

  // Gives the lane the next impact that needs steps, if there is one.
  void TakeNext(size_t lane) {
    while (next_ < problems_.size()) {
      const size_t i = next_++;
      const Problem& problem = problems_[i];
      if (Solver<double>::OrderFor(problem.tolerance) != order_) continue;
      if (problem.v0 >= 0.0) {
        impacts_[i] = SeparatingImpact(problem);
        continue;
      }
      Solver<double>& solver = solvers_[lane].emplace(problem, problem.Delassus().Rank(), problem.tolerance);
      if (solver.Start().has_value()) {
        at_[lane] = i;
        ++busy_;
        return step_.Set(lane, solver, problem.tolerance);
      }
      Finish(solver, i);
    }
    solvers_[lane].reset();
    step_.Rest(lane);
  }

  // Further attempts are rare, and need other tolerances.
  void Finish(const Solver<double>& solver, size_t i) {
    const Problem& problem = problems_[i];
    Attempts attempts(problem.tolerance);
    bool needs_another = attempts.NeedsAnotherAfter(solver.Report());
    while (needs_another) {
      needs_another =
          attempts.NeedsAnotherAfter(Solver<double>(problem, solver.problem().w.rank, attempts.tolerance()).Run());
    }
    impacts_[i] = attempts.Best();
  }

  const int order_;
  const absl::Span<const Problem> problems_;
  const absl::Span<Impact> impacts_;
  size_t next_ = 0;
  size_t busy_ = 0;
  std::array<std::optional<Solver<double>>, kLanes> solvers_;
  std::array<size_t, kLanes> at_ = {};
  StepColumns step_;
};

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // RICOCHET_SIMD

#endif  // per-target include guard
