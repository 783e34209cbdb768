#include "core/rows/spatial_lanes.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "absl/types/span.h"
#include "core/answer/model_outcomes.h"
#include "core/models/spatial/columns.h"
#include "core/plan/needs_spatial.h"
#include "core/plan/scene_problem.h"

namespace ricochet {

void SpatialLanes::Clear() {
  added_.clear();
  problems_.clear();
}

size_t SpatialLanes::Add(const spatial::Problem& problem, double negligible, SceneContact& contact) {
  problems_.push_back(problem);
  added_.push_back({std::move(std::get<SpatialReduction>(contact.reduction)), contact.coefficients, negligible});
  return added_.size() - 1;
}

std::optional<size_t> SpatialLanes::Add(const Scene& scene, const Demand& demand,
                                        std::optional<SceneContact>& contact) {
  if (!contact.has_value() || !demand.IsToleranceAlone()) return std::nullopt;
  const auto* reduction = std::get_if<SpatialReduction>(&contact->reduction);
  if (reduction == nullptr || !FitsDoubles(contact->reduction)) return std::nullopt;
  const double tolerance = std::clamp(demand.relative_tolerance, spatial::kLeastTolerance, spatial::kMostTolerance);
  const spatial::Problem problem =
      spatial::MakeProblem(*reduction, scene.restitution, contact->coefficients, tolerance);
  if (!NeedsSpatial(problem, demand.relative_tolerance)) return std::nullopt;
  return Add(problem, 0.0, *contact);
}

std::optional<size_t> SpatialLanes::Add(const PlannedScene& planned, std::optional<SceneContact>& contact) {
  if (planned.choice.model != Model::kSpatial) return std::nullopt;
  return Add(std::get<spatial::Problem>(planned.problem), planned.choice.negligible, *contact);
}

void SpatialLanes::Solve() {
  if (problems_.empty()) return;
  impacts_.resize(problems_.size());
  spatial::SolveColumns(problems_, absl::MakeSpan(impacts_));
}

void SpatialLanes::SetOutcome(size_t place, Outcome& outcome) const {
  const Added& added = added_[place];
  spatial::MakeOutcome(impacts_[place], added.reduction, {.numbers_only = true}, outcome).IgnoreError();
  outcome.effective = added.effective;
  AddNeglected(added.negligible, spatial::ApproachOf(problems_[place]), outcome);
  outcome.plan.model = Model::kSpatial;
}

}  // namespace ricochet
