#include "core/certified/residual.h"

#include "core/certified/digits.h"
#include "core/certified/flint.h"
#include "core/numerics/invariant.h"
#include "ricochet/certificate.h"

namespace ricochet::certified {
namespace {

// Numbers that agree in every digit of a certificate still leave a double's worth of bits.
slong Bits() { return BitsOf(2 * kMostCertifiedDigits); }

class Ball {
 public:
  Ball() { arb_init(value_); }
  Ball(const Ball&) = delete;
  Ball& operator=(const Ball&) = delete;
  ~Ball() { arb_clear(value_); }

  void Read(const std::string& decimal) {
    CheckInvariant(arb_set_str(value_, decimal.c_str(), Bits()) == 0, "a certificate has decimals");
  }
  arb_struct* get() { return value_; }

 private:
  arb_t value_;
};

double Difference(Ball& x, Ball& y) {
  Ball difference;
  arb_sub(difference.get(), x.get(), y.get(), Bits());
  return arf_get_d(arb_midref(difference.get()), ARF_RND_NEAR);
}

}  // namespace

double Residual(const std::string& decimal, double number) {
  Ball x;
  Ball y;
  x.Read(decimal);
  arb_set_d(y.get(), number);
  return Difference(x, y);
}

double Residual(const std::string& decimal, const std::string& other) {
  Ball x;
  Ball y;
  x.Read(decimal);
  y.Read(other);
  return Difference(x, y);
}

}  // namespace ricochet::certified
