#include "core/engine/engine.h"

#include <cstdint>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/contact/reduction.h"
#include "core/models/compliant/compliant.h"
#include "core/models/pendulum/first_order.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "core/models/sliding/sliding.h"
#include "core/models/spatial/spatial.h"
#include "core/numerics/stable_hash.h"

namespace ricochet {
namespace {

// One of 64 pendulums, which together reach every law and regime.
pendulum::Problem Probe(int i) {
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

template <typename Impact>
void Add(const Impact& impact, StableHash& hash) {
  hash.Add(static_cast<uint64_t>(impact.regime));
  for (const double value : {impact.v1, impact.tau_compression, impact.tau1, impact.work_normal_compression,
                             impact.work_normal_restitution, impact.energy_change}) {
    hash.Add(value);
  }
}

void Add(const PlanarReduction& reduction, StableHash& hash) {
  for (const double value : reduction.w) hash.Add(value);
  for (const double value : reduction.response) hash.Add(value);
  hash.Add(reduction.u0[0]);
  hash.Add(reduction.v0);
}

void AddValues(const pendulum::Impact& impact, StableHash& hash) {
  hash.Add(static_cast<uint64_t>(impact.regime));
  for (const double value : impact.values) hash.Add(value);
}

// Adds both arithmetics of the closed forms, each with the bound on its rounding error.
void AddArithmetics(const planar::Problem& problem, StableHash& hash) {
  planar::RoundingErrors errors;
  Add(planar::Solve(problem, errors), hash);
  hash.Add(errors.Largest());
  const planar::PlainImpact plain = planar::SolvePlain(problem);
  if (!plain.proved) return;
  Add(plain.impact, hash);
  hash.Add(plain.errors.Largest());
}

void AddArithmetics(const pendulum::Problem& problem, StableHash& hash) {
  AddValues(pendulum::Solve(problem), hash);
  const pendulum::PlainImpact plain = pendulum::SolvePlain(problem);
  if (!plain.proved) return;
  AddValues(plain.impact, hash);
  hash.Add(plain.relative_error);
}

std::string Fingerprint() {
  StableHash hash;
  for (int i = 0; i < 16; ++i) {
    AddArithmetics(PlanarProbe(i), hash);
    Add(spatial::Solve(SpatialProbe(i)), hash);
    Add(compliant::Solve(CompliantProbe(i)), hash);
    Add(sliding::Solve(SlidingProbe(i)), hash);
    Add(sliding::SolveFrictionless(SlidingProbe(i)), hash);
    Add(sliding::Solve(SpatialSlidingProbe(i)), hash);
    Add(std::get<PlanarReduction>(Reduce({.system = LinkageProbe(i)})), hash);
  }
  for (int i = 0; i < 64; ++i) {
    AddArithmetics(Probe(i), hash);
    if (i % 4 == 0 && first_order::Serves(Probe(i))) AddValues(first_order::Solve(Probe(i)), hash);
  }
  return absl::StrCat(absl::Hex(hash.value(), absl::kZeroPad16));
}

}  // namespace

const EngineInfo& ThisEngine() {
  static const EngineInfo engine = {.version = RICOCHET_VERSION, .fingerprint = Fingerprint()};
  return engine;
}

}  // namespace ricochet
