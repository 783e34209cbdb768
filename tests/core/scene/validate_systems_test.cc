// Validation of every system but the pendulum, and of the other parts of a scene.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "core/contact/reduction.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {

// The test framework finds this function by its name.
static void PrintTo(const Violation& violation, std::ostream* out) {
  *out << violation.field << " " << violation.description;
}

namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

struct BadScene {
  std::string name;
  std::function<Scene()> make;
  std::string field;
  std::string description;
};

void PrintTo(const BadScene& bad, std::ostream* out) { *out << bad.name; }

template <typename T>
std::function<Scene()> Spoil(T system, const std::function<void(T&)>& spoil) {
  return [=] {
    T spoilt = system;
    spoil(spoilt);
    return With(spoilt);
  };
}

std::function<Scene()> Beside(const std::function<void(Scene&)>& spoil) {
  return [=] {
    Scene scene = With(Contact());
    spoil(scene);
    return scene;
  };
}

std::vector<BadScene> BadSystems() {
  return {
      {"BodyWithoutMass", Spoil<PlanarBody>(Flat(), [](auto& b) { b.mass_kg = 0.0; }), "planar_body.mass_kg",
       "= 0: must be > 0"},
      {"BodyWithoutInertia", Spoil<PlanarBody>(Flat(), [](auto& b) { b.inertia_com_kg_m2 = -1.0; }),
       "planar_body.inertia_com_kg_m2", "= -1: must be > 0"},
      {"BodyThatIsNowhere", Spoil<PlanarBody>(Flat(), [](auto& b) { b.offset_n_m = kNan; }), "planar_body.offset_n_m",
       "= nan: must be finite"},
      {"BodyInSpaceWithoutMass", Spoil<SpatialBody>(Body(), [](auto& b) { b.mass_kg = -2.0; }), "spatial_body.mass_kg",
       "= -2: must be > 0"},
      {"ShortInertia", Spoil<SpatialBody>(Body(), [](auto& b) { b.inertia_com_kg_m2.pop_back(); }),
       "spatial_body.inertia_com_kg_m2", "has 5 entries: must have 6"},
      {"IndefiniteInertia", Spoil<SpatialBody>(Body(), [](auto& b) { b.inertia_com_kg_m2 = {1, 2, 0, 1, 0, 1}; }),
       "spatial_body.inertia_com_kg_m2", "= [1, 2, 0, 1, 0, 1]: must be positive definite"},
      {"SingularInertia", Spoil<SpatialBody>(Body(), [](auto& b) { b.inertia_com_kg_m2 = {1, 0, 0, 1, 0, 0}; }),
       "spatial_body.inertia_com_kg_m2", "= [1, 0, 0, 1, 0, 0]: must be positive definite"},
      {"ImpossibleInertia", Spoil<SpatialBody>(Body(), [](auto& b) { b.inertia_com_kg_m2 = {1, 0, 0, 1, 0, 5}; }),
       "spatial_body.inertia_com_kg_m2",
       "= [1, 0, 0, 1, 0, 5]: must be that of a body: its largest principal moment is at most the sum of the other "
       "two"},
      // In its own axes, this tensor is [1, 0, 0, 3, 0, 5].
      {"ImpossibleInertiaInTurnedAxes",
       Spoil<SpatialBody>(Body(), [](auto& b) { b.inertia_com_kg_m2 = {2, 1, 0, 2, 0, 5}; }),
       "spatial_body.inertia_com_kg_m2",
       "= [2, 1, 0, 2, 0, 5]: must be that of a body: its largest principal moment is at most the sum of the other "
       "two"},
      {"LongOffset", Spoil<SpatialBody>(Body(), [](auto& b) { b.offset_m.push_back(1.0); }), "spatial_body.offset_m",
       "has 4 entries: must have 3"},
      {"NoVelocity", Spoil<SpatialBody>(Body(), [](auto& b) { b.linear_m_s.clear(); }), "spatial_body.linear_m_s",
       "has 0 entries: must have 3"},
      {"OneRate", Spoil<SpatialBody>(Body(), [](auto& b) { b.angular_rad_s = {1.0}; }), "spatial_body.angular_rad_s",
       "has 1 entry: must have 3"},
      {"InfiniteRate", Spoil<SpatialBody>(Body(), [](auto& b) { b.angular_rad_s[2] = INFINITY; }),
       "spatial_body.angular_rad_s[2]", "= inf: must be finite"},
      {"PairOfNothing", [] { return With(BodyPair()); }, "body_pair.bodies",
       "is not set: must be one of planar, spatial"},
      {"SecondBodyWithoutMass",
       Spoil<BodyPair>({PlanarPair{Flat(), Flat()}},
                       [](auto& p) { std::get<PlanarPair>(p.bodies).body_2.mass_kg = 0.0; }),
       "body_pair.planar.body_2.mass_kg", "= 0: must be > 0"},
      {"SecondBodyInSpaceWithoutOffset",
       Spoil<BodyPair>({SpatialPair{Body(), Body()}},
                       [](auto& p) { std::get<SpatialPair>(p.bodies).body_2.offset_m.clear(); }),
       "body_pair.spatial.body_2.offset_m", "has 0 entries: must have 3"},
      {"ChainWithoutLinks", [] { return With(Linkage()); }, "linkage.links", "has 0 entries: must have at least one"},
      {"LinkWithoutLength", Spoil<Linkage>(Chain(), [](auto& l) { l.links[1].length_m = 0.0; }),
       "linkage.links[1].length_m", "= 0: must be > 0"},
      {"LinkWithoutMass", Spoil<Linkage>(Chain(), [](auto& l) { l.links[0].mass_kg = 0.0; }),
       "linkage.links[0].mass_kg", "= 0: must be > 0"},
      {"LinkWithoutInertia", Spoil<Linkage>(Chain(), [](auto& l) { l.links[0].inertia_com_kg_m2 = 0.0; }),
       "linkage.links[0].inertia_com_kg_m2", "= 0: must be > 0"},
      {"LinkAtNoAngle", Spoil<Linkage>(Chain(), [](auto& l) { l.links[1].theta_rad = kNan; }),
       "linkage.links[1].theta_rad", "= nan: must be finite"},
      {"NegativeW", Spoil<PlanarContact>(Contact(), [](auto& c) { c.w_nn_per_kg = -1.0; }),
       "planar_contact.w_nn_per_kg", "= -1: must be >= 0"},
      {"IndefiniteW", Spoil<PlanarContact>(Contact(), [](auto& c) { c.w_tn_per_kg = 1.5; }),
       "planar_contact.w_tn_per_kg", "= 1.5: must leave W positive semidefinite: w_tn^2 <= w_tt w_nn = 2 * 1"},
      {"CouplingWithoutTangentialW", Spoil<PlanarContact>(Contact(), [](auto& c) { c.w_tt_per_kg = 0.0; }),
       "planar_contact.w_tn_per_kg", "= 0.5: must leave W positive semidefinite: w_tn^2 <= w_tt w_nn = 0 * 1"},
      {"IndefiniteWInSpace", Spoil<SpatialContact>(ContactInSpace(), [](auto& c) { c.w_per_kg = {1, 0, 2, 1, 0, 1}; }),
       "spatial_contact.w_per_kg", "= [1, 0, 2, 1, 0, 1]: must be positive semidefinite"},
      {"ShortWInSpace", Spoil<SpatialContact>(ContactInSpace(), [](auto& c) { c.w_per_kg = {1.0}; }),
       "spatial_contact.w_per_kg", "has 1 entry: must have 6"},
      {"OneTangentialVelocityInSpace", Spoil<SpatialContact>(ContactInSpace(), [](auto& c) { c.tangential_m_s = {1}; }),
       "spatial_contact.tangential_m_s", "has 1 entry: must have 2"},
      {"NothingThatCouldStopIt",
       [] {
         return With(PlanarContact{1.0, 0.0, 0.0, 1.0, -1.0});
       },
       "planar_contact.normal_m_s", "makes v0 = -1 where W_nn = 0: must be >= 0, no impulse along n ends the approach"},
      {"NothingThatCouldStopItInSpace",
       [] {
         return With(SpatialContact{{1, 0, 0, 1, 0, 0}, {1.0, 0.5}, -1.0});
       },
       "spatial_contact.normal_m_s",
       "makes v0 = -1 where W_nn = 0: must be >= 0, no impulse along n ends the approach"},
      {"AMobilityInSpaceThatTheOthersHide",
       [] {
         return With(SpatialContact{{1, 0, 0, 1, 0, 1e-140}, {1.0, 0.5}, -1.0});
       },
       "spatial_contact.w_per_kg",
       "has 1e-140 1/kg on the diagonal of W: must have 0 or at least 3.3589380537835444e-139 times the largest, 1"},
      {"FrictionInSpaceThatHasNoSquare",
       [] {
         Scene scene = With(ContactInSpace());
         scene.friction.kinetic_coefficient = 1e200;
         return scene;
       },
       "friction", "has a kinetic coefficient of 1e+200: must be at most 2.977131414714806e+138 in space"},
  };
}

