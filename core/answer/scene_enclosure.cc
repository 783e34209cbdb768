#include "core/answer/scene_enclosure.h"

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
#include "core/answer/planar_outcome.h"
#include "core/bounds/enclosure.h"
#include "core/contact/effective.h"
#include "core/contact/interval_reduction.h"
#include "core/contact/reduction.h"
#include "core/numerics/decimal.h"
#include "core/problem/scene_problem.h"
#include "core/scene/check.h"
#include "core/scene/field.h"

namespace ricochet {
namespace {

constexpr char kPhi[] = "pendulum.phi_rad";

// ---- The paths of ranges ----

// Why a field that an axis may drive has no range; null if it may have one.
const char* WhyNoRange(const Scene& scene, const std::string& path) {
  for (const char* effect : {"compliance.", "gravity.", "pin_moment.", "contact_acceleration."}) {
    if (absl::StartsWith(path, effect)) return "bounds are those of the impulsive impact, which does not know it";
  }
  if (absl::StartsWith(path, "restitution.")) return "bounds hold for every coefficient of restitution";
  if (absl::StartsWith(path, "friction.by_speed.")) return "an enclosure takes friction.by_speed as it stands";
  if (absl::StartsWith(path, "surface_velocity.") && IsOfRankOne(scene.system)) {
    return "with the surface in motion next to no velocity would be in the range of W, whose rank is one";
  }
  return nullptr;
}

std::vector<std::string> RangePaths(const Scene& scene) {
  std::vector<std::string> paths = FieldPaths(scene);
  const auto has_none = [&](const std::string& path) { return WhyNoRange(scene, path) != nullptr; };
  paths.erase(std::remove_if(paths.begin(), paths.end(), has_none), paths.end());
  return paths;
}

void CheckEnds(const Scene& scene, int index, const FieldRange& range, Check& check) {
  Scene with_field = scene;
  if (!ResolveField(range.path, with_field).ok()) return;
  const auto check_ends = [&](NumberRule rule) {
    check.Number(NumberPath{"ranges", index, "low"}, range.low, rule);
    check.Number(NumberPath{"ranges", index, "high"}, range.high, rule);
  };
  if (range.path == kPhi) check_ends(NumberRule::kFinite);
  VisitNumbers(with_field, [&](const NumberPath& path, double& /*number*/, NumberRule rule) {
    if (path.Text() == range.path) check_ends(rule);
  });
  check.Require(!(range.low > range.high), [&] {
    return MakeViolation(absl::StrCat("ranges[", index, "].high"), range.high,
                         absl::StrCat("be >= low = ", ShortestDecimal(range.low)));
  });
}

// The fields that a range drives.
std::vector<std::string> Drives(const Scene& scene, const FieldRange& range) {
  Scene copy = scene;
  const absl::StatusOr<Field> field = ResolveField(range.path, copy);
  return field.ok() ? field->sets() : std::vector<std::string>{range.path};
}

bool Overlap(const std::vector<std::string>& x, const std::vector<std::string>& y) {
  return std::any_of(x.begin(), x.end(),
                     [&](const std::string& path) { return std::find(y.begin(), y.end(), path) != y.end(); });
}

void CheckPath(const Scene& scene, absl::Span<const FieldRange> ranges, size_t index, Check& check) {
  const std::string& path = ranges[index].path;
  const std::string field = absl::StrCat("ranges[", index, "].path");
  const std::string found = absl::StrCat("= \"", absl::CEscape(path), "\": must ");
  const std::vector<std::string> all = FieldPaths(scene);
  const bool is_field = std::find(all.begin(), all.end(), path) != all.end();
  const char* const why_none = is_field ? WhyNoRange(scene, path) : nullptr;
  check.Require(why_none == nullptr, [&] {
    return Violation{field, absl::StrCat("= \"", path, "\": must not have a range: ", why_none)};
  });
  check.Require(is_field, [&] {
    return Violation{field, absl::StrCat(found, "be one of ", absl::StrJoin(RangePaths(scene), ", "))};
  });
  for (size_t i = 0; i < index; ++i) {
    if (!Overlap(Drives(scene, ranges[i]), Drives(scene, ranges[index]))) continue;
    check.Require(false, [&] {
      return Violation{field, path == ranges[i].path
                                  ? absl::StrCat(found, "not be that of ranges[", i, "] too")
                                  : absl::StrCat(found, "not drive what ranges[", i, "] drives, ", ranges[i].path)};
    });
    return;
  }
}

bool IsPlanar(const System& system) {
  const auto* const pair = std::get_if<BodyPair>(&system);
  const bool unset = std::holds_alternative<std::monostate>(system) ||
                     (pair != nullptr && std::holds_alternative<std::monostate>(pair->bodies));
  return !unset && TangentialDirections(system) == 1;
}

// ---- The box ----

// A scene with its ranges as numbers in intervals.
class UncertainScene {
 public:
  UncertainScene(const Scene& scene, absl::Span<const FieldRange> ranges) : box_{scene, scene, std::nullopt} {
    for (const FieldRange& range : ranges) {
      whole_.emplace_back(range.low, range.high);
      ends_.push_back(range.path == kPhi ? std::nullopt : EndsOf(range.path));
    }
    Set(whole_);
  }
  // Holds pointers into itself.
  UncertainScene(const UncertainScene&) = delete;
  UncertainScene& operator=(const UncertainScene&) = delete;

