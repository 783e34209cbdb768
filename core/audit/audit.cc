#include "core/audit/audit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "core/audit/coulomb_path.h"
#include "core/base/decimal.h"
#include "core/contact/delassus.h"
#include "core/models/restitution_law.h"
#include "core/numerics/elementary.h"
#include "core/numerics/wide.h"
#include "ricochet/error.h"

namespace ricochet::audit {
namespace {

// The share of the terms of W p = v+ - v- below which doubles, and models that compute with them, see no difference.
constexpr double kRounding = 0x1p-46;

template <size_t N>
using Vector = std::array<double, N>;
// A matrix of numbers with about 100 bits: Moderate within IsModerate's range, else Wide.
template <typename Number, size_t N>
using Matrix = std::array<std::array<Number, N>, N>;
using Moderate = HWY_NAMESPACE::DoubleDouble<double>;

// Contact holds W, the velocity before and the observed one after; the normal direction is the last.
template <size_t N>
struct Contact {
  std::array<Vector<N>, N> w;
  Vector<N> before, after, terms;
  double mu_static, uncertainty;
};

Contact<2> MakeContact(const planar::Problem& in, const Observation& seen) {
  return {.w = {{{in.w.tt, in.w.tn}, {in.w.tn, in.w.nn}}},
          .before = {in.u0, in.v0},
          .after = {seen.u1[0], seen.v1},
          .terms = {seen.u_terms[0], seen.v_terms},
          .mu_static = std::max(in.mu, in.mu_static),
          .uncertainty = seen.uncertainty};
}

Contact<3> MakeContact(const spatial::Problem& in, const Observation& seen) {
  return {.w = {{{in.w11, in.w12, in.w13}, {in.w12, in.w22, in.w23}, {in.w13, in.w23, in.w33}}},
          .before = {in.u0[0], in.u0[1], in.v0},
          .after = {seen.u1[0], seen.u1[1], seen.v1},
          .terms = {seen.u_terms[0], seen.u_terms[1], seen.v_terms},
          .mu_static = std::max(in.mu, in.mu_static),
          .uncertainty = seen.uncertainty};
}

// Returns the size in proportion to which the velocities before and after are rounded.
template <size_t N>
double SizeOf(const Contact<N>& contact, size_t i) {
  return std::abs(contact.after[i]) + std::abs(contact.before[i]) + contact.terms[i];
}

// Decides whether the exact quantities can do without exponents of their own: det W is above 2^-50 times a product of
// three of its entries, so that within these sizes no quotient of the two leaves the range of doubles.
template <size_t N>
bool IsModerate(const Contact<N>& contact) {
  const auto moderate = [](double value) {
    const double size = std::abs(value);
    return size == 0.0 || (size >= 0x1p-40 && size <= 0x1p40);
  };
  bool all = moderate(contact.mu_static) && moderate(contact.uncertainty);
  for (size_t i = 0; i < N; ++i) {
    all = all && moderate(contact.before[i]) && moderate(contact.after[i]);
    for (size_t j = 0; j < N; ++j) all = all && moderate(contact.w[i][j]);
  }
  return all;
}

// Inverts W by Gauss-Jordan elimination without pivoting, which a positive definite matrix does not need.
template <typename Number, size_t N>
Matrix<Number, N> InverseOf(const std::array<Vector<N>, N>& w) {
  Matrix<Number, N> left;
  Matrix<Number, N> inverse;
  for (size_t i = 0; i < N; ++i) {
    for (size_t j = 0; j < N; ++j) {
      left[i][j] = Number::Exactly(w[i][j]);
      inverse[i][j] = Number::Constant(i == j ? 1.0 : 0.0);
    }
  }
  for (size_t pivot = 0; pivot < N; ++pivot) {
    const Number reciprocal = Inverse(left[pivot][pivot]);
    for (size_t j = 0; j < N; ++j) {
      left[pivot][j] = left[pivot][j] * reciprocal;
      inverse[pivot][j] = inverse[pivot][j] * reciprocal;
    }
    for (size_t i = 0; i < N; ++i) {
      if (i == pivot) continue;
      const Number factor = left[i][pivot];
      for (size_t j = 0; j < N; ++j) {
        left[i][j] = left[i][j] - factor * left[pivot][j];
        inverse[i][j] = inverse[i][j] - factor * inverse[pivot][j];
      }
    }
  }
  return inverse;
}

template <typename Number, size_t N>
Number Dot(const std::array<Number, N>& x, const std::array<Number, N>& y) {
  Number sum = x[0] * y[0];
  for (size_t i = 1; i < N; ++i) sum = sum + x[i] * y[i];
  return sum;
}

template <typename Number, size_t N>
std::array<Number, N> Times(const Matrix<Number, N>& matrix, const std::array<Number, N>& x) {
  std::array<Number, N> product;
  for (size_t i = 0; i < N; ++i) product[i] = Dot(matrix[i], x);
  return product;
}

// Sums |x_i| weight_i in doubles, which is exact enough for an allowance.
template <typename Number, size_t N>
double Charge(const std::array<Number, N>& x, const Vector<N>& weight) {
  double sum = 0.0;
  for (size_t i = 0; i < N; ++i) sum += std::abs(Rounded(x[i])) * weight[i];
  return sum;
}

// Returns p_t/p_n in a plane, |p_t|/p_n in space.
template <size_t N>
double TangentialRatio(const std::array<double, 2>& tangential, double normal) {
  if (!(normal > 0.0)) return 0.0;
  return (N == 2 ? tangential[0] : Hypot(tangential[0], tangential[1])) / normal;
}

void Check(AuditLimit kind, double value, double limit, double excess, double allowance, AuditReport& report) {
  const Verdict exceeded = excess > allowance ? Verdict::kBroken : Verdict::kWithinUncertainty;
  report.limits[static_cast<size_t>(kind)] = {.value = value,
                                              .limit = limit,
                                              .excess = excess,
                                              .allowance = allowance,
                                              .verdict = excess > 0.0 ? exceeded : Verdict::kKept};
}

void Judge(AuditReport& report) {
  const bool broken = std::any_of(report.limits.begin(), report.limits.end(),
                                  [](const LimitCheck& check) { return check.verdict == Verdict::kBroken; });
  report.admissible = !report.unexplained && !broken;
}

// Bounds the error of the energetic coefficient: the path's velocities are off by velocity_error, so the work of
// restitution by that times tau.
double EnergeticError(const PathPoint& point) {
  const double work = -point.work_normal_compression;
  if (!(work > 0.0) || !(point.energetic > 0.0)) return 0.0;
  const double square = point.velocity_error * point.tau / work * (1.0 + point.energetic * point.energetic);
  return 0.5 * square / point.energetic;
}

// `moved_back` gives the earliest point of the path that the uncertainty allows.
void CheckSharp(const PathPoint& point, absl::FunctionRef<PathPoint()> moved_back, AuditReport& report) {
  double allowance = 0.0;
  if (point.energetic_excess > 0.0) {
    allowance = std::max(point.energetic - moved_back().energetic, 0.0) + EnergeticError(point);
  }
  Check(AuditLimit::kSharp, point.energetic, 1.0, point.energetic_excess, allowance, report);
}

// Fills the fields of a report that describe a point of the path.
AuditReport OnPath(const PathPoint& point) {
  return {.regime = point.regime,
          .w_rank = point.w_rank,
          .compression_ended = point.poisson >= 0.0 && point.regime != Regime::kSeparating,
          .newton = point.newton,
          .poisson = point.poisson,
          .energetic = point.energetic,
          .normal_impulse = point.tau,
          .normal_impulse_compression = point.tau_compression,
          .tangential_impulse = point.f,
          .work_normal_compression = point.work_normal_compression,
          .work_normal_restitution = point.work_normal_restitution,
          .work_tangential_compression = point.work_tangential_compression,
          .work_tangential_restitution = point.work_tangential_restitution,
          .energy_change = point.energy_change,
          .path_tangential_velocity = point.u,
          .path_normal_velocity = point.v};
}

void CloseLedger(AuditReport& report) {
  report.residual = (report.work_normal_compression + report.work_normal_restitution) +
                    (report.work_tangential_compression + report.work_tangential_restitution) - report.energy_change;
}

// UniqueImpulse is the one impulse W^-1 (v+ - v-) that explains an observation where W has full rank.
template <typename Number, size_t N>
class UniqueImpulse {
 public:
  explicit UniqueImpulse(const Contact<N>& contact) : contact_(contact), inverse_(InverseOf<Number>(contact.w)) {
    for (size_t i = 0; i < N; ++i) {
      change_[i] = Number::Exactly(contact.after[i]) - Number::Exactly(contact.before[i]);
      sum_[i] = Number::Exactly(contact.after[i]) + Number::Exactly(contact.before[i]);
    }
    impulse_ = Times(inverse_, change_);
    for (size_t i = 0; i < N; ++i) {
      rounding_[i] = SizeOf(contact, i);
      for (size_t j = 0; j < N; ++j) rounding_[i] += std::abs(contact.w[i][j] * Rounded(impulse_[j]));
      rounding_[i] *= kRounding;
      error_[i] = contact.uncertainty + rounding_[i];
    }
  }

