#include "core/fit/information.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/SpecialFunctions>

#include "core/numerics/elementary.h"

namespace ricochet::fit {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// Differences are exact to some 1e-7 of the numbers: a slope below this part of them is nothing.
constexpr double kNothing = 1e-6;
// An unknown with a smaller part of a combination that is not seen is seen by itself.
constexpr double kLeastPart = 1e-3;

// The share of each row in the square of a column of J.
std::vector<double> SharesOf(const Problem& problem, const Eigen::VectorXd& column) {
  std::vector<double> shares(problem.rows, 0.0);
  for (size_t i = 0; i < problem.numbers.size(); ++i) {
    const double slope = column[static_cast<Eigen::Index>(i)];
    shares[problem.numbers[i].row] += slope * slope / column.squaredNorm();
  }
  return shares;
}

}  // namespace

Information InformationOf(const Problem& problem, const std::vector<double>& predicted,
                          const std::vector<double>& derivatives, const std::vector<double>& weights) {
  const auto count = static_cast<Eigen::Index>(problem.numbers.size());
  const auto size = static_cast<Eigen::Index>(problem.unknowns());
  Eigen::MatrixXd slopes(count, size);
  double numbers = 0.0;  // The length of the numbers in sigmas.
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<size_t>(i);
    const double sigma = problem.numbers[at].sigma;
    numbers = Hypot(numbers, predicted[at] / sigma);
    for (Eigen::Index k = 0; k < size; ++k) {
      slopes(i, k) = derivatives[at * problem.unknowns() + static_cast<size_t>(k)] * std::sqrt(weights[at]) / sigma;
    }
  }
  Eigen::VectorXd lengths = slopes.colwise().norm().transpose();
  Information information = {.is_seen = std::vector<bool>(problem.unknowns(), true)};
  information.row_shares.resize(problem.unknowns());
  for (Eigen::Index k = 0; k < size; ++k) {
    const auto at = static_cast<size_t>(k);
    const bool is_nothing = !(lengths[k] * problem.scale[at] > kNothing * numbers);
    if (!is_nothing) information.row_shares[at] = SharesOf(problem, slopes.col(k));
    information.is_seen[at] = !is_nothing;
    slopes.col(k) *= is_nothing ? 0.0 : 1.0 / lengths[k];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> parts(slopes, Eigen::ComputeThinU | Eigen::ComputeThinV);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index j = 0; j < parts.singularValues().size(); ++j) {
    const Eigen::VectorXd part = parts.matrixV().col(j);
    const double value = parts.singularValues()[j];
    if (value > kNothing) {
      ++information.rank;
      inverse += part * part.transpose() / (value * value);
      continue;
    }
    for (Eigen::Index k = 0; k < size; ++k) {
      if (std::fabs(part[k]) > kLeastPart) information.is_seen[static_cast<size_t>(k)] = false;
    }
  }
  for (Eigen::Index k = 0; k < size; ++k) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const bool both = information.is_seen[static_cast<size_t>(k)] && information.is_seen[static_cast<size_t>(j)];
      information.covariance.push_back(both ? inverse(k, j) / (lengths[k] * lengths[j]) : kNone);
      information.correlation.push_back(both ? inverse(k, j) / std::sqrt(inverse(k, k) * inverse(j, j)) : kNone);
    }
  }
  return information;
}

<<<<<<< HEAD
double ChiSquaredBeyond(double value, double degrees_of_freedom) {
  return Eigen::numext::igammac(0.5 * degrees_of_freedom, 0.5 * value);
=======
// The logarithm of the gamma function at a multiple of 1/2.
static double LogGamma(double a) {
  constexpr double kLogRootPi = 0.5723649429247001;
  double sum = std::floor(a) == a ? 0.0 : kLogRootPi;
  for (int i = 1; a - i > 0.0; ++i) sum += Log(a - i);
  return sum;
}

// The incomplete gamma function Q(a, x), by its series below a + 1 and by Lentz's continued fraction above.
double ChiSquaredBeyond(double value, double degrees_of_freedom) {
  const double a = 0.5 * degrees_of_freedom;
  const double x = 0.5 * value;
  if (!(x > 0.0)) return 1.0;
  const double front = Exp(a * Log(x) - x - LogGamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (int n = 1; term > sum * 1e-16; ++n) sum += term *= x / (a + n);
    return 1.0 - front * sum;
  }
  double b = x + 1.0 - a;
  double c = 1e300;
  double d = 1.0 / b;
  double fraction = d;
  for (int i = 1; i < 10'000; ++i) {
    const double an = -i * (i - a);
    b += 2.0;
    d = 1.0 / (an * d + b);
    c = b + an / c;
    fraction *= c * d;
    if (std::fabs(c * d - 1.0) < 1e-15) break;
  }
  return front * fraction;
>>>>>>> fit
}

}  // namespace ricochet::fit
