#include "tests/benchmark/cvode_peer.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace ricochet::bench {
namespace {

using spatial::Problem;

// Checks a call that fails only if this program is wrong.
void Require(int flag) {
  if (flag >= 0) return;
  std::fprintf(stderr, "CVODE refused a setting with %d\n", flag);
  std::abort();
}

void Silent(int /*code*/, const char* /*module*/, const char* /*function*/, char* /*message*/, void* /*data*/) {}

// u, v, normal work.
using State = std::array<double, 4>;

// Velocities in units of max(|u0|, |v0|), W in units of Wnn.
struct Impact {
  double w11, w12, w13, w22, w23;
  double mu;
  RestitutionLaw law;
  double coefficient;
  double stop_slip;

  bool restitution = false;
  double target = 0.0;  // v, tau or work at which the phase ends.

  double Value(double tau, const State& y) const {
    if (!restitution || law == RestitutionLaw::kNewton) return y[2];
    return law == RestitutionLaw::kPoisson ? tau : y[3];
  }

  State Rate(const State& y, double f1, double f2) const {
    return {w11 * f1 + w12 * f2 + w13, w12 * f1 + w22 * f2 + w23, w13 * f1 + w23 * f2 + 1.0, y[2]};
  }

  // Begins restitution; returns false if there is none.
  bool BeginRestitution(double tau, const State& y, double v0) {
    restitution = true;
    target = law == RestitutionLaw::kNewton    ? -coefficient * v0
             : law == RestitutionLaw::kPoisson ? (1.0 + coefficient) * tau
                                               : y[3] * (1.0 - coefficient * coefficient);
    return coefficient > 0.0;
  }
};

State& StateOf(N_Vector vector) { return *reinterpret_cast<State*>(NV_DATA_S(vector)); }

int Rate(realtype /*tau*/, N_Vector y, N_Vector rate, void* data) {
  const Impact& impact = *static_cast<const Impact*>(data);
  const State& at = StateOf(y);
  const double slip = std::sqrt(at[0] * at[0] + at[1] * at[1]);
  if (slip == 0.0) return 1;  // This error is recoverable: CVODE tries a smaller step.
  StateOf(rate) = impact.Rate(at, -impact.mu * at[0] / slip, -impact.mu * at[1] / slip);
  return 0;
}

int Events(realtype tau, N_Vector y, realtype* values, void* data) {
  const Impact& impact = *static_cast<const Impact*>(data);
  const State& at = StateOf(y);
  values[0] = impact.Value(tau, at) - impact.target;
  values[1] = at[0] * at[0] + at[1] * at[1] - impact.stop_slip * impact.stop_slip;
  return 0;
}

// d(u, v, w)/dtau once slip has stopped: the contact holds if friction can do that; else slip starts in the one
// direction e in which it grows, (mu Wtt + h) e = wtn with |e| = 1, h > 0.
State RateFromRest(const Impact& impact) {
  const auto solve = [&](double scale, double h) -> std::array<double, 2> {
    const double a = scale * impact.w11 + h;
    const double b = scale * impact.w12;
    const double c = scale * impact.w22 + h;
    const double det = a * c - b * b;
    return {(c * impact.w13 - b * impact.w23) / det, (a * impact.w23 - b * impact.w13) / det};
  };
  const std::array<double, 2> hold = solve(1.0, 0.0);
  if (std::hypot(hold[0], hold[1]) <= impact.mu) return {0.0, 0.0, impact.Rate({}, -hold[0], -hold[1])[2], 0.0};
  double low = 0.0;
  double high = std::hypot(impact.w13, impact.w23);
  constexpr int kHalvings = 60;
  for (int i = 0; i < kHalvings; ++i) {
    const double h = 0.5 * (low + high);
    const std::array<double, 2> e = solve(impact.mu, h);
    (std::hypot(e[0], e[1]) > 1.0 ? low : high) = h;
  }
  const std::array<double, 2> e = solve(impact.mu, high);
  return impact.Rate({}, -impact.mu * e[0], -impact.mu * e[1]);
}

// The normal impulse up to the end of the phase on a straight path with slope `slope` of v.
double StraightLength(const Impact& impact, double tau, const State& y, double slope) {
  const double missing = impact.target - impact.Value(tau, y);
  if (impact.restitution && impact.law == RestitutionLaw::kPoisson) return missing;
  if (impact.restitution && impact.law == RestitutionLaw::kEnergetic) {
    return 2.0 * missing / (y[2] + std::sqrt(y[2] * y[2] + 2.0 * slope * missing));
  }
  return missing / slope;
}

// Follows the path from the stop of slip to the end of the impact.
bool FinishStraight(Impact& impact, double tau, State& y, double v0) {
  const State rate = RateFromRest(impact);
  for (;;) {
    const double length = StraightLength(impact, tau, y, rate[2]);
    if (!(length >= 0.0) || !std::isfinite(length)) return false;
    y = {y[0] + length * rate[0], y[1] + length * rate[1], y[2] + length * rate[2],
         y[3] + length * (y[2] + 0.5 * length * rate[2])};
    tau += length;
    if (impact.restitution || !impact.BeginRestitution(tau, y, v0)) return true;
  }
}

}  // namespace

