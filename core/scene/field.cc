#include "core/scene/field.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/contact/reduction.h"
#include "core/numerics/elementary.h"

namespace ricochet {
namespace {

constexpr char kPhi[] = "pendulum.phi_rad";

// Switches the restitution to the definition `T`.
template <typename T>
void Switch(Scene& scene) {
  if (!std::holds_alternative<T>(scene.restitution)) scene.restitution = T{};
}

// Gives the scene a surface at rest if it states none. A pair has no surface but its body 2.
void MakeSurface(Scene& scene) {
  if (scene.surface_velocity.has_value() || std::holds_alternative<BodyPair>(scene.system)) return;
  scene.surface_velocity = SurfaceVelocity{std::vector<double>(TangentialDirections(scene.system), 0.0), 0.0};
}

bool StartsWith(const std::string& text, const char* prefix) { return text.rfind(prefix, 0) == 0; }

// Adds the optional part of the scene that `path` names, if the scene leaves it out.
void MakePresent(const std::string& path, Scene& scene) {
  auto& static_coefficient = scene.friction.static_coefficient;
  if (path == "friction.static_coefficient" && !static_coefficient.has_value()) static_coefficient = 0.0;
  if (path == "restitution.newton") Switch<NewtonCoefficient>(scene);
  if (path == "restitution.poisson") Switch<PoissonCoefficient>(scene);
  if (path == "restitution.energetic") Switch<EnergeticCoefficient>(scene);
  if (StartsWith(path, "surface_velocity.")) MakeSurface(scene);
}

// The path under which the scene stores the field: the three definitions of restitution share one.
std::string Storage(const std::string& path) {
  const bool is_definition = StartsWith(path, "restitution.") && !StartsWith(path, "restitution.by_speed.");
  return is_definition ? "restitution.coefficient" : path;
}

}  // namespace

bool Field::Set(double value) const {
  if (const auto* scalar = std::get_if<Scalar>(&driver_)) return scalar->Set(value);
  const auto& phi = std::get<Phi>(driver_);
  const bool a_is_right = phi.a.Set(phi.distance * Sin(value));
  return phi.b.Set(phi.distance * Cos(value)) && a_is_right;
}

// Finds the number at `path`, which must exist.
Field::Scalar Field::Find(const std::string& path, Scene& scene) {
  Scalar found = {.number = nullptr, .rule = NumberRule::kFinite};
  VisitNumbers(scene, [&](const NumberPath& number_path, double& number, NumberRule rule) {
    if (number_path.Text() == path) found = {.number = &number, .rule = rule};
  });
  assert(found.number != nullptr);
  return found;
}

absl::StatusOr<Field> ResolveField(const std::string& path, Scene& scene) {
  auto* const pendulum = std::get_if<Pendulum>(&scene.system);
  if (path == kPhi && pendulum != nullptr) {
    const double distance = Hypot(pendulum->a_m, pendulum->b_m);
    return Field(Field::Phi{Field::Find("pendulum.a_m", scene), Field::Find("pendulum.b_m", scene), distance},
                 {"pendulum.a_m", "pendulum.b_m"});
  }
  const std::vector<std::string> paths = FieldPaths(scene);
  if (std::find(paths.begin(), paths.end(), path) == paths.end()) {
    return absl::InvalidArgumentError(
        absl::StrCat("= \"", absl::CEscape(path), "\": must be one of ", absl::StrJoin(paths, ", ")));
  }
  MakePresent(path, scene);
  return Field(Field::Find(path, scene), {Storage(path)});
}

std::vector<std::string> FieldPaths(const Scene& scene) {
  Scene all = scene;
  MakePresent("friction.static_coefficient", all);
  MakeSurface(all);
  all.restitution = std::monostate();
  std::vector<std::string> paths;
  VisitNumbers(all,
               [&](const NumberPath& path, double& /*number*/, NumberRule /*rule*/) { paths.push_back(path.Text()); });
  if (std::holds_alternative<Pendulum>(scene.system)) paths.emplace_back(kPhi);
  if (!std::holds_alternative<std::monostate>(scene.impact_law)) return paths;
  for (const char* definition : {"newton", "poisson", "energetic"}) {
    paths.push_back(absl::StrCat("restitution.", definition));
  }
  return paths;
}

}  // namespace ricochet
