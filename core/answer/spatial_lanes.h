// SpatialLanes: scenes of any system in space whose impacts are solved together, in SIMD lanes, as batches need them.
//
// A scene is checked and planned by itself. If its plan asks for the spatial model, it is added here, and has its outcome
// once the impacts of all are solved. The outcome has the bits of SolveScene.

#ifndef RICOCHET_CORE_ANSWER_SPATIAL_LANES_H_
#define RICOCHET_CORE_ANSWER_SPATIAL_LANES_H_

#include <cstddef>
#include <vector>

#include "core/contact/scene_contact.h"
#include "core/models/spatial/spatial.h"
#include "core/plan/planned_scene.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

class SpatialLanes {
 public:
  static bool Serves(const PlannedScene& planned) { return planned.choice.model == Model::kSpatial; }

  // Forgets all scenes.
  void Clear();
  // Adds a scene whose plan is served, takes its reduction over, and returns its place.
  size_t Add(const Scene& scene, SceneContact& contact, const PlannedScene& planned);
  void Solve();

  // Sets the numbers of the scene at a place, as SolveScene does with Detail::kNumbers, into an outcome that is empty.
  void SetOutcome(size_t place, Outcome& outcome) const;

 private:
  struct Added {
    SpatialReduction reduction;
    EffectiveCoefficients effective;
    double negligible = 0.0;
  };

  std::vector<Added> added_;
  std::vector<spatial::Problem> problems_;
  std::vector<spatial::Impact> impacts_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_SPATIAL_LANES_H_
