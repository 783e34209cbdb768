#include "core/engine/fingerprint.h"

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/stable_hash.h"
#include "core/contact/coefficients_at_speed.h"
#include "core/contact/reduction.h"
#include "core/models/compliant/compliant.h"
#include "core/models/finite_duration/finite_duration.h"
#include "core/models/laws/impact_laws.h"
#include "core/models/pendulum/first_order.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "core/models/sliding/sliding.h"
#include "core/models/spatial/spatial.h"
#include "ricochet/engine_info.h"
#include "ricochet/plan.h"

namespace ricochet {
namespace {

// One of 64 pendulums, which together reach every law and regime.
pendulum::Problem PendulumProbe(int i) {
  const int step = i / 8;  // 0 ... 7
  return {.inertia = 1.0 + 0.1 * i,
          .a = 0.3 + 0.07 * step,
          .b = i % 5 == 0 ? 0.0 : 1.0 - 0.25 * step,
          .omega_minus = i == 63 ? 1.0 : -1.0 - 0.01 * i,
          .mu = 0.05 * (i % 8),
          .mu_static = 0.05 * (i % 8) + (i % 7 == 0 ? 0.2 : 0.0),
          .law = static_cast<RestitutionLaw>(i % 3),
          .coefficient = (i % 11) / 10.0};
}

// One of 16 planar contacts, or of 16 contacts in space: every law, and slip that goes on, turns, reverses and stops.
planar::Problem PlanarProbe(int i) {
  return {.w = {2.5, -1.5 + 0.2 * i, 2.5},
          .u0 = i % 4 == 3 ? 0.0 : -1.0 + 0.1 * i,
          .v0 = -1.0,
          .mu = 0.1 * (i % 9),
          .mu_static = 0.1 * (i % 9),
          .law = static_cast<RestitutionLaw>(i % 3),
          .coefficient = (i % 11) / 10.0};
}

spatial::Problem SpatialProbe(int i) {
  return {.w11 = 1.96,
          .w12 = 0.24,
          .w13 = 0.6,
          .w22 = 2.96,
          .w23 = -0.8,
          .w33 = 1.85,
          .u0 = {1.0 - 0.2 * i, 0.6},
          .v0 = -1.0,
          .mu = 0.1 * (i % 10),
          .mu_static = 0.1 * (i % 10),
          .law = static_cast<RestitutionLaw>(i % 3),
          .coefficient = (i % 11) / 10.0};
}

// One of the planar contacts with a compliance along t: some sticks end and some impacts do not.
compliant::Problem CompliantProbe(int i) {
  planar::Problem contact = PlanarProbe(i);
  contact.mu = 0.1 * (i % 7);
  contact.coefficient = 0.1 + 0.05 * i;
  return {.contact = contact, .ratio_squared = 0.25 + 0.1 * i};
}

sliding::Problem<1> SlidingProbe(int i) {
  return {.w = {2.5, 0.1 * i, 2.5}, .u0 = {1.0 + 0.1 * i}, .v0 = -1.0, .mu = 0.05 * i, .coefficient = i / 16.0};
}

sliding::Problem<2> SpatialSlidingProbe(int i) {
  return {.w = {1.96, 0.24, 0.6, 2.96, -0.8, 1.85},
          .u0 = {1.0 + 0.1 * i, 0.6},
          .v0 = -1.0,
          .mu = 0.01 * i,
          .coefficient = i / 16.0};
}

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

// A contact that lasts, at a tolerance that takes few steps: each spring, rigid and compliant along the surface.
finite_duration::Problem FiniteDurationProbe(int i) {
  finite_duration::Problem problem;
  problem.contact = PlanarProbe(4 * i + 1);
  problem.contact.law = RestitutionLaw::kEnergetic;
  problem.contact.coefficient = 0.5;
  problem.tangential_acceleration = 0.3;
  problem.normal_acceleration = -9.81;
  problem.tolerance = 1e-3;
  if (i == 0) problem.spring = LinearSpring{1e4};
  if (i == 1) problem.spring = HertzSpring{1e6};
  if (i == 2) problem.spring = HuntCrossleySpring{1e5, 1.3, 0.2};
  if (i == 3) {
    problem.spring = LinearSpring{1e4};
    problem.ratio_squared = 0.8;
  }
  return problem;
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

// Systems of every kind, none of which lacks a number that its reduction reads.
std::vector<System> SystemProbes() {
  static_assert(std::variant_size_v<System> == 9, "a system that was added needs a probe");
  std::vector<System> systems;
  for (int i = 0; i < 4; ++i) {
    const double part = 0.1 * i;
    systems.push_back(Pendulum{.inertia_kg_m2 = 1.3 + part, .a_m = 0.7, .b_m = 0.3 - part, .omega_minus_rad_s = -1.1});
    systems.push_back(PlanarBodyProbe(i));
    systems.push_back(SpatialBodyProbe(i));
    systems.push_back(BodyPair{PlanarPair{.body_1 = PlanarBodyProbe(i), .body_2 = PlanarBodyProbe(3 - i)}});
    systems.push_back(BodyPair{SpatialPair{.body_1 = SpatialBodyProbe(i), .body_2 = SpatialBodyProbe(3 - i)}});
    systems.push_back(PlanarContact{
        .w_tt_per_kg = 2.5, .w_tn_per_kg = 2.5 - part, .w_nn_per_kg = 2.5, .tangential_m_s = 0.3, .normal_m_s = -0.9});
    systems.push_back(SpatialContact{
        .w_per_kg = {1.96, 0.24, 0.6, 2.96, -0.8, 1.85}, .tangential_m_s = {0.3, part}, .normal_m_s = -0.9});
  }
  for (int i = 0; i < 16; ++i) systems.push_back(LinkageProbe(i));
  for (int i = 0; i < 8; ++i) systems.push_back(MechanismProbe(i));
  return systems;
}

// Collects the bits of answers.
class Bits {
 public:
  void Add(uint64_t word) { bits_.push_back(word); }
  void Add(double value) { Add(std::bit_cast<uint64_t>(value)); }
  template <typename Values>
  void AddAll(const Values& values) {
    for (const double value : values) Add(value);
  }
  void Add(const std::array<double, 1>& values) { AddAll(values); }
  void Add(const std::array<double, 2>& values) { AddAll(values); }

  template <typename Tangential>
  void Add(const ImpactEnd<Tangential>& impact) {
    Add(static_cast<uint64_t>(impact.regime));
    AddAll(std::array{impact.newton, impact.poisson, impact.energetic, impact.tangential, impact.v1,
                      impact.tau_compression, impact.tau1, impact.work_normal_compression,
                      impact.work_normal_restitution, impact.work_tangential_compression,
                      impact.work_tangential_restitution, impact.energy_change});
    Add(impact.u1);
    Add(impact.f1);
  }

  void Add(const pendulum::Impact& impact) {
    Add(static_cast<uint64_t>(impact.regime));
    AddAll(impact.values);
  }

  void Add(const laws::ImpactLawResult& result) {
    Add(static_cast<uint64_t>(result.solutions.size()));
    for (const laws::ImpactSolution& solution : result.solutions) {
      AddAll(std::array{solution.f, solution.tau1, solution.u1, solution.v1, solution.energy_change});
    }
  }

  std::vector<uint64_t> bits() && { return std::move(bits_); }

 private:
  std::vector<uint64_t> bits_;
};

// Adds both arithmetics of the closed forms, each with the bound on its rounding error.
void AddArithmetics(const planar::Problem& problem, Bits& bits) {
  planar::RoundingErrors errors;
  bits.Add(planar::Solve(problem, errors));
  bits.Add(errors.Largest());
  const planar::PlainImpact plain = planar::SolvePlain(problem);
  if (!plain.proved) return;
  bits.Add(plain.impact);
  bits.Add(plain.errors.Largest());
}

void AddArithmetics(const pendulum::Problem& problem, Bits& bits) {
  bits.Add(pendulum::Solve(problem));
  const pendulum::PlainImpact plain = pendulum::SolvePlain(problem);
  if (!plain.proved) return;
  bits.Add(plain.impact);
  bits.Add(plain.relative_error);
}

// SUNDIALS chooses its steps by roots of errors. Two libraries whose pow differs may agree on the few roots of a few
// impacts, so that many more are compared.
void AddFiniteDuration(Bits& bits) {
  if (!finite_duration::IsAvailable()) return;
  for (int i = 0; i < 4; ++i) bits.Add(finite_duration::Solve(FiniteDurationProbe(i)));
  double base = 1e-6;
  for (int i = 0; i < 4096; ++i, base *= 1.007) bits.Add(finite_duration::LibraryPower(base, 1.0 / (2 + i % 12)));
}

void AddLaws(Bits& bits) {
  static_assert(std::variant_size_v<ImpactLaw> == 5, "a law that was added needs a probe");
  for (int i = 0; i < 16; ++i) {
    const PlanarProblem problem = PlanarProbe(i);
    bits.Add(laws::SolveWhittaker(problem, 0.05 * i));
    bits.Add(laws::SolveKaneLevinson(problem, 0.05 * i));
    bits.Add(laws::SolveBrach(problem, 0.05 * i, 0.3 - 0.1 * i));
    bits.Add(laws::SolveChatterjeeRuina(problem, 0.05 * i, 0.6 - 0.1 * i));
  }
}

void AddPendulums(Bits& bits) {
  for (int i = 0; i < 64; ++i) AddArithmetics(PendulumProbe(i), bits);
}

void AddFirstOrder(Bits& bits) {
  for (int i = 0; i < 64; i += 4) {
    if (first_order::Serves(PendulumProbe(i))) bits.Add(first_order::Solve(PendulumProbe(i)));
  }
}

template <typename AddProbe>
void AddSixteen(const AddProbe& add) {
  for (int i = 0; i < 16; ++i) add(i);
}

void AddModel(Model model, Bits& bits) {
  switch (model) {
    case Model::kUnspecified:
    case Model::kNone:
      return;
    case Model::kFrictionless:
      return AddSixteen([&](int i) { bits.Add(sliding::SolveFrictionless(SlidingProbe(i))); });
    case Model::kFirstOrder:
      return AddFirstOrder(bits);
    case Model::kSliding:
      return AddSixteen([&](int i) {
        bits.Add(sliding::Solve(SlidingProbe(i)));
        bits.Add(sliding::Solve(SpatialSlidingProbe(i)));
      });
    case Model::kPendulum:
      return AddPendulums(bits);
    case Model::kPlanar:
      return AddSixteen([&](int i) { AddArithmetics(PlanarProbe(i), bits); });
    case Model::kSpatial:
      return AddSixteen([&](int i) { bits.Add(spatial::Solve(SpatialProbe(i))); });
    case Model::kCompliant:
      return AddSixteen([&](int i) { bits.Add(compliant::Solve(CompliantProbe(i))); });
    case Model::kFiniteDuration:
      return AddFiniteDuration(bits);
    case Model::kImpactLaw:
      return AddLaws(bits);
  }
}

// Gravity where a system may have it, and a moment about the pin of a pendulum.
FiniteForces ForcesOn(const System& system) {
  if (std::holds_alternative<Pendulum>(system)) return PinMoment{0.3};
  const auto* const pair = std::get_if<BodyPair>(&system);
  const bool has_gravity = std::holds_alternative<PlanarBody>(system) || std::holds_alternative<Linkage>(system) ||
                           (pair != nullptr && std::holds_alternative<PlanarPair>(pair->bodies));
  return has_gravity ? FiniteForces(Gravity{0.4, -9.81}) : FiniteForces();
}

template <size_t kTangential>
void AddReduction(const Reduction<kTangential>& reduction, Bits& bits) {
  bits.AddAll(reduction.w);
  bits.Add(reduction.u0);
  bits.Add(reduction.v0);
  bits.AddAll(reduction.response);
  bits.AddAll(reduction.momentum);
  bits.AddAll(reduction.acceleration);
  bits.AddAll(reduction.drift);
  std::array<double, kTangential> tangential;
  tangential.fill(0.3);
  bits.AddAll(reduction.After(tangential, 0.7, 1e-3));
}

// Coefficients that depend on the approach speed take powers and interpolate.
void AddCoefficients(Bits& bits) {
  const std::optional<SpeedDependence> power = PowerLaw{.alpha = 0.3, .exponent = 0.2};
  const std::optional<SpeedDependence> table = SpeedTable{.speed_m_s = {0.1, 1.0, 3.0}, .factor = {1.0, 0.7, 0.4}};
  AddSixteen([&](int i) {
    bits.Add(FactorAt(power, 0.05 + 0.3 * i));
    bits.Add(FactorAt(table, 0.05 + 0.3 * i));
  });
}

}  // namespace

std::vector<Probe> ProbeEngine() {
  std::vector<Probe> probes;
  for (int model = 0; model < kModelCount; ++model) {
    Bits bits;
    AddModel(static_cast<Model>(model), bits);
    probes.push_back({absl::StrCat("model ", model), std::move(bits).bits()});
  }
  std::array<Bits, std::variant_size_v<System>> by_system;
  for (const System& system : SystemProbes()) {
    const AnyReduction any = Reduce({.system = system, .finite_forces = ForcesOn(system)});
    std::visit([&](const auto& reduction) { AddReduction(reduction, by_system[system.index()]); }, any);
  }
  for (size_t i = 0; i < by_system.size(); ++i) {
    probes.push_back({absl::StrCat("system ", i), std::move(by_system[i]).bits()});
  }
  Bits coefficients;
  AddCoefficients(coefficients);
  probes.push_back({"coefficients", std::move(coefficients).bits()});
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

const EngineInfo& ThisEngine() {
  static const EngineInfo engine = {.version = RICOCHET_VERSION, .fingerprint = FingerprintOf(ProbeEngine())};
  return engine;
}

}  // namespace ricochet
