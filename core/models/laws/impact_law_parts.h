// NewtonImpact: the algebra that the impact laws share (core/models/laws/impact_law.h), private to core/models/laws.
//
// Let c = -(1 + e) v0 be the change of the normal velocity. W^-1 (-u0, c) is the impulse that ends without slip:
//
//   (f, tau)_stick = (-G, T)/det W,   G = u0 wnn + c wtn,   T = c wtt + u0 wtn
//
// and an impulse with f = r tau gives tau1 = c/(wnn + r wtn) and u1 = (G + r T)/(wnn + r wtn).

#ifndef RICOCHET_CORE_MODELS_LAWS_IMPACT_LAW_PARTS_H_
#define RICOCHET_CORE_MODELS_LAWS_IMPACT_LAW_PARTS_H_

#include <optional>

#include "core/models/laws/impact_law.h"

namespace ricochet::laws {

// The sign of x: -1, 0 or 1.
double Sign(double x);

class NewtonImpact {
 public:
  NewtonImpact(const PlanarProblem& input, double e);

  // The result if the contact separates or cannot move along the normal, which is the same for all laws.
  std::optional<ImpactLawResult> Trivial() const;

  bool rank_one() const { return det_ == 0.0; }
  double det() const { return det_; }              // Exactly 0 if the rank is one.
  double normal_change() const { return c_; }      // c, m/s
  double frictionless_slip() const { return h_; }  // u0 wnn - v0 wtn: slip after frictionless compression, times wnn.
  double tangential_numerator() const { return g_; }  // G
  double normal_numerator() const { return t_; }      // T
  double NormalSlope(double ratio) const;             // wnn + ratio wtn = dv/dtau, rounded once.
  ImpactSolution Solution(double f, double tau1, double u1) const;
  // The solution with f = ratio tau1; none if wnn + ratio wtn <= 0, because no impulse then ends the approach.
  std::optional<ImpactSolution> AtRatio(double ratio) const;

 private:
  PlanarProblem in_;
  double e_;
  double c_;
  double det_;
  double h_;
  double g_ = 0.0;
  double t_ = 0.0;
};

// The result that has `solution` alone, or no solution.
ImpactLawResult AtMostOne(const std::optional<ImpactSolution>& solution);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_IMPACT_LAW_PARTS_H_
