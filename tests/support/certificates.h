// Certificates as tests read them: numbers by path, digits as balls, problems as scenes.

#ifndef RICOCHET_TESTS_SUPPORT_CERTIFICATES_H_
#define RICOCHET_TESTS_SUPPORT_CERTIFICATES_H_

#include <gtest/gtest.h>

#include <string>

#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "ricochet/certificate.h"
#include "ricochet/scene.h"
#include "tests/support/arb.h"

namespace ricochet {

inline constexpr slong kTestBits = 4096;

// A caller that never stops what it has asked for.
inline bool Never() { return false; }

// The number at `path`; one without a path where there is none.
inline CertifiedNumber NumberAt(const Certificate& certificate, const std::string& path) {
  for (const CertifiedNumber& number : certificate.numbers) {
    if (number.path == path) return number;
  }
  return {};
}

inline std::string DecimalAt(const Certificate& certificate, const std::string& path) {
  return NumberAt(certificate, path).decimal;
}

// A decimal, to far more than its digits.
inline Ball Digits(const std::string& decimal) { return Ball::Parse(decimal, kTestBits); }

// Whether two decimals differ by less than 10^-digits of the first, or are both 0.
inline bool Agree(const std::string& x, const std::string& y, int digits) {
  Ball allowed = Abs(Digits(x));
  for (int i = 0; i < digits; ++i) allowed = allowed / Ball(10.0, kTestBits);
  return Abs(Digits(x) - Digits(y)) <= allowed;
}

// Whether a range or a decimal of `set` holds the decimal.
inline bool Holds(const CertifiedNumber& set, const std::string& decimal) {
  if (!set.decimal.empty()) return Agree(set.decimal, decimal, 15);
  const bool above = set.lower == "-inf" || Digits(set.lower) <= Digits(decimal);
  return above && (set.upper == "inf" || Digits(decimal) <= Digits(set.upper));
}

inline Restitution RestitutionOf(RestitutionLaw law, double coefficient) {
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

inline Scene SceneOf(const pendulum::Problem& p) {
  return {.system = Pendulum{p.inertia, p.a, p.b, p.omega_minus},
          .friction = {.kinetic_coefficient = p.mu, .static_coefficient = p.mu_static},
          .restitution = RestitutionOf(p.law, p.coefficient)};
}

inline Scene SceneOf(const planar::Problem& p) {
  return {.system = PlanarContact{p.w.tt, p.w.tn, p.w.nn, p.u0, p.v0},
          .friction = {.kinetic_coefficient = p.mu, .static_coefficient = p.mu_static},
          .restitution = RestitutionOf(p.law, p.coefficient)};
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_CERTIFICATES_H_
