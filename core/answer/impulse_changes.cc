#include "core/answer/impulse_changes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/functional/function_ref.h"
#include "core/numerics/elementary.h"
#include "core/numerics/products.h"
#include "core/plan/perturbed_path.h"

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-53;

template <size_t kTangential>
using Vector = std::array<double, kTangential>;

template <size_t kTangential>
double Length(const Vector<kTangential>& x) {
  double square = 0.0;
  for (const double component : x) square += component * component;
  return std::sqrt(square);
}

double Weighted(double weight, double size) { return size == 0.0 ? 0.0 : weight * size; }

// Neighbours holds the contact of A and bounds on how far B differs from it. Slip is measured by |u|, the root of u^T
// Wtt^-1 u; comments have the symbols of docs/theory/mechanism.md.
//
// In space one free coordinate moves slip along one direction d alone. |u| then measures the part of u along d. What u
// has across d stays as it is, and turns friction.
template <size_t kTangential>
class Neighbours {
 public:
  // Normal impulses must not exceed `most_tau`.
  Neighbours(const Reduction<kTangential>& reduction, const EffectiveCoefficients& coefficients,
             const ContactErrors<kTangential>& errors, Freedom freedom, double most_tau);

  double SlipGap(double tau) const { return slip_gap_ + slip_growth_ * tau; }                             // N
  double SpeedGap(double tau) const { return speed_gap_ + speed_growth_ * tau + lever_ * SlipGap(tau); }  // E
  // Returns E from the end of compression of each impact on, where it is `gap`.
  double SpeedGapAfter(double time, double gap) const { return (speed_growth_ + lever_ * slip_growth_) * time + gap; }
  double lever() const { return lever_; }
  double ImpulseGap(size_t i, double tau) const {
    const double slip_gap = SlipGap(tau);
    const double turn = across_ + Weighted(turn_by_slip_, slip_gap);
    const double bound = Weighted(inverse_roots_[i], 2.0 * slip_gap) + Weighted(turn, most_friction_ * tau);
    return std::min(bound, 2.0 * most_friction_ * tau) + friction_error_ * tau;
  }

  double slip_pace() const { return slip_pace_; }          // |u_A'| is at most that.
  double steepest() const { return steepest_; }            // |v_A'| is at most that.
  double most_friction() const { return most_friction_; }  // A and B share it.
  double root_trace() const { return root_trace_; }        // The length of u is at most this times |u|.
  bool has_friction() const { return most_friction_ > 0.0; }

  // Returns the time after which slip of this gap has stopped if kinetic friction surely holds a contact of B at rest,
  // as it does in A; else infinity.
  double SettlingTime(double slip_gap) const;
  // True if static friction decides, or may decide, whether a contact at rest is held.
  bool StaticFrictionDecides() const {
    return static_friction_ > kinetic_friction_ && hold_ + hold_error_ > kinetic_friction_ - friction_error_ &&
           !SurelySlips();
  }
  bool SurelyHolds() const { return hold_ + hold_error_ <= static_friction_ - static_error_; }
  bool SurelySlips() const { return hold_ - hold_error_ > static_friction_ + static_error_; }
  bool Holds() const { return hold_ <= static_friction_; }
  // True if slip of B surely stops as its compression ends: u = v = 0.
  bool StopsAtRest() const { return stops_at_rest_; }

  double SlidingSlope(const Vector<kTangential>& u) const {
    double along = 0.0;
    for (size_t i = 0; i < kTangential; ++i) along += coupling_[i] * u[i];
    return wnn_ - kinetic_friction_ * (along / Length<kTangential>(u)) - slope_noise_;
  }
  // The least v_A' while slip differs from `u` by no more than `reach`.
  double LeastSlope(const Vector<kTangential>& u, double reach, bool is_held) const;

