#include "core/answer/derivatives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "core/answer/derivative_sides.h"
#include "core/answer/differences.h"
#include "core/answer/near_thresholds.h"
#include "core/answer/scene_line.h"
#include "core/base/nearest.h"
#include "core/contact/contact_tangent.h"
#include "core/contact/scene_contact.h"
#include "core/models/planar/tangent.h"
#include "core/plan/scene_problem.h"
#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"

namespace ricochet {
namespace {

constexpr char kPhi[] = "pendulum.phi_rad";
// A number that is 0 has its sides here. The square of it is still a normal double.
constexpr double kBeside = 0x1p-300;
constexpr size_t kOutputs = kPlanarOutputPaths.size();

// --- Which numbers there are ---

// The paths of the velocities of the system itself after the impact; in a plane in the order of
// PlanarReduction::before.
struct VelocityPaths {
  std::vector<std::string>& paths;
  size_t tangential;  // Directions.

  void operator()(std::monostate) const {}
  void operator()(const PlanarContact& /*contact*/) const {}
  void operator()(const SpatialContact& /*contact*/) const {}
  void operator()(const SpatialBody& /*body*/) const { Bodies(1); }
  void operator()(const Pendulum& /*pendulum*/) const { List("rates_after_rad_s", 1); }
  void operator()(const Linkage& linkage) const { List("rates_after_rad_s", linkage.links.size()); }
  void operator()(const Mechanism& mechanism) const { List("rates_after", mechanism.rates.size()); }
  void operator()(const PlanarBody& /*body*/) const { Bodies(1); }
  void operator()(const BodyPair& /*pair*/) const { Bodies(2); }

