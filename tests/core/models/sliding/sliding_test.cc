// Compares slip that neither stops nor turns, and no friction at all, with the exact planar model, the spatial one, and
// the header's formulas in extended precision.

#include "core/models/sliding/sliding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/answer/model_outcomes.h"
#include "core/models/planar/planar.h"
#include "core/models/spatial/spatial.h"
#include "core/plan/scene_problem.h"
#include "tests/support/scenes/made_outcome.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/spatial_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet::sliding {
namespace {

using testing::ElementsAre;

constexpr int kScenes = 100'000;
constexpr double kUlp = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

template <size_t kTangential>
double ScaleOf(const Problem<kTangential>& p) {
  double scale = std::fabs(p.v0);
  for (const double u : p.u0) scale = std::max(scale, std::fabs(u));
  return scale;
}

// Keeps the largest ratio of an error to what is allowed for it.
class Worst {
 public:
  void Add(double error, double allowed) { ratio_ = std::max(ratio_, error == 0.0 ? 0.0 : error / allowed); }
  double ratio() const { return ratio_; }

 private:
  double ratio_ = 0.0;
};

// `exact` is itself within an ulp.
void Compare(const Problem<1>& p, const Impact<1>& end, const planar::Impact& exact, const RelativeErrors& bound,
             Worst& worst) {
  const double scale = ScaleOf(p);
  worst.Add(std::fabs(end.u1[0] - exact.u1), bound.velocity * scale + kUlp * std::fabs(exact.u1));
  worst.Add(std::fabs(end.v1 - exact.v1), bound.velocity * scale + kUlp * std::fabs(exact.v1));
  worst.Add(p.Wnn() * std::fabs(end.tau1 - exact.tau1), bound.impulse * scale + kUlp * p.Wnn() * exact.tau1);
  worst.Add(p.Wtt() * std::fabs(end.f1[0] - exact.f1), bound.impulse * scale + kUlp * p.Wtt() * std::fabs(exact.f1));
}

planar::Problem AnySliding(planar::SceneSource& source) {
  for (;;) {
    const planar::Problem p = source.Any();
    if (p.u0 == 0.0 || p.mu == 0.0 || p.coefficient > 1.0) continue;
    const planar::Impact exact = planar::Solve(p);
    if (exact.regime == Regime::kSliding && exact.w_rank == 2) return p;
  }
}

TEST(SlidingTest, InAPlaneItIsTheExactImpactWithinItsBound) {
  planar::SceneSource source(401);
  Worst worst;
  for (int i = 0; i < kScenes; ++i) {
    const planar::Problem p = AnySliding(source);
    const Problem<1> problem = SlidingProblemOf(p);
    Compare(problem, Solve(problem), planar::Solve(p), ErrorsOf(problem), worst);
    ASSERT_LE(worst.ratio(), 1.0) << i;
  }
  std::printf("  sliding in a plane        worst error %.3f of its bound\n", worst.ratio());
  EXPECT_GT(worst.ratio(), 0.1);
}

TEST(SlidingTest, AllTheRestOfAPlanarImpactIsThatOfTheExactOne) {
  planar::SceneSource source(402);
  for (int i = 0; i < 20'000; ++i) {
    const planar::Problem p = AnySliding(source);
    const planar::Impact exact = planar::Solve(p);
    const Problem<1> problem = SlidingProblemOf(p);
    const Impact<1> impact = Solve(problem);
    const RelativeErrors bound = ErrorsOf(problem);
    ASSERT_EQ(impact.regime, Regime::kSliding);
    ASSERT_EQ(impact.w_rank, 2);
    ASSERT_EQ(impact.event_count, exact.event_count);
    ASSERT_NEAR(impact.newton, exact.newton, 8.0 * kUlp);
    ASSERT_NEAR(impact.poisson, exact.poisson, 8.0 * kUlp);
    ASSERT_NEAR(impact.energetic, exact.energetic, 8.0 * kUlp);
    ASSERT_NEAR(impact.energetic_excess, exact.energetic_excess, 8.0 * kUlp);
    ASSERT_DOUBLE_EQ(impact.tangential, exact.tangential);
    ASSERT_FALSE(exact.energy_limit_broken);
    // A work is an impulse times a velocity, each with its error.
    const double work = 8.0 * (exact.tau1 + std::fabs(exact.f1)) * ScaleOf(problem) *
                        (bound.velocity + kUlp * (1.0 + std::fabs(exact.u1) / ScaleOf(problem)));
    ASSERT_NEAR(impact.work_normal_compression, exact.work_normal_compression, work);
    ASSERT_NEAR(impact.work_normal_restitution, exact.work_normal_restitution, work);
    ASSERT_NEAR(impact.work_tangential_compression, exact.work_tangential_compression, work);
    ASSERT_NEAR(impact.work_tangential_restitution, exact.work_tangential_restitution, work);
    ASSERT_NEAR(impact.energy_change, exact.energy_change, work);
    for (size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(impact.events[k].kind, exact.events[k].kind);
      ASSERT_NEAR(impact.events[k].tau, exact.events[k].tau, 4.0 * kUlp * exact.tau1);
      ASSERT_NEAR(impact.events[k].f[0], exact.events[k].f, 4.0 * kUlp * std::fabs(exact.f1));
      ASSERT_NEAR(impact.events[k].u[0], exact.events[k].u, 2.0 * bound.velocity * ScaleOf(problem));
      ASSERT_NEAR(impact.events[k].v, exact.events[k].v, 2.0 * bound.velocity * ScaleOf(problem));
    }
  }
}

// Evaluates the formulas of the header in extended precision.
struct Extended {
  long double u1[2], f1[2], v1, tau1;
};

Extended SolveExtended(const Problem<2>& p, bool friction) {
  const auto& [w11, w12, w13, w22, w23, w33] = p.w;
  const long double x = p.u0[0];
  const long double y = p.u0[1];
  const long double slip = std::sqrt(x * x + y * y);
  const long double f[2] = {friction ? -p.mu * x / slip : 0.0L, friction ? -p.mu * y / slip : 0.0L};
  const long double slope[2] = {w13 + w11 * f[0] + w12 * f[1], w23 + w12 * f[0] + w22 * f[1]};
  const long double tau1 = -p.v0 * (1.0L + p.coefficient) / (w33 + w13 * f[0] + w23 * f[1]);
  return {.u1 = {x + slope[0] * tau1, y + slope[1] * tau1},
          .f1 = {f[0] * tau1, f[1] * tau1},
          .v1 = -static_cast<long double>(p.coefficient) * p.v0,
          .tau1 = tau1};
}

void Compare(const Problem<2>& p, const Impact<2>& end, const Extended& exact, const RelativeErrors& bound,
             Worst& worst) {
  const double scale = ScaleOf(p);
  const auto error = [](double x, long double y) { return static_cast<double>(std::fabs(x - y)); };
  for (size_t i = 0; i < 2; ++i) {
    worst.Add(error(end.u1[i], exact.u1[i]), bound.velocity * scale);
    worst.Add(p.Wtt() * error(end.f1[i], exact.f1[i]), bound.impulse * scale);
  }
  worst.Add(error(end.v1, exact.v1), bound.velocity * scale);
  worst.Add(p.Wnn() * error(end.tau1, exact.tau1), bound.impulse * scale);
}

TEST(SlidingTest, InSpaceItsFormulasAreEvaluatedWithinTheirBound) {
  spatial::SceneSource source(403);
  Worst worst;
  for (int i = 0; i < kScenes;) {
    const Problem<2> problem = SlidingProblemOf(i % 4 == 0 ? source.NearJam() : source.Typical());
    // If v grows more slowly, extended precision does not serve as a reference.
    if (!(SlidingSlopes(problem).v > 1e-4 * problem.Wnn())) continue;
    Compare(problem, Solve(problem), SolveExtended(problem, true), ErrorsOf(problem), worst);
    ASSERT_LE(worst.ratio(), 1.0) << i;
    ++i;
  }
  std::printf("  sliding in space          worst error %.3f of its bound\n", worst.ratio());
  EXPECT_GT(worst.ratio(), 0.1);
}

// Puts a planar impact into a tangent frame that is turned by any angle, with any mobility across it.
spatial::Problem InSpace(const planar::Problem& p, double across, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {.w11 = c * c * p.w.tt + s * s * across,
          .w12 = c * s * (p.w.tt - across),
          .w13 = c * p.w.tn,
          .w22 = s * s * p.w.tt + c * c * across,
          .w23 = s * p.w.tn,
          .w33 = p.w.nn,
          .u0 = {c * p.u0, s * p.u0},
          .v0 = p.v0,
          .mu = p.mu,
          .mu_static = p.mu_static,
          .law = p.law,
          .coefficient = p.coefficient,
          .tolerance = 1e-12};
}

TEST(SlidingTest, InSpaceItIsTheSpatialModelWhereSlipDoesNotTurn) {
  planar::SceneSource source(404);
  Worst worst;
  for (int i = 0; i < 20'000;) {
    planar::Problem plane = source.Everyday();
    if (plane.u0 == 0.0 || plane.mu == 0.0 || planar::Solve(plane).regime != Regime::kSliding) continue;
    plane.coefficient = std::min(plane.coefficient, 1.0);
    const spatial::Problem p = InSpace(plane, source.Uniform(0.1, 3.0), source.Uniform(0.0, 6.0));
    const spatial::Impact other = spatial::Solve(p);
    if (!other.closed_form || other.regime != Regime::kSliding) continue;
    const Problem<2> problem = SlidingProblemOf(p);
    const Impact<2> impact = Solve(problem);
    const double allowed = (ErrorsOf(problem).velocity + p.tolerance) * ScaleOf(problem);
    for (size_t k = 0; k < 2; ++k) worst.Add(std::fabs(impact.u1[k] - other.u1[k]), allowed);
    worst.Add(std::fabs(impact.v1 - other.v1), allowed);
    ASSERT_LE(worst.ratio(), 1.0) << i;
    ASSERT_EQ(impact.w_rank, other.w_rank);
    ASSERT_NEAR(impact.energy_change, other.energy_change, 1e-11 * std::fabs(other.energy_change)) << i;
    ASSERT_NEAR(impact.tangential, other.tangential, 1e-12 * p.mu);
    ++i;
  }
  std::printf("  against the spatial model worst difference %.3f of its tolerance\n", worst.ratio());
}

TEST(FrictionlessTest, InAPlaneItIsTheExactImpactWithinItsBound) {
  planar::SceneSource source(405);
  Worst worst;
  for (int i = 0; i < kScenes;) {
    planar::Problem p = source.Any();
    p.mu = p.mu_static = 0.0;
    p.coefficient = std::min(p.coefficient, 1.0);
    const planar::Impact exact = planar::Solve(p);
    if (exact.w_rank < 2) continue;
    const Problem<1> problem = SlidingProblemOf(p);
    Compare(problem, SolveFrictionless(problem), exact, FrictionlessErrorsOf(problem), worst);
    ASSERT_LE(worst.ratio(), 1.0) << i;
    ASSERT_EQ(SolveFrictionless(problem).regime, exact.regime);
    ASSERT_NEAR(SolveFrictionless(problem).energy_change, exact.energy_change,
                8.0 * kUlp * std::fabs(exact.work_normal_compression));
    ++i;
  }
  std::printf("  frictionless in a plane   worst error %.3f of its bound\n", worst.ratio());
  EXPECT_GT(worst.ratio(), 0.1);
}

TEST(FrictionlessTest, InSpaceItIsTheSpatialModelAndWithinItsBoundOfTheFormulas) {
  spatial::SceneSource source(406);
  Worst worst;
  for (int i = 0; i < kScenes; ++i) {
    spatial::Problem p = source.Typical();
    p.mu = p.mu_static = 0.0;
    p.tolerance = 1e-12;
    const Problem<2> problem = SlidingProblemOf(p);
    const Impact<2> end = SolveFrictionless(problem);
    const RelativeErrors bound = FrictionlessErrorsOf(problem);
    Compare(problem, end, SolveExtended(problem, false), bound, worst);
    ASSERT_LE(worst.ratio(), 1.0) << i;
    if (i % 10 != 0) continue;
    const spatial::Impact other = spatial::Solve(p);
    const double allowed = (bound.velocity + p.tolerance) * ScaleOf(problem);
    for (size_t k = 0; k < 2; ++k) ASSERT_NEAR(end.u1[k], other.u1[k], allowed);
    ASSERT_NEAR(end.v1, other.v1, allowed);
  }
  std::printf("  frictionless in space     worst error %.3f of its bound\n", worst.ratio());
}

TEST(FrictionlessTest, ReadsNoFrictionAndNoTangentialMobility) {
  const Problem<2> problem = {.w = {2.0, 0.3, 0.4, 1.5, -0.2, 1.2}, .u0 = {1.0, -0.5}, .v0 = -1.0, .coefficient = 0.5};
  Problem<2> poisoned = problem;
  poisoned.mu = poisoned.w[0] = poisoned.w[1] = poisoned.w[3] = kNaN;
  const Impact<2> end = SolveFrictionless(problem);
  const Impact<2> other = SolveFrictionless(poisoned);
  EXPECT_EQ(end.u1, other.u1);
  EXPECT_EQ(end.v1, other.v1);
  EXPECT_EQ(end.tau1, other.tau1);
  EXPECT_EQ(end.f1, other.f1);
  EXPECT_EQ(FrictionlessErrorsOf(problem).velocity, FrictionlessErrorsOf(poisoned).velocity);
  EXPECT_EQ(FrictionlessErrorsOf(problem).impulse, FrictionlessErrorsOf(poisoned).impulse);
  poisoned = problem;
  poisoned.mu = kNaN;
  EXPECT_EQ(SolveFrictionless(problem).energy_change, SolveFrictionless(poisoned).energy_change);
  EXPECT_EQ(SolveFrictionless(poisoned).work_tangential_compression, 0.0);
}

TEST(SlidingTest, PromisesNothingWhereProductsMayLeaveTheRangeOfDoublesOrVHardlyGrows) {
  const Problem<1> fine = {.w = {2.5, 0.5, 2.5}, .u0 = {9.0}, .v0 = -1.0, .mu = 0.3, .coefficient = 0.5};
  EXPECT_LT(ErrorsOf(fine).Largest(), 1e-14);
  for (double Problem<1>::*const number : {&Problem<1>::mu, &Problem<1>::coefficient}) {
    Problem<1> far = fine;
    far.*number *= 0x1p-101;
    EXPECT_EQ(ErrorsOf(far).velocity, kInfinity);
    EXPECT_EQ(ErrorsOf(far).impulse, kInfinity);
  }
  Problem<1> slow = fine;
  slow.u0[0] = slow.v0 = -0x1p-901;
  EXPECT_EQ(ErrorsOf(slow).velocity, kInfinity);
  Problem<1> jams = fine;
  jams.mu = 5.0;
  EXPECT_EQ(ErrorsOf(jams).velocity, kInfinity);
  Problem<2> hardly = {.w = {9.0, 0.0, 1.0, 9.0, 1.0, 1.0}, .u0 = {1.0, 1.0}, .v0 = -1.0, .coefficient = 0.5};
  hardly.mu = std::sqrt(0.5) * (1.0 - 0x1p-51);
  EXPECT_EQ(ErrorsOf(hardly).velocity, kInfinity);
  hardly.mu = 0.5;
  EXPECT_LT(ErrorsOf(hardly).velocity, 1e-13);
}

TEST(SlidingTest, PromisesTheSameForAnApproachOfAnySize) {
  for (const double v0 : {-1.0, -1e-30, -1e-100, -1e-300, -0x1p-1074}) {
    const Problem<2> grazes = {
        .w = {1.96, 0.24, 0.6, 2.96, -0.8, 1.85}, .u0 = {1.0, 0.6}, .v0 = v0, .mu = 0.3, .coefficient = 0.8};
    EXPECT_LT(ErrorsOf(grazes).Largest(), 1e-14) << v0;
    EXPECT_LT(FrictionlessErrorsOf(grazes).Largest(), 1e-15) << v0;
  }
}

template <size_t kTangential>
void ExpectLinear(const Problem<kTangential>& problem, const Impact<kTangential>& impact) {
  const auto& [start, rest, last] = impact.events;
  for (const Instant<kTangential>& event : impact.events) {
    const Instant<kTangential> there = At(impact, event.tau);
    ASSERT_EQ(there.f, event.f);
    ASSERT_EQ(there.u, event.u);
    ASSERT_EQ(there.v, event.v);
  }
  for (const double part : {0.1, 0.5, 0.9}) {
    const Instant<kTangential> there = At(impact, part * impact.tau1);
    const double size = 8.0 * kUlp * (ScaleOf(problem) + std::fabs(last.v));
    ASSERT_NEAR(there.v, problem.v0 + part * (impact.v1 - problem.v0), size);
    for (size_t i = 0; i < kTangential; ++i) {
      ASSERT_NEAR(there.f[i], part * impact.f1[i], 8.0 * kUlp * std::fabs(impact.f1[i]));
      ASSERT_NEAR(there.u[i], problem.u0[i] + part * (impact.u1[i] - problem.u0[i]),
                  size + 8.0 * kUlp * std::fabs(impact.u1[i]));
    }
  }
}

template <size_t kTangential>
void ExpectLedger(const Impact<kTangential>& impact) {
  const double works = impact.work_normal_compression + impact.work_normal_restitution +
                       impact.work_tangential_compression + impact.work_tangential_restitution;
  const double size =
      std::fabs(impact.work_normal_compression) + std::fabs(impact.work_tangential_compression) + std::fabs(works);
  ASSERT_NEAR(works, impact.energy_change, 16.0 * kUlp * size);
}

TEST(SlidingTest, HistoriesAreStraightMeetTheEventsAndWorksAddUp) {
  planar::SceneSource plane(407);
  spatial::SceneSource space(408);
  for (int i = 0; i < 5'000; ++i) {
    const Problem<1> flat = SlidingProblemOf(AnySliding(plane));
    ExpectLinear(flat, Solve(flat));
    ExpectLinear(flat, SolveFrictionless(flat));
    ExpectLedger(Solve(flat));
    ExpectLedger(SolveFrictionless(flat));
    spatial::Problem p = space.Typical();
    p.mu *= 0.1;
    const Problem<2> problem = SlidingProblemOf(p);
    ExpectLinear(problem, Solve(problem));
    ExpectLinear(problem, SolveFrictionless(problem));
    ExpectLedger(Solve(problem));
    ExpectLedger(SolveFrictionless(problem));
  }
}

// ---- Outcomes ----

std::vector<EventKind> KindsOf(const Outcome& outcome) {
  std::vector<EventKind> kinds;
  for (const Event& event : outcome.timeline) kinds.push_back(event.kind);
  return kinds;
}

void ExpectNear(absl::Span<const double> x, absl::Span<const double> y) {
  ASSERT_EQ(x.size(), y.size());
  for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], 1e-12 * (1.0 + std::fabs(y[i])));
}

