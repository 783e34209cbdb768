// Impacts in space close to where the equations are singular, against other methods.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/models/restitution_law.h"
#include "core/models/spatial/spatial.h"
#include "ricochet/solver.h"
#include "tests/hard_cases/hard_case_table.h"
#include "tests/support/oracles/arb.h"
#include "tests/support/scenes/known_contacts.h"
#include "tests/support/scenes/spatial_scenes.h"

namespace ricochet::spatial {
namespace {

constexpr double kTolerance = 1e-12;

struct End {
  long double u1, u2, v;
};

double Scale(const Problem& problem) {
  return std::max(std::hypot(problem.u0[0], problem.u0[1]), std::fabs(problem.v0));
}

double Distance(const Problem& problem, const End& a, const End& b) {
  return static_cast<double>(std::max(std::hypot(a.u1 - b.u1, a.u2 - b.u2), std::fabs(a.v - b.v))) / Scale(problem);
}

End EndOf(const Impact& impact) { return {impact.u1[0], impact.u1[1], impact.v1}; }

// Keller's equations by the classical Runge-Kutta method at a fixed step, of tau or, where that is singular, of xi with
// dtau = s dxi: shares nothing with the solver.
template <typename T>
class RungeKutta {
 public:
  struct State {
    T u1, u2, v, tau;
  };
  RungeKutta(const Problem& problem, bool in_xi) : p_(problem), in_xi_(in_xi) {}

  State Stepped(const State& from, T step) const {
    const State k1 = Rate(from);
    const State k2 = Rate(Sum(from, step / 2, k1));
    const State k3 = Rate(Sum(from, step / 2, k2));
    const State k4 = Rate(Sum(from, step, k3));
    return Sum(Sum(Sum(Sum(from, step / 6, k1), step / 3, k2), step / 3, k3), step / 6, k4);
  }

  // The state at which `goal` first holds, by bisecting the step that reaches it; or a NaN.
  template <typename Goal>
  State Reach(State state, T step, const Goal& goal) const {
    constexpr int kEnough = 500'000;
    State next = Stepped(state, step);
    for (int i = 0; i < kEnough && !goal(next) && !std::isnan(next.v); ++i) {
      state = next;
      next = Stepped(state, step);
    }
    T low = 0;
    for (int i = 0; i < 64; ++i) {
      step /= 2;
      if (!goal(Stepped(state, low + step))) low += step;
    }
    return Stepped(state, low);
  }

  // The impact ends by Poisson's law.
  End Run(T step) const {
    State state = {static_cast<T>(p_.u0[0]), static_cast<T>(p_.u0[1]), static_cast<T>(p_.v0), T{0}};
    state = Reach(state, step, [](const State& at) { return at.v >= 0; });
    const T whole = (T{1} + static_cast<T>(p_.coefficient)) * state.tau;
    state = Reach(state, step, [whole](const State& at) { return at.tau >= whole; });
    return {state.u1, state.u2, state.v};
  }

 private:
  State Rate(const State& at) const {
    const T s = std::sqrt(at.u1 * at.u1 + at.u2 * at.u2);
    const T unit = in_xi_ ? s : T{1};
    const T f1 = -static_cast<T>(p_.mu) * at.u1 / s;
    const T f2 = -static_cast<T>(p_.mu) * at.u2 / s;
    return {unit * (p_.w11 * f1 + p_.w12 * f2 + p_.w13), unit * (p_.w12 * f1 + p_.w22 * f2 + p_.w23),
            unit * (p_.w13 * f1 + p_.w23 * f2 + p_.w33), unit};
  }
  static State Sum(const State& a, T t, const State& b) {
    return {a.u1 + t * b.u1, a.u2 + t * b.u2, a.v + t * b.v, a.tau + t * b.tau};
  }

