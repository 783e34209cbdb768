#include "core/answer/scene_enclosure.h"

#include <algorithm>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/base/decimal.h"
#include "core/bounds/enclosure.h"
#include "core/contact/delassus.h"
#include "core/contact/interval_reduction.h"
#include "core/contact/mechanism.h"
#include "core/contact/reduction.h"
#include "core/contact/scene_contact.h"
#include "core/scene/check.h"
#include "core/scene/field.h"

namespace ricochet {
namespace {

// ---- The paths of ranges ----

constexpr char kNotImpulsive[] = "bounds are those of the impulsive impact, which does not know it";

// Fields that an axis may drive but that have no range, by the start of their paths, and why.
struct FieldsWithoutRange {
  const char* prefix;
  const char* why;
};
constexpr FieldsWithoutRange kWithoutRange[] = {
    {"compliance.", kNotImpulsive},
    {"gravity.", kNotImpulsive},
    {"pin_moment.", kNotImpulsive},
    {"contact_acceleration.", kNotImpulsive},
    {"restitution.", "bounds hold for every coefficient of restitution"},
    {"friction.by_speed.", "an enclosure takes friction.by_speed as it stands"},
};

// Says why a field that an axis may drive has no range; null if it may have one.
const char* WhyNoRange(const Scene& scene, const std::string& path) {
  for (const FieldsWithoutRange& fields : kWithoutRange) {
    if (absl::StartsWith(path, fields.prefix)) return fields.why;
  }
  if (absl::StartsWith(path, "surface_velocity.") && IsOfRankOne(scene.system)) {
    return "an enclosure covers velocities in the range of a W of rank one, and the surface's motion takes them out of "
           "it";
  }
  return nullptr;
}

// Checks the ranges of one scene, of which it keeps a single copy for all of them to drive.
class RangeCheck {
 public:
  RangeCheck(const Scene& scene, absl::Span<const FieldRange> ranges, Check& check)
      : scene_(scene), ranges_(ranges), driven_(scene), check_(check) {}

  // Checks one range against those before it, which must have been checked.
  void CheckRange(int index) {
    const FieldRange& range = ranges_[static_cast<size_t>(index)];
    const absl::StatusOr<Field> field = ResolveField(range.path, driven_);
    CheckPath(index, range.path, field.status());
    CheckOthers(index, range.path, field.ok() ? field->sets() : std::vector<std::string>{range.path});
    if (field.ok()) CheckEnds(index, range, field->rule());
  }

 private:
  static std::string PathOf(int index) { return absl::StrCat("ranges[", index, "].path"); }

  void CheckPath(int index, const std::string& path, const absl::Status& resolved) {
    const char* const why_none = resolved.ok() ? WhyNoRange(scene_, path) : nullptr;
    check_.Require(why_none == nullptr, [&] {
      return MakeViolation(PathOf(index), Found(path), absl::StrCat("not have a range: ", why_none));
    });
    check_.Require(resolved.ok(), [&] { return Violation{PathOf(index), std::string(resolved.message())}; });
  }

  // `drives` are the fields that the range drives.
  void CheckOthers(int index, const std::string& path, const std::vector<std::string>& drives) {
    int first = index;
    for (const std::string& field : drives) first = std::min(first, driven_by_.emplace(field, index).first->second);
    check_.Require(first == index, [&] {
      const std::string& other_path = ranges_[static_cast<size_t>(first)].path;
      return MakeViolation(PathOf(index), Found(path),
                           path == other_path
                               ? absl::StrCat("not be that of ranges[", first, "] too")
                               : absl::StrCat("not drive what ranges[", first, "] drives, ", other_path));
    });
  }

  void CheckEnds(int index, const FieldRange& range, NumberRule rule) {
    check_.Number(NumberPath{"ranges", index, "low"}, range.low, rule);
    check_.Number(NumberPath{"ranges", index, "high"}, range.high, rule);
    check_.Require(!(range.low > range.high), [&] {
      return MakeViolation(absl::StrCat("ranges[", index, "].high"), range.high,
                           absl::StrCat("be >= low = ", ShortestDecimal(range.low)));
    });
  }

