// kSceneNumbers: every number of a scene with its name, its member and the rule that it keeps by itself.
//
// VisitNumbers gives them their paths. Validate, the axes of sweeps, the ranges of bounds and the limits on the sizes
// of lists all read this table, so that a new number is added here only.

#ifndef RICOCHET_CORE_SCENE_NUMBERS_H_
#define RICOCHET_CORE_SCENE_NUMBERS_H_

#include <cmath>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/multi_contact.h"
#include "ricochet/number_path.h"
#include "ricochet/scene.h"

namespace ricochet {

// Below this ratio doubles do not resolve the oscillation along the surface (core/models/compliant/compliant.h).
inline constexpr double kLeastTangentialRatioSquared = 1e-9;
// Above this ratio the tangential spring is too soft to have an effect that doubles resolve.
inline constexpr double kMostTangentialRatioSquared = 1e9;

// Each rule requires in addition that the number is finite.
enum class NumberRule {
  kFinite,
  kPositive,
  kNotNegative,
  kUnitInterval,
  kPlusMinusOne,
  kOneToFour,
  kRatioSquared,
  kAngle,     // Any angle in radians; one beyond a full turn may be meant in degrees.
  kHalfTurn,  // An angle above 0 and below pi.
};

// The numbers that keep a rule, without `least` if the range is open, and the rule in words.
struct NumberRange {
  double least, most;
  bool is_open;
  const char* words;
};

inline constexpr double kLargestNumber = std::numeric_limits<double>::max();
// In the order of NumberRule. Both ends are finite, so that NaN and infinity break every rule.
inline constexpr NumberRange kNumberRanges[] = {
    {-kLargestNumber, kLargestNumber, false, "be finite"},
    {0.0, kLargestNumber, true, "be > 0"},
    {0.0, kLargestNumber, false, "be >= 0"},
    {0.0, 1.0, false, "be in [0, 1]"},
    {-1.0, 1.0, false, "be in [-1, 1]"},
    {1.0, 4.0, false, "be in [1, 4]"},
    {kLeastTangentialRatioSquared, kMostTangentialRatioSquared, false, "be in [1e-9, 1e9]"},
    {-kLargestNumber, kLargestNumber, false, "be finite"},
    {0.0, std::numbers::pi, true, "be in (0, pi), in radians"}};  // The double that is called pi lies below pi.

static_assert(std::size(kNumberRanges) == static_cast<size_t>(NumberRule::kHalfTurn) + 1);

constexpr const NumberRange& RangeOf(NumberRule rule) { return kNumberRanges[static_cast<size_t>(rule)]; }

inline bool Holds(double value, NumberRule rule) {
  const NumberRange& range = RangeOf(rule);
  return (range.is_open ? value > range.least : value >= range.least) && value <= range.most;
}

// A number of a part of the scene, an optional number of it, or a list of numbers that keep one rule.
template <typename Part, typename Value>
struct SceneNumber {
  using Owner = Part;

  constexpr SceneNumber(const char* its_name, Value Part::*its_member, NumberRule its_rule = NumberRule::kFinite)
      : name(its_name), member(its_member), rule(its_rule) {}

