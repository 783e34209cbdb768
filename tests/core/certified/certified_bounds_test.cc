// Certified bounds against the paper's identities, the impacts that attain them, and the bounds in doubles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/bounds/contact_bounds.h"
#include "core/bounds/pendulum_bounds.h"
#include "core/certified/certified.h"
#include "core/models/restitution_law.h"
#include "core/plan/scene_problem.h"
#include "ricochet/solver.h"
#include "tests/support/oracles/certificates.h"
#include "tests/support/oracles/ulp.h"
#include "tests/support/scenes/pendulum_scenes.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

// x = 0.6: r = 1/4, and every root is rational.
TEST(CertifiedBoundsTest, APendulumAtXThreeFifthsHasThoseOfThePaper) {
  const Scene scene =
      SceneOf(pendulum::Problem{.inertia = 2.0, .a = 5.0, .b = -1.0, .omega_minus = -1.0, .mu = 3.0, .mu_static = 3.0});
  const Certificate bounds = *CertifyBounds(scene, {20}, Never);
  EXPECT_EQ(DecimalAt(bounds, "friction_ratio"), "0.6");
  EXPECT_EQ(DecimalAt(bounds, "slope_ratio"), "0.25");
  EXPECT_EQ(DecimalAt(bounds, "sharp.newton.upper"), "0.5");
  EXPECT_EQ(DecimalAt(bounds, "sharp.poisson.upper"), "2");
  EXPECT_EQ(DecimalAt(bounds, "sharp.energetic.upper"), "1");
  // (a/|b|)(1 - sqrt(1 - x^2)) = 5 (1 - 4/5), on the side of b < 0.
  EXPECT_EQ(DecimalAt(bounds, "sharp.tangential.upper"), "1");
  EXPECT_EQ(DecimalAt(bounds, "sharp.tangential.lower"), "-3");
  EXPECT_EQ(DecimalAt(bounds, "sharp.normal_total_n_s.lower"), "0.25");
  EXPECT_EQ(DecimalAt(bounds, "sharp.normal_total_n_s.upper"), "0.75");
  EXPECT_EQ(DecimalAt(bounds, "energy_only.newton.upper"), "1");
  EXPECT_EQ(DecimalAt(bounds, "energy_only.poisson.upper"), "4");
  EXPECT_EQ(DecimalAt(bounds, "energy_only.energetic.upper"), "2");
  EXPECT_EQ(DecimalAt(bounds, "critical.stick"), "5");
}

TEST(CertifiedBoundsTest, SharpBoundsAreTheCoefficientsOfTheElasticImpact) {
  for (const System& system : std::vector<System>{Pendulum{1.0, 0.3, 1.0, -1.0}, Contact(), Flat(), Chain()}) {
    Scene scene = With(system);
    scene.friction.kinetic_coefficient = 0.1;
    scene.restitution = EnergeticCoefficient{1.0};
    const Certificate bounds = *CertifyBounds(scene, {60}, Never);
    const Certificate elastic = *CertifySolve(scene, {60}, Never);
    EXPECT_FALSE(bounds.is_set);
    EXPECT_EQ(bounds.regimes, elastic.regimes);
    EXPECT_EQ(DecimalAt(bounds, "sharp.newton.upper"), DecimalAt(elastic, "coefficients.newton"));
    EXPECT_EQ(DecimalAt(bounds, "sharp.poisson.upper"), DecimalAt(elastic, "coefficients.poisson"));
    EXPECT_EQ(DecimalAt(bounds, "sharp.normal_total_n_s.upper"), DecimalAt(elastic, "impulse.normal_total_n_s"));
    EXPECT_EQ(DecimalAt(bounds, "sharp.normal_total_n_s.lower"), DecimalAt(elastic, "impulse.normal_compression_n_s"));
  }
}

// Restitution up to Poisson's weaker bound gives back just the energy that there was.
TEST(CertifiedBoundsTest, EnergyIsBackAtTheWeakerBounds) {
  planar::SceneSource source(21);
  for (int i = 0; i < 300; ++i) {
    planar::Problem problem = source.Everyday();
    const Certificate bounds = *CertifyBounds(SceneOf(problem), {40}, Never);
    problem.law = RestitutionLaw::kPoisson;
    problem.coefficient = NumberAt(bounds, "energy_only.poisson.upper").value;
    const Certificate impact = *CertifySolve(SceneOf(problem), {40}, Never);
    const double before = std::fabs(NumberAt(impact, "work.normal_compression_j").value) +
                          std::fabs(NumberAt(impact, "work.tangential_total_j").value);
    EXPECT_LE(std::fabs(NumberAt(impact, "energy_change_j").value), 1e-13 * before) << i;
    EXPECT_NEAR(NumberAt(impact, "coefficients.newton").value, NumberAt(bounds, "energy_only.newton.upper").value,
                1e-12);
    EXPECT_NEAR(NumberAt(impact, "coefficients.energetic").value, NumberAt(bounds, "energy_only.energetic.upper").value,
                1e-12);
  }
}

