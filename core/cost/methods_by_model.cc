#include "core/cost/methods_by_model.h"

#include "absl/types/span.h"
#include "core/plan/candidates.h"

namespace ricochet {
namespace {

// The effects that a model simulates, of any contact.
EffectSet SimulatedBy(Model model) {
  EffectSet simulated;
  const auto add = [&](absl::Span<const Candidate> candidates) {
    for (const Candidate& candidate : candidates) {
      if (candidate.model == model) simulated = simulated | candidate.simulates;
    }
  };
  add(kPlanarCandidates);
  add(kPendulumCandidates);
  add(kSpatialCandidates);
  return simulated;
}

}  // namespace

Demand DemandFor(Model model) {
  // The rounding errors of the frictionless form exceed a tolerance of 0, so it gets a larger one; with friction
  // excluded there is no cheaper model.
  const EffectSet simulated = SimulatedBy(model);
  Demand demand = {.relative_tolerance = model == Model::kFrictionless ? 0.1 : 0.0};
  for (const Effect effect : kEffects) {
    if (!simulated.Has(effect)) demand.excluded.Add(effect);
  }
  return demand;
}

std::string NameOf(Arithmetic arithmetic) {
  switch (arithmetic) {
    case Arithmetic::kPlain:
      return "plain";
    case Arithmetic::kCompensated:
      return "compensated";
    case Arithmetic::kCertified:
      return "certified";
    case Arithmetic::kUnspecified:
      break;
  }
  return "";
}

}  // namespace ricochet
