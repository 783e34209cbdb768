#include "core/answer/derivatives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
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
constexpr char kStatic[] = "friction.static_coefficient";
// A number that is 0 has its sides here. The square of it is still a normal double.
constexpr double kBeside = 0x1p-300;
constexpr size_t kOutputs = kPlanarOutputPaths.size();

// --- Which numbers there are ---

// The paths of the velocities of the system itself after the impact, in the order of PlanarReduction::before.
struct VelocityPaths {
  std::vector<std::string>& paths;

  void operator()(std::monostate) const {}
  void operator()(const PlanarContact& /*contact*/) const {}
  void operator()(const SpatialContact& /*contact*/) const {}
  void operator()(const SpatialBody& /*body*/) const {}
  void operator()(const Pendulum& /*pendulum*/) const { List("rates_after_rad_s", 1); }
  void operator()(const Linkage& linkage) const { List("rates_after_rad_s", linkage.links.size()); }
  void operator()(const Mechanism& mechanism) const { List("rates_after", mechanism.rates.size()); }
  void operator()(const PlanarBody& /*body*/) const { Bodies(1); }
  void operator()(const BodyPair& /*pair*/) const { Bodies(2); }

 private:
  void List(const char* name, size_t count) const {
    for (size_t i = 0; i < count; ++i) paths.push_back(absl::StrCat(name, "[", i, "]"));
  }
  void Bodies(int count) const {
    for (int i = 0; i < count; ++i) {
      for (const char* velocity : {"linear_m_s[0]", "linear_m_s[1]", "angular_rad_s[0]"}) {
        paths.push_back(absl::StrCat("bodies_after[", i, "].", velocity));
      }
    }
  }
};

std::vector<std::string> OutputPaths(const Scene& scene) {
  std::vector<std::string> paths(kPlanarOutputPaths.begin(), kPlanarOutputPaths.end());
  std::visit(VelocityPaths{paths}, scene.system);
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

// --- Why there are none ---

const char* EffectWithout(const Scene& scene) {
  if (TangentialDirections(scene.system) == 2) return "an impact in space";
  if (!std::holds_alternative<std::monostate>(scene.impact_law)) return "an impact law";
  if (!scene.compliance.has_value()) return nullptr;
  return std::holds_alternative<std::monostate>(scene.compliance->normal)
             ? "tangential compliance"
             : "compliance, with which an impact takes time";
}

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
    const std::string_view path = kPlanarOutputPaths[i];
    const bool is_coefficient = path.starts_with("coefficients.");
    scale[i] = is_coefficient                 ? 1.0
               : path.starts_with("impulse.") ? impulse
               : path.starts_with("contact_") ? speed
                                              : impulse * speed;
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

// The rate of a side at place i, and else a clause that says why it has none.
struct Limit {
  std::optional<double> rate;
  const char* why_none = "";
};

Limit LimitOf(const Side& side, const Here& here, size_t i) {
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
bool Agree(double x, double y) { return std::fabs(x - y) <= 0x1p-40 * (std::fabs(x) + std::fabs(y)); }

Derivative Join(const Side& below, const Side& above, const Here& here, size_t i) {
  const Limit under = LimitOf(below, here, i);
  const Limit over = LimitOf(above, here, i);
  Derivative derivative = {.from_below = under.rate, .from_above = over.rate};
  if (under.rate.has_value() && over.rate.has_value() && Agree(*under.rate, *over.rate)) {
    derivative.kind = DerivativeKind::kTwoSided;
    derivative.value = derivative.from_below = derivative.from_above;
    return derivative;
  }
  const bool has_side = under.rate.has_value() || over.rate.has_value();
  derivative.kind = has_side ? DerivativeKind::kOneSided : DerivativeKind::kNone;
  derivative.threshold = ThresholdBetween(below, above);
  if (!under.rate.has_value()) absl::StrAppend(&derivative.reason, "Below, ", under.why_none, ".");
  if (!over.rate.has_value()) {
    absl::StrAppend(&derivative.reason, derivative.reason.empty() ? "" : " ", "Above, ", over.why_none, ".");
  }
  return derivative;
}

}  // namespace

DerivativePaths AllDerivativePaths(const Scene& scene) {
  DerivativePaths paths = {.of = OutputPaths(scene), .by = FieldPaths(scene)};
  paths.by.erase(std::remove_if(paths.by.begin(), paths.by.end(),
                                [&scene](const std::string& path) { return IsOtherDefinition(scene, path); }),
                 paths.by.end());
  return paths;
}

std::vector<Violation> CheckDerivatives(const Scene& scene, const DemandFields& demand, const DerivativePaths& paths) {
  std::vector<Violation> violations;
  if (const char* const effect = EffectWithout(scene)) {
    violations.push_back(
        MakeViolation("derivatives", "is set", absl::StrCat("not be for ", effect, ", which has no derivatives yet")));
    return violations;
  }
  if (!demand.excluded.empty()) {
    violations.push_back(MakeViolation("excluded", "is set", "not be, with derivatives: they leave nothing out"));
  }
  const DerivativePaths known = AllDerivativePaths(scene);
  CheckPaths("of", paths.of, known.of, "a velocity, an impulse, a work or a coefficient of the outcome", violations);
  CheckPaths("by", paths.by, known.by, "a number of the scene, with the definition of restitution that it states",
             violations);
  return violations;
}

std::vector<Derivative> DerivativesOf(const Scene& scene, const DerivativePaths& paths) {
  const std::vector<std::string> known = OutputPaths(scene);
  std::vector<size_t> places;
  for (const std::string& of : paths.of) {
    places.push_back(static_cast<size_t>(std::find(known.begin(), known.end(), of) - known.begin()));
  }
  const Here here = HereOf(scene);
  std::vector<Derivative> derivatives(paths.of.size() * paths.by.size());
  for (size_t k = 0; k < paths.by.size(); ++k) {
    const std::string& by = paths.by[k];
    Scene stated = scene;
    // Friction that is not stated for sticking is that for sliding.
    auto& static_coefficient = stated.friction.static_coefficient;
    if (by == kStatic && !static_coefficient.has_value()) static_coefficient = scene.friction.kinetic_coefficient;
    const Side below = SideAt(StepBeside(stated, by, -1.0));
    const Side above = SideAt(StepBeside(stated, by, 1.0));
    for (size_t i = 0; i < places.size(); ++i) {
      Derivative& derivative = derivatives[i * paths.by.size() + k];
      derivative = Join(below, above, here, places[i]);
      derivative.of = paths.of[i];
      derivative.by = by;
    }
  }
  return derivatives;
}

}  // namespace ricochet
