#include "core/scene/field.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "core/base/nearest.h"
#include "core/base/utf8.h"
#include "core/numerics/elementary.h"
#include "core/scene/check.h"

namespace ricochet {
namespace {

// Switches the restitution to the definition `T`.
template <typename T>
void Switch(Scene& scene) {
  if (!std::holds_alternative<T>(scene.restitution)) scene.restitution = T{};
}

// Gives the scene a surface with every velocity that it does not state, which is 0. A pair has no surface but its body
// 2.
void MakeSurface(Scene& scene) {
  if (std::holds_alternative<BodyPair>(scene.system)) return;
  if (!scene.surface_velocity.has_value()) scene.surface_velocity.emplace();
  std::vector<double>& tangential = scene.surface_velocity->tangential_m_s;
  if (tangential.empty()) tangential.resize(TangentialDirections(scene.system));
}

// Switches the scene to the definition of restitution that `path` names. Returns false if it names none.
bool SwitchRestitution(const std::string& path, Scene& scene) {
  if (path == "restitution.newton") {
    Switch<NewtonCoefficient>(scene);
  } else if (path == "restitution.poisson") {
    Switch<PoissonCoefficient>(scene);
  } else if (path == "restitution.energetic") {
    Switch<EnergeticCoefficient>(scene);
  } else {
    return false;
  }
  return true;
}

// Adds the optional part of the scene that `path` names, if the scene leaves it out.
void MakePresent(const std::string& path, Scene& scene) {
  auto& static_coefficient = scene.friction.static_coefficient;
  if (path == "friction.static_coefficient" && !static_coefficient.has_value()) static_coefficient = 0.0;
  if (absl::StartsWith(path, "surface_velocity.")) MakeSurface(scene);
}

// Removes WORD, or the index of a list, from the front of `text`. Returns false if something else stands there.
bool Take(absl::string_view word, absl::string_view& text) { return absl::ConsumePrefix(&text, word); }
bool TakeIndex(int index, absl::string_view& text) { return index < 0 || Take(absl::StrCat("[", index, "]"), text); }

// True if `text` is path.Text(), without making that text for a path that starts otherwise.
bool Matches(absl::string_view text, const NumberPath& path) {
  const bool has_prefix = *path.prefix != '\0';
  if (has_prefix && !(Take(path.prefix, text) && TakeIndex(path.entry, text) && Take(".", text))) return false;
  return Take(path.name, text) && TakeIndex(path.index, text) && text.empty();
}

// True for an entry below the diagonal of a mass matrix, which the one above it drives.
bool IsDrivenFromAbove(const System& system, const NumberPath& path) {
  const auto* const mechanism = std::get_if<Mechanism>(&system);
  if (mechanism == nullptr || std::strcmp(path.name, "mass_matrix") != 0 || mechanism->rates.empty()) return false;
  const auto n = static_cast<int>(mechanism->rates.size());
  return path.index / n > path.index % n;
}

absl::Status UnknownField(const std::string& path, const Scene& scene) {
  return absl::InvalidArgumentError(
      absl::StrCat(Found(path), ": must be a field that the scene states; `ricochet sweep --axis '?'` lists them",
                   DidYouMean(path, FieldPaths(scene))));
}

}  // namespace

bool Field::Set(double value) const {
  if (const auto* scalar = std::get_if<Scalar>(&driver_)) return scalar->Set(value);
  const auto& phi = std::get<Phi>(driver_);
  const bool a_is_right = phi.a.Set(phi.distance * Sin(value));
  return phi.b.Set(phi.distance * Cos(value)) && a_is_right && Holds(value, rule());
}

NumberRule Field::rule() const {
  const auto* const scalar = std::get_if<Scalar>(&driver_);
  return scalar == nullptr ? NumberRule::kHalfTurn : scalar->rule;
}

// Finds the number at `path`.
std::optional<Field::Scalar> Field::Find(const std::string& path, Scene& scene) {
  std::optional<Scalar> found;
  VisitNumbers(scene, [&](const NumberPath& number_path, double& number, NumberRule rule) {
    if (Matches(path, number_path)) found = Scalar{.number = &number, .rule = rule};
  });
  return found;
}

void Field::SetMirror(Mechanism& mechanism, Scalar& entry, std::vector<std::string>& sets) {
  std::vector<double>& mass = mechanism.mass_matrix;
  const size_t n = mechanism.rates.size();
  const std::less<> is_before;
  const bool is_of_mass = !is_before(entry.number, mass.data()) && is_before(entry.number, mass.data() + mass.size());
  if (!is_of_mass || mass.size() != n * n) return;
  const auto place = static_cast<size_t>(entry.number - mass.data());
  const size_t across = place % n * n + place / n;
  if (across == place) return;
  entry.mirror = &mass[across];
  sets.push_back(absl::StrCat("mechanism.mass_matrix[", across, "]"));
}

std::optional<Violation> WhyNoPhi(double value) {
  Check check(Check::Mode::kListing);
  check.Number({.prefix = "pendulum", .name = "phi_rad"}, value, NumberRule::kHalfTurn);
  if (!check.failed()) return std::nullopt;
  return std::move(check).violations().front();
}

absl::StatusOr<Field> ResolveField(const std::string& path, Scene& scene) {
  auto* const pendulum = std::get_if<Pendulum>(&scene.system);
  if (path == kPhi && pendulum != nullptr) {
    const double distance = Hypot(pendulum->a_m, pendulum->b_m);
    return Field(Field::Phi{*Field::Find("pendulum.a_m", scene), *Field::Find("pendulum.b_m", scene), distance},
                 {"pendulum.a_m", "pendulum.b_m"});
  }
  const bool has_law = !std::holds_alternative<std::monostate>(scene.impact_law);
  if (!has_law && SwitchRestitution(path, scene)) {
    return Field(*Field::Find(path, scene), {"restitution.coefficient"});  // The three definitions share one place.
  }
  const bool is_definition = absl::StartsWith(path, "restitution.") && !absl::StartsWith(path, "restitution.by_speed.");
  if (is_definition) return UnknownField(path, scene);
  const std::optional<SurfaceVelocity> stated = scene.surface_velocity;
  MakePresent(path, scene);
  std::optional<Field::Scalar> number = Field::Find(path, scene);
  if (number.has_value()) {
    std::vector<std::string> sets = {path};
    if (auto* const mechanism = std::get_if<Mechanism>(&scene.system)) Field::SetMirror(*mechanism, *number, sets);
    return Field(*number, sets);
  }
  scene.surface_velocity = stated;
  return UnknownField(path, scene);
}

std::string Found(const std::string& text) {
  return absl::StrCat("= \"", Excerpt(text), "\"",
                      text.size() > kMostExcerpt ? absl::StrCat(" (", text.size(), " bytes)") : "");
}

static std::vector<std::string> Paths(const Scene& scene, bool has_mirrored) {
  Scene all = scene;
  MakePresent("friction.static_coefficient", all);
  MakeSurface(all);
  all.restitution = std::monostate();
  std::vector<std::string> paths;
  VisitNumbers(all, [&](const NumberPath& path, double& /*number*/, NumberRule /*rule*/) {
    if (has_mirrored || !IsDrivenFromAbove(scene.system, path)) paths.push_back(path.Text());
  });
  if (std::holds_alternative<Pendulum>(scene.system)) paths.emplace_back(kPhi);
  if (!std::holds_alternative<std::monostate>(scene.impact_law)) return paths;
  for (const char* definition : {"newton", "poisson", "energetic"}) {
    paths.push_back(absl::StrCat("restitution.", definition));
  }
  return paths;
}

std::vector<std::string> FieldPaths(const Scene& scene) { return Paths(scene, false); }

std::vector<std::string> AllFieldPaths(const Scene& scene) { return Paths(scene, true); }

DrivenFields::DrivenFields(const std::vector<std::string>& paths, NameOf name_of, const char* member, Scene& scene) {
  std::map<std::string, size_t> driven_by;
  for (size_t i = 0; i < paths.size() && !IsFull(violations_); ++i) {
    const std::string place = absl::StrCat(name_of(i), member);
    absl::StatusOr<Field> field = ResolveField(paths[i], scene);
    if (!field.ok()) {
      violations_.push_back({place, std::string(field.status().message())});
      continue;
    }
    for (const std::string& target : field->sets()) {
      const auto [other, is_new] = driven_by.emplace(target, i);
      if (is_new) continue;
      const std::string& driver = paths[other->second];
      const std::string also = driver == paths[i] ? "" : absl::StrCat(", ", driver, ",");
      violations_.push_back(
          MakeViolation(place, Found(paths[i]),
                        absl::StrCat("not drive ", target, ", which ", name_of(other->second), also, " drives")));
    }
    // An angle sets two numbers from the base scene's distance, so their base values must be right.
    if (paths[i] != kPhi) {
      driven_.insert(paths[i]);
      driven_.insert(field->sets().begin(), field->sets().end());
    }
    fields_.push_back(*std::move(field));
  }
}

bool DrivenFields::CanBeCured(const Violation& violation) const {
  switch (violation.kind) {
    case ViolationKind::kShape:
      return false;
    case ViolationKind::kValue:
      return driven_.contains(violation.field) ||
             std::any_of(violation.tied_to.begin(), violation.tied_to.end(),
                         [this](const std::string& path) { return driven_.contains(path); });
    case ViolationKind::kContact:
      return !fields_.empty();
  }
  return false;
}

}  // namespace ricochet
