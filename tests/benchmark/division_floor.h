// DivisionsAndRoots: the operations of a closed form that take the longest, in the lanes of the widest SIMD target that
// the core uses. They are a floor for the time of anything that needs them.

#ifndef RICOCHET_TESTS_BENCHMARK_DIVISION_FLOOR_H_
#define RICOCHET_TESTS_BENCHMARK_DIVISION_FLOOR_H_

#include <cstddef>

namespace ricochet::bench {

// Reads a number per point, divides by it and takes square roots of it as often as asked, independently of one another,
// and writes one number per point. `count` is a multiple of the lanes.
void DivisionsAndRoots(int divisions, int roots, size_t count, const double* from, double* to);

}  // namespace ricochet::bench

#endif  // RICOCHET_TESTS_BENCHMARK_DIVISION_FLOOR_H_
