// Perturbation puts relative errors on a computation on purpose, so that their growth can be seen in its result.
//
// The signs are pseudo-random (xorshift64) and follow from the seed; the size is the same throughout.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_PERTURBATION_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_PERTURBATION_H_

#include <cmath>
#include <cstdint>

namespace ricochet::compliant {

class Perturbation {
 public:
  // `seed` is not 0. A size of 0 changes nothing.
  Perturbation(uint64_t seed, double size) : bits_(seed), size_(size) {}

  // Returns the next relative error.
  double Next() {
    bits_ ^= bits_ << 13;
    bits_ ^= bits_ >> 7;
    bits_ ^= bits_ << 17;
    return (bits_ >> 63) == 0 ? size_ : -size_;
  }

  double On(double value) { return value + value * Next(); }

  // The error is relative to the terms, because rounding them makes one of that kind.
  double Sum(double x, double y) { return x + y + (std::fabs(x) + std::fabs(y)) * Next(); }

 private:
  uint64_t bits_;
  double size_;
};

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_PERTURBATION_H_
