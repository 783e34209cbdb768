// Random scenes: every system with every set of effects that it may have, and numbers at random.
//
// The scenes of one kind have the same parts and differ in numbers alone, so that a sweep or a batch can have one of
// them in each row. Nearly all are valid, and most of them approach.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_RANDOM_SCENES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_RANDOM_SCENES_H_

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "ricochet/scene.h"

namespace ricochet {

class RandomScenes {
 public:
  explicit RandomScenes(uint64_t seed) : random_(seed) {}

  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  // 10 to a power between both arguments.
  double Power(double low, double high) { return std::pow(10.0, Uniform(low, high)); }
  bool OneIn(int count) { return std::uniform_int_distribution<int>(1, count)(random_) == 1; }
  // A velocity along the normal: towards the surface in nine cases of ten.
  double Towards() { return OneIn(10) ? Uniform(0.0, 1.0) : -Power(-1.0, 0.7); }
  std::vector<double> Three(double most) { return {Uniform(-most, most), Uniform(-most, most), Uniform(-most, most)}; }

  PlanarBody Body() {
    return {.mass_kg = Power(-0.5, 0.5),
            .inertia_com_kg_m2 = Power(-2.0, 0.0),
            .offset_t_m = Uniform(-0.3, 0.3),
            .offset_n_m = Uniform(-0.5, -0.1),
            .velocity_t_m_s = Uniform(-2.0, 2.0),
            .velocity_n_m_s = Towards(),
            .rate_rad_s = Uniform(-1.0, 1.0)};
  }
  SpatialBody BodyInSpace() {
    const double inertia = Power(-2.0, 0.0);
    SpatialBody body = {.mass_kg = Power(-0.5, 0.5),
                        .inertia_com_kg_m2 = {1.0, 0.1, 0.05, 1.2, -0.1, 0.9},
                        .offset_m = Three(0.3),
                        .linear_m_s = Three(2.0),
                        .angular_rad_s = Three(1.0)};
    for (double& entry : body.inertia_com_kg_m2) entry *= inertia * Uniform(0.95, 1.05);
    body.linear_m_s[2] = Towards();
    return body;
  }
  Linkage Chain() {
    Linkage chain;
    for (int i = 0; i < 2; ++i) {
      chain.links.push_back({.length_m = Uniform(0.5, 1.5),
                             .mass_kg = Power(-0.5, 0.5),
                             .com_m = Uniform(0.1, 0.5),
                             .inertia_com_kg_m2 = Power(-2.0, 0.0),
                             .theta_rad = Uniform(-3.0, 3.0),
                             .rate_rad_s = Uniform(-3.0, 3.0)});
    }
    return chain;
  }
  PlanarContact Contact() {
    const double tt = Power(-0.5, 0.5);
    const double nn = Power(-0.5, 0.5);
    return {.w_tt_per_kg = tt,
            .w_tn_per_kg = Uniform(-0.95, 0.95) * std::sqrt(tt * nn),
            .w_nn_per_kg = nn,
            .tangential_m_s = Uniform(-2.0, 2.0),
            .normal_m_s = Towards()};
  }
  SpatialContact ContactInSpace() {
    const std::vector<double> a = Three(1.0), b = Three(1.0), c = Three(1.0);
    const auto dot = [](const std::vector<double>& x, const std::vector<double>& y) {
      return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    };
    return {.w_per_kg = {dot(a, a) + 0.1, dot(a, b), dot(a, c), dot(b, b) + 0.1, dot(b, c), dot(c, c) + 0.1},
            .tangential_m_s = {Uniform(-2.0, 2.0), Uniform(-2.0, 2.0)},
            .normal_m_s = Towards()};
  }
  // M = A A^T + 0.3.
  Mechanism Arm(bool in_space) {
    const size_t n = in_space ? 4 : 3;
    std::vector<std::vector<double>> a(n);
    Mechanism arm;
    for (std::vector<double>& row : a) {
      for (size_t k = 0; k < n; ++k) row.push_back(Uniform(-1.0, 1.0));
    }
    for (size_t i = 0; i < n; ++i) {
      for (size_t j = 0; j < n; ++j) {
        double entry = i == j ? 0.3 : 0.0;
        for (size_t k = 0; k < n; ++k) entry += a[i][k] * a[j][k];
        arm.mass_matrix.push_back(entry);
      }
      arm.rates.push_back(Uniform(-2.0, 2.0));
    }
    for (size_t i = 0; i < (in_space ? 3 : 2) * n; ++i) arm.jacobian.push_back(Uniform(-1.0, 1.0));
    return arm;
  }
  Pendulum Bar() {
    return {.inertia_kg_m2 = Power(-1.0, 1.0),
            .a_m = Uniform(0.05, 1.0),
            .b_m = Uniform(-1.0, 1.0),
            .omega_minus_rad_s = OneIn(10) ? 0.5 : -Power(-1.0, 0.7)};
  }
  Friction Rubbing() { return {.kinetic_coefficient = OneIn(10) ? 0.0 : Uniform(0.0, 1.0)}; }
  double Coefficient() { return OneIn(10) ? 1.0 : Uniform(0.05, 1.0); }

