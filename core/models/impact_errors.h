// ImpactErrors: the errors of the numbers of an impact (ImpactEnd), each in the unit of its number and on its scale.
//
// A model bounds or estimates the errors of its velocities, impulses and works. Those of the coefficients follow: each
// is a quotient of two such numbers. An error that is not known is infinite. Errors are those of the model for the
// numbers of its problem as they are stated; what its plan leaves out comes on top. docs/theory/rounding.md derives the
// coefficients'. RelativeErrors: proved bounds over the contact speed.

#ifndef RICOCHET_CORE_MODELS_IMPACT_ERRORS_H_
#define RICOCHET_CORE_MODELS_IMPACT_ERRORS_H_

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "core/models/impact_end.h"
#include "core/models/restitution_law.h"

namespace ricochet {

// Proved bounds on the error of a model's answer, all divided by V = max(|u0|, |v0|).
struct RelativeErrors {
  double velocity = 0.0;  // Error of each component of the contact velocity after the impact.
  // Error of each impulse times its mobility: Wnn |d tau1|, Wtt |d f1|; in space (W11 + W22) |d f1| for each component.
  double impulse = 0.0;

  double Largest() const { return std::max(velocity, impulse); }
};

struct ImpactErrors {
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  double newton = kUnknown, poisson = kUnknown, energetic = kUnknown, tangential = kUnknown;
  double u = kUnknown, v = kUnknown;  // of the velocities after; in space the error of each component
  double tau_compression = kUnknown, tau = kUnknown, f = kUnknown;
  double work_normal_compression = kUnknown, work_normal_restitution = kUnknown;
  double work_tangential_compression = kUnknown, work_tangential_restitution = kUnknown;
  double energy_change = kUnknown;
};

// Returns an estimate or bound of an error, and infinity for one that is no number: a product of an infinity and 0.
inline double KnownError(double error) { return error >= 0.0 ? error : ImpactErrors::kUnknown; }

namespace internal {

// A bound on the error of the quotient x/y = `quotient`, y > 0; infinite where y may be 0.
inline double ErrorOfQuotient(double quotient, double x_error, double y, double y_error) {
  constexpr double kRounding = 0x1p-51;
  const double least = y - y_error;
  if (!(least > 0.0)) return ImpactErrors::kUnknown;
  const double size = std::fabs(quotient);
  return (1.0 + kRounding) * (x_error / least + size * (y_error / least)) + kRounding * size +
         std::numeric_limits<double>::denorm_min();
}

}  // namespace internal

// The errors of the impulses in a plane by those of velocities, W (f, tau) = d(u, v): `determinant` is that of W.
struct ImpulseErrors {
  double tau = ImpactErrors::kUnknown, f = ImpactErrors::kUnknown;
};
inline ImpulseErrors ErrorsOfImpulses(double wtt, double wtn, double wnn, double determinant, double u_error,
                                      double v_error) {
  if (!(determinant > 0.0)) return {};
  const double coupling = std::fabs(wtn);
  return {.tau = (wtt * v_error + coupling * u_error) / determinant,
          .f = (wnn * u_error + coupling * v_error) / determinant};
}

// Sets the errors of the coefficients of an impact that starts with v0. A coefficient that the law states is exact, and
// all three are where there is no restitution.
template <typename Tangential>
void SetCoefficientErrors(const ImpactEnd<Tangential>& impact, double v0, RestitutionLaw law, double coefficient,
                          ImpactErrors& errors) {
  using internal::ErrorOfQuotient;
  const double tau_c = impact.tau_compression;
  const double work_c = -impact.work_normal_compression;
  const double f_error = std::is_same_v<Tangential, double> ? errors.f : errors.f * std::sqrt(2.0);
  errors.tangential = ErrorOfQuotient(impact.tangential, f_error, impact.tau1, errors.tau);
  errors.newton = ErrorOfQuotient(impact.newton, errors.v, -v0, 0.0);
  if (impact.regime == Regime::kLocked && std::isinf(errors.tau_compression)) {
    // The true contact may lock a little later, in restitution.
    errors.poisson = errors.energetic = errors.tau_compression;
    return;
  }
  if (impact.regime == Regime::kLocked || coefficient == 0.0) {
    errors.newton = errors.poisson = errors.energetic = 0.0;
    return;
  }
  errors.poisson = ErrorOfQuotient(1.0 + impact.poisson, errors.tau, tau_c, errors.tau_compression);
  const double square = impact.energetic * impact.energetic;
  const double of_square =
      ErrorOfQuotient(square, errors.work_normal_restitution, work_c, errors.work_normal_compression);
  const double least = std::sqrt(std::max(square - of_square, 0.0));
  errors.energetic = of_square == 0.0 ? 0.0 : of_square / (impact.energetic + least) + 0x1p-52 * impact.energetic;
  switch (law) {
    case RestitutionLaw::kNewton:
      if (impact.newton == coefficient) errors.newton = 0.0;
      break;
    case RestitutionLaw::kPoisson:
      if (impact.poisson == coefficient) errors.poisson = 0.0;
      break;
    case RestitutionLaw::kEnergetic:
      if (impact.energetic == coefficient) errors.energetic = 0.0;
      break;
  }
}

// The errors of an impact in which nothing changes: none of its numbers is computed.
inline ImpactErrors NoErrors() {
  ImpactErrors none;
  for (double* error :
       {&none.newton, &none.poisson, &none.energetic, &none.tangential, &none.u, &none.v, &none.tau_compression,
        &none.tau, &none.f, &none.work_normal_compression, &none.work_normal_restitution,
        &none.work_tangential_compression, &none.work_tangential_restitution, &none.energy_change}) {
    *error = 0.0;
  }
  return none;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_MODELS_IMPACT_ERRORS_H_
