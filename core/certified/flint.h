// The only header that includes those of FLINT and Arb. FLINT 3 contains Arb as <flint/arb.h>; before it, Arb was a
// library of its own whose headers Debian 12 installs as <arb.h>. Ball: a number of Arb that frees itself.

#ifndef RICOCHET_CORE_CERTIFIED_FLINT_H_
#define RICOCHET_CORE_CERTIFIED_FLINT_H_

#include <flint/flint.h>
#include <flint/fmpq.h>
#include <flint/fmpz.h>

#if __has_include(<flint/arb.h>)
#include <flint/arb.h>
#include <flint/arb_mat.h>
#else
#include <arb.h>
#include <arb_mat.h>
#endif

namespace ricochet::certified {

// A FLINT ball (a midpoint with a radius) that frees itself.
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

#endif  // RICOCHET_CORE_CERTIFIED_FLINT_H_
