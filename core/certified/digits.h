// Numbers as decimal digits, rounded by proof.
//
//   x = n 10^(e - digits + 1), n an integer of `digits` digits
//
// For a surd, or the root of one, n is read off a ball a few bits finer than the digits; where the ball holds the point
// that decides between n and n + 1, the surd is compared with it exactly. So the digits are always those nearest to the
// number (half to even) or, rounded outward, the next ones below or above it.

#ifndef RICOCHET_CORE_CERTIFIED_DIGITS_H_
#define RICOCHET_CORE_CERTIFIED_DIGITS_H_

#include <optional>
#include <string>

#include "core/certified/arf_interval.h"
#include "core/certified/contact_path.h"
#include "core/certified/surd.h"
#include "ricochet/certificate.h"

namespace ricochet::certified {

// The bits of the arithmetic that `digits` decimal digits are taken from, with 64 to spare.
slong BitsOf(int digits);

// All but the path.
CertifiedNumber Certify(const Number<Surd>& number, int digits);

// Nothing unless the interval is narrow enough to prove the digits: a millionth of a unit in the last one.
std::optional<CertifiedNumber> Certify(const ArfInterval& interval, int digits);

// As a set, its ends rounded outward to the digits.
CertifiedNumber CertifyRange(const ArfInterval& interval, int digits);

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_DIGITS_H_
