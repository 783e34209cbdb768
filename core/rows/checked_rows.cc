#include "core/rows/checked_rows.h"

#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/plan/number_demand.h"
#include "core/rows/column.h"
#include "core/rows/driven_scene.h"
#include "core/rows/scene_lanes.h"
#include "core/scene/validate.h"
#include "core/types/grid.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

std::vector<Violation> CheckRange(const SweepRequest& request) {
  const int64_t points = PointCount(request.grid);
  const int64_t end = request.end_index.value_or(points);
  std::vector<Violation> violations;
  if (end < 0 || end > points) {
    violations.push_back({"end_index", absl::StrCat("= ", end, ": must be in [0, ", points, "], the grid's points")});
  }
  const int64_t most = violations.empty() ? end : points;
  if (request.first_index < 0 || request.first_index > most) {
    const char* const what = violations.empty() ? "end_index = " : "";
    violations.push_back(
        {"first_index", absl::StrCat("= ", request.first_index, ": must be in [0, ", what, most, "]")});
  }
  return violations;
}

void Append(std::vector<Violation> more, std::vector<Violation>& violations) {
  std::move(more.begin(), more.end(), std::back_inserter(violations));
}

// Lists the violations of the scene and of the demand that no field can cure. `contact` is that of a scene without any.
std::vector<Violation> CheckScene(const DrivenScene& driven, const DemandFields& demand,
                                  std::optional<SceneContact>& contact) {
  const auto stays = [&driven](const Violation& violation) { return !driven.CanBeCured(violation); };
  std::vector<Violation> violations = Validate(driven.scene(), RestitutionIs::kRequired, contact, stays);
  if (!violations.empty()) {
    Append(CheckDemand(demand), violations);
    return violations;
  }
  violations = CheckDemand(driven.scene(), contact, demand);
  std::erase_if(violations, std::not_fn(stays));
  return violations;
}

}  // namespace

absl::StatusOr<CheckedSweep> CheckSweep(const SweepRequest& request) {
  const DrivenScene driven(
      request.grid.scene, AxisPaths(request.grid), [](size_t i) { return absl::StrCat("axes[", i, "]"); }, ".path");
  const Scene& scene = driven.scene();
  std::optional<SceneContact> contact;
  std::vector<Violation> violations = CheckScene(driven, request.demand, contact);
  Append(driven.violations(), violations);
  const std::vector<Violation> axes = ValidateAxes(request.grid);
  Append(axes, violations);
  Append(CheckColumns(scene, request.columns), violations);
  if (axes.empty()) Append(CheckRange(request), violations);
  const Demand demand = ToDemand(request.demand);
  if (violations.empty()) violations = CheckEffectsBehind(scene, contact, demand, request.columns);
  if (!violations.empty()) return InvalidRequest(violations);

  CheckedSweep sweep = {.grid = request.grid,
                        .demand = WithNumbers(demand, request.columns),
                        .with_regime = request.with_regime,
                        .first = request.first_index,
                        .end = request.end_index.value_or(PointCount(request.grid)),
                        .columns = request.columns};
  sweep.in_lanes = SceneLanes::Make(scene, request.columns, sweep.demand) != nullptr;
  return sweep;
}

absl::StatusOr<CheckedBatch> CheckBatch(const BatchSetup& setup) {
  const DrivenScene driven(
      setup.scene, setup.fields, [](size_t i) { return absl::StrCat("fields[", i, "]"); }, "");
  const Scene& scene = driven.scene();
  std::optional<SceneContact> contact;
  std::vector<Violation> violations = CheckScene(driven, setup.demand, contact);
  if (setup.fields.empty()) violations.push_back({"fields", "is empty: must name at least one"});
  Append(driven.violations(), violations);
  Append(CheckColumns(scene, setup.columns), violations);
  const Demand demand = ToDemand(setup.demand);
  if (violations.empty()) violations = CheckEffectsBehind(scene, contact, demand, setup.columns);
  if (!violations.empty()) return InvalidRequest(violations);
  return CheckedBatch{.scene = setup.scene,
                      .fields = setup.fields,
                      .columns = setup.columns,
                      .demand = WithNumbers(demand, setup.columns)};
}

}  // namespace ricochet
