// kOutcomeNumbers: every number of an outcome that a sweep can ask for, with its name and its member.
// VisitOutcomeNumbers gives them their paths.
//
// A number that was not computed is unset, and is no number: a contact that is not followed in time has no duration, an
// impact law no phases. VisitOutcomeFields visits the place of such a number, too. The lists of an outcome have the
// same lengths for every impact of one scene, so that all its outcomes have the same places in the same order.

#ifndef RICOCHET_OUTCOME_NUMBERS_H_
#define RICOCHET_OUTCOME_NUMBERS_H_

#include <cstddef>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "ricochet/number_path.h"
#include "ricochet/outcome.h"

namespace ricochet {

// True for an error, which is infinite where nothing is known. All other numbers of an answer are finite.
inline bool MayBeInfinite(const NumberPath& path) {
  const std::string_view prefix = path.prefix;
  return prefix == "accuracy" || prefix == "errors";
}

// A number of a part of an outcome, one that may be unset, or a list of numbers.
template <typename Part, typename Value>
struct OutcomeNumber {
  constexpr OutcomeNumber(const char* its_name, Value Part::*its_member) : name(its_name), member(its_member) {}

  const char* name;
  Value Part::*member;
};

// Every number of every part of an outcome.
inline constexpr auto kOutcomeNumbers =
    std::tuple{OutcomeNumber("newton", &Coefficients::newton),
               OutcomeNumber("poisson", &Coefficients::poisson),
               OutcomeNumber("energetic", &Coefficients::energetic),
               OutcomeNumber("tangential", &Coefficients::tangential),
               OutcomeNumber("linear_m_s", &BodyVelocity::linear_m_s),
               OutcomeNumber("angular_rad_s", &BodyVelocity::angular_rad_s),
               OutcomeNumber("tangential_m_s", &ContactVelocity::tangential_m_s),
               OutcomeNumber("normal_m_s", &ContactVelocity::normal_m_s),
               OutcomeNumber("normal_compression_n_s", &Impulse::normal_compression_n_s),
               OutcomeNumber("normal_total_n_s", &Impulse::normal_total_n_s),
               OutcomeNumber("tangential_n_s", &Impulse::tangential_n_s),
               OutcomeNumber("normal_compression_j", &WorkLedger::normal_compression_j),
               OutcomeNumber("normal_restitution_j", &WorkLedger::normal_restitution_j),
               OutcomeNumber("tangential_compression_j", &WorkLedger::tangential_compression_j),
               OutcomeNumber("tangential_restitution_j", &WorkLedger::tangential_restitution_j),
               OutcomeNumber("normal_total_j", &WorkLedger::normal_total_j),
               OutcomeNumber("tangential_total_j", &WorkLedger::tangential_total_j),
               OutcomeNumber("friction_dissipation_j", &WorkLedger::friction_dissipation_j),
               OutcomeNumber("tangential_spring_j", &WorkLedger::tangential_spring_j),
               OutcomeNumber("kinetic", &EffectiveCoefficients::kinetic_friction),
               OutcomeNumber("static", &EffectiveCoefficients::static_friction),
               OutcomeNumber("restitution", &EffectiveCoefficients::restitution),
               OutcomeNumber("relative_error", &Accuracy::relative_error),
               OutcomeNumber("duration_s", &ContactDuration::duration_s),
               OutcomeNumber("peak_normal_n", &ContactDuration::peak_normal_n),
               OutcomeNumber("peak_tangential_n", &ContactDuration::peak_tangential_n),
               OutcomeNumber("indentation_m", &ContactDuration::indentation_m),
               OutcomeNumber("newton", &NumberErrors::newton),
               OutcomeNumber("poisson", &NumberErrors::poisson),
               OutcomeNumber("energetic", &NumberErrors::energetic),
               OutcomeNumber("tangential", &NumberErrors::tangential),
               OutcomeNumber("tangential_m_s", &NumberErrors::tangential_m_s),
               OutcomeNumber("normal_m_s", &NumberErrors::normal_m_s),
               OutcomeNumber("normal_compression_n_s", &NumberErrors::normal_compression_n_s),
               OutcomeNumber("normal_total_n_s", &NumberErrors::normal_total_n_s),
               OutcomeNumber("tangential_n_s", &NumberErrors::tangential_n_s),
               OutcomeNumber("normal_compression_j", &NumberErrors::normal_compression_j),
               OutcomeNumber("normal_restitution_j", &NumberErrors::normal_restitution_j),
               OutcomeNumber("tangential_compression_j", &NumberErrors::tangential_compression_j),
               OutcomeNumber("tangential_restitution_j", &NumberErrors::tangential_restitution_j),
               OutcomeNumber("energy_change_j", &NumberErrors::energy_change_j),
               OutcomeNumber("rates_after", &NumberErrors::rates_after),
               OutcomeNumber("momentum_change", &NumberErrors::momentum_change)};

// Calls visit(name, value) for the numbers of `part`, which may be const: each a double, an optional or Components.
template <typename Part, typename Visitor>
void VisitOutcomePart(Part& part, const Visitor& visit) {
  const auto visit_own = [&]<typename Owner, typename Value>(const OutcomeNumber<Owner, Value>& number) {
    if constexpr (std::is_same_v<Owner, std::remove_const_t<Part>>) visit(number.name, part.*number.member);
  };
  std::apply([&](const auto&... number) { (visit_own(number), ...); }, kOutcomeNumbers);
}

// Calls visit(path, number) for the place of every number; `number` is a const double*, null if it is unset. Paths
// start at the outcome: "coefficients.newton", "bodies_after[0].linear_m_s[1]".
template <typename Visitor>
void VisitOutcomeFields(const Outcome& outcome, const Visitor& visit) {
  const auto visit_value = [&visit]<typename Value>(NumberPath path, const Value& value) {
    if constexpr (std::is_same_v<Value, double>) {
      visit(path, &value);
    } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
      visit(path, value.has_value() ? &*value : nullptr);
    } else {
      for (size_t i = 0; i < value.size(); ++i) {
        path.index = static_cast<int>(i);
        visit(path, &value[i]);
      }
    }
  };
  const auto visit_part = [&visit_value](const char* prefix, const auto& part, int entry = -1) {
    VisitOutcomePart(part, [&](const char* name, const auto& value) {
      visit_value(NumberPath{prefix, entry, name}, value);
    });
  };
  visit_part("coefficients", outcome.coefficients);
  visit_value({.name = "rates_after_rad_s"}, outcome.rates_after_rad_s);
  int body = 0;
  for (const BodyVelocity& velocity : outcome.bodies_after) visit_part("bodies_after", velocity, body++);
  visit_part("contact_velocity_after", outcome.contact_velocity_after);
  visit_part("impulse", outcome.impulse);
  visit_part("work", outcome.work);
  visit_value({.name = "energy_change_j"}, outcome.energy_change_j);
  visit_value({.name = "rates_after"}, outcome.rates_after);
  visit_value({.name = "momentum_change"}, outcome.momentum_change);
  visit_part("effective", outcome.effective);
  visit_part("accuracy", outcome.accuracy);
  const bool has_contact = outcome.contact.has_value();
  const ContactDuration none;
  VisitOutcomePart(has_contact ? *outcome.contact : none, [&](const char* name, const double& number) {
    visit(NumberPath{.prefix = "contact", .name = name}, has_contact ? &number : nullptr);
  });
  visit_part("errors", outcome.errors);
}

// Calls visit(path, number) for every number that is set.
template <typename Visitor>
void VisitOutcomeNumbers(const Outcome& outcome, const Visitor& visit) {
  VisitOutcomeFields(outcome, [&visit](const NumberPath& path, const double* number) {
    if (number != nullptr) visit(path, *number);
  });
}

}  // namespace ricochet

#endif  // RICOCHET_OUTCOME_NUMBERS_H_