  const char* name;
  Value Part::*member;
  NumberRule rule;
};

// Every number of every part of a scene, or of a scene of several contacts, part by part in the order of the proto's
// fields. Validate checks in addition the rules between numbers.
inline constexpr auto kSceneNumbers = std::tuple{
    SceneNumber("inertia_kg_m2", &Pendulum::inertia_kg_m2, NumberRule::kPositive),
    SceneNumber("a_m", &Pendulum::a_m, NumberRule::kPositive),
    SceneNumber("b_m", &Pendulum::b_m),
    SceneNumber("omega_minus_rad_s", &Pendulum::omega_minus_rad_s),
    SceneNumber("mass_kg", &PlanarBody::mass_kg, NumberRule::kPositive),
    SceneNumber("inertia_com_kg_m2", &PlanarBody::inertia_com_kg_m2, NumberRule::kPositive),
    SceneNumber("offset_t_m", &PlanarBody::offset_t_m),
    SceneNumber("offset_n_m", &PlanarBody::offset_n_m),
    SceneNumber("velocity_t_m_s", &PlanarBody::velocity_t_m_s),
    SceneNumber("velocity_n_m_s", &PlanarBody::velocity_n_m_s),
    SceneNumber("rate_rad_s", &PlanarBody::rate_rad_s),
    SceneNumber("mass_kg", &SpatialBody::mass_kg, NumberRule::kPositive),
    SceneNumber("inertia_com_kg_m2", &SpatialBody::inertia_com_kg_m2),
    SceneNumber("offset_m", &SpatialBody::offset_m),
    SceneNumber("linear_m_s", &SpatialBody::linear_m_s),
    SceneNumber("angular_rad_s", &SpatialBody::angular_rad_s),
    SceneNumber("length_m", &Link::length_m, NumberRule::kPositive),
    SceneNumber("mass_kg", &Link::mass_kg, NumberRule::kPositive),
    SceneNumber("com_m", &Link::com_m),
    SceneNumber("inertia_com_kg_m2", &Link::inertia_com_kg_m2, NumberRule::kPositive),
    SceneNumber("theta_rad", &Link::theta_rad, NumberRule::kAngle),
    SceneNumber("rate_rad_s", &Link::rate_rad_s),
    SceneNumber("w_tt_per_kg", &PlanarContact::w_tt_per_kg, NumberRule::kNotNegative),
    SceneNumber("w_tn_per_kg", &PlanarContact::w_tn_per_kg),
    SceneNumber("w_nn_per_kg", &PlanarContact::w_nn_per_kg, NumberRule::kNotNegative),
    SceneNumber("tangential_m_s", &PlanarContact::tangential_m_s),
    SceneNumber("normal_m_s", &PlanarContact::normal_m_s),
    SceneNumber("w_per_kg", &SpatialContact::w_per_kg),
    SceneNumber("tangential_m_s", &SpatialContact::tangential_m_s),
    SceneNumber("normal_m_s", &SpatialContact::normal_m_s),
    SceneNumber("mass_matrix", &Mechanism::mass_matrix),
    SceneNumber("jacobian", &Mechanism::jacobian),
    SceneNumber("rates", &Mechanism::rates),
    SceneNumber("kinetic_coefficient", &Friction::kinetic_coefficient, NumberRule::kNotNegative),
    SceneNumber("static_coefficient", &Friction::static_coefficient, NumberRule::kNotNegative),
    SceneNumber("alpha", &PowerLaw::alpha),
    SceneNumber("exponent", &PowerLaw::exponent, NumberRule::kNotNegative),
    SceneNumber("speed_m_s", &SpeedTable::speed_m_s, NumberRule::kNotNegative),
    SceneNumber("factor", &SpeedTable::factor),
    SceneNumber("newton", &NewtonCoefficient::value, NumberRule::kNotNegative),
    SceneNumber("poisson", &PoissonCoefficient::value, NumberRule::kNotNegative),
    SceneNumber("energetic", &EnergeticCoefficient::value, NumberRule::kUnitInterval),
    SceneNumber("tangential_m_s", &SurfaceVelocity::tangential_m_s),
    SceneNumber("normal_m_s", &SurfaceVelocity::normal_m_s),
    SceneNumber("e", &WhittakerLaw::e, NumberRule::kNotNegative),
    SceneNumber("e", &KaneLevinsonLaw::e, NumberRule::kNotNegative),
    SceneNumber("e", &BrachLaw::e, NumberRule::kNotNegative),
    SceneNumber("mu_hat", &BrachLaw::mu_hat),
    SceneNumber("e", &ChatterjeeRuinaLaw::e, NumberRule::kNotNegative),
    SceneNumber("e_t", &ChatterjeeRuinaLaw::e_t, NumberRule::kPlusMinusOne),
    SceneNumber("tangential_ratio_squared", &Compliance::tangential_ratio_squared, NumberRule::kRatioSquared),
    SceneNumber("stiffness_n_m", &LinearSpring::stiffness_n_m, NumberRule::kPositive),
    SceneNumber("stiffness_n_m1_5", &HertzSpring::stiffness_n_m1_5, NumberRule::kPositive),
    SceneNumber("stiffness_n_m_p", &HuntCrossleySpring::stiffness_n_m_p, NumberRule::kPositive),
    SceneNumber("exponent", &HuntCrossleySpring::exponent, NumberRule::kOneToFour),
    SceneNumber("damping_s_m", &HuntCrossleySpring::damping_s_m, NumberRule::kNotNegative),
    SceneNumber("tangential_m_s2", &Gravity::tangential_m_s2),
    SceneNumber("normal_m_s2", &Gravity::normal_m_s2),
    SceneNumber("moment_n_m", &PinMoment::moment_n_m),
    SceneNumber("tangential_m_s2", &ContactAcceleration::tangential_m_s2),
    SceneNumber("normal_m_s2", &ContactAcceleration::normal_m_s2),
    SceneNumber("w_per_kg", &ContactMatrix::w_per_kg),
    SceneNumber("velocity_m_s", &ContactMatrix::velocity_m_s),
    SceneNumber("mass_kg", &FreeBody::mass_kg, NumberRule::kPositive),
    SceneNumber("inertia_com_kg_m2", &FreeBody::inertia_com_kg_m2),
    SceneNumber("position_m", &FreeBody::position_m),
    SceneNumber("linear_m_s", &FreeBody::linear_m_s),
    SceneNumber("angular_rad_s", &FreeBody::angular_rad_s),
    SceneNumber("friction", &MultiContactPoint::friction, NumberRule::kNotNegative),
    SceneNumber("energetic", &MultiContactPoint::energetic, NumberRule::kUnitInterval),
    SceneNumber("relative_stiffness", &MultiContactPoint::relative_stiffness, NumberRule::kPositive),
    SceneNumber("point_m", &MultiContactPoint::point_m),
    SceneNumber("normal", &MultiContactPoint::normal)};

// Says how many numbers of the table a part has.
template <typename Part>
inline constexpr size_t kNumbersOf = std::apply(
    [](const auto&... number) {
      return (size_t{std::is_same_v<Part, typename std::remove_cvref_t<decltype(number)>::Owner>} + ...);
    },
    kSceneNumbers);

// The prefix of the numbers of a part that stands in one place of a scene only.
constexpr const char* PrefixOf(const Pendulum& /*part*/) { return "pendulum"; }
constexpr const char* PrefixOf(const PlanarBody& /*part*/) { return "planar_body"; }
constexpr const char* PrefixOf(const SpatialBody& /*part*/) { return "spatial_body"; }
constexpr const char* PrefixOf(const PlanarContact& /*part*/) { return "planar_contact"; }
constexpr const char* PrefixOf(const SpatialContact& /*part*/) { return "spatial_contact"; }
constexpr const char* PrefixOf(const Mechanism& /*part*/) { return "mechanism"; }
constexpr const char* PrefixOf(const Friction& /*part*/) { return "friction"; }
constexpr const char* PrefixOf(const NewtonCoefficient& /*part*/) { return "restitution"; }
constexpr const char* PrefixOf(const PoissonCoefficient& /*part*/) { return "restitution"; }
constexpr const char* PrefixOf(const EnergeticCoefficient& /*part*/) { return "restitution"; }
constexpr const char* PrefixOf(const SurfaceVelocity& /*part*/) { return "surface_velocity"; }
constexpr const char* PrefixOf(const WhittakerLaw& /*part*/) { return "whittaker"; }
constexpr const char* PrefixOf(const KaneLevinsonLaw& /*part*/) { return "kane_levinson"; }
constexpr const char* PrefixOf(const BrachLaw& /*part*/) { return "brach"; }
constexpr const char* PrefixOf(const ChatterjeeRuinaLaw& /*part*/) { return "chatterjee_ruina"; }
constexpr const char* PrefixOf(const Compliance& /*part*/) { return "compliance"; }
constexpr const char* PrefixOf(const LinearSpring& /*part*/) { return "compliance.linear"; }
constexpr const char* PrefixOf(const HertzSpring& /*part*/) { return "compliance.hertz"; }
constexpr const char* PrefixOf(const HuntCrossleySpring& /*part*/) { return "compliance.hunt_crossley"; }
constexpr const char* PrefixOf(const Gravity& /*part*/) { return "gravity"; }
constexpr const char* PrefixOf(const PinMoment& /*part*/) { return "pin_moment"; }
constexpr const char* PrefixOf(const ContactAcceleration& /*part*/) { return "contact_acceleration"; }

// This namespace implements VisitNumbers. T is U or const U.
namespace numbers {

template <typename T, typename U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

template <typename Visitor>
void VisitOne(const NumberPath& path, Is<double> auto& number, NumberRule rule, Visitor& visit) {
  visit(path, number, rule);
}

template <typename Visitor>
void VisitOne(const NumberPath& path, Is<std::optional<double>> auto& number, NumberRule rule, Visitor& visit) {
  if (number.has_value()) visit(path, *number, rule);
}

template <typename Visitor>
void VisitOne(NumberPath path, Is<std::vector<double>> auto& list, NumberRule rule, Visitor& visit) {
  for (size_t i = 0; i < list.size(); ++i) {
    path.index = static_cast<int>(i);
    visit(path, list[i], rule);
  }
}

// Visits the number at a place of the table if it is one of `part`. Its rule is a constant for the visitor.
template <size_t kPlace, typename Part, typename Visitor>
void VisitOwn(Part& part, const char* prefix, int entry, Visitor& visit) {
  constexpr auto kNumber = std::get<kPlace>(kSceneNumbers);
  if constexpr (Is<Part, typename decltype(kNumber)::Owner>) {
    VisitOne(NumberPath{prefix, entry, kNumber.name}, part.*kNumber.member, kNumber.rule, visit);
  }
}

// Visits the numbers of a part. Each part has some, so that a new one does not compile until it has them in the table.
template <typename Part, typename Visitor>
void VisitPart(Part& part, const char* prefix, Visitor& visit, int entry = -1) {
  const auto visit_all = [&]<size_t... kPlace>(std::index_sequence<kPlace...> /*places*/) {
    static_assert((Is<Part, typename std::tuple_element_t<kPlace, decltype(kSceneNumbers)>::Owner> || ...));
    (VisitOwn<kPlace>(part, prefix, entry, visit), ...);
  };
  visit_all(std::make_index_sequence<std::tuple_size_v<decltype(kSceneNumbers)>>());
}

template <typename Part, typename Visitor>
void Visit(Part& part, Visitor& visit) {
  VisitPart(part, PrefixOf(part), visit);
}

template <Is<std::monostate> Unset, typename Visitor>
void Visit(Unset& /*unset*/, Visitor& /*visit*/) {}

template <Is<BodyPair> Pair, typename Visitor>
void Visit(Pair& pair, Visitor& visit) {
  const auto visit_bodies = [&visit](auto& bodies, const char* body_1, const char* body_2) {
    VisitPart(bodies.body_1, body_1, visit);
    VisitPart(bodies.body_2, body_2, visit);
  };
  if (auto* const planar = std::get_if<PlanarPair>(&pair.bodies)) {
    visit_bodies(*planar, "body_pair.planar.body_1", "body_pair.planar.body_2");
  } else if (auto* const spatial = std::get_if<SpatialPair>(&pair.bodies)) {
    visit_bodies(*spatial, "body_pair.spatial.body_1", "body_pair.spatial.body_2");
  }
}

template <Is<Linkage> SomeLinkage, typename Visitor>
void Visit(SomeLinkage& linkage, Visitor& visit) {
  int entry = 0;
  for (auto& link : linkage.links) VisitPart(link, "linkage.links", visit, entry++);
}

template <typename Visitor>
void VisitAlternative(auto& variant, Visitor& visit) {
  std::visit([&visit](auto& alternative) { Visit(alternative, visit); }, variant);
}

template <typename Visitor>
void VisitBySpeed(auto& dependence, const char* power_law, const char* table, Visitor& visit) {
  if (!dependence.has_value()) return;
  if (auto* const law = std::get_if<PowerLaw>(&*dependence)) VisitPart(*law, power_law, visit);
  if (auto* const list = std::get_if<SpeedTable>(&*dependence)) VisitPart(*list, table, visit);
}

}  // namespace numbers

// Calls visit(path, number, rule) for every number of the scene, in the order of the proto's fields. `number` is a
// reference to const if the scene is const. A oneof that is not set has no numbers.
template <typename SomeScene, typename Visitor>
void VisitNumbers(SomeScene& scene, Visitor visit) {
  numbers::VisitAlternative(scene.system, visit);
  numbers::Visit(scene.friction, visit);
  numbers::VisitBySpeed(scene.friction.by_speed, "friction.by_speed.power_law", "friction.by_speed.table", visit);
  numbers::VisitAlternative(scene.restitution, visit);
  numbers::VisitBySpeed(scene.restitution_by_speed, "restitution.by_speed.power_law", "restitution.by_speed.table",
                        visit);
  if (scene.surface_velocity.has_value()) numbers::Visit(*scene.surface_velocity, visit);
  numbers::VisitAlternative(scene.impact_law, visit);
  if (scene.compliance.has_value()) {
    numbers::Visit(*scene.compliance, visit);
    numbers::VisitAlternative(scene.compliance->normal, visit);
  }
  numbers::VisitAlternative(scene.finite_forces, visit);
}

// Returns the number of the scene at a path; nothing if the scene states none there.
inline std::optional<double> NumberAt(const Scene& scene, const std::string& path) {
  std::optional<double> number;
  VisitNumbers(scene, [&](const NumberPath& at, double value, NumberRule /*rule*/) {
    if (at.Text() == path) number = value;
  });
  return number;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_NUMBERS_H_
