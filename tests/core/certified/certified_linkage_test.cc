// Certificates of linkages, whose ties no precision decides and which are then answered as sets; and what is refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/certified/certified.h"
#include "ricochet/solver.h"
#include "tests/support/oracles/certificates.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

bool HasRegime(const Certificate& set, Regime regime) {
  return std::find(set.regimes.begin(), set.regimes.end(), regime) != set.regimes.end();
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
  const absl::StatusOr<Certificate> certificate = CertifySolve(SymmetricChain(), {30}, Never);
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

// No precision decides whether slip would stop in the end, but both answers have the same digits.
TEST(CertifiedCapTest, ATieThatChangesNoDigitIsNoSet) {
  Scene scene = SymmetricChain();
  auto& links = std::get<Linkage>(scene.system).links;
  links[0].rate_rad_s = -2.0;
  scene.friction.kinetic_coefficient = 0.0;
  scene.friction.static_coefficient = 0.5;
  const Certificate certificate = *CertifySolve(scene, {30}, Never);
  EXPECT_EQ(certificate.precision_bits, kMostBits);
  EXPECT_FALSE(certificate.is_set);
  EXPECT_EQ(certificate.regimes, std::vector<Regime>{Regime::kFrictionless});
  EXPECT_EQ(DecimalAt(certificate, "impulse.normal_total_n_s").size(), 31U);
}

TEST(CertifiedLinkageTest, AnElasticImpactWithoutFrictionKeepsItsEnergyExactly) {
  Scene scene = With(Chain());
  scene.friction.kinetic_coefficient = 0.0;
  scene.restitution = NewtonCoefficient{1.0};
  const CertifiedNumber energy = NumberAt(*CertifySolve(scene, {30}, Never), "energy_change_j");
  EXPECT_EQ(energy.decimal, "0");
  EXPECT_TRUE(energy.exact);
}

TEST(CertifiedCapTest, WhatALowCapLeavesOpenHoldsWhatAHighOneProves) {
  for (const double theta : {0.3, 1e-9, 3.0}) {
    Linkage chain = Chain();
    chain.links[0].theta_rad = theta;
    const Scene scene = With(chain);
    const Certificate proved = *CertifySolve(scene, {50}, Never);
    const Certificate capped = *CertifySolve(scene, {50, 70}, Never);
    EXPECT_FALSE(proved.is_set);
    EXPECT_TRUE(capped.is_set);
    EXPECT_EQ(capped.precision_bits, 70);
    EXPECT_TRUE(HasRegime(capped, proved.regimes[0]));
    for (size_t i = 0; i < proved.numbers.size(); ++i) {
      EXPECT_TRUE(Holds(capped.numbers[i], proved.numbers[i].decimal)) << proved.numbers[i].path;
    }
  }
}

// The chain ties at every precision, so that a certificate looks at every step at whether it should stop.
TEST(CertifiedLinkageTest, StopsSoonAfterItsCallerAsksForIt) {
  int looks = 0;
  const auto count = [&looks] {
    ++looks;
    return false;
  };
  ASSERT_TRUE(CertifySolve(SymmetricChain(), {30}, count).ok());
  const int all_looks = looks;
  EXPECT_GT(all_looks, 30);
  for (const int enough : {0, 1, 3, 6, 10, all_looks - 1}) {
    looks = 0;
    const auto stopped = [&] { return ++looks > enough; };
    EXPECT_TRUE(absl::IsCancelled(CertifySolve(SymmetricChain(), {30}, stopped).status())) << enough;
    EXPECT_LE(looks, enough + 3);
    looks = 0;
    EXPECT_TRUE(absl::IsCancelled(CertifyBounds(SymmetricChain(), {30}, stopped).status())) << enough;
  }
}

// Three parallel links turn as one where they are: W has rank one by proof, and friction that reaches locks it.
TEST(CertifiedLinkageTest, ParallelLinksHaveRankOneByProof) {
  Linkage chain = Chain();
  chain.links.push_back(chain.links[0]);
  for (Link& link : chain.links) link.theta_rad = 0.7;
  Scene scene = With(chain);
  scene.friction.kinetic_coefficient = 10.0;
  const Certificate locked = *CertifySolve(scene, {40}, Never);
  EXPECT_FALSE(locked.is_set);
  EXPECT_EQ(locked.regimes, std::vector<Regime>{Regime::kLocked});
  EXPECT_EQ(DecimalAt(locked, "contact_velocity_after.normal_m_s"), "0");
  scene.friction.kinetic_coefficient = 0.1;
  const Certificate rebound = *CertifySolve(scene, {40}, Never);
  EXPECT_FALSE(rebound.is_set);
  EXPECT_EQ(rebound.regimes, std::vector<Regime>{Regime::kReversalInRestitution});
}

// --- Refusals ---

std::string Refusal(const Scene& scene, int digits) {
  return std::string(LocalSolver().Solve({.scene = scene, .certified_digits = digits}).status().message());
}

TEST(CertifiedRefusalTest, NamesWhatStandsAgainstACertificate) {
  EXPECT_EQ(
      Refusal(With(Body()), 10),
      "system lies in space: must be a pendulum, planar bodies, a linkage or planar_contact for a certified answer");
  EXPECT_EQ(Refusal(With(Contact()), 1001), "certified_digits = 1001: must be 0 for none, or in [1, 1000]");
  EXPECT_EQ(Refusal(With(Contact()), -1), "certified_digits = -1: must be 0 for none, or in [1, 1000]");
  Scene scene = With(Contact());
  scene.finite_forces = ContactAcceleration{0.0, -9.81};
  EXPECT_EQ(Refusal(scene, 10),
            "finite_forces are set: must not be for a certified answer, whose impact takes no time");
  scene = With(Contact());
  scene.compliance = Compliance{.tangential_ratio_squared = 1.2};
  EXPECT_EQ(Refusal(scene, 10), "compliance is set: must not be for a certified answer, which needs rigid contact");
  scene = With(Contact());
  scene.restitution = {};
  scene.impact_law = WhittakerLaw{0.5};
  EXPECT_EQ(Refusal(scene, 10),
            "impact_law is set: must not be for a certified answer, which needs Coulomb friction and a coefficient of "
            "restitution");
  Linkage parallel = Chain();
  parallel.links[1].theta_rad = parallel.links[0].theta_rad;
  scene = With(parallel);
  scene.surface_velocity = SurfaceVelocity{{0.0}, 0.0};
  EXPECT_EQ(Refusal(scene, 10),
            "surface_velocity is set: must not be for a certified answer about links that are all parallel");
}

TEST(CertifiedRefusalTest, NoEffectIsLeftOut) {
  const auto response = LocalSolver().Solve(
      {.scene = With(Contact()), .demand = {.excluded = {Effect::kFriction}}, .certified_digits = 10});
  EXPECT_EQ(response.status().message(),
            "excluded is set: must not be, with certified_digits: certificates leave nothing out");
}

TEST(CertifiedRefusalTest, BoundsRefuseTheSame) {
  EXPECT_EQ(
      LocalSolver().Bounds({.scene = With(Body()), .certified_digits = 10}).status().message(),
      "system lies in space: must be a pendulum, planar bodies, a linkage or planar_contact for a certified answer");
}

}  // namespace
}  // namespace ricochet
