// The model of finite duration: closed forms, the rigid impact, a table of compliant impacts, a second integrator.

#include "core/models/finite_duration/finite_duration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "core/models/compliant/compliant.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet::finite_duration {
namespace {

double SpeedOf(const Problem& problem) {
  return std::max(std::fabs(problem.contact.u0), std::fabs(problem.contact.v0));
}

Problem ProblemOf(const planar::Problem& rigid, const NormalSpring& spring, double tolerance) {
  return {.contact = rigid, .spring = spring, .tolerance = tolerance};
}

// A uniform rod at 45 degrees that strikes with its end, m = l = 1, under gravity of its own.
Problem Rod(const NormalSpring& spring) {
  return {.contact = {.w = {2.5, 1.5, 2.5}, .u0 = -1.0, .v0 = -1.0, .mu = 0.3, .mu_static = 0.3, .coefficient = 0.7},
          .tangential_acceleration = 0.0,
          .normal_acceleration = -9.81,
          .spring = spring};
}

double WorkScale(const Impact& impact) {
  return std::max({std::fabs(impact.work_normal_compression), std::fabs(impact.work_normal_restitution),
                   std::fabs(impact.work_tangential_compression), std::fabs(impact.work_tangential_restitution)});
}

double Residual(const Impact& impact) {
  return impact.work_normal_compression + impact.work_normal_restitution + impact.work_tangential_compression +
         impact.work_tangential_restitution - impact.energy_change;
}

double DistanceOf(const Problem& problem, const Impact& impact, double u1, double v1) {
  return std::max(std::fabs(impact.u1 - u1), std::fabs(impact.v1 - v1)) / SpeedOf(problem);
}

std::vector<EventKind> KindsOf(const Impact& impact) {
  std::vector<EventKind> kinds;
  for (const TimedInstant& event : impact.events) kinds.push_back(event.kind);
  return kinds;
}

// Estimated over true errors. Never below 1, in the median at most 100.
class EstimateLog {
 public:
  void Add(const Impact& impact, double error, const std::string& what) {
    EXPECT_LE(error, impact.error_estimate) << what;
    ratios_.push_back(impact.error_estimate / std::max(error, 1e-17));
  }
  void Check(const char* name) {
    std::sort(ratios_.begin(), ratios_.end());
    const double median = ratios_[ratios_.size() / 2];
    std::printf("  %-24s estimated over true error: least %.2g, median %.2g of %zu\n", name, ratios_.front(), median,
                ratios_.size());
    EXPECT_LE(median, 100.0) << name;
  }

 private:
  std::vector<double> ratios_;
};

// Returns whether rounding or the tolerance may move the stop of slip into another phase.
bool StopsNearAnEnd(const planar::Impact& impact, double speed, double tolerance) {
  for (int i = 0; i < impact.event_count; ++i) {
    const planar::Instant& event = impact.events[static_cast<size_t>(i)];
    if (event.kind != EventKind::kSlipStops) continue;
    const double margin = 100.0 * tolerance;
    return std::fabs(event.v) <= margin * speed || impact.tau1 - event.tau <= margin * impact.tau1;
  }
  return std::fabs(impact.u1) <= 100.0 * tolerance * speed;
}

TEST(FiniteDurationTest, WithoutFiniteForcesItIsTheRigidImpactAtAnyStiffness) {
  planar::SceneSource source(20);
  EstimateLog log;
  for (int i = 0; i < 400; ++i) {
    planar::Problem rigid = source.Any();
    rigid.law = RestitutionLaw::kEnergetic;
    rigid.coefficient = source.UnitCoefficient();
    const planar::Impact exact = planar::Solve(rigid);
    const double tolerance = std::pow(10.0, -source.Uniform(4.0, 10.0));
    const double stiffness = std::pow(10.0, source.Uniform(-3.0, 12.0));
    for (const NormalSpring& spring : {NormalSpring(LinearSpring{stiffness}), NormalSpring(HertzSpring{stiffness})}) {
      const std::string what = "scene " + std::to_string(i) + (spring.index() == 1 ? " linear" : " Hertz");
      const Problem problem = ProblemOf(rigid, spring, tolerance);
      const Impact impact = Solve(problem);
      ASSERT_TRUE(impact.Converged()) << what;
      const double error = DistanceOf(problem, impact, exact.u1, exact.v1);
      log.Add(impact, error, what);
      EXPECT_LE(error, tolerance) << what;
      EXPECT_EQ(impact.w_rank, exact.w_rank) << what;
      if (StopsNearAnEnd(exact, SpeedOf(problem), tolerance)) continue;
      EXPECT_EQ(impact.regime, exact.regime) << what;
      // Impulses and works near rank one are large numbers that velocities hardly depend on.
      const double det = rigid.w.tt * rigid.w.nn - rigid.w.tn * rigid.w.tn;
      if (exact.w_rank == 2 && det < 0.01 * rigid.w.tt * rigid.w.nn) continue;
      const double slack = 100.0 * tolerance;
      const double scale = exact.tau1 * (1.0 + rigid.mu_static);
      EXPECT_NEAR(impact.tau_compression, exact.tau_compression, slack * scale) << what;
      EXPECT_NEAR(impact.tau1, exact.tau1, slack * scale) << what;
      EXPECT_NEAR(impact.f1, exact.f1, slack * scale) << what;
      EXPECT_NEAR(impact.f_compression, exact.f_compression, slack * scale) << what;
      const double work = scale * SpeedOf(problem);
      EXPECT_NEAR(impact.work_normal_compression, exact.work_normal_compression, slack * work) << what;
      EXPECT_NEAR(impact.work_normal_restitution, exact.work_normal_restitution, slack * work) << what;
      EXPECT_NEAR(impact.work_tangential_compression, exact.work_tangential_compression, slack * work) << what;
      EXPECT_NEAR(impact.work_tangential_restitution, exact.work_tangential_restitution, slack * work) << what;
      EXPECT_NEAR(impact.energy_change, exact.energy_change, slack * work) << what;
      EXPECT_EQ(impact.energetic, exact.energetic) << what;
    }
  }
  log.Check("rigid along t");
}

TEST(FiniteDurationTest, ALinearContactLastsHalfAPeriodShrunkByEta) {
  for (const double eta : {1.0, 0.6, 0.05, 0.0}) {
    const double k = 3e7;
    const Impact impact = Solve(
        {.contact = {.w = {1.0, 0.0, 0.4}, .u0 = 0.3, .v0 = -2.0, .coefficient = eta}, .spring = LinearSpring{k}});
    const double omega = std::sqrt(k * 0.4);
    EXPECT_EQ(impact.regime, Regime::kFrictionless);
    EXPECT_NEAR(impact.contact.duration_s * omega, std::numbers::pi / 2.0 * (1.0 + eta), 1e-9);
    EXPECT_NEAR(impact.contact.peak_normal_n / (k * 2.0 / omega), 1.0, 1e-9);
    EXPECT_NEAR(impact.contact.indentation_m / (2.0 / omega), 1.0, 1e-9);
    EXPECT_EQ(impact.contact.peak_tangential_n, 0.0);
    EXPECT_NEAR(impact.v1, 2.0 * eta, 1e-9);
  }
}

// Hertz (1882): the whole of an elastic contact lasts 2.9432 d_max/|v0|, d_max^(5/2) = (5/4) v0^2/(k Wnn).
TEST(FiniteDurationTest, AHertzContactLastsAsLongAsHertzSays) {
  const double half = std::sqrt(std::numbers::pi) * std::tgamma(1.4) / std::tgamma(0.9);
  EXPECT_NEAR(2.0 * half, 2.9432, 1e-4);
  for (const double eta : {1.0, 0.5, 0.1}) {
    const double k = 7e9;
    const double wnn = 25.0;
    const Impact impact =
        Solve({.contact = {.w = {0.0, 0.0, wnn}, .v0 = -0.7, .coefficient = eta}, .spring = HertzSpring{k}});
    const double largest = std::pow(1.25 * 0.49 / (k * wnn), 0.4);
    EXPECT_NEAR(impact.contact.indentation_m / largest, 1.0, 1e-9);
    EXPECT_NEAR(impact.contact.peak_normal_n / (k * std::pow(largest, 1.5)), 1.0, 1e-9);
    EXPECT_NEAR(impact.contact.duration_s / ((1.0 + eta) * half * largest / 0.7), 1.0, 1e-9);
  }
}

// w dw/(1 + c w) = -(k Wnn) d^p dd for w = d', so that w/c - ln(1 + c w)/c^2 is the same at first and last touch.
double HuntCrossleyCoefficient(double c, double speed) {
  const auto place = [&](double w) { return w / c - std::log1p(c * w) / (c * c); };
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const bool too_slow = c * middle * speed < 1.0 && place(-middle * speed) < place(speed);
    (too_slow ? low : high) = middle;
  }
  return low;
}