 private:
  // Bounds the root of y^T Wtt^-1 y over all y whose components are no larger than those of x.
  double Norm(const Vector<kTangential>& x) const {
    double sum = 0.0;
    if (has_one_direction_) {
      for (size_t i = 0; i < kTangential; ++i) sum += std::fabs(direction_[i]) * x[i];
      return sum / root_trace_;
    }
    for (size_t i = 0; i < kTangential; ++i) {
      if (x[i] > 0.0) sum += x[i] / roots_[i];
    }
    return Weighted(conditioning_, sum);
  }
  void SetOneDirection(const Reduction<2>& reduction);
  void SetHold(const Reduction<kTangential>& reduction, const ContactErrors<kTangential>& errors);
  void SetGaps(const ContactErrors<kTangential>& errors);
  void SetTurn(const Reduction<2>& reduction, const ContactErrors<2>& errors, double most_tau);
  void SetStop(const Reduction<2>& reduction, const ContactErrors<2>& errors);

  double wnn_, kinetic_friction_, static_friction_, friction_error_, static_error_, most_friction_;
  Vector<kTangential> roots_, inverse_roots_;  // Square roots of the diagonals of Wtt and of Wtt^-1.
  Vector<kTangential> coupling_;               // wtn
  double conditioning_ = 1.0;                  // 1/sqrt(1 - rho^2), rho the correlation of t1 and t2.
  double coupling_size_, root_trace_, steepest_, slope_noise_;
  bool has_one_direction_ = false;
  Vector<kTangential> direction_ = {};  // d
  // These bound how far errors of u across d, and errors along d, turn the direction of friction.
  double across_ = 0.0, turn_by_slip_ = 0.0;
  Vector<kTangential> holding_ = {};      // Wtt^-1 wtn
  double hold_ = 0.0, hold_error_ = 0.0;  // Its length.
  bool stops_at_rest_ = false;
  double stick_slope_ = 0.0;
  double slip_gap_ = 0.0, slip_growth_ = 0.0, speed_gap_ = 0.0, speed_growth_ = 0.0, lever_ = 0.0, slip_pace_ = 0.0;
};

template <size_t kTangential>
Neighbours<kTangential>::Neighbours(const Reduction<kTangential>& reduction, const EffectiveCoefficients& coefficients,
                                    const ContactErrors<kTangential>& errors, Freedom freedom, double most_tau)
    : wnn_(reduction.w.back()),
      kinetic_friction_(coefficients.kinetic_friction),
      static_friction_(coefficients.static_friction),
      friction_error_(errors.coefficients.kinetic_friction),
      static_error_(errors.coefficients.static_friction),
      most_friction_(kinetic_friction_ + friction_error_) {
  if constexpr (kTangential == 1) {
    roots_ = {std::sqrt(reduction.w[0])};
    coupling_ = {reduction.w[1]};
  } else {
    roots_ = {std::sqrt(reduction.w[0]), std::sqrt(reduction.w[3])};
    coupling_ = {reduction.w[2], reduction.w[4]};
    if (roots_[0] > 0.0 && roots_[1] > 0.0) {
      const double rho = reduction.w[1] / roots_[0] / roots_[1];
      const double square = 1.0 - rho * rho - 16.0 * kUnit;
      conditioning_ = square > 0.0 ? 1.0 / std::sqrt(square) : kInfinity;
    }
  }
  for (size_t i = 0; i < kTangential; ++i) inverse_roots_[i] = conditioning_ / roots_[i];
  coupling_size_ = Length<kTangential>(coupling_);
  root_trace_ = Length<kTangential>(roots_);
  if constexpr (kTangential == 2) {
    const bool is_one = freedom == Freedom::kOneAlone || freedom == Freedom::kOneBesideOthers;
    if (is_one && root_trace_ > 0.0) SetOneDirection(reduction);
  }
  steepest_ = wnn_ + std::max(most_friction_, static_friction_) * coupling_size_;
  slope_noise_ = 16.0 * kUnit * steepest_;
  SetHold(reduction, errors);
  SetGaps(errors);
  if constexpr (kTangential == 2) {
    if (has_one_direction_ && freedom == Freedom::kOneBesideOthers) SetTurn(reduction, errors, most_tau);
    if (freedom == Freedom::kTwoAlone) SetStop(reduction, errors);
  }
}

