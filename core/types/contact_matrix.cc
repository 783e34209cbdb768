#include "ricochet/contact_matrix.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "core/base/decimal.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

// Two entries across the diagonal may differ by this part of the largest entry on the diagonal.
constexpr double kSymmetric = 1e-9;

absl::Status CheckSymmetric(std::span<const double> w, size_t rows, std::string_view frame) {
  double largest = 0.0;
  for (size_t i = 0; i < rows; ++i) largest = std::max(largest, std::fabs(w[i * rows + i]));
  std::vector<Violation> violations;
  for (size_t i = 0; i < rows; ++i) {
    for (size_t j = i + 1; j < rows; ++j) {
      const double upper = w[i * rows + j];
      const double lower = w[j * rows + i];
      // The rules of the contact see the entries on the diagonal and above it alone.
      if (!std::isfinite(lower)) {
        violations.push_back(MakeViolation(absl::StrCat("w_per_kg[", j, "][", i, "]"), lower, "be finite"));
        continue;
      }
      if (!(std::fabs(upper - lower) > kSymmetric * largest)) continue;
      violations.push_back(MakeViolation(
          absl::StrCat("w_per_kg[", j, "][", i, "]"), lower,
          absl::StrCat("be equal to [", i, "][", j, "] = ", ShortestDecimal(upper),
                       ", as W is symmetric in the frame (", absl::string_view(frame.data(), frame.size()), ")")));
    }
  }
  return violations.empty() ? absl::OkStatus() : InvalidRequest(violations);
}

}  // namespace

absl::StatusOr<PlanarContact> ContactFrom(std::span<const double, 4> w, double tangential_m_s, double normal_m_s,
                                          std::string_view frame) {
  if (absl::Status status = CheckSymmetric(w, 2, frame); !status.ok()) return status;
  return PlanarContact{.w_tt_per_kg = w[0],
                       .w_tn_per_kg = w[1],
                       .w_nn_per_kg = w[3],
                       .tangential_m_s = tangential_m_s,
                       .normal_m_s = normal_m_s};
}

absl::StatusOr<SpatialContact> ContactFrom(std::span<const double, 9> w, std::array<double, 2> tangential_m_s,
                                           double normal_m_s, std::string_view frame) {
  if (absl::Status status = CheckSymmetric(w, 3, frame); !status.ok()) return status;
  return SpatialContact{.w_per_kg = {w[0], w[1], w[2], w[4], w[5], w[8]},
                        .tangential_m_s = {tangential_m_s.begin(), tangential_m_s.end()},
                        .normal_m_s = normal_m_s};
}

}  // namespace ricochet
