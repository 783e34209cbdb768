#include "core/study/audit_columns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/numerics/products.h"
#include "ricochet/error.h"

namespace ricochet::audit {
namespace {

using Receiver = absl::FunctionRef<void(int64_t row, const AuditReport& report)>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kRankTolerance = 4.0 * kEpsilon;

struct Column {
  const char* name;
  absl::Span<const double> values;
  bool has_default = false;
};

absl::Status CheckLengths(const std::vector<Column>& columns, int64_t rows) {
  std::vector<Violation> violations;
  for (const Column& column : columns) {
    const auto length = static_cast<int64_t>(column.values.size());
    if (length == 1 || length == rows || (length == 0 && column.has_default)) continue;
    violations.push_back({column.name, absl::StrCat("has ", length, " values: must have 1 or ", rows)});
  }
  return violations.empty() ? absl::OkStatus() : InvalidRequest(violations);
}

double ValueAt(absl::Span<const double> column, int64_t row, double otherwise = 0.0) {
  if (column.empty()) return otherwise;
  return column.size() == 1 ? column[0] : column[static_cast<size_t>(row)];
}

bool AllFinite(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

// a d - b^2 >= 0 up to the rounding of W's entries, for the minor [a b; b d].
bool MinorIsSemidefinite(double a, double b, double d) {
  return DifferenceOfProducts(a, d, b, b) >= -kRankTolerance * a * d;
}

bool IsValid(const planar::Problem& in, const PlanarObservation& seen) {
  if (!AllFinite({in.w.tt, in.w.tn, in.w.nn, in.u0, in.v0, in.mu, in.mu_static, seen.u1, seen.v1, seen.uncertainty})) {
    return false;
  }
  if (in.mu < 0.0 || in.mu_static < in.mu || seen.uncertainty < 0.0) return false;
  if (in.w.tt < 0.0 || !(in.w.nn > 0.0) || !MinorIsSemidefinite(in.w.tt, in.w.tn, in.w.nn)) return false;
  const double det = DifferenceOfProducts(in.w.tt, in.w.nn, in.w.tn, in.w.tn);
  if (det > kRankTolerance * in.w.tt * in.w.nn) return true;
  const double off_range = DifferenceOfProducts(in.u0, in.w.nn, in.v0, in.w.tn);
  return std::abs(off_range) <= 8.0 * kEpsilon * (std::abs(in.u0) * in.w.nn + std::abs(in.v0 * in.w.tn));
}

bool IsSemidefinite(const spatial::Problem& in) {
  if (in.w11 < 0.0 || in.w22 < 0.0 || !(in.w33 > 0.0)) return false;
  if (!MinorIsSemidefinite(in.w11, in.w12, in.w22) || !MinorIsSemidefinite(in.w11, in.w13, in.w33) ||
      !MinorIsSemidefinite(in.w22, in.w23, in.w33)) {
    return false;
  }
  // det W Wnn from the minors that hold Wnn, Sylvester's identity, up to what the rounding of the entries makes of it.
  const double m11 = DifferenceOfProducts(in.w11, in.w33, in.w13, in.w13);
  const double m22 = DifferenceOfProducts(in.w22, in.w33, in.w23, in.w23);
  const double m12 = DifferenceOfProducts(in.w12, in.w33, in.w13, in.w23);
  const double terms = in.w11 * in.w22 * in.w33 * in.w33;
  return DifferenceOfProducts(m11, m22, m12, m12) >= -4.0 * kRankTolerance * terms;
}

bool IsValid(const spatial::Problem& in, const SpatialObservation& seen) {
  return AllFinite({in.w11, in.w12, in.w13, in.w22, in.w23, in.w33, in.u0[0], in.u0[1], in.v0, in.mu, in.mu_static,
                    seen.u1[0], seen.u1[1], seen.v1, seen.uncertainty}) &&
         in.mu >= 0.0 && in.mu_static >= in.mu && seen.uncertainty >= 0.0 && IsSemidefinite(in);
}

void Count(int64_t row, Tally& tally) {
  if (tally.count == 0) tally.first_index = row;
  ++tally.count;
}

template <typename Problem, typename Observation>
AuditReport AuditRow(const Problem& problem, const Observation& seen) {
  if (IsValid(problem, seen)) {
    const AuditReport report = Audit(problem, seen);
    if (OverflowIn(report) == nullptr) return report;
  }
  return {.regime = Regime::kInvalid};
}

std::vector<Column> ListOf(const PlanarColumns& in) {
  return {{"wtt", in.wtt}, {"wtn", in.wtn}, {"wnn", in.wnn}, {"mu", in.mu}, {"mu_static", in.mu_static, true},
          {"u0", in.u0},   {"v0", in.v0},   {"u1", in.u1},   {"v1", in.v1}, {"uncertainty", in.uncertainty, true}};
}

std::vector<Column> ListOf(const SpatialColumns& in) {
  return {{"w11", in.w11},
          {"w12", in.w12},
          {"w13", in.w13},
          {"w22", in.w22},
          {"w23", in.w23},
          {"w33", in.w33},
          {"mu", in.mu},
          {"mu_static", in.mu_static, true},
          {"u0[0]", in.u0[0]},
          {"u0[1]", in.u0[1]},
          {"v0", in.v0},
          {"u1[0]", in.u1[0]},
          {"u1[1]", in.u1[1]},
          {"v1", in.v1},
          {"uncertainty", in.uncertainty, true}};
}

planar::Problem ProblemAt(const PlanarColumns& in, int64_t row) {
  const double mu = ValueAt(in.mu, row);
  return {.w = {ValueAt(in.wtt, row), ValueAt(in.wtn, row), ValueAt(in.wnn, row)},
          .u0 = ValueAt(in.u0, row),
          .v0 = ValueAt(in.v0, row),
          .mu = mu,
          .mu_static = ValueAt(in.mu_static, row, mu)};
}

spatial::Problem ProblemAt(const SpatialColumns& in, int64_t row) {
  const double mu = ValueAt(in.mu, row);
  return {.w11 = ValueAt(in.w11, row),
          .w12 = ValueAt(in.w12, row),
          .w13 = ValueAt(in.w13, row),
          .w22 = ValueAt(in.w22, row),
          .w23 = ValueAt(in.w23, row),
          .w33 = ValueAt(in.w33, row),
          .u0 = {ValueAt(in.u0[0], row), ValueAt(in.u0[1], row)},
          .v0 = ValueAt(in.v0, row),
          .mu = mu,
          .mu_static = ValueAt(in.mu_static, row, mu),
          .tolerance = in.tolerance};
}

PlanarObservation ObservationAt(const PlanarColumns& in, int64_t row) {
  return {ValueAt(in.u1, row), ValueAt(in.v1, row), ValueAt(in.uncertainty, row)};
}

SpatialObservation ObservationAt(const SpatialColumns& in, int64_t row) {
  return {{ValueAt(in.u1[0], row), ValueAt(in.u1[1], row)}, ValueAt(in.v1, row), ValueAt(in.uncertainty, row)};
}

template <typename Columns>
absl::StatusOr<AuditSummary> AuditRows(const Columns& in, Receiver receive) {
  AuditSummary summary;
  if (in.rows == 0) return summary;
  if (absl::Status status = CheckLengths(ListOf(in), in.rows); !status.ok()) return status;
  for (int64_t row = 0; row < in.rows; ++row) {
    AuditReport report = AuditRow(ProblemAt(in, row), ObservationAt(in, row));
    Add(row, report, summary);
    receive(row, report);
  }
  return summary;
}

}  // namespace

void Add(int64_t row, const AuditReport& report, AuditSummary& summary) {
  ++summary.rows;
  if (report.regime == Regime::kInvalid) return Count(row, summary.invalid);
  if (report.admissible) ++summary.admissible;
  if (report.unexplained) Count(row, summary.unexplained);
  for (size_t i = 0; i < report.limits.size(); ++i) {
    const LimitCheck& check = report.limits[i];
    if (check.verdict == Verdict::kWithinUncertainty) Count(row, summary.within_uncertainty[i]);
    if (check.verdict != Verdict::kBroken) continue;
    Count(row, summary.broken[i]);
    summary.largest_excess[i] = std::max(summary.largest_excess[i], check.excess);
  }
}

absl::StatusOr<AuditSummary> AuditColumns(const PlanarColumns& columns, Receiver receive) {
  return AuditRows(columns, receive);
}

absl::StatusOr<AuditSummary> AuditColumns(const SpatialColumns& columns, Receiver receive) {
  return AuditRows(columns, receive);
}

}  // namespace ricochet::audit