template <size_t kTangential>
void Neighbours<kTangential>::SetOneDirection(const Reduction<2>& reduction) {
  has_one_direction_ = true;
  conditioning_ = 1.0;
  const bool is_first = reduction.w[0] >= reduction.w[3];
  direction_ = {reduction.w[is_first ? 0 : 1], reduction.w[is_first ? 1 : 3]};
  const double length = Length<2>(direction_);
  for (double& component : direction_) component /= length;
  inverse_roots_.fill(1.0 / root_trace_);
}

// For slip (x, c) along and across d, friction along d is F = -mu x/sqrt(x^2 + c^2), which falls with x. Its slope by c
// is at most 2/(3 sqrt 3) mu/c, so that an error of c lets |u| grow by that times the root of tr Wtt at most.
template <size_t kTangential>
void Neighbours<kTangential>::SetTurn(const Reduction<2>& reduction, const ContactErrors<2>& errors, double most_tau) {
  const Vector<2> across = {-direction_[1], direction_[0]};
  const Vector<2> u0 = {reduction.u0[0], reduction.u0[1]};
  double part = 0.0, of_direction = 0.0, error = 0.0;
  for (size_t i = 0; i < 2; ++i) {
    const double of_wtt = errors.w[i][0] + errors.w[i][1];
    part += across[i] * u0[i];
    of_direction += 2.0 * of_wtt / (root_trace_ * root_trace_);
    error += std::fabs(across[i]) * (errors.velocity[i] + most_tau * (errors.w[i][2] + most_friction_ * of_wtt));
  }
  const double noise = (8.0 * kUnit + of_direction) * Length<2>(u0);
  error += noise;
  const double least = std::fabs(part) - noise - error;
  across_ = least > 0.0 ? error / least : kInfinity;
  turn_by_slip_ = least > 0.0 ? root_trace_ / least : kInfinity;
  slip_growth_ += Weighted(across_, 0.385 * most_friction_ * root_trace_);
}

template <size_t kTangential>
void Neighbours<kTangential>::SetHold(const Reduction<kTangential>& reduction,
                                      const ContactErrors<kTangential>& errors) {
  if constexpr (kTangential == 1) {
    const double wtt = reduction.w[0];
    stick_slope_ = wnn_;
    if (wtt > 0.0) {
      holding_[0] = coupling_[0] / wtt;
      stick_slope_ = DifferenceOfProducts(wtt, wnn_, coupling_[0], coupling_[0]) / wtt;
    }
  } else if (has_one_direction_) {
    const double along = coupling_[0] * direction_[0] + coupling_[1] * direction_[1];
    for (size_t i = 0; i < 2; ++i) holding_[i] = along / (root_trace_ * root_trace_) * direction_[i];
  } else {
    const bool is_full = roots_[0] > 0.0 && roots_[1] > 0.0;
    const double rho = is_full ? reduction.w[1] / roots_[0] / roots_[1] : 0.0;
    const double square = conditioning_ * conditioning_;
    Vector<2> scaled = {};
    for (size_t i = 0; i < 2; ++i) scaled[i] = roots_[i] > 0.0 ? coupling_[i] / roots_[i] : 0.0;
    for (size_t i = 0; i < 2; ++i) {
      if (roots_[i] > 0.0) holding_[i] = square * (scaled[i] - rho * scaled[1 - i]) / roots_[i];
    }
    stick_slope_ = wnn_ - coupling_[0] * holding_[0] - coupling_[1] * holding_[1] - Weighted(square, slope_noise_);
  }
  hold_ = Length<kTangential>(holding_);
  // That of B is off by da = Wtt^-1 (dwtn - dWtt hold - dWtt da). The 16 ulp of conditioning_ are in `rounding`.
  Vector<kTangential> change = {}, of_wtt = {};
  double spread = 0.0;
  for (size_t i = 0; i < kTangential; ++i) {
    change[i] = errors.w[i][kTangential] + 8.0 * kUnit * std::fabs(coupling_[i]);
    for (size_t j = 0; j < kTangential; ++j) {
      change[i] += errors.w[i][j] * std::fabs(holding_[j]);
      of_wtt[i] += errors.w[i][j];
    }
    spread += inverse_roots_[i];
  }
  const double rounding = Weighted(32.0 * kUnit * conditioning_ * conditioning_, hold_);
  const double again = Weighted(spread, Norm(of_wtt));
  hold_error_ = again < 1.0 ? (Weighted(spread, Norm(change)) + rounding) / (1.0 - again) : kInfinity;
}

