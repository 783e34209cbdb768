// Sin, Cos, Exp, Log, Pow, Hypot: elementary functions whose bits do not depend on the processor.
//
// The C library's functions choose their code by the instructions that the processor has, and their last bits differ.
// These are the scalar "cinz" functions of SLEEF 3.5 (https://sleef.org), which that library promises to give the same
// bits on every platform: each product and sum is rounded by itself, never fused, and nothing is chosen at run time.
// Hypot is written here, because SLEEF's Hypot loses its accuracy close to underflow.
//
// Accuracy: kElementaryUlps, in ulp of the exact result, which SLEEF states and the tests hold every function to; the
// worst they see are 0.72 (Sin, Cos), 0.93 (Exp), 0.66 (Log), 0.65 (Pow) and, close to underflow, 0.73 (Hypot). Sin and
// Cos reduce arguments of any size by as many bits of 2/pi as these need. Sin(0), Cos(0), Exp(0), Log(1), Pow(x, 0) and
// Pow(x, 1) are exact.
// Bad input: for an infinity, Log(0) or a negative argument the result is the limit or the NaN that C prescribes.

#ifndef RICOCHET_CORE_NUMERICS_ELEMENTARY_H_
#define RICOCHET_CORE_NUMERICS_ELEMENTARY_H_

namespace ricochet {

inline constexpr double kElementaryUlps = 1.0;

double Sin(double radians);
double Cos(double radians);
double Exp(double x);
double Log(double x);
double Pow(double base, double exponent);
double Hypot(double x, double y);  // sqrt(x^2 + y^2)

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_ELEMENTARY_H_
