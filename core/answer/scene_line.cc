#include "core/answer/scene_line.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "core/answer/derivative_sides.h"
#include "core/numerics/elementary.h"
#include "core/scene/numbers.h"

namespace ricochet {
namespace {

// arctan(a/b) in (0, pi): the distance that is left becomes itself less its sine.
double AngleOf(const Pendulum& pendulum) {
  const double radius = Hypot(pendulum.a_m, pendulum.b_m);
  double angle = 1.5;
  constexpr int kEnough = 10;
  for (int i = 0; i < kEnough; ++i) {
    angle -= (pendulum.b_m * Sin(angle) - pendulum.a_m * Cos(angle)) / radius;
  }
  return angle;
}

}  // namespace

Scene Stating(const std::string& by, Scene scene) {
  auto& friction = scene.friction;
  if (by == "friction.static_coefficient" && !friction.static_coefficient.has_value()) {
    friction.static_coefficient = friction.kinetic_coefficient;
  }
  return scene;
}

SceneLine::SceneLine(Scene scene, const std::string& by)
    : scene_(Stating(by, std::move(scene))), field_(*ResolveField(by, scene_)) {
  if (const std::optional<double> number = NumberAt(scene_, by)) {
    number_ = *number;
  } else {  // The angle of a pendulum.
    number_ = AngleOf(std::get<Pendulum>(scene_.system));
  }
  double size = std::fabs(number_);
  if (size == 0.0) {
    VisitNumbers(scene_, [&](const NumberPath& path, double value, NumberRule /*rule*/) {
      if (HeadOf(path.Text()) == HeadOf(by)) size = std::max(size, std::fabs(value));
    });
  }
  unit_ = size == 0.0 ? 1.0 : std::ldexp(1.0, std::ilogb(size));
}

bool SceneLine::At(const SampleSource& source, double step, std::optional<Sample>& sample) {
  sample.reset();
  if (!field_.Set(number_ + step)) return true;
  return source.At(scene_, sample);
}

}  // namespace ricochet
