// Laws of restitution by the names that tables of tests give them: newton, poisson and energetic.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_LAWS_BY_NAME_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_LAWS_BY_NAME_H_

#include <map>
#include <string>

#include "core/models/restitution_law.h"
#include "ricochet/scene.h"

namespace ricochet {

inline RestitutionLaw LawOf(const std::string& name) {
  static const std::map<std::string, RestitutionLaw> laws = {{"newton", RestitutionLaw::kNewton},
                                                             {"poisson", RestitutionLaw::kPoisson},
                                                             {"energetic", RestitutionLaw::kEnergetic}};
  return laws.at(name);
}

inline Restitution RestitutionOf(const std::string& law, double value) {
  switch (LawOf(law)) {
    case RestitutionLaw::kNewton:
      return NewtonCoefficient{value};
    case RestitutionLaw::kPoisson:
      return PoissonCoefficient{value};
    case RestitutionLaw::kEnergetic:
      return EnergeticCoefficient{value};
  }
  return {};
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_LAWS_BY_NAME_H_
