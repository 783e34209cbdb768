// Grades the answers of a simulator to the conformance cases: which law it obeys, and which limits it breaks.
//
// An error is the largest difference to a right answer of all velocities, in m/s or rad/s. The limits are those of an
// audit (ricochet/audit.h), for any number of contacts: kinetic energy, bodies that still approach, and the friction
// cones, outside which lies what no impulse within them explains. A limit is broken if it is exceeded by more than
// velocities that are wrong by the tolerance can cause. conformance/grade.py gives the same verdicts.

#ifndef RICOCHET_CLIENT_CLI_CONFORMANCE_GRADE_H_
#define RICOCHET_CLIENT_CLI_CONFORMANCE_GRADE_H_

#include <string>
#include <vector>

#include "client/cli/conformance/answers.h"
#include "client/cli/conformance/cases.h"
#include "ricochet/audit.h"

namespace ricochet::cli {

struct GradeDemand {
  double tolerance = 1e-9;
  std::string law;                            // The law to be obeyed at one contact; empty: see LawOf.
  std::vector<const ConformanceCase*> asked;  // In order.
};

struct CaseGrade {
  const ConformanceCase* asked = nullptr;
  bool answered = false;            // If not, all that follows is empty.
  std::string law;                  // At one contact the law that it is judged by, at several the nearest answer's.
  double error = 0.0;               // From that law's answer.
  bool right = false;               // The error is within the tolerance.
  std::vector<double> errors;       // From each answer of the case.
  std::vector<std::string> obeyed;  // All laws, orders or springs within the tolerance.
  bool other_order = false;         // The numbers are those of a right answer, but in another order.
  // `energy` is in J; `approach` in m/s. The value of `cone` is the largest velocity, in m/s or rad/s, that the nearest
  // impulse within the cones leaves unexplained, and its excess a bound that any impulse within them exceeds.
  // The value of `symmetry` is the largest difference to the mirror image. Broken limits are Verdict::kBroken.
  LimitCheck energy, approach, cone, symmetry;
};

struct Grade {
  GradeDemand demand;
  std::string simulator;
  std::string law;         // The law that most cases are judged by, and
  bool law_found = false;  // whether it was found as the one that answers come nearest to.
  std::vector<CaseGrade> cases;

  int RightCases() const;
  bool AllRight() const { return RightCases() == static_cast<int>(cases.size()); }
};

// Judges all answers by the law of the demand; else each by its own law, and those without one by the law that the
// answers at one contact match most often.
Grade GradeOf(const SimulatorAnswers& answers, const GradeDemand& demand);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_CONFORMANCE_GRADE_H_