// Slip along e = (c, s) turns to the left where (-s, c).(wtn - mu Wtt e) > 0. On both sides of u0 this looks for a
// direction with v = hold.u < 0 from which slip of B surely turns back. Then v stays below 0 until slip stops.
template <size_t kTangential>
void Neighbours<kTangential>::SetStop(const Reduction<2>& reduction, const ContactErrors<2>& errors) {
  constexpr int kDirections = 32;  // Slip that is caught between two of them is not known to be.
  const auto& w = reduction.w;     // 11, 12, 13, 22, 23, 33
  const Vector<2> u0 = {reduction.u0[0], reduction.u0[1]};
  const double size = Length<2>(u0), of_u0 = errors.velocity[0] + errors.velocity[1] + 8.0 * kUnit * size;
  const double trace = w[0] + w[3], steepest = coupling_size_ + most_friction_ * trace;
  double of_turn = friction_error_ * trace + steepest * (16.0 * kUnit + 2.0 * of_u0 / size);
  for (size_t i = 0; i < 2; ++i) of_turn += errors.w[i][2] + most_friction_ * (errors.w[i][0] + errors.w[i][1]);
  const auto turns_back = [&](double side, double part) {
    const double x = (1.0 - part) * u0[0] / size + part * side * holding_[1] / hold_;
    const double y = (1.0 - part) * u0[1] / size - part * side * holding_[0] / hold_;
    const double length = Hypot(x, y), c = x / length, s = y / length;
    const double turn =
        c * (w[4] - kinetic_friction_ * (w[1] * c + w[3] * s)) - s * (w[2] - kinetic_friction_ * (w[0] * c + w[1] * s));
    const bool is_beyond = side * (u0[0] * s - u0[1] * c) > of_u0 && holding_[0] * c + holding_[1] * s < -hold_error_;
    return (part == 0.0 || is_beyond) && side * turn < -of_turn;
  };
  bool on_left = false, on_right = false;
  for (int i = 0; i < kDirections; ++i) {
    on_left = on_left || turns_back(1.0, static_cast<double>(i) / kDirections);
    on_right = on_right || turns_back(-1.0, static_cast<double>(i) / kDirections);
  }
  stops_at_rest_ = on_left && on_right;
}

template <size_t kTangential>
void Neighbours<kTangential>::SetGaps(const ContactErrors<kTangential>& errors) {
  speed_gap_ = errors.velocity[kTangential];
  speed_growth_ = errors.w[kTangential][kTangential];
  if (!has_friction()) return;
  Vector<kTangential> u = {}, growth = {}, coupling = {};
  for (size_t i = 0; i < kTangential; ++i) {
    u[i] = errors.velocity[i];
    growth[i] = errors.w[i][kTangential];
    coupling[i] = std::fabs(coupling_[i]);
    for (size_t j = 0; j < kTangential; ++j) growth[i] += most_friction_ * errors.w[i][j];
    speed_growth_ += most_friction_ * errors.w[i][kTangential] + friction_error_ * coupling[i];
  }
  const double omega = std::min(std::sqrt(wnn_), Norm(coupling));
  slip_gap_ = Norm(u);
  slip_growth_ = Norm(growth) + friction_error_ * root_trace_;
  lever_ = 2.0 * omega;
  slip_pace_ = most_friction_ * root_trace_ + omega;
}

