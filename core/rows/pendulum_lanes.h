// PendulumLanes: pendulums over a surface at rest, each by the closed form in SIMD lanes or to first order.

#ifndef RICOCHET_CORE_ROWS_PENDULUM_LANES_H_
#define RICOCHET_CORE_ROWS_PENDULUM_LANES_H_

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "core/models/pendulum/columns.h"
#include "core/models/pendulum/pendulum.h"
#include "core/plan/demand.h"
#include "core/rows/scene_lanes.h"
#include "ricochet/scene.h"

namespace ricochet {

class PendulumLanes : public SceneLanes {
 public:
  // Returns null if the closed form does not give every column.
  static std::unique_ptr<SceneLanes> Make(const Scene& scene, absl::Span<const std::string> columns,
                                          const Demand& demand);

  // Coefficients that depend on the speed are no fields.
  bool TakesFields() const override { return takes_fields_; }
  Numbers NumbersOf(const Scene& scene) const override;
  void Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) override;

 private:
  static constexpr size_t kNumberCount = pendulum::ProblemColumns::kNumbers;

  PendulumLanes(const Scene& scene, const Demand& demand);
  bool SetColumns(absl::Span<const std::string> paths);
  void SetProblems(const Columns& columns, size_t count);
  Model Plan(size_t i);
  bool PlanAll(size_t count, Block& block);
  bool SolveByClosedForm(size_t first, size_t count, Block& block);
  void SolveToFirstOrder(size_t first, size_t count, Block& block) const;
  bool SolveRuns(size_t count, Block& block);

  const Demand demand_;
  const bool takes_fields_;
  pendulum::ProblemColumns problems_;
  std::array<std::optional<double>, kNumberCount> held_;  // The number that all problems have, where that is known.

  std::vector<pendulum::Output> outputs_;         // The kernel computes these, each once.
  std::vector<std::optional<size_t>> column_of_;  // The column of each output; unset for an output that is no column.
  std::vector<double*> places_;                   // The places of the outputs in the current block.
  std::optional<size_t> dissipation_;             // The column of minus the work of friction.
  std::optional<size_t> spring_;                  // The column of the tangential spring energy, which is 0 here.
  size_t friction_ = 0;                           // Which output the work of friction is, if it is needed.
  std::array<double, kBlock> friction_work_;      // Its place if it is no column.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_PENDULUM_LANES_H_
