// Certificates as tests read them: numbers by path, digits as balls.

#ifndef RICOCHET_TESTS_SUPPORT_ORACLES_CERTIFICATES_H_
#define RICOCHET_TESTS_SUPPORT_ORACLES_CERTIFICATES_H_

#include <gtest/gtest.h>

#include <string>

#include "ricochet/certificate.h"
#include "tests/support/oracles/arb.h"

namespace ricochet {

inline constexpr slong kTestBits = 4096;

// A caller that never stops what it has asked for.
inline bool Never() { return false; }

// The number at `path`; one without a path where there is none.
inline CertifiedNumber NumberAt(const Certificate& certificate, const std::string& path) {
  for (const CertifiedNumber& number : certificate.numbers) {
    if (number.path == path) return number;
  }
  return {};
}

inline std::string DecimalAt(const Certificate& certificate, const std::string& path) {
  return NumberAt(certificate, path).decimal;
}

// A decimal, to far more than its digits.
inline Ball Digits(const std::string& decimal) { return Ball::Parse(decimal, kTestBits); }

// Returns whether two decimals differ by less than 10^-digits of the first, or are both 0.
inline bool Agree(const std::string& x, const std::string& y, int digits) {
  Ball allowed = Abs(Digits(x));
  for (int i = 0; i < digits; ++i) allowed = allowed / Ball(10.0, kTestBits);
  return Abs(Digits(x) - Digits(y)) <= allowed;
}

// Returns whether a range or a decimal of `set` holds the decimal.
inline bool Holds(const CertifiedNumber& set, const std::string& decimal) {
  if (!set.decimal.empty()) return Agree(set.decimal, decimal, 15);
  const bool above = set.lower == "-inf" || Digits(set.lower) <= Digits(decimal);
  return above && (set.upper == "inf" || Digits(decimal) <= Digits(set.upper));
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_ORACLES_CERTIFICATES_H_