  const std::vector<Interval>& whole() const { return whole_; }
  const SceneBox& box() const { return box_; }

  void Set(absl::Span<const Interval> values) {
    for (size_t i = 0; i < values.size(); ++i) {
      if (!ends_[i].has_value()) {
        box_.phi = values[i];
        continue;
      }
      ends_[i]->first.Set(values[i].lower);
      ends_[i]->second.Set(values[i].upper);
    }
  }

 private:
  using Ends = std::optional<std::pair<Field, Field>>;

  Ends EndsOf(const std::string& path) {
    const absl::StatusOr<Field> low = ResolveField(path, box_.low);
    const absl::StatusOr<Field> high = ResolveField(path, box_.high);
    return std::pair(*low, *high);
  }

  SceneBox box_;
  std::vector<Interval> whole_;
  std::vector<Ends> ends_;  // Unset for phi.
};

// ---- Friction ----

// Both at the approach speed of the scenes, the factor enclosed over all of it.
struct FrictionForm {
  SlopeForm kinetic;
  std::optional<SlopeForm> fixed;  // Static friction; unset where it follows kinetic: it would not be the same scene's.
};

// `approach` is -v0; what separates does not matter.
FrictionForm FrictionAt(const SceneBox& box, const SlopeForm& approach, SlopeParameters& parameters) {
  const Friction& low = box.low.friction;
  const Friction& high = box.high.friction;
  const bool all_approach = approach.range().lower > 0.0;
  const SlopeForm speed = all_approach ? approach : SlopeForm(Hull(AtLeast(approach.range(), 0.0), 0.0));
  const SlopeForm factor = FactorAt(low.by_speed, speed);
  FrictionForm friction = {
      .kinetic = factor * SlopeForm::Parameter({low.kinetic_coefficient, high.kinetic_coefficient}, parameters),
      .fixed = std::nullopt};
  if (low.static_coefficient.has_value()) {
    friction.fixed = factor * SlopeForm::Parameter({*low.static_coefficient, *high.static_coefficient}, parameters);
  }
  return friction;
}

using ContactBox = std::variant<PlanarForm, PendulumBox>;

ContactBox WithFriction(const SceneBox& box, const IntervalPendulum& pendulum, SlopeParameters& parameters) {
  if (IsEmpty(pendulum.a)) return PendulumBox{.mu = pendulum.a};
  const FrictionForm friction = FrictionAt(box, -(pendulum.a * pendulum.omega_minus), parameters);
  PendulumBox contact = {.inertia = pendulum.inertia,
                         .a = pendulum.a,
                         .b = pendulum.b,
                         .omega_minus = pendulum.omega_minus,
                         .mu = AtLeast(friction.kinetic.range(), 0.0),
                         .mu_static = std::nullopt,
                         .slope = pendulum.slope};
  if (friction.fixed.has_value()) contact.mu_static = AtLeast(friction.fixed->range(), 0.0);
  return contact;
}

ContactBox WithFriction(const SceneBox& box, const ContactForm& contact, SlopeParameters& parameters) {
  const FrictionForm friction = FrictionAt(box, -contact.v0, parameters);
  return PlanarForm{.wtt = contact.wtt,
                    .wtn = contact.wtn,
                    .wnn = contact.wnn,
                    .u0 = contact.u0,
                    .v0 = contact.v0,
                    .mu = friction.kinetic,
                    .mu_static = friction.fixed,
                    .stick_slope = contact.stick_slope};
}

ContactBox ContactOf(const SceneBox& box, SlopeParameters& parameters) {
  parameters = SlopeParameters();
  return std::visit([&](const auto& reduction) { return WithFriction(box, reduction, parameters); },
                    Reduce(box, parameters));
}

// Whether its corners tell everything: a pendulum whose own numbers and friction's have ranges.
bool IsSolvedAtCorners(const SceneBox& box) {
  return std::holds_alternative<Pendulum>(box.low.system) && !box.phi.has_value() &&
         !box.low.friction.by_speed.has_value();
}

// Whether the W of every scene has rank one though those of its kind do not.
bool HasRankOneThroughout(const Scene& scene, absl::Span<const FieldRange> ranges) {
  if (IsOfRankOne(scene.system)) return false;
  const bool moves_w = std::any_of(ranges.begin(), ranges.end(), [](const FieldRange& range) {
    return range.low < range.high &&
           (absl::StartsWith(range.path, "planar_contact.w_") || absl::EndsWith(range.path, ".theta_rad"));
  });
  if (moves_w) return false;
  const planar::Problem problem = planar::MakeProblem(std::get<PlanarReduction>(Reduce(scene)), {}, {});
  return planar::Solve(problem).w_rank == 1;
}

absl::Status RankOneThroughout(const System& system) {
  const bool is_linkage = std::holds_alternative<Linkage>(system);
  return InvalidRequest({{is_linkage ? "linkage" : "planar_contact",
                          "has a W of rank one: must have rank two, with ranges, or be stated as a pendulum"}});
}

}  // namespace

std::vector<Violation> CheckRanges(const Scene& scene, absl::Span<const FieldRange> ranges) {
  if (ranges.empty()) return {};
  Check check(Check::Mode::kListing);
  check.Require(IsPlanar(scene.system), [] {
    return Violation{"system",
                     "has no enclosure: must be one of pendulum, planar_body, body_pair.planar, linkage, "
                     "planar_contact, with ranges"};
  });
  check.Require(!scene.surface_velocity.has_value() || !IsOfRankOne(scene.system), [] {
    return Violation{"surface_velocity", "is set: must not be, with ranges, for a system whose W has rank one"};
  });
  if (check.failed()) return std::move(check).violations();
  for (size_t i = 0; i < ranges.size(); ++i) {
    CheckPath(scene, ranges, i, check);
    CheckEnds(scene, static_cast<int>(i), ranges[i], check);
  }
  return std::move(check).violations();
}

absl::StatusOr<Enclosure> EncloseScene(const Scene& scene, absl::Span<const FieldRange> ranges,
                                       absl::FunctionRef<bool()> stopped) {
  if (HasRankOneThroughout(scene, ranges)) return RankOneThroughout(scene.system);
  UncertainScene uncertain(scene, ranges);
  SlopeParameters parameters;
  const auto contact_in = [&](absl::Span<const Interval> values) {
    uncertain.Set(values);
    return ContactOf(uncertain.box(), parameters);
  };
  const Enclosure enclosure = IsSolvedAtCorners(uncertain.box())
                                  ? Enclose(std::get<PendulumBox>(ContactOf(uncertain.box(), parameters)))
                                  : Enclose(uncertain.whole(), contact_in, EnclosureOptions(), stopped);
  if (stopped()) return absl::CancelledError("the enclosure was stopped by its caller");
  if (enclosure.attained.newton.lower > enclosure.attained.newton.upper) {
    return InvalidRequest({{"ranges",
                            "hold no valid scene: must hold one with det W >= 0, static friction >= kinetic and both "
                            ">= 0 at the approach speed"}});
  }
  return enclosure;
}

}  // namespace ricochet