std::vector<BadScene> BadCompanions() {
  const SpeedTable table = {{1.0, 2.0}, {1.0, 0.5}};
  return {
      {"LongSurface", Beside([](Scene& s) {
         s.surface_velocity = SurfaceVelocity{{1.0, 2.0}, 0.0};
       }),
       "surface_velocity.tangential_m_s", "has 2 entries: must have 1"},
      {"InfiniteSurface", Beside([](Scene& s) {
         s.surface_velocity = SurfaceVelocity{{1.0}, INFINITY};
       }),
       "surface_velocity.normal_m_s", "= inf: must be finite"},
      {"PairOnASurface",
       [] {
         Scene scene = With(BodyPair{PlanarPair{Flat(), Flat()}});
         scene.surface_velocity = SurfaceVelocity{{1.0}, 0.0};
         return scene;
       },
       "surface_velocity", "is set: must not be for body_pair, whose body 2 is the surface"},
      {"LawBesideRestitution", Beside([](Scene& s) { s.impact_law = WhittakerLaw{0.5}; }), "restitution",
       "is set beside an impact law: must not be, the law states its own coefficient"},
      {"LawInSpace",
       [] {
         Scene scene = With(ContactInSpace());
         scene.restitution = std::monostate();
         scene.impact_law = BrachLaw{0.5, 0.1};
         return scene;
       },
       "brach", "is set: must not be for a system in space"},
      {"TangentialCoefficientBeyondOne", Beside([](Scene& s) {
         s.restitution = std::monostate();
         s.impact_law = ChatterjeeRuinaLaw{0.5, -1.5};
       }),
       "chatterjee_ruina.e_t", "= -1.5: must be in [-1, 1]"},
      {"NegativeWhittaker", Beside([](Scene& s) {
         s.restitution = std::monostate();
         s.impact_law = WhittakerLaw{-0.5};
       }),
       "whittaker.e", "= -0.5: must be >= 0"},
      {"DependenceOfNoForm", Beside([](Scene& s) { s.friction.by_speed = SpeedDependence(); }),
       "friction.by_speed.form", "is not set: must be one of power_law, table"},
      {"NegativeExponent", Beside([](Scene& s) {
         s.friction.by_speed = PowerLaw{0.1, -1.0};
       }),
       "friction.by_speed.power_law.exponent", "= -1: must be >= 0"},
      {"EmptyTable", Beside([](Scene& s) { s.restitution_by_speed = SpeedTable(); }),
       "restitution.by_speed.table.speed_m_s", "has 0 entries: must have at least one"},
      {"SpeedsThatDoNotRise", Beside([=](Scene& s) {
         SpeedTable falling = table;
         falling.speed_m_s[1] = 1.0;
         s.friction.by_speed = falling;
       }),
       "friction.by_speed.table.speed_m_s[1]", "= 1: must be > the speed before it, 1"},
      {"FactorsThatAreMissing", Beside([=](Scene& s) {
         SpeedTable short_table = table;
         short_table.factor.pop_back();
         s.friction.by_speed = short_table;
       }),
       "friction.by_speed.table.factor", "has 1 entry: must have 2"},
      {"FactorThatMakesFrictionNegative", Beside([](Scene& s) {
         s.friction.by_speed = PowerLaw{3.0, 1.0};
       }),
       "friction.by_speed", "makes the coefficient -1 at the approach speed 1 m/s: must be finite and >= 0"},
      {"FactorThatMakesRestitutionAboveOne", Beside([](Scene& s) {
         s.restitution_by_speed = PowerLaw{-2.0, 0.5};
       }),
       "restitution.by_speed", "makes the coefficient 1.5 at the approach speed 1 m/s: must be in [0, 1]"},
  };
}

