// Asks for everything by requests that name few of their members, as programs do. It is compiled with the usual
// warnings as errors, and does not run.

#include "ricochet/solver.h"

namespace {

using ricochet::EnergeticCoefficient, ricochet::PlanarBody, ricochet::Scene;

Scene Rod() {
  return {.system = PlanarBody{.mass_kg = 1, .inertia_com_kg_m2 = 0.1, .velocity_n_m_s = -1},
          .friction = {.kinetic_coefficient = 0.3},
          .restitution = EnergeticCoefficient{0.5}};
}

}  // namespace

bool AnswersEverything(const ricochet::Solver& solver) {
  bool all = solver.Solve({.scene = Rod()}).ok() && solver.Plan({.scene = Rod()}).ok() &&
             solver.Solve({.scene = {.system = PlanarBody{1, 1}}, .demand = {.relative_tolerance = 1e-3}}).ok();
  all = all && solver.Bounds({.scene = Rod()}).ok() && solver.Audit({.scene = Rod()}).ok() &&
        solver.AuditBatch({.scene = Rod()}).ok();
  all = all && solver.OpenBatches({.scene = {.system = PlanarBody{1, 1}}, .columns = {"newton"}}).ok();
  all = all && solver.Fit({.scene = Rod(), .unknowns = {{.path = "mu"}}, .measured = {{.path = "newton"}}}).ok();
  all = all && solver.MultiContact({.scene = {}}).ok();
  for (const auto& chunk : solver.Sweep({.grid = {.scene = Rod(), .axes = {{.path = "mu"}}}, .columns = {"newton"}})) {
    all = all && chunk.ok();
  }
  for (const auto& chunk : solver.Cost({.scene = Rod()})) all = all && chunk.ok();
  return all;
}
