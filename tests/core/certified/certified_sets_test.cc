// Certified sets: of inputs that are ranges, and of linkages whose ties no precision decides; and what is refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/certified/certified.h"
#include "core/models/restitution_law.h"
#include "ricochet/solver.h"
#include "tests/support/certificates.h"
#include "tests/support/system_scenes.h"

namespace ricochet {
namespace {

bool HasRegime(const Certificate& set, Regime regime) {
  return std::find(set.regimes.begin(), set.regimes.end(), regime) != set.regimes.end();
}

// That the answers to a problem within lie in a set.
void ExpectWithin(const Certificate& set, const Scene& scene) {
  const absl::StatusOr<Certificate> point = CertifySolve(scene, 25);
  ASSERT_TRUE(point.ok()) << point.status();
  EXPECT_TRUE(HasRegime(set, point->regimes[0]));
  ASSERT_EQ(point->numbers.size(), set.numbers.size());
  for (size_t i = 0; i < set.numbers.size(); ++i) {
    EXPECT_EQ(point->numbers[i].path, set.numbers[i].path);
    EXPECT_TRUE(Holds(set.numbers[i], point->numbers[i].decimal))
        << set.numbers[i].path << ": " << point->numbers[i].decimal << " is not in [" << set.numbers[i].lower << ", "
        << set.numbers[i].upper << "]";
  }
}

class Sampler {
 public:
  // The ends as often as all between.
  double In(const Range& range) {
    const int end = std::uniform_int_distribution<int>(0, 3)(random_);
    if (end < 2) return end == 0 ? range.lower : range.upper;
    return std::uniform_real_distribution<double>(range.lower, range.upper)(random_);
  }

