// AlignedVector: a std::vector whose first element begins a cache line, because a SIMD load that crosses two lines
// takes twice as long.

#ifndef RICOCHET_CORE_NUMERICS_ALIGNED_VECTOR_H_
#define RICOCHET_CORE_NUMERICS_ALIGNED_VECTOR_H_

#include <cstddef>
#include <new>
#include <vector>

namespace ricochet {

template <typename T>
class CacheLineAllocator {
 public:
  using value_type = T;

  CacheLineAllocator() = default;
  template <typename Other>
  CacheLineAllocator(const CacheLineAllocator<Other>& /*other*/) {}  // NOLINT: std::vector converts allocators.

  T* allocate(size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* place, size_t /*count*/) { ::operator delete(place, kLine); }

  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }

 private:
  static constexpr std::align_val_t kLine{64};  // In bytes, the size of a line and of the widest vector on x86.
};

template <typename T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_ALIGNED_VECTOR_H_