  double normal() const { return Rounded(impulse_[kNormal]); }
  double normal_uncertainty() const { return Uncertainty(kNormal); }

  // Fills in the impulse, its energy and every limit but the sharp one.
  void Fill(AuditReport& report) const {
    report.normal_impulse = normal();
    report.normal_impulse_uncertainty = normal_uncertainty();
    for (size_t i = 0; i < kNormal; ++i) {
      report.tangential_impulse[i] = Rounded(impulse_[i]);
      report.tangential_impulse_uncertainty[i] = Uncertainty(i);
    }
    report.tangential = TangentialRatio<N>(report.tangential_impulse, report.normal_impulse);
    report.energy_change = Rounded(Number::Constant(0.5) * Dot(impulse_, sum_));
    const double v1 = contact_.after[kNormal];
    Check(AuditLimit::kNormalImpulse, normal(), 0.0, -normal(), normal_uncertainty(), report);
    Check(AuditLimit::kPenetration, v1, 0.0, -v1, error_[kNormal], report);
    CheckCone(report);
    Check(AuditLimit::kEnergy, report.energy_change, 0.0, report.energy_change, EnergyAllowance(), report);
  }

  // Decides whether v+ equals v- to within the errors.
  bool Unchanged() const {
    for (size_t i = 0; i < N; ++i) {
      if (std::abs(Rounded(change_[i])) > error_[i]) return false;
    }
    return true;
  }
  double Change() const {
    double length = 0.0;
    for (const Number& change : change_) length = Hypot(length, Rounded(change));
    return length;
  }

