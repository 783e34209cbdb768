#include "client/cli/conformance/grade.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>

#include "client/cli/conformance/cone_distance.h"

namespace ricochet::cli {
namespace {

using Vector = std::vector<double>;

// The share of its terms below which a difference of doubles is rounding.
constexpr double kRounding = 0x1p-46;

double LargestDifference(const Vector& x, const Vector& y) {
  double largest = 0.0;
  for (size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
  return largest;
}

LimitCheck Check(double value, double excess, double allowance) {
  const Verdict exceeded = excess > allowance ? Verdict::kBroken : Verdict::kWithinUncertainty;
  return {
      .value = value, .excess = excess, .allowance = allowance, .verdict = excess > 0.0 ? exceeded : Verdict::kKept};
}

Vector Minus(const Vector& x, const Vector& y) {
  Vector difference(x.size());
  for (size_t i = 0; i < x.size(); ++i) difference[i] = x[i] - y[i];
  return difference;
}

LimitCheck EnergyCheck(const ConformanceCase& one, const Vector& after, double tolerance) {
  const Vector moving = Minus(after, one.frame);
  const Vector sum = Minus(moving, Minus(one.frame, one.before));
  const Vector change = Times(one.mass, Minus(after, one.before));
  const double gained = 0.5 * Dot(sum, change);
  double allowance = kRounding * Dot(moving, Times(one.mass, moving));
  for (const double momentum : Times(one.mass, moving)) allowance += tolerance * std::abs(momentum);
  return Check(gained, gained, allowance);
}

LimitCheck ApproachCheck(const ConformanceCase& one, const Vector& after, double tolerance) {
  const Vector velocity = Times(one.jacobian, Minus(after, one.frame));
  LimitCheck worst = Check(0.0, -1.0, 0.0);
  const auto step = static_cast<size_t>(one.dimension);
  for (size_t row = step - 1; row < velocity.size(); row += step) {
    double allowance = 0.0;
    for (const double entry : one.jacobian[row]) allowance += tolerance * std::abs(entry);
    const LimitCheck check = Check(velocity[row], -velocity[row], allowance + kRounding);
    if (row == step - 1 || check.excess - check.allowance > worst.excess - worst.allowance) worst = check;
  }
  return worst;
}

LimitCheck ConeCheck(const ConformanceCase& one, const Vector& after, double tolerance) {
  const Vector left = OutsideCones(one, Minus(after, one.before));
  double allowance = kRounding * std::sqrt(Dot(one.before, Times(one.mass, one.before)));
  for (size_t i = 0; i < left.size(); ++i) allowance += tolerance * std::sqrt(one.mass[i][i]);
  const double largest = LargestDifference(left, Vector(left.size()));
  return Check(largest, std::sqrt(Dot(left, Times(one.mass, left))), allowance);
}

LimitCheck SymmetryCheck(const ConformanceCase& one, const Vector& after, double tolerance) {
  double largest = 0.0;
  for (const std::vector<int>& symmetry : one.symmetries) {
    for (size_t i = 0; i < after.size(); ++i) {
      const double image = after[static_cast<size_t>(std::abs(symmetry[i])) - 1];
      largest = std::max(largest, std::abs(after[i] - (symmetry[i] > 0 ? image : -image)));
    }
  }
  return Check(largest, largest, 2.0 * tolerance + kRounding);
}

// Decides whether some answer has the same numbers in another order.
bool IsInOtherOrder(const ConformanceCase& one, Vector after, double tolerance) {
  std::sort(after.begin(), after.end());
  return std::any_of(one.answers.begin(), one.answers.end(), [&](const RightAnswer& answer) {
    Vector right = answer.velocity_after;
    std::sort(right.begin(), right.end());
    return LargestDifference(right, after) <= tolerance;
  });
}

// Returns the law that most answers obey at one contact. Where several do as often, the last of them.
std::string CommonestLaw(const SimulatorAnswers& answers, double tolerance) {
  std::map<std::string, int> counts;
  for (const SimulatorAnswer& answer : answers.answers) {
    for (const std::string& law : GradeCase(answer, "", tolerance).obeyed) ++counts[law];
  }
  std::string commonest = kConformanceLaws.front();
  for (const std::string& law : kConformanceLaws) {
    if (counts[law] >= counts[commonest]) commonest = law;
  }
  return commonest;
}

}  // namespace

CaseGrade GradeCase(const SimulatorAnswer& answer, const std::string& law, double tolerance) {
  const ConformanceCase& one = *answer.asked;
  const Vector& after = answer.velocity_after;
  CaseGrade grade{.asked = &one, .answered = true, .law = law, .error = std::numeric_limits<double>::infinity()};
  for (const RightAnswer& right : one.answers) {
    const double error = LargestDifference(after, right.velocity_after);
    grade.errors.push_back(error);
    const bool judges = one.HasOneContact() ? right.law == law : error < grade.error;
    if (judges) grade.error = error;
    if (judges) grade.law = right.law;
    if (error > tolerance) continue;
    grade.obeyed.push_back(right.law);
    grade.obeyed.insert(grade.obeyed.end(), right.also.begin(), right.also.end());
  }
  grade.right = grade.error <= tolerance;
  grade.other_order = grade.obeyed.empty() && IsInOtherOrder(one, after, tolerance);
  grade.energy = EnergyCheck(one, after, tolerance);
  grade.approach = ApproachCheck(one, after, tolerance);
  grade.cone = ConeCheck(one, after, tolerance);
  grade.symmetry = SymmetryCheck(one, after, tolerance);
  return grade;
}

int Grade::RightCases() const {
  return static_cast<int>(std::count_if(cases.begin(), cases.end(), [](const CaseGrade& one) { return one.right; }));
}

Grade GradeOf(const SimulatorAnswers& answers, const GradeDemand& demand) {
  Grade grade{.demand = demand, .simulator = answers.simulator, .law = demand.law};
  for (const SimulatorAnswer& answer : answers.answers) {
    if (grade.law.empty()) grade.law = answer.law;
  }
  grade.law_found = grade.law.empty();
  if (grade.law_found) grade.law = CommonestLaw(answers, demand.tolerance);
  for (const ConformanceCase* asked : demand.asked) {
    const auto found = std::find_if(answers.answers.begin(), answers.answers.end(),
                                    [&](const SimulatorAnswer& answer) { return answer.asked == asked; });
    if (found == answers.answers.end()) {
      grade.cases.push_back({.asked = asked});
      continue;
    }
    const bool own = demand.law.empty() && !found->law.empty();
    grade.cases.push_back(GradeCase(*found, own ? found->law : grade.law, demand.tolerance));
  }
  return grade;
}

}  // namespace ricochet::cli
