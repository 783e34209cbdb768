#include "core/models/finite_duration/integrator.h"

#include <cvode/cvode.h>
#include <dlfcn.h>
#include <sundials/sundials_math.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>

#include "core/base/invariant.h"
#include "core/models/finite_duration/finite_duration.h"

namespace ricochet::finite_duration {
namespace {

// The parts in a vector. Only a contact that is pulled integrates kStretch, the last one.
Motion MotionIn(N_Vector vector) {
  Motion motion;
  motion[kStretch] = 1.0;
  std::copy_n(NV_DATA_S(vector), NV_LENGTH_S(vector), motion.begin());
  return motion;
}

void Write(const Motion& motion, N_Vector vector) {
  std::copy_n(motion.begin(), NV_LENGTH_S(vector), NV_DATA_S(vector));
}

// Checks a call that fails only where this program is wrong.
void Require(int flag) { CheckInvariant(flag >= 0, "CVODE refused a call"); }

// CVODE's search for roots multiplies a guard by a step and by another guard. Steps and guards within these limits keep
// its products in the range of doubles; a search that meets an infinity or a NaN never ends.
constexpr double kLargest = 0x1p500;
constexpr double kSmallest = 0x1p-500;

double InRangeOfSearch(double guard) {
  return guard == 0.0 ? guard : std::copysign(std::clamp(std::fabs(guard), kSmallest, kLargest), guard);
}

// Returns the address at which the file of a function was loaded.
template <typename Function>
const void* HomeOf(Function* function) {
  Dl_info info = {};
  return dladdr(reinterpret_cast<const void*>(function), &info) != 0 ? info.dli_fbase : nullptr;
}

void IgnoreMessage(int /*code*/, const char* /*module*/, const char* /*function*/, char* /*message*/, void* /*data*/) {}

}  // namespace

bool Integrator::LibraryIsWhole() {
  // Old releases of SUNDIALS have the first of each pair alone.
  return HomeOf(&N_VClone) == HomeOf(&N_VScaleAddMulti) && HomeOf(&N_VNew_Serial) == HomeOf(&N_VScaleAddMulti_Serial);
}

Integrator::Integrator(const ScaledContact& contact)
    : contact_(contact),
      y_(N_VNew_Serial(contact.pulled ? kParts : kParts - 1, context_)),
      absolute_(N_VClone(y_)),
      errors_(N_VClone(y_)),
      memory_(CVodeCreate(CV_ADAMS, context_)) {
  N_VConst(0.0, y_);
  N_VConst(1.0, absolute_);
  fixed_point_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
  Require(CVodeInit(memory_, Rates, 0.0, y_));
  Require(CVodeSVtolerances(memory_, 1.0, absolute_));
  Require(CVodeSetUserData(memory_, this));
  Require(CVodeSetMaxStep(memory_, kLargest));
  Require(CVodeSetNonlinearSolver(memory_, fixed_point_));
  Require(CVodeRootInit(memory_, kGuards, Roots));
  std::array<int, kGuards> directions = {};
  std::fill_n(directions.begin(), static_cast<size_t>(kModeGuards), -1);
  Require(CVodeSetRootDirection(memory_, directions.data()));
  Require(CVodeSetNoInactiveRootWarn(memory_));
  Require(CVodeSetErrHandlerFn(memory_, IgnoreMessage, nullptr));
}

Integrator::~Integrator() {
  CVodeFree(&memory_);
  SUNNonlinSolFree(fixed_point_);
  N_VDestroy(errors_);
  N_VDestroy(absolute_);
  N_VDestroy(y_);
}

void Integrator::Begin(const Mode& mode, const Motion& y, double tolerance) {
  Count();
  mode_ = mode;
  Write(y, y_);
  Motion absolute;
  const double slip = std::max(1.0, std::fabs(contact_.u0));
  absolute.fill(tolerance);
  absolute[kU] *= slip;
  absolute[kTangentWork] *= slip;
  absolute[kFrictionLoss] *= slip;
  absolute[kV] *= Pace(contact_, mode);
  for (const Part part : kForceParts) absolute[part] *= contact_.stiffness;
  // A weak pull ends the contact where damping has left as little of N as the pull.
  constexpr double kWeakest = 0x1p-60;
  absolute[kStretch] *= std::clamp(std::max(std::fabs(contact_.an), std::fabs(contact_.at)), kWeakest, 1.0);
  Write(absolute, absolute_);
  Require(CVodeReInit(memory_, 0.0, y_));
  Require(CVodeSVtolerances(memory_, tolerance, absolute_));
  s_ = previous_s_ = 0.0;
  counted_since_begin_ = {0, 0};
  step_of_errors_ = 0;
}

Integrator::Progress Integrator::Step(std::array<bool, kModeGuards>& fallen) {
  // CVODE takes from it only the direction and the size of the first step.
  constexpr double kAhead = 1.0;
  fallen.fill(false);
  previous_s_ = s_;
  const int flag = CVode(memory_, s_ + kAhead, y_, &s_, CV_ONE_STEP);
  if (flag == CV_ILL_INPUT) return Progress::kBeginAnew;
  if (flag < 0) return Progress::kFailed;
  AddLocalErrors();
  if (flag != CV_ROOT_RETURN) return Progress::kStep;
  std::array<int, kGuards> found;
  Require(CVodeGetRootInfo(memory_, found.data()));
  for (size_t i = 0; i < kModeGuards; ++i) fallen[i] = found[i] != 0;
  return Progress::kStep;
}

Motion Integrator::y() const { return MotionIn(y_); }

Motion Integrator::Between(double s) {
  const Motion now = y();
  Require(CVodeGetDky(memory_, s, 0, y_));
  const Motion between = y();
  Write(now, y_);
  return between;
}

std::pair<int64_t, int64_t> Integrator::TakeCosts() {
  Count();
  return {std::exchange(steps_, 0), std::exchange(right_hand_sides_, 0)};
}

int Integrator::Rates(realtype /*s*/, N_Vector y, N_Vector rates, void* data) {
  const Integrator& self = *static_cast<const Integrator*>(data);
  Write(RatesAt(self.contact_, self.mode_, MotionIn(y)), rates);
  return 0;
}

int Integrator::Roots(realtype /*s*/, N_Vector y, realtype* values, void* data) {
  const Integrator& self = *static_cast<const Integrator*>(data);
  const Guards guards = GuardsAt(self.contact_, self.mode_, MotionIn(y));
  std::transform(guards.begin(), guards.end(), values, InRangeOfSearch);
  constexpr int kGiveUp = -1;
  return std::any_of(guards.begin(), guards.end(), [](double guard) { return std::isnan(guard); }) ? kGiveUp : 0;
}

void Integrator::AddLocalErrors() {
  long steps = 0;
  Require(CVodeGetNumSteps(memory_, &steps));
  if (steps == step_of_errors_) return;
  step_of_errors_ = steps;
  Require(CVodeGetEstLocalErrors(memory_, errors_));
  for (sunindextype i = 0; i < NV_LENGTH_S(errors_); ++i) {
    local_errors_[static_cast<size_t>(i)] += std::fabs(NV_Ith_S(errors_, i));
  }
}

void Integrator::Count() {
  long steps = 0;
  long right_hand_sides = 0;
  Require(CVodeGetNumSteps(memory_, &steps));
  Require(CVodeGetNumRhsEvals(memory_, &right_hand_sides));
  steps_ += steps - counted_since_begin_.first;
  right_hand_sides_ += right_hand_sides - counted_since_begin_.second;
  counted_since_begin_ = {steps, right_hand_sides};
}

double LibraryPower(double base, double exponent) { return SUNRpowerR(base, exponent); }

}  // namespace ricochet::finite_duration