template <size_t kTangential>
double Neighbours<kTangential>::SettlingTime(double slip_gap) const {
  const double margin = kinetic_friction_ - friction_error_ - hold_ - hold_error_;
  double least = kInfinity;  // A bound below the root of the least eigenvalue of Wtt.
  for (const double root : roots_) least = std::min(least, root > 0.0 ? root / conditioning_ : kInfinity);
  least /= std::sqrt(static_cast<double>(kTangential));
  if (has_one_direction_) least = root_trace_;
  return margin > 0.0 && least > 0.0 ? slip_gap / (margin * least) : kInfinity;
}

template <size_t kTangential>
double Neighbours<kTangential>::LeastSlope(const Vector<kTangential>& u, double reach, bool is_held) const {
  if (!has_friction()) return wnn_;
  if (is_held) return stick_slope_;
  const double size = Length<kTangential>(u);
  if (size > reach) {
    const double turn = kTangential == 1 ? 0.0 : std::min(2.0 * reach / size, 2.0);
    return SlidingSlope(u) - kinetic_friction_ * coupling_size_ * turn;
  }
  const double slides = wnn_ - kinetic_friction_ * coupling_size_ - slope_noise_;
  return Holds() && !has_one_direction_ ? std::min(slides, stick_slope_) : slides;
}

// The course of A as far as the bound needs it.
template <size_t kTangential>
struct Course {
  explicit Course(const Outcome& outcome);

  bool is_known = false;
  Vector<kTangential> u0, u_compression, u1;
  double v0 = 0.0, v1 = 0.0, compression = 0.0, total = 0.0;
  std::optional<double> stop;  // Where slip stops, or 0 if there was none.

  bool SlidesOneWay(double reach_at_start, double reach_at_end) const {
    return kTangential == 1 && !stop.has_value() && std::fabs(u0[0]) > reach_at_start &&
           std::fabs(u1[0]) > reach_at_end && u0[0] * u1[0] > 0.0;
  }
};

template <size_t kTangential>
Course<kTangential>::Course(const Outcome& outcome) {
  const auto slip_at = [](const State& state) {
    Vector<kTangential> u;
    std::copy_n(state.contact_velocity.tangential_m_s.begin(), kTangential, u.begin());
    return u;
  };
  for (const Event& event : outcome.timeline) {
    const State& state = event.state;
    if (event.kind == EventKind::kStart) u0 = slip_at(state), v0 = state.contact_velocity.normal_m_s;
    if (event.kind == EventKind::kSlipStops) stop = state.normal_impulse_n_s;
    if (event.kind == EventKind::kCompressionEnds) {
      is_known = true;
      u_compression = slip_at(state);
      compression = state.normal_impulse_n_s;
    }
  }
  if (!is_known) return;
  const State& end = outcome.timeline.back().state;
  u1 = slip_at(end);
  v1 = end.contact_velocity.normal_m_s;
  total = end.normal_impulse_n_s;
  if (Length<kTangential>(u0) == 0.0) stop = stop.value_or(0.0);
}

// Returns a bound on the shift of an end: `bound(step)`, which holds if it is no larger than `step`.
double ProvedShift(absl::FunctionRef<double(double)> bound) {
  double step = bound(0.0);
  for (int i = 0; i < 8 && step < kInfinity; ++i) {
    step *= 1.0 + 0x1p-10;
    const double shift = bound(step);
    if (shift <= step) return shift;
    step = 2.0 * shift;
  }
  return kInfinity;
}

double Over(double gap, double slope) { return slope > 0.0 ? gap / slope : gap == 0.0 ? 0.0 : kInfinity; }

bool IsRigid(Model model) {
  return model == Model::kFrictionless || model == Model::kSliding || model == Model::kPlanar ||
         model == Model::kSpatial;
}