 private:
  static constexpr size_t kNormal = N - 1;

  double Uncertainty(size_t i) const { return Charge(inverse_[i], error_); }

  Number TangentialSize() const {
    if constexpr (N == 2) return IsNegative(impulse_[0]) ? -impulse_[0] : impulse_[0];
    Number square = impulse_[0] * impulse_[0];
    for (size_t t = 1; t < kNormal; ++t) square = square + impulse_[t] * impulse_[t];
    return IsPositive(square) ? Sqrt(square) : Number::Constant(0.0);
  }

  void CheckCone(AuditReport& report) const {
    const Number mu = Number::Exactly(contact_.mu_static);
    const Number size = TangentialSize();
    std::array<Number, N> gradient;
    for (size_t i = 0; i < N; ++i) {
      gradient[i] = -(mu * inverse_[kNormal][i]);
      for (size_t t = 0; t < kNormal && IsPositive(size); ++t) {
        gradient[i] = gradient[i] + inverse_[t][i] * impulse_[t] / size;
      }
    }
    const Number limit = mu * impulse_[kNormal];
    Check(AuditLimit::kCone, Rounded(size), Rounded(limit), Rounded(size - limit), Charge(gradient, error_), report);
  }

  double EnergyAllowance() const {
    std::array<Number, N> after;
    Vector<N> measured;
    for (size_t i = 0; i < N; ++i) {
      after[i] = Number::Exactly(contact_.after[i]);
      measured[i] = contact_.uncertainty;
    }
    return Charge(Times(inverse_, after), measured) +
           0.5 * (Charge(Times(inverse_, sum_), rounding_) + Charge(impulse_, rounding_));
  }

