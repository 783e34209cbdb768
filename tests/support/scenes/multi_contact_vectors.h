// Reference vectors of several contacts: tests/data/multi_contact.json.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_MULTI_CONTACT_VECTORS_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_MULTI_CONTACT_VECTORS_H_

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/multi/problem.h"
#include "tests/support/paths.h"

namespace ricochet::multi {

inline nlohmann::json ReadMultiContactVectors() {
  std::ifstream file(TestDataPath("multi_contact.json"));
  return nlohmann::json::parse(file);
}

// Results are texts of 25 digits.
inline double NumberOf(const nlohmann::json& value) {
  return value.is_string() ? std::strtod(value.get<std::string>().c_str(), nullptr) : value.get<double>();
}

inline std::vector<double> NumbersOf(const nlohmann::json& values) {
  std::vector<double> numbers;
  for (const auto& value : values) numbers.push_back(NumberOf(value));
  return numbers;
}

inline Problem ProblemOf(const nlohmann::json& scene) {
  Problem problem = {.d = scene["d"], .k = scene["k"], .w = {}, .v = {}, .laws = {}};
  const int size = problem.d * problem.k;
  problem.w.resize(size, size);
  problem.v.resize(size);
  for (int i = 0; i < size; ++i) {
    problem.v(i) = scene["v"][static_cast<size_t>(i)];
    for (int j = 0; j < size; ++j) problem.w(i, j) = scene["W"][static_cast<size_t>(i)][static_cast<size_t>(j)];
  }
  for (size_t i = 0; i < static_cast<size_t>(problem.k); ++i) {
    ContactLaw& law = problem.laws.emplace_back(ContactLaw{.mu = scene["mu"][i], .e = scene["e"][i]});
    if (scene.contains("stiffness")) law.stiffness = scene["stiffness"][i];
  }
  return problem;
}

}  // namespace ricochet::multi

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_MULTI_CONTACT_VECTORS_H_