TEST(FiniteDurationTest, HuntCrossleyImpliesTheCoefficientOfItsPhasePlane) {
  for (const double p : {1.0, 1.5, 2.2, 4.0}) {
    for (const double c : {0.01, 0.3, 1.0, 10.0}) {
      const double speed = 1.7;
      const double k = 4e5;
      // Slip goes on, so that v feels one inertia throughout.
      const Problem problem = {.contact = {.w = {3.0, 0.5, 2.0}, .u0 = 20.0, .v0 = -speed, .mu = 0.2, .mu_static = 0.2},
                               .spring = HuntCrossleySpring{k, p, c}};
      const Impact impact = Solve(problem);
      const double coefficient = HuntCrossleyCoefficient(c, speed);
      EXPECT_EQ(impact.regime, Regime::kSliding);
      EXPECT_NEAR(impact.newton, coefficient, 1e-8) << p << " " << c;
      EXPECT_NEAR(impact.poisson, coefficient, 1e-8) << p << " " << c;
      EXPECT_NEAR(impact.energetic, coefficient, 1e-8) << p << " " << c;
      EXPECT_NEAR(impact.energetic_excess, coefficient - 1.0, 1e-8);
      const double slope = 2.0 - 0.2 * 0.5;
      const double room = (speed / c - std::log1p(c * speed) / (c * c)) * (p + 1.0) / (k * slope);
      EXPECT_NEAR(impact.contact.indentation_m / std::pow(room, 1.0 / (p + 1.0)), 1.0, 1e-8);
      EXPECT_LE(std::fabs(Residual(impact)), 1e-8 * WorkScale(impact));
    }
  }
}

// The duration of an impact with k = Wnn = |v0| = 1 and strong damping. With y = 1 - c v the integral above is
// y - ln(y) = 1 + c^2 (D^(p+1) - d^(p+1))/(p+1), D the largest indentation, of which y > 1 is the root in compression
// and y < 1 that in restitution; dt = dd/|v|.
double DurationOfStrongDamping(double c, double p) {
  const double largest = (p + 1.0) * (1.0 / c - std::log1p(c) / (c * c));  // D^(p+1)
  const auto speed_at = [&](double part, bool in_restitution) {            // part = 1 - (d/D)^(p+1)
    const double level = c * c * largest / (p + 1.0) * part;               // y - 1 - ln(y) = level
    if (in_restitution && level > 30.0) return 1.0 / c;
    // x = y - 1 by Newton's method from outside the root, because x - ln(1 + x) is convex.
    double x = in_restitution ? std::expm1(-level - 1.0 + std::exp(-level - 1.0)) : std::sqrt(2.0 * level) + level;
    double step = x;
    for (int i = 0; i < 60 && std::fabs(step) > 1e-13 * std::fabs(x); ++i) {
      step = (x - std::log1p(x) - level) * (1.0 + x) / x;
      x -= step;
    }
    return std::fabs(x) / c;
  };
  double sum = 0.0;
  constexpr int kPieces = 20'000;
  for (int i = 0; i < kPieces; ++i) {  // d = D (1 - s^2), so that nothing is infinite at v = 0.
    const double s = (i + 0.5) / kPieces;
    const double part = -std::expm1((p + 1.0) * std::log1p(-s * s));
    for (const bool in_restitution : {false, true}) sum += 2.0 * s / speed_at(part, in_restitution);
  }
  return std::pow(largest, 1.0 / (p + 1.0)) * sum / kPieces;
}

TEST(FiniteDurationTest, StrongDampingTakesTheTimeOfItsPhasePlane) {
  for (const double p : {1.0, 1.5, 2.2}) {
    for (const double c : {5.0, 20.0, 36.0, 40.0, 100.0, 2000.0}) {
      const double duration = DurationOfStrongDamping(c, p);
      for (const double tolerance : {1e-12, 1e-6, 1e-4}) {
        const Impact impact = Solve({.contact = {.w = {0.0, 0.0, 1.0}, .v0 = -1.0},
                                     .spring = HuntCrossleySpring{1.0, p, c},
                                     .tolerance = tolerance,
                                     .intervals = 16});
        ASSERT_TRUE(impact.Converged()) << p << " " << c;
        EXPECT_NEAR(impact.contact.duration_s / duration, 1.0, std::max(1e-8, 10.0 * c * tolerance))
            << p << " " << c << " " << tolerance;
        EXPECT_NEAR(impact.contact.history.back().indentation_m / impact.contact.indentation_m, 0.0, 1e-12);
        for (const ForceSample& sample : impact.contact.history) EXPECT_GE(sample.normal_n, 0.0);
      }
    }
  }
}

// Strong damping leaves next to nothing of N before a weak pull ends the contact. The references are those of implicit
// integrations of the indentation and 1 - c v (k = Wnn = |v0| = 1).
TEST(FiniteDurationTest, AWeakPullEndsStrongDampingWhenItExceedsTheForce) {
  struct Pulled {
    double p, c, pull, duration;
  };
  for (const auto& [p, c, pull, duration] : {Pulled{1.0, 20.0, 1e-6, 3.2925485}, Pulled{1.0, 100.0, 1e-12, 2.405550},
                                             Pulled{1.0, 100.0, 1e-15, 2.99618}, Pulled{1.5, 1000.0, 1e-16, 1.55062}}) {
    for (const double tolerance : {1e-12, 1e-6, 1e-3}) {
      const Impact impact = Solve({.contact = {.w = {1.0, 0.0, 1.0}, .v0 = -1.0},
                                   .normal_acceleration = pull,
                                   .spring = HuntCrossleySpring{1.0, p, c},
                                   .tolerance = tolerance});
      ASSERT_TRUE(impact.Converged()) << c;
      EXPECT_NEAR(impact.contact.duration_s / duration, 1.0, std::max(2e-6, 0.1 * tolerance)) << c << " " << tolerance;
    }
  }
}

// Forces that press make this contact slide on for ever.
TEST(FiniteDurationTest, WhatSlidesOnForEverIsWedgedAtEveryTolerance) {
  for (const double tolerance : {1e-12, 1e-6, 1e-5, 1e-3}) {
    const Impact impact = Solve({.contact = {.w = {0.04175769164366804, -0.032409646780643515, 0.03871869456021673},
                                             .u0 = 1.73929694899484,
                                             .v0 = -2.3522136857222296,
                                             .mu = 2.284922412399314,
                                             .mu_static = 2.284922412399314},
                                 .tangential_acceleration = 208935.1130068348,
                                 .normal_acceleration = -7918.795489663881,
                                 .spring = HuntCrossleySpring{1533540.0371225511, 1.0, 0.08438831037720504},
                                 .tolerance = tolerance});
    EXPECT_EQ(impact.regime, Regime::kWedged) << tolerance;
    EXPECT_TRUE(std::isfinite(impact.work_tangential_restitution)) << tolerance;
  }
}

TEST(FiniteDurationTest, HuntCrossleyWithoutDampingIsElasticToTheBit) {
  const Impact impact = Solve(Rod(HuntCrossleySpring{1e6, 1.5, 0.0}));
  EXPECT_EQ(impact.energetic, 1.0);
  EXPECT_EQ(impact.energetic_excess, 0.0);
}