  const Contact<N>& contact_;
  Matrix<Number, N> inverse_;
  std::array<Number, N> change_, sum_, impulse_;
  Vector<N> rounding_, error_;
};

template <typename Number, size_t N, typename Problem>
AuditReport AuditUnique(const Problem& problem, const Contact<N>& contact, const PathPoint& start) {
  const UniqueImpulse<Number, N> observed(contact);
  const bool moves = start.regime != Regime::kSeparating && observed.normal() > 0.0;
  const PathPoint point = moves ? PathAt(problem, observed.normal()) : start;
  AuditReport report = OnPath(point);
  observed.Fill(report);
  if (point.regime == Regime::kSeparating) {
    report.unexplained = !observed.Unchanged();
    report.distance = report.unexplained ? observed.Change() : 0.0;
  } else {
    report.newton = -contact.after[N - 1] / contact.before[N - 1];
    if (observed.normal() < 0.0) report.poisson = observed.normal() / point.tau_compression - 1.0;
  }
  for (size_t i = 0; i < 2; ++i) report.friction_mismatch[i] = report.tangential_impulse[i] - point.f[i];
  const auto moved_back = [&] {
    return PathAt(problem, std::max(observed.normal() - observed.normal_uncertainty(), 0.0));
  };
  CheckSharp(point, moved_back, report);
  CloseLedger(report);
  Judge(report);
  return report;
}

template <size_t N, typename Problem>
AuditReport AuditFullRank(const Problem& problem, const Contact<N>& contact, const PathPoint& start) {
  if (IsModerate(contact)) return AuditUnique<Moderate>(problem, contact, start);
  return AuditUnique<Wide>(problem, contact, start);
}

// Reports a point of the path, where no W^-1 gives the impulse, and the limit of the observed normal velocity.
template <size_t N>
AuditReport AuditPoint(const PathPoint& point, const PathPoint& moved_back, const Contact<N>& contact,
                       double normal_error) {
  AuditReport report = OnPath(point);
  report.tangential = TangentialRatio<N>(point.f, point.tau);
  report.normal_impulse_uncertainty = std::abs(point.tau - moved_back.tau);
  for (size_t i = 0; i + 1 < N; ++i) {
    report.tangential_impulse_uncertainty[i] = std::abs(point.f[i] - moved_back.f[i]);
  }
  const double v1 = contact.after[N - 1];
  const double size = Hypot(point.f[0], point.f[1]);
  const double cone = contact.mu_static * point.tau;
  const double energy_error = std::max(point.energy_change - moved_back.energy_change, 0.0);
  Check(AuditLimit::kNormalImpulse, point.tau, 0.0, -point.tau, 0.0, report);
  Check(AuditLimit::kPenetration, v1, 0.0, -v1, normal_error, report);
  // A subnormal tau has lost bits, and mu may magnify what is missing.
  const double subnormal_error = contact.mu_static * std::numeric_limits<double>::denorm_min();
  const double cone_error = kRounding * cone + subnormal_error + point.velocity_error * point.tau;
  Check(AuditLimit::kCone, size, cone, size - cone, cone_error, report);
  Check(AuditLimit::kEnergy, point.energy_change, 0.0, point.energy_change,
        energy_error + point.velocity_error * point.tau, report);
  CheckSharp(
      point, [&] { return moved_back; }, report);
  CloseLedger(report);
  return report;
}

// RangeDirection is the unit vector along which a W of rank one changes the velocity.
struct RangeDirection {
  double t, n;  // n > 0
};

Vector<2> Errors(const Contact<2>& contact) {
  Vector<2> error;
  for (size_t i = 0; i < 2; ++i) {
    error[i] = contact.uncertainty + kRounding * SizeOf(contact, i);
  }
  return error;
}

// `path_at(v)` is the point of the path at the normal velocity v >= v0, or the path's end if it stops before.
AuditReport AuditRankOne(const Contact<2>& contact, const RangeDirection& range,
                         absl::FunctionRef<PathPoint(double)> path_at) {
  const Vector<2> error = Errors(contact);
  const auto [u1, v1] = contact.after;
  const double v0 = contact.before[1];
  const double component = range.t * u1 + range.n * v1;
  const double component_error = std::abs(range.t) * error[0] + range.n * error[1];
  // A v+ in the range of W is its own nearest point and needs no rounded projection. A contact that separates keeps its
  // velocity, which may lie beside the range.
  const bool in_range =
      v0 >= 0.0 ? std::abs(u1 - contact.before[0]) <= error[0] && std::abs(v1 - v0) <= error[1]
                : std::abs(range.n * u1 - range.t * v1) <= range.n * error[0] + std::abs(range.t) * error[1];
  const double nearest = in_range && contact.uncertainty == 0.0 ? v1 : component * range.n;
  const PathPoint point = path_at(std::max(nearest, v0));
  const PathPoint moved_back = path_at(std::max(nearest - component_error * range.n, v0));
  AuditReport report = AuditPoint(point, moved_back, contact, error[1]);
  const double beyond = std::abs(component - (range.t * point.u[0] + range.n * point.v));
  report.unexplained = !in_range || beyond > component_error;
  report.distance = report.unexplained ? Hypot(u1 - point.u[0], v1 - point.v) : 0.0;
  Judge(report);
  return report;
}

// The path of rank one is a point where the contact does not approach. Else compression is one straight piece, since u
// and v vanish together, and Newton's law gives the points after it.
AuditReport AuditPlanarRankOne(const planar::Problem& problem, const Contact<2>& contact,
                               const PathPoint& compression) {
  const double size = Hypot(problem.w.tn, problem.w.nn);
  const RangeDirection range = {problem.w.tn / size, problem.w.nn / size};
  const auto path_at = [&](double v) {
    if (problem.v0 >= 0.0) return compression;
    if (v >= 0.0) return PathWhereNormalIs(problem, v);
    return PathAt(problem, (1.0 - v / problem.v0) * compression.tau_compression);
  };
  return AuditRankOne(contact, range, path_at);
}

PathPoint PendulumCompression(const pendulum::Problem& problem, const pendulum::Impact& impact, double omega) {
  using pendulum::Output;
  const double tau0 = impact[Output::kNormalImpulseCompression];
  const double share = 1.0 - omega / problem.omega_minus;
  const double f = share * impact[Output::kTangentialImpulseCompression];
  const double mean = 0.5 * (problem.omega_minus + omega);
  PathPoint point{.regime = impact.regime, .w_rank = 1, .tau_compression = tau0, .tau = share * tau0};
  point.f[0] = f;
  point.u[0] = problem.b * omega;
  point.v = problem.a * omega;
  point.newton = -omega / problem.omega_minus;
  point.poisson = -omega / problem.omega_minus;
  point.energetic_excess = -1.0;
  point.work_normal_compression = problem.a * mean * point.tau;
  point.work_tangential_compression = problem.b * mean * f;
  point.energy_change = point.work_normal_compression + point.work_tangential_compression;
  return point;
}

PathPoint EndOf(const pendulum::Impact& impact) {
  using pendulum::Output;
  PathPoint point{.regime = impact.regime,
                  .w_rank = 1,
                  .tau_compression = impact[Output::kNormalImpulseCompression],
                  .tau = impact[Output::kNormalImpulse],
                  .v = impact[Output::kNormalVelocityAfter],
                  .newton = impact[Output::kNewton],
                  .poisson = impact[Output::kPoisson],
                  .energetic = impact[Output::kEnergetic],
                  .energetic_excess = impact[Output::kEnergeticExcess],
                  .work_normal_compression = impact[Output::kWorkNormalCompression],
                  .work_normal_restitution = impact[Output::kWorkNormalRestitution],
                  .work_tangential_compression = impact[Output::kWorkTangentialCompression],
                  .work_tangential_restitution = impact[Output::kWorkTangentialRestitution],
                  .energy_change = impact[Output::kEnergyChange]};
  point.f[0] = impact[Output::kTangentialImpulse];
  point.u[0] = impact[Output::kTangentialVelocityAfter];
  return point;
}

PathPoint PendulumAt(pendulum::Problem problem, double omega) {
  problem.law = RestitutionLaw::kNewton;
  problem.coefficient = std::max(-omega / problem.omega_minus, 0.0);
  const pendulum::Impact impact = pendulum::Solve(problem);
  const bool compressing = impact.regime != Regime::kSeparating && omega < 0.0;
  return compressing ? PendulumCompression(problem, impact, omega) : EndOf(impact);
}

absl::Status PathTooLong(double friction) {
  return MakeError(absl::StatusCode::kOutOfRange, ErrorReason::kNotEnded,
                   absl::StrCat("the impact under friction of ", ShortestDecimal(friction),
                                ", with which the observation is compared, takes more steps than an audit has; state "
                                "a smaller coefficient"));
}

// NearestPoint searches the point of a spatial path nearest to v+, for tau in [0, end]: golden section around each step
// that lies nearer than its neighbours. Steps are equal, and in proportion to tau towards the start, as the end may lie
// far beyond the impact. Each solves an impact, and `stopped` is asked before each. All together may take kMostSteps of
// the model; most impacts take under a hundred.
class NearestPoint {
 public:
  NearestPoint(const spatial::Problem& problem, const Contact<3>& contact, absl::FunctionRef<bool()> stopped)
      : problem_(problem), contact_(contact), stopped_(stopped) {}

