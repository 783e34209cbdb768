#include "core/batch/planar_rows.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace ricochet {
namespace {

// In the order of PlanarLanes::Number, but for the coefficient of restitution, whose path depends on the law.
constexpr const char* kPaths[] = {"planar_contact.w_tt_per_kg", "planar_contact.w_tn_per_kg",
                                  "planar_contact.w_nn_per_kg", "planar_contact.tangential_m_s",
                                  "planar_contact.normal_m_s",  "friction.kinetic_coefficient",
                                  "friction.static_coefficient"};

size_t NumberAt(const std::string& path) {
  const auto* const found = std::find(std::begin(kPaths), std::end(kPaths), path);
  return static_cast<size_t>(found - std::begin(kPaths));
}

}  // namespace

std::optional<PlanarRows> PlanarRows::Make(const Scene& scene, const BatchSetup& setup, const Demand& demand) {
  std::optional<std::vector<PlanarOutput>> outputs = PlanarLanes::OutputsOf(scene, setup.columns, demand);
  if (!outputs.has_value()) return std::nullopt;
  PlanarRows rows(PlanarLanes(scene, *std::move(outputs), demand.relative_tolerance));
  const PlanarLanes::Numbers numbers = PlanarLanes::NumbersOf(scene);
  for (size_t n = 0; n < numbers.size(); ++n) rows.base_[n].fill(numbers[n]);
  rows.static_is_kinetic_ = !scene.friction.static_coefficient.has_value();
  for (size_t k = 0; k < setup.fields.size(); ++k) rows.column_of_[NumberAt(setup.fields[k])] = k;
  rows.places_.resize(setup.columns.size());
  return rows;
}

PlanarLanes::Columns PlanarRows::ColumnsOf(const BatchRows& rows, size_t first) const {
  PlanarLanes::Columns columns;
  for (size_t n = 0; n < column_of_.size(); ++n) {
    columns.varies[n] = column_of_[n].has_value();
    columns.of[n] = columns.varies[n] ? rows.inputs[*column_of_[n]].data() + first : base_[n].data();
  }
  if (static_is_kinetic_ && !columns.varies[PlanarLanes::kMuStatic]) {
    columns.of[PlanarLanes::kMuStatic] = columns.of[PlanarLanes::kMu];
  }
  return columns;
}

bool PlanarRows::Solve(const BatchRows& rows, size_t first, size_t count, Block& block) {
  for (size_t c = 0; c < places_.size(); ++c) places_[c] = rows.outputs[c].data() + first;
  lanes_.Solve(ColumnsOf(rows, first), count, places_, block);
  return lanes_.HasAllNumbers(count, places_, block);
}

}  // namespace ricochet
