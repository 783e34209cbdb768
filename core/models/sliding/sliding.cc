#include "core/models/sliding/sliding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/delassus.h"
#include "core/numerics/moderate.h"
#include "core/numerics/products.h"

namespace ricochet::sliding {
namespace {

// 2^-53, enlarged by a quarter for terms of higher order.
constexpr double kRounding = 1.25 * 0x1p-53;
constexpr RelativeErrors kNoBound = {.velocity = std::numeric_limits<double>::infinity(),
                                     .impulse = std::numeric_limits<double>::infinity()};

template <size_t kTangential>
int RankOf(const Problem<kTangential>& problem) {
  if constexpr (kTangential == 1) {
    return PlanarDelassus{.tt = problem.w[0], .tn = problem.w[1], .nn = problem.w[2]}.Rank();
  } else {
    return SpatialDelassus{problem.w}.Rank();
  }
}

constexpr double kLimit = 0x1p100;  // The sizes for which products stay within the range of doubles.

// Whether all numbers that the frictionless impact reads are moderate.
template <size_t kTangential>
bool IsModerateWithoutFriction(const Problem<kTangential>& problem) {
  return AreModerate(problem.Wtn(), kLimit) && AreModerate(problem.u0, kLimit) &&
         AreModerate({problem.Wnn(), problem.v0, problem.coefficient}, kLimit);
}

template <size_t kTangential>
double Largest(const Vector<kTangential>& vector) {
  double largest = 0.0;
  for (const double value : vector) largest = std::max(largest, std::fabs(value));
  return largest;
}

template <size_t kTangential>
double ScaleOf(const Problem<kTangential>& problem) {
  return std::max(Largest(problem.u0), std::fabs(problem.v0));
}

template <size_t kTangential>
double Dot(const Vector<kTangential>& x, const Vector<kTangential>& y) {
  double sum = x[0] * y[0];
  for (size_t i = 1; i < kTangential; ++i) sum = std::fma(x[i], y[i], sum);
  return sum;
}

template <size_t kTangential>
Vector<kTangential> Sum(const Vector<kTangential>& x, const Vector<kTangential>& y) {
  Vector<kTangential> sum;
  for (size_t i = 0; i < kTangential; ++i) sum[i] = x[i] + y[i];
  return sum;
}

// x + slope * tau, where adding 0.0 turns -0 into 0.
template <size_t kTangential>
Vector<kTangential> Moved(const Vector<kTangential>& x, const Vector<kTangential>& slope, double tau) {
  Vector<kTangential> moved;
  for (size_t i = 0; i < kTangential; ++i) moved[i] = std::fma(slope[i], tau, x[i]) + 0.0;
  return moved;
}

template <size_t kTangential>
struct End {
  double tau_compression, tau1;
  Vector<kTangential> u1;
  double v1;
};

// The end of a straight path, from the slopes of u and v.
template <size_t kTangential>
End<kTangential> EndOf(const Problem<kTangential>& problem, const Vector<kTangential>& u_slope, double v_slope) {
  const double tau_compression = -problem.v0 / v_slope;
  const double tau1 = std::fma(problem.coefficient, tau_compression, tau_compression);
  return {tau_compression, tau1, Moved(problem.u0, u_slope, tau1), -problem.coefficient * problem.v0};
}

// Fills the fields of Impact that do not depend on the friction impulse.
template <size_t kTangential>
Impact<kTangential> MakeImpact(const Problem<kTangential>& problem, const Vector<kTangential>& u_slope,
                               double v_slope) {
  const End<kTangential> end = EndOf(problem, u_slope, v_slope);
  const double c = problem.coefficient;
  Impact<kTangential> impact;
  impact.regime = Regime::kSliding;
  impact.w_rank = RankOf(problem);
  impact.newton = impact.poisson = impact.energetic = c;
  impact.energetic_excess = c - 1.0;
  impact.u1 = end.u1;
  impact.v1 = end.v1;
  impact.tau_compression = end.tau_compression;
  impact.tau1 = end.tau1;
  impact.work_normal_compression = 0.5 * end.tau_compression * problem.v0;
  impact.work_normal_restitution = 0.0 - c * c * impact.work_normal_compression;
  // v0 + v1 = (1 - c) v0
  impact.energy_change = 0.5 * end.tau1 * ((1.0 - c) * problem.v0) + 0.0;
  impact.events = {{{.kind = EventKind::kStart, .u = problem.u0, .v = problem.v0},
                    {.kind = EventKind::kCompressionEnds,
                     .tau = end.tau_compression,
                     .u = Moved(problem.u0, u_slope, end.tau_compression)},
                    {.kind = EventKind::kRestitutionEnds, .tau = end.tau1, .u = end.u1, .v = end.v1}}};
  return impact;
}

}  // namespace

template <size_t kTangential>
Slopes<kTangential> SlidingSlopes(const Problem<kTangential>& problem) {
  const auto& w = problem.w;
  const Vector<kTangential>& u0 = problem.u0;
  const double mu = problem.mu;
  if constexpr (kTangential == 1) {
    const double f = -std::copysign(mu, u0[0]);
    return {.u = {std::fma(f, w[0], w[1])}, .v = std::fma(f, w[1], w[2]), .f = {f}};
  } else {
    const double slip = std::sqrt(std::fma(u0[0], u0[0], u0[1] * u0[1]));
    const auto along = [&](double x, double y) { return DifferenceOfProducts(x, u0[0], -y, u0[1]) / slip; };
    return {.u = {std::fma(-mu, along(w[0], w[1]), w[2]), std::fma(-mu, along(w[1], w[3]), w[4])},
            .v = std::fma(-mu, along(w[2], w[4]), w[5]),
            .f = {-mu * (u0[0] / slip), -mu * (u0[1] / slip)}};
  }
}

template <size_t kTangential>
RelativeErrors ErrorsOf(const Problem<kTangential>& problem) {
  constexpr double kDirectional = kTangential == 1 ? 0.0 : 6.0;
  if (!IsModerateWithoutFriction(problem) || !AreModerate(problem.w, kLimit) || !AreModerate({problem.mu}, kLimit)) {
    return kNoBound;
  }
  const Slopes<kTangential> slopes = SlidingSlopes(problem);
  if (!(slopes.v > 0.0)) return kNoBound;
  const double conditioning = kDirectional * (std::fabs(slopes.v - problem.Wnn()) / slopes.v);
  if (!(conditioning * 0x1p-53 <= 0x1p-4)) return kNoBound;
  const End<kTangential> end = EndOf(problem, slopes.u, slopes.v);
  const Vector<kTangential> wtn = problem.Wtn();
  double velocity = end.v1;
  for (size_t i = 0; i < kTangential; ++i) {
    const double of_slope = (4.0 + conditioning) * std::fabs(slopes.u[i]);
    const double of_direction = kDirectional * std::fabs(slopes.u[i] - wtn[i]);
    velocity = std::max(velocity, std::fabs(end.u1[i]) + end.tau1 * (of_slope + of_direction));
  }
  const double normal = (3.0 + conditioning) * problem.Wnn();
  const double tangential = (kDirectional + 4.0 + conditioning) * problem.Wtt() * problem.mu;
  const double unit = kRounding / ScaleOf(problem);
  return {.velocity = unit * velocity, .impulse = unit * end.tau1 * std::max(normal, tangential)};
}

template <size_t kTangential>
RelativeErrors FrictionlessErrorsOf(const Problem<kTangential>& problem) {
  if (!IsModerateWithoutFriction(problem)) return kNoBound;
  const End<kTangential> end = EndOf(problem, problem.Wtn(), problem.Wnn());
  const double drift = Largest(problem.Wtn()) * end.tau1;
  const double unit = kRounding / ScaleOf(problem);
  return {.velocity = unit * std::max(end.v1, Largest(end.u1) + 2.0 * drift),
          .impulse = unit * 2.0 * problem.Wnn() * end.tau1};
}

template <size_t kTangential>
Impact<kTangential> Solve(const Problem<kTangential>& problem) {
  const Slopes<kTangential> slopes = SlidingSlopes(problem);
  Impact<kTangential> impact = MakeImpact(problem, slopes.u, slopes.v);
  auto& [start, middle, last] = impact.events;
  Vector<kTangential> f_restitution;
  for (size_t i = 0; i < kTangential; ++i) {
    middle.f[i] = slopes.f[i] * impact.tau_compression;
    f_restitution[i] = problem.coefficient * middle.f[i];
    impact.f1[i] = last.f[i] = slopes.f[i] * impact.tau1;
  }
  impact.tangential = kTangential == 1 ? slopes.f[0] : problem.mu;
  impact.work_tangential_compression = 0.5 * Dot(middle.f, Sum(start.u, middle.u)) + 0.0;
  impact.work_tangential_restitution = 0.5 * Dot(f_restitution, Sum(middle.u, last.u)) + 0.0;
  impact.energy_change += 0.5 * Dot(last.f, Sum(start.u, last.u));
  const double friction_gives = impact.work_tangential_compression + impact.work_tangential_restitution;
  impact.energy_limit_broken = friction_gives > 0.0 && impact.energy_change > 0.0;
  const double moved = impact.work_normal_restitution - impact.work_normal_compression;
  impact.friction_limit_broken = friction_gives > 16.0 * std::numeric_limits<double>::epsilon() * moved;
  return impact;
}

template <size_t kTangential>
bool FrictionPushes(const Problem<kTangential>& problem) {
  const Slopes<kTangential> slopes = SlidingSlopes(problem);
  return Dot(problem.u0, Sum(problem.u0, EndOf(problem, slopes.u, slopes.v).u1)) < 0.0;
}

template <size_t kTangential>
Impact<kTangential> SolveFrictionless(const Problem<kTangential>& problem) {
  Impact<kTangential> impact = MakeImpact(problem, problem.Wtn(), problem.Wnn());
  impact.regime = Regime::kFrictionless;
  return impact;
}

template <size_t kTangential>
Instant<kTangential> At(const Impact<kTangential>& impact, double tau) {
  const auto& [start, middle, last] = impact.events;
  const bool compressing = tau < middle.tau;
  const Instant<kTangential>& from = compressing ? start : middle;
  const Instant<kTangential>& to = compressing ? middle : last;
  Instant<kTangential> at = to;
  at.kind = EventKind::kUnspecified;
  at.tau = tau;
  if (!(tau < to.tau)) return at;
  const double passed = (tau - from.tau) / (to.tau - from.tau);
  const double left = (to.tau - tau) / (to.tau - from.tau);
  const auto between = [&](double x, double y) { return std::fma(x, left, y * passed) + 0.0; };
  for (size_t i = 0; i < kTangential; ++i) {
    at.f[i] = between(from.f[i], to.f[i]);
    at.u[i] = between(from.u[i], to.u[i]);
  }
  at.v = between(from.v, to.v);
  return at;
}

template Slopes<1> SlidingSlopes(const Problem<1>&);
template Slopes<2> SlidingSlopes(const Problem<2>&);
template RelativeErrors ErrorsOf(const Problem<1>&);
template RelativeErrors ErrorsOf(const Problem<2>&);
template RelativeErrors FrictionlessErrorsOf(const Problem<1>&);
template RelativeErrors FrictionlessErrorsOf(const Problem<2>&);
template Impact<1> Solve(const Problem<1>&);
template Impact<2> Solve(const Problem<2>&);
template bool FrictionPushes(const Problem<1>&);
template bool FrictionPushes(const Problem<2>&);
template Impact<1> SolveFrictionless(const Problem<1>&);
template Impact<2> SolveFrictionless(const Problem<2>&);
template Instant<1> At(const Impact<1>&, double);
template Instant<2> At(const Impact<2>&, double);

}  // namespace ricochet::sliding