  Problem p_;
  bool in_xi_;
};

// Slip comes as near to 0 as `least`, on the side from which it turns by 190 degrees (sign > 0) or by 170. The start is
// found by going back from there. `mu` = 0.1617 makes the angle between the directions in and out 190 degrees.
Problem NearMiss(double least, double mu, double sign) {
  Problem problem = TurningContact(0.0, 0.0, mu);
  problem.law = RestitutionLaw::kPoisson;
  problem.coefficient = 0.6;
  problem.tolerance = kTolerance;
  // The direction to the side, where slip neither grows nor falls.
  double best = std::numeric_limits<double>::infinity();
  double phi = 0.0;
  constexpr int kDirections = 100'000;
  const double start = sign > 0.0 ? 2.12 : -0.8;
  for (int i = 0; i < kDirections; ++i) {
    const double at = start + (std::numbers::pi * i) / kDirections;
    const double c = std::cos(at);
    const double s = std::sin(at);
    const double growth = c * (problem.w13 - mu * (problem.w11 * c + problem.w12 * s)) +
                          s * (problem.w23 - mu * (problem.w12 * c + problem.w22 * s));
    if (std::fabs(growth) < best) {
      best = std::fabs(growth);
      phi = at;
    }
  }
  using Method = RungeKutta<long double>;
  const Method back(problem, true);
  Method::State state = {least * std::cos(phi), least * std::sin(phi), 0.0L, 0.0L};
  state = back.Reach(state, -1e-2L, [](const Method::State& at) { return std::hypot(at.u1, at.u2) >= 0.3L; });
  problem.u0 = {static_cast<double>(state.u1), static_cast<double>(state.u2)};
  problem.v0 = -1.0;
  return problem;
}

// The angle in radians by which slip turns.
double Turned(const Problem& problem) {
  using Method = RungeKutta<long double>;
  const Method method(problem, true);
  Method::State state = {problem.u0[0], problem.u0[1], problem.v0, 0.0L};
  long double angle = 0.0L;
  const auto turn = [](const Method::State& a, const Method::State& b) {
    return std::atan2(a.u1 * b.u2 - a.u2 * b.u1, a.u1 * b.u1 + a.u2 * b.u2);
  };
  constexpr long double kStep = 1e-3L;
  while (state.tau < 0.6L) {
    const Method::State next = method.Stepped(state, kStep);
    angle += turn(state, next);
    state = next;
  }
  return static_cast<double>(std::fabs(angle));
}

// Applies Runge and Kutta's method in xi, and takes out the leading term of its error.
End Reference(const Problem& problem) {
  const RungeKutta<long double> method(problem, true);
  const End coarse = method.Run(2e-3L);
  const End fine = method.Run(1e-3L);
  const auto limit = [](long double x, long double y) { return y + (y - x) / 15.0L; };
  return {limit(coarse.u1, fine.u1), limit(coarse.u2, fine.u2), limit(coarse.v, fine.v)};
}

// Solves an impact under Poisson's law with 64-bit mantissas. Slip follows its Taylor series in xi, in steps of an
// eighth of the time in which it can change, until nothing is left of it. Stick, and slip in one direction, have closed
// forms.
class SlipSeries {
 public:
  explicit SlipSeries(const Problem& problem) : p_(problem), at_{problem.u0[0], problem.u0[1], problem.v0, 0.0L} {
    const long double most = p_.mu * (std::fabs(p_.w11) + 2.0L * std::fabs(p_.w12) + std::fabs(p_.w22));
    step_ = 0.125L / (most + std::fabs(p_.w13) + std::fabs(p_.w23));
  }

  End Run() {
    constexpr long double kNothing = 1e-21L;
    constexpr int kEnough = 100'000;
    for (int i = 0; i < kEnough && !done_; ++i) {
      const long double slip = std::hypot(at_[0], at_[1]);
      if (slip <= kNothing * Scale(p_)) {
        GoStraight(RateFromRest(), kNever);
      } else if (const Instant rate = RateAlong(at_[0] / slip, at_[1] / slip); IsStraight(rate)) {
        const long double growth = (rate[0] * at_[0] + rate[1] * at_[1]) / slip;
        GoStraight(rate, growth < 0.0L ? -slip / growth : kNever);
      } else {
        Slip();
      }
    }
    EXPECT_TRUE(done_);
    return {at_[0], at_[1], at_[2]};
  }