TEST(FiniteDurationTest, AHuntCrossleyContactThatIsPulledApartEndsIndented) {
  const Impact impact = Solve({.contact = {.w = {0.0, 0.0, 1.0}, .v0 = -1.0},
                               .normal_acceleration = 2000.0,
                               .spring = HuntCrossleySpring{1e6, 1.0, 3.0},
                               .intervals = 8});
  ASSERT_TRUE(impact.Converged());
  EXPECT_NEAR(impact.v1, 1.0 / 3.0, 1e-9);
  EXPECT_GT(impact.contact.history.back().indentation_m, 0.0);
  EXPECT_NEAR(impact.contact.history.back().normal_n, 0.0, 1e-6 * impact.contact.peak_normal_n);
  EXPECT_LE(std::fabs(Residual(impact)), 1e-8 * WorkScale(impact));
}

// The kinds of events that a row's modes stand for, apart from the end of compression.
std::vector<EventKind> KindsOf(const std::string& modes) {
  std::vector<EventKind> kinds = {EventKind::kStart};
  std::istringstream words(modes);
  std::string last;
  for (std::string word; words >> word;) {
    if (word.size() == 1) continue;
    if (!last.empty() && word != last) {
      kinds.push_back(word == "stick" ? EventKind::kStickStarts : EventKind::kSlipStarts);
    }
    last = word;
  }
  kinds.push_back(EventKind::kRestitutionEnds);
  return kinds;
}

// The impact by the model that follows the same springs without a duration.
auto WithoutDuration(const Problem& problem) {
  return compliant::Solve({.contact = problem.contact, .ratio_squared = *problem.ratio_squared});
}

TEST(FiniteDurationTest, CompliantImpactsAreThoseOfTheTable) {
  const std::vector<VectorRow> rows = ReadVectors("compliant.csv");
  ASSERT_EQ(rows.size(), 60U);
  EstimateLog log;
  for (size_t i = 0; i < rows.size(); ++i) {
    const VectorRow& row = rows[i];
    for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
      const Problem problem = {.contact = {.w = {Number(row, "wtt"), Number(row, "wtn"), Number(row, "wnn")},
                                           .u0 = Number(row, "u0"),
                                           .v0 = Number(row, "v0"),
                                           .mu = Number(row, "mu"),
                                           .mu_static = Number(row, "mu"),
                                           .coefficient = Number(row, "eta")},
                               .spring = LinearSpring{std::pow(10.0, 0.1 * static_cast<double>(i))},
                               .ratio_squared = Number(row, "ratio2"),
                               .tolerance = tolerance};
      const Impact impact = Solve(problem);
      const std::string what = "row " + std::to_string(i) + " at " + std::to_string(tolerance);
      const double error = DistanceOf(problem, impact, Number(row, "u1"), Number(row, "v1"));
      log.Add(impact, error, what);
      EXPECT_LE(error, tolerance) << what;
      const double tau1 = Number(row, "tau1");
      const double slack = 10.0 * tolerance;
      EXPECT_NEAR(impact.tau1 / tau1, 1.0, slack) << what;
      EXPECT_NEAR(impact.tau_compression / tau1, Number(row, "tau_compression") / tau1, slack) << what;
      EXPECT_NEAR(impact.f1 / tau1, Number(row, "friction_impulse") / tau1, slack) << what;
      const double work_t = impact.work_tangential_compression + impact.work_tangential_restitution;
      const double scale = std::max({std::fabs(Number(row, "work_n_compression")),
                                     std::fabs(Number(row, "work_n_restitution")), std::fabs(Number(row, "work_t"))});
      EXPECT_NEAR(impact.work_normal_compression / scale, Number(row, "work_n_compression") / scale, slack) << what;
      EXPECT_NEAR(impact.work_normal_restitution / scale, Number(row, "work_n_restitution") / scale, slack) << what;
      EXPECT_NEAR(work_t / scale, Number(row, "work_t") / scale, slack) << what;
      EXPECT_NEAR((work_t + impact.friction_dissipation + impact.spring_energy) / scale, 0.0, slack) << what;
      EXPECT_NEAR(Residual(impact) / scale, 0.0, slack) << what;
      const auto same = WithoutDuration(problem);
      EXPECT_EQ(impact.regime, same.regime) << what;
      EXPECT_NEAR(impact.work_tangential_compression / scale, same.work_tangential_compression / scale, slack) << what;
      if (tolerance > 1e-10) continue;
      std::vector<EventKind> kinds = KindsOf(impact);
      std::erase(kinds, EventKind::kCompressionEnds);
      EXPECT_EQ(kinds, KindsOf(row.at("modes"))) << what << ": " << row.at("modes");
    }
  }
  log.Check("compliant along t");
}

// W has rank one with the velocity in its range, so that the particle's speed vanishes just where v does: rounding must
// not decide which comes first, or on which branch of the spring the particle goes on.
TEST(FiniteDurationTest, AParticleWhoseSpeedFollowsTheNormalVelocityStopsWhereThatReverses) {
  planar::SceneSource source(41);
  for (int i = 0; i < 300; ++i) {
    planar::Problem rigid = source.RankOne();
    rigid.mu_static = rigid.mu;
    rigid.coefficient = source.Uniform(0.05, 0.95);
    ASSERT_TRUE(rigid.w.UFollowsV(rigid.u0, rigid.v0)) << i;
    Problem problem = ProblemOf(rigid, LinearSpring{1e4}, 1e-9);
    problem.ratio_squared = source.Uniform(0.1, 3.0);
    const Impact impact = Solve(problem);
    const auto same = WithoutDuration(problem);
    EXPECT_EQ(impact.regime, same.regime) << i;
    if (impact.regime == Regime::kWedged) continue;
    EXPECT_LE(DistanceOf(problem, impact, same.u1, same.v1), impact.error_estimate) << i;
    for (const TimedInstant& event : impact.events) {
      EXPECT_TRUE(event.v == 0.0 || std::fabs(event.v) > 1e-9 * std::fabs(rigid.v0)) << i << " at " << event.v;
    }
  }
}

TEST(FiniteDurationTest, AParticleThatTheStifferBranchDrivesOnNeverSticks) {
  const Problem problem = {
      .contact = {.w = {1.0, 1.0, 1.0}, .u0 = -1.0, .v0 = -1.0, .mu = 0.5, .mu_static = 0.5, .coefficient = 0.5},
      .spring = LinearSpring{1e4},
      .ratio_squared = 1.0};
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.regime, Regime::kSliding);
  EXPECT_EQ(WithoutDuration(problem).regime, Regime::kSliding);
  EXPECT_EQ(KindsOf(impact),
            (std::vector{EventKind::kStart, EventKind::kCompressionEnds, EventKind::kRestitutionEnds}));
}

// Friction pushes the body back into the surface: v changes its sign three times.
TEST(FiniteDurationTest, CompressionEndsAtTheLastReversalOfALoadedSpring) {
  const Problem problem = {
      .contact =
          {.w = {3.673, 1.0988, 0.48}, .u0 = -1.516, .v0 = -1.0, .mu = 0.9626, .mu_static = 0.9626, .coefficient = 0.9},
      .spring = LinearSpring{1e4},
      .ratio_squared = 0.8022,
      .tolerance = 1e-9};
  const Impact impact = Solve(problem);
  const auto same = WithoutDuration(problem);
  EXPECT_NEAR(impact.tau_compression, same.tau_compression, 1e-7);
  EXPECT_NEAR(impact.work_normal_compression, same.work_normal_compression, 1e-7);
  EXPECT_NEAR(impact.work_tangential_compression, same.work_tangential_compression, 1e-7);
  EXPECT_NEAR(impact.work_tangential_restitution, same.work_tangential_restitution, 1e-7);
}

