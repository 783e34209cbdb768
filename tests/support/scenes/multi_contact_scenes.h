// Scenes of several contacts at once that people know: rows of balls, and a block that falls flat; and their answers.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_MULTI_CONTACT_SCENES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_MULTI_CONTACT_SCENES_H_

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "ricochet/solver.h"

namespace ricochet {

// Balls in a row along x that touch, without friction. Contact i is between balls i and i + 1.
inline MultiContactScene RowOfBalls(const std::vector<double>& masses, const std::vector<double>& velocities,
                                    const std::vector<double>& energetic) {
  FreeBodies balls;
  MultiContactScene scene;
  for (size_t i = 0; i < masses.size(); ++i) {
    const auto x = static_cast<double>(i);
    balls.bodies.push_back({.mass_kg = masses[i],
                            .inertia_com_kg_m2 = {0.1 * masses[i]},
                            .position_m = {x, 0.0},
                            .linear_m_s = {velocities[i], 0.0}});
    if (i == 0) continue;
    scene.contacts.push_back({.energetic = energetic[i - 1],
                              .body = static_cast<int32_t>(i) + 1,
                              .other_body = static_cast<int32_t>(i),
                              .point_m = {x - 0.5, 0.0},
                              .normal = {1.0, 0.0}});
  }
  scene.system = std::move(balls);
  return scene;
}

// A homogeneous block of 1 kg, 1 m wide and 2 m high, that falls flat on its two lower corners at 1 m/s. Contact 1 is
// the left one.
inline MultiContactScene FallingBlock(double friction, double energetic, double stiffness_right = 1.0) {
  MultiContactScene scene;
  scene.system = FreeBodies{
      .bodies = {
          {.mass_kg = 1.0, .inertia_com_kg_m2 = {5.0 / 12.0}, .position_m = {0.0, 1.0}, .linear_m_s = {0.0, -1.0}}}};
  for (const double side : {-1.0, 1.0}) {
    scene.contacts.push_back({.friction = friction,
                              .energetic = energetic,
                              .relative_stiffness = side < 0.0 ? 1.0 : stiffness_right,
                              .body = 1,
                              .point_m = {0.5 * side, 0.0},
                              .normal = {0.0, 1.0}});
  }
  return scene;
}

// A box in space that lands on its four lower corners.
inline MultiContactScene SpatialBox(double friction = 0.3, double energetic = 0.4) {
  MultiContactScene scene;
  scene.system = FreeBodies{.bodies = {{.mass_kg = 2.0,
                                        .inertia_com_kg_m2 = {0.04, 0.0, 0.0, 0.06, 0.0, 0.08},
                                        .position_m = {0.0, 0.0, 0.1},
                                        .linear_m_s = {0.4, 0.1, -1.0},
                                        .angular_rad_s = {0.3, -0.2, 0.0}}}};
  for (const double x : {-0.2, 0.2}) {
    for (const double y : {-0.15, 0.15}) {
      scene.contacts.push_back(
          {.friction = friction, .energetic = energetic, .body = 1, .point_m = {x, y, 0.0}, .normal = {0.0, 0.0, 1.0}});
    }
  }
  return scene;
}

// The answer to the first state, in this process. It is empty where the test has failed, because there is none.
inline MultiContactAnswer AnswerTo(const MultiContactRequest& request) {
  const absl::StatusOr<MultiContactResponse> response = LocalSolver().MultiContact(request);
  EXPECT_TRUE(response.ok()) << response.status();
  return response.ok() ? response->answers.front() : MultiContactAnswer();
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_MULTI_CONTACT_SCENES_H_