template <size_t kTangential>
class Comparison {
 public:
  Comparison(const Reduction<kTangential>& reduction, RestitutionLaw law, const ContactErrors<kTangential>& errors,
             Freedom freedom, const Outcome& outcome)
      : law_(law),
        errors_(errors),
        outcome_(outcome),
        freedom_(freedom),
        course_(outcome),
        most_tau_(freedom == Freedom::kOneBesideOthers ? 1.01 * course_.total : std::numeric_limits<double>::max()),
        near_(reduction, outcome.effective, errors, freedom, most_tau_),
        u_error_(outcome.errors.tangential_m_s.value_or(kInfinity)),
        v_error_(outcome.errors.normal_m_s.value_or(kInfinity)) {}

  // Returns the changes of the impulses, or nothing if B surely ends at rest.
  std::optional<Impulses<kTangential>> Bound() const;

 private:
  // True if B surely ends at rest, provided that it approaches.
  bool Rests() const {
    if (freedom_ == Freedom::kOneAlone) return near_.SurelyHolds() && Length<kTangential>(course_.u0) > 0.0;
    const double e = outcome_.effective.restitution.value_or(0.0) + errors_.coefficients.restitution.value_or(0.0);
    return near_.StopsAtRest() && (near_.SurelyHolds() || e == 0.0);
  }
  // True if slip of both stops as compression ends and starts again, in a direction that depends on W and mu alone. v
  // of A then rises by one slope, and so does that of B, by as much less as v of two impacts from rest may differ.
  bool Restarts() const { return near_.StopsAtRest() && near_.SurelySlips() && course_.stop.has_value(); }
  double RestartSlope() const { return near_.SlidingSlope(course_.u1) - near_.SpeedGapAfter(1.0, 0.0); }
  // Returns the normal impulse at which v of A begins to rise above 0. Slip may stop a little after v = 0.
  double Start() const { return Restarts() ? std::max(*course_.stop, course_.compression) : course_.compression; }
  double LeastSlope(const Vector<kTangential>& u, double from, double step) const {
    if (Restarts() && Start() <= from - step) return RestartSlope();
    const double reach = near_.root_trace() * near_.slip_pace() * step + u_error_;
    return near_.LeastSlope(u, reach, course_.stop.has_value() && near_.Holds() && *course_.stop <= from - step);
  }
  double CompressionShift() const {
    const auto bound = [&](double step) {
      const double slope = Restarts() ? RestartSlope() : LeastSlope(course_.u_compression, course_.compression, step);
      return Over(near_.SpeedGap(Start() + step), slope);
    };
    return Start() - course_.compression + ProvedShift(bound);
  }
  double RestitutionShift(double compression_shift) const;
  // True if A and B slip in one direction, or stick, from the ends of their compression on.
  bool ReboundAlike(double compression_shift, double slip_gap) const {
    if (!near_.has_friction()) return true;
    const double since = course_.stop.value_or(kInfinity) + near_.SettlingTime(slip_gap);
    return since <= course_.compression - compression_shift || SlideOneWay(slip_gap);
  }
  bool SlideOneWay(double slip_gap) const {
    const double reach = near_.root_trace() * slip_gap + u_error_;
    return course_.SlidesOneWay(reach, reach);
  }
  bool MayRest(double reach) const {
    const auto length = [](const Vector<kTangential>& u) { return Length<kTangential>(u); };
    return course_.stop.has_value() ||
           std::min({length(course_.u0), length(course_.u_compression), length(course_.u1)}) <= reach;
  }

  const RestitutionLaw law_;
  const ContactErrors<kTangential>& errors_;
  const Outcome& outcome_;
  const Freedom freedom_;
  const Course<kTangential> course_;
  const double most_tau_;  // No bound is given for a B whose impulse may exceed it.
  const Neighbours<kTangential> near_;
  const double u_error_, v_error_;  // The errors of A itself.
};

