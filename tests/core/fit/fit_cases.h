// Measured impacts that are made from known scenes, for the tests of fits.

#ifndef RICOCHET_TESTS_CORE_FIT_FIT_CASES_H_
#define RICOCHET_TESTS_CORE_FIT_FIT_CASES_H_

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/engine/row_runs.h"
#include "ricochet/fit.h"
#include "ricochet/solver.h"

namespace ricochet::fit {

// A scene whose numbers are the truth, the unknowns with the place where the search starts, inputs, and the numbers
// that are measured with their sigma.
struct Case {
  std::string name;
  Scene truth;
  std::vector<FitUnknown> unknowns;
  std::vector<double> true_values;
  std::vector<FitInput> inputs;
  std::vector<std::pair<std::string, double>> measured;
};

// Fits on this thread alone.
inline absl::StatusOr<FitResponse> Fit(const FitRequest& request, absl::FunctionRef<bool()> stopped) {
  return RunFit(request, nullptr, stopped);
}

// Errors of measured numbers and of inputs: normal ones with their sigma, of which some are ten times as large.
class Noise {
 public:
  explicit Noise(uint64_t seed, double outliers = 0.0) : random_(seed), is_outlier_(outliers) {}

  FitRequest AddedTo(FitRequest request) {
    for (FitMeasured& measured : request.measured) Add(measured.sigma[0], measured.values);
    for (FitInput& input : request.inputs) {
      if (!input.sigma.empty()) Add(input.sigma[0], input.values);
    }
    return request;
  }

 private:
  void Add(double sigma, std::vector<double>& values) {
    for (double& value : values) {
      const double error = sigma * normal_(random_);
      value += is_outlier_.p() > 0.0 && is_outlier_(random_) ? 10.0 * error : error;
    }
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::bernoulli_distribution is_outlier_;
};

// The request that a case makes without noise.
inline FitRequest Noiseless(const Case& given) {
  FitRequest request = {.scene = given.truth, .unknowns = given.unknowns, .inputs = given.inputs};
  BatchSetup setup = {.scene = given.truth};
  BatchRows rows;
  for (const FitInput& input : given.inputs) {
    setup.fields.push_back(input.path);
    rows.inputs.emplace_back(input.values);
  }
  for (const auto& [path, sigma] : given.measured) {
    setup.columns.push_back(path);
    request.measured.push_back({path, std::vector<double>(given.inputs.front().values.size()), {sigma}});
  }
  for (FitMeasured& measured : request.measured) rows.outputs.push_back(absl::MakeSpan(measured.values));
  static_cast<void>(LocalSolver().SolveBatch(setup, rows));
  return request;
}

inline Case PendulumCase() {
  return {.name = "pendulum",
          .truth = {.system = Pendulum{.inertia_kg_m2 = 0.2, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
                    .friction = {.kinetic_coefficient = 0.12},
                    .restitution = EnergeticCoefficient{0.7}},
          .unknowns = {{.path = "friction.kinetic_coefficient", .start = 0.05},
                       {.path = "restitution.energetic", .start = 0.5}},
          .true_values = {0.12, 0.7},
          .inputs = {{"pendulum.omega_minus_rad_s", {-1.0, -2.0, -1.5, -0.7}}, {"pendulum.a_m", {0.3, 0.5, 0.7, 0.9}}},
          .measured = {{"rates_after_rad_s[0]", 0.01}, {"impulse.normal_total_n_s", 0.002}}};
}

inline Case ContactCase() {
  return {
      .name = "planar_contact",
      .truth = {.system = PlanarContact{.w_tt_per_kg = 3.0,
                                        .w_tn_per_kg = 0.5,
                                        .w_nn_per_kg = 1.0,
                                        .tangential_m_s = 1.0,
                                        .normal_m_s = -1.0},
                .friction = {.kinetic_coefficient = 0.25},
                .restitution = PoissonCoefficient{0.6}},
      .unknowns = {{.path = "friction.kinetic_coefficient", .start = 0.1},
                   {.path = "restitution.poisson", .start = 0.8}},
      .true_values = {0.25, 0.6},
      .inputs = {{"planar_contact.tangential_m_s", {0.2, 0.6, 1.0, 2.0, 3.0, 4.0}},
                 {"planar_contact.normal_m_s", {-1.0, -1.0, -1.5, -1.0, -2.0, -1.0}}},
      .measured = {{"contact_velocity_after.tangential_m_s[0]", 0.01}, {"contact_velocity_after.normal_m_s", 0.01}}};
}

inline Case BodyCase() {
  return {.name = "planar_body",
          .truth = {.system = PlanarBody{.mass_kg = 0.5,
                                         .inertia_com_kg_m2 = 0.01,
                                         .offset_t_m = 0.05,
                                         .offset_n_m = -0.1,
                                         .velocity_t_m_s = 1.0,
                                         .velocity_n_m_s = -2.0},
                    .friction = {.kinetic_coefficient = 0.15},
                    .restitution = NewtonCoefficient{0.55}},
          .unknowns = {{.path = "friction.kinetic_coefficient", .start = 0.3},
                       {.path = "restitution.newton", .start = 0.9},
                       {.path = "planar_body.inertia_com_kg_m2", .start = 0.02}},
          .true_values = {0.15, 0.55, 0.01},
          .inputs = {{"planar_body.velocity_t_m_s", {0.5, 1.0, 2.0, 4.0, 3.0}},
                     {"planar_body.offset_t_m", {0.05, 0.02, -0.03, 0.04, 0.01}}},
          .measured = {{"bodies_after[0].linear_m_s[0]", 0.01},
                       {"bodies_after[0].linear_m_s[1]", 0.01},
                       {"bodies_after[0].angular_rad_s[0]", 0.1}}};
}

inline Case SpaceCase() {
  return {.name = "spatial_contact",
          .truth = {.system = SpatialContact{.w_per_kg = {3.0, 0.2, 0.1, 2.5, 0.3, 1.0},
                                             .tangential_m_s = {1.0, 0.5},
                                             .normal_m_s = -1.0},
                    .friction = {.kinetic_coefficient = 0.2},
                    .restitution = EnergeticCoefficient{0.8}},
          .unknowns = {{.path = "friction.kinetic_coefficient", .start = 0.1},
                       {.path = "restitution.energetic", .start = 0.6}},
          .true_values = {0.2, 0.8},
          .inputs = {{"spatial_contact.tangential_m_s[0]", {1.0, 2.0, 3.0, 1.5}},
                     {"spatial_contact.normal_m_s", {-1.0, -0.8, -1.0, -1.2}}},
          .measured = {{"contact_velocity_after.tangential_m_s[0]", 0.01},
                       {"contact_velocity_after.tangential_m_s[1]", 0.01},
                       {"contact_velocity_after.normal_m_s", 0.01}}};
}

inline Case CompliantCase() {
  Case made = ContactCase();
  made.name = "tangential_compliance";
  made.truth.restitution = EnergeticCoefficient{0.75};
  made.truth.compliance = Compliance{.tangential_ratio_squared = 1.2};
  made.unknowns = {{.path = "friction.kinetic_coefficient", .start = 0.15},
                   {.path = "restitution.energetic", .start = 0.6},
                   {.path = "compliance.tangential_ratio_squared", .start = 1.0}};
  made.true_values = {0.25, 0.75, 1.2};
  return made;
}

}  // namespace ricochet::fit

#endif  // RICOCHET_TESTS_CORE_FIT_FIT_CASES_H_