TEST(FiniteDurationTest, ACompliantContactThatEndsAtRestBooksItsSpringAsLost) {
  const Impact impact =
      Solve({.contact = {.w = {3.5, 0.0, 1.0}, .u0 = 0.2, .v0 = -1.0, .mu = 0.5, .mu_static = 0.5, .coefficient = 0.0},
             .spring = LinearSpring{1e4},
             .ratio_squared = 1.2});
  // It sticks: a quarter of the normal period, F = -u0 sin(w t)/(ratio^2 w) with w^2 = Wtt/(ratio^2 Wnn).
  const double w = std::sqrt(3.5 / 1.2);
  const double u = 0.2 * std::cos(w * std::numbers::pi / 2.0);
  EXPECT_EQ(impact.regime, Regime::kStickInCompression);
  EXPECT_NEAR(impact.u1, u, 1e-9);
  EXPECT_NEAR(impact.spring_energy, (0.2 * 0.2 - u * u) / (2.0 * 3.5), 1e-9);
  EXPECT_EQ(impact.friction_dissipation, 0.0);
}

TEST(FiniteDurationTest, WhereNothingMovesAlongTFrictionTakesNothing) {
  const Impact impact =
      Solve({.contact = {.w = {0.0, 0.0, 1.0}, .v0 = -1.0, .mu = 0.5, .mu_static = 0.5, .coefficient = 0.8},
             .normal_acceleration = -9.81,
             .spring = LinearSpring{1e4},
             .ratio_squared = 1.2});
  EXPECT_EQ(impact.regime, Regime::kFrictionless);
  EXPECT_EQ(impact.f1, 0.0);
  EXPECT_EQ(impact.friction_dissipation, 0.0);
  EXPECT_EQ(impact.spring_energy, 0.0);
}

// Without slip and coupling the tangential spring is never stretched.
TEST(FiniteDurationTest, WhatHasNoSlipToStartWithNeverSlips) {
  for (const auto& [wtt, wnn, v0, mu, eta, ratio_squared, stiffness] :
       {std::array{3.5, 1.0, -1.0, 0.5, 0.8, 1.2, 1e5}, {4.78, 2.46, -0.2815, 0.03142, 0.7397, 9.4536, 7.8e7}}) {
    for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
      const Impact impact =
          Solve({.contact = {.w = {wtt, 0.0, wnn}, .v0 = v0, .mu = mu, .mu_static = mu, .coefficient = eta},
                 .spring = LinearSpring{stiffness},
                 .ratio_squared = ratio_squared,
                 .tolerance = tolerance});
      EXPECT_EQ(KindsOf(impact),
                (std::vector{EventKind::kStart, EventKind::kCompressionEnds, EventKind::kRestitutionEnds}));
    }
  }
}

TEST(FiniteDurationTest, AParticleThatStopsWhereNothingMovesAlongTSticks) {
  const Problem problem = {
      .contact = {.w = {0.0, 0.0, 1.0}, .u0 = 0.3, .v0 = -1.0, .mu = 0.5, .mu_static = 0.5, .coefficient = 0.5},
      .spring = LinearSpring{1e4},
      .ratio_squared = 1.0};
  EXPECT_EQ(Solve(problem).regime, Regime::kStickInCompression);
  EXPECT_EQ(WithoutDuration(problem).regime, Regime::kStickInCompression);
}

// The integral of a force over a history, by the trapezoidal rule.
double Integral(const std::vector<ForceSample>& history, double ForceSample::*force) {
  double sum = 0.0;
  for (size_t i = 1; i < history.size(); ++i) {
    sum += 0.5 * (history[i].*force + history[i - 1].*force) * (history[i].time_s - history[i - 1].time_s);
  }
  return sum;
}

TEST(FiniteDurationTest, HistoriesIntegrateToTheImpulsesAndKeepTheCone) {
  for (const NormalSpring& spring : {NormalSpring(LinearSpring{1e4}), NormalSpring(HertzSpring{1e4}),
                                     NormalSpring(HuntCrossleySpring{1e6, 2.0, 0.3})}) {
    for (const double mu : {0.3, 0.9}) {
      Problem problem = Rod(spring);
      problem.contact.mu = problem.contact.mu_static = mu;
      problem.tangential_acceleration = 2.0;
      double last = 1.0;
      for (const int64_t intervals : {250, 1000, 4000}) {
        problem.intervals = intervals;
        const Impact impact = Solve(problem);
        const ContactDuration& contact = impact.contact;
        ASSERT_TRUE(impact.Converged());
        ASSERT_EQ(static_cast<int64_t>(contact.history.size()), intervals + 1);
        EXPECT_EQ(contact.history.front().time_s, 0.0);
        EXPECT_EQ(contact.history.back().time_s, contact.duration_s);
        const double normal = Integral(contact.history, &ForceSample::normal_n) - impact.tau1;
        const double tangential = Integral(contact.history, &ForceSample::tangential_n) - impact.f1;
        // The rule is of second order within a piece; each jump of the friction force adds its part of a step.
        const double step = 1.0 / static_cast<double>(intervals);
        EXPECT_LE(std::fabs(normal), 4.0 * step * step * impact.tau1);
        EXPECT_LE(std::fabs(tangential), 4.0 * step * impact.tau1);
        EXPECT_LE(std::fabs(normal), last);
        last = std::fabs(normal);
        double largest = 0.0;
        for (size_t i = 0; i < contact.history.size(); ++i) {
          const ForceSample& sample = contact.history[i];
          EXPECT_NEAR(sample.time_s, static_cast<double>(i) * step * contact.duration_s, 1e-12 * contact.duration_s);
          EXPECT_LE(std::fabs(sample.tangential_n), mu * sample.normal_n + 1e-8 * contact.peak_normal_n);
          EXPECT_LE(sample.indentation_m, contact.indentation_m * (1.0 + 1e-12));
          largest = std::max(largest, sample.normal_n);
        }
        EXPECT_LE(largest, contact.peak_normal_n * (1.0 + 1e-12));
        EXPECT_GE(largest, contact.peak_normal_n * (1.0 - 10.0 * step * step));
        EXPECT_LE(contact.peak_tangential_n, mu * contact.peak_normal_n * (1.0 + 1e-12));
      }
    }
  }
}

TEST(FiniteDurationTest, WhatGravityChangesIsOfFirstOrderInTheDuration) {
  for (const double mu : {0.3, 0.9}) {
    double last_change = 0.0;
    double last_duration = 0.0;
    for (int i = 0; i < 6; ++i) {
      // Half the duration each time, three decades of stiffness.
      Problem problem = Rod(LinearSpring{1e7 * std::pow(4.0, i)});
      problem.contact.mu = problem.contact.mu_static = mu;
      problem.tolerance = 1e-12;
      const Impact impact = Solve(problem);
      problem.normal_acceleration = 0.0;
      const Impact without = Solve(problem);
      const double change = DistanceOf(problem, impact, without.u1, without.v1);
      if (i > 0) {
        EXPECT_NEAR(impact.contact.duration_s / last_duration, 0.5, 0.01);
        EXPECT_NEAR(change / last_change, 0.5, 0.02) << mu << " " << i;
      }
      last_change = change;
      last_duration = impact.contact.duration_s;
    }
    EXPECT_GT(last_change, 0.0);
  }
}

// A second method: Runge and Kutta's classical steps of one size in SI units, halved down onto each event.
class FixedSteps {
 public:
  explicit FixedSteps(const Problem& problem) : p_(problem), k_(std::get<LinearSpring>(problem.spring).stiffness_n_m) {}

