#include "core/certified/residual.h"

#include "core/base/invariant.h"
#include "core/certified/digits.h"
#include "core/certified/flint.h"
#include "ricochet/certificate.h"

namespace ricochet::certified {
namespace {

// Numbers that agree in every digit of a certificate still leave a double's worth of bits.
slong Bits() { return BitsOf(2 * kMostCertifiedDigits); }

void Read(const std::string& decimal, Ball& ball) {
  CheckInvariant(arb_set_str(ball.get(), decimal.c_str(), Bits()) == 0, "a certificate has decimals");
}

double Difference(Ball& x, Ball& y) {
  Ball difference;
  arb_sub(difference.get(), x.get(), y.get(), Bits());
  return arf_get_d(arb_midref(difference.get()), ARF_RND_NEAR);
}

}  // namespace

double Residual(const std::string& decimal, double number) {
  Ball x;
  Ball y;
  Read(decimal, x);
  arb_set_d(y.get(), number);
  return Difference(x, y);
}

double Residual(const std::string& decimal, const std::string& other) {
  Ball x;
  Ball y;
  Read(decimal, x);
  Read(other, y);
  return Difference(x, y);
}

}  // namespace ricochet::certified
