// The answers of the models that a plan chooses, and of the model that leaves out nothing.

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_PLANNED_ANSWER_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_PLANNED_ANSWER_H_

#include <gtest/gtest.h>

#include "core/models/compliant/compliant.h"
#include "core/models/pendulum/first_order.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/sliding/sliding.h"
#include "core/models/spatial/spatial.h"
#include "core/plan/choose.h"
#include "core/plan/scene_problem.h"
#include "tests/support/claims/impact_change.h"

namespace ricochet {

template <size_t kTangential>
struct Answer {
  Ending<kTangential> end;
  double error = 0.0;  // The model's estimate of its error, if it makes one.
};

inline compliant::Problem CompliantOf(const planar::Problem& problem, double ratio_squared) {
  return {.contact = problem, .ratio_squared = ratio_squared};
}

inline Answer<1> FullAnswer(const planar::Problem& problem, const ContactPhysics& physics) {
  if (physics.ratio_squared == 0.0) return {.end = EndingOf(planar::Solve(problem))};
  const compliant::Impact impact = compliant::Solve(CompliantOf(problem, physics.ratio_squared));
  return {.end = EndingOf(impact), .error = impact.error_estimate};
}

inline Answer<1> PlannedAnswer(const Choice& choice, const planar::Problem& full, const ContactPhysics& physics) {
  const planar::Problem problem = Without(choice, full);
  switch (choice.model) {
    case Model::kNone:
      return {.end = {.u1 = {full.u0}, .v1 = full.v0}};
    case Model::kFrictionless:
      return {.end = EndingOf(sliding::SolveFrictionless(SlidingProblemOf(problem)))};
    case Model::kSliding:
      return {.end = EndingOf(sliding::Solve(SlidingProblemOf(problem)))};
    case Model::kPlanar:
      return {.end = EndingOf(planar::Solve(problem))};
    case Model::kCompliant:
      return FullAnswer(problem, Without(choice, physics));
    default:
      ADD_FAILURE() << "no model for a planar contact: " << static_cast<int>(choice.model);
      return {};
  }
}

inline Answer<1> PlannedAnswer(const Choice& choice, const pendulum::Problem& full) {
  const pendulum::Problem problem = Without(choice, full);
  switch (choice.model) {
    case Model::kFrictionless:
      return {.end = EndingOf(sliding::SolveFrictionless(SlidingProblemOf(PlanarOf(problem))))};
    case Model::kFirstOrder:
      return {.end = EndingOf(first_order::Solve(problem))};
    case Model::kPendulum:
      return {.end = EndingOf(pendulum::Solve(problem))};
    default:
      ADD_FAILURE() << "no model for a pendulum: " << static_cast<int>(choice.model);
      return {};
  }
}

inline Answer<2> PlannedAnswer(const Choice& choice, const spatial::Problem& full) {
  spatial::Problem problem = Without(choice, full);
  switch (choice.model) {
    case Model::kFrictionless:
      return {.end = EndingOf(sliding::SolveFrictionless(SlidingProblemOf(problem)))};
    case Model::kSliding:
      return {.end = EndingOf(sliding::Solve(SlidingProblemOf(problem)))};
    case Model::kSpatial: {
      problem.tolerance = choice.model_tolerance;
      const spatial::Impact impact = spatial::Solve(problem);
      return {.end = EndingOf(impact), .error = impact.error_estimate};
    }
    default:
      ADD_FAILURE() << "no model for a contact in space: " << static_cast<int>(choice.model);
      return {};
  }
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_PLANNED_ANSWER_H_