template <size_t kTangential>
double Comparison<kTangential>::RestitutionShift(double compression_shift) const {
  const double e = outcome_.effective.restitution.value_or(0.0);
  const double e_error = errors_.coefficients.restitution.value_or(0.0);
  if (e + e_error == 0.0) return 0.0;
  const double compression = course_.compression + compression_shift;
  if (law_ == RestitutionLaw::kPoisson) return e * compression_shift + e_error * compression;
  const double slip_gap = near_.SlipGap(compression) + near_.slip_pace() * compression_shift;
  const double time = course_.total - course_.compression;
  double lasting_gap = ReboundAlike(compression_shift, slip_gap) ? 0.0 : near_.lever() * slip_gap;
  if (Restarts()) lasting_gap = std::fabs(course_.v1 - near_.SlidingSlope(course_.u1) * (course_.total - Start()));
  if (law_ == RestitutionLaw::kNewton) {
    const double goal_gap = e * errors_.velocity[kTangential] + e_error * std::fabs(course_.v0);
    return ProvedShift([&](double step) {
      return Over(near_.SpeedGapAfter(time + step, lasting_gap) + goal_gap,
                  LeastSlope(course_.u1, course_.total, step));
    });
  }
  const double most = e + e_error;
  const double stored = std::fabs(outcome_.work.normal_compression_j.value_or(kInfinity));
  const double goal_gap = most * (most * near_.SpeedGap(compression) * compression + 2.0 * Weighted(stored, e_error));
  return ProvedShift([&](double step) {
    const double work_gap = near_.SpeedGapAfter(time + step, lasting_gap) * (time + step) + goal_gap;
    return Over(work_gap, course_.v1 - v_error_ - near_.steepest() * step);
  });
}

template <size_t kTangential>
std::optional<Impulses<kTangential>> Comparison<kTangential>::Bound() const {
  Impulses<kTangential> change;
  change.fill(kInfinity);
  if (!course_.is_known || !(near_.SpeedGap(0.0) < -0.5 * course_.v0)) return change;
  if (Rests()) return std::nullopt;
  if (outcome_.regime == Regime::kLocked) return change;
  const double compression_shift = CompressionShift();
  const double shift = compression_shift + RestitutionShift(compression_shift);
  const double last = course_.total + shift;
  if (!(last <= most_tau_)) return change;
  const double slip_gap = near_.SlipGap(last) + near_.slip_pace() * shift;
  if (near_.StaticFrictionDecides() && MayRest(near_.root_trace() * slip_gap + u_error_)) return change;
  const bool same_friction = !near_.has_friction() || SlideOneWay(slip_gap);
  for (size_t i = 0; i < kTangential; ++i) {
    const double gap = same_friction ? errors_.coefficients.kinetic_friction * last : near_.ImpulseGap(i, last);
    change[i] = WithRoundingMargin(gap + near_.most_friction() * shift);
  }
  change[kTangential] = WithRoundingMargin(shift);
  return change;
}

}  // namespace

template <size_t kTangential>
std::optional<Impulses<kTangential>> ImpulseChanges(const Reduction<kTangential>& reduction, RestitutionLaw law,
                                                    const ContactErrors<kTangential>& errors, Freedom freedom,
                                                    const Outcome& outcome) {
  Impulses<kTangential> change = {};
  const double v_error = errors.velocity[kTangential];
  if (outcome.regime == Regime::kSeparating && (v_error == 0.0 || reduction.v0 > v_error)) return change;
  if (HasEnd(outcome.termination) && IsRigid(outcome.plan.model)) {
    return Comparison<kTangential>(reduction, law, errors, freedom, outcome).Bound();
  }
  change.fill(kInfinity);
  return change;
}

template std::optional<Impulses<1>> ImpulseChanges<1>(const Reduction<1>&, RestitutionLaw, const ContactErrors<1>&,
                                                      Freedom, const Outcome&);
template std::optional<Impulses<2>> ImpulseChanges<2>(const Reduction<2>&, RestitutionLaw, const ContactErrors<2>&,
                                                      Freedom, const Outcome&);

}  // namespace ricochet