  const Scene& scene_;
  const absl::Span<const FieldRange> ranges_;
  Scene driven_;                                    // The scene with every optional field that a range drives.
  std::unordered_map<std::string, int> driven_by_;  // The first range that drives a field.
  Check& check_;
};

bool IsPlanar(const System& system) {
  const auto* const pair = std::get_if<BodyPair>(&system);
  const bool unset = std::holds_alternative<std::monostate>(system) ||
                     (pair != nullptr && std::holds_alternative<std::monostate>(pair->bodies));
  return !unset && TangentialDirections(system) == 1;
}

// ---- The box ----

// A scene whose ranges are intervals.
class UncertainScene {
 public:
  UncertainScene(const Scene& scene, absl::Span<const FieldRange> ranges) : box_{scene, scene, std::nullopt} {
    for (const FieldRange& range : ranges) {
      whole_.emplace_back(range.low, range.high);
      ends_.push_back(range.path == kPhi ? std::nullopt : EndsOf(range.path));
    }
    Set(whole_);
  }
  // It holds pointers into itself, so it cannot be copied.
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
  std::vector<Ends> ends_;  // An entry is unset for phi.
};

// ---- Friction ----

// The coefficients of friction, with the factor for speed enclosed over all approach speeds of the scenes.
struct AffineFriction {
  AffineInterval kinetic;
  // Unset if static friction equals kinetic friction, because two forms would not know that they are of one scene.
  std::optional<AffineInterval> static_of_its_own;
};

// `approach` is -v0. Scenes that separate do not matter.
AffineFriction FrictionAt(const SceneBox& box, const AffineInterval& approach, SlopeParameters& parameters) {
  const Friction& low = box.low.friction;
  const Friction& high = box.high.friction;
  const bool all_approach = approach.range().lower > 0.0;
  const AffineInterval speed = all_approach ? approach : AffineInterval(Hull(AtLeast(approach.range(), 0.0), 0.0));
  const AffineInterval factor = FactorAt(low.by_speed, speed);
  AffineFriction friction = {
      .kinetic = factor * AffineInterval::Parameter({low.kinetic_coefficient, high.kinetic_coefficient}, parameters),
      .static_of_its_own = std::nullopt};
  if (low.static_coefficient.has_value()) {
    friction.static_of_its_own =
        factor * AffineInterval::Parameter({*low.static_coefficient, *high.static_coefficient}, parameters);
  }
  return friction;
}

using ContactBox = std::variant<AffinePlanarBox, PendulumBox>;

ContactBox WithFriction(const SceneBox& box, const IntervalPendulum& pendulum, SlopeParameters& parameters) {
  if (IsEmpty(pendulum.a)) return PendulumBox{.mu = pendulum.a};
  const AffineFriction friction = FrictionAt(box, -(pendulum.a * pendulum.omega_minus), parameters);
  PendulumBox contact = {.inertia = pendulum.inertia,
                         .a = pendulum.a,
                         .b = pendulum.b,
                         .omega_minus = pendulum.omega_minus,
                         .mu = AtLeast(friction.kinetic.range(), 0.0),
                         .mu_static = std::nullopt,
                         .slope = pendulum.slope};
  if (friction.static_of_its_own.has_value()) contact.mu_static = AtLeast(friction.static_of_its_own->range(), 0.0);
  return contact;
}

ContactBox WithFriction(const SceneBox& box, const AffineContact& contact, SlopeParameters& parameters) {
  const AffineFriction friction = FrictionAt(box, -contact.v0, parameters);
  return AffinePlanarBox{.wtt = contact.wtt,
                         .wtn = contact.wtn,
                         .wnn = contact.wnn,
                         .u0 = contact.u0,
                         .v0 = contact.v0,
                         .mu = friction.kinetic,
                         .mu_static = friction.static_of_its_own,
                         .stick_slope = contact.stick_slope};
}

ContactBox ContactOf(const SceneBox& box, SlopeParameters& parameters, absl::FunctionRef<bool()> stopped) {
  parameters = SlopeParameters();
  return std::visit([&](const auto& reduction) { return WithFriction(box, reduction, parameters); },
                    Reduce(box, parameters, stopped));
}

// Tells whether the corners of the box are enough: the case of a pendulum whose own numbers and friction have ranges.
bool IsSolvedAtCorners(const SceneBox& box) {
  return std::holds_alternative<Pendulum>(box.low.system) && !box.phi.has_value() &&
         !box.low.friction.by_speed.has_value();
}

// Tells whether the box holds systems whose W may have another rank than the scene's. Masses, lengths and inertias do
// not change the rank of a linkage, nor does M that of a mechanism; a body's W has rank two.
bool RankMayVary(const SceneBox& box) {
  if (const auto* low = std::get_if<PlanarContact>(&box.low.system)) {
    const auto& high = std::get<PlanarContact>(box.high.system);
    return low->w_tt_per_kg < high.w_tt_per_kg || low->w_tn_per_kg < high.w_tn_per_kg ||
           low->w_nn_per_kg < high.w_nn_per_kg;
  }
  if (const auto* low = std::get_if<Mechanism>(&box.low.system)) {
    return low->jacobian != std::get<Mechanism>(box.high.system).jacobian;
  }
  if (const auto* low = std::get_if<Linkage>(&box.low.system)) {
    const auto& high = std::get<Linkage>(box.high.system);
    return !std::equal(low->links.begin(), low->links.end(), high.links.begin(),
                       [](const Link& x, const Link& y) { return x.theta_rad == y.theta_rad; });
  }
  return false;
}

// Tells whether the W of every scene has rank one though other systems of its kind have rank two.
bool HasRankOneThroughout(const Scene& scene, const SceneBox& box) {
  const auto* const mechanism = std::get_if<Mechanism>(&scene.system);
  if (mechanism != nullptr && FreeCoordinates(*mechanism).size() == 1) return true;
  if (IsOfRankOne(scene.system) || RankMayVary(box)) return false;
  const PlanarReduction reduction = std::get<PlanarReduction>(Reduce(scene));
  return PlanarDelassus{.tt = reduction.w[0], .tn = reduction.w[1], .nn = reduction.w[2]}.Rank() < 2;
}

absl::Status RankOneThroughout(const System& system) {
  const char* const field = std::holds_alternative<Linkage>(system)     ? "linkage"
                            : std::holds_alternative<Mechanism>(system) ? "mechanism"
                                                                        : "planar_contact";
  return InvalidRequest(
      {MakeViolation(field, "has a W of rank one", "have rank two, with ranges, or be stated as a pendulum")});
}

}  // namespace

std::vector<Violation> CheckRanges(const Scene& scene, absl::Span<const FieldRange> ranges) {
  if (ranges.empty()) return {};
  Check check(Check::Mode::kListing);
  check.Require(IsPlanar(scene.system), [] {
    return MakeViolation("system", "has no enclosure",
                         "be one of pendulum, planar_body, body_pair.planar, linkage, "
                         "planar_contact, mechanism in a plane, with ranges");
  });
  check.Require(!scene.surface_velocity.has_value() || !IsOfRankOne(scene.system), [] {
    return MakeViolation("surface_velocity", "is set",
                         "not be, with ranges, for a system whose W has rank one: an enclosure "
                         "covers velocities in the range of W");
  });
  if (check.failed()) return std::move(check).violations();
  RangeCheck range_check(scene, ranges, check);
  for (size_t i = 0; i < ranges.size() && !check.IsFull(); ++i) range_check.CheckRange(static_cast<int>(i));
  return std::move(check).violations();
}

absl::StatusOr<Enclosure> EncloseScene(const Scene& scene, absl::Span<const FieldRange> ranges, int64_t most_boxes,
                                       absl::FunctionRef<bool()> stopped) {
  EnclosureOptions options;
  options.budget = std::min(options.budget, most_boxes);
  UncertainScene uncertain(scene, ranges);
  if (HasRankOneThroughout(scene, uncertain.box())) return RankOneThroughout(scene.system);
  SlopeParameters parameters;
  const auto contact_in = [&](absl::Span<const Interval> values) {
    uncertain.Set(values);
    return ContactOf(uncertain.box(), parameters, stopped);
  };
  const Enclosure enclosure = IsSolvedAtCorners(uncertain.box())
                                  ? Enclose(std::get<PendulumBox>(ContactOf(uncertain.box(), parameters, stopped)))
                                  : Enclose(uncertain.whole(), contact_in, options, stopped);
  // A stop leaves the last box half reduced, so that the enclosure means nothing.
  if (stopped()) return absl::CancelledError("the enclosure was stopped by its caller");
  if (enclosure.attained.newton.lower > enclosure.attained.newton.upper) {
    return InvalidRequest({MakeViolation("ranges", "hold no valid scene",
                                         "hold one with det W >= 0, static friction >= kinetic and both >= 0 at the "
                                         "approach speed")});
  }
  return enclosure;
}

}  // namespace ricochet
