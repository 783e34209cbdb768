// CostStudy: what accuracy costs for one scene, method by method (ricochet/cost.h).
//
// core/cost/cost_methods.h lists the methods, core/cost/reference_velocity.h their references, core/cost/stopwatch.h
// says how they are timed, core/cost/cost_summary.h how the front and the picks are found. A method has an equal share
// of the time that is left, one half for single solves and one for a batch, which is left out if it takes more than 2 %
// of the limit. Its first answer may take a quarter of the time left, so that a slow method does not take that of all
// others.

#ifndef RICOCHET_CORE_COST_COST_H_
#define RICOCHET_CORE_COST_COST_H_

#include <memory>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/cost.h"

namespace ricochet {

class CostStudy {
 public:
  // Errors: INVALID_ARGUMENT with every violation of the scene and the options; ContactOverflow.
  static absl::StatusOr<CostStudy> Make(const CostRequest& request);

  CostStudy(CostStudy&&) noexcept;
  CostStudy& operator=(CostStudy&&) noexcept;
  ~CostStudy();

  bool ended() const;  // True once the last part has been made.

  // Makes the next part: first one without rows, then one for each method; the last one has the summary. The engine is
  // left to the caller. Not to be called once the study has ended. Only the time spent in here counts.
  // `stopped` is asked before each sample of a time, and between the steps of an impact in time: at least every few
  // milliseconds, but for an impact with tangential compliance of very many sections.
  // Errors: CANCELLED once `stopped` returns true; the study must not be used any more.
  absl::StatusOr<CostChunk> NextChunk(absl::FunctionRef<bool()> stopped);

 private:
  class Impl;
  explicit CostStudy(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_COST_COST_H_
