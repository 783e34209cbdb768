// CompensatedDot: a sum of products as good as if it were computed in twice the precision and rounded once.
//
// With n products its error is at most u |sum| + (n u)^2/(1 - n u)^2 times the sum of the magnitudes of the products,
// u = 2^-53 (Ogita, Rump and Oishi, 2005, Proposition 5.5). No product may overflow or underflow.

#ifndef RICOCHET_CORE_NUMERICS_COMPENSATED_DOT_H_
#define RICOCHET_CORE_NUMERICS_COMPENSATED_DOT_H_

#include <cmath>

namespace ricochet {

class CompensatedDot {
 public:
  explicit CompensatedDot(double start = 0.0) : sum_(start), size_(std::fabs(start)) {}

  void Add(double x, double y) {
    const double product = x * y;
    const double sum = sum_ + product;
    const double part = sum - sum_;
    const double lost = (sum_ - (sum - part)) + (product - part);
    correction_ += lost + std::fma(x, y, -product);
    sum_ = sum;
    size_ += std::fabs(product);
  }

  double value() const { return sum_ + correction_; }
  // The sum of the magnitudes of the terms.
  double size() const { return size_; }

 private:
  double sum_;
  double correction_ = 0.0;
  double size_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_COMPENSATED_DOT_H_
