#include "core/models/planar/columns.h"

#include <cassert>

namespace ricochet::planar {
namespace {

double Number(const Impact& impact, double relative_error, Output output) {
  switch (output) {
    case Output::kNewton:
      return impact.newton;
    case Output::kPoisson:
      return impact.poisson;
    case Output::kEnergetic:
      return impact.energetic;
    case Output::kTangentialCoefficient:
      return impact.tangential;
    case Output::kTangentialVelocityAfter:
      return impact.u1;
    case Output::kNormalVelocityAfter:
      return impact.v1;
    case Output::kNormalImpulseCompression:
      return impact.tau_compression;
    case Output::kNormalImpulse:
      return impact.tau1;
    case Output::kTangentialImpulse:
      return impact.f1;
    case Output::kWorkNormalCompression:
      return impact.work_normal_compression;
    case Output::kWorkNormalRestitution:
      return impact.work_normal_restitution;
    case Output::kWorkTangentialCompression:
      return impact.work_tangential_compression;
    case Output::kWorkTangentialRestitution:
      return impact.work_tangential_restitution;
    case Output::kWorkNormal:
      return impact.work_normal_compression + impact.work_normal_restitution;
    case Output::kWorkTangential:
      return impact.work_tangential_compression + impact.work_tangential_restitution;
    case Output::kFrictionDissipation:
      return 0.0 - (impact.work_tangential_compression + impact.work_tangential_restitution);
    case Output::kEnergyChange:
      return impact.energy_change;
    case Output::kRelativeError:
      return relative_error;
  }
  return 0.0;
}

void Write(const Impact& impact, double relative_error, size_t i, const SolvedColumns& solved) {
  for (size_t c = 0; c < solved.outputs.size(); ++c) {
    solved.columns[c][i] = Number(impact, relative_error, solved.outputs[c]);
  }
  if (!solved.regimes.empty()) solved.regimes[i] = impact.regime;
  if (!solved.inadmissible.empty()) {
    solved.inadmissible[i] = impact.sharp_limit_broken || impact.energy_limit_broken;
  }
}

// Returns whether plain arithmetic serves.
bool SolveAlone(const Problem& problem, double tolerance, size_t i, const SolvedColumns& solved) {
  if (tolerance > 0.0) {
    const PlainImpact plain = SolvePlain(problem);
    const double error = plain.errors.Largest();
    if (plain.proved && error <= tolerance) {
      Write(plain.impact, error, i, solved);
      return true;
    }
  }
  RoundingErrors errors;
  const Impact impact = Solve(problem, errors);
  Write(impact, errors.Largest(), i, solved);
  return false;
}

}  // namespace

Problem ProblemColumns::operator[](size_t i) const {
  return {.w = {wtt[i], wtn[i], wnn[i]},
          .u0 = u0[i],
          .v0 = v0[i],
          .mu = mu[i],
          .mu_static = mu_static[i],
          .law = law,
          .coefficient = coefficient[i]};
}

size_t SolveColumns(const ProblemColumns& problems, double tolerance, const SolvedColumns& solved) {
  assert(solved.outputs.size() == solved.columns.size());
  size_t compensated = 0;
  for (size_t i = 0; i < problems.size(); ++i) {
    if (!SolveAlone(problems[i], tolerance, i, solved)) ++compensated;
  }
  return compensated;
}

}  // namespace ricochet::planar