 private:
  std::mt19937_64 random_;
};

// Scenes with the same parts.
struct SceneKind {
  std::string name;
  bool takes_time = false;  // Every answer is that of the model of finite duration.
  std::function<Scene(RandomScenes& random)> make;
};

// A system, and what only systems of its kind may have.
struct RandomSystem {
  std::string name;
  bool in_space = false;
  bool has_surface = false;  // The surface may move, whatever the numbers of the system are.
  System (*make)(RandomScenes& random);
  FiniteForces (*forces)(RandomScenes& random);
  bool has_coordinates = false;  // Some may be held.
};

inline std::vector<RandomSystem> RandomSystems() {
  using R = RandomScenes;
  const auto none = [](R& /*r*/) -> FiniteForces { return std::monostate(); };
  const auto gravity = [](R& r) -> FiniteForces { return Gravity{r.Uniform(-5.0, 5.0), r.Uniform(-10.0, 0.0)}; };
  const auto moment = [](R& r) -> FiniteForces { return PinMoment{r.Uniform(-5.0, 5.0)}; };
  const auto acceleration = [](R& r) -> FiniteForces {
    return ContactAcceleration{r.Uniform(-5.0, 5.0), r.Uniform(-10.0, 0.0)};
  };
  return {
      {"pendulum", false, false, [](R& r) -> System { return r.Bar(); }, moment},
      {"planar_body", false, true, [](R& r) -> System { return r.Body(); }, gravity},
      {"planar_pair", false, false,
       [](R& r) -> System {
         return BodyPair{PlanarPair{r.Body(), r.Body()}};
       },
       gravity},
      {"linkage", false, false, [](R& r) -> System { return r.Chain(); }, gravity},
      {"planar_contact", false, true, [](R& r) -> System { return r.Contact(); }, acceleration},
      {"mechanism", false, false, [](R& r) -> System { return r.Arm(false); }, none, true},
      {"mechanism_in_space", true, false, [](R& r) -> System { return r.Arm(true); }, none, true},
      {"spatial_body", true, true, [](R& r) -> System { return r.BodyInSpace(); }, none},
      {"spatial_pair", true, false,
       [](R& r) -> System {
         return BodyPair{SpatialPair{r.BodyInSpace(), r.BodyInSpace()}};
       },
       none},
      {"spatial_contact", true, true, [](R& r) -> System { return r.ContactInSpace(); }, none},
  };
}

// Every kind of scene of a system.
inline std::vector<SceneKind> SceneKinds(const RandomSystem& system) {
  using R = RandomScenes;
  const auto rigid = [system](R& r) -> Scene {
    return {.system = system.make(r), .friction = r.Rubbing(), .restitution = EnergeticCoefficient{r.Coefficient()}};
  };
  std::vector<SceneKind> kinds;
  const auto add = [&](const std::string& name, bool takes_time, auto change) {
    kinds.push_back({system.name + " " + name, takes_time, [rigid, change](R& r) {
                       Scene scene = rigid(r);
                       change(r, scene);
                       return scene;
                     }});
  };
  add("energetic", false, [](R&, Scene&) {});
  add("newton", false, [](R& r, Scene& scene) { scene.restitution = NewtonCoefficient{r.Coefficient()}; });
  add("poisson", false, [](R& r, Scene& scene) { scene.restitution = PoissonCoefficient{r.Coefficient()}; });
  add("static friction", false, [](R& r, Scene& scene) {
    scene.friction.static_coefficient = scene.friction.kinetic_coefficient + r.Uniform(0.0, 0.5);
  });
  add("by speed", false, [](R& r, Scene& scene) {
    scene.friction.by_speed = SpeedTable{{0.5, 2.0}, {1.0, r.Uniform(0.2, 1.0)}};
    scene.restitution_by_speed = PowerLaw{r.Uniform(0.0, 0.1), 0.5};
  });
  if (system.has_surface) {
    add("moving surface", false, [system](R& r, Scene& scene) {
      scene.surface_velocity = SurfaceVelocity{std::vector<double>(system.in_space ? 2 : 1, r.Uniform(-1.0, 1.0)), 0.0};
    });
  }
  if (system.has_coordinates) {
    add("held coordinate", false, [](R&, Scene& scene) { std::get<Mechanism>(scene.system).kept_coordinates = {1}; });
  }
  if (system.in_space) return kinds;
  const auto spring = [](std::optional<double> ratio, const NormalSpring& normal) {
    return Compliance{.tangential_ratio_squared = ratio, .normal = normal};
  };
  add("tangential spring", false, [=](R& r, Scene& scene) { scene.compliance = spring(r.Power(-0.3, 0.5), {}); });
  add("linear spring", false, [=](R& r, Scene& scene) { scene.compliance = spring({}, LinearSpring{r.Power(4, 8)}); });
  add("hertz spring", false, [=](R& r, Scene& scene) { scene.compliance = spring({}, HertzSpring{r.Power(5, 9)}); });
  add("two springs", false,
      [=](R& r, Scene& scene) { scene.compliance = spring(r.Power(-0.3, 0.5), LinearSpring{r.Power(4, 8)}); });
  add("damped spring", true, [=](R& r, Scene& scene) {
    scene.restitution = std::monostate();
    scene.compliance = spring({}, HuntCrossleySpring{r.Power(4, 8), 1.5, r.Uniform(0.0, 1.0)});
  });
  add("spring and forces", true, [=](R& r, Scene& scene) {
    scene.compliance = spring({}, LinearSpring{r.Power(4, 8)});
    scene.finite_forces = system.forces(r);
  });
  const auto add_law = [&](const std::string& name, auto law) {
    add(name, false, [law](R& r, Scene& scene) {
      scene.restitution = std::monostate();
      scene.impact_law = law(r);
    });
  };
  add_law("whittaker", [](R& r) { return WhittakerLaw{r.Coefficient()}; });
  add_law("kane_levinson", [](R& r) { return KaneLevinsonLaw{r.Coefficient()}; });
  add_law("brach", [](R& r) { return BrachLaw{r.Coefficient(), r.Uniform(-0.3, 0.3)}; });
  add_law("chatterjee_ruina", [](R& r) { return ChatterjeeRuinaLaw{r.Coefficient(), r.Uniform(-1.0, 1.0)}; });
  return kinds;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_RANDOM_SCENES_H_
