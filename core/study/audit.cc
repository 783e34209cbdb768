#include "core/study/audit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "absl/functional/function_ref.h"
#include "core/models/restitution_law.h"
#include "core/numerics/elementary.h"
#include "core/numerics/wide.h"
#include "core/study/coulomb_path.h"

namespace ricochet::audit {
namespace {

// Of the terms of W p = v+ - v-: what doubles, and the models that compute them, cannot tell.
constexpr double kRounding = 0x1p-46;

template <size_t N>
using Vector = std::array<double, N>;
// Of a number type with 100 bits.
template <typename Number, size_t N>
using Matrix = std::array<std::array<Number, N>, N>;
using Moderate = HWY_NAMESPACE::DoubleDouble<double>;

// The contact and what was seen of it; the normal direction is the last.
template <size_t N>
struct Contact {
  std::array<Vector<N>, N> w;
  Vector<N> before, after;
  double mu_static, uncertainty;
};

Contact<2> MakeContact(const planar::Problem& in, const PlanarObservation& seen) {
  return {.w = {{{in.wtt, in.wtn}, {in.wtn, in.wnn}}},
          .before = {in.u0, in.v0},
          .after = {seen.u1, seen.v1},
          .mu_static = std::max(in.mu, in.mu_static),
          .uncertainty = seen.uncertainty};
}

Contact<3> MakeContact(const spatial::Problem& in, const SpatialObservation& seen) {
  return {.w = {{{in.w11, in.w12, in.w13}, {in.w12, in.w22, in.w23}, {in.w13, in.w23, in.w33}}},
          .before = {in.u0[0], in.u0[1], in.v0},
          .after = {seen.u1[0], seen.u1[1], seen.v1},
          .mu_static = std::max(in.mu, in.mu_static),
          .uncertainty = seen.uncertainty};
}

// Whether the exact quantities can do without exponents of their own: no product of three entries over det W, which is
// above 2^-50 times one, leaves the range of doubles.
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

// Gauss-Jordan without pivoting, which a positive definite W does not need.
template <typename Number, size_t N>
Matrix<Number, N> InverseOf(const std::array<Vector<N>, N>& w) {
  Matrix<Number, N> rest;
  Matrix<Number, N> inverse;
  for (size_t i = 0; i < N; ++i) {
    for (size_t j = 0; j < N; ++j) {
      rest[i][j] = Number::Exactly(w[i][j]);
      inverse[i][j] = Number::Constant(i == j ? 1.0 : 0.0);
    }
  }
  for (size_t pivot = 0; pivot < N; ++pivot) {
    const Number reciprocal = Inverse(rest[pivot][pivot]);
    for (size_t j = 0; j < N; ++j) {
      rest[pivot][j] = rest[pivot][j] * reciprocal;
      inverse[pivot][j] = inverse[pivot][j] * reciprocal;
    }
    for (size_t i = 0; i < N; ++i) {
      if (i == pivot) continue;
      const Number factor = rest[i][pivot];
      for (size_t j = 0; j < N; ++j) {
        rest[i][j] = rest[i][j] - factor * rest[pivot][j];
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

// sum |x_i| weight_i, of rounded terms: an allowance needs no more.
template <typename Number, size_t N>
double Charge(const std::array<Number, N>& x, const Vector<N>& weight) {
  double sum = 0.0;
  for (size_t i = 0; i < N; ++i) sum += std::abs(Rounded(x[i])) * weight[i];
  return sum;
}

// A number with its sign in a plane, a length in space.
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

// The velocities of the path are off by as much, so the work of restitution by that times tau.
double EnergeticError(const PathPoint& point) {
  const double work = -point.work_normal_compression;
  if (!(work > 0.0) || !(point.energetic > 0.0)) return 0.0;
  const double square = point.velocity_error * point.tau / work * (1.0 + point.energetic * point.energetic);
  return 0.5 * square / point.energetic;
}

// `moved_back` is the path where the uncertainty could have put the observation.
void CheckSharp(const PathPoint& point, absl::FunctionRef<PathPoint()> moved_back, AuditReport& report) {
  double allowance = 0.0;
  if (point.energetic_excess > 0.0) {
    allowance = std::max(point.energetic - moved_back().energetic, 0.0) + EnergeticError(point);
  }
  Check(AuditLimit::kSharp, point.energetic, 1.0, point.energetic_excess, allowance, report);
}

// What a report takes from the path.
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

// The observation through W^-1.
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
      rounding_[i] = std::abs(contact.after[i]) + std::abs(contact.before[i]);
      for (size_t j = 0; j < N; ++j) rounding_[i] += std::abs(contact.w[i][j] * Rounded(impulse_[j]));
      rounding_[i] *= kRounding;
      error_[i] = contact.uncertainty + rounding_[i];
    }
  }

  double normal() const { return Rounded(impulse_[kNormal]); }
  double normal_uncertainty() const { return Uncertainty(kNormal); }

  // The impulse, its energy and every limit but the sharp one.
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

  // Whether v+ is v-.
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

// Without a W^-1: the limits that a point of the path can break, and the observed normal velocity's.
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
  // A subnormal tau has fewer bits, of which mu makes what it will.
  const double of_tau = contact.mu_static * std::numeric_limits<double>::denorm_min();
  Check(AuditLimit::kCone, size, cone, size - cone, kRounding * cone + of_tau + point.velocity_error * point.tau,
        report);
  Check(AuditLimit::kEnergy, point.energy_change, 0.0, point.energy_change,
        energy_error + point.velocity_error * point.tau, report);
  CheckSharp(
      point, [&] { return moved_back; }, report);
  CloseLedger(report);
  return report;
}

// The line that all velocities of a rank-one W lie on.
struct Line {
  double t, n;  // Unit vector, n > 0.
};

Vector<2> Errors(const Contact<2>& contact) {
  Vector<2> error;
  for (size_t i = 0; i < 2; ++i) {
    error[i] = contact.uncertainty + kRounding * (std::abs(contact.after[i]) + std::abs(contact.before[i]));
  }
  return error;
}

// `reach(v)` is the point of the path at the normal velocity v >= v0, or its end.
AuditReport AuditRankOne(const Contact<2>& contact, const Line& line, absl::FunctionRef<PathPoint(double)> reach) {
  const Vector<2> error = Errors(contact);
  const auto [u1, v1] = contact.after;
  const double v0 = contact.before[1];
  const double along = line.t * u1 + line.n * v1;
  const double along_error = std::abs(line.t) * error[0] + line.n * error[1];
  // Where v+ is on the line it is its own nearest point: no rounding.
  const bool on_line = std::abs(line.n * u1 - line.t * v1) <= line.n * error[0] + std::abs(line.t) * error[1];
  const double nearest = on_line && contact.uncertainty == 0.0 ? v1 : along * line.n;
  const PathPoint point = reach(std::max(nearest, v0));
  const PathPoint moved_back = reach(std::max(nearest - along_error * line.n, v0));
  AuditReport report = AuditPoint(point, moved_back, contact, error[1]);
  const double beyond = std::abs(along - (line.t * point.u[0] + line.n * point.v));
  report.unexplained = !on_line || beyond > along_error;
  report.distance = report.unexplained ? Hypot(u1 - point.u[0], v1 - point.v) : 0.0;
  Judge(report);
  return report;
}

// The start of the path where the contact does not approach, else by Newton's law; compression is one straight piece,
// since u and v vanish together.
AuditReport AuditPlanarRankOne(const planar::Problem& problem, const Contact<2>& contact,
                               const PathPoint& compression) {
  const double size = Hypot(problem.wtn, problem.wnn);
  const Line line = {problem.wtn / size, problem.wnn / size};
  const auto reach = [&](double v) {
    if (problem.v0 >= 0.0) return compression;
    if (v >= 0.0) return PathWhereNormalIs(problem, v);
    return PathAt(problem, (1.0 - v / problem.v0) * compression.tau_compression);
  };
  return AuditRankOne(contact, line, reach);
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

// The nearest point of a spatial path by golden section around the best of equal steps.
class NearestPoint {
 public:
  NearestPoint(const spatial::Problem& problem, const Contact<3>& contact, double end)
      : problem_(problem), contact_(contact), end_(end) {}

  double DistanceTo(const PathPoint& point) const {
    return Hypot(Hypot(contact_.after[0] - point.u[0], contact_.after[1] - point.u[1]), contact_.after[2] - point.v);
  }

  double Find() const {
    constexpr int kSteps = 64;
    int best = 0;
    for (int i = 1; i <= kSteps; ++i) {
      if (DistanceAt(end_ * i / kSteps) < DistanceAt(end_ * best / kSteps)) best = i;
    }
    return Refined(end_ * std::max(best - 1, 0) / kSteps, end_ * std::min(best + 1, kSteps) / kSteps);
  }

 private:
  double DistanceAt(double tau) const { return DistanceTo(PathAt(problem_, tau)); }

  // Halves the interval every 1.44 steps, down to the rounding of its end.
  double Refined(double low, double high) const {
    constexpr double kGolden = 0.6180339887498949;
    double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    double left_distance = DistanceAt(left), right_distance = DistanceAt(right);
    while (high - low > 0x1p-48 * high) {
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
  double end_;
};

// The path no longer comes nearer once its normal velocity is above v+_n by the distance from its start.
AuditReport AuditSpatialDeficient(const spatial::Problem& problem, const Contact<3>& contact, const PathPoint& start) {
  const NearestPoint start_search(problem, contact, 0.0);
  PathPoint point = start;
  double error = contact.uncertainty + start.velocity_error;
  for (size_t i = 0; i < 3; ++i) error += kRounding * (std::abs(contact.after[i]) + std::abs(contact.before[i]));
  PathPoint moved_back = start;
  if (start.regime != Regime::kSeparating) {
    const double reach = std::max(contact.after[2], 0.0) + start_search.DistanceTo(start);
    const double end = PathWhereNormalIs(problem, reach).tau;
    point = PathAt(problem, NearestPoint(problem, contact, end).Find());
    // First order: how far the path goes in that much velocity.
    const double step = 0x1p-10 * point.tau;
    const PathPoint before = PathAt(problem, point.tau - step);
    const double way = Hypot(Hypot(point.u[0] - before.u[0], point.u[1] - before.u[1]), point.v - before.v);
    const double back = way > 0.0 ? std::min(error / way * step, point.tau) : 0.0;
    moved_back = PathAt(problem, point.tau - back);
  }
  AuditReport report = AuditPoint(point, moved_back, contact, error);
  const double distance = start_search.DistanceTo(point);
  report.unexplained = distance > std::sqrt(3.0) * error;
  report.distance = report.unexplained ? distance : 0.0;
  Judge(report);
  return report;
}

// Of W, also where the contact does not approach and the model has no rank to tell.
int RankOf(spatial::Problem problem, const PathPoint& start) {
  if (start.regime != Regime::kSeparating) return start.w_rank;
  problem.v0 = -1.0;
  return PathAt(problem, 0.0).w_rank;
}

}  // namespace

AuditReport Audit(const planar::Problem& problem, const PlanarObservation& observation) {
  const Contact<2> contact = MakeContact(problem, observation);
  const PathPoint start = PathAt(problem, 0.0);
  return start.w_rank == 2 ? AuditFullRank(problem, contact, start) : AuditPlanarRankOne(problem, contact, start);
}

AuditReport Audit(const spatial::Problem& problem, const SpatialObservation& observation) {
  const Contact<3> contact = MakeContact(problem, observation);
  PathPoint start = PathAt(problem, 0.0);
  start.w_rank = RankOf(problem, start);
  return start.w_rank == 3 ? AuditFullRank(problem, contact, start) : AuditSpatialDeficient(problem, contact, start);
}

AuditReport Audit(const pendulum::Problem& problem, const PlanarObservation& observation) {
  const Contact<2> contact{.w = {},
                           .before = {problem.b * problem.omega_minus, problem.a * problem.omega_minus},
                           .after = {observation.u1, observation.v1},
                           .mu_static = std::max(problem.mu, problem.mu_static),
                           .uncertainty = observation.uncertainty};
  const double size = Hypot(problem.a, problem.b);
  const Line line = {problem.b / size, problem.a / size};
  return AuditRankOne(contact, line, [&](double v) { return PendulumAt(problem, v / problem.a); });
}

AuditReport AuditRate(const pendulum::Problem& problem, double omega_plus, double uncertainty) {
  const double size = Hypot(problem.a, problem.b);
  // |along| of the line moves by the sum of its parts.
  const double per_component = uncertainty * size * size / (problem.a + std::abs(problem.b));
  return Audit(problem, {problem.b * omega_plus, problem.a * omega_plus, per_component});
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
  return nullptr;
}

}  // namespace ricochet::audit
