#include "core/multi/endless_pair.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/numerics/products.h"

namespace ricochet::multi {
namespace {

// The two contacts as a linear system in their normal impulses. The second one approaches.
struct Pair {
  Eigen::Vector2i contact;
  Eigen::Vector2d e;
  Eigen::Vector2d friction = Eigen::Vector2d::Zero();  // -mu s, the tangential impulse by the normal one.
  Eigen::Matrix<double, Eigen::Dynamic, 2> rows;       // W times the unit impulses of the two.
  Eigen::Matrix2d a;                                   // Normal velocities by normal impulses.
  Eigen::MatrixXd unit;                                // The unit impulses.
  Eigen::Vector2d v;                                   // Normal velocities.
  double determinant = 0.0;                            // The determinant of a.
  bool is_singular = false;                            // The determinant is rounding alone.

  bool IsFrictionless() const { return friction.isZero(0.0); }
};

// Returns nothing if a contact with friction does not slip, or slips in space, where it turns.
std::optional<Pair> PairOf(const Problem& problem, int i, int j, const Vector& v) {
  Pair pair = {.contact = {i, j}, .e = {}, .rows = {}, .a = {}, .unit = {}, .v = {}};
  Eigen::MatrixXd& unit = pair.unit;
  unit = Eigen::MatrixXd::Zero(v.size(), 2);
  for (int c = 0; c < 2; ++c) {
    const int contact = pair.contact(c);
    const ContactLaw& law = problem.laws[At(contact)];
    const double slip = v(problem.T(contact));
    if (law.mu > 0.0 && (problem.d == 3 || slip == 0.0)) return std::nullopt;
    pair.e(c) = law.e;
    if (law.mu > 0.0) pair.friction(c) = -std::copysign(law.mu, slip);
    unit(problem.N(contact), c) = 1.0;
    if (law.mu > 0.0) unit(problem.T(contact), c) = pair.friction(c);
    pair.v(c) = v(problem.N(contact));
  }
  pair.rows = problem.w * unit;
  for (int c = 0; c < 2; ++c) pair.a.row(c) = pair.rows.row(problem.N(pair.contact(c)));
  pair.determinant = DifferenceOfProducts(pair.a(0, 0), pair.a(1, 1), pair.a(0, 1), pair.a(1, 0));
  pair.is_singular = std::abs(pair.determinant) <= 8.0 * kEpsilon * pair.a(0, 0) * pair.a(1, 1);
  return pair;
}

// True if both normal velocities are those that an impulse makes, to within their errors.
bool IsInRange(const Problem& problem, const Pair& pair, const Attained& state) {
  const Eigen::Matrix2d& a = pair.a;
  const double first = a(1, 1) * pair.v(0), second = a(0, 1) * pair.v(1);
  const double error = a(1, 1) * state.ErrorOf(problem, problem.N(pair.contact(0))) +
                       std::abs(a(0, 1)) * state.ErrorOf(problem, problem.N(pair.contact(1)));
  return std::abs(first - second) <= error + 8.0 * kEpsilon * (std::abs(first) + std::abs(second));
}

// `approach` is the speed with which the first contact was struck last.
bool IsEndless(const Problem& problem, const Pair& pair, double approach, const Attained& state) {
  const Eigen::Matrix2d& a = pair.a;
  if (!(a(0, 0) > 0.0 && a(1, 1) > 0.0 && a(0, 1) < 0.0 && a(1, 0) < 0.0)) return false;
  // A singular pair has one contact that approaches as the other parts: the conditions hold, the last with equality.
  if (pair.is_singular) return pair.e.prod() > 0.0 && IsInRange(problem, pair, state);
  const double e1 = pair.e(0), e2 = pair.e(1);
  const double product = (1.0 + e1) * (1.0 + e2) * (a(0, 1) * a(1, 0) / (a(0, 0) * a(1, 1)));
  const double roots = std::sqrt(e1) + std::sqrt(e2);
  const double excess = product - roots * roots;
  if (e1 * e2 == 0.0 ? !(excess > 0.0) : !(excess >= 0.0)) return false;
  // The eigenvalues of two impacts, whose discriminant is a product.
  const double trace = product - e1 - e2;
  const double larger = 0.5 * (trace + std::sqrt(excess * (trace + 2.0 * std::sqrt(e1 * e2))));
  const double smaller = larger > 0.0 ? e1 * e2 / larger : 0.0;
  return -pair.v(1) * (1.0 + e2) * (-a(0, 1) / a(1, 1)) >= approach * (smaller + e1);
}

// Returns the normal impulses that are still to come, or nothing if there is no limit.
std::optional<Eigen::Vector2d> RemainingImpulses(const Pair& pair) {
  const Eigen::Matrix2d& a = pair.a;
  if (!pair.is_singular) {
    const Eigen::Vector2d impulses(DifferenceOfProducts(a(0, 1), pair.v(1), a(1, 1), pair.v(0)) / pair.determinant,
                                   DifferenceOfProducts(a(1, 0), pair.v(0), a(0, 0), pair.v(1)) / pair.determinant);
    if (pair.determinant < 0.0 || !(impulses.minCoeff() >= 0.0)) return std::nullopt;
    return impulses;
  }
  // Both normal velocities are proportional, and two impacts multiply them by e1 e2.
  const double factor = pair.e(0) * pair.e(1);
  // Where next to no energy is lost, the rounding of W and of the velocities decides on the limit.
  constexpr double kLeastLoss = 0x1p-40;
  if (!pair.IsFrictionless() || !(1.0 - factor > kLeastLoss)) return std::nullopt;
  const double second = -pair.v(1);
  const double first = pair.e(1) * second * (-a(0, 1) / a(1, 1));
  return Eigen::Vector2d((1.0 + pair.e(0)) * first / a(0, 0), (1.0 + pair.e(1)) * second / a(1, 1)) / (1.0 - factor);
}

// True if slip keeps its directions and no other contact approaches until the limit. Partial sums of both impulses
// rise, so that they stay in the box below their limits. `moved` is what each of the two changes in all.
bool KeepsCourse(const Problem& problem, const Pair& pair, const Eigen::MatrixXd& moved, const Attained& state) {
  const auto least = [&](int place, double sign) {
    return sign * state.v(place) + (sign * moved.row(place)).cwiseMin(0.0).sum();
  };
  for (int contact = 0; contact < problem.k; ++contact) {
    const bool is_pair = contact == pair.contact(0) || contact == pair.contact(1);
    if (!is_pair && least(problem.N(contact), 1.0) < 0.0) return false;
    if (!is_pair || problem.laws[At(contact)].mu == 0.0) continue;
    const int t = problem.T(contact);
    if (!(least(t, std::copysign(1.0, state.v(t))) > state.ErrorOf(problem, t))) return false;
  }
  return true;
}

// Adds the works of the impacts, one after the other until they are rounding.
void AddWorks(const Problem& problem, const Pair& pair, Attained& state) {
  constexpr int kMost = 100'000;
  Eigen::Vector2d v = pair.v;
  Eigen::Vector2d u(state.v(problem.T(pair.contact(0))), state.v(problem.T(pair.contact(1))));
  double first = 0.0;
  for (int hit = 0; hit < kMost; ++hit) {
    const int c = hit % 2 == 0 ? 1 : 0;
    ContactWorks& works = state.works[At(pair.contact(c))];
    const double speed = -v(c);
    if (!(speed > 0.0)) break;
    const double compression = 0.5 * speed * speed / pair.a(c, c);
    // The work of friction falls like the speed, that of the normal force like its square.
    first = std::max(first, speed);
    if (speed < 0x1p-60 * first) break;
    const double impulse = (1.0 + pair.e(c)) * speed / pair.a(c, c);
    works.compression -= compression;
    works.restitution += pair.e(c) * pair.e(c) * compression;
    const double before = u(c);
    for (int other = 0; other < 2; ++other) u(other) += pair.rows(problem.T(pair.contact(other)), c) * impulse;
    works.friction += pair.friction(c) * impulse * 0.5 * (before + u(c));
    v += pair.a.col(c) * impulse;
    v(c) = pair.e(c) * speed;
  }
}

// Returns the matrix for which the impulses still to come are minus the matrix times the normal velocities.
Eigen::Matrix2d InverseOf(const Pair& pair) {
  const Eigen::Matrix2d& a = pair.a;
  Eigen::Matrix2d inverse;
  inverse << a(1, 1), -a(0, 1), -a(1, 0), a(0, 0);
  if (!pair.is_singular) return inverse / pair.determinant;
  const double sum = 1.0 / (1.0 - pair.e(0) * pair.e(1));
  inverse << 0.0, (1.0 + pair.e(0)) * pair.e(1) * sum * (-a(0, 1) / a(1, 1)) / a(0, 0),  //
      0.0, (1.0 + pair.e(1)) * sum / a(1, 1);
  return inverse;
}

// Carries the error of the impulses to the limit.
void AddError(const Problem& problem, const Pair& pair, const Eigen::Vector2d& impulses, Attained& state) {
  const Eigen::Index size = state.p.size();
  if (state.error_terms == 0.0) state.error_squares = Eigen::MatrixXd::Zero(size, size);
  const Eigen::Matrix2d inverse = InverseOf(pair);
  const Eigen::Vector2i n(problem.N(pair.contact(0)), problem.N(pair.contact(1)));
  const Eigen::MatrixXd normals = problem.w(n, Eigen::all);
  const Eigen::Vector2d slack = state.slack(n);
  const Eigen::MatrixXd map = Eigen::MatrixXd::Identity(size, size) - pair.unit * (inverse * normals);
  state.error_squares = map * state.error_squares * map.transpose();
  // The rounding of the solution of the 2 x 2 system, and of what it starts from.
  const Eigen::Vector2d of_system =
      inverse.cwiseAbs() * (slack + 4.0 * kEpsilon * (pair.a.cwiseAbs() * impulses + pair.v.cwiseAbs()));
  for (int c = 0; c < 2; ++c) {
    const double own = of_system(c) + 2.0 * kEpsilon * impulses(c);
    state.error_squares += own * own * pair.unit.col(c) * pair.unit.col(c).transpose();
    for (const int row : n) {
      state.work_error += 4.0 * impulses(c) * (1.0 + std::abs(pair.friction(c))) * state.ErrorOf(problem, row);
    }
  }
  state.error_terms += 2.0;
}

}  // namespace

bool CloseEndlessPair(const Problem& problem, int i, int j, double approach, Attained& state) {
  const std::optional<Pair> pair = PairOf(problem, i, j, state.v);
  if (!pair.has_value() || !IsEndless(problem, *pair, approach, state)) return false;
  const std::optional<Eigen::Vector2d> impulses = RemainingImpulses(*pair);
  if (!impulses.has_value()) return false;
  const Eigen::MatrixXd moved = pair->rows * impulses->asDiagonal();
  if (!KeepsCourse(problem, *pair, moved, state)) return false;
  AddWorks(problem, *pair, state);
  AddError(problem, *pair, *impulses, state);
  for (int c = 0; c < 2; ++c) {
    const double impulse = (*impulses)(c);
    const int contact = pair->contact(c);
    state.works[At(contact)].compression_impulse += impulse / (1.0 + pair->e(c));
    state.p(problem.N(contact)) += impulse;
    if (pair->friction(c) != 0.0) state.p(problem.T(contact)) += pair->friction(c) * impulse;
  }
  state.slack += 4.0 * kEpsilon * (moved.cwiseAbs().rowwise().sum() + state.v.cwiseAbs());
  state.v += moved.rowwise().sum();
  for (const int contact : pair->contact) state.v(problem.N(contact)) = 0.0;
  state.end = MultiContactEnd::kEndless;
  return true;
}

}  // namespace ricochet::multi