  // (u, v) at the end.
  std::pair<double, double> Solve() {
    State y = {0.0, p_.contact.u0, p_.contact.v0};
    Regrip(y);
    if (p_.contact.u0 != 0.0) grip_ = p_.contact.u0 > 0.0 ? 1 : -1;
    const double step = 1e-4 / std::sqrt(k_ * p_.contact.w.nn);
    for (;;) {
      State next = Stepped(y, step);
      if (Fits(next)) {
        y = next;
        continue;
      }
      double low = 0.0;
      double high = step;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (Fits(Stepped(y, middle)) ? low : high) = middle;
      }
      y = Stepped(y, high);
      if (unloading_ && Normal(y) <= 0.0) return {y[1], y[2]};
      if (!unloading_ && y[2] >= 0.0) {
        unloading_ = true;
        largest_ = y[0];
      } else {
        if (grip_ != 0) y[1] = 0.0;
        Regrip(y);
      }
    }
  }

 private:
  using State = std::array<double, 3>;  // d, u, v

  double Normal(const State& y) const {
    const double eta2 = p_.contact.coefficient * p_.contact.coefficient;
    return k_ * (unloading_ ? (y[0] - (1.0 - eta2) * largest_) / eta2 : y[0]);
  }
  double Drive(double normal) const { return p_.contact.w.tn * normal + p_.tangential_acceleration; }
  State Rates(const State& y) const {
    const double normal = Normal(y);
    const double f = grip_ != 0 ? -p_.contact.mu * grip_ * normal : -Drive(normal) / p_.contact.w.tt;
    return {-y[2], p_.contact.w.tt * f + Drive(normal),
            p_.contact.w.tn * f + p_.contact.w.nn * normal + p_.normal_acceleration};
  }
  bool Fits(const State& y) const {
    if (unloading_ ? Normal(y) <= 0.0 : y[2] >= 0.0) return false;
    if (grip_ != 0) return grip_ * y[1] > 0.0 || just_slipped_;
    return std::fabs(Drive(Normal(y))) <= p_.contact.mu_static * p_.contact.w.tt * Normal(y);
  }
  void Regrip(const State& y) {
    const double drive = Drive(Normal(y));
    const bool sticks = grip_ != 0 && std::fabs(drive) <= p_.contact.mu_static * p_.contact.w.tt * Normal(y);
    grip_ = sticks ? 0 : drive > 0.0 ? 1 : -1;
    just_slipped_ = !sticks;
  }
  State Stepped(const State& y, double h) {
    const auto along = [](const State& a, const State& b, double c) {
      return State{a[0] + c * b[0], a[1] + c * b[1], a[2] + c * b[2]};
    };
    const State a = Rates(y);
    const State b = Rates(along(y, a, 0.5 * h));
    const State c = Rates(along(y, b, 0.5 * h));
    const State d = Rates(along(y, c, h));
    State next;
    for (size_t i = 0; i < 3; ++i) next[i] = y[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
    if (grip_ * next[1] > 0.0) just_slipped_ = false;
    return next;
  }

  const Problem& p_;
  double k_;
  int grip_ = 1;
  bool unloading_ = false;
  bool just_slipped_ = false;
  double largest_ = 0.0;
};

TEST(FiniteDurationTest, AgreesWithFixedStepsUnderFiniteForces) {
  for (const double mu : {0.1, 0.3, 0.59, 0.8}) {
    for (const double tangential : {-30.0, 0.0, 10.0}) {
      Problem problem = Rod(LinearSpring{2e4});
      problem.contact.mu = problem.contact.mu_static = mu;
      problem.tangential_acceleration = tangential;
      const Impact impact = Solve(problem);
      const auto [u, v] = FixedSteps(problem).Solve();
      EXPECT_LE(DistanceOf(problem, impact, u, v), 1e-9) << mu << " " << tangential;
    }
  }
}

TEST(FiniteDurationTest, AContactAtRestAlongTSlipsFirstUnderAFiniteForce) {
  Problem problem = Rod(LinearSpring{1e4});
  problem.contact.u0 = 0.0;
  problem.contact.mu = problem.contact.mu_static = 0.9;
  EXPECT_EQ(KindsOf(Solve(problem)),
            (std::vector{EventKind::kStart, EventKind::kCompressionEnds, EventKind::kRestitutionEnds}));
  problem.tangential_acceleration = 1.0;
  const Impact impact = Solve(problem);
  EXPECT_EQ(KindsOf(impact), (std::vector{EventKind::kStart, EventKind::kSlipStops, EventKind::kCompressionEnds,
                                          EventKind::kSlipStarts, EventKind::kRestitutionEnds}));
  EXPECT_EQ(impact.regime, Regime::kStickInCompression);
  // However weak it is.
  problem.tangential_acceleration = -1e-9;
  EXPECT_EQ(Solve(problem).regime, Regime::kStickInCompression);
}

// W = Wnn (g, 1)(g, 1)^T without friction until slip stops, at v = 1e-6 m/s. The contact then sticks, which leaves v
// alone, and unloads at that speed, so long that a step times a cone of friction as steep as doubles allow overflows.
TEST(FiniteDurationTest, ASteepConeIsLeftAfterALongStick) {
  constexpr double kSpeed = 1e-6;
  for (const NormalSpring& spring : {NormalSpring(LinearSpring{1.0}), NormalSpring(HertzSpring{1.0})}) {
    for (const double g : {1e100, 1e140}) {
      for (const double push : {-1e-20, 1e-20}) {
        Problem problem;
        problem.contact = {.w = {g * g, g, 1.0}, .u0 = -(1.0 + kSpeed) * g, .v0 = -1.0, .coefficient = 1.0};
        problem.contact.mu_static = 1e308 / (g * g);
        problem.tangential_acceleration = push * g;
        problem.spring = spring;
        problem.tolerance = 1e-9;
        const Impact impact = Solve(problem);
        EXPECT_EQ(impact.regime, Regime::kStickInRestitution) << g << " " << push;
        EXPECT_NEAR(impact.v1, kSpeed, 1e-12) << g << " " << push;
      }
    }
  }
}

TEST(FiniteDurationTest, ForcesBelowTheRoundingOfSlipDoNotDecideWhatAContactOfRankOneDoes) {
  Problem problem;
  problem.contact = {.w = {4.0, 2.0, 1.0}, .u0 = -2.0, .v0 = -1.0, .mu = 0.1, .mu_static = 0.1, .coefficient = 0.5};
  problem.spring = LinearSpring{1.0};
  const Impact free = Solve(problem);
  for (const double push : {1e-15, -1e-15, 1e-17, -1e-17, 1e-20, -1e-20, 1e-30, -1e-30}) {
    problem.tangential_acceleration = push;
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.regime, free.regime) << push;
    EXPECT_EQ(impact.u1, free.u1) << push;
    EXPECT_EQ(impact.v1, free.v1) << push;
  }
}

// Held against the same model at its tightest tolerance.
TEST(FiniteDurationTest, EstimatesAreNotBelowTheErrorUnderForcesDampingAndSprings) {
  EstimateLog log;
  planar::SceneSource source(77);
  for (int i = 0; i < 240; ++i) {
    planar::Problem rigid = source.Everyday();
    rigid.coefficient = source.Uniform(0.05, 1.0);
    const double stiffness = std::pow(10.0, source.Uniform(2.0, 6.0));
    const int kind = i % 4;
    Problem problem = ProblemOf(rigid, LinearSpring{stiffness}, 1e-12);
    if (kind == 1) problem.spring = HertzSpring{stiffness};
    if (kind == 2) problem.spring = HuntCrossleySpring{stiffness, source.Uniform(1.0, 4.0), source.Uniform(0.0, 1.0)};
    if (kind == 3) {
      problem.ratio_squared = source.Uniform(0.2, 3.0);
      problem.contact.mu_static = problem.contact.mu;
    }
    problem.tangential_acceleration = source.Uniform(-20.0, 20.0);
    problem.normal_acceleration = source.Uniform(-20.0, 20.0);
    const Impact exact = Solve(problem);
    if (!exact.Converged() || exact.error_estimate > 1e-11) continue;
    problem.tolerance = std::pow(10.0, -source.Uniform(3.0, 8.0));
    const Impact impact = Solve(problem);
    const std::string what = "scene " + std::to_string(i);
    ASSERT_TRUE(impact.Converged()) << what;
    log.Add(impact, DistanceOf(problem, impact, exact.u1, exact.v1), what);
    const double slack = 100.0 * problem.tolerance * (WorkScale(impact) + std::fabs(impact.energy_change));
    EXPECT_NEAR(Residual(impact), 0.0, slack) << what;
    const double work_t = impact.work_tangential_compression + impact.work_tangential_restitution;
    EXPECT_NEAR(impact.friction_dissipation + impact.spring_energy, -work_t, slack) << what;
    EXPECT_GE(impact.friction_dissipation, -slack) << what;
  }
  log.Check("forces, damping, springs");
}

