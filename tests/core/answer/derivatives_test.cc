// Derivatives against difference quotients in arbitrary precision: the scene is reduced to its contact and its impact
// is followed in balls of 1,600 bits, once as it is and once with one number moved by 2^-300 of its size.

#include "core/answer/derivatives.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/answer/derivative_paths.h"
#include "core/answer/exact_derivatives.h"
#include "core/contact/mechanism.h"
#include "core/contact/scene_contact.h"
#include "core/plan/scene_problem.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"
#include "ricochet/solver.h"
#include "tests/support/oracles/planar_oracle.h"
#include "tests/support/scenes/random_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

constexpr slong kBits = 1600;
constexpr double kStep = 0x1p-300;

Ball Exact(double x) { return Ball(x, kBits); }

// --- The reference ---

using Matrix = std::vector<std::vector<Ball>>;

// M^-1 B by elimination; M is positive definite.
Matrix Solve(Matrix m, Matrix b) {
  const size_t n = m.size();
  for (size_t k = 0; k < n; ++k) {
    for (size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const Ball factor = m[i][k] / m[k][k];
      for (size_t j = k; j < n; ++j) m[i][j] = m[i][j] - factor * m[k][j];
      for (Ball& entry : b[i]) entry = entry - factor * b[k][static_cast<size_t>(&entry - b[i].data())];
    }
  }
  for (size_t k = 0; k < n; ++k) {
    for (Ball& entry : b[k]) entry = entry / m[k][k];
  }
  return b;
}

// A scene whose numbers are balls, one of them moved.
class ExactScene {
 public:
  ExactScene(const Scene& scene, const std::string& moved, double side) : scene_(scene) {
    VisitNumbers(scene, [&](const NumberPath& path, double number, NumberRule /*rule*/) {
      numbers_[path.Text()] = Exact(number);
    });
    const double now = moved == "pendulum.phi_rad" ? 1.0 : numbers_.at(moved).Nearest();
    h_ = Exact(side * kStep * (now == 0.0 ? 1.0 : std::fabs(now)));
    if (moved == "pendulum.phi_rad") {
      const Ball a = numbers_.at("pendulum.a_m"), b = numbers_.at("pendulum.b_m");
      numbers_["pendulum.a_m"] = a * Cos(h_) + b * Sin(h_);
      numbers_["pendulum.b_m"] = b * Cos(h_) - a * Sin(h_);
    } else {
      Move(moved);
    }
    Reduce();
  }

  // The numbers of the outcome, by path.
  std::map<std::string, Ball> Outcome() {
    const Ball speed = v0_ < Ball(0.0) ? -v0_ : Exact(0.0);
    const Ball friction = Factor(scene_.friction.by_speed, "friction.by_speed.", speed);
    const Ball kinetic = At("friction.kinetic_coefficient");
    const Ball sticking = scene_.friction.static_coefficient.has_value() ? At("friction.static_coefficient") : kinetic;
    const SceneContact contact(scene_);
    planar::Problem problem =
        planar::MakeProblem(std::get<PlanarReduction>(contact.reduction), scene_.restitution, contact.coefficients);
    problem.v0 = -1.0;
    const char* const definition[] = {"", "restitution.newton", "restitution.poisson", "restitution.energetic"};
    const planar::ExactImpact x = planar::SolveExactly(
        problem, {.wtt = w_[0],
                  .wtn = w_[1],
                  .wnn = w_[2],
                  .u0 = u0_,
                  .v0 = v0_,
                  .mu = kinetic * friction,
                  .mu_static = sticking * friction,
                  .coefficient = At(definition[scene_.restitution.index()]) *
                                 Factor(scene_.restitution_by_speed, "restitution.by_speed.", speed)});
    conditioning = x.conditioning.Nearest();
    const Ball f = x.end().f, tau = x.end().tau;
    const Ball tangential_work = x.work_tangential_compression + x.work_tangential_restitution;
    std::map<std::string, Ball> out = {{"coefficients.newton", x.newton},
                                       {"coefficients.poisson", x.poisson},
                                       {"coefficients.energetic", x.energetic},
                                       {"coefficients.tangential", f / tau},
                                       {"contact_velocity_after.tangential_m_s[0]", x.end().u},
                                       {"contact_velocity_after.normal_m_s", x.end().v},
                                       {"impulse.normal_compression_n_s", x.tau_compression},
                                       {"impulse.normal_total_n_s", tau},
                                       {"impulse.tangential_n_s[0]", f},
                                       {"work.normal_compression_j", x.work_normal_compression},
                                       {"work.normal_restitution_j", x.work_normal_restitution},
                                       {"work.tangential_compression_j", x.work_tangential_compression},
                                       {"work.tangential_restitution_j", x.work_tangential_restitution},
                                       {"work.normal_total_j", x.work_normal_compression + x.work_normal_restitution},
                                       {"work.tangential_total_j", tangential_work},
                                       {"work.friction_dissipation_j", -tangential_work},
                                       {"energy_change_j", x.energy_change}};
    const std::vector<std::string> paths = AllDerivativePaths(scene_).of;
    const size_t first = out.size();
    for (size_t i = 0; i < rates_.size(); ++i) out[paths[first + i]] = rates_[i] + x_[i][0] * f + x_[i][1] * tau;
    if (!std::holds_alternative<Mechanism>(scene_.system)) return out;
    for (size_t i = 0; i < rates_.size(); ++i) {
      Ball momentum = Exact(0.0);
      for (size_t k = 0; k < rates_.size(); ++k) momentum = momentum + m_[i][k] * (x_[k][0] * f + x_[k][1] * tau);
      out["momentum_change[" + std::to_string(i) + "]"] = momentum;
    }
    return out;
  }

  const Ball& h() const { return h_; }
  double conditioning = 0.0;  // The impact has it, as tests/support/oracles/planar_oracle.h defines it.

 private:
  Ball At(const std::string& path) const { return numbers_.at(path); }
  Ball At(const std::string& part, const char* name) const { return numbers_.at(part + "." + name); }

