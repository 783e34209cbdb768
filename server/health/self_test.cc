#include "server/health/self_test.h"

#include "absl/strings/str_cat.h"

namespace ricochet::server {
namespace {

// A pendulum with a = b = 1 m and J0 = 1 kg m2 that strikes at 1 rad/s, with mu = 0.6 and the energetic coefficient 1.
// Slip reverses, so that Newton's coefficient is sqrt((1 - 0.6)/(1 + 0.6)) = 1/2 (Lubarda 2009).
constexpr double kNewton = 0.5;
constexpr double kTolerance = 1e-15;

Scene KnownScene() {
  Scene scene;
  scene.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 1.0, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  scene.friction.kinetic_coefficient = 0.6;
  scene.restitution = EnergeticCoefficient{1.0};
  return scene;
}

}  // namespace

absl::Status TestSolver(const Solver& solver) {
  const absl::StatusOr<SolveResponse> answer = solver.Solve({.scene = KnownScene()});
  if (!answer.ok()) return answer.status();
  const double newton = answer->outcome.coefficients.newton;
  if (newton >= kNewton - kTolerance && newton <= kNewton + kTolerance) return absl::OkStatus();
  return absl::InternalError(
      absl::StrCat("the self-test failed: Newton's coefficient is ", newton, ", must be ", kNewton));
}

}  // namespace ricochet::server