Compliance Rigid() { return {}; }
Compliance Ratio() { return {.tangential_ratio_squared = 1.2, .normal = {}}; }

std::vector<BadScene> BadEffects() {
  return {
      {"EmptyCompliance", Beside([](Scene& s) { s.compliance = Rigid(); }), "compliance",
       "is empty: must state tangential_ratio_squared or one of linear, hertz, hunt_crossley"},
      {"NoRatio", Beside([](Scene& s) { s.compliance = {.tangential_ratio_squared = 0.0, .normal = {}}; }),
       "compliance.tangential_ratio_squared", "= 0: must be in [1e-9, 1e9]"},
      {"RatioBelowWhatADoubleResolves",
       Beside([](Scene& s) { s.compliance = {.tangential_ratio_squared = 9.999e-10, .normal = {}}; }),
       "compliance.tangential_ratio_squared", "= 9.999e-10: must be in [1e-9, 1e9]"},
      {"RatioOfASpringThatIsNone",
       Beside([](Scene& s) { s.compliance = {.tangential_ratio_squared = 1e300, .normal = {}}; }),
       "compliance.tangential_ratio_squared", "= 1e+300: must be in [1e-9, 1e9]"},
      {"NoStiffness", Beside([](Scene& s) { s.compliance = {.normal = LinearSpring{0.0}}; }),
       "compliance.linear.stiffness_n_m", "= 0: must be > 0"},
      {"NegativeHertz", Beside([](Scene& s) { s.compliance = {.normal = HertzSpring{-1.0}}; }),
       "compliance.hertz.stiffness_n_m1_5", "= -1: must be > 0"},
      {"SteepDamper", Beside([](Scene& s) {
         s.restitution = std::monostate();
         s.compliance = {.normal = HuntCrossleySpring{1.0, 4.5, 0.1}};
       }),
       "compliance.hunt_crossley.exponent", "= 4.5: must be in [1, 4]"},
      {"DamperThatDrives", Beside([](Scene& s) {
         s.restitution = std::monostate();
         s.compliance = {.normal = HuntCrossleySpring{1.0, 1.5, -0.1}};
       }),
       "compliance.hunt_crossley.damping_s_m", "= -0.1: must be >= 0"},
      {"DamperBesideRestitution", Beside([](Scene& s) {
         s.compliance = {.normal = HuntCrossleySpring{1.0, 1.5, 0.1}};
       }),
       "restitution", "is set beside compliance.hunt_crossley: must not be, the damping stands for it"},
      {"RatioOfAHertzSpring",
       Beside([](Scene& s) { s.compliance = {.tangential_ratio_squared = 1.0, .normal = HertzSpring{1.0}}; }),
       "compliance.tangential_ratio_squared",
       "is set beside hertz or hunt_crossley: must not be, the ratio is one of constant stiffnesses"},
      {"StaticFrictionOnSprings", Beside([](Scene& s) {
         s.friction.static_coefficient = 0.6;
         s.compliance = Ratio();
       }),
       "friction.static_coefficient",
       "is set beside compliance.tangential_ratio_squared: must be friction.kinetic_coefficient or unset"},
      {"ComplianceInSpace",
       [] {
         Scene scene = With(ContactInSpace());
         scene.compliance = Ratio();
         return scene;
       },
       "compliance", "is set: must not be for a system in space"},
      {"ComplianceUnderALaw", Beside([](Scene& s) {
         s.restitution = std::monostate();
         s.impact_law = WhittakerLaw{0.5};
         s.compliance = Ratio();
       }),
       "compliance", "is set beside an impact law: must not be, an impact law has no springs"},
      {"NewtonOnASpring", Beside([](Scene& s) {
         s.restitution = NewtonCoefficient{0.5};
         s.compliance = Ratio();
       }),
       "restitution.newton", "is not energetic: must be, with compliance, unless W_tn is 0 and all three are the same"},
      {"NewtonAboveOneOnASpring",
       [] {
         Scene scene = With(PlanarContact{2.0, 0.0, 1.0, 1.0, -1.0});
         scene.restitution = NewtonCoefficient{1.5};
         scene.compliance = Ratio();
         return scene;
       },
       "restitution.newton", "is above 1: must be in [0, 1], with compliance"},
      {"ChatterWithoutRestitution", Beside([](Scene& s) {
         s.friction.kinetic_coefficient = 2.0;
         s.restitution = EnergeticCoefficient{0.0};
         s.compliance = Ratio();
       }),
       "restitution.energetic",
       "is 0: must be > 0, with a tangential compliance and friction that reaches W_nn/|W_tn|"},
      {"GravityOnAContact", Beside([](Scene& s) {
         s.finite_forces = Gravity{0.0, -9.81};
       }),
       "gravity", "is set: must only be for planar_body, body_pair.planar and linkage"},
      {"GravityInSpace",
       [] {
         Scene scene = With(BodyPair{SpatialPair{Body(), Body()}});
         scene.finite_forces = Gravity{0.0, -9.81};
         return scene;
       },
       "gravity", "is set: must only be for planar_body, body_pair.planar and linkage"},
      {"MomentOnAContact", Beside([](Scene& s) { s.finite_forces = PinMoment{1.0}; }), "pin_moment",
       "is set: must only be for pendulum"},
      {"AccelerationOfABody",
       [] {
         Scene scene = With(Flat());
         scene.finite_forces = ContactAcceleration{0.0, 1.0};
         return scene;
       },
       "contact_acceleration", "is set: must only be for planar_contact"},
      {"InfiniteGravity",
       [] {
         Scene scene = With(Flat());
         scene.finite_forces = Gravity{0.0, -INFINITY};
         return scene;
       },
       "gravity.normal_m_s2", "= -inf: must be finite"},
      {"ForcesUnderALaw", Beside([](Scene& s) {
         s.restitution = std::monostate();
         s.impact_law = WhittakerLaw{0.5};
         s.finite_forces = ContactAcceleration{0.0, 1.0};
       }),
       "contact_acceleration", "is set beside an impact law: must not be, an impact law has no duration"},
  };
}

