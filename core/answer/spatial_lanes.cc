#include "core/answer/spatial_lanes.h"

#include <utility>
#include <variant>

#include "absl/types/span.h"
#include "core/answer/model_outcomes.h"
#include "core/answer/scene_outcome.h"
#include "core/models/spatial/columns.h"

namespace ricochet {

void SpatialLanes::Clear() {
  added_.clear();
  problems_.clear();
}

size_t SpatialLanes::Add(const Scene& scene, SceneContact& contact, const PlannedScene& planned) {
  auto& reduction = std::get<SpatialReduction>(contact.reduction);
  problems_.push_back(SpatialProblemOf(scene, reduction, planned));
  added_.push_back({std::move(reduction), planned.effective, planned.choice.negligible});
  return added_.size() - 1;
}

void SpatialLanes::Solve() {
  impacts_.resize(problems_.size());
  spatial::SolveColumns(problems_, absl::MakeSpan(impacts_));
}

void SpatialLanes::SetOutcome(size_t place, Outcome& outcome) const {
  const Added& added = added_[place];
  spatial::MakeOutcome(impacts_[place], added.reduction, {.detail = Detail::kNumbers}, outcome).IgnoreError();
  outcome.effective = added.effective;
  outcome.accuracy.relative_error += added.negligible;
  outcome.plan.model = Model::kSpatial;
}

}  // namespace ricochet
