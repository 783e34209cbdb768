#include "core/fit/measured_velocity.h"

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/contact/moved_contact.h"
#include "core/numerics/elementary.h"
#include "core/scene/system_velocities.h"

namespace ricochet::fit {
namespace {

// Returns the places, among the problem's numbers, of those that a row measured at the paths, if it measured all.
std::vector<size_t> MeasuredAtAll(const Problem& problem, size_t row, const std::vector<std::string>& paths) {
  std::vector<size_t> places;
  for (const std::string& path : paths) {
    size_t i = problem.first_number[row];
    const size_t end = problem.first_number[row + 1];
    while (i < end && problem.batch.columns[problem.numbers[i].column] != path) ++i;
    if (i == end) return {};
    places.push_back(i);
  }
  return places;
}

std::optional<MeasuredVelocity> VelocityOfContact(const Problem& problem, const std::vector<double>& sigmas, size_t row,
                                                  const Scene& scene) {
  std::vector<std::string> paths;
  for (size_t i = 0; i < TangentialDirections(scene.system); ++i) {
    paths.push_back(absl::StrCat("contact_velocity_after.tangential_m_s[", i, "]"));
  }
  paths.emplace_back("contact_velocity_after.normal_m_s");
  const std::vector<size_t> places = MeasuredAtAll(problem, row, paths);
  if (places.empty()) return std::nullopt;
  MeasuredVelocity measured;
  for (const size_t place : places) {
    measured.sigma = std::max(measured.sigma, sigmas[place]);
    measured.velocity.tangential_m_s.push_back(problem.numbers[place].value);
  }
  measured.velocity.tangential_m_s.pop_back();
  measured.velocity.normal_m_s = problem.numbers[places.back()].value;
  return measured;
}

// The contact velocity is linear in the rates, so that the sigma of a rate changes it as the rate itself would.
std::optional<MeasuredVelocity> VelocityByRates(const Problem& problem, const std::vector<double>& sigmas, size_t row,
                                                const Scene& scene) {
  const std::vector<size_t> places = MeasuredAtAll(problem, row, SystemVelocityPaths(scene.system));
  if (places.empty()) return std::nullopt;
  std::vector<double> rates;
  for (const size_t place : places) rates.push_back(problem.numbers[place].value);
  MeasuredVelocity measured = {.velocity = ContactVelocityAt(scene, rates)};
  const Components& tangential = measured.velocity.tangential_m_s;
  std::vector<double> spread(tangential.size() + 1);
  for (size_t k = 0; k < rates.size(); ++k) {
    const double rate = rates[k];
    rates[k] += sigmas[places[k]];
    const ContactVelocity beside = ContactVelocityAt(scene, rates);
    rates[k] = rate;
    for (size_t i = 0; i < tangential.size(); ++i) {
      spread[i] = Hypot(spread[i], beside.tangential_m_s[i] - tangential[i]);
    }
    spread.back() = Hypot(spread.back(), beside.normal_m_s - measured.velocity.normal_m_s);
  }
  measured.sigma = *std::max_element(spread.begin(), spread.end());
  return measured;
}

}  // namespace

std::optional<MeasuredVelocity> VelocityOf(const Problem& problem, const std::vector<double>& sigmas, size_t row,
                                           const Scene& scene) {
  std::optional<MeasuredVelocity> measured = VelocityOfContact(problem, sigmas, row, scene);
  return measured.has_value() ? measured : VelocityByRates(problem, sigmas, row, scene);
}

}  // namespace ricochet::fit
