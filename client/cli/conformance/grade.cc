#include "client/cli/conformance/grade.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <vector>

namespace ricochet::cli {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The share of its terms below which a difference of doubles is rounding.
constexpr double kRounding = 0x1p-46;

double Largest(const VectorXd& x) { return x.lpNorm<Eigen::Infinity>(); }

LimitCheck Check(double value, double excess, double allowance) {
  const Verdict verdict = excess > allowance ? Verdict::kBroken
                          : excess > 0.0     ? Verdict::kWithinUncertainty
                                             : Verdict::kKept;
  return {.value = value, .excess = excess, .allowance = allowance, .verdict = verdict};
}

LimitCheck EnergyCheck(const ConformanceCase& one, const VectorXd& after, double tolerance) {
  const VectorXd moving = after - one.frame;
  const VectorXd momentum = one.mass * moving;
  const double gained = 0.5 * (moving + one.before - one.frame).dot(one.mass * (after - one.before));
  return Check(gained, gained, kRounding * moving.dot(momentum) + tolerance * momentum.lpNorm<1>());
}

LimitCheck ApproachCheck(const ConformanceCase& one, const VectorXd& after, double tolerance) {
  const VectorXd velocity = one.jacobian * (after - one.frame);
  const VectorXd allowance = tolerance * one.jacobian.cwiseAbs().rowwise().sum().array() + kRounding;
  Index worst = one.dimension - 1;
  for (Index row = worst; row < velocity.size(); row += one.dimension) {
    if (-velocity(row) - allowance(row) > -velocity(worst) - allowance(worst)) worst = row;
  }
  return Check(velocity(worst), -velocity(worst), allowance(worst));
}

// Columns that are combinations of the others to this share are taken for dependent.
constexpr double kDependent = 3e-7;

// Returns the x that makes |a x - b| least; nothing if the columns of a depend on each other.
std::optional<VectorXd> LeastSquares(const MatrixXd& a, const VectorXd& b) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(a.rows(), a.cols());
  qr.setThreshold(kDependent).compute(a);
  return qr.rank() == a.cols() ? std::optional<VectorXd>(qr.solve(b)) : std::nullopt;
}

// Returns the tangential directions, as columns, of the edges of a pyramid inside a friction cone, which is the cone
// itself in a plane. In space the first one lies at this angle.
MatrixXd Edges(int dimension, double angle) {
  if (dimension == 2) return Eigen::RowVector2d(1.0, -1.0);
  const double c = std::cos(angle), s = std::sin(angle);
  return (MatrixXd(2, 4) << c, -c, -s, s, s, -s, c, -c).finished();
}

// Returns the impulses along the edges of all cones, as columns. A cone without friction has one edge.
MatrixXd EdgeImpulses(const ConformanceCase& one, const MatrixXd& edges) {
  std::vector<VectorXd> impulses;
  for (Index contact = 0; contact < one.friction.size(); ++contact) {
    for (Index i = 0; i < (one.friction(contact) == 0.0 ? 1 : edges.cols()); ++i) {
      VectorXd& impulse = impulses.emplace_back(VectorXd::Zero(one.jacobian.rows()));
      impulse.segment(contact * one.dimension, one.dimension) << one.friction(contact) * edges.col(i), 1.0;
    }
  }
  MatrixXd columns(one.jacobian.rows(), impulses.size());
  for (size_t i = 0; i < impulses.size(); ++i) columns.col(static_cast<Index>(i)) = impulses[i];
  return columns;
}

// Returns what is left of the change of velocity after the impulse within the pyramids that leaves the least sum of
// squares. `effects` are the changes that unit impulses cause.
VectorXd OutsidePyramids(const ConformanceCase& one, const MatrixXd& effects, const VectorXd& change, double angle) {
  // Effects are scaled to unit length, so that those on heavy bodies count as those on light ones.
  const MatrixXd edges = (effects * EdgeImpulses(one, Edges(one.dimension, angle))).colwise().normalized();
  VectorXd least = change;
  // The nearest impulse lies on a face of the cones: on the edges of one subset.
  for (size_t subset = 1; subset < size_t{1} << edges.cols(); ++subset) {
    std::vector<Index> chosen;
    for (Index i = 0; i < edges.cols(); ++i) {
      if ((subset >> i & 1) != 0) chosen.push_back(i);
    }
    const MatrixXd face = edges(Eigen::all, chosen);
    const std::optional<VectorXd> shares = LeastSquares(face, change);
    if (!shares.has_value() || shares->minCoeff() < 0.0) continue;
    const VectorXd left = change - face * *shares;
    if (left.squaredNorm() < least.squaredNorm()) least = left;
  }
  return least;
}

