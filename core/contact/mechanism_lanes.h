// Mechanism lanes: reduces many states of one mechanism, each with one contact in space, in SIMD lanes.
//
// The steps are those of core/contact/mechanism.h: X = M^-1 J^T by the Cholesky factor of the scaled M, corrected once
// by its residual in twice the precision, and W = J X + X^T R. All targets give the same bits.

#ifndef RICOCHET_CORE_CONTACT_MECHANISM_LANES_H_
#define RICOCHET_CORE_CONTACT_MECHANISM_LANES_H_

#include <array>
#include <cstddef>

#include "absl/types/span.h"
#include "ricochet/system.h"

namespace ricochet {

// States of more coordinates are not reduced here: the matrices of all lanes would take too much memory.
inline constexpr size_t kMostInLanes = 64;

// One state of n coordinates: M (n x n), J (3 x n: t1, t2, n) and q' (n), and what they are reduced to.
struct MechanismState {
  const double* mass;
  const double* jacobian;
  const double* rates;
  double* response;              // M^-1 J^T, n x 3, of the coordinates that are free. The others stay as they are.
  std::array<double, 6> w = {};  // Upper triangle, row by row.
  std::array<double, 3> velocity = {};
  // False if M may not be positive definite or W not of full rank, or a number leaves the range of doubles. Then the
  // numbers above mean nothing, and Reduce (core/contact/reduction.h) must decide.
  bool is_reduced = false;
};

// Reduces states of as many coordinates as `form` has rates, at most kMostInLanes, and with those held that it holds.
// Its numbers do not matter.
void ReduceInLanes(const Mechanism& form, absl::Span<MechanismState> states);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_MECHANISM_LANES_H_
