// An impact in progress: its problem, the path so far and the errors on it, and how each phase ends.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_PROGRESS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_PROGRESS_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_PROGRESS_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_PROGRESS_INL_H_
#endif

#include "core/models/spatial/error_ledger-inl.h"
#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/spatial.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

template <typename T>
struct Progress {
  // `rank` is the rank of W.
  Progress(const Problem& its_problem, int rank) : problem(its_problem, rank), path(problem), errors(problem) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // The path has reached the goal of its phase, or of an auxiliary goal, with these slopes.
  void EndPhase(const Slopes<T>& slopes);
  void EndCompression(const Slopes<T>& slopes);
  void EndImpact(const Slopes<T>& slopes);

  const ScaledProblem<T> problem;
  Path<T> path;
  ErrorLedger<T> errors;
  EndErrors<T> end_errors;
};

template <typename T>
void Progress<T>::EndPhase(const Slopes<T>& slopes) {
  if (!path.in_restitution) {
    EndCompression(slopes);
  } else if (path.goal.quantity == Quantity::kImpulse && path.state.v < T{0}) {
    // Poisson's impulse is spent while the bodies still approach: the path goes on until they do not.
    if (!path.IsRounding(path.state.v)) path.RecordReceding(path.state);
    path.goal = {Quantity::kVelocity, T{0}};
  } else {
    EndImpact(slopes);
  }
}

template <typename T>
void Progress<T>::EndCompression(const Slopes<T>& slopes) {
  errors.EndCompression(path, slopes);
  path.StartRestitution();
  if (problem.coefficient == T{0}) EndImpact(slopes);
}

template <typename T>
void Progress<T>::EndImpact(const Slopes<T>& slopes) {
  path.End();
  end_errors = errors.AtEnd(path, slopes);
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
