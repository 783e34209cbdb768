// PlanarLanes: planar contacts that are rigid, with a W of full rank, each by its model in SIMD lanes.

#ifndef RICOCHET_CORE_ROWS_PLANAR_LANES_H_
#define RICOCHET_CORE_ROWS_PLANAR_LANES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "core/models/planar_outputs.h"
#include "core/plan/demand.h"
#include "core/rows/scene_lanes.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {

class PlanarLanes : public SceneLanes {
 public:
  // The numbers of a contact, in the order of their columns (SceneLanes::Numbers).
  enum Number { kWtt, kWtn, kWnn, kU0, kV0, kMu, kMuStatic, kCoefficient, kNumberCount };

  // Returns null if the planar models do not give every column, or if the demand is more than a tolerance.
  static std::unique_ptr<SceneLanes> Make(const Scene& scene, absl::Span<const std::string> columns,
                                          const Demand& demand);

  void Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) override;

 private:
  using Column = std::array<double, kBlock>;

  // The law of restitution is that of the scene.
  PlanarLanes(const Scene& scene, std::vector<PlanarOutput> outputs, double tolerance);

  PlanarProblemColumns ProblemsIn(const Columns& columns, size_t count) const;
  void SolveBy(Model model, const Columns& columns, size_t count, const PlanarSolvedColumns& solved) const;
  Columns Gather(const Columns& columns, absl::Span<const uint16_t> some);
  void SolveTogether(const Columns& columns, absl::Span<const uint16_t> some, size_t count, Model model,
                     absl::Span<double* const> places, Block& block);
  void Separate(const Columns& columns, size_t i, absl::Span<double* const> places, Block& block) const;
  Model ModelAlone(const PlanarProblem& problem) const;

  RestitutionLaw law_;
  double tolerance_;
  std::vector<PlanarOutput> outputs_;

  // Contacts of the block that one model solves: their numbers and outputs.
  std::array<Column, kNumberCount> gathered_;
  std::vector<Column> answers_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_PLANAR_LANES_H_
