// MadeCost: a study of cost with one row of every kind that a report has to show.

#ifndef RICOCHET_TESTS_CLIENT_CLI_MADE_COST_H_
#define RICOCHET_TESTS_CLIENT_CLI_MADE_COST_H_

#include <cmath>
#include <string>
#include <utility>

#include "ricochet/cost.h"

namespace ricochet::cli {

inline CostRow MeasuredRow(std::string name, CostMethod method, double time_s, CostError claimed, CostError achieved) {
  return {.name = std::move(name),
          .method = method,
          .status = CostStatus::kMeasured,
          .note = "",
          .solve = CostTime{time_s, 0.98 * time_s, 1.04 * time_s, 21, 1000},
          .batch = CostTime{0.5 * time_s, 0.49 * time_s, 0.52 * time_s, 21, 1000},
          .claimed = claimed,
          .achieved = achieved,
          .velocity_after = ContactVelocity{{0.7}, 0.2}};
}

// Rows 0 to 2 are on the front. Row 3 errs by more than it claims, row 4 misses its tolerance, row 5 failed, and row 6
// had no time left. Row 7 is certified.
inline CostChunk MadeCost() {
  constexpr double kInfinity = HUGE_VAL;
  CostChunk study{.rows_done = 8, .rows_total = 8, .engine = {"0.1.0", "0123456789abcdef"}};
  study.rows = {
      MeasuredRow("frictionless", {.model = Model::kFrictionless, .arithmetic = Arithmetic::kPlain}, 8e-9,
                  {kInfinity, 1e-16, kInfinity}, {0.05, 0.0, 0.05}),
      MeasuredRow("pendulum plain", {.model = Model::kPendulum, .arithmetic = Arithmetic::kPlain}, 2.5e-8,
                  {1.7e-15, 1.7e-15, 0.0}, {1.1e-16, 1.1e-16, 0.0}),
      MeasuredRow("pendulum compensated", {.model = Model::kPendulum, .arithmetic = Arithmetic::kCompensated}, 1.6e-7,
                  {1.2e-16, 1.2e-16, 0.0}, {0.0, 0.0, 0.0}),
      MeasuredRow("planar plain", {.model = Model::kPlanar, .arithmetic = Arithmetic::kPlain}, 8e-8,
                  {1e-15, 1e-15, 0.0}, {3e-15, 3e-15, 0.0}),
      MeasuredRow("space 1e-06", {.model = Model::kSpatial, .arithmetic = Arithmetic::kPlain, .tolerance = 1e-6},
                  1.5e-6, {4e-6, 4e-6, 0.0}, {2e-6, 2e-6, 0.0}),
      {.name = "finite duration k=1e9 1e-12",
       .method =
           {.model = Model::kFiniteDuration, .arithmetic = Arithmetic::kPlain, .tolerance = 1e-12, .stiffness = 1e9},
       .status = CostStatus::kFailed,
       .note = "The budget of steps ran out before the contact separated, say < 1 & > 0."},
      {.name = "compliant",
       .method = {.model = Model::kCompliant, .arithmetic = Arithmetic::kPlain},
       .status = CostStatus::kOutOfTime},
      MeasuredRow("certified 32 digits", {.model = Model::kPlanar, .arithmetic = Arithmetic::kCertified, .digits = 32},
                  1.2e-4, {1e-32, 1e-32, 0.0}, {3e-33, 3e-33, 0.0})};
  study.rows[4].steps = 12;
  study.rows[4].right_hand_sides = 80;
  study.summary =
      CostSummary{.reference = ContactVelocity{{0.7}, 0.2},
                  .reference_source = "certified to 64 digits",
                  .reference_error = 1e-64,
                  .front = {0, 1, 2},
                  .picks = {{.row = 2, .least_tolerance = 0.0, .most_tolerance = 1e-15},
                            {.row = 1, .least_tolerance = 1e-14, .most_tolerance = 1e-2},
                            {.row = -1, .least_tolerance = 1e-1, .most_tolerance = 1e-1, .model = Model::kFirstOrder}},
                  .deceived = 1,
                  .out_of_time = 1,
                  .failed = 1,
                  .machine = {"Processor 1", "GCC 12.2.0", "AVX3", true},
                  .elapsed_s = 2.9};
  return study;
}

}  // namespace ricochet::cli

#endif  // RICOCHET_TESTS_CLIENT_CLI_MADE_COST_H_