TEST(FiniteDurationTest, ToleranceMeansTheSameAtAllSizes) {
  Problem problem = Rod(HertzSpring{1e4});
  const Impact impact = Solve(problem);
  // Mass, velocity and time in other units.
  const double mass = 0x1p60;
  const double speed = 0x1p-40;
  const double time = 0x1p-30;
  for (double* w : {&problem.contact.w.tt, &problem.contact.w.tn, &problem.contact.w.nn}) *w /= mass;
  for (double* u : {&problem.contact.u0, &problem.contact.v0}) *u *= speed;
  problem.normal_acceleration *= speed / time;
  problem.spring = HertzSpring{1e4 * mass / (time * std::sqrt(speed * time) * time)};
  const Impact scaled = Solve(problem);
  EXPECT_NEAR(scaled.u1 / speed, impact.u1, 1e-10);
  EXPECT_NEAR(scaled.v1 / speed, impact.v1, 1e-10);
  EXPECT_NEAR(scaled.contact.duration_s / time / impact.contact.duration_s, 1.0, 1e-9);
  EXPECT_NEAR(scaled.contact.peak_normal_n * time / (mass * speed) / impact.contact.peak_normal_n, 1.0, 1e-9);
}

TEST(FiniteDurationTest, WhatDoesNotPartEndsByItsBudget) {
  for (const NormalSpring& spring :
       {NormalSpring(LinearSpring{1e3}), NormalSpring(HuntCrossleySpring{1e3, 1.5, 1.0})}) {
    Problem problem = Rod(spring);
    problem.normal_acceleration = -1e4;
    problem.intervals = 4;
    const Impact impact = Solve(problem);
    EXPECT_FALSE(impact.Converged());
    EXPECT_EQ(impact.regime, Regime::kWedged);
    EXPECT_EQ(impact.error_estimate, std::numeric_limits<double>::infinity());
    // The budget holds for the impact, for two repetitions and for its history.
    EXPECT_LE(impact.steps, 4 * 50'000);
    EXPECT_TRUE(std::isfinite(impact.u1) && std::isfinite(impact.v1) && std::isfinite(impact.contact.duration_s));
    EXPECT_EQ(impact.contact.history.size(), 5U);
  }
}

// The force takes over the whole stroke what it gave, and the spring returns eta^2 of what it stored, over eta^2 of the
// way: v1 = -eta v0, which is a small rest of large energies.
TEST(FiniteDurationTest, ACoarseToleranceFindsTheEndOfAContactThatIsPressedHard) {
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const Problem problem = {.contact = {.w = {1.2, 0.0, 1.1}, .v0 = -0.0045, .coefficient = 0.5},
                             .normal_acceleration = -143.0,
                             .spring = LinearSpring{25.0},
                             .tolerance = tolerance};
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.termination, Termination::kConverged) << tolerance;
    EXPECT_LE(std::fabs(impact.v1 / 0.0045 - 0.5), impact.error_estimate) << tolerance;
    EXPECT_LE(impact.error_estimate, 1e-2) << tolerance;
  }
}

// The force does some 1e14 times the work of the approach, so that the path may miss its end and bounce once more: then
// no error is claimed.
TEST(FiniteDurationTest, APathThatMayHaveMissedItsEndClaimsNoError) {
  for (const double v0 : {-1e-5, -1e-8, -1e-50}) {
    const Impact impact = Solve({.contact = {.w = {1.0, 0.0, 1.0}, .v0 = v0, .coefficient = 1.0},
                                 .normal_acceleration = -9.81,
                                 .spring = HertzSpring{1e6}});
    EXPECT_TRUE(std::isfinite(impact.poisson)) << v0;
    EXPECT_LE(std::fabs(impact.newton - 1.0), impact.error_estimate) << v0;
  }
}

TEST(FiniteDurationTest, ATighterToleranceLosesNoAnswer) {
  // Sticks and slips so often that the finest integration uses up its budget.
  Problem problem = {
      .contact = {.w = {17.63, 2.16, 0.2752}, .u0 = 0.05912, .v0 = -1.0, .mu = 1.506, .mu_static = 1.506},
      .normal_acceleration = 0.1258,
      .spring = LinearSpring{1e4},
      .ratio_squared = 0.001562,
      .tolerance = 1e-4};
  problem.contact.coefficient = 1.0;
  const Impact loose = Solve(problem);
  problem.tolerance = 1e-12;
  const Impact tight = Solve(problem);
  ASSERT_EQ(loose.termination, Termination::kConverged);
  EXPECT_NE(tight.regime, Regime::kWedged);
  EXPECT_LE(std::fabs(tight.v1 - loose.v1), loose.error_estimate + tight.error_estimate);
  EXPECT_LE(tight.error_estimate, 1e-3);
}

TEST(FiniteDurationTest, WhatIsPulledApartBeforeItsSpringIsFeltFollowsThePull) {
  // v = v0 + a t down to d_max = v0^2/(2 a), then to (1 - eta^2) d_max, where the curve of unloading ends.
  constexpr double kPull = 0.2;
  constexpr double kAlong = 2.0;
  constexpr double kEta = 0.45;
  for (const double k : {1e-20, 1e-100, 1e-250}) {
    for (const NormalSpring& spring : {NormalSpring(LinearSpring{k}), NormalSpring(HertzSpring{k})}) {
      const Impact impact = Solve(
          {.contact = {.w = {2.5, 1.5, 1.2}, .u0 = 1.5, .v0 = -1.0, .mu = 0.3, .mu_static = 0.3, .coefficient = kEta},
           .tangential_acceleration = kAlong,
           .normal_acceleration = kPull,
           .spring = spring,
           .intervals = 4});
      EXPECT_TRUE(impact.Converged());
      EXPECT_LE(impact.error_estimate, 1e-10);
      const double duration = (1.0 + kEta) / kPull;
      EXPECT_NEAR(impact.contact.duration_s, duration, 1e-10 * duration) << k;
      EXPECT_NEAR(impact.u1, 1.5 + kAlong * duration, 1e-10 * impact.u1) << k;
      EXPECT_NEAR(impact.v1, kEta, 1e-10) << k;
      EXPECT_NEAR(impact.poisson, kEta, 1e-9) << k;
      EXPECT_NEAR(impact.f1, -0.3 * impact.tau1, 1e-9 * impact.tau1) << k;
      if (!std::holds_alternative<LinearSpring>(spring)) continue;
      // The integral of k (t - a t^2/2).
      const double compression = k / (3.0 * kPull * kPull);
      EXPECT_NEAR(impact.tau_compression, compression, 1e-9 * compression) << k;
    }
  }
}

// The pull a alone turns the contact, at d = v0^2/(2 a), and the curve of unloading ends at 1 - eta^2 of that: v1 = eta
// |v0| after (1 + eta) |v0|/a.
TEST(FiniteDurationTest, APullNearTheLargestDoubleReversesTheContactInNoTime) {
  Problem problem = Rod(HertzSpring{1.0});
  problem.normal_acceleration = 1e300;
  problem.intervals = 4;
  const Impact impact = Solve(problem);
  const double eta = problem.contact.coefficient;
  ASSERT_TRUE(impact.Converged());
  EXPECT_NEAR(impact.v1 / (eta * -problem.contact.v0), 1.0, 1e-10);
  EXPECT_NEAR(impact.contact.duration_s / ((1.0 + eta) * -problem.contact.v0 / 1e300), 1.0, 1e-10);
  EXPECT_EQ(impact.contact.history.size(), 5U);
}

// u falls by 10^9 m/s within 10^-13 of the time that the impact has lasted.
TEST(FiniteDurationTest, ImpulsesMakeTheChangeOfASlipThatStopsAllOfASudden) {
  const Problem problem = {
      .contact = {.w = {1.685, -0.6, 1.186}, .u0 = -0x1p30, .v0 = -2.0, .mu = 2.5, .mu_static = 2.5},
      .spring = HuntCrossleySpring{1e6, 1.5, 0.2}};
  const Impact impact = Solve(problem);
  const double u1 = problem.contact.u0 + problem.contact.w.tt * impact.f1 + problem.contact.w.tn * impact.tau1;
  EXPECT_NEAR(impact.u1, u1, impact.error_estimate * std::fabs(problem.contact.u0));
  EXPECT_LE(impact.error_estimate, 1e-8);
}

