// Every wrong request for a fit, with the violation that names field, value and rule.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "ricochet/error.h"
#include "tests/core/fit/fit_cases.h"

namespace ricochet::fit {
namespace {

struct Wrong {
  const char* name;
  std::function<void(FitRequest&)> spoil;
  const char* field;
  const char* description;  // A part of it.
};

class Errors : public testing::TestWithParam<Wrong> {};

TEST_P(Errors, IsNamed) {
  FitRequest request = Noiseless(ContactCase());
  GetParam().spoil(request);
  const absl::Status status = Fit(request, [] { return false; }).status();
  ASSERT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << status;
  const std::vector<Violation> violations = ViolationsOf(status);
  ASSERT_FALSE(violations.empty());
  EXPECT_EQ(violations[0].field, GetParam().field) << status;
  EXPECT_THAT(violations[0].description, testing::HasSubstr(GetParam().description));
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(
    Requests, Errors,
    testing::Values(
        Wrong{"NoUnknown", [](FitRequest& r) { r.unknowns.clear(); }, "unknowns", "is empty: must name at least one"},
        Wrong{"NothingMeasured", [](FitRequest& r) { r.measured.clear(); }, "measured", "is empty: must name at least"},
        Wrong{"WrongPath", [](FitRequest& r) { r.unknowns[0].path = "friction.kinetic_coeficient"; },
              "unknowns[0].path", "did you mean friction.kinetic_coefficient?"},
        Wrong{"UnknownThatTheSceneLacks",
              [](FitRequest& r) { r.unknowns[0].path = "compliance.tangential_ratio_squared"; }, "unknowns[0].path",
              "compliance.tangential_ratio_squared"},
        Wrong{"NoStart", [](FitRequest& r) { r.unknowns[0] = {.path = "friction.static_coefficient"}; },
              "unknowns[0].start", "is unset: must be set: the scene states no friction.static_coefficient"},
        Wrong{"TwiceTheSame", [](FitRequest& r) { r.unknowns[1].path = r.unknowns[0].path; }, "unknowns[1].path",
              "unknowns[0]"},
        Wrong{"InputIsUnknown", [](FitRequest& r) { r.inputs[0].path = r.unknowns[0].path; }, "inputs[0].path",
              "unknowns[0]"},
        Wrong{"WrongColumn", [](FitRequest& r) { r.measured[0].path = "contact_velocity_after.normal_m_a"; },
              "measured[0].path", "did you mean contact_velocity_after.normal_m_s?"},
        Wrong{"ColumnThatTheSceneCannotHave", [](FitRequest& r) { r.measured[0].path = "contact.duration_s"; },
              "measured[0].path", "contact.duration_s"},
        Wrong{"BoundExcludesStart", [](FitRequest& r) { r.unknowns[0].low = 0.2; }, "unknowns[0].start",
              "= 0.1: must be in [0.2, inf], the bounds"},
        Wrong{"BoundBreaksTheRule", [](FitRequest& r) { r.unknowns[0].low = -0.2; }, "unknowns[0].low",
              "= -0.2: must be in [0, inf]"},
        Wrong{"BoundsTurnedAround",
              [](FitRequest& r) {
                r.unknowns[0].low = 0.1;
                r.unknowns[0].high = 0.1;
              },
              "unknowns[0].low", "= 0.1: must be below the upper bound 0.1"},
        Wrong{"SigmaOfZero", [](FitRequest& r) { r.measured[0].sigma = {0.0}; }, "measured[0].sigma[0]",
              "= 0: must be > 0"},
        Wrong{"NegativeSigmaOfAnInput", [](FitRequest& r) { r.inputs[1].sigma = {-0.1}; }, "inputs[1].sigma[0]",
              "= -0.1: must be 0, or in [1e-150, 1e+150]"},
        Wrong{"TooFewSigmasOfAnInput",
              [](FitRequest& r) {
                r.inputs[1].sigma = {0.1, 0.1};
              },
              "inputs[1].sigma", "has 2 numbers: must have 6, one for each row, or one for all"},
        Wrong{"SigmaWithoutASquare", [](FitRequest& r) { r.measured[0].sigma = {1e-200}; }, "measured[0].sigma[0]",
              "= 1e-200: must be in [1e-150, 1e+150]"},
        Wrong{"LossWithoutAName", [](FitRequest& r) { r.loss = static_cast<FitLoss>(99); }, "loss",
              "= 99: must be a loss that is named"},
        Wrong{"SigmaOfARow", [](FitRequest& r) { r.measured[1].sigma = {1, 1, 1, -1, 1, 1}; }, "measured[1].sigma[3]",
              "= -1: must be > 0"},
        Wrong{"SigmasMissing",
              [](FitRequest& r) {
                r.measured[1].sigma = {1, 1};
              },
              "measured[1].sigma", "has 2 numbers: must have 6, one for each row, or one for all"},
        Wrong{"ColumnsOfTwoLengths", [](FitRequest& r) { r.measured[1].values.pop_back(); }, "measured[1].values",
              "has 5 numbers: must have 6"},
        Wrong{"InputTooShort", [](FitRequest& r) { r.inputs[0].values.pop_back(); }, "inputs[0].values",
              "has 5 numbers: must have 6"},
        Wrong{"InputNotFinite", [](FitRequest& r) { r.inputs[1].values[2] = std::nan(""); }, "inputs[1].values[2]",
              "= nan: must be finite"},
        Wrong{"MeasuredInfinite", [](FitRequest& r) { r.measured[0].values[1] = kInfinity; }, "measured[0].values[1]",
              "= inf: must be finite where something was measured"},
        Wrong{"TooFewRows",
              [](FitRequest& r) {
                for (FitMeasured& m : r.measured) m.values.assign(6, std::nan(""));
                r.measured[0].values[0] = 1.0;
              },
              "measured", "has 1 numbers in 6 rows: must have at least 2, one for each unknown"},
        Wrong{"ScaleWithoutLoss", [](FitRequest& r) { r.loss_scale = 2.0; }, "loss_scale", "= 2: must be unset"},
        Wrong{"ScaleOfZero",
              [](FitRequest& r) {
                r.loss = FitLoss::kHuber;
                r.loss_scale = 0.0;
              },
              "loss_scale", "= 0: must be in [1e-06, 1e+09], in sigmas"},
        Wrong{"NoStarts", [](FitRequest& r) { r.starts = 0; }, "starts", "= 0: must be in [1, 1000]"},
        Wrong{"NoIterations", [](FitRequest& r) { r.max_iterations = 0; }, "max_iterations", "= 0: must be in [1, "},
        Wrong{"RegionOfNoUnknown",
              [](FitRequest& r) {
                r.region = {"restitution.poison", "x"};
              },
              "region[0]", "did you mean restitution.poisson?"},
        Wrong{"RegionOfOne", [](FitRequest& r) { r.region = {"restitution.poisson"}; }, "region",
              "has 1 entry: must have two different unknowns, or none"},
        Wrong{"SceneWrong",
              [](FitRequest& r) {
                r.scene.restitution = std::monostate();
                r.unknowns.pop_back();
              },
              "restitution.coefficient", "is not set: must"},
        Wrong{"RowWithoutImpact",
              [](FitRequest& r) {
                r.inputs[0] = {"planar_contact.w_nn_per_kg", {1, 1, 1, -1, 1, 1}};
              },
              "inputs[0].values[3]", "-1"}),
    [](const auto& given) { return given.param.name; });

}  // namespace
}  // namespace ricochet::fit
