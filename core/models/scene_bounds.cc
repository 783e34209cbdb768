#include "core/models/scene_bounds.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/laws/contact_bounds.h"
#include "core/laws/enclosure.h"
#include "core/laws/nearly_vertical.h"
#include "core/models/pendulum_bounds.h"
#include "core/models/planar_outcome.h"
#include "core/models/scene_outcome.h"
#include "core/models/spatial_outcome.h"
#include "core/numerics/decimal.h"
#include "core/plan/planned_scene.h"
#include "core/scene/check.h"
#include "core/scene/effective.h"
#include "core/scene/reduction.h"
#include "core/sweep/field.h"

namespace ricochet {
namespace {

Bounds PendulumBounds(const Scene& scene) {
  const pendulum::Problem problem = ClosedFormProblem(scene);
  Bounds bounds = pendulum::SolveBounds(problem);
  if (bounds.slope_ratio > 0.0 && bounds.regime != Regime::kLocked) {
    const bool has_restitution = !std::holds_alternative<std::monostate>(scene.restitution);
    bounds.nearly_vertical = pendulum::SolveNearlyVertical(problem, has_restitution);
  }
  return bounds;
}

Bounds ReducedBounds(const PlanarReduction& reduction, const EffectiveCoefficients& effective) {
  const planar::ContactBounds contact = planar::SolveBounds(planar::MakeProblem(reduction, {}, effective));
  return {.regime = contact.regime,
          .sharp = contact.sharp,
          .energy_only = contact.energy_only,
          .nearly_vertical = std::nullopt,
          .critical = contact.critical};
}

void Include(double value, Range& range) {
  range.lower = std::min(range.lower, value);
  range.upper = std::max(range.upper, value);
}

Bounds ReducedBounds(const SpatialReduction& reduction, const EffectiveCoefficients& effective) {
  spatial::Problem problem =
      spatial::MakeProblem(reduction, EnergeticCoefficient{}, effective, spatial::kStudyTolerance);
  problem.coefficient = 0.0;
  const spatial::Impact dead = spatial::Solve(problem);
  Bounds bounds;
  bounds.sampled = true;
  bounds.regime = dead.regime;
  CoefficientBounds& sharp = bounds.sharp;
  sharp = {.newton = {dead.newton, dead.newton},
           .poisson = {dead.poisson, dead.poisson},
           .energetic = {dead.energetic, dead.energetic},
           .tangential = {dead.tangential, dead.tangential},
           .normal_total_n_s = {dead.tau1, dead.tau1}};
  for (int i = 1; i < kSpatialImpacts; ++i) {
    problem.coefficient = static_cast<double>(i) / (kSpatialImpacts - 1);
    const spatial::Impact impact = spatial::Solve(problem);
    bounds.regime = impact.regime;
    Include(impact.newton, sharp.newton);
    Include(impact.poisson, sharp.poisson);
    Include(impact.energetic, sharp.energetic);
    Include(impact.tangential, sharp.tangential);
    Include(impact.tau1, sharp.normal_total_n_s);
  }
  return bounds;
}

absl::Status CheckFinite(const CoefficientBounds& bounds, const std::string& path) {
  const std::pair<const char*, Range> ranges[] = {{"newton", bounds.newton},
                                                  {"poisson", bounds.poisson},
                                                  {"energetic", bounds.energetic},
                                                  {"tangential", bounds.tangential},
                                                  {"normal_total_n_s", bounds.normal_total_n_s}};
  for (const auto& [name, range] : ranges) {
    if (!std::isfinite(range.upper)) return OutputOverflow(absl::StrCat(path, name, ".upper"));
    if (!std::isfinite(range.lower)) return OutputOverflow(absl::StrCat(path, name, ".lower"));
  }
  return absl::OkStatus();
}

absl::Status CheckFinite(const Bounds& bounds) {
  if (!std::isfinite(bounds.friction_ratio)) return OutputOverflow("bounds.friction_ratio");
  absl::Status status = CheckFinite(bounds.sharp, "bounds.sharp.");
  if (bounds.energy_only.has_value()) status.Update(CheckFinite(*bounds.energy_only, "bounds.energy_only."));
  if (!bounds.nearly_vertical.has_value()) return status;
  status.Update(CheckFinite(bounds.nearly_vertical->bounds, "bounds.nearly_vertical.bounds."));
  return status;
}

bool HasRanges(const System& system) {
  return std::holds_alternative<Pendulum>(system) || std::holds_alternative<PlanarContact>(system);
}

// The paths that a range may have: numbers that the boxes hold as they stand.
std::vector<std::string> RangePaths(const Scene& scene) {
  std::vector<std::string> paths;
  for (const std::string& path : FieldPaths(scene)) {
    const bool is_friction = absl::StartsWith(path, "friction.") && !absl::StartsWith(path, "friction.by_speed.");
    const bool is_system = absl::StartsWith(path, "pendulum.") || absl::StartsWith(path, "planar_contact.");
    if (is_friction || (is_system && path != "pendulum.phi_rad")) paths.push_back(path);
  }
  return paths;
}

void CheckEnds(const Scene& scene, int index, const FieldRange& range, Check& check) {
  Scene with_field = scene;
  if (!ResolveField(range.path, with_field).ok()) return;
  VisitNumbers(with_field, [&](const NumberPath& path, double& /*number*/, NumberRule rule) {
    if (path.Text() != range.path) return;
    check.Number(NumberPath{"ranges", index, "low"}, range.low, rule);
    check.Number(NumberPath{"ranges", index, "high"}, range.high, rule);
  });
  check.Require(!(range.low > range.high), [&] {
    return MakeViolation(absl::StrCat("ranges[", index, "].high"), range.high,
                         absl::StrCat("be >= low = ", ShortestDecimal(range.low)));
  });
}

void CheckPath(const std::vector<std::string>& paths, absl::Span<const FieldRange> ranges, size_t index, Check& check) {
  const std::string field = absl::StrCat("ranges[", index, "].path");
  const std::string found = absl::StrCat("= \"", absl::CEscape(ranges[index].path), "\": must ");
  check.Require(std::find(paths.begin(), paths.end(), ranges[index].path) != paths.end(), [&] {
    return Violation{field, absl::StrCat(found, "be one of ", absl::StrJoin(paths, ", "))};
  });
  const auto* const first = std::find_if(ranges.begin(), ranges.end(),
                                         [&](const FieldRange& range) { return range.path == ranges[index].path; });
  check.Require(first == &ranges[index], [&] {
    return Violation{field, absl::StrCat(found, "not be that of ranges[", first - ranges.begin(), "] too")};
  });
}

// `scene` with each field at one end of its range.
Scene AtEnd(Scene scene, absl::Span<const FieldRange> ranges, double FieldRange::*end) {
  for (const FieldRange& range : ranges) {
    const absl::StatusOr<Field> field = ResolveField(range.path, scene);
    if (field.ok()) field->Set(range.*end);
  }
  return scene;
}

Interval KineticBetween(const Scene& low, const Scene& high) {
  return {low.friction.kinetic_coefficient, high.friction.kinetic_coefficient};
}

// Unset where static friction follows kinetic: a range of its own would let the two differ.
std::optional<Interval> StaticBetween(const Scene& low, const Scene& high) {
  if (!low.friction.static_coefficient.has_value()) return std::nullopt;
  return Interval(*low.friction.static_coefficient, *high.friction.static_coefficient);
}

PendulumBox PendulumBetween(const Scene& low_scene, const Scene& high_scene) {
  const auto& low = std::get<Pendulum>(low_scene.system);
  const auto& high = std::get<Pendulum>(high_scene.system);
  return {.inertia = {low.inertia_kg_m2, high.inertia_kg_m2},
          .a = {low.a_m, high.a_m},
          .b = {low.b_m, high.b_m},
          .omega_minus = {low.omega_minus_rad_s, high.omega_minus_rad_s},
          .mu = KineticBetween(low_scene, high_scene),
          .mu_static = StaticBetween(low_scene, high_scene)};
}

PlanarBox PlanarBetween(const Scene& low_scene, const Scene& high_scene) {
  const auto& low = std::get<PlanarContact>(low_scene.system);
  const auto& high = std::get<PlanarContact>(high_scene.system);
  return {.wtt = {low.w_tt_per_kg, high.w_tt_per_kg},
          .wtn = {low.w_tn_per_kg, high.w_tn_per_kg},
          .wnn = {low.w_nn_per_kg, high.w_nn_per_kg},
          .u0 = {low.tangential_m_s, high.tangential_m_s},
          .v0 = {low.normal_m_s, high.normal_m_s},
          .mu = KineticBetween(low_scene, high_scene),
          .mu_static = StaticBetween(low_scene, high_scene)};
}

bool HasOneWOfRankOne(const Scene& scene, const PlanarBox& box) {
  if (!IsPoint(box.wtt) || !IsPoint(box.wtn) || !IsPoint(box.wnn)) return false;
  planar::Problem problem = {.wtt = box.wtt.lower,
                             .wtn = box.wtn.lower,
                             .wnn = box.wnn.lower,
                             .u0 = box.u0.lower,
                             .v0 = box.v0.lower,
                             .mu = scene.friction.kinetic_coefficient};
  problem.mu_static = problem.mu;
  return planar::Solve(problem).w_rank < 2;
}

}  // namespace

absl::StatusOr<Bounds> SolveSceneBounds(const Scene& scene) {
  Bounds bounds;
  if (HasClosedForm(scene)) {
    bounds = PendulumBounds(scene);
  } else {
    const AnyReduction any = Reduce(scene);
    if (!IsFinite(any)) return ContactOverflow();
    const EffectiveCoefficients effective = EffectiveAt(scene, ApproachSpeed(any));
    bounds = std::visit([&](const auto& reduction) { return ReducedBounds(reduction, effective); }, any);
  }
  const absl::Status finite = CheckFinite(bounds);
  if (!finite.ok()) return finite;
  return bounds;
}

std::vector<Violation> CheckRanges(const Scene& scene, absl::Span<const FieldRange> ranges) {
  Check check(Check::Mode::kListing);
  if (ranges.empty()) return {};
  check.Require(HasRanges(scene.system), [] {
    return Violation{"system", "has no enclosure: must be pendulum or planar_contact, with ranges"};
  });
  check.Require(!scene.surface_velocity.has_value(), [] {
    return Violation{"surface_velocity", "is set: must not be, with ranges"};
  });
  check.Require(!scene.friction.by_speed.has_value(), [] {
    return Violation{"friction.by_speed", "is set: must not be, with ranges"};
  });
  if (!HasRanges(scene.system)) return std::move(check).violations();
  const std::vector<std::string> paths = RangePaths(scene);
  for (size_t i = 0; i < ranges.size(); ++i) {
    CheckPath(paths, ranges, i, check);
    CheckEnds(scene, static_cast<int>(i), ranges[i], check);
  }
  return std::move(check).violations();
}

absl::StatusOr<Enclosure> EncloseScene(const Scene& scene, absl::Span<const FieldRange> ranges) {
  const Scene low = AtEnd(scene, ranges, &FieldRange::low);
  const Scene high = AtEnd(scene, ranges, &FieldRange::high);
  Enclosure enclosure;
  if (std::holds_alternative<Pendulum>(scene.system)) {
    enclosure = Enclose(PendulumBetween(low, high));
  } else {
    const PlanarBox box = PlanarBetween(low, high);
    if (HasOneWOfRankOne(scene, box)) {
      return InvalidRequest({{"planar_contact",
                              "has a W of rank one: must have rank two, with ranges, or be stated as "
                              "a pendulum"}});
    }
    enclosure = Enclose(box, EnclosureOptions());
  }
  if (enclosure.attained.newton.lower > enclosure.attained.newton.upper) {
    return InvalidRequest({{"ranges",
                            "hold no valid scene: must hold one with det W >= 0 and static friction >= "
                            "kinetic"}});
  }
  return enclosure;
}

}  // namespace ricochet
