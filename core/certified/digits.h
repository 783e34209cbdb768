// Certify: turns numbers into decimal digits, rounded by proof.
//
//   x = n 10^(e - digits + 1), where n is an integer of `digits` digits
//
// For a surd, or the root of one, n is read off a ball a few bits finer than the digits. If the ball holds the point
// that decides between n and n + 1, the surd is compared with that point exactly. So the digits are always the ones
// nearest to the number (half to even) or, where they are rounded outward, the next ones below or above it.

#ifndef RICOCHET_CORE_CERTIFIED_DIGITS_H_
#define RICOCHET_CORE_CERTIFIED_DIGITS_H_

#include <optional>

#include "core/certified/arf_interval.h"
#include "core/certified/contact_path.h"
#include "core/certified/surd.h"
#include "ricochet/certificate.h"

namespace ricochet::certified {

// Returns the precision of the arithmetic for so many decimal digits, with 64 bits to spare.
slong BitsOf(int digits);

// Sets every field but the path.
CertifiedNumber Certify(const Number<Surd>& number, int digits);

// Returns nothing unless the interval is narrow enough to prove the digits: a millionth of a unit in the last one.
std::optional<CertifiedNumber> Certify(const ArfInterval& interval, int digits);

// Gives the interval itself, with its ends rounded outward to the digits.
CertifiedNumber CertifyRange(const ArfInterval& interval, int digits);

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_DIGITS_H_
