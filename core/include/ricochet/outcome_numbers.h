// VisitOutcomeNumbers: every number of an outcome that a sweep can ask for, with its path.
//
// The lists of an outcome have the same lengths for every impact of one scene, and the same numbers are unset under its
// impact law, so that all its outcomes have their numbers in the same order.

#ifndef RICOCHET_OUTCOME_NUMBERS_H_
#define RICOCHET_OUTCOME_NUMBERS_H_

#include <cstddef>
#include <optional>

#include "ricochet/number_path.h"
#include "ricochet/outcome.h"

namespace ricochet {

// Calls visit(path, number) for every number that is set. Paths start at the outcome: "coefficients.newton",
// "bodies_after[0].linear_m_s[1]".
template <typename Visitor>
void VisitOutcomeNumbers(const Outcome& outcome, const Visitor& visit) {
  const auto one = [&visit](const char* prefix, const char* name, double number) {
    visit(NumberPath{.prefix = prefix, .name = name}, number);
  };
  const auto if_known = [&one](const char* prefix, const char* name, const std::optional<double>& number) {
    if (number.has_value()) one(prefix, name, *number);
  };
  const auto each = [&visit](const char* prefix, int entry, const char* name, const Components& numbers) {
    for (size_t i = 0; i < numbers.size(); ++i) {
      visit(NumberPath{prefix, entry, name, static_cast<int>(i)}, numbers[i]);
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
  one("effective", "restitution", outcome.effective.restitution);
  one("accuracy", "relative_error", outcome.accuracy.relative_error);
  const ContactDuration none;
  const ContactDuration& contact = outcome.contact.has_value() ? *outcome.contact : none;
  one("contact", "duration_s", contact.duration_s);
  one("contact", "peak_normal_n", contact.peak_normal_n);
  one("contact", "peak_tangential_n", contact.peak_tangential_n);
  one("contact", "indentation_m", contact.indentation_m);
}

}  // namespace ricochet

#endif  // RICOCHET_OUTCOME_NUMBERS_H_
