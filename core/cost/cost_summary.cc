#include "core/cost/cost_summary.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/cost/methods_by_model.h"
#include "core/plan/planned_scene.h"

namespace ricochet {
namespace {

bool IsComparable(const CostRow& row) {
  return row.status == CostStatus::kMeasured && row.solve.has_value() && row.achieved.has_value();
}

double OwnStiffness(const Scene& scene) {
  return scene.compliance.has_value() ? StiffnessOf(scene.compliance->normal) : 0.0;
}

// Returns the row of a model with the largest tolerance that does not exceed `tolerance`.
int64_t RowOf(const std::vector<CostRow>& rows, const CostMethod& wanted, double tolerance) {
  constexpr double kRounding = 1.0 + 1e-9;
  int64_t found = -1;
  double found_tolerance = 0.0;
  for (size_t i = 0; i < rows.size(); ++i) {
    CostMethod method = rows[i].method;
    const double at = method.tolerance.value_or(0.0);
    method.tolerance.reset();
    if (!(method == wanted) || at > tolerance * kRounding || (found >= 0 && at <= found_tolerance)) continue;
    found = static_cast<int64_t>(i);
    found_tolerance = at;
  }
  return found;
}

CostPick PickAt(const Scene& scene, std::optional<SceneContact>& contact, const std::vector<CostRow>& rows,
                double tolerance) {
  const Demand demand = {.relative_tolerance = tolerance};
  const PlannedScene planned = PlanScene(scene, contact, demand);
  const Model model = planned.choice.model;
  CostMethod wanted = {.model = model, .arithmetic = ArithmeticOf(planned).arithmetic};
  if (model == Model::kFiniteDuration) wanted.stiffness = OwnStiffness(scene);
  return {.row = RowOf(rows, wanted, planned.choice.model_tolerance),
          .least_tolerance = tolerance,
          .most_tolerance = tolerance,
          .model = model};
}

}  // namespace

std::vector<int64_t> ParetoFront(const std::vector<CostRow>& rows) {
  std::vector<int64_t> order;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (IsComparable(rows[i])) order.push_back(static_cast<int64_t>(i));
  }
  const auto row = [&rows](int64_t i) -> const CostRow& { return rows[static_cast<size_t>(i)]; };
  std::stable_sort(order.begin(), order.end(), [&row](int64_t i, int64_t k) {
    const double a = row(i).solve->median_s;
    const double b = row(k).solve->median_s;
    return a != b ? a < b : row(i).ComparedError() < row(k).ComparedError();
  });
  std::vector<int64_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const int64_t i : order) {
    if (!(row(i).ComparedError() < least)) continue;
    least = row(i).ComparedError();
    front.push_back(i);
  }
  return front;
}

std::vector<CostPick> PicksFor(const Scene& scene, std::optional<SceneContact>& contact,
                               const std::vector<CostRow>& rows) {
  std::vector<CostPick> picks;
  for (const double tolerance : kCostTolerances) {
    const CostPick pick = PickAt(scene, contact, rows, tolerance);
    if (!picks.empty() && picks.back().row == pick.row && picks.back().model == pick.model) {
      picks.back().most_tolerance = tolerance;
    } else {
      picks.push_back(pick);
    }
  }
  return picks;
}

}  // namespace ricochet
