#include "core/models/sliding/sliding.h"

#include "core/contact/delassus.h"

namespace ricochet::sliding {
namespace {

// 2^-53, enlarged by a quarter.
constexpr double kRounding = 1.25 * 0x1p-53;
constexpr RelativeErrors kNoBound = {.velocity = std::numeric_limits<double>::infinity(),
                                     .impulse = std::numeric_limits<double>::infinity()};

int RankOf(const Problem<1>& problem) {
  return PlanarDelassus{.tt = problem.w[0], .tn = problem.w[1], .nn = problem.w[2]}.Rank();
}

int RankOf(const Problem<2>& problem) { return SpatialDelassus{problem.w}.Rank(); }

template <typename Values>
bool AllModerate(const Values& values) {
  return std::all_of(values.begin(), values.end(), internal::Moderate);
}

// All that the frictionless impact reads.
template <size_t kTangential>
bool IsModerateWithoutFriction(const Problem<kTangential>& problem) {
  return AllModerate(problem.Wtn()) && AllModerate(problem.u0) &&
         AllModerate(std::array{problem.Wnn(), problem.v0, problem.coefficient});
}

template <size_t kTangential>
double ScaleOf(const Problem<kTangential>& problem) {
  return std::max(internal::Largest(problem.u0), std::fabs(problem.v0));
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

// All that friction has no part in.
template <size_t kTangential>
Impact<kTangential> MakeImpact(const Problem<kTangential>& problem, const End<kTangential>& end,
                               const Vector<kTangential>& u_slope) {
  const double c = problem.coefficient;
  Vector<kTangential> u_compression;
  for (size_t i = 0; i < kTangential; ++i) {
    u_compression[i] = std::fma(u_slope[i], end.tau_compression, problem.u0[i]) + 0.0;
  }
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
                    {.kind = EventKind::kCompressionEnds, .tau = end.tau_compression, .u = u_compression},
                    {.kind = EventKind::kRestitutionEnds, .tau = end.tau1, .u = end.u1, .v = end.v1}}};
  return impact;
}

}  // namespace

template <size_t kTangential>
RelativeErrors ErrorsOf(const Problem<kTangential>& problem) {
  constexpr double kDirectional = kTangential == 1 ? 0.0 : 6.0;
  if (!IsModerateWithoutFriction(problem) || !AllModerate(problem.w) || !internal::Moderate(problem.mu))
    return kNoBound;
  const Slopes<kTangential> slopes = SlidingSlopes(problem);
  if (!(slopes.v > 0.0)) return kNoBound;
  const double conditioning = kDirectional * (std::fabs(slopes.v - problem.Wnn()) / slopes.v);
  if (!(conditioning * 0x1p-53 <= 0x1p-4)) return kNoBound;
  const End<kTangential> end = SolveEnd(problem, slopes);
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
  const End<kTangential> end = SolveFrictionlessEnd(problem);
  const double drift = internal::Largest(problem.Wtn()) * end.tau1;
  const double unit = kRounding / ScaleOf(problem);
  return {.velocity = unit * std::max(end.v1, internal::Largest(end.u1) + 2.0 * drift),
          .impulse = unit * 2.0 * problem.Wnn() * end.tau1};
}

template <size_t kTangential>
Impact<kTangential> Solve(const Problem<kTangential>& problem) {
  const Slopes<kTangential> slopes = SlidingSlopes(problem);
  const End<kTangential> end = SolveEnd(problem, slopes);
  Impact<kTangential> impact = MakeImpact(problem, end, slopes.u);
  auto& [start, rest, last] = impact.events;
  Vector<kTangential> f_restitution;
  for (size_t i = 0; i < kTangential; ++i) {
    rest.f[i] = slopes.f[i] * end.tau_compression;
    f_restitution[i] = problem.coefficient * rest.f[i];
  }
  impact.f1 = last.f = end.f1;
  impact.tangential = kTangential == 1 ? slopes.f[0] : problem.mu;
  impact.work_tangential_compression = 0.5 * Dot(rest.f, Sum(start.u, rest.u)) + 0.0;
  impact.work_tangential_restitution = 0.5 * Dot(f_restitution, Sum(rest.u, last.u)) + 0.0;
  impact.energy_change += 0.5 * Dot(last.f, Sum(start.u, last.u));
  const double friction_gives = impact.work_tangential_compression + impact.work_tangential_restitution;
  impact.energy_limit_broken = friction_gives > 0.0 && impact.energy_change > 0.0;
  return impact;
}

template <size_t kTangential>
Impact<kTangential> SolveFrictionless(const Problem<kTangential>& problem) {
  Impact<kTangential> impact = MakeImpact(problem, SolveFrictionlessEnd(problem), problem.Wtn());
  impact.regime = Regime::kFrictionless;
  return impact;
}

template <size_t kTangential>
Instant<kTangential> At(const Impact<kTangential>& impact, double tau) {
  const auto& [start, rest, last] = impact.events;
  const bool compressing = tau < rest.tau;
  const Instant<kTangential>& from = compressing ? start : rest;
  const Instant<kTangential>& to = compressing ? rest : last;
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

template RelativeErrors ErrorsOf(const Problem<1>&);
template RelativeErrors ErrorsOf(const Problem<2>&);
template RelativeErrors FrictionlessErrorsOf(const Problem<1>&);
template RelativeErrors FrictionlessErrorsOf(const Problem<2>&);
template Impact<1> Solve(const Problem<1>&);
template Impact<2> Solve(const Problem<2>&);
template Impact<1> SolveFrictionless(const Problem<1>&);
template Impact<2> SolveFrictionless(const Problem<2>&);
template Instant<1> At(const Impact<1>&, double);
template Instant<2> At(const Impact<2>&, double);

}  // namespace ricochet::sliding
