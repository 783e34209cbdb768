// Integrator: CVODE for one contact of finite duration, step by step, with the roots of its guards.
//
// It uses Adams' formulas of variable order. This header and its source are the only files that know SUNDIALS.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_INTEGRATOR_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_INTEGRATOR_H_

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_nonlinearsolver.h>

#include <array>
#include <cstdint>
#include <utility>

#include "core/models/finite_duration/guards.h"

namespace ricochet::finite_duration {

class Integrator {
 public:
  // False if another library that was loaded before SUNDIALS has functions of the same names, as that of Simbody has:
  // then those are called with data that they do not know, and no integrator may be made.
  static bool LibraryIsWhole();

  explicit Integrator(const ScaledContact& contact);
  ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  // Starts anew at s = 0, in `mode`.
  void Begin(const Mode& mode, const Motion& y, double tolerance);

  enum class Progress {
    kStep,
    kBeginAnew,  // A guard is 0 at the last root and just after it: the integration has to begin anew from there.
    kFailed
  };
  // Goes to the end of a step or the next root, and marks in `fallen` the guards that are 0 there.
  Progress Step(std::array<bool, kModeGuards>& fallen);

  Motion y() const;
  double s() const { return s_; }
  double previous_s() const { return previous_s_; }
  // The motion anywhere in the last step.
  Motion Between(double s);

  // Returns the sum of the sizes of the local errors of each part since the last call, as CVODE estimates them.
  Motion TakeLocalErrors() { return std::exchange(local_errors_, Motion{}); }
  // Returns the steps and the evaluations of the rates since the last call.
  std::pair<int64_t, int64_t> TakeCosts();

 private:
  static int Rates(realtype s, N_Vector y, N_Vector rates, void* data);
  static int Roots(realtype s, N_Vector y, realtype* values, void* data);
  void AddLocalErrors();
  void Count();

  const ScaledContact& contact_;
  Mode mode_;
  sundials::Context context_;
  N_Vector y_;
  N_Vector absolute_;
  N_Vector errors_;
  void* memory_;
  SUNNonlinearSolver fixed_point_;
  double s_ = 0.0;
  double previous_s_ = 0.0;
  int64_t steps_ = 0;
  int64_t right_hand_sides_ = 0;
  std::pair<int64_t, int64_t> counted_since_begin_ = {0, 0};  // These steps and evaluations are in the sums above.
  long step_of_errors_ = 0;                                   // The step whose local errors were taken last.
  Motion local_errors_ = {};
};

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_INTEGRATOR_H_