// Compares everything but accuracy and history.
void ExpectSameImpact(const Outcome& x, const Outcome& y) {
  EXPECT_EQ(x.regime, y.regime);
  EXPECT_EQ(x.w_rank, y.w_rank);
  EXPECT_EQ(KindsOf(x), KindsOf(y));
  ExpectNear(x.rates_after_rad_s, y.rates_after_rad_s);
  ExpectNear(x.contact_velocity_after.tangential_m_s, y.contact_velocity_after.tangential_m_s);
  ExpectNear(x.impulse.tangential_n_s, y.impulse.tangential_n_s);
  ExpectNear({x.contact_velocity_after.normal_m_s, *x.impulse.normal_compression_n_s, x.impulse.normal_total_n_s,
              x.work.normal_total_j, x.work.tangential_total_j, x.energy_change_j, x.coefficients.tangential},
             {y.contact_velocity_after.normal_m_s, *y.impulse.normal_compression_n_s, y.impulse.normal_total_n_s,
              y.work.normal_total_j, y.work.tangential_total_j, y.energy_change_j, y.coefficients.tangential});
  ASSERT_EQ(x.bodies_after.size(), y.bodies_after.size());
  for (size_t i = 0; i < x.bodies_after.size(); ++i) {
    ExpectNear(x.bodies_after[i].linear_m_s, y.bodies_after[i].linear_m_s);
    ExpectNear(x.bodies_after[i].angular_rad_s, y.bodies_after[i].angular_rad_s);
  }
  for (size_t i = 0; i < x.timeline.size(); ++i) {
    ExpectNear(x.timeline[i].state.rates_rad_s, y.timeline[i].state.rates_rad_s);
  }
}

