// Enclosures: they contain every scene of their box, they are tight, they keep to their budget.

#include "core/bounds/enclosure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "core/bounds/contact_bounds.h"
#include "core/bounds/pendulum_bounds.h"
#include "tests/support/scenes/pendulum_scenes.h"
#include "tests/support/scenes/planar_scenes.h"

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr EnclosureOptions kDefault;

using Numbers = std::vector<double>;
using Box = std::vector<Interval>;

// wtt, wtn, wnn, u0, v0, mu and, if there is one, mu_s.
PlanarBox ToPlanarBox(const Box& x) {
  PlanarBox box = {.wtt = x[0], .wtn = x[1], .wnn = x[2], .u0 = x[3], .v0 = x[4], .mu = x[5]};
  if (x.size() > 6) box.mu_static = x[6];
  return box;
}

bool Never() { return false; }

// Encloses the contacts whose own numbers lie in the box.
Enclosure EnclosePlanar(const PlanarBox& box, const EnclosureOptions& options) {
  Box ranges = {box.wtt, box.wtn, box.wnn, box.u0, box.v0, box.mu};
  if (box.mu_static) {
    ranges[5] = AtMost(box.mu, box.mu_static->upper);
    ranges.push_back(AtLeast(*box.mu_static, box.mu.lower));
  }
  SlopeParameters parameters;
  const auto to_form = [&](absl::Span<const Interval> x) -> std::variant<AffinePlanarBox, PendulumBox> {
    parameters = SlopeParameters();
    const auto at = [&](size_t i) { return AffineInterval::Parameter(x[i], parameters); };
    AffinePlanarBox form = {.wtt = at(0), .wtn = at(1), .wnn = at(2), .u0 = at(3), .v0 = at(4), .mu = at(5)};
    if (x.size() > 6) form.mu_static = at(6);
    return form;
  };
  return Enclose(ranges, to_form, options, Never);
}

planar::Problem ToPlanarProblem(const Numbers& x) {
  return {.w = {x[0], x[1], x[2]}, .u0 = x[3], .v0 = x[4], .mu = x[5], .mu_static = x.size() > 6 ? x[6] : x[5]};
}

// inertia, a, b, omega_minus, mu and, if there is one, mu_s.
PendulumBox ToPendulumBox(const Box& x) {
  PendulumBox box = {.inertia = x[0], .a = x[1], .b = x[2], .omega_minus = x[3], .mu = x[4]};
  if (x.size() > 5) box.mu_static = x[5];
  return box;
}

pendulum::Problem ToPendulumProblem(const Numbers& x) {
  return {
      .inertia = x[0], .a = x[1], .b = x[2], .omega_minus = x[3], .mu = x[4], .mu_static = x.size() > 5 ? x[5] : x[4]};
}

// The bounds of the elastic and the plastic impact, which core/bounds/contact_bounds.h shows to be all that is needed.
CoefficientBounds PlanarBounds(const Numbers& x) {
  planar::Problem problem = ToPlanarProblem(x);
  problem.coefficient = 0.0;
  const planar::Impact plastic = planar::Solve(problem);
  problem.coefficient = 1.0;
  const planar::Impact elastic = planar::Solve(problem);
  return {.newton = {0.0, elastic.newton},
          .poisson = {0.0, elastic.poisson},
          .energetic = {0.0, elastic.energetic},
          .tangential = {std::min(plastic.tangential, elastic.tangential),
                         std::max(plastic.tangential, elastic.tangential)},
          .normal_total_n_s = {plastic.tau1, elastic.tau1}};
}

CoefficientBounds PendulumBounds(const Numbers& x) { return pendulum::SolveBounds(ToPendulumProblem(x)).sharp; }

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  size_t Below(size_t bound) { return engine_() % bound; }

  double In(const Interval& range) { return IsPoint(range) ? range.lower : Uniform(range.lower, range.upper); }
  // Inside, and one in four times at an end of each range.
  Numbers In(const Box& box) {
    const bool corner = Below(4) == 0;
    Numbers point;
    for (const Interval& range : box) {
      point.push_back(corner ? (Below(2) == 0 ? range.lower : range.upper) : In(range));
    }
    return point;
  }

 private:
  std::mt19937_64 engine_;
};

