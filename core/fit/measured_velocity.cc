#include "core/fit/measured_velocity.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/contact/reduction.h"
#include "core/numerics/elementary.h"
#include "core/rows/driven_scene.h"

namespace ricochet::fit {
namespace {

// A number of the outcome, and the number of the scene that is the same before the impact.
struct Rate {
  std::string after, before;
};

void AddBody(size_t index, const std::string& before, std::vector<Rate>& rates) {
  const std::string after = absl::StrCat("bodies_after[", index, "].");
  rates.push_back({after + "linear_m_s[0]", before + ".velocity_t_m_s"});
  rates.push_back({after + "linear_m_s[1]", before + ".velocity_n_m_s"});
  rates.push_back({after + "angular_rad_s[0]", before + ".rate_rad_s"});
}

// What moves the contact; nothing for a system whose motion is not told by such numbers.
std::vector<Rate> RatesOf(const System& system) {
  std::vector<Rate> rates;
  if (std::holds_alternative<Pendulum>(system)) rates = {{"rates_after_rad_s[0]", "pendulum.omega_minus_rad_s"}};
  if (std::holds_alternative<PlanarBody>(system)) AddBody(0, "planar_body", rates);
  const auto* const pair = std::get_if<BodyPair>(&system);
  if (pair != nullptr && std::holds_alternative<PlanarPair>(pair->bodies)) {
    AddBody(0, "body_pair.planar.body_1", rates);
    AddBody(1, "body_pair.planar.body_2", rates);
  }
  if (const auto* const linkage = std::get_if<Linkage>(&system)) {
    for (size_t i = 0; i < linkage->links.size(); ++i) {
      rates.push_back({absl::StrCat("rates_after_rad_s[", i, "]"), absl::StrCat("linkage.links[", i, "].rate_rad_s")});
    }
  }
  if (const auto* const mechanism = std::get_if<Mechanism>(&system)) {
    for (size_t i = 0; i < mechanism->rates.size(); ++i) {
      rates.push_back({absl::StrCat("rates_after[", i, "]"), absl::StrCat("mechanism.rates[", i, "]")});
    }
  }
  return rates;
}

// The number that a row measured at a path.
const Number* MeasuredAt(const Problem& problem, size_t row, const std::string& path) {
  const auto& numbers = problem.numbers;
  auto number =
      std::lower_bound(numbers.begin(), numbers.end(), row, [](const Number& n, size_t r) { return n.row < r; });
  while (number != numbers.end() && number->row == row && problem.batch.columns[number->column] != path) ++number;
  return number == numbers.end() || number->row != row ? nullptr : &*number;
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

ContactVelocity VelocityBefore(const Scene& scene) {
  return std::visit(
      [](const auto& reduction) {
        return ContactVelocity{{reduction.u0.begin(), reduction.u0.end()}, reduction.v0};
      },
      Reduce(scene));
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

// The contact's velocity is linear in the rates. So it is that of a scene which moves before its impact as was
// measured, and each sigma changes it by what the rate does.
std::optional<MeasuredVelocity> VelocityByRates(const Problem& problem, size_t row, const Scene& scene) {
  std::vector<std::string> after, before;
  for (Rate& rate : RatesOf(scene.system)) {
    after.push_back(std::move(rate.after));
    before.push_back(std::move(rate.before));
  }
  const std::vector<const Number*> numbers = MeasuredAtAll(problem, row, after);
  if (numbers.empty()) return std::nullopt;
  DrivenScene moved(scene, before);
  for (size_t k = 0; k < numbers.size(); ++k) moved.Set(k, numbers[k]->value);
  MeasuredVelocity measured = {.velocity = VelocityBefore(moved.scene())};
  std::vector<double> sigmas(measured.velocity.tangential_m_s.size() + 1);
  for (size_t k = 0; k < numbers.size(); ++k) {
    moved.Set(k, numbers[k]->value + numbers[k]->sigma);
    const ContactVelocity beside = VelocityBefore(moved.scene());
    moved.Set(k, numbers[k]->value);
    for (size_t i = 0; i + 1 < sigmas.size(); ++i) {
      sigmas[i] = Hypot(sigmas[i], beside.tangential_m_s[i] - measured.velocity.tangential_m_s[i]);
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