  void Move(const std::string& path) {
    numbers_[path] = numbers_.at(path) + h_;
    const std::string prefix = "mechanism.mass_matrix[";
    if (path.rfind(prefix, 0) != 0) return;
    const size_t n = std::get<Mechanism>(scene_.system).rates.size();
    const auto place = static_cast<size_t>(std::stoi(path.substr(prefix.size())));
    const size_t across = place % n * n + place / n;
    numbers_[prefix + std::to_string(across) + "]"] = numbers_.at(path);
  }

  void AddBody(const std::string& part, double side) {
    const size_t at = m_.size();
    for (std::vector<Ball>& row : m_) row.resize(at + 3, Exact(0.0));
    m_.resize(at + 3, std::vector<Ball>(at + 3, Exact(0.0)));
    m_[at][at] = m_[at + 1][at + 1] = At(part, "mass_kg");
    m_[at + 2][at + 2] = At(part, "inertia_com_kg_m2");
    const Ball sign = Exact(side);
    jt_.push_back({sign, Exact(0.0)});
    jt_.push_back({Exact(0.0), sign});
    jt_.push_back({-sign * At(part, "offset_n_m"), sign * At(part, "offset_t_m")});
    for (const char* name : {"velocity_t_m_s", "velocity_n_m_s", "rate_rad_s"}) rates_.push_back(At(part, name));
  }

  void AddLinks(size_t n) {
    const auto at = [this](size_t i, const char* name) { return At("linkage.links[" + std::to_string(i) + "]", name); };
    m_.assign(n, std::vector<Ball>(n, Exact(0.0)));
    // Body k moves by length_i for each joint i before it and by com_k itself.
    for (size_t k = 0; k < n; ++k) {
      const auto arm = [&](size_t i) { return i < k ? at(i, "length_m") : at(k, "com_m"); };
      for (size_t i = 0; i <= k; ++i) {
        for (size_t j = 0; j <= k; ++j) {
          m_[i][j] = m_[i][j] + at(k, "mass_kg") * arm(i) * arm(j) * Cos(at(i, "theta_rad") - at(j, "theta_rad"));
        }
      }
      m_[k][k] = m_[k][k] + at(k, "inertia_com_kg_m2");
    }
    for (size_t i = 0; i < n; ++i) {
      jt_.push_back({at(i, "length_m") * Cos(at(i, "theta_rad")), at(i, "length_m") * Sin(at(i, "theta_rad"))});
      rates_.push_back(at(i, "rate_rad_s"));
    }
  }

  void AddMechanism(const Mechanism& mechanism) {
    const size_t n = mechanism.rates.size();
    const auto at = [this](const char* list, size_t i) {
      return At(std::string("mechanism.") + list + "[" + std::to_string(i) + "]");
    };
    for (size_t i = 0; i < n; ++i) {
      m_.emplace_back();
      for (size_t j = 0; j < n; ++j) m_[i].push_back(at("mass_matrix", i * n + j));
      jt_.push_back({at("jacobian", i), at("jacobian", n + i)});
      rates_.push_back(at("rates", i));
    }
  }

  void Reduce() {
    std::vector<size_t> free;
    if (std::holds_alternative<PlanarContact>(scene_.system)) {
      const std::string part = "planar_contact";
      w_ = {At(part, "w_tt_per_kg"), At(part, "w_tn_per_kg"), At(part, "w_nn_per_kg")};
      u0_ = At(part, "tangential_m_s");
      v0_ = At(part, "normal_m_s");
    } else {
      if (std::holds_alternative<Pendulum>(scene_.system)) {
        m_ = {{At("pendulum.inertia_kg_m2")}};
        jt_ = {{At("pendulum.b_m"), At("pendulum.a_m")}};
        rates_ = {At("pendulum.omega_minus_rad_s")};
      }
      if (std::holds_alternative<PlanarBody>(scene_.system)) AddBody("planar_body", 1.0);
      if (std::holds_alternative<BodyPair>(scene_.system)) {
        AddBody("body_pair.planar.body_1", 1.0);
        AddBody("body_pair.planar.body_2", -1.0);
      }
      if (const auto* linkage = std::get_if<Linkage>(&scene_.system)) AddLinks(linkage->links.size());
      if (const auto* mechanism = std::get_if<Mechanism>(&scene_.system)) AddMechanism(*mechanism);
      ReduceMotion();
    }
    if (scene_.surface_velocity.has_value()) {
      u0_ = u0_ - At("surface_velocity.tangential_m_s[0]");
      v0_ = v0_ - At("surface_velocity.normal_m_s");
    }
  }

  void ReduceMotion() {
    std::vector<size_t> free;
    for (size_t i = 0; i < rates_.size(); ++i) free.push_back(i);
    if (const auto* mechanism = std::get_if<Mechanism>(&scene_.system)) {
      free.clear();
      for (const auto i : FreeCoordinates(*mechanism)) free.push_back(static_cast<size_t>(i));
    }
    Matrix m, jt;
    for (const size_t i : free) {
      m.emplace_back();
      for (const size_t j : free) m.back().push_back(m_[i][j]);
      jt.push_back(jt_[i]);
    }
    const Matrix x = Solve(m, jt);
    x_.assign(rates_.size(), {Exact(0.0), Exact(0.0)});
    u0_ = v0_ = Exact(0.0);
    w_.assign(3, Exact(0.0));
    for (size_t k = 0; k < free.size(); ++k) {
      x_[free[k]] = x[k];
      w_[0] = w_[0] + jt[k][0] * x[k][0];
      w_[1] = w_[1] + jt[k][0] * x[k][1];
      w_[2] = w_[2] + jt[k][1] * x[k][1];
    }
    for (size_t i = 0; i < rates_.size(); ++i) {
      u0_ = u0_ + jt_[i][0] * rates_[i];
      v0_ = v0_ + jt_[i][1] * rates_[i];
    }
  }

