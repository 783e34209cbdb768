// SpatialLanes: scenes of any system in space whose impacts are solved together, in SIMD lanes, as batches need them.
//
// A scene is checked and planned by itself. If its plan asks for the spatial model, it is added here, and has its
// outcome once the impacts of all are solved. The outcome has the bits of SolveScene.

#ifndef RICOCHET_CORE_ROWS_SPATIAL_LANES_H_
#define RICOCHET_CORE_ROWS_SPATIAL_LANES_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "core/contact/scene_contact.h"
#include "core/models/spatial/spatial.h"
#include "core/plan/demand.h"
#include "core/plan/planned_scene.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

class SpatialLanes {
 public:
  // Forgets all scenes.
  void Clear();
  // Adds a scene if the spatial model is to solve it, takes the reduction of its contact over, and returns its place.
  // The first form decides without a plan where it can. If it returns nothing, the second form decides by a plan.
  std::optional<size_t> Add(const Scene& scene, const Demand& demand, std::optional<SceneContact>& contact);
  std::optional<size_t> Add(const PlannedScene& planned, std::optional<SceneContact>& contact);
  void Solve();

  // Sets the numbers of the scene at a place, as SolveScene does with numbers_only, into an outcome that is empty.
  void SetOutcome(size_t place, Outcome& outcome) const;

 private:
  struct Added {
    SpatialReduction reduction;
    EffectiveCoefficients effective;
    double negligible = 0.0;
  };

  size_t Add(const spatial::Problem& problem, double negligible, SceneContact& contact);

  std::vector<Added> added_;
  std::vector<spatial::Problem> problems_;
  std::vector<spatial::Impact> impacts_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_SPATIAL_LANES_H_