Interval Around(double value, double relative) {
  const double reach = std::fabs(value) * relative;
  return {value - reach, value + reach};
}

Box PointBox(const Numbers& x) { return {x.begin(), x.end()}; }

// `count` of the numbers of `x`, drawn at random, become ranges.
Box RandomBox(const Numbers& x, int count, double relative, Random& random) {
  Box box = PointBox(x);
  for (int k = 0; k < count; ++k) {
    const size_t i = random.Below(x.size());
    box[i] = Around(x[i], relative);
  }
  return box;
}

std::string ToString(const Box& box) {
  std::ostringstream text;
  text.precision(17);
  for (const Interval& range : box) text << '[' << range.lower << ", " << range.upper << "] ";
  return text.str();
}

std::string ToString(const Numbers& point) { return ToString(PointBox(point)); }

// Allows for the rounding of the point's own bounds.
bool Contains(const Range& outer, const Range& inner, double slack = 1e-15) {
  const auto reach = [&](double end) { return std::isinf(end) ? 0.0 : slack * std::fabs(end); };
  return inner.lower >= outer.lower - reach(outer.lower) && inner.upper <= outer.upper + reach(outer.upper);
}

bool Contains(const CoefficientBounds& outer, const CoefficientBounds& inner, double slack = 1e-15) {
  return Contains(outer.newton, inner.newton, slack) && Contains(outer.poisson, inner.poisson, slack) &&
         Contains(outer.energetic, inner.energetic, slack) && Contains(outer.tangential, inner.tangential, slack) &&
         Contains(outer.normal_total_n_s, inner.normal_total_n_s, slack);
}

Range Join(const Range& x, const Range& y) { return {std::min(x.lower, y.lower), std::max(x.upper, y.upper)}; }

void Join(CoefficientBounds& x, const CoefficientBounds& y) {
  x.newton = Join(x.newton, y.newton);
  x.poisson = Join(x.poisson, y.poisson);
  x.energetic = Join(x.energetic, y.energetic);
  x.tangential = Join(x.tangential, y.tangential);
  x.normal_total_n_s = Join(x.normal_total_n_s, y.normal_total_n_s);
}

double Wider(const Range& outer, const Range& inner) {
  return (outer.upper - outer.lower) / (inner.upper - inner.lower) - 1.0;
}

double Wider(const CoefficientBounds& outer, const CoefficientBounds& inner) {
  return std::max({Wider(outer.newton, inner.newton), Wider(outer.poisson, inner.poisson),
                   Wider(outer.tangential, inner.tangential), Wider(outer.normal_total_n_s, inner.normal_total_n_s)});
}

template <typename BoundsOf>
CoefficientBounds Sampled(const Box& box, int samples, uint64_t seed, BoundsOf bounds_of) {
  Random random(seed);
  const auto inside = [&] {
    Numbers point;
    for (const Interval& range : box) point.push_back(random.In(range));
    return point;
  };
  CoefficientBounds seen = bounds_of(inside());
  for (int i = 1; i < samples; ++i) Join(seen, bounds_of(inside()));
  return seen;
}

Numbers EverydayContact(Random& random) {
  const double t = random.Uniform(0.5, 2.0);
  const double n = random.Uniform(0.5, 2.0);
  return {t * t,
          t * n * random.Uniform(-0.9, 0.9),
          n * n,
          random.Uniform(-2.0, 2.0),
          -random.Uniform(0.1, 2.0),
          random.Uniform(0.0, 1.5)};
}

bool IsValid(const Numbers& x) {
  return x[0] * x[2] - x[1] * x[1] > 1e-9 * x[0] * x[2] && (x.size() < 7 || x[6] >= x[5]);
}

// ---- Containment ----

void ExpectPlanarContainment(const Box& box, int samples, Random& random, const EnclosureOptions& options = kDefault) {
  const Enclosure enclosure = EnclosePlanar(ToPlanarBox(box), options);
  ASSERT_LE(enclosure.boxes, options.budget);
  if (!IsEmpty({enclosure.attained.newton.lower, enclosure.attained.newton.upper})) {
    ASSERT_TRUE(Contains(enclosure.outer, enclosure.attained, 0.0)) << ToString(box);
  }
  for (int i = 0; i < samples; ++i) {
    const Numbers point = random.In(box);
    if (!IsValid(point) || point[4] >= 0.0) continue;
    ASSERT_TRUE(Contains(enclosure.outer, PlanarBounds(point))) << ToString(box) << "\nat " << ToString(point);
  }
}