  Ball Factor(const std::optional<SpeedDependence>& dependence, const std::string& prefix, const Ball& speed) const {
    if (!dependence.has_value()) return Exact(1.0);
    if (std::holds_alternative<PowerLaw>(*dependence)) {
      const std::string part = prefix + "power_law";
      return Exact(1.0) - At(part, "alpha") * Pow(speed, At(part, "exponent"));
    }
    const size_t count = std::get<SpeedTable>(*dependence).factor.size();
    const auto at = [&](const char* list, size_t i) {
      return At(prefix + "table." + list + "[" + std::to_string(i) + "]");
    };
    if (speed <= at("speed_m_s", 0)) return at("factor", 0);
    for (size_t i = 1; i < count; ++i) {
      if (!(speed <= at("speed_m_s", i))) continue;
      const Ball share = (speed - at("speed_m_s", i - 1)) / (at("speed_m_s", i) - at("speed_m_s", i - 1));
      return at("factor", i - 1) + share * (at("factor", i) - at("factor", i - 1));
    }
    return at("factor", count - 1);
  }

  Scene scene_;
  std::map<std::string, Ball> numbers_;
  Ball h_;
  Matrix m_, jt_, x_;
  std::vector<Ball> rates_, w_;
  Ball u0_, v0_;
};

// The difference quotients of all numbers of the outcome, from one side.
std::map<std::string, Ball> Quotients(const Scene& scene, const std::string& by, double side) {
  ExactScene moved(scene, by, side);
  // A step of 2^-600 beside 2^-300 tells a derivative from a jump at the scene itself.
  std::map<std::string, Ball> far = moved.Outcome();
  ExactScene near(scene, by, side * 0x1p-40);
  const std::map<std::string, Ball> start = near.Outcome();
  for (auto& [path, number] : far) number = (number - start.at(path)) / (moved.h() - near.h());
  return far;
}

// The distance of a derivative from the exact one, relative to it, or to what is typical of its number.
double ErrorOf(double derivative, const Ball& exact, double typical) {
  const double size = std::max(std::fabs(exact.Nearest()), typical);
  return std::fabs((Exact(derivative) - exact).Nearest()) / size;
}

// --- Every model's random scenes ---

class EverySystem : public testing::TestWithParam<size_t> {};