 private:
  static constexpr size_t kTerms = 32;
  static constexpr long double kNever = std::numeric_limits<long double>::infinity();
  using Series = std::array<long double, kTerms>;
  using Instant = std::array<long double, 4>;  // u1, u2, v, tau

  // du/dxi = A u + s wtn, s s' = u . u', dv/dxi = s Wnn - mu wtn . u, dtau/dxi = s.
  std::array<Series, 4> Expand() const {
    std::array<Series, 4> x = {};
    Series s = {};
    for (size_t i = 0; i < 4; ++i) x[i][0] = at_[i];
    s[0] = std::hypot(at_[0], at_[1]);
    for (size_t k = 0; k + 1 < kTerms; ++k) {
      const auto h = 1.0L / static_cast<long double>(k + 1);
      const long double u1 = x[0][k];
      const long double u2 = x[1][k];
      x[0][k + 1] = h * (s[k] * p_.w13 - p_.mu * (p_.w11 * u1 + p_.w12 * u2));
      x[1][k + 1] = h * (s[k] * p_.w23 - p_.mu * (p_.w12 * u1 + p_.w22 * u2));
      x[2][k + 1] = h * (s[k] * p_.w33 - p_.mu * (p_.w13 * u1 + p_.w23 * u2));
      x[3][k + 1] = h * s[k];
      long double square = 0.0L;
      for (size_t i = 0; i <= k + 1; ++i) square += x[0][i] * x[0][k + 1 - i] + x[1][i] * x[1][k + 1 - i];
      for (size_t i = 1; i <= k; ++i) square -= s[i] * s[k + 1 - i];
      s[k + 1] = square / (2.0L * s[0]);
    }
    return x;
  }

  static Instant At(const std::array<Series, 4>& x, long double xi) {
    Instant at = {};
    for (size_t i = 0; i < 4; ++i) {
      for (size_t k = kTerms; k-- > 0;) at[i] = at[i] * xi + x[i][k];
    }
    return at;
  }

  bool IsPhaseOver(const Instant& at) const { return restoring_ ? at[3] >= whole_ : at[2] >= 0.0L; }

  void Slip() {
    const std::array<Series, 4> x = Expand();
    const Instant next = At(x, step_);
    if (!IsPhaseOver(next)) {
      at_ = next;
      return;
    }
    long double low = 0.0L;
    for (long double part = 0.5L * step_; part > 1e-22L * step_; part *= 0.5L) {
      if (!IsPhaseOver(At(x, low + part))) low += part;
    }
    at_ = At(x, low);
    EndPhase();
  }

  void EndPhase() {
    done_ = restoring_;
    restoring_ = true;
    whole_ = (1.0L + p_.coefficient) * at_[3];
  }

  // Slip that has come to an invariant direction keeps it.
  bool IsStraight(const Instant& rate) const {
    constexpr long double kRounding = 1e-18L;
    return std::fabs(at_[0] * rate[1] - at_[1] * rate[0]) <= kRounding * std::hypot(at_[0], at_[1]) / step_;
  }

  Instant RateAlong(long double e1, long double e2) const {
    return {p_.w13 - p_.mu * (p_.w11 * e1 + p_.w12 * e2), p_.w23 - p_.mu * (p_.w12 * e1 + p_.w22 * e2),
            p_.w33 - p_.mu * (p_.w13 * e1 + p_.w23 * e2), 1.0L};
  }