TEST(EnclosureTest, ContainsEveryPlanarSceneOfRandomBoxes) {
  Random random(1);
  for (int i = 0; i < 1'500; ++i) {
    const double reach = random.Below(2) == 0 ? 0.1 : std::exp2(-random.Uniform(0.0, 30.0));
    const Box box = RandomBox(EverydayContact(random), 1 + static_cast<int>(random.Below(4)), reach, random);
    ExpectPlanarContainment(box, 200, random, {.budget = 2'000});
    ASSERT_FALSE(::testing::Test::HasFatalFailure());
  }
}

// All parameters have ranges at once, and a budget cannot do much about such a box.
TEST(EnclosureTest, ContainsEveryPlanarSceneOfWideBoxes) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    Box box;
    for (const double x : EverydayContact(random)) box.push_back(Around(x, random.Uniform(0.0, 1.5)));
    box[0] = AtLeast(box[0], 0.0);
    box[2] = AtLeast(box[2], 0.01);
    box[5] = AtLeast(box[5], 0.0);
    ExpectPlanarContainment(box, 1'000, random, {.budget = 500});
    ASSERT_FALSE(::testing::Test::HasFatalFailure());
  }
}

TEST(EnclosureTest, ContainsScenesOnBothSidesOfEveryThreshold) {
  planar::SceneSource source(3);
  Random random(3);
  int boxes = 0;
  while (boxes < 1'000) {
    const planar::Problem p = source.Any();
    const Numbers centre = {p.w.tt, p.w.tn, p.w.nn, p.u0, p.v0, p.mu};
    if (!IsValid(centre)) continue;
    ++boxes;
    const double reach = std::exp2(-random.Uniform(2.0, 50.0));
    ExpectPlanarContainment(RandomBox(centre, 3, reach, random), 200, random, {.budget = 500});
    ASSERT_FALSE(::testing::Test::HasFatalFailure());
  }
}

TEST(EnclosureTest, ContainsScenesWithStaticFrictionOfItsOwn) {
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    Numbers centre = EverydayContact(random);
    centre.push_back(centre[5] * random.Uniform(1.0, 1.5));
    Box box = RandomBox(centre, 3, 0.1, random);
    if (random.Below(2) == 0) box[3] = Interval(random.Below(2) == 0 ? 0.0 : -0.1, 0.1);
    ExpectPlanarContainment(box, 200, random, {.budget = 2'000});
    ASSERT_FALSE(::testing::Test::HasFatalFailure());
  }
}

// Boxes around a W of rank one hold scenes of full rank, of rank one, and of none that is valid.
TEST(EnclosureTest, ContainsScenesOfRankOneAmongOthers) {
  Random random(14);
  for (int i = 0; i < 300; ++i) {
    const Numbers centre = {random.Uniform(0.5, 2.0), random.Uniform(0.5, 2.0), random.Uniform(-2.0, 2.0),
                            -random.Uniform(0.5, 2.0), random.Uniform(0.0, 1.0)};
    const Box x = RandomBox(centre, 3, 0.05, random);
    const PlanarBox box = {.wtt = Square(x[2]) / x[0],
                           .wtn = x[1] * x[2] / x[0],
                           .wnn = Square(x[1]) / x[0],
                           .u0 = x[2] * x[3],
                           .v0 = x[1] * x[3],
                           .mu = x[4]};
    const Enclosure enclosure = EnclosePlanar(box, {.budget = 300});
    for (int k = 0; k < 100; ++k) {
      const Numbers p = random.In(x);
      const Numbers contact = {p[2] * p[2] / p[0], p[1] * p[2] / p[0], p[1] * p[1] / p[0],
                               p[2] * p[3],        p[1] * p[3],        p[4]};
      ASSERT_TRUE(Contains(enclosure.outer, PlanarBounds(contact))) << ToString(x) << "\nat " << ToString(p);
    }
  }
}

// Wnn goes by doubles through W = (t, n)(t, n)^T, so that a box holds W that are refused, of rank one and of rank two,
// and the velocity lies beside the range of those of rank one.
TEST(EnclosureTest, ContainsScenesBesideTheRangeOfAWOfRankOne) {
  Random random(15);
  constexpr int kDoubles = 12;
  int answered = 0;
  for (int i = 0; i < 2'000; ++i) {
    const double t = random.Below(2) == 0 ? 2.0 : -0.5;
    const double n = random.Below(2) == 0 ? 1.0 : 0.75;
    const Numbers centre = {t * t,
                            t * n,
                            n * n,
                            random.Uniform(-3.0, 3.0),
                            -random.Uniform(0.1, 2.0),
                            random.Below(4) == 0 ? std::fabs(n / t) : random.Uniform(0.0, 3.0)};
    const double ulp = std::nextafter(centre[2], kInfinity) - centre[2];
    Box box = RandomBox(centre, 2, 0.01, random);
    box[0] = centre[0];
    box[1] = centre[1];
    box[2] = {centre[2] - kDoubles * ulp, centre[2] + kDoubles * ulp};
    const Enclosure enclosure = EnclosePlanar(ToPlanarBox(box), {.budget = 300});
    for (int k = -kDoubles; k <= kDoubles; ++k) {
      Numbers point = random.In(box);
      point[2] = centre[2] + k * ulp;
      const planar::Problem problem = ToPlanarProblem(point);
      if (!problem.w.IsSemidefinite() || planar::Solve(problem).regime == Regime::kWedged) continue;
      ++answered;
      ASSERT_TRUE(Contains(enclosure.outer, PlanarBounds(point), 1e-13)) << ToString(box) << "\nat " << ToString(point);
    }
  }
  EXPECT_GT(answered, 20'000);
}

void ExpectPendulumContainment(const Box& box, int samples, Random& random) {
  const Enclosure enclosure = Enclose(ToPendulumBox(box));
  ASSERT_TRUE(Contains(enclosure.outer, enclosure.attained, 0.0)) << ToString(box);
  for (int i = 0; i < samples; ++i) {
    const Numbers point = random.In(box);
    if (point.size() > 5 && point[5] < point[4]) continue;
    ASSERT_TRUE(Contains(enclosure.outer, PendulumBounds(point), 0.0)) << ToString(box) << "\nat " << ToString(point);
  }
}

TEST(EnclosureTest, ContainsEveryPendulumOfRandomBoxes) {
  pendulum::SceneSource source(5);
  Random random(5);
  for (int i = 0; i < 2'000; ++i) {
    const pendulum::Problem p = random.Below(4) == 0 ? source.NearLocking() : source.Everyday();
    if (!(p.a > 1e-100 && p.a < 1e100 && p.inertia < 1e100 && p.omega_minus > -1e100 && p.mu < 1e100)) continue;
    Numbers centre = {p.inertia, p.a, p.b, p.omega_minus, p.mu};
    if (p.mu_static > p.mu) centre.push_back(p.mu_static);
    const double reach = random.Below(2) == 0 ? 0.1 : std::exp2(-random.Uniform(0.0, 50.0));
    ExpectPendulumContainment(RandomBox(centre, 3, reach, random), 100, random);
    ASSERT_FALSE(::testing::Test::HasFatalFailure());
  }
}

TEST(EnclosureTest, ContainsPendulumsOnBothSidesOfThePin) {
  Random random(6);
  const Box box = {1.0, {0.4, 0.5}, {-0.3, 0.2}, {-2.0, 0.5}, {0.1, 0.4}};
  ExpectPendulumContainment(box, 10'000, random);
}

// ---- Tightness ----

struct Case {
  const char* name;
  Box box;
  int samples = 200'000;
};

std::vector<Case> PlanarCases() {
  return {
      {"rod, W", {{2.25, 2.75}, {1.35, 1.65}, {2.25, 2.75}, -1.0, -1.0, 0.7}, 1'000'000},
      {"rod, velocities and friction", {2.5, 1.5, 2.5, {-1.1, -0.9}, {-1.1, -0.9}, {0.63, 0.77}}},
      {"stops in compression or restitution, sticks or reverses",
       {2.0, 0.8, {1.8, 2.2}, {-0.88, -0.72}, -1.0, {0.36, 0.44}},
       1'000'000},
      {"jams or not", {{0.9, 1.1}, 0.7, 1.0, {0.45, 0.55}, -1.0, {1.26, 1.54}}},
      {"driven, stops or slides on", {{1.8, 2.2}, {0.54, 0.66}, 1.0, 1.0, -1.0, {0.45, 0.55}}},
      {"slip of either sign", {{1.8, 2.2}, 0.6, 1.0, {-0.1, 0.1}, -1.0, {0.45, 0.55}}},
  };
}

TEST(EnclosureTest, PlanarIsAtMostOnePercentWiderThanWhatSamplesReach) {
  for (const Case& one : PlanarCases()) {
    const Enclosure enclosure = EnclosePlanar(ToPlanarBox(one.box), kDefault);
    const CoefficientBounds seen = Sampled(one.box, one.samples, 7, PlanarBounds);
    EXPECT_TRUE(Contains(enclosure.outer, seen)) << one.name;
    EXPECT_LE(Wider(enclosure.outer, seen), 0.01) << one.name;
    EXPECT_LE(enclosure.excess, 0.01) << one.name;
    EXPECT_LE(enclosure.boxes, 50'000) << one.name;
  }
}

TEST(EnclosureTest, PendulumIsAtMostOnePercentWiderThanWhatSamplesReach) {
  const std::vector<Case> cases = {
      {"geometry", {1.0, {0.27, 0.33}, {0.9, 1.1}, -2.0, {0.09, 0.11}}, 1'000'000},
      {"inertia, speed, friction", {{0.9, 1.1}, 0.3, 0.5, {-2.2, -1.8}, {0.27, 0.33}}},
      {"left of the pin", {{0.9, 1.1}, {0.9, 1.1}, {-0.55, -0.45}, -1.0, 0.5}},
      {"locked", {1.0, {0.9, 1.1}, {3.6, 4.4}, -1.0, {0.45, 0.55}}},
  };
  for (const Case& one : cases) {
    const Enclosure enclosure = Enclose(ToPendulumBox(one.box));
    const CoefficientBounds seen = Sampled(one.box, one.samples, 8, PendulumBounds);
    EXPECT_TRUE(Contains(enclosure.outer, seen, 0.0)) << one.name;
    EXPECT_EQ(enclosure.excess, 0.0) << one.name;
    if (seen.energetic.upper == 0.0) {
      EXPECT_EQ(enclosure.outer.newton, Range());
      EXPECT_EQ(enclosure.outer.poisson, Range());
      EXPECT_LE(Wider(enclosure.outer.tangential, seen.tangential), 0.01);
      continue;
    }
    EXPECT_LE(Wider(enclosure.outer, seen), 0.01) << one.name;
  }
}

// Wherever W stays away from singular: what is attained is proved to be, so no sampling is needed to tell the excess.
TEST(EnclosureTest, DefaultBudgetSufficesForRandomBoxesOfThreeRanges) {
  Random random(9);
  std::vector<double> boxes;
  for (int i = 0; i < 400; ++i) {
    Numbers centre = EverydayContact(random);
    centre[1] *= 0.8;
    const Box box = RandomBox(centre, 3, 0.1, random);
    const Enclosure enclosure = EnclosePlanar(ToPlanarBox(box), kDefault);
    EXPECT_LE(enclosure.excess, 0.01) << ToString(box);
    boxes.push_back(static_cast<double>(enclosure.boxes));
  }
  std::sort(boxes.begin(), boxes.end());
  EXPECT_LE(boxes[boxes.size() * 9 / 10], 2'000);
}

TEST(EnclosureTest, MoreBudgetIsNeverWider) {
  const Box box = PlanarCases()[1].box;
  double excess = kInfinity;
  for (const int64_t budget : {1, 100, 1'000, 10'000}) {
    const Enclosure enclosure = EnclosePlanar(ToPlanarBox(box), {.tolerance = 1e-4, .budget = budget});
    EXPECT_LE(enclosure.boxes, budget);
    EXPECT_LE(enclosure.excess, excess);
    excess = enclosure.excess;
  }
  EXPECT_LE(excess, 0.01);
}

// ---- Points ----

void ExpectSame(const CoefficientBounds& got, const CoefficientBounds& want, double tolerance) {
  const auto same = [&](const Range& x, const Range& y) {
    const double scale = tolerance * std::max({1e-3, std::fabs(y.lower), std::fabs(y.upper)});
    EXPECT_NEAR(x.lower, y.lower, scale);
    EXPECT_NEAR(x.upper, y.upper, scale);
  };
  same(got.newton, want.newton);
  same(got.poisson, want.poisson);
  same(got.energetic, want.energetic);
  same(got.tangential, want.tangential);
  same(got.normal_total_n_s, want.normal_total_n_s);
}

TEST(EnclosureTest, APointHasItsOwnBounds) {
  Random random(10);
  for (int i = 0; i < 5'000; ++i) {
    const Numbers point = EverydayContact(random);
    const Enclosure enclosure = EnclosePlanar(ToPlanarBox(PointBox(point)), kDefault);
    ExpectSame(enclosure.outer, PlanarBounds(point), 1e-12);
    EXPECT_EQ(enclosure.excess, 0.0) << ToString(point);
    EXPECT_LE(enclosure.boxes, 3);
    ASSERT_FALSE(::testing::Test::HasFailure()) << ToString(point);
  }
}

TEST(EnclosureTest, APointOfRankOneIsThePendulum) {
  pendulum::SceneSource source(11);
  for (int i = 0; i < 5'000; ++i) {
    const pendulum::Problem p = source.Everyday();
    const Bounds want = pendulum::SolveBounds(p);
    if (std::fabs(1.0 - want.friction_ratio) < 1e-3) continue;
    const PlanarBox box = {.wtt = p.b * p.b / p.inertia,
                           .wtn = p.a * p.b / p.inertia,
                           .wnn = p.a * p.a / p.inertia,
                           .u0 = p.b * p.omega_minus,
                           .v0 = p.a * p.omega_minus,
                           .mu = p.mu,
                           .mu_static = p.mu_static};
    const double tolerance = 1e-13 * (1.0 + 1.0 / std::fabs(1.0 - want.friction_ratio));
    ExpectSame(EnclosePlanar(box, kDefault).outer, want.sharp, tolerance);
    ASSERT_FALSE(::testing::Test::HasFailure()) << pendulum::ToString(p);
  }
}

TEST(EnclosureTest, APendulumAtAPointHasItsOwnBounds) {
  pendulum::SceneSource source(12);
  for (int i = 0; i < 5'000; ++i) {
    const pendulum::Problem p = source.Everyday();
    const Bounds want = pendulum::SolveBounds(p);
    const double tolerance = 4e-15 * (1.0 + 1.0 / std::fabs(1.0 - want.friction_ratio));
    const Enclosure enclosure = Enclose(
        {.inertia = p.inertia, .a = p.a, .b = p.b, .omega_minus = p.omega_minus, .mu = p.mu, .mu_static = p.mu_static});
    ExpectSame(enclosure.outer, want.sharp, tolerance);
    ASSERT_FALSE(::testing::Test::HasFailure()) << pendulum::ToString(p);
  }
}

// ---- Thresholds ----

TEST(EnclosureTest, ABoxThatReachesIntoLockingHasNoFiniteBoundOfPoisson) {
  const Enclosure enclosure = Enclose({.inertia = 1.0, .a = {0.9, 1.1}, .b = 2.0, .omega_minus = -1.0, .mu = 0.5});
  EXPECT_EQ(enclosure.outer.poisson.upper, kInfinity);
  EXPECT_EQ(enclosure.outer.normal_total_n_s.upper, kInfinity);
  EXPECT_EQ(enclosure.excess, kInfinity);
  // x = 1/1.1 at the far end.
  EXPECT_NEAR(enclosure.outer.newton.upper, std::sqrt(0.1 / 2.1), 1e-15);
  EXPECT_NEAR(enclosure.outer.tangential.lower, -0.5, 1e-15);
  EXPECT_EQ(enclosure.outer.tangential.upper, 0.5);
}

// mu_s locks it before x = mu |b|/a gets near 1: slip ends at x = mu/mu_s.
TEST(EnclosureTest, StaticFrictionThatLocksEarlyKeepsPoissonFinite) {
  const Enclosure enclosure =
      Enclose({.inertia = 1.0, .a = {0.9, 1.1}, .b = 1.0, .omega_minus = -1.0, .mu = 0.5, .mu_static = Interval(1.0)});
  EXPECT_NEAR(enclosure.outer.poisson.upper, std::sqrt(1.5 / 0.5), 1e-14);
}

TEST(EnclosureTest, ABoxThatSeparatesHasNoImpulse) {
  const Enclosure all = EnclosePlanar({.wtt = 1.0, .wnn = 1.0, .v0 = {0.0, 1.0}, .mu = 0.5}, kDefault);
  EXPECT_EQ(all.outer, CoefficientBounds());
  const Enclosure some = EnclosePlanar({.wtt = 1.0, .wnn = 1.0, .u0 = 1.0, .v0 = {-1.0, 1.0}, .mu = 0.5}, kDefault);
  EXPECT_EQ(some.outer.normal_total_n_s, (Range{0.0, 2.0}));
}

TEST(EnclosureTest, WithoutFrictionEverythingIsExact) {
  const Enclosure enclosure =
      EnclosePlanar({.wtt = 2.0, .wtn = {0.4, 0.6}, .wnn = 1.0, .u0 = 1.0, .v0 = -1.0}, kDefault);
  EXPECT_EQ(enclosure.outer.newton, (Range{0.0, 1.0}));
  EXPECT_EQ(enclosure.outer.poisson, (Range{0.0, 1.0}));
  EXPECT_EQ(enclosure.outer.tangential, Range());
  EXPECT_EQ(enclosure.outer.normal_total_n_s, (Range{1.0, 2.0}));
  EXPECT_EQ(enclosure.excess, 0.0);
}

TEST(EnclosureTest, ABoxWithoutAValidSceneIsEmpty) {
  const Enclosure enclosure = EnclosePlanar({.wtt = 1.0, .wtn = {2.0, 3.0}, .wnn = 1.0, .v0 = -1.0}, kDefault);
  EXPECT_LT(enclosure.outer.newton.upper, enclosure.outer.newton.lower);
  EXPECT_LT(enclosure.outer.normal_total_n_s.upper, enclosure.outer.normal_total_n_s.lower);
}

// ---- A system that is not a bare contact ----

// A free body, contact offset (x, y) and mass m uncertain: W = [1/m + y^2/I, -xy/I; ., 1/m + x^2/I].
std::variant<AffinePlanarBox, PendulumBox> BodyContact(absl::Span<const Interval> range) {
  const Interval inverse = Interval(1.0) / range[2];
  const Interval inertia(0.1);
  return AffinePlanarBox{.wtt = inverse + Square(range[1]) / inertia,
                         .wtn = -(range[0] * range[1]) / inertia,
                         .wnn = inverse + Square(range[0]) / inertia,
                         .u0 = 1.0,
                         .v0 = -1.0,
                         .mu = 0.4};
}

TEST(EnclosureTest, AsksBeforeEachBoxWhetherToStop) {
  const Box box = {Around(0.3, 0.1), Around(-0.4, 0.1), Around(1.0, 0.1)};
  for (const int64_t enough : {1, 5, 20, 100}) {
    int64_t looks = 0;
    const Enclosure enclosure = Enclose(box, BodyContact, kDefault, [&] { return ++looks > enough; });
    EXPECT_LE(looks, enough + 1);
    // A look goes with at most the two boxes of a cut.
    EXPECT_LE(enclosure.boxes, 2 * enough + 1);
  }
}

TEST(EnclosureTest, EnclosesABodyThroughItsOwnParameters) {
  const Box box = {Around(0.3, 0.1), Around(-0.4, 0.1), Around(1.0, 0.1)};
  const auto bounds_of = [](const Numbers& x) {
    const double inverse = 1.0 / x[2];
    return PlanarBounds({inverse + x[1] * x[1] / 0.1, -x[0] * x[1] / 0.1, inverse + x[0] * x[0] / 0.1, 1.0, -1.0, 0.4});
  };
  const Enclosure enclosure = Enclose(box, BodyContact, kDefault, Never);
  const CoefficientBounds seen = Sampled(box, 1'000'000, 13, bounds_of);
  EXPECT_TRUE(Contains(enclosure.outer, seen));
  EXPECT_LE(Wider(enclosure.outer, seen), 0.01);
  EXPECT_LE(enclosure.excess, 0.01);
}

}  // namespace
}  // namespace ricochet
