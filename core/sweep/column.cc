#include "core/sweep/column.h"

#include <set>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/answer/model_outcomes.h"
#include "core/contact/reduction.h"
#include "core/scene/field.h"
#include "core/scene/nearest.h"
#include "ricochet/outcome_numbers.h"

namespace ricochet {
namespace {

// Shape is the length of the lists that an outcome of the system has.
struct Shape {
  size_t rates = 0;
  size_t bodies = 0;
};

Shape ShapeOf(std::monostate /*unset*/) { return {}; }
Shape ShapeOf(const Pendulum& /*pendulum*/) { return {.rates = 1}; }
Shape ShapeOf(const PlanarBody& /*body*/) { return {.bodies = 1}; }
Shape ShapeOf(const SpatialBody& /*body*/) { return {.bodies = 1}; }
Shape ShapeOf(const BodyPair& /*pair*/) { return {.bodies = 2}; }
Shape ShapeOf(const Linkage& linkage) { return {.rates = linkage.links.size()}; }
Shape ShapeOf(const PlanarContact& /*contact*/) { return {}; }
Shape ShapeOf(const SpatialContact& /*contact*/) { return {}; }

}  // namespace

std::vector<std::string> Columns(const Scene& scene) {
  const Shape shape = std::visit([](const auto& system) { return ShapeOf(system); }, scene.system);
  const size_t tangential = TangentialDirections(scene.system);
  Outcome outcome;
  outcome.rates_after_rad_s.resize(shape.rates);
  outcome.bodies_after.resize(shape.bodies);
  for (BodyVelocity& body : outcome.bodies_after) {
    body.linear_m_s.resize(tangential + 1);
    body.angular_rad_s.resize(tangential == 1 ? 1 : 3);
  }
  outcome.contact_velocity_after.tangential_m_s.resize(tangential);
  outcome.impulse.tangential_n_s.resize(tangential);
  if (!std::holds_alternative<std::monostate>(scene.impact_law)) UnsetPhases(outcome);
  std::vector<std::string> columns;
  VisitOutcomeNumbers(outcome, [&](const NumberPath& path, double /*number*/) { columns.push_back(path.Text()); });
  return columns;
}

ColumnPositions PositionsOf(const std::vector<std::string>& columns) {
  ColumnPositions positions;
  for (size_t i = 0; i < columns.size(); ++i) positions.emplace(columns[i], i);
  return positions;
}

std::vector<Violation> CheckColumns(const std::vector<std::string>& columns, const std::vector<std::string>& all,
                                    const ColumnPositions& known) {
  std::vector<Violation> violations;
  if (columns.empty()) violations.push_back({"columns", "is empty: must name at least one"});
  std::set<std::string> seen;
  for (size_t i = 0; i < columns.size() && !IsFull(violations); ++i) {
    const auto refuse = [&](const std::string& rule) {
      violations.push_back({absl::StrCat("columns[", i, "]"), absl::StrCat(Found(columns[i]), ": must be ", rule)});
    };
    if (!known.contains(columns[i])) {
      refuse(
          absl::StrCat("a column of the scene; `ricochet sweep --column '?'` lists them", DidYouMean(columns[i], all)));
    } else if (!seen.insert(columns[i]).second) {
      refuse("named once");
    }
  }
  return violations;
}

void ReadColumns(const Outcome& outcome, std::vector<double>& numbers) {
  numbers.clear();
  VisitOutcomeNumbers(outcome, [&](const NumberPath& /*path*/, double number) { numbers.push_back(number); });
}

}  // namespace ricochet