  double DistanceTo(const PathPoint& point) const {
    return Hypot(Hypot(contact_.after[0] - point.u[0], contact_.after[1] - point.u[1]), contact_.after[2] - point.v);
  }

  // Returns tau of the nearest point. The path may come near v+ and leave it again between two steps, so that they
  // include `likely`. Errors: CANCELLED, and that of PathTooLong.
  absl::StatusOr<double> Find(double end, double likely) {
    constexpr int kSteps = 64;
    constexpr double kRatio = 0.75;
    std::vector<double> steps = {0.0, std::min(likely, end)};
    double small = end / kSteps;
    for (int i = 1; i <= kSteps; ++i) {
      steps.push_back(end * i / kSteps);
      steps.push_back(small *= kRatio);
    }
    std::sort(steps.begin(), steps.end());
    std::vector<double> distances;
    for (const double tau : steps) {
      if (absl::Status status = CheckProgress(); !status.ok()) return status;
      distances.push_back(DistanceAt(tau));
    }
    double best = 0.0, least = distances.front();
    for (size_t i = 0; i < steps.size(); ++i) {
      const size_t before = i == 0 ? i : i - 1, after = std::min(i + 1, steps.size() - 1);
      if (distances[i] > distances[before] || distances[i] > distances[after]) continue;
      const absl::StatusOr<double> tau = Refined(steps[before], steps[after]);
      if (!tau.ok()) return tau.status();
      if (distances[i] < least) best = steps[i], least = distances[i];
      const double distance = DistanceAt(*tau);
      if (distance < least) best = *tau, least = distance;
    }
    return best;
  }

