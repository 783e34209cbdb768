// VisitOutcomeNumbers: every number of an outcome that a sweep can ask for, with its path.
//
// A number that was not computed is unset, and is no number: a contact that is not followed in time has no duration, an
// impact law no phases. VisitOutcomeFields visits the place of such a number, too. The lists of an outcome have the same
// lengths for every impact of one scene, so that all its outcomes have the same places in the same order.

#ifndef RICOCHET_OUTCOME_NUMBERS_H_
#define RICOCHET_OUTCOME_NUMBERS_H_

#include <cstddef>
#include <optional>
#include <string_view>

#include "ricochet/number_path.h"
#include "ricochet/outcome.h"

namespace ricochet {

// True for an error, which is infinite where nothing is known. All other numbers of an answer are finite.
inline bool MayBeInfinite(const NumberPath& path) {
  const std::string_view prefix = path.prefix;
  return prefix == "accuracy" || prefix == "errors";
}

// Calls visit(name, error) for every error, set or not.
template <typename Errors, typename Visitor>
void VisitErrors(Errors& errors, const Visitor& visit) {
  visit("newton", errors.newton);
  visit("poisson", errors.poisson);
  visit("energetic", errors.energetic);
  visit("tangential", errors.tangential);
  visit("tangential_m_s", errors.tangential_m_s);
  visit("normal_m_s", errors.normal_m_s);
  visit("normal_compression_n_s", errors.normal_compression_n_s);
  visit("normal_total_n_s", errors.normal_total_n_s);
  visit("tangential_n_s", errors.tangential_n_s);
  visit("normal_compression_j", errors.normal_compression_j);
  visit("normal_restitution_j", errors.normal_restitution_j);
  visit("tangential_compression_j", errors.tangential_compression_j);
  visit("tangential_restitution_j", errors.tangential_restitution_j);
  visit("energy_change_j", errors.energy_change_j);
}

// Calls visit(path, number) for the place of every number; `number` is a const double*, null if it is unset. Paths start
// at the outcome: "coefficients.newton", "bodies_after[0].linear_m_s[1]".
template <typename Visitor>
void VisitOutcomeFields(const Outcome& outcome, const Visitor& visit) {
  const auto one = [&visit](const char* prefix, const char* name, const double& number) {
    visit(NumberPath{.prefix = prefix, .name = name}, &number);
  };
  const auto if_known = [&visit](const char* prefix, const char* name, const std::optional<double>& number) {
    visit(NumberPath{.prefix = prefix, .name = name}, number.has_value() ? &*number : nullptr);
  };
  const auto each = [&visit](const char* prefix, int entry, const char* name, const Components& numbers) {
    for (size_t i = 0; i < numbers.size(); ++i) {
      visit(NumberPath{prefix, entry, name, static_cast<int>(i)}, &numbers[i]);
    }
  };
  one("coefficients", "newton", outcome.coefficients.newton);
  if_known("coefficients", "poisson", outcome.coefficients.poisson);
  if_known("coefficients", "energetic", outcome.coefficients.energetic);
  one("coefficients", "tangential", outcome.coefficients.tangential);
  each("", -1, "rates_after_rad_s", outcome.rates_after_rad_s);
  for (size_t i = 0; i < outcome.bodies_after.size(); ++i) {
    each("bodies_after", static_cast<int>(i), "linear_m_s", outcome.bodies_after[i].linear_m_s);
    each("bodies_after", static_cast<int>(i), "angular_rad_s", outcome.bodies_after[i].angular_rad_s);
  }
  each("contact_velocity_after", -1, "tangential_m_s", outcome.contact_velocity_after.tangential_m_s);
  one("contact_velocity_after", "normal_m_s", outcome.contact_velocity_after.normal_m_s);
  if_known("impulse", "normal_compression_n_s", outcome.impulse.normal_compression_n_s);
  one("impulse", "normal_total_n_s", outcome.impulse.normal_total_n_s);
  each("impulse", -1, "tangential_n_s", outcome.impulse.tangential_n_s);
  if_known("work", "normal_compression_j", outcome.work.normal_compression_j);
  if_known("work", "normal_restitution_j", outcome.work.normal_restitution_j);
  if_known("work", "tangential_compression_j", outcome.work.tangential_compression_j);
  if_known("work", "tangential_restitution_j", outcome.work.tangential_restitution_j);
  one("work", "normal_total_j", outcome.work.normal_total_j);
  one("work", "tangential_total_j", outcome.work.tangential_total_j);
  one("work", "friction_dissipation_j", outcome.work.friction_dissipation_j);
  one("work", "tangential_spring_j", outcome.work.tangential_spring_j);
  one("", "energy_change_j", outcome.energy_change_j);
  one("effective", "kinetic", outcome.effective.kinetic_friction);
  one("effective", "static", outcome.effective.static_friction);
  if_known("effective", "restitution", outcome.effective.restitution);
  one("accuracy", "relative_error", outcome.accuracy.relative_error);
  const ContactDuration* const contact = outcome.contact.has_value() ? &*outcome.contact : nullptr;
  const auto of_contact = [&visit, contact](const char* name, double ContactDuration::*number) {
    visit(NumberPath{.prefix = "contact", .name = name}, contact == nullptr ? nullptr : &(contact->*number));
  };
  of_contact("duration_s", &ContactDuration::duration_s);
  of_contact("peak_normal_n", &ContactDuration::peak_normal_n);
  of_contact("peak_tangential_n", &ContactDuration::peak_tangential_n);
  of_contact("indentation_m", &ContactDuration::indentation_m);
  VisitErrors(outcome.errors,
              [&if_known](const char* name, const std::optional<double>& error) { if_known("errors", name, error); });
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
