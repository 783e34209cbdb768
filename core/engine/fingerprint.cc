#include "core/engine/fingerprint.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/answer/scene_outcome.h"
#include "core/base/floating_point_mode.h"
#include "core/base/invariant.h"
#include "core/base/stable_hash.h"
#include "core/contact/multi_reduction.h"
#include "core/engine/row_runs.h"
#include "core/models/restitution_law.h"
#include "core/multi/solve_multi_contact.h"
#include "core/plan/demand.h"
#include "core/rows/axis_values.h"
#include "core/scene/validate.h"
#include "ricochet/engine_info.h"
#include "ricochet/fit.h"
#include "ricochet/grid.h"
#include "ricochet/multi_contact.h"
#include "ricochet/outcome_numbers.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {
namespace {

// A chain of one to four links, which needs elementary functions and the factors of a matrix.
Linkage LinkageProbe(int i) {
  Linkage linkage;
  for (int k = 0; k <= i % 4; ++k) {
    linkage.links.push_back({.length_m = 1.0 + 0.1 * k,
                             .mass_kg = 1.0 + 0.2 * i,
                             .com_m = 0.5,
                             .inertia_com_kg_m2 = 0.1,
                             .theta_rad = 0.3 * i - 0.7 * k,
                             .rate_rad_s = -1.0 - 0.1 * k});
  }
  return linkage;
}

PlanarBody PlanarBodyProbe(int i) {
  return {.mass_kg = 1.0 + 0.3 * i,
          .inertia_com_kg_m2 = 0.1 + 0.07 * i,
          .offset_t_m = 0.2 - 0.1 * i,
          .offset_n_m = -0.3 - 0.01 * i,
          .velocity_t_m_s = 0.7 * i,
          .velocity_n_m_s = -1.0 - 0.1 * i,
          .rate_rad_s = 0.9 - 0.4 * i};
}

// The tensor is that of a body whose principal axes do not lie in the frame.
SpatialBody SpatialBodyProbe(int i) {
  return {.mass_kg = 1.0 + 0.3 * i,
          .inertia_com_kg_m2 = {0.3 + 0.01 * i, 0.02, -0.03, 0.4, 0.01 * i, 0.5},
          .offset_m = {0.1 * i, -0.2, -0.3},
          .linear_m_s = {0.7, -0.1 * i, -1.1},
          .angular_rad_s = {0.3, 0.2 * i, -0.9}};
}

// A chain of two to five coordinates, in a plane or in space, with all free or one held.
Mechanism MechanismProbe(int i) {
  Mechanism mechanism;
  const int n = 2 + i % 4;
  const int rows = 2 + i % 2;
  for (int k = 0; k < n; ++k) {
    for (int l = 0; l < n; ++l) mechanism.mass_matrix.push_back(1.0 / (1.0 + k + l) + (k == l ? 0.3 : 0.0));
    mechanism.rates.push_back(0.4 - 0.3 * k);
  }
  for (int k = 0; k < rows * n; ++k) mechanism.jacobian.push_back(0.7 - 0.11 * k + 0.01 * i * k * k);
  if (i % 3 == 0) mechanism.kept_coordinates = {1};
  return mechanism;
}

// Returns systems of every kind, each with all numbers that its reduction reads.
std::vector<System> SystemProbes() {
  static_assert(std::variant_size_v<System> == 9, "a system that was added needs a probe");
  std::vector<System> systems;
  for (int i = 0; i < 4; ++i) {
    const double part = 0.1 * i;
    systems.emplace_back(
        Pendulum{.inertia_kg_m2 = 1.3 + part, .a_m = 0.7, .b_m = 0.3 - part, .omega_minus_rad_s = -1.1});
    systems.emplace_back(PlanarBodyProbe(i));
    systems.emplace_back(SpatialBodyProbe(i));
    systems.emplace_back(BodyPair{PlanarPair{.body_1 = PlanarBodyProbe(i), .body_2 = PlanarBodyProbe(3 - i)}});
    systems.emplace_back(BodyPair{SpatialPair{.body_1 = SpatialBodyProbe(i), .body_2 = SpatialBodyProbe(3 - i)}});
    systems.emplace_back(PlanarContact{
        .w_tt_per_kg = 2.5, .w_tn_per_kg = 2.5 - part, .w_nn_per_kg = 2.5, .tangential_m_s = 0.3, .normal_m_s = -0.9});
    systems.emplace_back(SpatialContact{
        .w_per_kg = {1.96, 0.24, 0.6, 2.96, -0.8, 1.85}, .tangential_m_s = {0.3, part}, .normal_m_s = -0.9});
  }
  for (int i = 0; i < 16; ++i) systems.emplace_back(LinkageProbe(i));
  for (int i = 0; i < 8; ++i) systems.emplace_back(MechanismProbe(i));
  return systems;
}

// Returns gravity where a system may have it, and a moment about the pin for a pendulum.
FiniteForces ForcesOn(const System& system) {
  if (std::holds_alternative<Pendulum>(system)) return PinMoment{0.3};
  const auto* const pair = std::get_if<BodyPair>(&system);
  const bool has_gravity = std::holds_alternative<PlanarBody>(system) || std::holds_alternative<Linkage>(system) ||
                           (pair != nullptr && std::holds_alternative<PlanarPair>(pair->bodies));
  return has_gravity ? FiniteForces(Gravity{0.4, -9.81}) : FiniteForces();
}

// Rigid impacts: every definition of restitution, friction from none to much, slip that goes on, turns, reverses and
// stops, and coefficients that depend on the speed.
Scene RigidScene(const System& system, int i) {
  const double mu = 0.1 * (i % 9);
  Scene scene = {.system = system,
                 .friction = {.kinetic_coefficient = mu},
                 .restitution = ToRestitution(static_cast<RestitutionLaw>(i % 3), (i % 11) / 10.0)};
  if (i % 7 == 0) scene.friction.static_coefficient = mu + 0.2;
  if (i % 8 == 5) scene.friction.by_speed = PowerLaw{.alpha = 0.3, .exponent = 0.2};
  if (i % 8 == 6) {
    scene.restitution_by_speed = SpeedTable{.speed_m_s = {0.1, 1.0, 3.0}, .factor = {1.0, 0.7, 0.4}};
  }
  return scene;
}

// Contacts that a spring along the surface holds; some sticks end and some impacts do not.
Scene CompliantScene(const System& system, int i) {
  return {.system = system,
          .friction = {.kinetic_coefficient = 0.1 * (i % 7)},
          .restitution = EnergeticCoefficient{0.1 + 0.05 * (i % 16)},
          .compliance = Compliance{.tangential_ratio_squared = 0.25 + 0.1 * (i % 16)}};
}

// Contacts that last: each spring, rigid and compliant along the surface, under finite forces.
Scene LastingScene(const System& system, int i) {
  static_assert(std::variant_size_v<NormalSpring> == 4, "a spring that was added needs a probe");
  Scene scene = CompliantScene(system, i);
  scene.finite_forces = ForcesOn(system);
  if (i % 2 == 0) scene.compliance->tangential_ratio_squared.reset();
  scene.compliance->normal = LinearSpring{1e4};
  if (i % 3 == 1) scene.compliance->normal = HertzSpring{1e6};
  if (i % 3 != 2) return scene;
  scene.compliance->normal = HuntCrossleySpring{1e5, 1.3, 0.2};
  scene.restitution = std::monostate();
  return scene;
}

Scene LawScene(const System& system, int i) {
  static_assert(std::variant_size_v<ImpactLaw> == 5, "a law that was added needs a probe");
  const double e = 0.05 * (i % 16);
  const ImpactLaw laws[] = {WhittakerLaw{e}, KaneLevinsonLaw{e}, BrachLaw{e, 0.3 - 0.05 * (i % 8)},
                            ChatterjeeRuinaLaw{e, 0.6 - 0.1 * (i % 8)}};
  return {.system = system, .friction = {.kinetic_coefficient = 0.1 * (i % 9)}, .impact_law = laws[i % 4]};
}

class Questions {
 public:
  // Asks for all numbers of the impact, which are those of its system and of the model that the demand calls for. A
  // scene that breaks a rule is not asked, nor a demand that it cannot meet.
  void Ask(const Scene& scene, const Demand& demand) {
    std::optional<SceneContact> contact;
    if (!Validate(scene, RestitutionIs::kRequired, contact).empty()) return;
    if (!CheckDemand(scene, contact, demand).empty()) return;
    Outcome outcome;
    const auto never = [] { return false; };
    if (!SolveScene(scene, contact, demand, {.numbers_only = true}, never, outcome).ok()) return;
    std::vector<uint64_t>& of_model = by_model_[static_cast<size_t>(outcome.plan.model)];
    std::vector<uint64_t>& of_system = by_system_[scene.system.index()];
    const auto add = [&](uint64_t word) {
      of_model.push_back(word);
      of_system.push_back(word);
    };
    add(static_cast<uint64_t>(outcome.regime));
    VisitOutcomeNumbers(outcome,
                        [&add](const NumberPath& /*path*/, double number) { add(std::bit_cast<uint64_t>(number)); });
  }