 private:
  absl::Status CheckProgress() const {
    constexpr int64_t kMostSteps = 200'000;
    if (stopped_()) return absl::CancelledError("the audit was stopped by its caller");
    return has_lost_path_ || steps_ > kMostSteps ? PathTooLong(problem_.mu) : absl::OkStatus();
  }

  double DistanceAt(double tau) {
    const PathPoint point = PathAt(problem_, tau);
    steps_ += point.steps;
    has_lost_path_ = has_lost_path_ || point.regime == Regime::kUnspecified;
    return DistanceTo(point);
  }

  // Halves the interval every 1.44 steps, down to the rounding of its end.
  absl::StatusOr<double> Refined(double low, double high) {
    constexpr double kGolden = 0.6180339887498949;
    double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    double left_distance = DistanceAt(left), right_distance = DistanceAt(right);
    while (high - low > 0x1p-48 * high) {
      if (absl::Status status = CheckProgress(); !status.ok()) return status;
      if (left_distance <= right_distance) {
        high = right;
        right = left, right_distance = left_distance;
        left = high - kGolden * (high - low), left_distance = DistanceAt(left);
      } else {
        low = left;
        left = right, left_distance = right_distance;
        right = low + kGolden * (high - low), right_distance = DistanceAt(right);
      }
      if (!(left < right)) break;
    }
    return left_distance <= right_distance ? left : right;
  }

