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

// The sizes for which products stay within the range of doubles. Velocities may be smaller: what their products lose by
// underflow is at most Unseen of the largest one.
constexpr double kLimit = 0x1p100;
constexpr double kLeastVelocity = 0x1p-900;
constexpr double kSmallest = 0x1p-1074;

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

bool IsVelocity(double size) { return size >= kLeastVelocity && size <= kLimit; }

// Returns whether all numbers that the frictionless impact reads are moderate.
template <size_t kTangential>
bool IsModerateWithoutFriction(const Problem<kTangential>& problem) {
  return AreModerate(problem.Wtn(), kLimit) && AreModerate({problem.Wnn(), problem.coefficient}, kLimit) &&
         IsVelocity(ScaleOf(problem));
}
template <size_t kTangential>
bool IsModerate(const Problem<kTangential>& problem) {
  return IsModerateWithoutFriction(problem) && AreModerate(problem.w, kLimit) && AreModerate({problem.mu}, kLimit) &&
         IsVelocity(Largest(problem.u0));
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

// Returns x + slope * tau; adding 0.0 turns -0 into 0.
template <size_t kTangential>
Vector<kTangential> Advanced(const Vector<kTangential>& x, const Vector<kTangential>& slope, double tau) {
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
  return {tau_compression, tau1, Advanced(problem.u0, u_slope, tau1), -problem.coefficient * problem.v0};
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
  impact.work_normal_compression = 0.5 * end.tau_compression * problem.v0 + 0.0;
  impact.work_normal_restitution = 0.0 - c * c * impact.work_normal_compression;
  // v0 + v1 = (1 - c) v0
  impact.energy_change = 0.5 * end.tau1 * ((1.0 - c) * problem.v0) + 0.0;
  impact.events = {{{.kind = EventKind::kStart, .u = problem.u0, .v = problem.v0},
                    {.kind = EventKind::kCompressionEnds,
                     .tau = end.tau_compression,
                     .u = Advanced(problem.u0, u_slope, end.tau_compression)},
                    {.kind = EventKind::kRestitutionEnds, .tau = end.tau1, .u = end.u1, .v = end.v1}}};
  return impact;
}

// Counts the roundings of the direction of slip in a component of W along it; in a plane the direction is exact.
template <size_t kTangential>
constexpr double kDirectionErrors = kTangential == 1 ? 0.0 : 6.0;

// Returns what these roundings change of v', relative to v'; infinite if v' is not positive.
template <size_t kTangential>
double ConditioningOf(const Problem<kTangential>& problem, const Slopes<kTangential>& slopes) {
  if (!(slopes.v > 0.0)) return std::numeric_limits<double>::infinity();
  return kDirectionErrors<kTangential> * (std::fabs(slopes.v - problem.Wnn()) / slopes.v);
}

// Bounds what underflow takes from velocities, and from impulses times mobilities below 2^100, over the largest one.
template <size_t kTangential>
double Unseen(const Problem<kTangential>& problem) {
  const bool nothing = AreModerate(problem.u0, kLimit) && AreModerate({problem.v0}, kLimit);
  return nothing ? 0.0 : kSmallest * kLimit * 64.0 / ScaleOf(problem);
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
  constexpr double kDirectional = kDirectionErrors<kTangential>;
  if (!IsModerate(problem)) return kNoBound;
  const Slopes<kTangential> slopes = SlidingSlopes(problem);
  const double conditioning = ConditioningOf(problem, slopes);
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
  const double unseen = Unseen(problem);
  return {.velocity = unit * velocity + unseen, .impulse = unit * end.tau1 * std::max(normal, tangential) + unseen};
}

template <size_t kTangential>
RelativeErrors FrictionlessErrorsOf(const Problem<kTangential>& problem) {
  if (!IsModerateWithoutFriction(problem)) return kNoBound;
  const End<kTangential> end = EndOf(problem, problem.Wtn(), problem.Wnn());
  const double drift = Largest(problem.Wtn()) * end.tau1;
  const double unit = kRounding / ScaleOf(problem);
  const double unseen = Unseen(problem);
  return {.velocity = unit * std::max(end.v1, Largest(end.u1) + 2.0 * drift) + unseen,
          .impulse = unit * 2.0 * problem.Wnn() * end.tau1 + unseen};
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
ImpactErrors NumberErrorsOf(const Problem<kTangential>& problem, const Impact<kTangential>& impact) {
  const bool friction = impact.regime == Regime::kSliding;
  if (friction ? !IsModerate(problem) : !IsModerateWithoutFriction(problem)) return {};
  Slopes<kTangential> slopes = {.u = problem.Wtn(), .v = problem.Wnn(), .f = {}};
  if (friction) slopes = SlidingSlopes(problem);
  const double conditioning = friction ? ConditioningOf(problem, slopes) : 0.0;
  if (!(conditioning * 0x1p-53 <= 0x1p-4)) return {};
  const double directional = friction ? kDirectionErrors<kTangential> : 0.0;
  const auto& [start, middle, last] = impact.events;
  const Vector<kTangential> wtn = problem.Wtn();
  const auto of = [](double count, double number) { return kRounding * count * std::fabs(number) + kSmallest; };
  ImpactErrors errors;
  errors.newton = errors.poisson = errors.energetic = errors.tangential = 0.0;
  errors.v = of(1.0, impact.v1);
  errors.tau_compression = of(2.0 + conditioning, impact.tau_compression);
  errors.tau = of(3.0 + conditioning, impact.tau1);
  errors.work_normal_compression = of(3.0 + conditioning, impact.work_normal_compression);
  errors.work_normal_restitution = of(6.0 + conditioning, impact.work_normal_restitution);
  errors.u = errors.f = 0.0;
  errors.work_tangential_compression = errors.work_tangential_restitution = kSmallest;
  errors.energy_change = of(7.0 + conditioning, impact.work_normal_compression + impact.work_normal_restitution) +
                         of(1.0, impact.energy_change);
  for (size_t i = 0; i < kTangential; ++i) {
    const double of_slope =
        (4.0 + conditioning) * std::fabs(slopes.u[i]) + directional * std::fabs(slopes.u[i] - wtn[i]);
    const double of_middle = std::fabs(middle.u[i]) + of_slope * impact.tau_compression;
    const double of_last = std::fabs(last.u[i]) + of_slope * impact.tau1;
    errors.u = std::max(errors.u, of(1.0, of_last));
    errors.f = std::max(errors.f, of(directional + 4.0 + conditioning, impact.f1[i]));
    const auto work = [&](double f, double u_sum, double u_error) {
      return 0.5 * std::fabs(f) * ((directional + 9.0 + conditioning) * std::fabs(u_sum) + u_error);
    };
    const double f_restitution = problem.coefficient * middle.f[i];
    errors.work_tangential_compression += of(1.0, work(middle.f[i], start.u[i] + middle.u[i], of_middle));
    errors.work_tangential_restitution += of(1.0, work(f_restitution, middle.u[i] + last.u[i], of_middle + of_last));
    errors.energy_change += of(1.0, work(impact.f1[i], start.u[i] + last.u[i], of_last));
  }
  if (!friction) errors.f = errors.work_tangential_compression = errors.work_tangential_restitution = 0.0;
  return errors;
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
template ImpactErrors NumberErrorsOf(const Problem<1>&, const Impact<1>&);
template ImpactErrors NumberErrorsOf(const Problem<2>&, const Impact<2>&);
template Instant<1> At(const Impact<1>&, double);
template Instant<2> At(const Impact<2>&, double);

}  // namespace ricochet::sliding
