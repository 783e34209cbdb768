// The measured sphere of docs/experiments.md: an aluminium oxide sphere of 5 mm that strikes glass at 3.9 m/s under
// many angles (Kharaz, Gorham and Salman 2001; tests/data/measured_sphere.csv), against predictions and fits.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_split.h"
#include "ricochet/solver.h"
#include "tests/support/paths.h"

namespace ricochet {
namespace {

constexpr double kSpeed = 3.9;
constexpr double kRadius = 0.0025;
constexpr double kDegree = std::numbers::pi / 180.0;

// The angle from the normal, degrees, and the value of each quantity.
using Series = std::map<std::string, std::vector<std::pair<double, double>>>;

Series Measured() {
  std::ifstream file(TestDataPath("measured_sphere.csv"));
  Series series;
  for (std::string line; std::getline(file, line);) {
    const std::vector<std::string> cells = absl::StrSplit(line, ',');
    double angle = 0.0;
    double value = 0.0;
    if (line[0] == '#' || cells.size() != 3 || !absl::SimpleAtod(cells[1], &angle)) continue;
    EXPECT_TRUE(absl::SimpleAtod(cells[2], &value));
    series[cells[0]].emplace_back(angle, value);
  }
  return series;
}

// The sphere with the stated numbers. The ratio of compliances is that of the stated moduli.
Scene Sphere(double angle, bool compliant) {
  const double mass = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius * 4000.0;
  Scene scene = {.system = PlanarBody{.mass_kg = mass,
                                      .inertia_com_kg_m2 = 0.4 * mass * kRadius * kRadius,
                                      .offset_n_m = -kRadius,
                                      .velocity_t_m_s = kSpeed * std::sin(angle * kDegree),
                                      .velocity_n_m_s = -kSpeed * std::cos(angle * kDegree)},
                 .friction = {.kinetic_coefficient = 0.092},
                 .restitution = EnergeticCoefficient{0.98}};
  if (compliant) scene.compliance = Compliance{.tangential_ratio_squared = 1.1639};
  return scene;
}

double Predicted(const std::string& quantity, double angle, bool compliant) {
  const Outcome outcome = LocalSolver().Solve({.scene = Sphere(angle, compliant)})->outcome;
  const BodyVelocity& after = outcome.bodies_after.front();
  if (quantity == "rebound_spin_rad_s") return after.angular_rad_s[0];
  if (quantity == "tangential_restitution_of_centre") {
    return after.linear_m_s[0] / (kSpeed * std::sin(angle * kDegree));
  }
  const ContactVelocity& contact = outcome.contact_velocity_after;
  return std::atan2(contact.tangential_m_s[0], contact.normal_m_s) / kDegree;
}

double RootMeanSquare(const std::string& quantity, bool compliant, double from_angle = 0.0) {
  double sum = 0.0;
  int count = 0;
  const Series measured = Measured();
  for (const auto& [angle, value] : measured.at(quantity)) {
    if (angle < from_angle) continue;
    sum += std::pow(Predicted(quantity, angle, compliant) - value, 2.0);
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(MeasuredSphereTest, HasItsThreeSeries) {
  Series measured = Measured();
  EXPECT_EQ(measured["tangential_restitution_of_centre"].size(), 10);
  EXPECT_EQ(measured["rebound_spin_rad_s"].size(), 10);
  EXPECT_EQ(measured["rebound_angle_of_contact_deg"].size(), 11);
}

TEST(MeasuredSphereTest, ThePredictionWithoutAFittedNumberDeviatesAsDocumented) {
  EXPECT_NEAR(RootMeanSquare("tangential_restitution_of_centre", false), 0.048, 0.0005);
  EXPECT_NEAR(RootMeanSquare("rebound_spin_rad_s", false), 60.0, 0.5);
  EXPECT_NEAR(RootMeanSquare("rebound_angle_of_contact_deg", false), 2.9, 0.05);
  EXPECT_NEAR(RootMeanSquare("tangential_restitution_of_centre", true), 0.029, 0.0005);
  EXPECT_NEAR(RootMeanSquare("rebound_spin_rad_s", true), 21.0, 0.5);
  EXPECT_NEAR(RootMeanSquare("rebound_angle_of_contact_deg", true), 1.1, 0.05);
  EXPECT_NEAR(RootMeanSquare("tangential_restitution_of_centre", true, 15.0), 0.004, 0.0005);
}

}  // namespace
}  // namespace ricochet