TEST_P(EverySystem, DerivativesAreDifferenceQuotients) {
  const RandomSystem system = RandomSystems()[GetParam()];
  RandomScenes random(20 + GetParam());
  int compared = 0;
  int above_limit = 0;
  for (const SceneKind& kind : SceneKinds(system)) {
    for (int i = 0; i < 1500; ++i) {
      const Scene scene = kind.make(random);
      if (!Validate(scene).empty()) continue;
      if (WhyNotExact(scene) != nullptr) continue;
      const DerivativePaths all = AllDerivativePaths(scene);
      const SceneContact contact(scene);
      if (ApproachSpeed(contact.reduction) == 0.0) continue;
      // A different number of the scene each time.
      DerivativePaths paths = {.of = all.of, .by = {all.by[static_cast<size_t>(i) % all.by.size()]}};
      if (paths.by[0] == "friction.static_coefficient" && !scene.friction.static_coefficient.has_value()) continue;
      if (paths.by[0].rfind("surface_velocity", 0) == 0 && !scene.surface_velocity.has_value()) continue;
      const std::vector<Derivative> derivatives = ExactDerivativesOf(scene, paths);
      const std::map<std::string, Ball> above = Quotients(scene, paths.by[0], 1.0);
      ExactScene here(scene, paths.by[0], 0.0);
      (void)here.Outcome();
      const double conditioning = here.conditioning;
      double typical = 1e-4;  // The numbers of an outcome are of the order of 1.
      for (const Derivative& d : derivatives) {
        if (d.value.has_value()) typical = std::max(typical, 1e-2 * std::fabs(above.at(d.of).Nearest()));
      }
      for (const Derivative& d : derivatives) {
        const std::optional<double> rate = d.value.has_value() ? d.value : d.from_above;
        if (!rate.has_value()) continue;
        const double error = ErrorOf(*rate, above.at(d.of), typical);
        above_limit += error > 1e-10 ? 1 : 0;
        ++compared;
        // W itself is rounded, and a nearly singular one takes its digits along.
        if (d.error.has_value()) {
          ASSERT_LE(std::fabs((Exact(*rate) - above.at(d.of)).Nearest()), *d.error)
              << kind.name << " " << d.of << " by " << d.by << ": " << *rate;
          continue;
        }
        ASSERT_LE(error, std::max(1e-10, 1e-14 * conditioning * conditioning))
            << kind.name << " " << d.of << " by " << d.by << ": " << *rate << ", exact " << above.at(d.of).ToString();
      }
    }
  }
  EXPECT_GE(compared, 50'000);
  EXPECT_LE(above_limit, compared / 10'000);
}

INSTANTIATE_TEST_SUITE_P(Systems, EverySystem, testing::Range<size_t>(0, 6));

// --- Thresholds ---

// A planar contact whose numbers have few bits, so that it can lie exactly on a threshold.
class ThresholdScenes {
 public:
  Scene FrictionLimit() {
    Scene scene = Any();
    auto& contact = std::get<PlanarContact>(scene.system);
    const double limit = scene.friction.static_coefficient.value_or(scene.friction.kinetic_coefficient);
    contact.w_tn_per_kg = Sign() * limit * contact.w_tt_per_kg;
    contact.w_nn_per_kg = 2.0 * limit * limit * contact.w_tt_per_kg;
    contact.tangential_m_s = -0.125 * std::copysign(1.0, contact.w_tn_per_kg);
    return scene;
  }
  Scene SlipStart() {
    Scene scene = Any();
    std::get<PlanarContact>(scene.system).tangential_m_s = 0.0;
    return scene;
  }
  // Slip stops at `share` of what v rises to from its value before.
  Scene StopAt(double share) {
    for (;;) {
      Scene scene = Any();
      auto& contact = std::get<PlanarContact>(scene.system);
      const double mu = scene.friction.kinetic_coefficient;
      const double u_rise = contact.w_tn_per_kg - mu * contact.w_tt_per_kg;
      const double v_rise = contact.w_nn_per_kg - mu * contact.w_tn_per_kg;
      if (!(u_rise < 0.0) || !(v_rise > 0.0)) continue;
      contact.normal_m_s = -v_rise;
      contact.tangential_m_s = -u_rise * share;
      return scene;
    }
  }
  Scene CompressionEnd() { return StopAt(1.0); }
  Scene ImpactEnd() {
    Scene scene = StopAt(1.5);
    scene.restitution = NewtonCoefficient{0.5};
    return scene;
  }

 private:
  double Eighths(int least, int most) { return std::uniform_int_distribution<int>(least, most)(random_) / 8.0; }
  double Sign() { return Eighths(0, 1) == 0.0 ? -1.0 : 1.0; }
  Scene Any() {
    Scene scene;
    const double tt = Eighths(8, 32), nn = Eighths(8, 32);
    scene.system = PlanarContact{tt, Sign() * (Eighths(1, 7) - 0.0625) * std::min(tt, nn), nn, Sign() * Eighths(1, 16),
                                 -Eighths(1, 16)};
    scene.friction.kinetic_coefficient = Eighths(1, 8);
    if (Sign() > 0.0) scene.friction.static_coefficient = scene.friction.kinetic_coefficient + Eighths(0, 4);
    const double coefficient = Eighths(1, 7);
    switch (std::uniform_int_distribution<int>(0, 2)(random_)) {
      case 0:
        scene.restitution = NewtonCoefficient{coefficient};
        break;
      case 1:
        scene.restitution = PoissonCoefficient{coefficient};
        break;
      default:
        scene.restitution = EnergeticCoefficient{coefficient};
    }
    return scene;
  }

  std::mt19937_64 random_{31};
};

// Compares one side of the derivatives with difference quotients; where the number jumps, there must be none.
void ExpectSide(const Scene& scene, const std::vector<Derivative>& derivatives, double side,
                std::optional<double> Derivative::*rate, int& jumps) {
  const std::string& by = derivatives[0].by;
  const std::map<std::string, Ball> here = ExactScene(scene, by, 0.0).Outcome();
  const std::map<std::string, Ball> beside = ExactScene(scene, by, side * 0x1p-40).Outcome();
  const std::map<std::string, Ball> quotients = Quotients(scene, by, side);
  for (const Derivative& d : derivatives) {
    if (Abs(beside.at(d.of) - here.at(d.of)) > Exact(1e-9)) {
      ++jumps;
      EXPECT_FALSE((d.*rate).has_value()) << d.of << " by " << d.by << " on side " << side;
      EXPECT_THAT(d.reason, testing::HasSubstr("jumps"));
      continue;
    }
    ASSERT_TRUE((d.*rate).has_value()) << d.of << " by " << d.by << " on side " << side << ": " << d.reason;
    ASSERT_LE(ErrorOf(*(d.*rate), quotients.at(d.of), 1e-2), 1e-10)
        << d.of << " by " << d.by << " on side " << side << ": " << *(d.*rate) << ", exact "
        << quotients.at(d.of).ToString();
  }
}

struct ThresholdCase {
  const char* name;
  Threshold threshold;
  Scene (ThresholdScenes::*make)();
};

class EveryThreshold : public testing::TestWithParam<ThresholdCase> {};

TEST_P(EveryThreshold, HasBothOneSidedDerivativesOrNamesTheJump) {
  ThresholdScenes scenes;
  int on_threshold = 0, on_others = 0, jumps = 0;
  for (int i = 0; i < 1000; ++i) {
    const Scene scene = (scenes.*GetParam().make)();
    if (!Validate(scene).empty()) continue;
    const DerivativePaths all = AllDerivativePaths(scene);
    for (const std::string& by : all.by) {
      if (by.rfind("planar_contact.", 0) != 0) continue;  // Both sides of those are in the domain.
      const std::vector<Derivative> derivatives = ExactDerivativesOf(scene, {.of = all.of, .by = {by}});
      ExpectSide(scene, derivatives, -1.0, &Derivative::from_below, jumps);
      ExpectSide(scene, derivatives, 1.0, &Derivative::from_above, jumps);
      if (HasFatalFailure())
        FAIL() << planar::ToString(planar::MakeProblem(std::get<PlanarReduction>(SceneContact(scene).reduction),
                                                       scene.restitution, SceneContact(scene).coefficients));
      for (const Derivative& d : derivatives) {
        if (d.kind == DerivativeKind::kTwoSided) continue;
        ++(d.threshold == GetParam().threshold ? on_threshold : on_others);
      }
    }
  }
  EXPECT_GE(on_threshold, 1000);
  EXPECT_LE(on_others, on_threshold / 10);  // Numbers of few bits lie on two thresholds at times.
  // Friction that holds more than it resists with lets the outcome jump where slip does not stop as it did.
  EXPECT_GE(jumps, GetParam().threshold == Threshold::kFrictionLimit ? 100 : 0);
}

INSTANTIATE_TEST_SUITE_P(
    Thresholds, EveryThreshold,
    testing::Values(ThresholdCase{"FrictionLimit", Threshold::kFrictionLimit, &ThresholdScenes::FrictionLimit},
                    ThresholdCase{"SlipStart", Threshold::kSlipStart, &ThresholdScenes::SlipStart},
                    ThresholdCase{"CompressionEnd", Threshold::kCompressionEnd, &ThresholdScenes::CompressionEnd},
                    ThresholdCase{"ImpactEnd", Threshold::kImpactEnd, &ThresholdScenes::ImpactEnd}),
    [](const auto& one) { return one.param.name; });

Derivative Only(const Scene& scene, const std::string& of, const std::string& by) {
  return ExactDerivativesOf(scene, {.of = {of}, .by = {by}}).front();
}

Scene PendulumScene(double b, double mu, double eta) {
  return {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.5, .b_m = b, .omega_minus_rad_s = -1.0},
          .friction = {.kinetic_coefficient = mu},
          .restitution = EnergeticCoefficient{eta}};
}

TEST(DerivativesTest, PendulumIsLubardasFormula) {
  // Newton's coefficient is eta sqrt((1 - x)/(1 + x)) with x = mu b/a [15], so that d/dmu is -eta (b/a) r/(1 - x^2).
  const Derivative d = Only(PendulumScene(1.0, 0.25, 0.8), "coefficients.newton", "friction.kinetic_coefficient");
  EXPECT_EQ(d.kind, DerivativeKind::kTwoSided);
  EXPECT_NEAR(*d.value, -0.8 * 2.0 * std::sqrt(0.5 / 1.5) / 0.75, 1e-14);
}

TEST(DerivativesTest, PendulumBelowItsPinHasAKink) {
  const Derivative d = Only(PendulumScene(0.0, 0.25, 0.8), "coefficients.newton", "pendulum.b_m");
  EXPECT_EQ(d.kind, DerivativeKind::kOneSided);
  EXPECT_EQ(d.threshold, Threshold::kSlipStart);
  EXPECT_NEAR(*d.from_above, -0.8 * 0.25 / 0.5, 1e-15);
  EXPECT_NEAR(*d.from_below, 0.8 * 0.25 / 0.5, 1e-15);
  EXPECT_FALSE(d.value.has_value());
}

TEST(DerivativesTest, PendulumThatJustLocksJumps) {
  const Scene scene = PendulumScene(1.0, 0.5, 0.8);  // x = 1
  const Derivative impulse = Only(scene, "impulse.normal_total_n_s", "friction.kinetic_coefficient");
  EXPECT_EQ(impulse.threshold, Threshold::kJamming);
  EXPECT_FALSE(impulse.from_below.has_value());
  EXPECT_FALSE(impulse.value.has_value());
  EXPECT_NEAR(*impulse.from_above, -1.0 / (0.5 + 0.5) / (0.5 + 0.5), 1e-14);  // tau_0 is J0/(a + mu b).
  EXPECT_EQ(Only(scene, "coefficients.newton", "friction.kinetic_coefficient").from_above, 0.0);
}

// A number that is 0 and feels nothing of the impact changes as the number of the scene does.
TEST(DerivativesTest, VelocityAtRestThatTheImpactDoesNotTouchKeepsItsDerivative) {
  Scene disc =
      With(PlanarBody{.mass_kg = 1.0, .inertia_com_kg_m2 = 0.4, .velocity_t_m_s = 0.5, .velocity_n_m_s = -1.0});
  const Derivative spin = Only(disc, "bodies_after[0].angular_rad_s[0]", "planar_body.rate_rad_s");
  EXPECT_EQ(spin.kind, DerivativeKind::kTwoSided) << spin.reason;
  EXPECT_EQ(spin.value, 1.0);
  const Scene arm = With(
      Mechanism{.mass_matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .jacobian = {1, 0, 0, 0, 1, 0}, .rates = {1.0, -1.0, 0.0}});
  const Derivative rate = Only(arm, "rates_after[2]", "mechanism.rates[2]");
  EXPECT_EQ(rate.kind, DerivativeKind::kTwoSided) << rate.reason;
  EXPECT_EQ(rate.value, 1.0);
}

// By symmetry these are 0. What rounding, or the change of the derivative itself, leaves on the sides is no kink.
TEST(DerivativesTest, DerivativeThatIsZeroIsTwoSided) {
  const auto expect_zero = [](const Scene& scene, const char* of, const char* by) {
    const Derivative d = Only(scene, of, by);
    EXPECT_EQ(d.kind, DerivativeKind::kTwoSided) << of << " " << by << d.reason;
    EXPECT_NEAR(d.value.value_or(1.0), 0.0, 1e-30) << of << " " << by;
  };
  const Scene ball = {
      .system = PlanarBody{.mass_kg = 1.0, .inertia_com_kg_m2 = 0.4, .offset_n_m = -0.1, .velocity_n_m_s = -1.0},
      .friction = {.kinetic_coefficient = 0.3},
      .restitution = EnergeticCoefficient{0.5}};
  expect_zero(ball, "coefficients.newton", "planar_body.velocity_t_m_s");
  expect_zero(ball, "bodies_after[0].linear_m_s[1]", "planar_body.offset_t_m");
  const Scene disc = {
      .system = PlanarBody{.mass_kg = 1.0, .inertia_com_kg_m2 = 0.4, .velocity_t_m_s = 0.5, .velocity_n_m_s = -1.0},
      .friction = {.kinetic_coefficient = 0.3},
      .restitution = NewtonCoefficient{0.5}};
  expect_zero(disc, "energy_change_j", "planar_body.offset_n_m");
}

// A slender body whose W is nearly singular: the references are those of the formulas in 60 digits.
TEST(DerivativesTest, NearlySingularWHasAnError) {
  const Scene scene = {.system = PlanarBody{.mass_kg = 1.0,
                                            .inertia_com_kg_m2 = 1e-8,
                                            .offset_t_m = 0.6,
                                            .offset_n_m = -0.7,
                                            .velocity_t_m_s = 0.3,
                                            .velocity_n_m_s = -1.0,
                                            .rate_rad_s = 0.1},
                       .friction = {.kinetic_coefficient = 1.5},
                       .restitution = EnergeticCoefficient{0.5}};
  const Derivative d = Only(scene, "impulse.normal_total_n_s", "planar_body.inertia_com_kg_m2");
  ASSERT_TRUE(d.value.has_value() && d.error.has_value());
  EXPECT_LE(std::fabs(*d.value - 0.30585), *d.error);
}

TEST(DerivativesTest, ImpactWithoutAnEndHasNone) {
  Scene scene = {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
                 .friction = {.kinetic_coefficient = 0.5},
                 .restitution = NewtonCoefficient{0.5},
                 .surface_velocity = SurfaceVelocity{.tangential_m_s = {-0.5}, .normal_m_s = 0.2}};
  const Derivative d = Only(scene, "rates_after_rad_s[0]", "pendulum.omega_minus_rad_s");
  EXPECT_EQ(d.kind, DerivativeKind::kNone);
  EXPECT_NE(d.reason.find("no end of the impact is known"), std::string::npos) << d.reason;
}

TEST(DerivativesTest, PhiTurnsTheContactAboutThePin) {
  const Scene scene = PendulumScene(1.0, 0.25, 0.8);
  const auto by = [&scene](const char* path) { return *Only(scene, "contact_velocity_after.normal_m_s", path).value; };
  EXPECT_NEAR(by("pendulum.phi_rad"), 1.0 * by("pendulum.a_m") - 0.5 * by("pendulum.b_m"), 1e-14);
}

// Below the pin b = 0, and d/dphi is -a d/db of the other side.
TEST(DerivativesTest, PhiHasTheKinkOfAPendulumBelowItsPin) {
  const Scene scene = PendulumScene(0.0, 0.25, 0.8);
  for (const char* of :
       {"coefficients.newton", "impulse.normal_total_n_s", "rates_after_rad_s[0]", "energy_change_j"}) {
    const Derivative by_phi = Only(scene, of, "pendulum.phi_rad"), by_b = Only(scene, of, "pendulum.b_m");
    EXPECT_EQ(by_phi.kind, DerivativeKind::kOneSided) << of;
    EXPECT_NEAR(*by_phi.from_above, -0.5 * *by_b.from_below, 1e-14) << of;
    EXPECT_NEAR(*by_phi.from_below, -0.5 * *by_b.from_above, 1e-14) << of;
  }
  EXPECT_NEAR(*Only(scene, "coefficients.newton", "pendulum.phi_rad").from_above, -0.2, 1e-14);
}

// At 2 m/s the factor 1 - |v|^p is 0 for p = 0 and negative for every p > 0.
TEST(DerivativesTest, AnExponentThatWouldMakeRestitutionNegativeHasNoSide) {
  Scene scene = With(PlanarContact{3.0, 0.3, 1.0, 0.1, -2.0});
  scene.friction.kinetic_coefficient = 0.1;
  scene.restitution = EnergeticCoefficient{0.8};
  scene.restitution_by_speed = PowerLaw{.alpha = 1.0, .exponent = 0.0};
  const char* const exponent = "restitution.by_speed.power_law.exponent";
  const Derivative fast = Only(scene, "coefficients.energetic", exponent);
  EXPECT_EQ(fast.kind, DerivativeKind::kNone);
  EXPECT_EQ(fast.threshold, Threshold::kDomain);
  std::get<PlanarContact>(scene.system).normal_m_s = -0.5;
  EXPECT_NEAR(*Only(scene, "coefficients.energetic", exponent).from_above, 0.8 * std::log(2.0), 1e-14);
}

TEST(DerivativesTest, NumberAtTheEndOfItsRangeHasOneSide) {
  const Scene elastic = PendulumScene(1.0, 0.25, 1.0);
  const Derivative most = Only(elastic, "coefficients.newton", "restitution.energetic");
  EXPECT_EQ(most.threshold, Threshold::kDomain);
  EXPECT_FALSE(most.from_above.has_value());
  EXPECT_NEAR(*most.from_below, std::sqrt(0.5 / 1.5), 1e-14);
  // v1 is proportional to eta, also where eta^2 is 0 to first order.
  const Derivative least = Only(PendulumScene(1.0, 0.25, 0.0), "coefficients.newton", "restitution.energetic");
  EXPECT_FALSE(least.from_below.has_value());
  EXPECT_NEAR(*least.from_above, std::sqrt(0.5 / 1.5), 1e-14);
  const Derivative rough = Only(elastic, "coefficients.newton", "friction.static_coefficient");
  EXPECT_EQ(rough.threshold, Threshold::kDomain);
  EXPECT_EQ(rough.from_above, 0.0);
}

TEST(DerivativesTest, ContactThatJustApproachesHasBothVelocitiesButNoCoefficients) {
  Scene scene = With(PlanarContact{2.0, 0.5, 1.0, 1.0, 0.0});
  scene.restitution = NewtonCoefficient{0.5};
  const Derivative velocity = Only(scene, "contact_velocity_after.normal_m_s", "planar_contact.normal_m_s");
  EXPECT_EQ(velocity.threshold, Threshold::kApproach);
  EXPECT_NEAR(*velocity.from_below, -0.5, 1e-15);
  EXPECT_EQ(velocity.from_above, 1.0);
  const Derivative coefficient = Only(scene, "coefficients.newton", "planar_contact.normal_m_s");
  EXPECT_FALSE(coefficient.from_below.has_value());
  EXPECT_EQ(coefficient.from_above, 0.0);
}

// A contact that just approaches slides throughout: tau = (1 + e_P) |v0|/(Wnn - mu Wtn), so that v1 = -e_P v0 and
// u1 = u0 + (Wtn - mu Wtt) tau.
TEST(DerivativesTest, ContactThatJustApproachesDiffersOnItsSidesUnderFriction) {
  const Scene scene = {.system = PlanarContact{3.25, 1.75, 1.75, 1.75, 0.0},
                       .friction = {.kinetic_coefficient = 0.125},
                       .restitution = PoissonCoefficient{0.75}};
  const Derivative normal = Only(scene, "contact_velocity_after.normal_m_s", "planar_contact.normal_m_s");
  EXPECT_EQ(normal.kind, DerivativeKind::kOneSided);
  EXPECT_EQ(normal.threshold, Threshold::kApproach);
  EXPECT_NEAR(normal.from_below.value_or(0.0), -0.75, 1e-14);
  EXPECT_EQ(normal.from_above, 1.0);
  const Derivative slip = Only(scene, "contact_velocity_after.tangential_m_s[0]", "planar_contact.normal_m_s");
  EXPECT_NEAR(slip.from_below.value_or(0.0), -(1.75 - 0.125 * 3.25) * 1.75 / (1.75 - 0.125 * 1.75), 1e-14);
  EXPECT_EQ(slip.from_above, 0.0);
}

// At mu > Wnn/|Wtn| and slip towards the jam, v1 tends to a number above 0 as v0 tends to 0, and -v1/v0 has no limit.
TEST(DerivativesTest, CoefficientThatGrowsWithoutBoundHasNone) {
  const Scene scene = {.system = PlanarContact{4.0, -2.0, 1.75, -1.875, 0.0},
                       .friction = {.kinetic_coefficient = 1.375},
                       .restitution = EnergeticCoefficient{0.25}};
  const Derivative newton = Only(scene, "coefficients.newton", "planar_contact.normal_m_s");
  EXPECT_FALSE(newton.from_below.has_value());
  EXPECT_THAT(newton.reason, testing::HasSubstr("the number jumps"));
}

// mu Wtt = |Wtn| keeps u where it is, and beside it slip would stop only after an impulse without end: nothing jumps.
// u1 = u0 + (Wtn - mu Wtt) tau with tau = (1 + e) |v0|/(Wnn - mu Wtn) = 1.
TEST(DerivativesTest, SlipThatStopsAtInfinityIsNoThreshold) {
  const Scene scene = {.system = PlanarContact{2.0, 1.0, 2.0, 1.0, -1.0},
                       .friction = {.kinetic_coefficient = 0.5},
                       .restitution = NewtonCoefficient{0.5}};
  const char* const slip = "contact_velocity_after.tangential_m_s[0]";
  for (const auto& [by, expected] : {std::pair("friction.kinetic_coefficient", -2.0),
                                     {"planar_contact.w_tn_per_kg", 1.0},
                                     {"planar_contact.w_tt_per_kg", -0.5}}) {
    const Derivative d = Only(scene, slip, by);
    EXPECT_EQ(d.kind, DerivativeKind::kTwoSided) << by;
    EXPECT_NEAR(d.value.value_or(0.0), expected, 1e-14) << by;
  }
}

TEST(DerivativesTest, WOfRankOneHasNoDerivativeByItsEntries) {
  Scene scene = With(PlanarContact{1.0, 0.5, 0.25, -2.0, -1.0});
  scene.friction.kinetic_coefficient = 0.125;
  const Derivative by_w = Only(scene, "contact_velocity_after.normal_m_s", "planar_contact.w_tt_per_kg");
  EXPECT_EQ(by_w.kind, DerivativeKind::kNone);
  EXPECT_EQ(by_w.threshold, Threshold::kRank);
  const Derivative by_u = Only(scene, "contact_velocity_after.normal_m_s", "planar_contact.tangential_m_s");
  EXPECT_EQ(by_u.threshold, Threshold::kRank);
  EXPECT_EQ(Only(scene, "contact_velocity_after.normal_m_s", "friction.kinetic_coefficient").kind,
            DerivativeKind::kTwoSided);
}

// mu is at the threshold of a jam, Wnn = mu |Wtn|, where the impulse has no bound on one side.
TEST(DerivativesTest, VelocityBehindAnImpulseWithoutBoundHasNone) {
  const Scene scene = {.system = Mechanism{.mass_matrix = {0.5}, .jacobian = {2.0, -0.25}, .rates = {1.0}},
                       .friction = {.kinetic_coefficient = 0.125},
                       .restitution = NewtonCoefficient{0.5}};
  for (const char* by : {"friction.kinetic_coefficient", "mechanism.jacobian[0]"}) {
    const Derivative d = Only(scene, "rates_after[0]", by);
    EXPECT_FALSE(d.value.has_value()) << by;
    EXPECT_LT(std::fabs(d.from_below.value_or(0.0)) + std::fabs(d.from_above.value_or(0.0)), 1e3) << by;
  }
}

TEST(DerivativesTest, ContactThatSeparatesFeelsNoLawOfSpeed) {
  Scene scene = {.system = PlanarContact{1.0, 0.0, 1.0, 1.0, 1.0}, .restitution = NewtonCoefficient{0.5}};
  scene.friction.by_speed = PowerLaw{0.25, 0.5};
  const Derivative d = Only(scene, "contact_velocity_after.normal_m_s", "planar_contact.normal_m_s");
  EXPECT_EQ(d.kind, DerivativeKind::kTwoSided) << d.reason;
  EXPECT_EQ(d.value, 1.0);
}

// The rows of J are parallel, J = (2 a, a), so that W = s (4, 2; 2, 1) with s = a M^-1 a' has rank one for every M.
// Slip and approach end together: tau = |v0|/s/(1 + 2 mu) + e |v0|/s/(1 - 2 mu).
TEST(DerivativesTest, WThatKeepsRankOneHasDerivatives) {
  const Scene arm = {
      .system = Mechanism{.mass_matrix = {2.0, 0.1, 0.1, 1.0}, .jacobian = {0.6, 0.2, 0.3, 0.1}, .rates = {0.0, -1.0}},
      .friction = {.kinetic_coefficient = 0.25},
      .restitution = NewtonCoefficient{0.5}};
  const Derivative by_mass = Only(arm, "impulse.normal_total_n_s", "mechanism.mass_matrix[0]");
  const double s = (0.3 * 0.29 + 0.1 * 0.17) / 1.99, ds = -0.29 / 1.99 * 0.29 / 1.99;
  EXPECT_EQ(by_mass.kind, DerivativeKind::kTwoSided) << by_mass.reason;
  EXPECT_NEAR(by_mass.value.value_or(0.0), -0.1 / s * (1.0 / 1.5 + 0.5 / 0.5) / s * ds, 1e-12);
  // One row alone, and W = diag(0, w): tau = (1 + e) |v0|/w.
  const Scene contact = {.system = PlanarContact{0.0, 0.0, 2.0, 0.5, -1.0}, .restitution = NewtonCoefficient{0.5}};
  const Derivative by_w = Only(contact, "impulse.normal_total_n_s", "planar_contact.w_nn_per_kg");
  EXPECT_EQ(by_w.kind, DerivativeKind::kTwoSided) << by_w.reason;
  EXPECT_NEAR(by_w.value.value_or(0.0), -1.5 / 4.0, 1e-15);
  EXPECT_EQ(Only(contact, "impulse.normal_total_n_s", "planar_contact.w_tt_per_kg").threshold, Threshold::kDomain);
}

TEST(DerivativesTest, NumberThatATableDoesNotTouchHasNoThresholdThere) {
  Scene scene = {.system = PlanarContact{3.5, 0.0, 2.0, 1.375, -1.875},
                 .friction = {.kinetic_coefficient = 1.0},
                 .restitution = NewtonCoefficient{0.5}};
  scene.friction.by_speed = SpeedTable{{0.9375, 1.875, 3.75}, {1.0, 0.75, 0.5}};
  const Derivative d = Only(scene, "impulse.normal_total_n_s", "friction.by_speed.table.speed_m_s[1]");
  EXPECT_EQ(d.kind, DerivativeKind::kTwoSided);
  EXPECT_NEAR(d.value.value_or(1.0), 0.0, 1e-30);
}

TEST(DerivativesTest, SpeedOfATableIsAThreshold) {
  Scene scene = With(PlanarContact{2.0, 0.5, 1.0, 4.0, -1.0});
  scene.friction.kinetic_coefficient = 0.25;
  scene.restitution = NewtonCoefficient{0.5};
  scene.restitution_by_speed = SpeedTable{{0.5, 1.0, 2.0}, {1.0, 0.5, 1.0}};
  const Derivative d = Only(scene, "contact_velocity_after.normal_m_s", "planar_contact.normal_m_s");
  EXPECT_EQ(d.threshold, Threshold::kSpeedTable);
  // v1 = -e F(-v0) v0; F has the slope 1/2 above the speed 1 and -1 below it.
  EXPECT_NEAR(*d.from_below, -0.25 - 0.5 * 0.5, 1e-15);
  EXPECT_NEAR(*d.from_above, -0.25 + 0.5 * 1.0, 1e-15);
}

// --- Requests ---

std::vector<Violation> Refused(const Scene& scene, const DerivativePaths& paths) {
  return ViolationsOf(LocalSolver().Solve({.scene = scene, .derivatives = paths}).status());
}

TEST(DerivativesTest, RequestNamesWhatHasNone) {
  const DerivativePaths paths = {.of = {"coefficients.newton"}, .by = {"friction.kinetic_coefficient"}};
  const auto only = [](const std::vector<Violation>& violations) {
    EXPECT_EQ(violations.size(), 1);
    return violations.empty() ? std::string() : violations[0].field + " " + violations[0].description;
  };
  EXPECT_EQ(
      only(Refused(With(Contact()), {.of = {"coefficients.newtn"}, .by = paths.by})),
      "derivatives.of[0] = \"coefficients.newtn\": must be a coefficient, an impulse, a contact velocity, a "
      "velocity or momentum of the system, or a work other than that of a spring; did you mean coefficients.newton?");
  EXPECT_EQ(only(Refused(With(Contact()), {.of = paths.of, .by = {"pendulum.a_m"}})).substr(0, 38),
            "derivatives.by[0] = \"pendulum.a_m\": mu");
  EXPECT_EQ(only(Refused(With(Contact()), {.of = paths.of, .by = {}})), "derivatives.by is empty: must name a number");
}

TEST(DerivativesTest, ComeInTheOrderOfTheRequest) {
  const DerivativePaths paths = {.of = {"coefficients.newton", "impulse.normal_total_n_s"},
                                 .by = {"pendulum.b_m", "pendulum.a_m", "friction.kinetic_coefficient"}};
  const auto response = LocalSolver().Solve({.scene = PendulumScene(1.0, 0.25, 0.8), .derivatives = paths});
  ASSERT_TRUE(response.ok()) << response.status();
  ASSERT_EQ(response->outcome.derivatives.size(), 6);
  for (size_t i = 0; i < 6; ++i) {
    const Derivative& d = response->outcome.derivatives[i];
    EXPECT_EQ(d.of, paths.of[i / 3]);
    EXPECT_EQ(d.by, paths.by[i % 3]);
    EXPECT_EQ(d.from_above, d.value);
    EXPECT_EQ(d.threshold, Threshold::kUnspecified);
  }
}

// Friction holds the contact at v_s = 0.125 m/s, which is just what Newton's coefficient of 0.5 asks for. A larger one
// wedges it, and no end is known. A smaller one ends the impact earlier, at the slope v0/v' of slip.
TEST(DerivativesTest, ASideThatIsWedgedHasNone) {
  const Scene scene = {.system = PlanarContact{1.0, 0.25, 0.0625, -1.5, -0.25},
                       .friction = {.kinetic_coefficient = 0.3},
                       .restitution = NewtonCoefficient{0.5}};
  Scene beside = scene;
  beside.restitution = NewtonCoefficient{0.50000001};
  const auto wedged = LocalSolver().Solve({.scene = beside});
  ASSERT_TRUE(wedged.ok());
  ASSERT_EQ(wedged->outcome.regime, Regime::kWedged);
  for (const char* const of : {"impulse.normal_total_n_s", "work.tangential_total_j", "coefficients.newton"}) {
    const auto answer =
        LocalSolver().Solve({.scene = scene, .derivatives = DerivativePaths{.of = {of}, .by = {"restitution.newton"}}});
    ASSERT_TRUE(answer.ok()) << answer.status();
    const Derivative& d = answer->outcome.derivatives.front();
    EXPECT_EQ(d.kind, DerivativeKind::kOneSided) << of;
    EXPECT_FALSE(d.from_above.has_value()) << of;
    EXPECT_THAT(d.reason, testing::HasSubstr("Above, no end of the impact is known")) << of;
  }
}

}  // namespace
}  // namespace ricochet