// A bound in doubles may lie some doubles lower, so that Solve accepts it.
bool IsBound(double computed, double exact, double tolerance) {
  return UlpDistance(computed, exact) <= 4 ||
         std::fabs(computed - exact) <= tolerance * std::max(1.0, std::fabs(exact));
}

void ExpectBounds(const Certificate& certificate, const std::string& prefix, const CoefficientBounds& bounds,
                  double tolerance) {
  const auto check = [&](const char* name, const Range& range) {
    const CertifiedNumber lower = NumberAt(certificate, prefix + name + ".lower");
    const CertifiedNumber upper = NumberAt(certificate, prefix + name + ".upper");
    EXPECT_TRUE(IsBound(range.lower, lower.value, tolerance)) << lower.path << range.lower << " " << lower.decimal;
    EXPECT_TRUE(IsBound(range.upper, upper.value, tolerance)) << upper.path << range.upper << " " << upper.decimal;
  };
  check("newton", bounds.newton);
  check("poisson", bounds.poisson);
  check("energetic", bounds.energetic);
  check("tangential", bounds.tangential);
  check("normal_total_n_s", bounds.normal_total_n_s);
}

TEST(CertifiedBoundsTest, ThoseOfPendulumsInDoublesAreWithinTheirPromise) {
  pendulum::SceneSource source(31);
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(i);
    const pendulum::Problem problem = source.Any();
    const Bounds bounds = pendulum::SolveBounds(problem);
    const Certificate certificate = *CertifyBounds(SceneOf(problem), {17}, Never);
    EXPECT_EQ(certificate.regimes, std::vector<Regime>{bounds.regime});
    ExpectBounds(certificate, "sharp.", bounds.sharp, 0.0);
    ExpectBounds(certificate, "energy_only.", *bounds.energy_only, 0.0);
    EXPECT_LE(UlpDistance(bounds.friction_ratio, NumberAt(certificate, "friction_ratio").value), 1U);
    EXPECT_LE(UlpDistance(bounds.slope_ratio, NumberAt(certificate, "slope_ratio").value), 1U);
  }
}

TEST(CertifiedBoundsTest, ThoseOfContactsInDoublesAreWithinTheirPromise) {
  planar::SceneSource source(41);
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(i);
    const planar::Problem problem = source.Everyday();
    const Bounds bounds = planar::SolveBounds(problem);
    const Certificate certificate = *CertifyBounds(SceneOf(problem), {17}, Never);
    EXPECT_EQ(certificate.regimes, std::vector<Regime>{bounds.regime});
    ExpectBounds(certificate, "sharp.", bounds.sharp, 1e-14);
    ExpectBounds(certificate, "energy_only.", *bounds.energy_only, 1e-10);
    const auto check = [&](const char* path, const std::optional<double>& critical) {
      const CertifiedNumber number = NumberAt(certificate, path);
      ASSERT_EQ(critical.has_value(), !number.path.empty()) << path;
      EXPECT_TRUE(IsBound(critical.value_or(0.0), number.value, 1e-11)) << path;
    };
    check("critical.stick", bounds.critical.stick);
    check("critical.stop_compression", bounds.critical.stop_compression);
    check("critical.stop", bounds.critical.stop);
    check("critical.reversal", bounds.critical.reversal);
    check("critical.jam", bounds.critical.jam);
  }
}

TEST(CertifiedBoundsTest, StandBesideTheDoublesOfTheResponse) {
  const auto response = LocalSolver().Bounds({.scene = With(Contact()), .certified_digits = 50});
  ASSERT_TRUE(response.ok()) << response.status();
  ASSERT_TRUE(response->certificate.has_value());
  EXPECT_EQ(*response->certificate, *CertifyBounds(With(Contact()), {50}, Never));
  EXPECT_FALSE(LocalSolver().Bounds({.scene = With(Contact())})->certificate.has_value());
}

}  // namespace
}  // namespace ricochet
