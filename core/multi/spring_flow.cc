#include "core/multi/spring_flow.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace ricochet::multi {
namespace {

// The length h of a step is chosen so that |A| h has this value.
constexpr double kTheta = 2.0;
// An eigenvalue of this part of the largest is rounding: the sticking contacts are then held more than once.
constexpr double kRankTolerance = 1e-12;

}  // namespace

int Series::Lead() const {
  for (int m = 0; m <= kSeriesOrder; ++m) {
    if (std::abs(c[static_cast<size_t>(m)]) > noise[static_cast<size_t>(m)]) return m;
  }
  return kSeriesOrder + 1;
}

double Series::At(double s) const {
  double value = 0.0;
  for (size_t m = kSeriesOrder + 1; m-- > 0;) value = value * s + c[m];
  return value;
}

double Series::Integral(double s) const {
  double value = 0.0;
  for (size_t m = kSeriesOrder + 1; m-- > 0;) value = value * s + c[m] / static_cast<double>(m + 1);
  return value * s;
}

double FirstRoot(const Series& series, int lead) {
  constexpr double kNone = 2.0;
  constexpr int kMostSteps = 200;
  const double* const c = series.c.data() + lead;
  const int order = kSeriesOrder - lead;
  double others = 0.0, curvature = 0.0;
  for (int m = 1; m <= order; ++m) {
    others += std::abs(c[m]);
    curvature += m * (m - 1) * std::abs(c[m]);
  }
  if (c[0] >= others) return kNone;
  // The parabola with this curvature bends below the series, so that it vanishes first.
  double s = 0.0;
  for (int step = 0; step < kMostSteps; ++step) {
    double value = c[order], slope = 0.0, size = std::abs(c[order]);
    for (int m = order - 1; m >= 0; --m) {
      slope = slope * s + value;
      value = value * s + c[m];
      size = size * s + std::abs(c[m]);
    }
    if (value <= kEpsilon * size) return s;
    const double root = std::sqrt(slope * slope + 2.0 * curvature * value);
    const double ahead = slope < 0.0 ? 2.0 * value / (root - slope) : (slope + root) / curvature;
    if (!(s + ahead > s)) return s;
    s += ahead;
    if (!(s <= 1.0)) return kNone;
  }
  return s;
}

bool IsRegular(const Eigen::LLT<Square>& cholesky, const Square& w) {
  if (cholesky.info() != Eigen::Success) return false;
  const auto diagonal = cholesky.matrixLLT().diagonal();
  return diagonal.cwiseAbs2().minCoeff() > kRankTolerance * w.diagonal().maxCoeff();
}

SpringFlow::SpringFlow(const Problem& problem, const Modes& modes, const SpringState& state, const Vector& v,
                       const Vector& v_noise)
    : k_(problem.k), modes_(modes) {
  for (int i = 0; i < k_; ++i) {
    const ContactLaw& law = problem.laws[At(i)];
    const NormalMode mode = modes_[At(i)].normal;
    if (mode == NormalMode::kLoading) stiffness_[At(i)] = law.stiffness;
    if (mode == NormalMode::kUnloading) stiffness_[At(i)] = law.stiffness / (law.e * law.e);
  }
  SetFriction(problem, state, v);
  SetStep(problem, state, v);
  Expand(state, v, v_noise);
}

// The tangential forces of contacts that stick answer to the others: W_SS tau_S = -W_S,rest. If W_SS is singular they
// are one choice of many, and contacts with larger weights take more.
void SpringFlow::SetStick(const Problem& problem, const Vector& weights) {
  std::array<int, kMostContacts> sticking;
  int count = 0;
  for (int i = 0; i < k_; ++i) {
    const bool sticks = IsClosed(i) && modes_[At(i)].slip == 0 && weights(i) > 0.0;
    if (sticks && problem.w(problem.T(i), problem.T(i)) > 0.0) sticking[At(count++)] = i;
  }
  if (count == 0) return;
  Square matrix(count, count);
  Square driven(count, k_);  // Minus the slip accelerations by the forces, without the friction of these contacts.
  for (int a = 0; a < count; ++a) {
    const int i = sticking[At(a)];
    for (int b = 0; b < count; ++b) matrix(a, b) = problem.w(problem.T(i), problem.T(sticking[At(b)]));
    for (int j = 0; j < k_; ++j) {
      double sum = 0.0;
      if (IsClosed(j))
        sum = problem.w(problem.T(i), problem.N(j)) + problem.w(problem.T(i), problem.T(j)) * friction_(j, j);
      driven(a, j) = -sum;
    }
  }
  Square solution;
  const Eigen::LLT<Square> cholesky(matrix);
  if (IsRegular(cholesky, matrix)) {
    solution = cholesky.solve(driven);
  } else {
    split_is_free_ = true;
    Vector roots(count);
    for (int a = 0; a < count; ++a) roots(a) = std::sqrt(weights(sticking[At(a)]));
    const Eigen::MatrixXd weighted = roots.asDiagonal() * matrix * roots.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(weighted);
    Vector inverse = solver.eigenvalues();
    const double least = kRankTolerance * inverse.cwiseAbs().maxCoeff();
    for (double& value : inverse) value = value > least ? 1.0 / value : 0.0;
    solution = roots.asDiagonal() *
               (solver.eigenvectors() *
                (inverse.asDiagonal() * (solver.eigenvectors().transpose() * (roots.asDiagonal() * driven))));
  }
  for (int a = 0; a < count; ++a) friction_.row(sticking[At(a)]) = solution.row(a);
}

