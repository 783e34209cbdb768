#include "core/rows/column.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/answer/outcome_parts.h"
#include "core/base/derivative_name.h"
#include "core/base/nearest.h"
#include "core/plan/number_demand.h"
#include "core/rows/derivative_columns.h"
#include "core/scene/check.h"
#include "core/scene/field.h"
#include "ricochet/outcome_numbers.h"

namespace ricochet {
namespace {

// Shape holds the lengths of the lists of an outcome of the system.
struct Shape {
  size_t rates = 0;
  size_t bodies = 0;
  size_t coordinates = 0;
};

Shape ShapeOf(std::monostate /*unset*/) { return {}; }
Shape ShapeOf(const Pendulum& /*pendulum*/) { return {.rates = 1}; }
Shape ShapeOf(const PlanarBody& /*body*/) { return {.bodies = 1}; }
Shape ShapeOf(const SpatialBody& /*body*/) { return {.bodies = 1}; }
Shape ShapeOf(const BodyPair& /*pair*/) { return {.bodies = 2}; }
Shape ShapeOf(const Linkage& linkage) { return {.rates = linkage.links.size()}; }
Shape ShapeOf(const PlanarContact& /*contact*/) { return {}; }
Shape ShapeOf(const SpatialContact& /*contact*/) { return {}; }
Shape ShapeOf(const Mechanism& mechanism) { return {.coordinates = mechanism.rates.size()}; }

// An outcome in which every number is set that an outcome of the scene may have.
Outcome WithEveryNumber(const Scene& scene) {
  const Shape shape = std::visit([](const auto& system) { return ShapeOf(system); }, scene.system);
  const size_t tangential = TangentialDirections(scene.system);
  Outcome outcome;
  outcome.rates_after_rad_s.resize(shape.rates);
  for (Components* const list :
       {&outcome.rates_after, &outcome.momentum_change, &outcome.errors.rates_after, &outcome.errors.momentum_change}) {
    list->resize(shape.coordinates);
  }
  outcome.bodies_after.resize(shape.bodies);
  for (BodyVelocity& body : outcome.bodies_after) {
    body.linear_m_s.resize(tangential + 1);
    body.angular_rad_s.resize(tangential == 1 ? 1 : 3);
  }
  outcome.contact_velocity_after.tangential_m_s.resize(tangential);
  outcome.impulse.tangential_n_s.resize(tangential);
  if (!HasDamping(scene)) outcome.effective.restitution = 0.0;
  const bool is_by_law = !std::holds_alternative<std::monostate>(scene.impact_law);
  VisitOutcomePart(outcome.errors, [is_by_law](const char* /*name*/, auto& error) {
    if constexpr (std::is_same_v<decltype(error), std::optional<double>&>) {
      if (!is_by_law) error = 0.0;
    }
  });
  if (is_by_law) UnsetPhases(outcome);
  outcome.contact.emplace();
  if (HoldsCoordinates(scene.system)) {
    outcome.free_end = FreeEnd{.rates_after = outcome.rates_after,
                               .contact_velocity_after = outcome.contact_velocity_after,
                               .impulse = outcome.impulse,
                               .errors = outcome.errors};
  }
  return outcome;
}

// Each entry says, for paths with this beginning, which outcomes have such a number.
constexpr std::pair<const char*, const char*> kOwners[] = {
    {"rates_after_rad_s[", "rates_after_rad_s has an entry for each link of a linkage and one for a pendulum"},
    {"rates_after[", "rates_after has an entry for each coordinate of a mechanism"},
    {"momentum_change[", "momentum_change has an entry for each coordinate of a mechanism"},
    {"errors.rates_after[", "rates_after has an entry for each coordinate of a mechanism"},
    {"errors.momentum_change[", "momentum_change has an entry for each coordinate of a mechanism"},
    {"bodies_after[",
     "bodies_after has an entry for planar_body and spatial_body and two for body_pair, with linear_m_s along t and n "
     "and one angular_rad_s in a plane, and three of each in space"},
    {"contact_velocity_after.tangential_m_s[", "only a system in space has two tangential directions"},
    {"impulse.tangential_n_s[", "only a system in space has two tangential directions"},
    {"free_end.", "free_end has the numbers of a mechanism with kept_coordinates or composite, and none held"},
    {"effective.restitution", "the damping of compliance.hunt_crossley stands for the coefficient of restitution"},
};

// Returns the rule that the path breaks as a column of the scene.
std::string RuleFor(const Scene& scene, const std::string& path, const std::vector<std::string>& all) {
  const std::string lacking = LackingForNumber(scene, path);
  const bool exists = std::find(all.begin(), all.end(), path) != all.end();
  if (exists && !lacking.empty()) return absl::StrCat("not be asked of a scene without ", lacking);
  const std::string rule = "be a column of the scene; ";
  for (const auto& [start, owner] : kOwners) {
    if (absl::StartsWith(path, start)) return rule + owner;
  }
  if (exists)
    return rule + "an impact law has no phases of compression and restitution, and no errors of single numbers";
  return absl::StrCat(rule, "`ricochet sweep --column '?'` lists them", DidYouMean(path, Columns(scene)));
}

}  // namespace

std::vector<std::string> Columns(const Scene& scene) {
  std::vector<std::string> columns;
  VisitOutcomeNumbers(WithEveryNumber(scene), [&](const NumberPath& path, double /*number*/) {
    std::string column = path.Text();
    if (LackingForNumber(scene, column).empty()) columns.push_back(std::move(column));
  });
  return columns;
}

std::vector<std::string> ColumnPlaces(const Scene& scene) {
  std::vector<std::string> paths;
  VisitOutcomeFields(WithEveryNumber(scene),
                     [&](const NumberPath& path, const double* /*number*/) { paths.push_back(path.Text()); });
  return paths;
}

bool MayBeUnset(absl::string_view column) {
  return absl::StartsWith(column, "errors.") || ReadDerivativeName(column).has_value() ||
         EffectBehind(column).has_value();
}

std::vector<Violation> CheckColumns(const Scene& scene, const std::vector<std::string>& columns) {
  std::vector<Violation> violations;
  if (columns.empty()) violations.push_back({"columns", "is empty: must name at least one"});
  const std::vector<std::string> known = Columns(scene);
  const std::unordered_set<std::string_view> are_known(known.begin(), known.end());
  const auto rule_for = [&](const std::string& column) {
    if (const auto derivative = ReadDerivativeName(column)) return RuleForDerivative(scene, *derivative);
    return are_known.contains(column) ? "" : RuleFor(scene, column, ColumnPlaces(scene));
  };
  std::set<std::string> seen;
  for (size_t i = 0; i < columns.size() && !IsFull(violations); ++i) {
    const auto refuse = [&](const std::string& rule) {
      violations.push_back({absl::StrCat("columns[", i, "]"), absl::StrCat(Found(columns[i]), ": must ", rule)});
    };
    if (const std::string rule = rule_for(columns[i]); !rule.empty()) {
      refuse(rule);
    } else if (!seen.insert(columns[i]).second) {
      refuse("be named once");
    }
  }
  return violations;
}

std::vector<Violation> CheckEffectsBehind(const Scene& scene, std::optional<SceneContact>& contact,
                                          const Demand& demand, const std::vector<std::string>& columns) {
  std::vector<Violation> violations;
  for (size_t i = 0; i < columns.size() && !IsFull(violations); ++i) {
    const auto derivative = ReadDerivativeName(columns[i]);
    const std::string& number = derivative.has_value() ? derivative->of : columns[i];
    std::vector<std::string> reasons = WhyNoNumber(scene, contact, demand, number);
    if (derivative.has_value() && !demand.excluded.IsEmpty()) {
      reasons.emplace_back("must not be asked with excluded effects: derivatives leave nothing out");
    }
    for (const std::string& reason : reasons) {
      violations.push_back({absl::StrCat("columns[", i, "]"), absl::StrCat(Found(columns[i]), ": ", reason)});
    }
  }
  return violations;
}

ColumnReader::ColumnReader(const Scene& scene, const std::vector<std::string>& columns) : columns_(columns.size()) {
  std::unordered_map<std::string, size_t> position_of;
  for (size_t c = 0; c < columns.size(); ++c) position_of.emplace(columns[c], c);
  VisitOutcomeFields(WithEveryNumber(scene), [&](const NumberPath& path, const double* /*number*/) {
    Place& place = places_.emplace_back();
    place.may_be_infinite = MayBeInfinite(path);
    if (const auto found = position_of.find(path.Text()); found != position_of.end()) place.column = found->second;
  });
}

ColumnReader::Reading ColumnReader::Read(const Outcome& outcome, std::vector<double>& numbers) const {
  numbers.resize(columns_);
  Reading reading;
  bool is_complete = true;
  auto place = places_.begin();
  VisitOutcomeFields(outcome, [&](const NumberPath& /*path*/, const double* number) {
    const auto& [column, may_be_infinite] = *place++;
    if (!column.has_value()) return;
    is_complete &= number != nullptr;
    numbers[*column] = number == nullptr ? std::numeric_limits<double>::quiet_NaN() : *number;
    if (number == nullptr || may_be_infinite || std::isfinite(*number)) return;
    reading.too_large = std::min(*column, reading.too_large.value_or(*column));
  });
  // The end of the mechanism that holds no coordinate counts as well as that which holds some, if it was asked for.
  const auto& free_end = outcome.free_end;
  if (reading.too_large.has_value()) {
    reading.status = RowStatus::kNotRepresentable;
  } else if (!outcome.admissible || (free_end.has_value() && !free_end->admissible)) {
    reading.status = RowStatus::kInadmissible;
  } else if (outcome.termination != Termination::kConverged ||
             (free_end.has_value() && free_end->termination != Termination::kConverged)) {
    reading.status = RowStatus::kNotConverged;
  } else if (!is_complete) {
    reading.status = RowStatus::kIncomplete;
  }
  return reading;
}

}  // namespace ricochet
