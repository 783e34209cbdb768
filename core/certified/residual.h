// Residual: the difference between a decimal of a certificate and another number, to double precision.
//
// A certificate has more digits than a double: the residual says how far a double, or a decimal with fewer digits, lies
// from it. Both numbers are read to far more digits than a certificate may have.
// A build without the component `certified` has no certificates and must not call these.

#ifndef RICOCHET_CORE_CERTIFIED_RESIDUAL_H_
#define RICOCHET_CORE_CERTIFIED_RESIDUAL_H_

#include <string>

namespace ricochet::certified {

// decimal - number, rounded to a double. `decimal` is a CertifiedNumber::decimal that is not empty; `number` is finite.
double Residual(const std::string& decimal, double number);
double Residual(const std::string& decimal, const std::string& other);

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_RESIDUAL_H_