// A pendulum that static friction holds, with the accelerations that a moment about its pin gives the contact. The
// normal one is below the smallest double.
Problem NearlyVertical(double a, double mu, double mu_static) {
  constexpr double kInertia = 1.3;
  constexpr double kB = 1.0 / 3.0;
  constexpr double kMoment = -4.889078302384e-311;
  return {.contact = {.w = {kB * kB / kInertia, a * kB / kInertia, a * a / kInertia},
                      .u0 = -2.0 * kB,
                      .v0 = -2.0 * a,
                      .mu = mu,
                      .mu_static = mu_static,
                      .coefficient = 1.0},
          .tangential_acceleration = kMoment * kB / kInertia,
          .normal_acceleration = kMoment * a / kInertia,
          .spring = HertzSpring{0.45385987235336556},
          .tolerance = 1e-12};
}

TEST(FiniteDurationTest, APendulumIsLockedThoughItsNormalAccelerationUnderflows) {
  for (const double a : {1e-20, 1.3e-86, 5.8e-102, 1e-150}) {
    const Problem problem = NearlyVertical(a, 0.0, 0.9);
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.regime, Regime::kLocked) << a;
    EXPECT_TRUE(impact.Converged()) << a;
    EXPECT_EQ(impact.u1, 0.0) << a;
    EXPECT_EQ(impact.v1, 0.0) << a;
  }
}

TEST(FiniteDurationTest, APendulumReboundsThoughItsNormalAccelerationUnderflows) {
  const Problem problem = NearlyVertical(5.8e-102, 0.0, 1e-200);
  const Impact impact = Solve(problem);
  EXPECT_NEAR(impact.u1 / -problem.contact.u0, 1.0, 1e-11);
  EXPECT_NEAR(impact.v1 / -problem.contact.v0, 1.0, 1e-11);
}

// v0 is 10^-86 of u0, and what becomes of it as small a part again.
TEST(FiniteDurationTest, APendulumThatIsNearlyLockedReboundsAsARigidOne) {
  for (const double beyond : {0x1p-30, 0x1p-20, 0x1p-10, 0.5}) {
    Problem problem = NearlyVertical(1.3e-86, 0.0124, 0.945);
    problem.contact.u0 *= 1.0 + beyond;
    planar::Problem rigid;
    static_cast<PlanarProblem&>(rigid) = problem.contact;
    const planar::Impact exact = planar::Solve(rigid);
    const Impact impact = Solve(problem);
    EXPECT_TRUE(impact.Converged()) << beyond;
    EXPECT_EQ(impact.regime, exact.regime) << beyond;
    EXPECT_NEAR(impact.v1 / exact.v1, 1.0, 1e-13 / beyond) << beyond;
    EXPECT_NEAR(impact.tau1 / exact.tau1, 1.0, 1e-13 / beyond) << beyond;
  }
}

TEST(FiniteDurationTest, WhatIsPressedToRestOnItsSpringDoesNotPart) {
  Problem problem = Rod(HuntCrossleySpring{3.0, 1.5, 0.2});
  problem.contact.mu = 4.0 / 3.0;
  problem.contact.mu_static = 3.0;
  problem.tangential_acceleration = 2.0;
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.termination, Termination::kRefused);
  EXPECT_EQ(impact.regime, Regime::kWedged);
}

// A spring that starts unloaded and at rest under a weight alone swings back to where it began, without a velocity with
// which to part: an error of any size decides whether it parts there or swings again.
TEST(FiniteDurationTest, AReleaseAtNoMoreThanTheErrorHasNoKnownError) {
  constexpr double kInertia = 1.0 / 12.0, kRight = 0.35355339059327379, kUp = 0.51969585681769959;
  Problem problem = {.contact = {.w = {.tt = 1.0 + kUp * kUp / kInertia,
                                       .tn = -kRight * kUp / kInertia,
                                       .nn = 1.0 + kRight * kRight / kInertia},
                                 .u0 = 1.5,
                                 .v0 = -7.7986562883470477e-133,
                                 .mu = 0.3,
                                 .mu_static = 0.3,
                                 .law = RestitutionLaw::kEnergetic,
                                 .coefficient = 0.8},
                     .normal_acceleration = -9.81,
                     .spring = LinearSpring{1e6},
                     .tolerance = 1e-3};
  const Impact grazing = Solve(problem);
  EXPECT_EQ(grazing.error_estimate, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(std::isfinite(grazing.errors.v));
  problem.contact.v0 = -0.1;
  EXPECT_LE(Solve(problem).error_estimate, problem.tolerance);
}

TEST(FiniteDurationTest, APendulumThatSticksIsLockedWhateverPressesIt) {
  Problem problem = {
      .contact = {.w = {4.0, 2.0, 1.0}, .u0 = -2.0, .v0 = -1.0, .mu = 0.6, .mu_static = 0.6, .coefficient = 0.8},
      .spring = LinearSpring{1e5}};
  for (const double normal : {0.0, -20.0, 20.0}) {
    problem.normal_acceleration = normal;
    problem.tangential_acceleration = 2.0 * normal;
    const Impact impact = Solve(problem);
    EXPECT_TRUE(impact.Converged());
    EXPECT_EQ(impact.regime, Regime::kLocked);
    EXPECT_EQ(impact.w_rank, 1);
    EXPECT_EQ(impact.u1, 0.0);
    EXPECT_EQ(impact.v1, 0.0);
    EXPECT_EQ(impact.poisson, 0.0);
    EXPECT_EQ(KindsOf(impact), (std::vector{EventKind::kStart, EventKind::kSlipStops, EventKind::kCompressionEnds}));
  }
}

TEST(FiniteDurationTest, AContactThatDoesNotApproachIsLeftAlone) {
  Problem problem = Rod(LinearSpring{1e5});
  for (const double v0 : {0.0, 2.0}) {
    problem.contact.v0 = v0;
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.regime, Regime::kSeparating);
    EXPECT_EQ(impact.u1, problem.contact.u0);
    EXPECT_EQ(impact.v1, v0);
    EXPECT_EQ(impact.steps, 0);
    EXPECT_TRUE(impact.events.empty());
  }
}

TEST(FiniteDurationTest, AStoppedImpactSaysSoAndNothingElse) {
  const Impact impact = Solve(Rod(HertzSpring{1e6}), [] { return true; });
  EXPECT_TRUE(impact.stopped);
  EXPECT_FALSE(impact.Converged());
  EXPECT_EQ(impact.regime, Regime::kUnspecified);
  EXPECT_FALSE(Solve(Rod(HertzSpring{1e6}), [] { return false; }).stopped);
}

// Counts how often an impact asks, and stops it at the question of that number.
struct Questions {
  explicit Questions(int64_t at) : stop_at(at) {}
  bool operator()() const { return ++asked >= stop_at; }

  mutable int64_t asked = 0;
  int64_t stop_at;
};

TEST(FiniteDurationTest, AnImpactThatNeverPartsAsksEvery64StepsAndEndsOnceItIsStopped) {
  Problem problem = Rod(LinearSpring{1e3});
  problem.normal_acceleration = -1e4;
  Questions all(std::numeric_limits<int64_t>::max());
  const Impact whole = Solve(problem, all);
  ASSERT_FALSE(whole.Converged());
  EXPECT_FALSE(whole.stopped);
  EXPECT_GE(64 * all.asked, whole.steps);
  ASSERT_GT(all.asked, 3);
  Questions some(3);
  EXPECT_TRUE(Solve(problem, some).stopped);
  EXPECT_EQ(some.asked, 3) << "nothing is asked after the answer";
}

