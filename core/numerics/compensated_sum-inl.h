// Sum: a sum of products as good as if it were computed in twice the precision and rounded once; V is a double or a
// vector of them (core/numerics/lanes-inl.h). core/numerics/compensated_sums.h has the bound of its error.

// Per-target include guard.
#if defined(RICOCHET_CORE_NUMERICS_COMPENSATED_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_NUMERICS_COMPENSATED_SUM_INL_H_
#undef RICOCHET_CORE_NUMERICS_COMPENSATED_SUM_INL_H_
#else
#define RICOCHET_CORE_NUMERICS_COMPENSATED_SUM_INL_H_
#endif

#include "core/numerics/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

template <typename V>
class Sum {
 public:
  HWY_INLINE explicit Sum(V start) : sum_(start), size_(Absolute(start)) {}

  HWY_INLINE void Add(V x, V y) {
    const V product = x * y;
    const V sum = sum_ + product;
    const V part = sum - sum_;
    const V lost = (sum_ - (sum - part)) + (product - part);
    correction_ = correction_ + (lost + FmaSubtract(x, y, product));
    sum_ = sum;
    size_ = size_ + Absolute(product);
  }

  HWY_INLINE V value() const { return sum_ + correction_; }
  HWY_INLINE V size() const { return size_; }

 private:
  V sum_;
  V correction_ = Lanes<V>::Fill(0.0);
  V size_;
};

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
