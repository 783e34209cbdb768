// Certificate: numbers proved to as many decimal digits as were asked for, beside the doubles of an answer.
//
// Mirrors ricochet.v1.Certificate field by field. core/certified/certified.h says what is proved, and how.

#ifndef RICOCHET_CERTIFICATE_H_
#define RICOCHET_CERTIFICATE_H_

#include <string>
#include <vector>

#include "ricochet/regime.h"

namespace ricochet {

// The most significant digits that can be asked for.
inline constexpr int kMostCertifiedDigits = 1000;

struct CertifiedNumber {
  std::string path;  // As ricochet/outcome_numbers.h spells it; of bounds, from Bounds on: "sharp.newton.upper".
  // Significant decimal digits as asked, the nearest to the number; of a number that an irrational W keeps too close to
  // the middle of two, either neighbour, within 1 of the last digit. Trailing zeros after the point are left out where
  // `exact`. Empty where all that is proved is [lower, upper].
  std::string decimal;
  std::string lower;  // Rounded outward to the digits asked; empty where `decimal` is not.
  std::string upper;
  double value =
      0.0;  // The double nearest to the number, or to the middle of [lower, upper]; infinite above the largest.
  bool exact = false;  // `decimal` is the number itself.
  friend bool operator==(const CertifiedNumber&, const CertifiedNumber&) = default;
};

struct Certificate {
  int digits = 0;
  int precision_bits = 0;       // Of the arithmetic that the digits were taken from.
  std::vector<Regime> regimes;  // One; of a set every regime that could not be excluded, in the order of the enum.
  bool is_set = false;          // Of ranges; or some number is proved to lie between `lower` and `upper` alone.
  std::vector<CertifiedNumber> numbers;
  friend bool operator==(const Certificate&, const Certificate&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_CERTIFICATE_H_