 private:
  std::mt19937_64 random_{9};
};

constexpr PendulumSet kPendulums = {.inertia = {1.0, 1.0},
                                    .a = {0.9, 1.1},
                                    .b = {-0.1, 2.1},
                                    .omega_minus = {-1.0, -0.5},
                                    .mu = {0.4, 0.5},
                                    .mu_static = {0.5, 0.6},
                                    .law = RestitutionLaw::kEnergetic,
                                    .coefficient = {0.6, 0.6}};

TEST(CertifiedSetTest, HoldsEveryPendulumOfItsRangesAcrossLocking) {
  const absl::StatusOr<Certificate> set = CertifySolve(kPendulums, 12);
  ASSERT_TRUE(set.ok()) << set.status();
  EXPECT_TRUE(set->is_set);
  Sampler sampler;
  for (int i = 0; i < 300; ++i) {
    ExpectWithin(*set, SceneOf(pendulum::Problem{.inertia = sampler.In(kPendulums.inertia),
                                                 .a = sampler.In(kPendulums.a),
                                                 .b = sampler.In(kPendulums.b),
                                                 .omega_minus = sampler.In(kPendulums.omega_minus),
                                                 .mu = sampler.In(kPendulums.mu),
                                                 .mu_static = sampler.In(kPendulums.mu_static),
                                                 .coefficient = 0.6}));
  }
  EXPECT_EQ(set->regimes, (std::vector<Regime>{Regime::kFrictionless, Regime::kRebound, Regime::kLocked}));
}

void ExpectHoldsItsContacts(const ContactSet& ranges) {
  const absl::StatusOr<Certificate> set = CertifySolve(ranges, 12);
  ASSERT_TRUE(set.ok()) << set.status();
  Sampler sampler;
  for (int i = 0; i < 200; ++i) {
    const double mu = sampler.In(ranges.mu);
    ExpectWithin(*set, SceneOf(planar::Problem{.wtt = sampler.In(ranges.wtt),
                                               .wtn = sampler.In(ranges.wtn),
                                               .wnn = sampler.In(ranges.wnn),
                                               .u0 = sampler.In(ranges.u0),
                                               .v0 = sampler.In(ranges.v0),
                                               .mu = mu,
                                               .mu_static = std::max(mu, sampler.In(ranges.mu_static)),
                                               .law = ranges.law,
                                               .coefficient = sampler.In(ranges.coefficient)}));
  }
}

TEST(CertifiedSetTest, HoldsEveryContactOfItsRangesAcrossEveryEvent) {
  for (const auto law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    // Slip stops before, at and after the ends of compression and restitution; starts either way or not at all.
    ExpectHoldsItsContacts({.wtt = {2.0, 2.0},
                            .wtn = {0.5, 0.75},
                            .wnn = {1.0, 1.0},
                            .u0 = {-1.0, 3.0},
                            .v0 = {-1.0, -0.75},
                            .mu = {0.25, 0.5},
                            .mu_static = {0.25, 0.5},
                            .law = law,
                            .coefficient = {0.5, 1.0}});
    // The contact may separate, and restitution may be 0.
    ExpectHoldsItsContacts({.wtt = {2.0, 2.0},
                            .wtn = {-0.5, 0.5},
                            .wnn = {1.0, 1.0},
                            .u0 = {1.0, 1.0},
                            .v0 = {-1.0, 0.5},
                            .mu = {0.0, 0.5},
                            .mu_static = {0.5, 0.5},
                            .law = law,
                            .coefficient = {0.0, 0.5}});
  }
}

// Newton's coefficient of an elastic pendulum is sqrt(r): between 0.5 and sqrt(0.5) where x is in [1/3, 0.6].
TEST(CertifiedSetTest, IsNearlyTheSmallest) {
  PendulumSet ranges = {.inertia = {1.0, 1.0},
                        .a = {1.0, 1.0},
                        .b = {1.0, 1.0},
                        .omega_minus = {-1.0, -1.0},
                        .mu = {1.0 / 3.0, 0.6},
                        .mu_static = {0.6, 0.6},
                        .coefficient = {1.0, 1.0}};
  const Certificate set = *CertifySolve(ranges, 12);
  const CertifiedNumber newton = NumberAt(set, "coefficients.newton");
  EXPECT_LE(std::stod(newton.lower), 0.5);
  EXPECT_GE(std::stod(newton.lower), 0.495);
  EXPECT_GE(std::stod(newton.upper), std::sqrt(0.5));
  EXPECT_LE(std::stod(newton.upper), std::sqrt(0.5) + 0.005);
  EXPECT_EQ(set.regimes, std::vector<Regime>{Regime::kRebound});
}

TEST(CertifiedSetTest, OfSingleNumbersIsTheirPoint) {
  const ContactSet point = {.wtt = {2.0, 2.0},
                            .wtn = {0.5, 0.5},
                            .wnn = {1.0, 1.0},
                            .u0 = {1.0, 1.0},
                            .v0 = {-1.0, -1.0},
                            .mu = {0.5, 0.5},
                            .mu_static = {0.5, 0.5},
                            .coefficient = {0.5, 0.5}};
  EXPECT_EQ(*CertifySolve(point, 30), *CertifySolve(With(Contact()), 30));
  EXPECT_EQ(*CertifyBounds(point, 30), *CertifyBounds(With(Contact()), 30));
}

TEST(CertifiedSetTest, WithNoSemidefiniteWIsRefused) {
  const ContactSet none = {.wtt = {1.0, 1.5}, .wtn = {2.0, 2.0}, .wnn = {1.0, 1.0}, .u0 = {}, .v0 = {-1.0, -1.0}};
  EXPECT_EQ(CertifySolve(none, 5).status().message(),
            "planar_contact has no W with det W >= 0 in the set: must have one");
}

// --- Linkages ---

// Two links that mirror each other and, so hung, feel the same inertia: the tip comes straight down, u0 = 0 and Wtn =
// 0, but sines and cosines cannot prove it.
Scene SymmetricChain() {
  const Link upper = {1.0, 1.0, 0.5, 0.25, 0.5, -1.0};
  const Link lower = {1.0, 1.0, 0.5, 1.25, -0.5, 1.0};
  return With(Linkage{{upper, lower}});
}

TEST(CertifiedCapTest, AZeroThatNoPrecisionProvesIsAnsweredAsASetAroundIt) {
  const absl::StatusOr<Certificate> certificate = CertifySolve(SymmetricChain(), 30);
  ASSERT_TRUE(certificate.ok()) << certificate.status();
  EXPECT_TRUE(certificate->is_set);
  EXPECT_EQ(certificate->precision_bits, kMostBits);
  EXPECT_EQ(certificate->regimes, std::vector<Regime>{Regime::kStickInCompression});
  const CertifiedNumber friction = NumberAt(*certificate, "impulse.tangential_n_s[0]");
  EXPECT_EQ(friction.decimal, "");
  EXPECT_TRUE(Holds(friction, "0"));
  EXPECT_TRUE(Digits(friction.upper) - Digits(friction.lower) < Digits("1e-4900"));
  EXPECT_LT(std::fabs(friction.value), 1e-300);
  EXPECT_EQ(DecimalAt(*certificate, "contact_velocity_after.tangential_m_s[0]"), "0");
  EXPECT_EQ(DecimalAt(*certificate, "coefficients.newton"), "0.5");
}

// Whether slip would stop in the end no precision decides, but both answers have the same digits.
TEST(CertifiedCapTest, ATieThatChangesNoDigitIsNoSet) {
  Scene scene = SymmetricChain();
  auto& links = std::get<Linkage>(scene.system).links;
  links[0].rate_rad_s = -2.0;
  scene.friction.kinetic_coefficient = 0.0;
  scene.friction.static_coefficient = 0.5;
  const Certificate certificate = *CertifySolve(scene, 30);
  EXPECT_EQ(certificate.precision_bits, kMostBits);
  EXPECT_FALSE(certificate.is_set);
  EXPECT_EQ(certificate.regimes, std::vector<Regime>{Regime::kFrictionless});
  EXPECT_EQ(DecimalAt(certificate, "impulse.normal_total_n_s").size(), 31U);
}

TEST(CertifiedLinkageTest, AnElasticImpactWithoutFrictionKeepsItsEnergyExactly) {
  Scene scene = With(Chain());
  scene.friction.kinetic_coefficient = 0.0;
  scene.restitution = NewtonCoefficient{1.0};
  const CertifiedNumber energy = NumberAt(*CertifySolve(scene, 30), "energy_change_j");
  EXPECT_EQ(energy.decimal, "0");
  EXPECT_TRUE(energy.exact);
}

TEST(CertifiedCapTest, WhatALowCapLeavesOpenHoldsWhatAHighOneProves) {
  for (const double theta : {0.3, 1e-9, 3.0}) {
    Linkage chain = Chain();
    chain.links[0].theta_rad = theta;
    const Scene scene = With(chain);
    const Certificate proved = *CertifySolve(scene, 50);
    const Certificate capped = *CertifySolve(scene, 50, 70);
    EXPECT_FALSE(proved.is_set);
    EXPECT_TRUE(capped.is_set);
    EXPECT_EQ(capped.precision_bits, 70);
    EXPECT_TRUE(HasRegime(capped, proved.regimes[0]));
    for (size_t i = 0; i < proved.numbers.size(); ++i) {
      EXPECT_TRUE(Holds(capped.numbers[i], proved.numbers[i].decimal)) << proved.numbers[i].path;
    }
  }
}

// Three parallel links turn as one where they are: W has rank one by proof, and friction that reaches locks it.
TEST(CertifiedLinkageTest, ParallelLinksHaveRankOneByProof) {
  Linkage chain = Chain();
  chain.links.push_back(chain.links[0]);
  for (Link& link : chain.links) link.theta_rad = 0.7;
  Scene scene = With(chain);
  scene.friction.kinetic_coefficient = 10.0;
  const Certificate locked = *CertifySolve(scene, 40);
  EXPECT_FALSE(locked.is_set);
  EXPECT_EQ(locked.regimes, std::vector<Regime>{Regime::kLocked});
  EXPECT_EQ(DecimalAt(locked, "contact_velocity_after.normal_m_s"), "0");
  scene.friction.kinetic_coefficient = 0.1;
  const Certificate rebound = *CertifySolve(scene, 40);
  EXPECT_FALSE(rebound.is_set);
  EXPECT_EQ(rebound.regimes, std::vector<Regime>{Regime::kReversalInRestitution});
}

// --- Refusals ---

std::string Refusal(const Scene& scene, int digits) {
  return std::string(LocalSolver().Solve({.scene = scene, .certified_digits = digits}).status().message());
}

TEST(CertifiedRefusalTest, NamesWhatStandsAgainstACertificate) {
  EXPECT_EQ(Refusal(With(Body()), 10),
            "system is in space: certified answers are for a pendulum, planar bodies, a linkage or planar_contact");
  EXPECT_EQ(Refusal(With(Contact()), 1001), "certified_digits = 1001: must be in [1, 1000]");
  EXPECT_EQ(Refusal(With(Contact()), -1), "certified_digits = -1: must be in [1, 1000]");
  Scene scene = With(Contact());
  scene.finite_forces = ContactAcceleration{0.0, -9.81};
  EXPECT_EQ(Refusal(scene, 10), "finite_forces are set: certified answers are for impacts that take no time");
  scene = With(Contact());
  scene.compliance = Compliance{.tangential_ratio_squared = 1.2};
  EXPECT_EQ(Refusal(scene, 10), "compliance is set: certified answers are for rigid contact");
  scene = With(Contact());
  scene.restitution = {};
  scene.impact_law = WhittakerLaw{0.5};
  EXPECT_EQ(Refusal(scene, 10),
            "impact_law is set: certified answers are for Coulomb friction and a coefficient of restitution");
  Linkage parallel = Chain();
  parallel.links[1].theta_rad = parallel.links[0].theta_rad;
  scene = With(parallel);
  scene.surface_velocity = SurfaceVelocity{{0.0}, 0.0};
  EXPECT_EQ(Refusal(scene, 10),
            "surface_velocity is set: certified answers for links that are all parallel are for a surface at rest");
}

TEST(CertifiedRefusalTest, APlanHasNoNumbersToProve) {
  const auto response = LocalSolver().Solve({.scene = With(Contact()), .plan_only = true, .certified_digits = 10});
  EXPECT_EQ(response.status().message(),
            "plan_only is set: must not be, with certified_digits: a plan has no numbers to prove");
}

TEST(CertifiedRefusalTest, NoEffectIsLeftOut) {
  const auto response = LocalSolver().Solve(
      {.scene = With(Contact()), .demand = {.excluded = {Effect::kFriction}}, .certified_digits = 10});
  EXPECT_EQ(response.status().message(),
            "excluded is set: must not be, with certified_digits: certificates leave nothing out");
}

TEST(CertifiedRefusalTest, BoundsRefuseTheSame) {
  EXPECT_EQ(LocalSolver().Bounds({.scene = With(Body()), .certified_digits = 10}).status().message(),
            "system is in space: certified answers are for a pendulum, planar bodies, a linkage or planar_contact");
}

}  // namespace
}  // namespace ricochet