struct CvodePeer::Solver {
  sundials::Context context;
  N_Vector y;
  void* memory;
  SUNNonlinearSolver fixed_point;
  Impact impact;

  Solver() : y(N_VNew_Serial(4, context)), memory(CVodeCreate(CV_ADAMS, context)), impact() {
    N_VConst(1.0, y);
    fixed_point = SUNNonlinSol_FixedPoint(y, 0, context);
    int falling_or_rising[] = {1, -1};
    Require(CVodeInit(memory, Rate, 0.0, y));
    Require(CVodeSStolerances(memory, 1e-6, 1e-6));
    Require(CVodeSetUserData(memory, &impact));
    Require(CVodeSetNonlinearSolver(memory, fixed_point));
    Require(CVodeRootInit(memory, 2, Events));
    Require(CVodeSetRootDirection(memory, falling_or_rising));
    Require(CVodeSetErrHandlerFn(memory, Silent, nullptr));
    Require(CVodeSetMaxErrTestFails(memory, 100));
    Require(CVodeSetMaxConvFails(memory, 100));
  }
  ~Solver() {
    CVodeFree(&memory);
    SUNNonlinSolFree(fixed_point);
    N_VDestroy(y);
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  // Integrates until the impact ends or slip stops; returns false if CVODE gives up.
  bool Slide(double v0, double& tau, bool& stopped) {
    constexpr double kFar = 1e9;
    for (;;) {
      long steps = 0;
      Require(CVodeGetNumSteps(memory, &steps));
      if (steps >= kStepBudget) return false;
      Require(CVodeSetMaxNumSteps(memory, kStepBudget - steps));
      if (CVode(memory, kFar, y, &tau, CV_NORMAL) != CV_ROOT_RETURN) return false;
      int found[2];
      Require(CVodeGetRootInfo(memory, found));
      if (found[0] != 0 && (impact.restitution || !impact.BeginRestitution(tau, StateOf(y), v0))) return true;
      if (found[0] == 0 && found[1] != 0) {
        stopped = true;
        return true;
      }
    }
  }
};

CvodePeer::CvodePeer() : solver_(std::make_unique<Solver>()) {}
CvodePeer::~CvodePeer() = default;

PeerImpact CvodePeer::Solve(const Problem& problem, double tolerance) {
  const double scale = std::fmax(std::hypot(problem.u0[0], problem.u0[1]), std::fabs(problem.v0));
  const double unit = 1.0 / problem.w33;
  Impact& impact = solver_->impact;
  impact = {.w11 = problem.w11 * unit,
            .w12 = problem.w12 * unit,
            .w13 = problem.w13 * unit,
            .w22 = problem.w22 * unit,
            .w23 = problem.w23 * unit,
            .mu = problem.mu,
            .law = problem.law,
            .coefficient = problem.coefficient,
            .stop_slip = kStopSlip * tolerance};
  State& y = StateOf(solver_->y);
  y = {problem.u0[0] / scale, problem.u0[1] / scale, problem.v0 / scale, 0.0};
  const double v0 = y[2];
  double tau = 0.0;
  PeerImpact result = {.ended = true};
  bool stopped = std::hypot(y[0], y[1]) <= impact.stop_slip;
  if (!stopped) {
    Require(CVodeReInit(solver_->memory, 0.0, solver_->y));
    Require(CVodeSStolerances(solver_->memory, tolerance, tolerance));
    result.ended = solver_->Slide(v0, tau, stopped);
    long steps = 0;
    long right_hand_sides = 0;
    Require(CVodeGetNumSteps(solver_->memory, &steps));
    Require(CVodeGetNumRhsEvals(solver_->memory, &right_hand_sides));
    result.steps = steps;
    result.right_hand_sides = right_hand_sides;
  }
  if (result.ended && stopped) {
    y[0] = y[1] = 0.0;
    result.ended = FinishStraight(impact, tau, y, v0);
  }
  result.u1 = {y[0] * scale, y[1] * scale};
  result.v1 = y[2] * scale;
  return result;
}

}  // namespace ricochet::bench