// Returns the same for the friction cones: 0 to rounding exactly if some impulse within them causes the change. A case
// in space has one contact, whose nearest impulse lies in the pyramid with an edge in the right direction.
VectorXd OutsideCones(const ConformanceCase& one, const VectorXd& change) {
  const MatrixXd effects = one.mass.llt().solve(one.jacobian.transpose());
  const auto left = [&](double angle) { return OutsidePyramids(one, effects, change, angle); };
  const std::optional<VectorXd> impulse = LeastSquares(effects, change);
  double middle = impulse.has_value() ? std::atan2((*impulse)(1), (*impulse)(0)) : 0.0;
  VectorXd least = left(middle);
  if (one.dimension == 2) return least;
  // A pyramid has an edge in each quarter of a turn.
  constexpr int kSteps = 31;
  constexpr double kShrinks = 0.6;
  double step = 0.5;
  for (int i = 0; i < kSteps; ++i, step *= kShrinks) {
    for (const double angle : {middle - step, middle + step}) {
      const VectorXd beside = left(angle);
      if (!(beside.squaredNorm() < least.squaredNorm())) continue;
      least = beside;
      middle = angle;
    }
  }
  return least;
}

LimitCheck ConeCheck(const ConformanceCase& one, const VectorXd& after, double tolerance) {
  const VectorXd left = OutsideCones(one, after - one.before);
  // Since `left` is perpendicular to the nearest impulse and at least at a right angle to all others, each of them
  // leaves a vector whose product with `left` is left^2 or more, and so some velocity of at least left^2 / |left|_1.
  const double sum = left.lpNorm<1>();
  const double least = sum > 0.0 ? left.squaredNorm() / sum : 0.0;
  return Check(Largest(left), least, kRounding * (one.before.norm() + after.norm()) + tolerance);
}

LimitCheck SymmetryCheck(const ConformanceCase& one, const VectorXd& after, double tolerance) {
  double largest = 0.0;
  for (const std::vector<int>& symmetry : one.symmetries) {
    for (Index i = 0; i < after.size(); ++i) {
      const int place = symmetry[static_cast<size_t>(i)];
      const double image = after(std::abs(place) - 1);
      largest = std::max(largest, std::abs(after(i) - (place > 0 ? image : -image)));
    }
  }
  return Check(largest, largest, 2.0 * tolerance + kRounding);
}

// Decides whether some answer has the same numbers in another order.
bool IsInOtherOrder(const ConformanceCase& one, VectorXd after, double tolerance) {
  std::sort(after.begin(), after.end());
  return std::any_of(one.answers.begin(), one.answers.end(), [&](const RightAnswer& answer) {
    VectorXd right = answer.velocity_after;
    std::sort(right.begin(), right.end());
    return Largest(right - after) <= tolerance;
  });
}

// The errors from each right answer.
std::vector<double> ErrorsOf(const SimulatorAnswer& answer) {
  std::vector<double> errors;
  for (const RightAnswer& right : answer.asked->answers) {
    errors.push_back(Largest(answer.velocity_after - right.velocity_after));
  }
  return errors;
}

// Grades one answer by itself; `law` is the one that it is judged by.
CaseGrade GradeCase(const SimulatorAnswer& answer, const std::string& law, double tolerance) {
  const ConformanceCase& one = *answer.asked;
  const VectorXd& after = answer.velocity_after;
  CaseGrade grade{.asked = &one, .answered = true, .law = law, .error = std::numeric_limits<double>::infinity()};
  grade.errors = ErrorsOf(answer);
  for (size_t i = 0; i < one.answers.size(); ++i) {
    const RightAnswer& right = one.answers[i];
    const double error = grade.errors[i];
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
  // The answer for one order of impacts may be right without being symmetric.
  if (!grade.right || one.HasOneContact()) grade.symmetry = SymmetryCheck(one, after, tolerance);
  return grade;
}

// Returns the law that answers at one contact come nearest to most often; all within the tolerance are as near. Where
// several are as often, the last of them.
std::string NearestLaw(const SimulatorAnswers& answers, double tolerance) {
  std::map<std::string, int> counts;
  for (const SimulatorAnswer& answer : answers.answers) {
    const std::vector<double> errors = ErrorsOf(answer);
    const double nearest = std::max(tolerance, *std::min_element(errors.begin(), errors.end()));
    for (size_t i = 0; i < errors.size(); ++i) {
      const RightAnswer& right = answer.asked->answers[i];
      if (errors[i] > nearest) continue;
      ++counts[right.law];
      for (const std::string& law : right.also) ++counts[law];
    }
  }
  std::string commonest = kConformanceLaws.front();
  for (const std::string& law : kConformanceLaws) {
    if (counts[law] >= counts[commonest]) commonest = law;
  }
  return commonest;
}

}  // namespace

int Grade::RightCases() const {
  return static_cast<int>(std::count_if(cases.begin(), cases.end(), [](const CaseGrade& one) { return one.right; }));
}

Grade GradeOf(const SimulatorAnswers& answers, const GradeDemand& demand) {
  Grade grade{.demand = demand, .simulator = answers.simulator, .law = demand.law};
  // Only answers at one contact have a law that counts.
  bool all_state = true;
  for (const SimulatorAnswer& answer : answers.answers) {
    if (!answer.asked->HasOneContact()) continue;
    all_state = all_state && !answer.law.empty();
    if (grade.law.empty()) grade.law = answer.law;
  }
  grade.law_found = demand.law.empty() && (!all_state || grade.law.empty());
  if (grade.law_found) grade.law = NearestLaw(answers, demand.tolerance);
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
