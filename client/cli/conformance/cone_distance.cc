#include "client/cli/conformance/cone_distance.h"

#include <cmath>
#include <cstddef>
#include <optional>

namespace ricochet::cli {
namespace {

using Vector = std::vector<double>;

// Below this share of a diagonal entry a pivot is rounding: the vectors depend on each other.
constexpr double kDependent = 1e-13;

// Solves a symmetric positive definite system by elimination; nothing if it is singular.
std::optional<Vector> Solve(Matrix a, Vector b) {
  const size_t n = b.size();
  const Matrix original = a;
  for (size_t i = 0; i < n; ++i) {
    if (!(a[i][i] > kDependent * original[i][i])) return std::nullopt;
    for (size_t j = i + 1; j < n; ++j) {
      const double factor = a[j][i] / a[i][i];
      for (size_t k = i; k < n; ++k) a[j][k] -= factor * a[i][k];
      b[j] -= factor * b[i];
    }
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

// An impulse of unit size: the momentum that it gives, and the change of velocity.
struct Effect {
  Vector momentum, velocity;
};

Effect EffectOf(const ConformanceCase& one, const Vector& impulse) {
  Effect effect{.momentum = Vector(one.before.size())};
  for (size_t row = 0; row < impulse.size(); ++row) {
    for (size_t i = 0; i < effect.momentum.size(); ++i) effect.momentum[i] += one.jacobian[row][i] * impulse[row];
  }
  effect.velocity = *Solve(one.mass, effect.momentum);
  return effect;
}

// Returns by how much of each effect the change is caused, with the least kinetic energy left; nothing if the effects
// depend on each other.
std::optional<Vector> Shares(const std::vector<Effect>& effects, const Vector& change) {
  Matrix products(effects.size(), Vector(effects.size()));
  Vector right(effects.size());
  for (size_t i = 0; i < effects.size(); ++i) {
    for (size_t j = 0; j < effects.size(); ++j) products[i][j] = Dot(effects[i].momentum, effects[j].velocity);
    right[i] = Dot(effects[i].momentum, change);
  }
  return Solve(products, right);
}

// Directions along which a pyramid inside the friction cone of a contact has its edges.
std::vector<Vector> Edges(const ConformanceCase& one, const Vector& change) {
  if (one.dimension == 2) return {{1.0}, {-1.0}};
  const std::optional<Vector> impulse =
      Shares({EffectOf(one, {1, 0, 0}), EffectOf(one, {0, 1, 0}), EffectOf(one, {0, 0, 1})}, change);
  const double length = impulse.has_value() ? std::hypot((*impulse)[0], (*impulse)[1]) : 0.0;
  const double c = length > 0.0 ? (*impulse)[0] / length : 1.0;
  const double s = length > 0.0 ? (*impulse)[1] / length : 0.0;
  return {{c, s}, {-c, -s}, {-s, c}, {s, -c}};
}

std::vector<Effect> EdgeEffects(const ConformanceCase& one, const Vector& change) {
  std::vector<Effect> effects;
  const auto d = static_cast<size_t>(one.dimension);
  for (size_t contact = 0; contact < one.friction.size(); ++contact) {
    for (const Vector& edge : Edges(one, change)) {
      Vector impulse(one.jacobian.size());
      for (size_t i = 0; i + 1 < d; ++i) impulse[contact * d + i] = one.friction[contact] * edge[i];
      impulse[contact * d + d - 1] = 1.0;
      effects.push_back(EffectOf(one, impulse));
      if (one.friction[contact] == 0.0) break;
    }
  }
  return effects;
}

}  // namespace

double Dot(const Vector& x, const Vector& y) {
  double sum = 0.0;
  for (size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

Vector Times(const Matrix& matrix, const Vector& x) {
  Vector product;
  for (const Vector& row : matrix) product.push_back(Dot(row, x));
  return product;
}

std::vector<double> OutsideCones(const ConformanceCase& one, const Vector& change) {
  const std::vector<Effect> effects = EdgeEffects(one, change);
  Vector least = change;
  double least_energy = Dot(change, Times(one.mass, change));
  // The nearest impulse lies on a face of the cones: on the edges of one subset.
  for (size_t subset = 1; subset < size_t{1} << effects.size(); ++subset) {
    std::vector<Effect> chosen;
    for (size_t i = 0; i < effects.size(); ++i) {
      if ((subset >> i & 1) != 0) chosen.push_back(effects[i]);
    }
    const std::optional<Vector> shares = Shares(chosen, change);
    if (!shares.has_value()) continue;
    Vector left = change;
    bool pushes = true;
    for (size_t i = 0; i < chosen.size(); ++i) {
      pushes = pushes && (*shares)[i] >= 0.0;
      for (size_t k = 0; k < left.size(); ++k) left[k] -= (*shares)[i] * chosen[i].velocity[k];
    }
    const double energy = Dot(left, Times(one.mass, left));
    if (!pushes || energy >= least_energy) continue;
    least = left;
    least_energy = energy;
  }
  return least;
}

}  // namespace ricochet::cli