class BadSystemTest : public testing::TestWithParam<BadScene> {};

TEST_P(BadSystemTest, IsReportedWithFieldValueAndRule) {
  const Scene scene = GetParam().make();
  const std::vector<Violation> violations = Validate(scene);
  ASSERT_THAT(violations, ElementsAre(Violation{GetParam().field, GetParam().description}));
  EXPECT_FALSE(violations.front().rule.empty());
  EXPECT_TRUE(absl::EndsWith(GetParam().description, ": must " + violations.front().rule));
}

std::string NameOf(const testing::TestParamInfo<BadScene>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Systems, BadSystemTest, testing::ValuesIn(BadSystems()), NameOf);
INSTANTIATE_TEST_SUITE_P(Effects, BadSystemTest, testing::ValuesIn(BadEffects()), NameOf);
INSTANTIATE_TEST_SUITE_P(Companions, BadSystemTest, testing::ValuesIn(BadCompanions()), NameOf);

TEST(ValidateSystemsTest, EverySystemHasAValidScene) {
  for (const System& system : Systems()) {
    EXPECT_THAT(Validate(With(system)), IsEmpty()) << system.index();
  }
}

// A determinant of -2 eps Wtt Wnn counts as rounding, one of -8 eps Wtt Wnn does not.
TEST(ValidateSystemsTest, ADeterminantWithinRoundingIsZero) {
  const double tn = 1.0 + kEpsilon;
  EXPECT_THAT(Validate(With(PlanarContact{1.0, tn, 1.0, -1.0, -1.0})), IsEmpty());
  EXPECT_THAT(Validate(With(PlanarContact{1.0, 1.0 + 4.0 * kEpsilon, 1.0, -1.0, -1.0})), Not(IsEmpty()));
}

