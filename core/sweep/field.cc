#include "core/sweep/field.h"

#include <cmath>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace ricochet {
namespace {

constexpr char kPhi[] = "pendulum.phi_rad";

// The restitution's value, switched to the definition `T`.
template <typename T>
double* Switch(Scene& scene) {
  if (!std::holds_alternative<T>(scene.restitution)) scene.restitution = T{};
  return &std::get<T>(scene.restitution).value;
}

// The scalar field at `path`; null if there is none.
double* FindScalar(const std::string& path, Scene& scene) {
  if (path == "friction.kinetic_coefficient") return &scene.friction.kinetic_coefficient;
  if (path == "friction.static_coefficient") {
    auto& coefficient = scene.friction.static_coefficient;
    if (!coefficient.has_value()) coefficient = 0.0;
    return &*coefficient;
  }
  if (path == "restitution.newton") return Switch<NewtonCoefficient>(scene);
  if (path == "restitution.poisson") return Switch<PoissonCoefficient>(scene);
  if (path == "restitution.energetic") return Switch<EnergeticCoefficient>(scene);
  auto* const pendulum = std::get_if<Pendulum>(&scene.system);
  if (pendulum == nullptr) return nullptr;
  if (path == "pendulum.inertia_kg_m2") return &pendulum->inertia_kg_m2;
  if (path == "pendulum.a_m") return &pendulum->a_m;
  if (path == "pendulum.b_m") return &pendulum->b_m;
  if (path == "pendulum.omega_minus_rad_s") return &pendulum->omega_minus_rad_s;
  return nullptr;
}

// The scene's own field behind a scalar path: the three definitions of restitution share one.
std::string Storage(const std::string& path) {
  return path.rfind("restitution.", 0) == 0 ? "restitution.coefficient" : path;
}

}  // namespace

void Field::Set(double value) const {
  if (const auto* scalar = std::get_if<Scalar>(&driver_)) {
    *scalar->target = value;
    return;
  }
  const auto& phi = std::get<Phi>(driver_);
  *phi.a = phi.distance * std::sin(value);
  *phi.b = phi.distance * std::cos(value);
}

absl::StatusOr<Field> ResolveField(const std::string& path, Scene& scene) {
  auto* const pendulum = std::get_if<Pendulum>(&scene.system);
  if (path == kPhi && pendulum != nullptr) {
    const double distance = std::hypot(pendulum->a_m, pendulum->b_m);
    return Field(Field::Phi{&pendulum->a_m, &pendulum->b_m, distance}, {"pendulum.a_m", "pendulum.b_m"});
  }
  double* const target = FindScalar(path, scene);
  if (target == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat("= \"", absl::CEscape(path), "\": must be one of ", absl::StrJoin(FieldPaths(), ", ")));
  }
  return Field(Field::Scalar{target}, {Storage(path)});
}

const std::vector<std::string>& FieldPaths() {
  static const std::vector<std::string> paths = {"pendulum.inertia_kg_m2",
                                                 "pendulum.a_m",
                                                 "pendulum.b_m",
                                                 "pendulum.omega_minus_rad_s",
                                                 kPhi,
                                                 "friction.kinetic_coefficient",
                                                 "friction.static_coefficient",
                                                 "restitution.newton",
                                                 "restitution.poisson",
                                                 "restitution.energetic"};
  return paths;
}

}  // namespace ricochet