Outcome FullOutcome(const PlanarReduction& reduction, const Restitution& restitution,
                    const EffectiveCoefficients& effective) {
  const planar::Problem problem = planar::MakeProblem(reduction, restitution, effective);
  return Made([&](Outcome& made) { return planar::MakeOutcome(problem, reduction, 0.0, {}, made); }).value();
}

Outcome FullOutcome(const SpatialReduction& reduction, const Restitution& restitution,
                    const EffectiveCoefficients& effective) {
  const spatial::Problem problem = spatial::MakeProblem(reduction, restitution, effective, 1e-12);
  return Made([&](Outcome& made) { return spatial::MakeOutcome(spatial::Solve(problem), reduction, {}, made); })
      .value();
}

Problem<1> ProblemOf(const PlanarReduction& reduction, const EffectiveCoefficients& effective) {
  return SlidingProblemOf(planar::MakeProblem(reduction, EnergeticCoefficient(), effective));
}

Problem<2> ProblemOf(const SpatialReduction& reduction, const EffectiveCoefficients& effective) {
  return SlidingProblemOf(spatial::MakeProblem(reduction, EnergeticCoefficient(), effective, 1e-12));
}

template <size_t kTangential>
Outcome FrictionlessOutcome(const Reduction<kTangential>& reduction, const EffectiveCoefficients& effective) {
  const Problem<kTangential> problem = ProblemOf(reduction, effective);
  return Made([&](Outcome& made) {
           return MakeOutcome(problem, SolveFrictionless(problem), FrictionlessErrorsOf(problem), reduction, {}, made);
         })
      .value();
}