TEST(FiniteDurationTest, AHistoryAsksAsOftenPerSampleAndIsStopped) {
  Problem problem = Rod(LinearSpring{1e5});
  Questions without(std::numeric_limits<int64_t>::max());
  EXPECT_FALSE(Solve(problem, without).stopped);
  problem.intervals = 10'000;
  Questions with(std::numeric_limits<int64_t>::max());
  EXPECT_EQ(Solve(problem, with).contact.history.size(), 10'001U);
  EXPECT_GE(64 * (with.asked - without.asked), 10'000);
  Questions late(without.asked + 50);
  const Impact impact = Solve(problem, late);
  EXPECT_TRUE(impact.stopped);
  EXPECT_TRUE(impact.contact.history.empty());
}

TEST(FiniteDurationTest, TheSameProblemHasTheSameBits) {
  Problem problem = Rod(HertzSpring{1e6});
  problem.intervals = 50;
  const Impact first = Solve(problem);
  const Impact second = Solve(problem);
  EXPECT_EQ(first.u1, second.u1);
  EXPECT_EQ(first.v1, second.v1);
  EXPECT_EQ(first.contact, second.contact);
  EXPECT_EQ(first.events, second.events);
}

// A small tangential force moves a contact that sticks by little more than the steps of a coarse integration err.
TEST(FiniteDurationTest, ACoarseToleranceFindsTheEndThatAFineOneFinds) {
  for (const double force : {1e-8, 1e-6, 1e-3, 0.1}) {
    for (const double coefficient : {1e-3, 0.01, 0.1, 0.5}) {
      Problem problem = {.contact = {.w = {1.1, 0.13, 0.228},
                                     .u0 = -0.155,
                                     .v0 = -1.445,
                                     .mu = 0.12,
                                     .mu_static = 0.12,
                                     .coefficient = coefficient},
                         .tangential_acceleration = force,
                         .normal_acceleration = -9.81,
                         .spring = HertzSpring{8e6},
                         .tolerance = 1e-12};
      const Impact fine = Solve(problem);
      ASSERT_TRUE(fine.Converged()) << force << " " << coefficient;
      for (const double tolerance : {0.1, 1e-3, 1e-5, 1e-6, 1e-7, 1e-9}) {
        problem.tolerance = tolerance;
        const Impact coarse = Solve(problem);
        EXPECT_TRUE(HasEnd(coarse.regime)) << force << " " << coefficient << " " << tolerance;
        EXPECT_LE(DistanceOf(problem, coarse, fine.u1, fine.v1), tolerance) << force << " " << coefficient;
      }
    }
  }
}

// Without friction a constant force does as much work in loading as in unloading, so that v1 = -e v0. The force presses
// so much that it leaves the contact 2 mm/s.
TEST(FiniteDurationTest, AForceThatPressesLeavesTheContactItsEndAtEveryTolerance) {
  Problem problem = {.contact = {.w = {17.942066668715817, -10.512433703951348, 8.425280048168668},
                                 .v0 = -0.7000289965127942,
                                 .coefficient = 0.0018969255438064936},
                     .tangential_acceleration = -13995.545903320006,
                     .normal_acceleration = -22778375.478743423,
                     .spring = LinearSpring{4035516.388946524}};
  for (const double tolerance : {0.1, 1e-4, 1e-7, 1e-8, 5e-9, 2e-9, 1e-9, 1e-11}) {
    problem.tolerance = tolerance;
    const Impact impact = Solve(problem);
    ASSERT_TRUE(HasEnd(impact.regime)) << tolerance;
    const double v1 = -problem.contact.coefficient * problem.contact.v0;
    EXPECT_LE(DistanceOf(problem, impact, impact.u1, v1), impact.error_estimate) << tolerance;
    EXPECT_LE(impact.error_estimate, std::max(tolerance, 2e-6)) << tolerance;
  }
}

// At the start of slip u and its rate are 0, and rounding gives the rate a sign.
TEST(FiniteDurationTest, SlipThatStartsDoesNotStopByRounding) {
  for (int i = 0; i <= 40; ++i) {
    const double u0 = -0.12 + 0.001 * i;
    const Problem problem = {
        .contact = {.w = {1.0, 0.2, 1.0}, .u0 = u0, .v0 = -1.0, .mu = 0.3, .mu_static = 0.3, .coefficient = 0.5},
        .tangential_acceleration = 0.1,
        .spring = LinearSpring{1000.0}};
    EXPECT_EQ(KindsOf(Solve(problem)),
              (std::vector{EventKind::kStart, EventKind::kSlipStops, EventKind::kCompressionEnds,
                           EventKind::kSlipStarts, EventKind::kRestitutionEnds}))
        << u0;
  }
}

// A contact that is pressed for ever comes to a balance, where rounding alone changes the signs of what is watched.
TEST(FiniteDurationTest, ABalanceOfForcesTakesNoMoreThanItsBudget) {
  const Problem problem = {.contact = {.w = {82.83418009915971, 39.66673836049119, 21.530682572639247},
                                       .u0 = -16.81854298167104,
                                       .v0 = -9.255635814832072,
                                       .mu = 0.36604595526585937,
                                       .mu_static = 0.45904109595162557},
                           .tangential_acceleration = 3870.5457315885246,
                           .normal_acceleration = -5977.467143311956,
                           .spring = HuntCrossleySpring{5400960.6441198625, 2.0, 0.6504420909121865},
                           .tolerance = 1e-9};
  const Impact impact = Solve(problem);
  EXPECT_FALSE(HasEnd(impact.regime));
  EXPECT_LE(impact.right_hand_sides, 1'600'000);
}

// v1 is the root of the phase plane, whatever the exponent (HuntCrossleyCoefficient).
TEST(FiniteDurationTest, PowersThatAreNoPolynomialsAreAsExact) {
  for (const double p : {1.1, 1.7, 2.2, 3.3, 3.9}) {
    const Impact impact = Solve(
        {.contact = {.w = {1.0, 0.0, 1.0}, .v0 = -1.0}, .spring = HuntCrossleySpring{1e5, p, 0.3}, .tolerance = 1e-12});
    EXPECT_TRUE(impact.Converged()) << p;
    EXPECT_LE(impact.error_estimate, 1e-12) << p;
    EXPECT_NEAR(impact.v1, HuntCrossleyCoefficient(0.3, 1.0), impact.error_estimate) << p;
  }
}

// A contact that is pulled apart while it slides 700 times as fast as it approaches, held against the tightest
// tolerance.
TEST(FiniteDurationTest, AFastSlipUnderAPullErrsByNoMoreThanIsClaimed) {
  Problem problem = {.contact = {.w = {9.933937347352531, -3.5360026501075654, 2.638656063760685},
                                 .u0 = -114.05077220145566,
                                 .v0 = -0.16385470615189887,
                                 .mu = 0.9231544532345825,
                                 .mu_static = 0.9231544532345825,
                                 .coefficient = 0.42833685851712117},
                     .normal_acceleration = 17.210825829941307,
                     .spring = LinearSpring{17623.60174089703},
                     .tolerance = 1e-12};
  const Impact fine = Solve(problem);
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-10}) {
    problem.tolerance = tolerance;
    const Impact impact = Solve(problem);
    EXPECT_LE(DistanceOf(problem, impact, fine.u1, fine.v1), impact.error_estimate) << tolerance;
  }
}

// After the slip has reversed, the amplitude of N about its equilibrium is 2.5e-6 of itself below that (by the closed
// form of the linear spring, in arbitrary precision): the contact never parts.
TEST(FiniteDurationTest, AContactThatNeverPartsHasNoEndAtAnyTolerance) {
  Problem problem = {.contact = {.w = {0.1796264632483553, 0.22279678784371723, 0.3452982737719966},
                                 .u0 = -0.06182082655768088,
                                 .v0 = -0.7202595587208074,
                                 .mu = 0.800440440731278,
                                 .mu_static = 0.800440440731278,
                                 .coefficient = 0.5502389220698087},
                     .tangential_acceleration = 0.0,
                     .normal_acceleration = -49905.415201072865,
                     .spring = LinearSpring{17534.500343810516}};
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-7, 1e-9}) {
    problem.tolerance = tolerance;
    EXPECT_FALSE(HasEnd(Solve(problem).regime)) << tolerance;
  }
}

}  // namespace
}  // namespace ricochet::finite_duration