TEST_P(BadSystemTest, BreaksARelationWhereItsShapeAndEachNumberByItselfAreRight) {
  const Scene scene = GetParam().make();
  const std::vector<Violation> violations = Validate(scene);
  bool numbers_are_right = true;
  VisitNumbers(scene, [&](const NumberPath& /*path*/, double value, NumberRule rule) {
    numbers_are_right = numbers_are_right && Holds(value, rule);
  });
  const bool whole = violations.front().kind != ViolationKind::kShape;
  if (whole && numbers_are_right) {
    EXPECT_TRUE(HasRelations(scene));
    std::optional<SceneContact> contact;
    EXPECT_FALSE(KeepsRelations(scene, nullptr, contact));
  }
}

// A plate has a moment that is exactly the sum of the other two, and so does a rod without thickness.
TEST(ValidateSystemsTest, InertiasOfPlatesAndRodsAreValidAsRoundedToSinglePrecision) {
  const auto with = [](const std::vector<double>& inertia) {
    SpatialBody body = Body();
    body.inertia_com_kg_m2 = inertia;
    return Validate(With(body));
  };
  EXPECT_THAT(with({0.1, 0, 0, 0.2, 0, 0.1 + 0.2}), IsEmpty());
  EXPECT_THAT(with({0.1F, 0, 0, 0.2F, 0, 0.30000004F}), IsEmpty());
  EXPECT_THAT(with({1, 0, 0, 1, 0, 1e-12}), IsEmpty());
  EXPECT_THAT(with({1e300, 0, 0, 1e300, 0, 2e300}), IsEmpty());
  EXPECT_THAT(with({0.1, 0, 0, 0.2, 0, 0.30001}), SizeIs(1));
}

