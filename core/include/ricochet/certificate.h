// Certificate: numbers proved to as many decimal digits as were asked for, beside the doubles of an answer.
//
// The structs mirror ricochet.v1.Certificate field by field. docs/theory/certified.md says what is proved, and how.

#ifndef RICOCHET_CERTIFICATE_H_
#define RICOCHET_CERTIFICATE_H_

#include <string>
#include <vector>

#include "ricochet/regime.h"

namespace ricochet {

// A request may ask for at most this many significant digits.
inline constexpr int kMostCertifiedDigits = 1000;

struct CertifiedNumber {
  // Path of a number of an outcome, spelled as in ricochet/outcome_numbers.h, or of a number of Bounds:
  // "sharp.newton.upper".
  std::string path;
  // The decimal nearest to the number, with as many significant digits as asked for. If W is irrational and the number
  // lies too close to the middle of two decimals, either of them may stand here, within 1 of the last digit. An `exact`
  // decimal has no trailing zeros after the point. Empty if only [lower, upper] is proved.
  std::string decimal;
  std::string lower;  // Ends rounded outward to the digits asked for; empty if `decimal` is not.
  std::string upper;
  // The double nearest to the number, or to the middle of [lower, upper]; infinite above the largest double.
  double value = 0.0;
  bool exact = false;  // True if `decimal` is the number itself.
  friend bool operator==(const CertifiedNumber&, const CertifiedNumber&) = default;
};

struct Certificate {
  int digits = 0;
  int precision_bits = 0;       // Precision of the arithmetic that proved the digits.
  std::vector<Regime> regimes;  // Every regime that could not be excluded, in the order of the enum; as a rule one.
  bool is_set = false;          // True if for some number only the range [lower, upper] is proved.
  std::vector<CertifiedNumber> numbers;
  friend bool operator==(const Certificate&, const Certificate&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_CERTIFICATE_H_
