#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/counted.h"
#include "core/base/decimal.h"
#include "core/contact/mechanism.h"
#include "core/scene/check.h"

namespace ricochet {
namespace {

constexpr char kMass[] = "mechanism.mass_matrix";
constexpr char kJacobian[] = "mechanism.jacobian";
constexpr char kKept[] = "mechanism.kept_coordinates";

// The entries of a free body's part of M and J may be off by this much, relative to its mass or to 1, so that matrices
// that were rounded to single precision are accepted.
constexpr double kBaseRounding = 1e-6;

std::string EntryOf(const char* field, size_t entry) { return absl::StrCat(field, "[", entry, "]"); }

// Returns whether the sizes of M, J and q' agree.
bool CheckSizes(const Mechanism& mechanism, size_t contacts, Check& check) {
  const size_t n = mechanism.rates.size();
  check.Require(n > 0, [] { return MakeViolation("mechanism.rates", "has 0 entries", "have at least one"); });
  if (n == 0) return false;
  const size_t mass = mechanism.mass_matrix.size();
  check.Require(mass == n * n, [&] {
    return MakeViolation(kMass, absl::StrCat("has ", Counted(mass, "entry")),
                         absl::StrCat("have n x n = ", n * n, " for the ", n, " of rates"));
  });
  const size_t jacobian = mechanism.jacobian.size();
  const size_t row = contacts * n;
  check.Require(jacobian == 2 * row || jacobian == 3 * row, [&] {
    const std::string times = contacts == 1 ? " x n = " : absl::StrCat(" x ", contacts, " x n = ");
    return MakeViolation(kJacobian, absl::StrCat("has ", Counted(jacobian, "entry")),
                         absl::StrCat("have 2", times, 2 * row, " in a plane or 3", times, 3 * row,
                                      " in space, for the ", n, " of rates"));
  });
  return mass == n * n && (jacobian == 2 * row || jacobian == 3 * row);
}

// M as it is given is symmetric: an entry that differs from the one across the diagonal is named, not averaged.
bool CheckSymmetry(const Mechanism& mechanism, Check& check) {
  const std::vector<double>& mass = mechanism.mass_matrix;
  const size_t n = mechanism.rates.size();
  bool holds = true;
  for (size_t i = 0; i < n && !(check.IsFull() && !holds); ++i) {
    for (size_t j = i + 1; j < n; ++j) {
      const double upper = mass[i * n + j];
      const double lower = mass[j * n + i];
      if (upper == lower) continue;
      holds = false;
      check.Require(false, [&] {
        return MakeViolation(EntryOf(kMass, j * n + i), lower,
                             absl::StrCat("be equal to the entry across the diagonal, [", i * n + j,
                                          "] = ", ShortestDecimal(upper), " (row ", i, ", column ", j,
                                          "); where they differ by rounding alone, (M + M^T)/2 is symmetric"),
                             {EntryOf(kMass, i * n + j)});
      });
    }
  }
  return holds;
}

void CheckDefinite(const Mechanism& mechanism, Check& check) {
  const std::vector<double>& mass = mechanism.mass_matrix;
  const size_t n = mechanism.rates.size();
  bool is_positive = true;
  for (size_t i = 0; i < n; ++i) {
    const double diagonal = mass[i * n + i];
    is_positive &= diagonal > 0.0;
    check.Require(diagonal > 0.0, [&] {
      return MakeViolation(EntryOf(kMass, i * n + i), diagonal, "be > 0: it lies on the diagonal of a definite matrix");
    });
  }
  if (!is_positive) return;
  const ScaledMass scaled(mass, n);
  if (scaled.IsSurelyDefinite()) return;
  const double eigenvalue = scaled.SmallestEigenvalue();
  check.Require(eigenvalue > scaled.least(), [&] {
    return MakeViolation(
        kMass, absl::StrCat("has the eigenvalue ", ShortestDecimal(eigenvalue), " when scaled to a diagonal in [1, 4)"),
        absl::StrCat("be positive definite, with eigenvalues above rounding, ", ShortestDecimal(scaled.least())),
        ViolationKind::kValue, EntriesOf(kMass, n * n));
  });
}

void CheckKept(const Mechanism& mechanism, Check& check) {
  const std::vector<int32_t>& kept = mechanism.kept_coordinates;
  const size_t n = mechanism.rates.size();
  std::vector<bool> is_held(n);
  for (size_t i = 0; i < kept.size(); ++i) {
    const bool exists = kept[i] >= 0 && static_cast<size_t>(kept[i]) < n;
    check.Require(exists, [&] {
      return MakeViolation(EntryOf(kKept, i), kept[i], absl::StrCat("be in [0, ", n, "), the coordinates of rates"));
    });
    if (!exists) continue;
    check.Require(!is_held[static_cast<size_t>(kept[i])],
                  [&] { return MakeViolation(EntryOf(kKept, i), kept[i], "be named once"); });
    is_held[static_cast<size_t>(kept[i])] = true;
  }
  check.Require(kept.empty() || !mechanism.composite,
                [] { return MakeViolation(kKept, "is set beside composite", "not be, composite holds all joints"); });
}

// True if the linear velocity of a free body takes the `axes` coordinates from `first` on. The first contact tells.
bool MovesAsBody(const Mechanism& mechanism, size_t first, size_t axes) {
  const size_t n = mechanism.rates.size();
  const double mass = mechanism.mass_matrix[first * n + first];
  for (size_t i = 0; i < axes; ++i) {
    for (size_t j = 0; j < axes; ++j) {
      const double unit = i == j ? 1.0 : 0.0;
      const double entry = mechanism.mass_matrix[(first + i) * n + first + j];
      double product = 0.0;  // The scalar product of two columns of J.
      for (size_t row = 0; row < axes; ++row) {
        product += mechanism.jacobian[row * n + first + i] * mechanism.jacobian[row * n + first + j];
      }
      if (!(std::fabs(entry / mass - unit) <= kBaseRounding)) return false;
      if (!(std::fabs(product - unit) <= kBaseRounding)) return false;
    }
  }
  return true;
}

// In a plane a base has one angular velocity and two axes, in space three of each.
void CheckBase(const Mechanism& mechanism, bool in_space, Check& check) {
  const size_t axes = in_space ? 3 : 2;
  const size_t base = in_space ? 6 : 3;
  const bool has_base =
      mechanism.rates.size() >= base && (MovesAsBody(mechanism, 0, axes) || MovesAsBody(mechanism, base - axes, axes));
  check.Require(has_base, [&] {
    return MakeViolation(
        "mechanism.composite", "is set",
        absl::StrCat("not be without a floating base: the first ", base,
                     " coordinates must be those of a free body, its velocity along orthonormal axes (the mass on the "
                     "diagonal of mass_matrix, a rotation in jacobian) before or after its angular velocity"));
  });
}

}  // namespace

void CheckMechanism(const Mechanism& mechanism, size_t contacts, Check& check) {
  if (!CheckSizes(mechanism, contacts, check)) return;
  CheckKept(mechanism, check);
  if (!AllFinite(mechanism.mass_matrix) || !CheckSymmetry(mechanism, check)) return;
  CheckDefinite(mechanism, check);
  if (mechanism.composite && AllFinite(mechanism.jacobian)) {
    CheckBase(mechanism, mechanism.jacobian.size() == 3 * contacts * mechanism.rates.size(), check);
  }
}

}  // namespace ricochet
