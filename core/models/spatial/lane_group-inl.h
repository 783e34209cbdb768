// LaneGroup: impacts in progress, one in each SIMD lane, that take their steps together.
//
// A step costs far more than all else on a path, and it is the same for every impact: only its numbers differ. Between
// steps each impact goes its own way (Solver::Accept and GoOn). A lane whose impact has ended takes the next problem.
// Steps are those of TakeStep in LaneNumbers, so that each impact has the bits of one that is solved alone.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_LANE_GROUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_LANE_GROUP_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_LANE_GROUP_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_LANE_GROUP_INL_H_
#endif

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "absl/types/span.h"
#include "core/models/spatial/attempts.h"
#include "core/models/spatial/solver-inl.h"
#include "core/models/spatial/step_columns-inl.h"

#if RICOCHET_SIMD
HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// Impacts whose steps are alike: they have as many terms, and each or none of them has to look for turns of v.
struct StepGroup {
  int order;
  bool may_jam;

  bool Has(const Problem& problem) const {
    const double coupling = std::sqrt(problem.w13 * problem.w13 + problem.w23 * problem.w23);
    return HasOrderOf(problem.tolerance) && (problem.mu * coupling >= problem.w33) == may_jam;
  }
  bool HasOrderOf(double tolerance) const { return Solver<double>::OrderFor(tolerance) == order; }
};

class LaneGroup {
 public:
  // Solves those of the problems that belong to `group`.
  LaneGroup(const StepGroup& group, absl::Span<const Problem> problems, absl::Span<Impact> impacts)
      : group_(group), problems_(problems), impacts_(impacts) {}

  void Run() {
    for (size_t lane = 0; lane < kLanes; ++lane) StartNext(lane);
    while (busy_ > 0) {
      step_.Take(group_.order);
      for (size_t lane = 0; lane < kLanes; ++lane) {
        if (solvers_[lane].has_value()) GoOn(lane);
      }
    }
  }

 private:
  // Takes over the steps of a lane since the last call, and what follows up to its next one.
  void GoOn(size_t lane) {
    Solver<double>& solver = *solvers_[lane];
    ++steps_[lane];
    if (!step_.NeedsAttention(lane) && steps_[lane] < solver.StepsLeft()) return;
    solver.Accept(step_.EndOf(lane), std::exchange(steps_[lane], 0));
    const bool goes_on = solver.IsUnderWay() && (!step_.Pauses(lane) || solver.GoOn().has_value());
    if (goes_on) return step_.SetPath(lane, solver);
    --busy_;
    if (!Finish(lane)) StartNext(lane);
  }

  // Gives the lane the next impact that needs steps, if there is one.
  void StartNext(size_t lane) {
    for (; next_ < problems_.size(); ++next_) {
      const Problem& problem = problems_[next_];
      if (!group_.Has(problem)) continue;
      if (problem.v0 >= 0.0) {
        impacts_[next_] = SeparatingImpact(problem);
        continue;
      }
      at_[lane] = next_;
      attempts_[lane].emplace(problem.tolerance, impacts_[next_]);
      if (!Begin(lane, problem.Delassus().Rank())) continue;
      ++next_;
      return;
    }
    solvers_[lane].reset();
    step_.SetIdle(lane);
  }

  // Begins the next attempt at the impact of a lane, and ends it if it needs no steps. Returns true if it needs some.
  bool Begin(size_t lane, int rank) {
    Solver<double>& solver = solvers_[lane].emplace(problems_[at_[lane]], rank, attempts_[lane]->tolerance());
    if (!solver.Start().has_value()) return Finish(lane);
    step_.Set(lane, solver);
    ++busy_;
    return true;
  }

  // Ends an attempt. Returns true if the lane goes on with another one, which it can if that has as many terms.
  bool Finish(size_t lane) {
    Attempts& attempts = *attempts_[lane];
    const int rank = solvers_[lane]->problem().w.rank;
    bool needs_another = attempts.NeedsAnotherAfter(solvers_[lane]->Report());
    while (needs_another) {
      if (group_.HasOrderOf(attempts.tolerance())) return Begin(lane, rank);
      needs_another =
          attempts.NeedsAnotherAfter(Solver<double>(problems_[at_[lane]], rank, attempts.tolerance()).Run());
    }
    return false;
  }

  const StepGroup group_;
  const absl::Span<const Problem> problems_;
  const absl::Span<Impact> impacts_;
  size_t next_ = 0;
  size_t busy_ = 0;
  // The impact of each lane: its place, its attempts, the present one, and its steps that are not taken over yet.
  std::array<size_t, kLanes> at_ = {};
  std::array<std::optional<Attempts>, kLanes> attempts_;
  std::array<std::optional<Solver<double>>, kLanes> solvers_;
  std::array<int64_t, kLanes> steps_ = {};
  StepColumns step_;
};

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // RICOCHET_SIMD

#endif  // per-target include guard
