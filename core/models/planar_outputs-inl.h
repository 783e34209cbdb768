// ForEachOutput: every output of a planar impact (core/models/planar_outputs.h), of one problem or of one in each lane.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_PLANAR_OUTPUTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_PLANAR_OUTPUTS_INL_H_
#undef RICOCHET_CORE_MODELS_PLANAR_OUTPUTS_INL_H_
#else
#define RICOCHET_CORE_MODELS_PLANAR_OUTPUTS_INL_H_
#endif

#include "core/models/planar_outputs.h"
#include "core/numerics/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

// Calls tell(output, value) for every output of an impact. `V` is double or a vector.
template <typename X, typename V, typename Tell>
HWY_INLINE void ForEachOutput(const X& x, V zero, V relative_error, const Tell& tell) {
  using Output = PlanarOutput;
  const V work_tangential = x.work_tangential_compression + x.work_tangential_restitution;
  tell(Output::kNewton, x.newton);
  tell(Output::kPoisson, x.poisson);
  tell(Output::kEnergetic, x.energetic);
  tell(Output::kTangentialCoefficient, x.tangential);
  tell(Output::kTangentialVelocityAfter, x.u1);
  tell(Output::kNormalVelocityAfter, x.v1);
  tell(Output::kNormalImpulseCompression, x.tau_compression);
  tell(Output::kNormalImpulse, x.tau1);
  tell(Output::kTangentialImpulse, x.f1);
  tell(Output::kWorkNormalCompression, x.work_normal_compression);
  tell(Output::kWorkNormalRestitution, x.work_normal_restitution);
  tell(Output::kWorkTangentialCompression, x.work_tangential_compression);
  tell(Output::kWorkTangentialRestitution, x.work_tangential_restitution);
  tell(Output::kWorkNormal, x.work_normal_compression + x.work_normal_restitution);
  tell(Output::kWorkTangential, work_tangential);
  tell(Output::kFrictionDissipation, zero - work_tangential);
  tell(Output::kEnergyChange, x.energy_change);
  tell(Output::kRelativeError, relative_error);
}

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
