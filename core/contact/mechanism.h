// Free part: the coordinates of a mechanism that move during the impact, with their mass matrix and Jacobian, and
// X = M^-1 J^T with bounds on its error.
//
// X is solved by the Cholesky factor of M and corrected once by its residual R = J^T - M X, which is computed in twice
// the precision. W = J X + X^T R then errs by the square of the error of X only. M is scaled to a diagonal in [1, 4) by
// powers of two, which changes no digit. docs/theory/mechanism.md proves the bounds. This header includes Eigen.

#ifndef RICOCHET_CORE_CONTACT_MECHANISM_H_
#define RICOCHET_CORE_CONTACT_MECHANISM_H_

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "absl/types/span.h"
#include "ricochet/scene.h"

namespace ricochet {

// The coordinates that are not held, in rising order. A base in space has 6 of them, one in a plane 3. The Jacobian of
// a single contact tells which of both it is.
std::vector<Eigen::Index> FreeCoordinates(const Mechanism& mechanism, bool in_space);
std::vector<Eigen::Index> FreeCoordinates(const Mechanism& mechanism);

// The power of two that brings the entry > 0 of a diagonal into [1, 4) from both sides.
double MassScale(double diagonal);

// The smallest eigenvalue of a scaled matrix of n rows that counts as positive: 16 n eps.
double LeastEigenvalue(size_t n);

// Bounds on the roots of the diagonal entries of M^-1, and on the root of its trace, from the Cholesky factor and the
// trace of an M whose diagonal lies in [1, 4). They are infinite where M is singular to rounding.
struct InverseBounds {
  InverseBounds(const Eigen::LLT<Eigen::MatrixXd>& cholesky, double trace);

  Eigen::VectorXd roots;
  double norm;
};

// A symmetric matrix (n x n, row by row) with a positive diagonal, scaled by powers of two to one in [1, 4).
class ScaledMass {
 public:
  ScaledMass(const std::vector<double>& matrix, size_t n);

  // LeastEigenvalue of its size.
  double least() const { return least_; }
  // True if a Cholesky factor proves that all eigenvalues are above `least`. False may mean that some are close to it.
  bool IsSurelyDefinite() const;
  double SmallestEigenvalue() const;

 private:
  Eigen::MatrixXd matrix_;
  double least_;
};

struct FreePart {
  // The Jacobian may have the rows of several contacts; without `in_space` it has those of one.
  FreePart(const Mechanism& mechanism, bool in_space);
  explicit FreePart(const Mechanism& mechanism);

  std::vector<Eigen::Index> coordinates;
  Eigen::VectorXd scales;    // Powers of two: coordinate i is scales(i) times the scaled one.
  Eigen::MatrixXd mass, jt;  // Scaled: one row for each free coordinate; `jt` has a column for each row of J.
};

// Response holds X of a free part, with the same scaling.
struct Response {
  explicit Response(const FreePart& part);

  Eigen::LLT<Eigen::MatrixXd> cholesky;
  Eigen::MatrixXd x;         // M^-1 J^T
  Eigen::MatrixXd residual;  // J^T - M x, each entry to within an ulp and `doubt`.
  Eigen::MatrixXd doubt;
  Eigen::MatrixXd w;       // W
  Eigen::MatrixXd w_size;  // The sum of the magnitudes of the terms of each entry of W.
};

// M M^-1 J^T of all coordinates, from those that are free and M^-1 J^T (n x d, row by row), whose other rows are 0.
std::vector<double> MomentumOf(const Mechanism& mechanism, const std::vector<Eigen::Index>& free,
                               absl::Span<const double> response);

// J q' of all coordinates, row by row of J, and the sums of the magnitudes of its terms.
struct ContactMotion {
  explicit ContactMotion(const Mechanism& mechanism);
  std::vector<double> velocity, size;
};

// Bounds on what rounding has made of the reduction of a mechanism, in the units of the caller. They are infinite where
// no bound is known.
struct MechanismErrors {
  explicit MechanismErrors(const Mechanism& mechanism) : MechanismErrors(mechanism, FreePart(mechanism)) {}

  Response solved;
  ContactMotion motion;
  Eigen::MatrixXd w;         // d x d, errors of solved.w
  Eigen::VectorXd velocity;  // d, errors of motion.velocity
  Eigen::MatrixXd response;  // n x d, errors of M^-1 J^T

 private:
  MechanismErrors(const Mechanism& mechanism, const FreePart& part);
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_MECHANISM_H_