TEST(ValidateSystemsTest, ContactsThatDoNotApproachNeedNoRange) {
  EXPECT_THAT(Validate(With(PlanarContact{4.0, 2.0, 1.0, 1.0, 1.0})), IsEmpty());
  EXPECT_THAT(Validate(With(PlanarContact{1.0, 0.0, 0.0, 1.0, 0.0})), IsEmpty());
  EXPECT_THAT(Validate(With(SpatialContact{{1, 0, 0, 0, 0, 1}, {1.0, 0.5}, 0.0})), IsEmpty());
}

TEST(ValidateSystemsTest, AnyVelocityIsValidWhateverTheRankOfW) {
  EXPECT_THAT(Validate(With(PlanarContact{4.0, 2.0, 1.0, -2.0, -1.0})), IsEmpty());
  EXPECT_THAT(Validate(With(PlanarContact{4.0, 2.0, 1.0, 1.0, -1.0})), IsEmpty());
  EXPECT_THAT(Validate(With(PlanarContact{0.0, 0.0, 1.0, 1.0, -1.0})), IsEmpty());
  EXPECT_THAT(Validate(With(SpatialContact{{1, 2, 1, 4, 2, 1}, {-1.0, -2.0}, -1.0})), IsEmpty());
  EXPECT_THAT(Validate(With(SpatialContact{{1, 0, 0, 0, 0, 1}, {1.0, 0.5}, -1.0})), IsEmpty());
}

// An impulse at the tip does not move a link of 10^20 kg, but the tip moves with that link.
TEST(ValidateSystemsTest, ALinkTooHeavyForTheTipToFeelMovesItOutOfTheRange) {
  const Link light = {.length_m = 1.0, .mass_kg = 1.0, .com_m = 0.5, .inertia_com_kg_m2 = 0.1, .theta_rad = 0.4};
  Linkage linkage = {.links = {light, light}};
  linkage.links[0].rate_rad_s = 1.0;
  linkage.links[1].theta_rad = -0.5;
  linkage.links[1].rate_rad_s = 2.0;
  const auto reduced = [](const Linkage& system) { return std::get<PlanarReduction>(Reduce(With(system))); };
  const PlanarReduction before = reduced(linkage);
  EXPECT_THAT(Validate(With(linkage)), IsEmpty());
  linkage.links[0].inertia_com_kg_m2 = 1e20;
  const PlanarReduction after = reduced(linkage);
  EXPECT_EQ(after.u0, before.u0);
  EXPECT_EQ(after.v0, before.v0);
  ASSERT_LT(after.v0, 0.0);
  EXPECT_FALSE(VelocityIsInRange(after));
  EXPECT_TRUE(VelocityIsInRange(before));
  EXPECT_THAT(Validate(With(linkage)), IsEmpty());
}