  // Goes on at a constant d(u, v)/dtau to the end of the phase, or until slip stops.
  void GoStraight(const Instant& rate, long double until_stop) {
    const long double until_end = restoring_ ? whole_ - at_[3] : rate[2] > 0.0L ? -at_[2] / rate[2] : kNever;
    const long double wait = std::min(until_end, until_stop);
    for (size_t i = 0; i < 4; ++i) at_[i] += wait * rate[i];
    if (until_stop <= until_end) at_[0] = at_[1] = 0.0L;
    if (until_end <= until_stop) EndPhase();
  }

  // Within 4e-15 of the threshold, stick and slip end alike up to an error of that size.
  Instant RateFromRest() const {
    const long double w11 = p_.w11, w12 = p_.w12, w13 = p_.w13, w22 = p_.w22, w23 = p_.w23;
    const long double determinant = w11 * w22 - w12 * w12;
    const long double f1 = -(w22 * w13 - w12 * w23) / determinant;
    const long double f2 = -(w11 * w23 - w12 * w13) / determinant;
    if (std::hypot(f1, f2) <= p_.mu * (1.0L + 4e-15L)) return {0.0L, 0.0L, w13 * f1 + w23 * f2 + p_.w33, 1.0L};
    const long double phi = OutwardDirection();
    return RateAlong(std::cos(phi), std::sin(phi));
  }

  // The one direction in which slip can grow from 0: its rate is along itself.
  long double OutwardDirection() const {
    const auto rates = [this](long double phi) {
      const long double c = std::cos(phi);
      const long double s = std::sin(phi);
      const Instant rate = RateAlong(c, s);
      return std::array<long double, 2>{c * rate[0] + s * rate[1], c * rate[1] - s * rate[0]};
    };
    constexpr int kDirections = 2'000;
    constexpr long double kStep = 2.0L * std::numbers::pi_v<long double> / kDirections;
    for (int i = 0; i < kDirections; ++i) {
      long double low = kStep * i;
      if (!(rates(low)[1] * rates(low + kStep)[1] <= 0.0L) || !(rates(low)[0] > 0.0L)) continue;
      for (long double part = 0.5L * kStep; part > 1e-20L; part *= 0.5L) {
        if (rates(low)[1] * rates(low + part)[1] > 0.0L) low += part;
      }
      return low;
    }
    return std::numeric_limits<long double>::quiet_NaN();
  }