  std::vector<Probe> Answers() && {
    std::vector<Probe> probes;
    for (size_t model = 0; model < by_model_.size(); ++model) {
      probes.push_back({absl::StrCat("model ", model), std::move(by_model_[model])});
    }
    for (size_t system = 0; system < by_system_.size(); ++system) {
      probes.push_back({absl::StrCat("system ", system), std::move(by_system_[system])});
    }
    return probes;
  }

 private:
  std::array<std::vector<uint64_t>, kModelCount> by_model_;
  std::array<std::vector<uint64_t>, std::variant_size_v<System>> by_system_;
};

// Returns the values of axes, because a sweep computes its points from them.
std::vector<uint64_t> ValuesOfAxes() {
  std::vector<uint64_t> bits;
  for (const Axis& axis : {Axis{.values = Linspace{-0.1, 0.3, 29}}, Axis{.values = Logspace{1e-3, 7.0, 29}}}) {
    for (int64_t i = 0; i < 29; ++i) bits.push_back(std::bit_cast<uint64_t>(AxisValue(axis, i)));
  }
  return bits;
}

// A block that falls flat: its orders, springs and the set of possible outcomes.
std::vector<uint64_t> SeveralContacts() {
  const double inertia = 5.0 / 12.0;
  MultiContactRequest request = {.scene = {.system = FreeBodies{.bodies = {{.mass_kg = 1.0,
                                                                            .inertia_com_kg_m2 = {inertia},
                                                                            .position_m = {0.0, 1.0},
                                                                            .linear_m_s = {0.1, -1.0}}}}}};
  for (const double side : {-1.0, 1.0}) {
    request.scene.contacts.push_back({.friction = 0.3,
                                      .energetic = 0.5,
                                      .relative_stiffness = 2.0 + side,
                                      .body = 1,
                                      .point_m = {0.5 * side, 0.0},
                                      .normal = {0.0, 1.0}});
  }
  std::vector<uint64_t> bits;
  const auto answers = SolveMultiContact(request, Reduce(request.scene), [] { return false; });
  CheckInvariant(answers.ok(), "the block of the fingerprint has an answer");
  const auto add = [&bits](const AttainedOutcome& outcome) {
    for (const double v : outcome.contact_velocity_m_s) bits.push_back(std::bit_cast<uint64_t>(v));
  };
  std::for_each(answers->front().orders.begin(), answers->front().orders.end(), add);
  if (answers->front().springs.has_value()) add(*answers->front().springs);
  for (const PossibleRange& range : answers->front().possible) {
    for (const double end : {range.lower, range.upper}) bits.push_back(std::bit_cast<uint64_t>(end));
  }
  return bits;
}

// The friction and the restitution of a pendulum that three impacts tell.
std::vector<uint64_t> FittedNumbers() {
  const FitRequest request = {.scene = {.system = Pendulum{1.3, 0.7, 0.3, -1.1},
                                        .friction = {.kinetic_coefficient = 0.2},
                                        .restitution = NewtonCoefficient{0.5}},
                              .unknowns = {{.path = "restitution.newton"}, {.path = "friction.kinetic_coefficient"}},
                              .inputs = {{"pendulum.omega_minus_rad_s", {-1.0, -1.5, -2.0}}},
                              .measured = {{"rates_after_rad_s[0]", {0.61, 0.89, 1.21}, {0.02}},
                                           {"impulse.normal_total_n_s", {2.7, 4.1, 5.4}, {0.1}}},
                              .starts = 1};
  const absl::StatusOr<FitResponse> response = RunFit(request, nullptr, [] { return false; });
  CheckInvariant(response.ok(), "the fit of the fingerprint has an answer");
  std::vector<uint64_t> bits;
  for (const FitEstimate& unknown : response->unknowns) {
    for (const double number : {unknown.value, unknown.low.value.value_or(0.0), unknown.high.value.value_or(0.0)}) {
      bits.push_back(std::bit_cast<uint64_t>(number));
    }
  }
  return bits;
}

}  // namespace

