#include "core/multi/single_impact.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/models/planar/planar.h"
#include "core/models/spatial/spatial.h"

namespace ricochet::multi {
namespace {

// A direction with no more than this part of its mobility left depends on the others: the models of one contact give
// such a block a lower rank.
constexpr double kRangeRank = 8.0 * kEpsilon;

template <typename Impact>
void KeepWorks(const Impact& impact, SingleImpact& single) {
  single.ended = impact.Converged() && impact.regime != Regime::kWedged;
  single.locked = impact.regime == Regime::kLocked;
  single.works = {.compression = impact.work_normal_compression,
                  .restitution = impact.work_normal_restitution,
                  .friction = impact.work_tangential_compression + impact.work_tangential_restitution,
                  .compression_impulse = impact.tau_compression};
}

SingleImpact SolvePlane(const ContactBlock& w, const ContactLaw& law, const ContactVector& x) {
  const PlanarProblem problem = {.w = {w(0, 0), w(0, 1), w(1, 1)},
                                 .u0 = x(0),
                                 .v0 = x(1),
                                 .mu = law.mu,
                                 .mu_static = law.mu,
                                 .law = RestitutionLaw::kEnergetic,
                                 .coefficient = law.e};
  planar::RoundingErrors errors;
  planar::Impact impact;
  if (planar::PlainImpact plain = planar::SolvePlain(problem); plain.proved) {
    impact = plain.impact;
    errors = plain.errors;
  } else {
    impact = planar::Solve(problem, errors);
  }
  SingleImpact single;
  KeepWorks(impact, single);
  if (!single.ended) return single;
  const double speed = std::max(std::abs(x(0)), std::abs(x(1)));
  single.impulse = Eigen::Vector2d(impact.f1, impact.tau1);
  single.velocity = Eigen::Vector2d(impact.u1, impact.v1);
  single.velocity_error = errors.velocity * speed;
  single.normal_error = errors.impulse * speed / w(1, 1);
  single.tangential_error = w(0, 0) > 0.0 ? errors.impulse * speed / w(0, 0) : 0.0;
  single.work_error = errors.work * (std::abs(impact.work_normal_compression) + impact.work_normal_restitution +
                                     std::abs(single.works.friction));
  return single;
}

// Returns the least eigenvalue of W that exceeds rounding.
double LeastMobility(const ContactBlock& w) {
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(w, Eigen::EigenvaluesOnly).eigenvalues();
  const double largest = values(values.size() - 1);
  return *std::find_if(values.begin(), values.end(), [largest](double x) { return x > kRangeRank * largest; });
}

SingleImpact SolveSpace(const ContactBlock& w, const ContactLaw& law, const ContactVector& x) {
  const spatial::Impact impact = spatial::Solve({.w11 = w(0, 0),
                                                 .w12 = w(0, 1),
                                                 .w13 = w(0, 2),
                                                 .w22 = w(1, 1),
                                                 .w23 = w(1, 2),
                                                 .w33 = w(2, 2),
                                                 .u0 = {x(0), x(1)},
                                                 .v0 = x(2),
                                                 .mu = law.mu,
                                                 .mu_static = law.mu,
                                                 .law = RestitutionLaw::kEnergetic,
                                                 .coefficient = law.e,
                                                 .tolerance = spatial::kLeastTolerance});
  SingleImpact single;
  single.error_is_proved = false;
  KeepWorks(impact, single);
  if (!single.ended) return single;
  single.impulse = Eigen::Vector3d(impact.f1[0], impact.f1[1], impact.tau1);
  single.velocity = Eigen::Vector3d(impact.u1[0], impact.u1[1], impact.v1);
  single.velocity_error = impact.error_estimate * x.cwiseAbs().maxCoeff();
  single.impulse_is_known = std::isfinite(impact.errors.f) && std::isfinite(impact.errors.tau);
  if (single.impulse_is_known) {
    single.tangential_error = impact.errors.f;
    single.normal_error = impact.errors.tau;
  } else {
    single.tangential_error = single.normal_error = single.velocity_error / LeastMobility(w);
  }
  single.work_error = std::max({impact.errors.work_normal_compression, impact.errors.work_normal_restitution,
                                impact.errors.work_tangential_compression + impact.errors.work_tangential_restitution});
  return single;
}

SingleImpact SolveOne(const ContactBlock& w, const ContactLaw& law, const ContactVector& x) {
  return w.rows() == 2 ? SolvePlane(w, law, x) : SolveSpace(w, law, x);
}

// Sets D, which has a closed form without friction.
void SetDerivative(const ContactBlock& w, const ContactLaw& law, const ContactVector& x, SingleImpact& single) {
  const auto d = x.size();
  ContactBlock& derivative = single.derivative;
  derivative = ContactBlock::Zero(d, d);
  if (law.mu == 0.0) {
    derivative(d - 1, d - 1) = -(1.0 + law.e) / w(d - 1, d - 1);
    return;
  }
  Eigen::Index largest = 0;
  const double speed = x.cwiseAbs().maxCoeff(&largest);
  const double step = speed * (d == 2 ? 0x1p-20 : 0x1p-14);
  ContactVector rest = single.impulse;
  for (Eigen::Index j = 0; j < d; ++j) {
    if (j == largest) continue;
    ContactVector beside = x;
    beside(j) -= step;  // v never rises, so that the contact still approaches.
    const SingleImpact moved = SolveOne(w, law, beside);
    if (!moved.ended) continue;
    derivative.col(j) = (single.impulse - moved.impulse) / step;
    rest -= derivative.col(j) * x(j);
  }
  derivative.col(largest) = rest / x(largest);
  single.error_is_proved = false;
}

// Moves a velocity into the range of its block of W, beside which rounding may have put it where the block is singular.
// The normal component stays.
ContactVector InRange(const ContactBlock& w, const ContactVector& x) {
  const auto d = w.rows();
  const auto place = [d](Eigen::Index a) { return (a + d - 1) % d; };  // The order is n, then t.
  ContactBlock c = ContactBlock::Zero(d, d);
  ContactVector y = ContactVector::Zero(d);
  ContactVector settled = x;
  for (Eigen::Index a = 0; a < d; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      const double rest = w(place(a), place(b)) - c.row(a).head(b).dot(c.row(b).head(b));
      if (c(b, b) > 0.0) c(a, b) = rest / c(b, b);
    }
    const double known = c.row(a).head(a).dot(y.head(a));
    const double left = w(place(a), place(a)) - c.row(a).head(a).squaredNorm();
    if (left > kRangeRank * w(place(a), place(a))) {
      c(a, a) = std::sqrt(left);
      y(a) = (x(place(a)) - known) / c(a, a);
    } else {
      settled(place(a)) = known;
    }
  }
  return settled;
}

}  // namespace

SingleImpact SolveSingleImpact(const Problem& problem, int i, const ContactVector& velocity) {
  const auto d = problem.d;
  const ContactBlock w = problem.w.block(problem.T(i), problem.T(i), d, d);
  const ContactVector x = InRange(w, velocity);
  const ContactLaw& law = problem.laws[At(i)];
  SingleImpact single = SolveOne(w, law, x);
  if (single.ended) SetDerivative(w, law, x, single);
  return single;
}

}  // namespace ricochet::multi
