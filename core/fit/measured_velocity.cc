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

// The number that a row measured at a path.
const Number* MeasuredAt(const Problem& problem, size_t row, const std::string& path) {
  for (size_t i = problem.first_number[row]; i < problem.first_number[row + 1]; ++i) {
    if (problem.batch.columns[problem.numbers[i].column] == path) return &problem.numbers[i];
  }
  return nullptr;
}

// The numbers that a row measured at the paths, if it measured all.
std::vector<const Number*> MeasuredAtAll(const Problem& problem, size_t row, const std::vector<std::string>& paths) {
  std::vector<const Number*> numbers;
  for (const std::string& path : paths) {
    const Number* const number = MeasuredAt(problem, row, path);
    if (number == nullptr) return {};
    numbers.push_back(number);
  }
  return numbers;
}

std::optional<MeasuredVelocity> VelocityOfContact(const Problem& problem, size_t row, const Scene& scene) {
  std::vector<std::string> paths;
  for (size_t i = 0; i < TangentialDirections(scene.system); ++i) {
    paths.push_back(absl::StrCat("contact_velocity_after.tangential_m_s[", i, "]"));
  }
  paths.emplace_back("contact_velocity_after.normal_m_s");
  const std::vector<const Number*> numbers = MeasuredAtAll(problem, row, paths);
  if (numbers.empty()) return std::nullopt;
  MeasuredVelocity measured;
  for (const Number* const number : numbers) measured.sigma = std::max(measured.sigma, number->sigma);
  for (size_t i = 0; i + 1 < numbers.size(); ++i) measured.velocity.tangential_m_s.push_back(numbers[i]->value);
  measured.velocity.normal_m_s = numbers.back()->value;
  return measured;
}

// The contact's velocity is linear in the rates, so that each sigma changes it by what its rate does.
std::optional<MeasuredVelocity> VelocityByRates(const Problem& problem, size_t row, const Scene& scene) {
  const std::vector<const Number*> numbers = MeasuredAtAll(problem, row, SystemVelocityPaths(scene.system));
  if (numbers.empty()) return std::nullopt;
  std::vector<double> rates;
  for (const Number* const number : numbers) rates.push_back(number->value);
  MeasuredVelocity measured = {.velocity = ContactVelocityAt(scene, rates)};
  const Components& tangential = measured.velocity.tangential_m_s;
  std::vector<double> sigmas(tangential.size() + 1);
  for (size_t k = 0; k < numbers.size(); ++k) {
    rates[k] = numbers[k]->value + numbers[k]->sigma;
    const ContactVelocity beside = ContactVelocityAt(scene, rates);
    rates[k] = numbers[k]->value;
    for (size_t i = 0; i < tangential.size(); ++i) {
      sigmas[i] = Hypot(sigmas[i], beside.tangential_m_s[i] - tangential[i]);
    }
    sigmas.back() = Hypot(sigmas.back(), beside.normal_m_s - measured.velocity.normal_m_s);
  }
  measured.sigma = *std::max_element(sigmas.begin(), sigmas.end());
  return measured;
}

}  // namespace

std::optional<MeasuredVelocity> VelocityOf(const Problem& problem, size_t row, const Scene& scene) {
  std::optional<MeasuredVelocity> measured = VelocityOfContact(problem, row, scene);
  return measured.has_value() ? measured : VelocityByRates(problem, row, scene);
}

}  // namespace ricochet::fit
