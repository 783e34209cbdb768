// Ball: a FLINT ball (a midpoint with a radius) that frees itself.

#ifndef RICOCHET_CORE_CERTIFIED_BALL_H_
#define RICOCHET_CORE_CERTIFIED_BALL_H_

#include "core/certified/flint.h"

namespace ricochet::certified {

class Ball {
 public:
  Ball() { arb_init(value_); }
  Ball(const Ball&) = delete;
  Ball& operator=(const Ball&) = delete;
  ~Ball() { arb_clear(value_); }
  arb_struct* get() { return value_; }

 private:
  arb_t value_;
};

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_BALL_H_