void SpringFlow::SetFriction(const Problem& problem, const SpringState& state, const Vector& v) {
  friction_ = Square::Zero(k_, k_);
  Vector weights = Vector::Zero(k_);
  Vector slides = Vector::Zero(k_);  // mu sqrt(stiffness) of the contacts that slip
  for (int i = 0; i < k_; ++i) {
    const double mu = problem.laws[At(i)].mu;
    if (!IsClosed(i) || mu == 0.0) continue;
    friction_(i, i) = -mu * modes_[At(i)].slip;
    if (modes_[At(i)].slip != 0) slides(i) = mu * std::sqrt(stiffness_[At(i)]);
    weights(i) = mu * (state.f[At(i)] > 0.0 ? state.f[At(i)] : stiffness_[At(i)] * std::abs(v(2 * i + 1)));
    if (weights(i) == 0.0) weights(i) = std::numeric_limits<double>::min();
  }
  SetStick(problem, weights);
  by_force_ = Tall::Zero(problem.v.size(), k_);
  size_ = Tall::Zero(problem.v.size(), k_);
  for (int row = 0; row < 2 * k_; ++row) {
    const bool sticks = row % 2 == 0 && weights(row / 2) > 0.0 && modes_[At(row / 2)].slip == 0;
    for (int j = 0; j < k_; ++j) {
      if (!IsClosed(j) || sticks) continue;
      double sum = problem.w(row, problem.N(j));
      double size = std::abs(sum);
      for (int l = 0; l < k_; ++l) {
        if (friction_(l, j) == 0.0) continue;
        const double term = problem.w(row, problem.T(l)) * friction_(l, j);
        sum += term;
        size += std::abs(term);
      }
      by_force_(row, j) = sum;
      size_(row, j) = size;
    }
  }
  double square = 0.0;
  for (int i = 0; i < k_; ++i) {
    double row = 0.0;
    for (int j = 0; j < k_; ++j) row += slides(i) * slides(j) * std::abs(problem.w(problem.T(i), problem.T(j)));
    square = std::max(square, row);
  }
  growth_rate_ = 0.5 * std::sqrt(square);
}

void SpringFlow::SetStep(const Problem& problem, const SpringState& state, const Vector& v) {
  double square = 0.0;
  for (int i = 0; i < k_; ++i) {
    if (!IsClosed(i)) continue;
    double row = 1e-3 * stiffness(i) * problem.w(2 * i + 1, 2 * i + 1);
    for (int j = 0; j < k_; ++j) row += std::sqrt(stiffness(i) * stiffness(j)) * std::abs(by_force_(2 * i + 1, j));
    square = std::max(square, row);
  }
  if (square > 0.0) {
    h_ = kTheta / std::sqrt(square);
    return;
  }
  h_ = 1.0;  // This holds unless a gap closes, because nothing else limits the step.
  bool closes = false;
  for (int i = 0; i < k_; ++i) {
    const double gap = state.g[At(i)];
    if (!(v(2 * i + 1) < 0.0 && gap > 0.0)) continue;
    const double step = 2.0 * gap / -v(2 * i + 1);
    h_ = closes ? std::min(h_, step) : step;
    closes = true;
  }
}

void SpringFlow::Expand(const SpringState& state, const Vector& v, const Vector& v_noise) {
  for (int row = 0; row < 2 * k_; ++row) {
    v_[At(row)].c[0] = v(row);
    v_[At(row)].noise[0] = v_noise(row);
  }
  for (int i = 0; i < k_; ++i) {
    f_[At(i)].c[0] = state.f[At(i)];
    f_[At(i)].noise[0] = 16.0 * kEpsilon * std::max(state.f[At(i)], state.largest_f[At(i)]);
    g_[At(i)].c[0] = state.g[At(i)];
    g_[At(i)].noise[0] = 8.0 * kEpsilon * state.g[At(i)];
  }
  for (size_t m = 0; m < kSeriesOrder; ++m) {
    const double factor = h_ / static_cast<double>(m + 1);
    for (int row = 0; row < 2 * k_; ++row) {
      double sum = 0.0, noise = 0.0;
      for (int j = 0; j < k_; ++j) {
        const double by = by_force_(row, j);
        if (by == 0.0) continue;
        const Series& force = f_[At(j)];
        sum += by * force.c[m];
        noise += size_(row, j) * (force.noise[m] + 16.0 * kEpsilon * std::abs(force.c[m]));
      }
      v_[At(row)].c[m + 1] = factor * sum;
      v_[At(row)].noise[m + 1] = factor * noise;
    }
    for (int i = 0; i < k_; ++i) {
      const Series& normal = v_[At(2 * i + 1)];
      const double by = factor * (IsClosed(i) ? -stiffness_[At(i)] : 0.0);
      f_[At(i)].c[m + 1] = by * normal.c[m];
      f_[At(i)].noise[m + 1] = std::abs(by) * normal.noise[m];
      g_[At(i)].c[m + 1] = IsClosed(i) ? 0.0 : factor * normal.c[m];
      g_[At(i)].noise[m + 1] = IsClosed(i) ? 0.0 : factor * normal.noise[m];
    }
  }
}

Series SpringFlow::Friction(int i) const {
  Series tau;
  tau.c.fill(0.0);
  tau.noise.fill(0.0);
  for (int j = 0; j < k_; ++j) {
    const double by = friction_(i, j);
    if (by == 0.0) continue;
    const Series& force = f_[At(j)];
    for (size_t m = 0; m <= kSeriesOrder; ++m) {
      tau.c[m] += by * force.c[m];
      tau.noise[m] += std::abs(by) * (force.noise[m] + 64.0 * kEpsilon * std::abs(force.c[m]));
    }
  }
  return tau;
}

}  // namespace ricochet::multi