  Problem p_;
  Instant at_;
  long double step_ = 0.0L;
  long double whole_ = 0.0L;
  bool restoring_ = false, done_ = false;
};

// Integrates d/dtau plainly, in 4000 steps an impact.
End Naive(const Problem& problem) { return RungeKutta<double>(problem, false).Run(Solve(problem).tau1 / 4000.0); }

// NaN counts as worse than any number.
double Worse(double x, double y) { return std::isnan(x) || std::isnan(y) ? x + y : std::max(x, y); }

HardCaseResult RunNearMiss(const char* name, const char* why, const Problem& problem) {
  const End exact = Reference(problem);
  const Impact impact = Solve(problem);
  EXPECT_GE(impact.error_estimate, Distance(problem, EndOf(impact), exact)) << name;
  EXPECT_LE(impact.error_estimate, kTolerance) << name;
  EXPECT_EQ(impact.regime, Regime::kSliding) << name;
  return {.name = name,
          .why = why,
          .naive = Distance(problem, Naive(problem), exact),
          .promised = kTolerance,
          .seen = Distance(problem, EndOf(impact), exact)};
}

// mu lies within 1e-15 of |Wtt^-1 wtn|: slip that stops then sticks, or starts again at nearly no rate.
HardCaseResult RunStickThreshold() {
  HardCaseResult result = {.name = "stick threshold ± 10⁻¹⁵",
                           .why = "stick, or slip that starts again at 10⁻¹⁵ of a rate",
                           .promised = kTolerance};
  SceneSource source(7);
  for (int i = 0; i < 300; ++i) {
    Problem problem = source.Typical();
    problem.law = RestitutionLaw::kPoisson;
    problem.tolerance = kTolerance;
    const double distance = 1e-15 * (static_cast<double>(source.Below(3)) - 1.0);
    problem.mu = problem.mu_static = SceneSource::StickFriction(problem) * (1.0 + distance);
    if (i % 3 == 0) problem.u0 = {};
    const End exact = SlipSeries(problem).Run();
    const Impact impact = Solve(problem);
    const double error = Distance(problem, EndOf(impact), exact);
    EXPECT_GE(impact.error_estimate, error) << i;
    result.seen = std::max(result.seen, error);
    result.naive = Worse(result.naive, Distance(problem, Naive(problem), exact));
  }
  return result;
}

// Slip along (3, 1), its invariant direction, goes on to the end, with v' = `slow` Wnn. Entries have few bits, so that
// the direction is exact.
Problem SlowV(SceneSource& source, double slow, RestitutionLaw law) {
  const auto rounded = [](double x) { return std::ldexp(std::floor(std::ldexp(x, 20)), -20); };
  Problem p = {.w33 = 1.0, .v0 = -1.0, .law = law, .coefficient = source.Uniform(0.1, 1.0), .tolerance = kTolerance};
  p.w11 = p.w22 = source.Uniform(0.5, 2.0);
  const double coupling = rounded(source.Uniform(0.03, 0.2));
  p.w13 = 3.0 * coupling;
  p.w23 = coupling;
  const double length = std::hypot(3.0, 1.0);
  p.mu = p.mu_static = p.w33 / (coupling * length) * (1.0 - slow);
  const double slowing = (p.mu * p.w11 - coupling * length) * (1.0 + p.coefficient) / slow;
  if (slowing <= 0.0) return SlowV(source, slow, law);
  const double slip = rounded(source.Uniform(1.1, 2.0) * slowing / length);
  p.u0 = {3.0 * slip, slip};
  return p;
}

// The end of a straight path is the same by any law: v1 = -e v0, and u has one rate all along.
End StraightEnd(const Problem& p) {
  constexpr slong kBits = 300;
  const auto exactly = [](double x) { return Ball(x, kBits); };
  const Ball slip = Sqrt(exactly(p.u0[0]) * exactly(p.u0[0]) + exactly(p.u0[1]) * exactly(p.u0[1]));
  const Ball f1 = -(exactly(p.mu) * exactly(p.u0[0]) / slip);
  const Ball f2 = -(exactly(p.mu) * exactly(p.u0[1]) / slip);
  const Ball rise = exactly(p.w33) + exactly(p.w13) * f1 + exactly(p.w23) * f2;
  const Ball tau = -(exactly(p.v0) * (exactly(1.0) + exactly(p.coefficient))) / rise;
  const auto u = [&](int i, double across, double along, double with) {
    return exactly(p.u0[static_cast<size_t>(i)]) + tau * (exactly(across) * f1 + exactly(along) * f2 + exactly(with));
  };
  return {u(0, p.w11, p.w12, p.w13).Nearest(), u(1, p.w12, p.w22, p.w23).Nearest(), -p.coefficient * p.v0};
}

HardCaseResult RunSlowV() {
  HardCaseResult result = {.name = "v′ from 10⁻¹ to 10⁻⁵ Wnn",
                           .why = "the impact lasts up to 10⁵ times as long, and errors of v′ with it",
                           .promised = 0.0};
  SceneSource source(8);
  for (int i = 0; i < 3000; ++i) {
    const double slow = std::pow(10.0, -source.Uniform(0.1, 5.0));
    const Problem p = SlowV(source, slow, static_cast<RestitutionLaw>(i % 3));
    const End exact = StraightEnd(p);
    const Impact impact = Solve(p);
    EXPECT_TRUE(impact.closed_form && impact.regime == Regime::kSliding) << i;
    const double error = Distance(p, EndOf(impact), exact);
    EXPECT_GE(impact.error_estimate, error) << i;
    result.promised = std::max(result.promised, impact.error_estimate);
    result.seen = std::max(result.seen, error);
    const double slip = std::hypot(p.u0[0], p.u0[1]);
    const double along = p.mu / slip;
    const double tau1 = (1.0 + p.coefficient) / (p.w33 - along * (p.w13 * p.u0[0] + p.w23 * p.u0[1]));
    const End naive = {p.u0[0] + (p.w13 - along * p.w11 * p.u0[0]) * tau1,
                       p.u0[1] + (p.w23 - along * p.w22 * p.u0[1]) * tau1, p.coefficient};
    result.naive = std::max(result.naive, Distance(p, naive, exact));
  }
  return result;
}

HardCaseResult RunRankTwo() {
  HardCaseResult result = {
      .name = "W of rank two up to 10⁻¹⁴", .why = "sticking divides by what is left of it", .promised = 0.0};
  SceneSource source(9);
  for (int i = 0; i < 300; ++i) {
    Problem problem = source.NearRankTwo();
    problem.law = RestitutionLaw::kPoisson;
    problem.tolerance = kTolerance;
    const Impact impact = Solve(problem);
    const End exact = SlipSeries(problem).Run();
    const double error = Distance(problem, EndOf(impact), exact);
    result.naive = Worse(result.naive, Distance(problem, Naive(problem), exact));
    EXPECT_GE(impact.error_estimate, error) << i;
    result.promised = std::max(result.promised, impact.error_estimate);
    result.seen = std::max(result.seen, error);
  }
  return result;
}

TEST(SpatialHardCasesTest, KeepTheirPromise) {
  constexpr double kMu = 0.1617;
  std::vector<HardCaseResult> results = {
      RunNearMiss("slip of 10⁻¹⁰ left, turns by 170°", "d phi/d tau is of the order of 10¹⁰",
                  NearMiss(1e-10, kMu, -1.0)),
      RunNearMiss("slip of 10⁻¹⁴ left, turns by 170°", "it all but stops", NearMiss(1e-14, kMu, -1.0)),
      RunNearMiss("slip of 10⁻¹⁰ left, turns by 190°", "the long way round", NearMiss(1e-10, kMu, 1.0)),
      RunNearMiss("slip of 10⁻¹⁴ left, turns by 190°", "the long way round, and it all but stops",
                  NearMiss(1e-14, kMu, 1.0)),
      RunStickThreshold(),
      RunSlowV(),
      RunRankTwo()};
  CheckTable("spatial", "of max(\\|u₀\\|, \\|v₀\\|)", results);
}

TEST(SpatialHardCasesTest, NearMissesTurnByTheAnglesOfTheirNames) {
  EXPECT_NEAR(Turned(NearMiss(1e-14, 0.1617, 1.0)), 190.0 / 180.0 * std::numbers::pi, 0.02);
  EXPECT_NEAR(Turned(NearMiss(1e-14, 0.1617, -1.0)), 170.0 / 180.0 * std::numbers::pi, 0.02);
}

TEST(SpatialHardCasesTest, ATolerancePastDoublePrecisionIsRefusedInWords) {
  const Problem p = TurningContact(1.0, 0.6, 0.4);
  const Scene scene = {.system = SpatialContact{{p.w11, p.w12, p.w13, p.w22, p.w23, p.w33}, {1.0, 0.6}, -1.0},
                       .friction = {.kinetic_coefficient = 0.4},
                       .restitution = EnergeticCoefficient{0.6}};
  for (const double tolerance : {0.0, 1e-17}) {
    const auto response = LocalSolver().Solve({.scene = scene, .demand = {.relative_tolerance = tolerance}});
    ASSERT_TRUE(response.ok()) << response.status();
    const Accuracy& accuracy = response->outcome.accuracy;
    EXPECT_GT(accuracy.relative_error, tolerance);
    EXPECT_LT(accuracy.relative_error, 1e-12);
    EXPECT_EQ(accuracy.kind, AccuracyKind::kEstimate);
  }
}

}  // namespace
}  // namespace ricochet::spatial
