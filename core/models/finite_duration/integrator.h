// CVODE for one contact of core/models/finite_duration/finite_duration.h: Adams' formulas of variable order, step by step, with the
// roots of the guards. The only file, with its source, that knows SUNDIALS.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_INTEGRATOR_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_INTEGRATOR_H_

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_nonlinearsolver.h>

#include <array>
#include <cstdint>
#include <utility>

#include "core/models/finite_duration/motion.h"

namespace ricochet::finite_duration {

class Integrator {
 public:
  explicit Integrator(const Contact& contact);
  ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  // From s = 0 anew, in `mode`.
  void Begin(const Mode& mode, const Motion& y, double tolerance);

  enum class Progress {
    kStep,
    kCrowded,  // A guard is 0 where the last root was and just after it: begin anew from there.
    kFailed
  };
  // To the end of a step or the next root. `fallen`: guards that it found at 0.
  Progress Step(std::array<bool, kModeGuards>& fallen);

  const Motion& y() const;
  double s() const { return s_; }
  double previous_s() const { return previous_s_; }
  // The motion anywhere in the last step.
  Motion Between(double s);

  // For each part, the sum of the sizes of its local errors since the last call, as CVODE estimates them.
  Motion TakeLocalErrors() { return std::exchange(local_errors_, Motion{}); }
  // Steps and evaluations of the rates since the last call.
  std::pair<int64_t, int64_t> TakeCosts();

 private:
  static int Rates(realtype s, N_Vector y, N_Vector rates, void* data);
  static int Roots(realtype s, N_Vector y, realtype* values, void* data);
  void AddLocalErrors();
  void Count();

  const Contact& contact_;
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
  std::pair<int64_t, int64_t> counted_ = {0, 0};  // Of those, since the integrator last began.
  long judged_ = 0;                               // The step whose local errors were taken last.
  Motion local_errors_ = {};
};

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_INTEGRATOR_H_