template <size_t kTangential>
absl::StatusOr<Outcome> SlidingOutcome(const Reduction<kTangential>& reduction, const EffectiveCoefficients& effective,
                                       const std::vector<double>& taus = {}) {
  const Problem<kTangential> problem = ProblemOf(reduction, effective);
  return Made([&](Outcome& made) {
    return MakeOutcome(problem, Solve(problem), ErrorsOf(problem), reduction, {.history_at_n_s = taus}, made);
  });
}

TEST(SlidingOutcomeTest, OfEverySystemWhoseSlipGoesOnIsThatOfTheFullModel) {
  const EffectiveCoefficients effective = {.kinetic_friction = 0.01, .static_friction = 0.01, .restitution = 0.5};
  int planar_systems = 0;
  for (const System& system : Systems()) {
    const Scene scene = With(system);
    const AnyReduction any = Reduce(scene);
    if (const auto* flat = std::get_if<PlanarReduction>(&any)) {
      const Outcome full = FullOutcome(*flat, scene.restitution, effective);
      if (full.regime != Regime::kSliding) continue;
      ExpectSameImpact(SlidingOutcome(*flat, effective).value(), full);
      ++planar_systems;
    }
  }
  EXPECT_GE(planar_systems, 3);
}

TEST(SlidingOutcomeTest, WithoutFrictionEverySystemIsThatOfTheFullModel) {
  const EffectiveCoefficients effective = {.restitution = 0.5};
  for (const System& system : Systems()) {
    const Scene scene = With(system);
    std::visit(
        [&](const auto& reduction) {
          ExpectSameImpact(FrictionlessOutcome(reduction, effective),
                           FullOutcome(reduction, scene.restitution, effective));
        },
        Reduce(scene));
  }
}