std::vector<Probe> ProbeEngine() {
  Questions questions;
  int i = 0;
  for (const System& system : SystemProbes()) {
    // The tolerances make the plan use both arithmetics, and each excluded effect a model without it.
    for (const double tolerance : {0.0, 1e-12, 1e-6}) {
      questions.Ask(RigidScene(system, i), {.relative_tolerance = tolerance});
    }
    for (const Effect effect : {Effect::kFriction, Effect::kSlipStop, Effect::kHigherOrder}) {
      questions.Ask(RigidScene(system, i), {.excluded = {effect}});
    }
    if (TangentialDirections(system) == 1) {
      questions.Ask(CompliantScene(system, i), {});
      questions.Ask(LawScene(system, i), {});
      if (i % 4 == 1) questions.Ask(LastingScene(system, i), {.relative_tolerance = 1e-3});
    }
    ++i;
  }
  std::vector<Probe> probes = std::move(questions).Answers();
  probes.push_back({"axes", ValuesOfAxes()});
  probes.push_back({"several contacts", SeveralContacts()});
  probes.push_back({"fit", FittedNumbers()});
  return probes;
}

std::string FingerprintOf(absl::Span<const Probe> probes) {
  StableHash hash;
  for (const Probe& probe : probes) {
    hash.Add(static_cast<uint64_t>(probe.bits.size()));
    for (const uint64_t word : probe.bits) hash.Add(word);
  }
  return absl::StrCat(absl::Hex(hash.value(), absl::kZeroPad16));
}

const char* ThisVersion() { return RICOCHET_VERSION; }

const EngineInfo& ThisEngine() {
  const DefaultFloatingPoint mode;
  static const EngineInfo engine = {.version = ThisVersion(), .fingerprint = FingerprintOf(ProbeEngine())};
  return engine;
}

}  // namespace ricochet