  const spatial::Problem& problem_;
  const Contact<3>& contact_;
  absl::FunctionRef<bool()> stopped_;
  int64_t steps_ = 0;
  bool has_lost_path_ = false;  // The model did not come to a point.
};

// Moves a point of the path back by `change` (m/s), to first order in the way that the velocity goes with tau.
PathPoint MovedBack(const spatial::Problem& problem, const PathPoint& point, double change) {
  const double step = 0x1p-10 * point.tau;
  const PathPoint before = PathAt(problem, point.tau - step);
  const double moved = Hypot(Hypot(point.u[0] - before.u[0], point.u[1] - before.u[1]), point.v - before.v);
  const double back = moved > 0.0 ? std::min(change / moved * step, point.tau) : 0.0;
  return PathAt(problem, point.tau - back);
}

absl::StatusOr<AuditReport> AuditSpatialDeficient(const spatial::Problem& problem, const Contact<3>& contact,
                                                  const PathPoint& start, absl::FunctionRef<bool()> stopped) {
  NearestPoint search(problem, contact, stopped);
  double error = contact.uncertainty;
  for (size_t i = 0; i < 3; ++i) error += kRounding * SizeOf(contact, i);
  PathPoint point = start;
  PathPoint moved_back = start;
  if (start.regime != Regime::kSeparating) {
    // Once its normal velocity exceeds v+_n by the distance of the start from v+, the path comes no nearer.
    const double farthest = std::max(contact.after[2], 0.0) + search.DistanceTo(start);
    const PathPoint likely = PathWhereNormalIs(problem, std::max(contact.after[2], 0.0));
    const PathPoint end = PathWhereNormalIs(problem, farthest);
    if (likely.regime == Regime::kUnspecified || end.regime == Regime::kUnspecified) return PathTooLong(problem.mu);
    const absl::StatusOr<double> tau = search.Find(end.tau, likely.tau);
    if (!tau.ok()) return tau.status();
    point = PathAt(problem, *tau);
    moved_back = MovedBack(problem, point, std::sqrt(3.0) * error);
    if (moved_back.regime == Regime::kUnspecified) return PathTooLong(problem.mu);
  }
  AuditReport report = AuditPoint(point, moved_back, contact, error);
  const double distance = search.DistanceTo(point);
  report.unexplained = distance > std::sqrt(3.0) * (error + point.velocity_error);
  report.distance = report.unexplained ? distance : 0.0;
  Judge(report);
  return report;
}

}  // namespace

AuditReport Audit(const planar::Problem& problem, const Observation& observation) {
  const Contact<2> contact = MakeContact(problem, observation);
  const PathPoint start = PathAt(problem, 0.0);
  return problem.w.Rank() == 2 ? AuditFullRank(problem, contact, start) : AuditPlanarRankOne(problem, contact, start);
}

absl::StatusOr<AuditReport> Audit(const spatial::Problem& in, const Observation& observation,
                                  absl::FunctionRef<bool()> stopped) {
  const Contact<3> contact = MakeContact(in, observation);
  PathPoint start = PathAt(in, 0.0);
  if (start.regime == Regime::kUnspecified) return PathTooLong(in.mu);
  start.w_rank = in.Delassus().Rank();
  absl::StatusOr<AuditReport> report =
      start.w_rank == 3 ? AuditFullRank(in, contact, start) : AuditSpatialDeficient(in, contact, start, stopped);
  if (report.ok() && report->regime == Regime::kUnspecified) return PathTooLong(in.mu);
  return report;
}

AuditReport Audit(const pendulum::Problem& problem, const Observation& observation) {
  const Contact<2> contact{.w = {},
                           .before = {problem.b * problem.omega_minus, problem.a * problem.omega_minus},
                           .after = {observation.u1[0], observation.v1},
                           .terms = {observation.u_terms[0], observation.v_terms},
                           .mu_static = std::max(problem.mu, problem.mu_static),
                           .uncertainty = observation.uncertainty};
  const double size = Hypot(problem.a, problem.b);
  const RangeDirection range = {problem.b / size, problem.a / size};
  return AuditRankOne(contact, range, [&](double v) { return PendulumAt(problem, v / problem.a); });
}

absl::StatusOr<AuditReport> Audit(const AnyProblem& any, const Observation& observation,
                                  absl::FunctionRef<bool()> stopped) {
  if (const auto* spatial = std::get_if<spatial::Problem>(&any)) return Audit(*spatial, observation, stopped);
  if (const auto* planar = std::get_if<planar::Problem>(&any)) return Audit(*planar, observation);
  return Audit(std::get<pendulum::Problem>(any), observation);
}

const char* OverflowIn(const AuditReport& report) {
  const std::pair<const char*, double> numbers[] = {
      {"report.normal_impulse_n_s", report.normal_impulse},
      {"report.normal_compression_n_s", report.normal_impulse_compression},
      {"report.tangential_impulse_n_s", report.tangential_impulse[0] + report.tangential_impulse[1]},
      {"report.friction_mismatch_n_s", report.friction_mismatch[0] + report.friction_mismatch[1]},
      {"report.distance_m_s", report.distance},
      {"report.coefficients.newton", report.newton},
      {"report.coefficients.poisson", report.poisson},
      {"report.coefficients.energetic", report.energetic},
      {"report.coefficients.tangential", report.tangential},
      {"report.work_normal_compression_j", report.work_normal_compression},
      {"report.work_normal_restitution_j", report.work_normal_restitution},
      {"report.work_tangential_compression_j", report.work_tangential_compression},
      {"report.work_tangential_restitution_j", report.work_tangential_restitution},
      {"report.energy_change_j", report.energy_change},
      {"report.residual_j", report.residual},
      {"report.path_velocity",
       report.path_tangential_velocity[0] + report.path_tangential_velocity[1] + report.path_normal_velocity}};
  for (const auto& [path, value] : numbers) {
    if (!std::isfinite(value)) return path;
  }
  const bool are_finite = std::all_of(report.limits.begin(), report.limits.end(), [](const LimitCheck& check) {
    return std::isfinite(check.value) && std::isfinite(check.limit) && std::isfinite(check.excess);
  });
  return are_finite ? nullptr : "report.limits";
}

}  // namespace ricochet::audit
