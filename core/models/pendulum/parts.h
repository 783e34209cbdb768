// Parts: the intermediate results that a pendulum's outputs need, so that a sweep computes only those of its columns.

#ifndef RICOCHET_CORE_MODELS_PENDULUM_PARTS_H_
#define RICOCHET_CORE_MODELS_PENDULUM_PARTS_H_

#include <cmath>

#include "core/models/pendulum/pendulum.h"

namespace ricochet::pendulum {

// The intermediate results that outputs share.
enum Part : unsigned {
  kPartKappa = 1U << 0,
  kPartKappaHat = 1U << 1,
  kPartOneMinusKappa = 1U << 2,
  kPartEta = 1U << 3,
  kPartEtaSquared = 1U << 4,
  kPartEnergyLoss = 1U << 5,
  kPartTau0 = 1U << 6,
  kPartWork = 1U << 7,
  kPartAll = (1U << 8) - 1,
};

// The parts that an output needs.
inline unsigned PartsOf(Output output) {
  switch (output) {
    case Output::kNewton:
    case Output::kOmegaPlus:
    case Output::kTangentialVelocityAfter:
    case Output::kNormalVelocityAfter:
      return kPartKappaHat;
    case Output::kPoisson:
      return kPartKappa;
    case Output::kEnergetic:
    case Output::kEnergeticExcess:
      return kPartEta;
    case Output::kTangentialCoefficient:
      return kPartKappa | kPartOneMinusKappa;
    case Output::kNormalImpulse:
      return kPartKappa | kPartTau0;
    case Output::kTangentialImpulse:
      return kPartKappa | kPartOneMinusKappa | kPartTau0;
    case Output::kNormalImpulseCompression:
    case Output::kTangentialImpulseCompression:
      return kPartTau0;
    case Output::kWorkNormalCompression:
    case Output::kWorkTangentialCompression:
    case Output::kWorkNormal:
      return kPartTau0 | kPartWork;
    case Output::kWorkNormalRestitution:
    case Output::kWorkTangentialRestitution:
    case Output::kWorkTangential:
      return kPartTau0 | kPartWork | kPartEtaSquared;
    case Output::kEnergyChange:
      return kPartEnergyLoss;
  }
  return 0;
}

// True if friction does not couple the tangential to the normal direction.
inline bool IsSmooth(const Problem& problem) { return problem.mu == 0.0 || problem.b == 0.0; }

// mu with the sign of b; 0 if the directions are not coupled.
inline double SignedFriction(const Problem& problem) {
  return IsSmooth(problem) ? 0.0 : std::copysign(problem.mu, problem.b);
}

// The regime of a problem that does not separate.
inline Regime RegimeOf(const Problem& problem, bool locked) {
  if (locked) return Regime::kLocked;
  return IsSmooth(problem) ? Regime::kFrictionless : Regime::kRebound;
}

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_MODELS_PENDULUM_PARTS_H_
