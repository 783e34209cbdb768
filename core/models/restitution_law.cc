#include "core/models/restitution_law.h"

#include <variant>

namespace ricochet {

StatedRestitution LawAndCoefficientOf(const Restitution& restitution) {
  struct Reader {
    StatedRestitution operator()(std::monostate) const { return {}; }
    StatedRestitution operator()(NewtonCoefficient given) const { return {RestitutionLaw::kNewton, given.value}; }
    StatedRestitution operator()(PoissonCoefficient given) const { return {RestitutionLaw::kPoisson, given.value}; }
    StatedRestitution operator()(EnergeticCoefficient given) const { return {RestitutionLaw::kEnergetic, given.value}; }
  };
  return std::visit(Reader(), restitution);
}

Restitution ToRestitution(RestitutionLaw law, double coefficient) {
  switch (law) {
    case RestitutionLaw::kNewton:
      return NewtonCoefficient{coefficient};
    case RestitutionLaw::kPoisson:
      return PoissonCoefficient{coefficient};
    case RestitutionLaw::kEnergetic:
      break;
  }
  return EnergeticCoefficient{coefficient};
}

}  // namespace ricochet
