// Problem: several contacts at one instant, as orders, springs and the possible outcomes take them.
//
//   v+ = v- + W p,   W = J M^-1 J^T,   |p_t| <= mu p_n at each contact
//
// The d = 2 or 3 numbers of a contact stand in the order t, n or t1, t2, n. W is positive semidefinite, of any rank,
// and v- lies in its range. Bad input: none gets here (core/scene/validate_multi.h). Units are SI.

#ifndef RICOCHET_CORE_MULTI_PROBLEM_H_
#define RICOCHET_CORE_MULTI_PROBLEM_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "ricochet/multi_contact.h"

namespace ricochet::multi {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// At most 16 contacts in space have 48 numbers, which lie in place.
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, 3 * kMostContacts, 1>;

// The place of a contact, or of one of its numbers, in an array.
inline size_t At(Eigen::Index i) { return static_cast<size_t>(i); }

struct ContactLaw {
  double mu = 0.0;         // >= 0
  double e = 0.0;          // energetic, in [0, 1]
  double stiffness = 1.0;  // > 0
};

struct Problem {
  int d = 2;  // Directions of a contact.
  int k = 0;  // Contacts.
  Eigen::MatrixXd w = {};
  Vector v = {};  // before
  std::vector<ContactLaw> laws = {};

  int N(int contact) const { return d * contact + d - 1; }  // The place of the normal direction of a contact.
  int T(int contact) const { return d * contact; }          // The place of its first tangential direction.
  bool AreCoupled(int i, int j) const { return !w.block(T(i), T(j), d, d).isZero(0.0); }
};

struct ContactWorks {
  double compression = 0.0, restitution = 0.0, friction = 0.0;  // J
  double compression_impulse = 0.0;                             // normal, N s
};

// An outcome that an order or springs attain. The velocities are v = v- + W p up to a rounding of `slack`.
struct Attained {
  std::vector<int> order;  // Contacts in the order of their impacts.
  int repeats_from = -1;   // From this place on the order repeats without end, if it is >= 0.
  MultiContactEnd end = MultiContactEnd::kUnspecified;
  int64_t events = 0;
  Vector v, p;
  Vector slack;
  // The error of p. Of springs it is known that the velocity which it makes has at most the norm `error` in the metric
  // of kinetic energy. Of orders it is a sum of `error_terms` vectors, the sum of whose squares x x^T is
  // `error_squares`.
  double error = 0.0;
  Eigen::MatrixXd error_squares;
  double error_terms = 0.0;
  Vector normal_impulse_error;  // Springs have one for each contact.
  double work_error = 0.0;
  bool error_is_proved = true;
  bool split_is_unique = true;
  std::array<ContactWorks, kMostContacts> works;

  // A bound on the error of row . p, where an impulse along the row has the energy mobility/2.
  double ErrorOfRow(const Vector& row, double mobility) const {
    double sum = error * std::sqrt(mobility);
    if (error_terms > 0.0) sum += std::sqrt(error_terms * std::max(row.dot(error_squares * row), 0.0));
    return sum * (1.0 + 4.0 * kEpsilon);
  }
  // A bound on the error of component j of the velocity.
  double ErrorOf(const Problem& problem, int j) const {
    return ErrorOfRow(problem.w.col(j), problem.w(j, j)) + slack(j);
  }
  double ErrorOfNormalImpulse(const Problem& problem, int contact) const {
    const int n = problem.N(contact);
    const double squares = error_terms > 0.0 ? error_terms * std::max(error_squares(n, n), 0.0) : 0.0;
    return normal_impulse_error(contact) + std::sqrt(squares);
  }
};

// An outcome that starts from the state before.
inline Attained StartOf(const Problem& problem) {
  Attained start;
  start.v = problem.v;
  start.p = start.slack = Vector::Zero(problem.v.size());
  start.normal_impulse_error = Vector::Zero(problem.k);
  return start;
}

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_PROBLEM_H_