TEST(SlidingOutcomeTest, AnswersAHistoryInSpaceWithAProvedBound) {
  const auto reduction = std::get<SpatialReduction>(Reduce(With(ContactInSpace())));
  const EffectiveCoefficients effective = {.kinetic_friction = 0.01, .restitution = 0.5};
  const Problem<2> problem = ProblemOf(reduction, effective);
  const Impact<2> impact = Solve(problem);
  const Outcome outcome = SlidingOutcome(reduction, effective, {0.0, 0.5 * impact.tau1, impact.tau1}).value();
  ASSERT_EQ(outcome.history.size(), 3U);
  EXPECT_EQ(outcome.history[0].contact_velocity.tangential_m_s, (Components{1.0, 0.6}));
  EXPECT_EQ(outcome.history[1].tangential_impulse_n_s.size(), 2U);
  EXPECT_EQ(outcome.history[2].contact_velocity, outcome.contact_velocity_after);
  EXPECT_EQ(outcome.accuracy.kind, AccuracyKind::kBound);
  EXPECT_EQ(outcome.accuracy.relative_error, ErrorsOf(problem).velocity);
  EXPECT_THAT(KindsOf(outcome),
              ElementsAre(EventKind::kStart, EventKind::kCompressionEnds, EventKind::kRestitutionEnds));
  EXPECT_EQ(SlidingOutcome(reduction, effective, {1.1 * impact.tau1}).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace ricochet::sliding