 private:
  void List(const std::string& name, size_t count) const {
    for (size_t i = 0; i < count; ++i) paths.push_back(absl::StrCat(name, "[", i, "]"));
  }
  void Bodies(int count) const {
    for (int i = 0; i < count; ++i) {
      List(absl::StrCat("bodies_after[", i, "].linear_m_s"), tangential + 1);
      List(absl::StrCat("bodies_after[", i, "].angular_rad_s"), tangential == 1 ? 1 : 3);
    }
  }
};

std::vector<std::string> OutputPaths(const Scene& scene) {
  const size_t tangential = TangentialDirections(scene.system);
  std::vector<std::string> paths;
  for (const std::string path : kPlanarOutputPaths) {
    paths.push_back(path);
    if (tangential == 2 && absl::EndsWith(path, "[0]"))
      paths.push_back(absl::StrCat(absl::StripSuffix(path, "0]"), "1]"));
  }
  std::visit(VelocityPaths{paths, tangential}, scene.system);
  if (TakesTime(scene)) {
    for (const char* number : {"duration_s", "peak_normal_n", "peak_tangential_n", "indentation_m"}) {
      paths.push_back(absl::StrCat("contact.", number));
    }
  }
  return paths;
}

const char* StatedDefinition(const Scene& scene) {
  constexpr std::array kDefinitions = {"", "restitution.newton", "restitution.poisson", "restitution.energetic"};
  return kDefinitions[scene.restitution.index()];
}

bool IsOtherDefinition(const Scene& scene, const std::string& path) {
  return absl::StartsWith(path, "restitution.") && !absl::StartsWith(path, "restitution.by_speed.") &&
         path != StatedDefinition(scene);
}

// --- One side of one number ---

// The scene and its direction, for one side of a number of the scene.
struct Beside {
  Scene scene, direction;
  double step = 0.0;  // The derivative by the number is that along the direction over this.
};

// The direction in which the number at `path` alone changes, by `step`.
Scene DirectionOf(const Scene& scene, const std::string& path, double step) {
  Scene direction = scene;
  const Field field = *ResolveField(path, direction);
  VisitNumbers(direction, [](const NumberPath& /*at*/, double& value, NumberRule /*rule*/) { value = 0.0; });
  if (path != kPhi) {
    field.Set(step);
    return direction;
  }
  // a = R sin phi and b = R cos phi.
  const auto& pendulum = std::get<Pendulum>(scene.system);
  auto& change = std::get<Pendulum>(direction.system);
  change.a_m = step * pendulum.b_m;
  change.b_m = -step * pendulum.a_m;
  return direction;
}

// `side` is 1 above the number and -1 below it. Returns nothing if the scene breaks a rule there.
std::optional<Beside> StepBeside(const Scene& scene, const std::string& path, double side) {
  Beside beside = {.scene = scene};
  if (path == kPhi) {
    beside.step = side;
    beside.direction = DirectionOf(scene, path, side);
    return beside;
  }
  const Field field = *ResolveField(path, beside.scene);
  const double number = *NumberAt(beside.scene, path);
  const double size = number == 0.0 ? kBeside : std::fabs(number);
  const bool keeps_rule = field.Set(number == 0.0 ? side * size : number + side * 0x1p-50 * size);
  if (!keeps_rule || !Validate(beside.scene).empty()) return std::nullopt;
  if (number != 0.0) field.Set(number);
  beside.step = side * size;
  beside.direction = DirectionOf(beside.scene, path, beside.step);
  return beside;
}

struct Side {
  bool exists = false;  // The scene keeps its rules on this side.
  planar::Tangent tangent;
  bool loses_rank = false;
  bool is_at_speed_of_table = false;
  std::vector<double> value, rate;  // By the places of OutputPaths; the rate by the number itself.
};

planar::Problem ProblemOf(const Scene& scene, const SceneContact& contact) {
  return planar::MakeProblem(std::get<PlanarReduction>(contact.reduction), scene.restitution, contact.coefficients);
}

// The velocities of the system and their rates: q' + X (f, tau).
void AppendVelocities(const PlanarReduction& reduction, const ContactTangent& d, Side& side) {
  const auto at = [](PlanarOutput output) { return static_cast<size_t>(output); };
  const double f = side.value[at(PlanarOutput::kTangentialImpulse)];
  const double tau = side.value[at(PlanarOutput::kNormalImpulse)];
  const double d_f = side.rate[at(PlanarOutput::kTangentialImpulse)];
  const double d_tau = side.rate[at(PlanarOutput::kNormalImpulse)];
  for (size_t i = 0; i < reduction.before.size(); ++i) {
    const double* const x = &reduction.response[2 * i];
    const double* const d_x = &d.response[2 * i];
    side.value.push_back(reduction.before[i] + x[0] * f + x[1] * tau);
    side.rate.push_back(d.before[i] + d_x[0] * f + d_x[1] * tau + x[0] * d_f + x[1] * d_tau);
  }
}

// Sets all numbers of the outcome, with their rates along the direction.
void SetNumbers(const planar::Tangent& tangent, const PlanarReduction& reduction, const ContactTangent& d, Side& side) {
  side.value.assign(tangent.value.begin(), tangent.value.begin() + kOutputs);
  side.rate.assign(tangent.rate.begin(), tangent.rate.begin() + kOutputs);
  AppendVelocities(reduction, d, side);
}

Side SideAt(const std::optional<Beside>& beside) {
  Side side;
  if (!beside.has_value()) return side;
  side.exists = true;
  const SceneContact contact(beside->scene);
  const ContactTangent d = TangentOf(beside->scene, contact, beside->direction);
  side.tangent = planar::TangentOf(ProblemOf(beside->scene, contact), {.w = d.w,
                                                                       .u0 = d.u0,
                                                                       .v0 = d.v0,
                                                                       .mu = d.kinetic_friction,
                                                                       .mu_static = d.static_friction,
                                                                       .coefficient = d.restitution});
  const bool moves_w = d.w.tt != 0.0 || d.w.tn != 0.0 || d.w.nn != 0.0;
  side.loses_rank = side.tangent.branch.approaches &&
                    (side.tangent.leaves_range || (side.tangent.w_rank == 1 && moves_w && !d.keeps_rank_one));
  side.is_at_speed_of_table = d.is_at_speed_of_table;
  SetNumbers(side.tangent, std::get<PlanarReduction>(contact.reduction), d, side);
  for (double& rate : side.rate) rate /= beside->step;
  return side;
}

// --- Both sides together ---

// The outcome at the scene itself, which a side must continue.
struct Here {
  std::vector<double> value, scale;
};

Here HereOf(const Scene& scene) {
  const SceneContact contact(scene);
  const planar::Problem problem = ProblemOf(scene, contact);
  const planar::Tangent tangent = planar::TangentOf(problem, {});
  const auto& reduction = std::get<PlanarReduction>(contact.reduction);
  ContactTangent none;
  none.before.assign(reduction.before.size(), 0.0);
  none.response.assign(reduction.response.size(), 0.0);
  Side here;
  SetNumbers(tangent, reduction, none, here);
  const double speed = std::max(std::fabs(problem.u0), std::fabs(problem.v0));
  const double impulse = tangent.value[static_cast<size_t>(PlanarOutput::kNormalImpulse)];
  std::vector<double> scale(here.value.size(), 0.0);
  for (size_t i = 0; i < kOutputs; ++i) {
    scale[i] = ScaleOf(kPlanarOutputPaths[i], speed, impulse);
  }
  for (size_t i = kOutputs; i < scale.size(); ++i) {
    const size_t row = 2 * (i - kOutputs);
    scale[i] = std::fabs(reduction.before[i - kOutputs]) +
               impulse * (std::fabs(reduction.response[row]) + std::fabs(reduction.response[row + 1]));
  }
  return {std::move(here.value), std::move(scale)};
}

Threshold ThresholdBetween(const Side& below, const Side& above) {
  if (below.loses_rank || above.loses_rank) return Threshold::kRank;
  if (!below.exists || !above.exists) return Threshold::kDomain;
  const planar::Branch& x = below.tangent.branch;
  const planar::Branch& y = above.tangent.branch;
  if (x.approaches != y.approaches) return Threshold::kApproach;
  if (x.slip_before != y.slip_before) return Threshold::kSlipStart;
  if (x.held != y.held) return Threshold::kJamming;
  if (x.stops && y.stops && x.sticks != y.sticks) return Threshold::kFrictionLimit;
  if (x.stops_in_compression != y.stops_in_compression) return Threshold::kCompressionEnd;
  if (x.stops_in_restitution != y.stops_in_restitution) return Threshold::kImpactEnd;
  return below.is_at_speed_of_table ? Threshold::kSpeedTable : Threshold::kUnspecified;
}

OneSided LimitOf(const Side& side, const Here& here, size_t i) {
  if (!side.exists) return {.why_none = "the scene would break a rule"};
  if (side.loses_rank) return {.why_none = "the rank of W, or whether the velocity lies in its range, changes at once"};
  if (!std::isfinite(side.value[i]) || !std::isfinite(side.rate[i])) {
    return {.why_none = "the number jumps or changes infinitely fast"};
  }
  const double size = std::max({std::fabs(here.value[i]), std::fabs(side.value[i]), here.scale[i]});
  if (std::fabs(side.value[i] - here.value[i]) > 0x1p-30 * size) return {.why_none = "the number jumps"};
  return {.rate = side.rate[i] + 0.0};
}

// True if the rates differ by no more than their rounding.
bool Agree(const OneSided& x, const OneSided& y) {
  return x.rate.has_value() && y.rate.has_value() &&
         std::fabs(*x.rate - *y.rate) <= 0x1p-40 * (std::fabs(*x.rate) + std::fabs(*y.rate));
}

}  // namespace

void CheckPaths(const char* list, const std::vector<std::string>& paths, const std::vector<std::string>& known,
                const char* what, std::vector<Violation>& violations) {
  if (paths.empty())
    violations.push_back(MakeViolation(absl::StrCat("derivatives.", list), "is empty", "name a number"));
  for (size_t i = 0; i < paths.size(); ++i) {
    if (std::find(known.begin(), known.end(), paths[i]) != known.end()) continue;
    violations.push_back(MakeViolation(absl::StrCat("derivatives.", list, "[", i, "]"), Found(paths[i]),
                                       absl::StrCat("be ", what, DidYouMean(paths[i], known))));
  }
}

DerivativePaths AllDerivativePaths(const Scene& scene) {
  DerivativePaths paths = {.of = OutputPaths(scene), .by = FieldPaths(scene)};
  paths.by.erase(std::remove_if(paths.by.begin(), paths.by.end(),
                                [&scene](const std::string& path) { return IsOtherDefinition(scene, path); }),
                 paths.by.end());
  return paths;
}

std::vector<Violation> CheckDerivatives(const Scene& scene, const DemandFields& demand, const DerivativePaths& paths) {
  std::vector<Violation> violations;
  if (!demand.excluded.empty()) {
    violations.push_back(MakeViolation("excluded", "is set", "not be, with derivatives: they leave nothing out"));
  }
  const DerivativePaths known = AllDerivativePaths(scene);
  CheckPaths("of", paths.of, known.of, "a velocity, an impulse, a work or a coefficient of the outcome", violations);
  CheckPaths("by", paths.by, known.by, "a number of the scene, with the definition of restitution that it states",
             violations);
  return violations;
}

absl::StatusOr<std::vector<Derivative>> DerivativesOf(const Scene& scene, const Demand& demand,
                                                      const DerivativePaths& paths, absl::FunctionRef<bool()> stopped) {
  const bool is_exact = WhyNotExact(scene) == nullptr;
  if (is_exact && !paths.find_thresholds) return ExactDerivatives(scene, paths);
  const absl::StatusOr<std::unique_ptr<SampleSource>> source = OutcomeSamples(scene, demand, paths.of, stopped);
  if (!source.ok()) return source.status();
  absl::StatusOr<std::vector<Derivative>> derivatives =
      is_exact ? ExactDerivatives(scene, paths) : DifferencesOf(**source, scene, paths);
  if (!derivatives.ok() || !paths.find_thresholds) return derivatives;
  const absl::Status found = FindThresholds(**source, scene, paths.by, *derivatives);
  if (!found.ok()) return found;
  return derivatives;
}

std::vector<Derivative> ExactDerivatives(const Scene& scene, const DerivativePaths& paths) {
  const std::vector<std::string> known = OutputPaths(scene);
  std::vector<size_t> places;
  for (const std::string& of : paths.of) {
    places.push_back(static_cast<size_t>(std::find(known.begin(), known.end(), of) - known.begin()));
  }
  const Here here = HereOf(scene);
  std::vector<Derivative> derivatives(paths.of.size() * paths.by.size());
  for (size_t k = 0; k < paths.by.size(); ++k) {
    const std::string& by = paths.by[k];
    const Scene stated = Stating(by, scene);
    const Side below = SideAt(StepBeside(stated, by, -1.0));
    const Side above = SideAt(StepBeside(stated, by, 1.0));
    for (size_t i = 0; i < places.size(); ++i) {
      Derivative& derivative = derivatives[i * paths.by.size() + k];
      const OneSided under = LimitOf(below, here, places[i]);
      const OneSided over = LimitOf(above, here, places[i]);
      derivative = Join(under, over, Agree(under, over), ThresholdBetween(below, above));
      derivative.of = paths.of[i];
      derivative.by = by;
    }
  }
  return derivatives;
}

}  // namespace ricochet
