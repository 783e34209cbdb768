#include "core/batch/lane_rows.h"

namespace ricochet {

std::unique_ptr<LaneRows> LaneRows::Make(const Scene& scene, const BatchSetup& setup, const Demand& demand) {
  std::unique_ptr<SceneLanes> lanes = SceneLanes::Make(scene, setup.columns, demand);
  if (lanes == nullptr || !lanes->TakesFields()) return nullptr;
  std::unique_ptr<LaneRows> rows(new LaneRows(std::move(lanes)));
  for (size_t k = 0; k < setup.fields.size(); ++k) {
    const std::optional<size_t> number = rows->lanes_->NumberAt(setup.fields[k]);
    if (!number.has_value()) return nullptr;
    rows->column_of_[*number] = k;
  }
  const SceneLanes::Numbers numbers = rows->lanes_->NumbersOf(scene);
  for (size_t n = 0; n < numbers.size(); ++n) rows->base_[n].fill(numbers[n]);
  rows->static_is_kinetic_ = !scene.friction.static_coefficient.has_value();
  rows->places_.resize(setup.columns.size());
  return rows;
}

SceneLanes::Columns LaneRows::ColumnsOf(const BatchRows& rows, size_t first) const {
  SceneLanes::Columns columns;
  for (size_t n = 0; n < column_of_.size(); ++n) {
    columns.varies[n] = column_of_[n].has_value();
    columns.of[n] = columns.varies[n] ? rows.inputs[*column_of_[n]].data() + first : base_[n].data();
  }
  if (static_is_kinetic_) lanes_->TakeStaticFromKinetic(columns);
  return columns;
}

void LaneRows::Solve(const BatchRows& rows, size_t first, size_t count) {
  for (size_t c = 0; c < places_.size(); ++c) places_[c] = rows.outputs[c].data() + first;
  lanes_->Solve(ColumnsOf(rows, first), count, places_, block_);
}

}  // namespace ricochet
