// Random scenes of several contacts in a plane, exact as doubles: W = J M^-1 J^T and the velocity J q' have no
// rounding, so that contacts whose rows are dependent are so exactly.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_RANDOM_MULTI_CONTACT_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_RANDOM_MULTI_CONTACT_H_

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "core/multi/problem.h"

namespace ricochet::multi {

// A multiple of 2^-6 in [low, high].
inline double Dyadic(double low, double high, std::mt19937_64& random) {
  std::uniform_int_distribution<int> steps(static_cast<int>(std::lround(low * 64)),
                                           static_cast<int>(std::lround(high * 64)));
  return steps(random) / 64.0;
}

// Two to four contacts: feet of one body at one height, contacts anywhere of one body, of two, or of as many as they
// need. At least one approaches. With `springs` all coefficients of restitution are above 0.
inline Problem RandomMultiContact(std::mt19937_64& random, bool springs) {
  std::uniform_int_distribution<int> counts(2, 4), kinds(0, 4), tenths(0, 9);
  for (;;) {
    const int k = counts(random);
    const int kind = kinds(random);
    const int n = kind <= 1 ? 3 : kind == 2 ? 6 : kind == 3 ? 2 * k : k + 1;
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(Eigen::Index{2} * k, n);
    const double height = Dyadic(-1.0, 1.0, random);
    for (Eigen::Index i = 0; i < k; ++i) {
      if (kind == 0) {
        j.row(2 * i) << 1.0, 0.0, height;
        j.row(2 * i + 1) << 0.0, 1.0, Dyadic(-1.0, 1.0, random);
      } else if (kind == 4) {
        // A row of balls without friction.
        j(2 * i + 1, i) = -1.0;
        j(2 * i + 1, i + 1) = 1.0;
      } else {
        for (int c = 0; c < n; ++c) {
          j(2 * i, c) = Dyadic(-1.0, 1.0, random);
          j(2 * i + 1, c) = Dyadic(-1.0, 1.0, random);
        }
      }
    }
    Eigen::VectorXd mobility(n), rates(n);
    for (int c = 0; c < n; ++c) {
      mobility(c) = Dyadic(0.25, 2.0, random);
      rates(c) = Dyadic(-1.0, 1.0, random);
    }
    if (kind == 0 && tenths(random) < 3) rates(0) = -height * rates(2);  // No slip.
    Problem problem = {.d = 2, .k = k};
    problem.w = j * mobility.asDiagonal() * j.transpose();
    problem.v = j * rates;
    bool approaches = false, moves = true;
    for (int i = 0; i < k; ++i) {
      ContactLaw law = {.mu = kind == 4 || tenths(random) < 2 ? 0.0 : Dyadic(0.0, 1.0, random),
                        .e = Dyadic(springs ? 0.125 : 0.0, 1.0, random),
                        .stiffness = std::ldexp(1.0, tenths(random) - 4)};
      if (!springs && tenths(random) < 2) law.e = 0.0;
      if (tenths(random) < 2) law.e = 1.0;
      problem.laws.push_back(law);
      approaches = approaches || problem.v(2 * i + 1) < 0.0;
      moves = moves && problem.w(2 * i + 1, 2 * i + 1) > 0.0;
    }
    if (approaches && moves) return problem;
  }
}

}  // namespace ricochet::multi

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_RANDOM_MULTI_CONTACT_H_