TEST(ValidateSystemsTest, ASurfaceThatMovesWithThePendulumIsValid) {
  Scene scene = With(Pendulum{1.0, 1.0, 2.0, -1.0});
  scene.surface_velocity = SurfaceVelocity{{1.0}, 0.5};
  EXPECT_THAT(Validate(scene), IsEmpty());
}

TEST(ValidateSystemsTest, AnImpactLawReplacesTheRestitution) {
  Scene scene = With(Contact());
  scene.restitution = std::monostate();
  for (const ImpactLaw& law : {ImpactLaw(WhittakerLaw{0.5}), ImpactLaw(KaneLevinsonLaw{0.5}),
                               ImpactLaw(BrachLaw{0.5, -0.2}), ImpactLaw(ChatterjeeRuinaLaw{0.5, -0.2})}) {
    scene.impact_law = law;
    EXPECT_THAT(Validate(scene), IsEmpty()) << law.index();
  }
}

TEST(ValidateSystemsTest, SpringsGoWithTheEnergeticCoefficientAndWithAnyWhereNothingCouples) {
  Scene scene = With(Contact());
  for (const NormalSpring& spring : {NormalSpring(), NormalSpring(LinearSpring{1e6})}) {
    scene.compliance = {.tangential_ratio_squared = 1.2, .normal = spring};
    EXPECT_THAT(Validate(scene), IsEmpty());
  }
  scene.compliance = {.normal = HertzSpring{1e9}};
  EXPECT_THAT(Validate(scene), IsEmpty());
  std::get<PlanarContact>(scene.system).w_tn_per_kg = 0.0;
  scene.restitution = PoissonCoefficient{0.5};
  EXPECT_THAT(Validate(scene), IsEmpty());
  scene.restitution = std::monostate();
  scene.compliance = {.normal = HuntCrossleySpring{1e9, 1.5, 0.1}};
  EXPECT_THAT(Validate(scene), IsEmpty());
}

TEST(ValidateSystemsTest, FiniteForcesGoWithTheirSystems) {
  const auto expect_valid = [](const System& system, const FiniteForces& forces) {
    Scene scene = With(system);
    scene.finite_forces = forces;
    EXPECT_THAT(Validate(scene), IsEmpty()) << system.index();
  };
  expect_valid(Flat(), Gravity{0.0, -9.81});
  expect_valid(Chain(), Gravity{0.0, -9.81});
  expect_valid(BodyPair{PlanarPair{Flat(), Flat()}}, Gravity{0.0, -9.81});
  expect_valid(Contact(), ContactAcceleration{1.0, -9.81});
  expect_valid(Pendulum{1.0, 1.0, 1.0, -1.0}, PinMoment{-4.0});
}

TEST(ValidateSystemsTest, EveryNumberOfEverySystemMustBeFinite) {
  for (const System& system : Systems()) {
    const Scene base = With(system);
    int count = 0;
    VisitNumbers(base, [&](const NumberPath&, const double&, NumberRule) { ++count; });
    EXPECT_GE(count, 7);
    for (int wanted = 0; wanted < count; ++wanted) {
      Scene scene = base;
      std::string path;
      int i = 0;
      VisitNumbers(scene, [&](const NumberPath& number_path, double& number, NumberRule) {
        if (i++ != wanted) return;
        number = kNan;
        path = number_path.Text();
      });
      EXPECT_THAT(Validate(scene), ElementsAre(Violation{path, "= nan: must be finite"}));
    }
  }
}

}  // namespace
}  // namespace ricochet
