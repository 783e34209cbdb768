// The solver behind core/models/spatial/spatial.h over a floating type T: double, or a wider one that tests hold it against.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_SOLVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_SOLVER_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_SOLVER_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_SOLVER_INL_H_
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/models/restitution_law.h"
#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/series-inl.h"
#include "core/models/spatial/spatial.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

namespace internal {

// A power of two that need not be a double: three factors that are.
struct Scale {
  double first, second, third;

  template <typename T>
  T operator()(T value) const {
    return value * first * second * third;
  }
};

inline int Exponent(double value) {
  int exponent = 0;
  (void)std::frexp(value, &exponent);
  return exponent;
}

inline Scale PowerOfTwo(int exponent) {
  constexpr int kMost = 1000;
  const auto factor = [](int e) { return std::bit_cast<double>(static_cast<int64_t>(e + 1023) << 52); };
  const int first = std::clamp(exponent, -kMost, kMost);
  const int second = std::clamp(exponent - first, -kMost, kMost);
  return {factor(first), factor(second), factor(exponent - first - second)};
}

}  // namespace internal

// One impact. Velocities are in units of 2^i, W in units of 2^j, so that nothing overflows.
//
// Error estimate. Coulomb friction contracts: two solutions approach each other in the norm of Wtt^-1, at equal tau,
//   (u - u')^T Wtt^-1 d(u - u')/dtau = -mu (u - u').(e - e') <= 0.
// An error df of the friction impulse at equal tau is Wtt df in u, so it has that norm sqrt(df^T Wtt df), and what all
// steps left behind is at most the sum of theirs, E. Semidefiniteness of W then bounds the velocities at equal tau:
//   |du| <= sqrt(largest eigenvalue of Wtt) E,   |dv| = |wtn . Wtt^-1 du| <= sqrt(Wnn) E.
// An event late by dtau adds dtau times the slopes there. Once the contact sticks, E is 0 again.
//
// Rounding. Slopes of slip along a line are sums of W's entries and of mu times others along e; with eps = 2^-52,
//   v' is off by eps (Wnn + mu |wtn|),   u' by eps (|wtn| + mu |Wtt|),
// however small they are themselves. Over a length in tau these are errors of v and of u. That of v is late / v' where
// v has to reach something, and its integral where work has. Slip that stops late by dtau = (error of u)/|u'| to stick
// leaves in v what the two slopes differ by, times dtau.
template <typename T>
class Solver {
 public:
  Solver(const Problem& problem, T tolerance);
  Impact Run();
  int Rank() const { return w_.Rank(); }

 private:
  // Impulses and work are those of this phase: what is left of a short restitution keeps its digits.
  struct State {
    T tau{0}, f1{0}, f2{0};
    T u1{0}, u2{0}, v{0};
    T friction_work{0};
  };
  struct Slopes {
    T u1, u2, v;
  };
  // The end of a phase: what has to reach `target`.
  enum class Quantity { kVelocity, kImpulse, kWork };
  struct Goal {
    Quantity quantity;
    T target;
  };
  struct Straight {
    Slopes slopes;
    T f1, f2;              // df/dtau
    T friction;            // d(friction work)/dtau over |u|: -mu while slipping, else 0
    T length;              // tau that is left
    bool to_rest = false;  // The body will be locked, so that no event comes before.
  };
  struct Rates {
    T value, slope;  // Of the goal's quantity, over xi.
  };

  static constexpr T kEpsilon = std::numeric_limits<double>::epsilon();
  static constexpr T kInfinity = std::numeric_limits<T>::infinity();
  // Far above what any impact was seen to need; see the tests.
  static constexpr int64_t kStepBudget = 10000;
  // Of the tolerance: for the last terms kept of a step, and for leaving a curve for its asymptote.
  static constexpr T kStepShare{0.15};
  static constexpr T kSwitchShare{0.1};

  void SlideFreely();
  void Slip();
  void SlipStraight(const Direction<T>& e);
  void AfterStop();
  void Advance(const Straight& piece);

  void EndLocked();
  void Step(const Frame<T>& frame, T slip);
  T OrderedEnd(const Frame<T>& frame, T slip, T end) const;
  State At(const Frame<T>& frame, T slip, T xi) const;
  void TurnTo(const Direction<T>& e);
  bool SwitchToStraight(const Frame<T>& frame, T slip);
  Frame<T> FrameAt(const Direction<T>& e) const;
  Slopes SlopesAlong(const Direction<T>& e) const;

  T VelocityRate(const State& state) const;
  Rates GoalRates(const State& state) const;
  T Value(const State& state) const;
  T PhaseWork(const State& state) const;
  T WorkRounding() const;
  T Distance(const Slopes& slopes) const;
  void Reach(const Slopes& slopes);
  void EndCompression(const Slopes& slopes);
  void EndRestitution(const Slopes& slopes);
  void Record(EventKind kind);
  void SetRegime(Regime in_compression, Regime in_restitution);

  void AddError(T error) { error_ += error; }
  T Late(const Slopes& slopes) const;
  T Estimate(const Slopes& slopes) const;
  void Report();
  void EchoCoefficient();

  double Velocity(T value) const { return static_cast<double>(velocity_unit_(value)) + 0.0; }
  double Impulse(T value) const { return static_cast<double>(impulse_unit_(value)) + 0.0; }
  double Work(T value) const { return static_cast<double>(work_unit_(value)) + 0.0; }

  const Problem& problem_;
  T tolerance_;
  int order_;
  internal::Scale velocity_unit_, impulse_unit_, work_unit_;
  Matrix<T> w_;
  T mu_, mu_static_, coefficient_;
  T scale_;         // max(|u0|, |v0|)
  T rate_;          // mu |Wtt| + |wtn|: the unit of 1/xi
  T largest_root_;  // sqrt of Wtt's largest eigenvalue
  T smallest_root_;
  T normal_root_;  // sqrt(Wnn)
  T steepest_;     // |v'| is not above it.
  bool may_jam_;   // v' < 0 is possible.

  State start_, state_, origin_;  // origin_: where the phase began.
  State compression_end_;         // Stays 0 until then.
  bool restitution_ = false;
  bool done_ = false;
  Goal goal_ = {Quantity::kVelocity, T{0}};
  SlipSeries<T> series_;

  T error_{0};              // E
  T work_error_{0};         // Of normal work in this phase: int |dv| dtau, and that of friction's.
  T compression_error_{0};  // dtau of the end of compression
  T compression_work_error_{0};
  T rounding_{0};       // Of v
  T slip_rounding_{0};  // Of u
  T estimate_{0};
  bool has_stopped_ = false;
  T stop_tau_ = -kInfinity;  // Where slip stopped, from where the phase began.
  Slopes slopes_before_stop_ = {T{0}, T{0}, T{0}};
  T landed_v_{0};  // Instead of 0, at the end of compression.
  T landing_{0};   // How far in tau the last event was found from its place.
  T work_compression_{0};
  Impact impact_;
};

namespace internal {

// The root of an increasing function with f(0) < 0 <= f(end): Newton's method, bisection where that would leave the
// bracket. `rates(x)` gives value and slope. A step
// of `last` times the root is the last.
template <typename T, typename F>
T FindRoot(const F& rates, T guess, T end, T last) {
  T low{0};
  T high = end;
  T x = guess > T{0} && guess < end ? guess : end;
  constexpr int kEnough = 200;
  for (int i = 0; i < kEnough && high > low; ++i) {
    const auto [value, slope] = rates(x);
    (value < T{0} ? low : high) = x;
    T next = x - value / slope;
    if (!(next > low && next < high)) {
      if (value == T{0} || std::fabs(next - x) <= last * x) return x;
      next = T{0.5} * (low + high);
    }
    if (std::fabs(next - x) <= last * next) return next;
    x = next;
  }
  return x;
}

// Terms of the series, by what one more costs and how much longer a step it allows.
template <typename T>
int OrderFor(T tolerance) {
  if (tolerance >= T{1e-5}) return kMinOrder;
  if (tolerance >= T{1e-7}) return 11;
  if (tolerance >= T{1e-9}) return 14;
  if (tolerance >= T{1e-11}) return 17;
  return tolerance >= T{1e-14} ? 20 : kMaxOrder;
}

}  // namespace internal

template <typename T>
Solver<T>::Solver(const Problem& problem, T tolerance)
    : problem_(problem), tolerance_(tolerance), order_(internal::OrderFor(tolerance)) {
  const double velocity_size =
      std::max(std::max(std::fabs(problem.u0[0]), std::fabs(problem.u0[1])), std::fabs(problem.v0));
  const int velocity_exponent = internal::Exponent(velocity_size);
  const int matrix_exponent = internal::Exponent(std::max(std::max(problem.w11, problem.w22), problem.w33));
  velocity_unit_ = internal::PowerOfTwo(velocity_exponent);
  impulse_unit_ = internal::PowerOfTwo(velocity_exponent - matrix_exponent);
  work_unit_ = internal::PowerOfTwo(2 * velocity_exponent - matrix_exponent);
  const internal::Scale to_matrix = internal::PowerOfTwo(-matrix_exponent);
  const internal::Scale to_velocity = internal::PowerOfTwo(-velocity_exponent);
  const auto matrix = [&](double value) { return static_cast<T>(to_matrix(value)); };
  const auto velocity = [&](double value) { return static_cast<T>(to_velocity(value)); };
  w_ = {.w11 = matrix(problem.w11),
        .w12 = matrix(problem.w12),
        .w13 = matrix(problem.w13),
        .w22 = matrix(problem.w22),
        .w23 = matrix(problem.w23),
        .w33 = matrix(problem.w33)};
  mu_ = problem.mu;
  mu_static_ = problem.mu_static;
  coefficient_ = problem.coefficient;
  state_.u1 = velocity(problem.u0[0]);
  state_.u2 = velocity(problem.u0[1]);
  state_.v = velocity(problem.v0);
  start_ = origin_ = state_;
  const T coupling = std::sqrt(w_.w13 * w_.w13 + w_.w23 * w_.w23);
  const T largest = w_.LargestTangentEigenvalue();
  scale_ = std::max(std::sqrt(state_.u1 * state_.u1 + state_.u2 * state_.u2), std::fabs(state_.v));
  rate_ = mu_ * largest + coupling;
  largest_root_ = std::sqrt(largest);
  smallest_root_ = std::sqrt(std::max(w_.TangentDeterminant() / largest, kEpsilon * largest));
  normal_root_ = std::sqrt(w_.w33);
  may_jam_ = mu_ * coupling >= w_.w33;
  steepest_ = w_.w33 + mu_ * coupling;
}

template <typename T>
Impact Solver<T>::Run() {
  impact_.w_rank = w_.Rank();
  Record(EventKind::kStart);
  if (w_.w11 == T{0} && w_.w22 == T{0}) {
    SlideFreely();
  } else if (state_.u1 == T{0} && state_.u2 == T{0}) {
    impact_.closed_form = true;
    AfterStop();
  } else if (mu_ == T{0}) {
    SlideFreely();
  } else {
    Slip();
  }
  if (!done_) impact_.converged = false;
  Report();
  return impact_;
}

// No friction impulse while the contact slips; it may stick if its slip happens to vanish.
template <typename T>
void Solver<T>::SlideFreely() {
  impact_.closed_form = true;
  const T cross = state_.u1 * w_.w23 - state_.u2 * w_.w13;
  const T along = state_.u1 * w_.w13 + state_.u2 * w_.w23;
  if (cross == T{0} && along < T{0}) return SlipStraight(Normalized(state_.u1, state_.u2));
  Advance({.slopes = {w_.w13, w_.w23, w_.w33}, .f1 = T{0}, .f2 = T{0}, .friction = T{0}, .length = kInfinity});
}

template <typename T>
void Solver<T>::Slip() {
  constexpr T kInvariant = T{8} * kEpsilon;
  // Below it slip has stopped as far as velocities go. Static friction alone can tell a stop from a near miss.
  const T stopped = mu_static_ > mu_ ? T{0x1p-400} : T{0x1p-70};
  const Direction<T> start = Normalized(state_.u1, state_.u2);
  if (w_.TangentIsSingular() || std::fabs(FrameAt(start).Turn()) <= kInvariant) {
    impact_.closed_form = true;
    return SlipStraight(start);
  }
  while (!done_ && impact_.steps < kStepBudget) {
    const T slip = std::sqrt(state_.u1 * state_.u1 + state_.u2 * state_.u2);
    if (slip < stopped) return AfterStop();
    const Frame<T> frame = FrameAt({state_.u1 / slip, state_.u2 / slip});
    if (SwitchToStraight(frame, slip)) return;
    Step(frame, slip);
  }
}

// Once slip is so near an attracting invariant direction that what it still turns by cannot be seen in the result, it
// follows that direction: exactly linear in tau, to its stop or for good.
template <typename T>
bool Solver<T>::SwitchToStraight(const Frame<T>& frame, T slip) {
  const T turn_slope = frame.TurnSlope();
  if (!(turn_slope < T{0})) return false;
  const T along = -frame.a11 * rate_ / mu_;  // e^T Wtt e
  const T norm = std::sqrt(along) / (largest_root_ * smallest_root_);
  const T error = slip * std::fabs(frame.Turn() / turn_slope) * norm;
  constexpr T kNear{0.1};
  if (!(std::fabs(frame.Turn()) <= -kNear * turn_slope)) return false;
  if (!(error * std::max(largest_root_, normal_root_) <= kSwitchShare * tolerance_ * scale_)) return false;
  Frame<T> there = frame;
  constexpr int kEnough = 8;
  for (int i = 0; i < kEnough; ++i) {
    const T turn = -there.Turn() / there.TurnSlope();
    if (std::fabs(turn) <= kEpsilon) break;
    there = FrameAt(Normalized(there.c - turn * there.s, there.s + turn * there.c));
  }
  const T left = T{1} - (there.c * frame.c + there.s * frame.s);
  if (!(left < T{0.1}) || !(there.TurnSlope() < T{0}) || !(std::fabs(there.Turn()) < T{1e-12})) return false;
  AddError(T{2} * error);
  work_error_ += slip * error;
  TurnTo({there.c, there.s});
  SlipStraight({there.c, there.s});
  return true;
}

// Slip of the same size along e, by a friction impulse: the state remains one that impulses lead to.
template <typename T>
void Solver<T>::TurnTo(const Direction<T>& e) {
  const T slip = std::sqrt(state_.u1 * state_.u1 + state_.u2 * state_.u2);
  const T du1 = slip * e.c - state_.u1;
  const T du2 = slip * e.s - state_.u2;
  const T determinant = w_.TangentDeterminant();
  const T df1 = (w_.w22 * du1 - w_.w12 * du2) / determinant;
  const T df2 = (w_.w11 * du2 - w_.w12 * du1) / determinant;
  state_.friction_work += df1 * (state_.u1 + T{0.5} * du1) + df2 * (state_.u2 + T{0.5} * du2);
  state_.f1 += df1;
  state_.f2 += df2;
  state_.u1 += du1;
  state_.u2 += du2;
  state_.v += w_.w13 * df1 + w_.w23 * df2;
}

template <typename T>
void Solver<T>::SlipStraight(const Direction<T>& e) {
  const Slopes slopes = SlopesAlong(e);
  const T slip = std::sqrt(state_.u1 * state_.u1 + state_.u2 * state_.u2);
  T growth = slopes.u1 * e.c + slopes.u2 * e.s;
  // Slip that starts grows, if ever so slowly: a rounding below 0 would stop it where it is, again and again.
  if (slip == T{0}) growth = std::max(growth, T{0});
  AddError(kEpsilon * slip / smallest_root_);
  Straight piece = {.slopes = {growth * e.c, growth * e.s, slopes.v},
                    .f1 = -mu_ * e.c,
                    .f2 = -mu_ * e.s,
                    .friction = -mu_,
                    .length = growth < T{0} ? -slip / growth : kInfinity};
  // Where friction and the joints will lock the body, v vanishes with u, and rounding must not let it come first.
  if (!restitution_ && growth < T{0} && impact_.w_rank < 3) {
    const Sticking<T> sticking = w_.Stick(mu_static_);
    if (sticking.holds && sticking.v_slope == T{0}) piece.to_rest = true;
  }
  slopes_before_stop_ = piece.slopes;
  Advance(piece);
  if (done_) return;
  state_.u1 = state_.u2 = T{0};
  AfterStop();
}

template <typename T>
void Solver<T>::AfterStop() {
  // Slip that starts again grows: it stops a second time only where numbers are beyond doubles.
  if (std::exchange(has_stopped_, true)) {
    impact_.converged = false;
    done_ = true;
    return;
  }
  if (state_.u1 != T{0} || state_.u2 != T{0}) slopes_before_stop_ = SlopesAlong(Normalized(state_.u1, state_.u2));
  stop_tau_ = state_.tau;
  state_.u1 = state_.u2 = T{0};
  const bool at_start = impact_.event_count == 1 && state_.tau == T{0};
  if (!at_start) Record(EventKind::kSlipStops);
  const Sticking<T> sticking = w_.Stick(mu_static_);
  if (!sticking.holds) {
    if (!at_start) SetRegime(Regime::kReversalInCompression, Regime::kReversalInRestitution);
    return SlipStraight(w_.Restart(mu_));
  }
  error_ = T{0};
  if (sticking.v_slope == T{0}) return EndLocked();
  const Slopes& before = slopes_before_stop_;
  const T slowing = std::sqrt(before.u1 * before.u1 + before.u2 * before.u2);
  if (slowing > T{0}) rounding_ += std::fabs(before.v - sticking.v_slope) * (slip_rounding_ / slowing);
  slip_rounding_ = T{0};
  SetRegime(Regime::kStickInCompression, Regime::kStickInRestitution);
  Advance({.slopes = {T{0}, T{0}, sticking.v_slope},
           .f1 = sticking.f1,
           .f2 = sticking.f2,
           .friction = T{0},
           .length = kInfinity});
}

// At rest for good: whatever the impulse, the body does not move.
template <typename T>
void Solver<T>::EndLocked() {
  SetRegime(Regime::kLocked, Regime::kStickInRestitution);
  const Slopes none = {T{0}, T{0}, T{0}};
  state_.v = T{0};
  if (!restitution_) EndCompression(none);
  if (!done_) EndRestitution(none);
}

template <typename T>
void Solver<T>::Advance(const Straight& piece) {
  T left = piece.length;
  while (!done_) {
    const T distance = piece.to_rest ? kInfinity : Distance(piece.slopes);
    const T length = std::min(distance, left);
    if (!(length < kInfinity)) return;
    const T slip = std::sqrt(state_.u1 * state_.u1 + state_.u2 * state_.u2);
    state_.tau += length;
    state_.f1 += piece.f1 * length;
    state_.f2 += piece.f2 * length;
    state_.u1 += piece.slopes.u1 * length;
    state_.u2 += piece.slopes.u2 * length;
    state_.v += piece.slopes.v * length;
    const T slip_after = std::sqrt(state_.u1 * state_.u1 + state_.u2 * state_.u2);
    state_.friction_work += piece.friction * length * T{0.5} * (slip + slip_after);
    const bool slips = piece.friction != T{0};
    rounding_ += kEpsilon * ((slips ? steepest_ : w_.w33) * length + std::fabs(state_.v));
    if (slips) slip_rounding_ += kEpsilon * (rate_ * length + slip);
    work_error_ += (normal_root_ * error_ + rounding_) * length;
    if (!(distance <= left)) return;
    left -= length;
    Reach(piece.slopes);
  }
}

template <typename T>
Frame<T> Solver<T>::FrameAt(const Direction<T>& e) const {
  const T c = e.c;
  const T s = e.s;
  const T along = c * w_.w11 + s * w_.w12;  // Wtt e
  const T across = c * w_.w12 + s * w_.w22;
  const T a = -mu_ / rate_;
  return {.c = c,
          .s = s,
          .a11 = a * (c * along + s * across),
          .a12 = a * (c * across - s * along),
          .a22 = a * (s * s * w_.w11 + c * c * w_.w22 - T{2} * c * s * w_.w12),
          .w1 = (c * w_.w13 + s * w_.w23) / rate_,
          .w2 = (c * w_.w23 - s * w_.w13) / rate_};
}

template <typename T>
typename Solver<T>::Slopes Solver<T>::SlopesAlong(const Direction<T>& e) const {
  return {.u1 = w_.w13 - mu_ * (w_.w11 * e.c + w_.w12 * e.s),
          .u2 = w_.w23 - mu_ * (w_.w12 * e.c + w_.w22 * e.s),
          .v = w_.w33 - mu_ * (w_.w13 * e.c + w_.w23 * e.s)};
}

template <typename T>
typename Solver<T>::State Solver<T>::At(const Frame<T>& frame, T slip, T xi) const {
  const SeriesValues<T> values = series_.At(xi);
  const T unit = slip / rate_;
  const T tau = unit * values.s_integral;
  const T f1 = -mu_ * unit * (frame.c * values.x_integral - frame.s * values.y_integral);
  const T f2 = -mu_ * unit * (frame.s * values.x_integral + frame.c * values.y_integral);
  return {.tau = state_.tau + tau,
          .f1 = state_.f1 + f1,
          .f2 = state_.f2 + f2,
          .u1 = slip * (frame.c * values.x - frame.s * values.y),
          .u2 = slip * (frame.s * values.x + frame.c * values.y),
          .v = state_.v + (w_.w33 * tau + w_.w13 * f1 + w_.w23 * f2),
          .friction_work = state_.friction_work - mu_ * slip * unit * values.square_integral};
}

template <typename T>
void Solver<T>::Step(const Frame<T>& frame, T slip) {
  series_.Expand(frame, order_);
  ++impact_.steps;
  impact_.right_hand_sides += order_;
  const T unit = largest_root_ * mu_ * slip / rate_;
  const T work_unit = mu_ * slip * slip / rate_;
  const T allowed = kStepShare * tolerance_ * scale_;
  // However small the slip: within the series' convergence, and so that it comes nearer a direction that attracts it.
  const T off = std::fabs(frame.Turn() / frame.TurnSlope());
  const T nearer = frame.TurnSlope() < T{0} ? std::max(T{0.1} * off, kEpsilon) : T{1};
  const T relative = std::min(std::ldexp(T{1}, -(5 * order_) / 4), nearer);
  T end = series_.Reach(std::min(allowed / (std::max(largest_root_, normal_root_) * unit), relative),
                        std::min(allowed * scale_ / (steepest_ * work_unit), relative));
  if (may_jam_) end = OrderedEnd(frame, slip, end);
  State next = At(frame, slip, end);
  const bool reached = Value(next) >= goal_.target;
  if (reached) {
    const auto rates = [&](T xi) { return GoalRates(At(frame, slip, xi)); };
    end = internal::FindRoot<T>(rates, Distance(SlopesAlong({frame.c, frame.s})) * rate_ / slip, end,
                                T{1e-3} * std::sqrt(tolerance_));
    next = At(frame, slip, end);
  }
  AddError(unit * series_.Remainder(end) + kEpsilon * slip / smallest_root_);
  work_error_ += normal_root_ * error_ * (next.tau - state_.tau) + work_unit * series_.SquareRemainder(end);
  rounding_ += kEpsilon * (w_.w33 * (next.tau - state_.tau) + std::fabs(next.v));
  state_ = next;
  if (!reached) return;
  const Rates rates = GoalRates(state_);
  landing_ =
      T{2} * std::fabs(rates.value / rates.slope) * std::sqrt(state_.u1 * state_.u1 + state_.u2 * state_.u2) / rate_;
  Reach(SlopesAlong(Normalized(state_.u1, state_.u2)));
}

// Where v' may change sign: `end`, or before it what makes the quantity that ends the phase monotonic until then.
template <typename T>
T Solver<T>::OrderedEnd(const Frame<T>& frame, T slip, T end) const {
  constexpr T kNegligible{1e-6};
  const auto cut = [&](const auto& rates) {
    const Rates first = rates(T{0});
    const Rates last = rates(end);
    if ((first.value < T{0}) == (last.value < T{0})) return;
    const T sign = first.value < T{0} ? T{1} : T{-1};
    const auto increasing = [&](T xi) {
      const Rates here = rates(xi);
      return Rates{sign * here.value, sign * here.slope};
    };
    const T root = internal::FindRoot<T>(increasing, end, end, T{1e-9});
    if (root > kNegligible * end) end = root;
  };
  const auto u_rates = [&](T xi, T p, T q) {  // Of p x + q y.
    const SeriesValues<T> at = series_.At(xi);
    const T s = std::sqrt(at.x * at.x + at.y * at.y);
    return Rates{p * at.x + q * at.y, p * (frame.a11 * at.x + frame.a12 * at.y + frame.w1 * s) +
                                          q * (frame.a12 * at.x + frame.a22 * at.y + frame.w2 * s)};
  };
  // v' is smallest where e points along wtn.
  cut([&](T xi) { return u_rates(xi, -frame.w2, frame.w1); });
  // v' s
  cut([&](T xi) {
    const SeriesValues<T> at = series_.At(xi);
    const T s = std::sqrt(at.x * at.x + at.y * at.y);
    const Rates x = u_rates(xi, T{1}, T{0});
    const Rates y = u_rates(xi, T{0}, T{1});
    const T s_slope = (at.x * x.slope + at.y * y.slope) / s;
    return Rates{w_.w33 / rate_ * s - mu_ * (frame.w1 * at.x + frame.w2 * at.y),
                 w_.w33 / rate_ * s_slope - mu_ * (frame.w1 * x.slope + frame.w2 * y.slope)};
  });
  if (restitution_ && state_.v != T{0}) {
    cut([&](T xi) {
      const State at = At(frame, slip, xi);
      return Rates{at.v, VelocityRate(at)};
    });
  }
  return end;
}

// dv/dxi
template <typename T>
T Solver<T>::VelocityRate(const State& state) const {
  const T s = std::sqrt(state.u1 * state.u1 + state.u2 * state.u2);
  return (w_.w33 * s - mu_ * (w_.w13 * state.u1 + w_.w23 * state.u2)) / rate_;
}

template <typename T>
typename Solver<T>::Rates Solver<T>::GoalRates(const State& state) const {
  const T value = Value(state) - goal_.target;
  if (goal_.quantity == Quantity::kVelocity) return {value, VelocityRate(state)};
  const T tau_rate = std::sqrt(state.u1 * state.u1 + state.u2 * state.u2) / rate_;
  return {value, goal_.quantity == Quantity::kImpulse ? tau_rate : state.v * tau_rate};
}

template <typename T>
T Solver<T>::Value(const State& state) const {
  switch (goal_.quantity) {
    case Quantity::kVelocity:
      return state.v;
    case Quantity::kImpulse:
      return state.tau;
    case Quantity::kWork:
      break;
  }
  return PhaseWork(state);
}

// Normal work of this phase: what changed the energy and was not friction.
template <typename T>
T Solver<T>::PhaseWork(const State& state) const {
  return T{0.5} * (state.f1 * (state.u1 + origin_.u1) + state.f2 * (state.u2 + origin_.u2) +
                   state.tau * (state.v + origin_.v)) -
         state.friction_work;
}

// Of PhaseWork: that of its terms, which may cancel.
template <typename T>
T Solver<T>::WorkRounding() const {
  const T f = std::fabs(state_.f1) + std::fabs(state_.f2);
  return T{2} * kEpsilon * (f + state_.tau) * scale_;
}

// How much tau until the goal, if the slopes stay.
template <typename T>
T Solver<T>::Distance(const Slopes& slopes) const {
  const T missing = goal_.target - Value(state_);
  if (!(missing > T{0})) return T{0};
  switch (goal_.quantity) {
    case Quantity::kVelocity:
      return slopes.v > T{0} ? missing / slopes.v : kInfinity;
    case Quantity::kImpulse:
      return missing;
    case Quantity::kWork:
      break;
  }
  const T square = state_.v * state_.v + T{2} * slopes.v * missing;
  if (square < T{0}) return kInfinity;
  const T root = std::sqrt(square);
  if (state_.v >= T{0}) return root > T{0} ? T{2} * missing / (state_.v + root) : kInfinity;
  return slopes.v > T{0} ? (root - state_.v) / slopes.v : kInfinity;
}

template <typename T>
void Solver<T>::Reach(const Slopes& slopes) {
  if (!restitution_) {
    EndCompression(slopes);
  } else if (goal_.quantity == Quantity::kImpulse && state_.v < T{0}) {
    goal_ = {Quantity::kVelocity, T{0}};
  } else {
    EndRestitution(slopes);
  }
}

template <typename T>
void Solver<T>::EndCompression(const Slopes& slopes) {
  const T landed_v = state_.v;
  work_compression_ = PhaseWork(state_);
  state_.v = T{0};
  Record(EventKind::kCompressionEnds);
  compression_error_ = Late(slopes) + landing_;
  landing_ = T{0};
  compression_work_error_ = work_error_ + WorkRounding();
  work_error_ = T{0};
  restitution_ = true;
  compression_end_ = state_;
  stop_tau_ -= state_.tau;
  state_ = {.u1 = state_.u1, .u2 = state_.u2, .v = T{0}};
  switch (problem_.law) {
    case RestitutionLaw::kNewton:
      goal_ = {Quantity::kVelocity, -coefficient_ * start_.v};
      break;
    case RestitutionLaw::kPoisson:
      goal_ = {Quantity::kImpulse, coefficient_ * compression_end_.tau};
      break;
    case RestitutionLaw::kEnergetic:
      goal_ = {Quantity::kWork, -coefficient_ * coefficient_ * work_compression_};
      break;
  }
  if (coefficient_ == T{0}) return EndRestitution(slopes);
  // Where v was left by the search for its root, for it goes on from there.
  state_.v = landed_v_ = landed_v;
  origin_ = state_;
}

template <typename T>
void Solver<T>::EndRestitution(const Slopes& slopes) {
  if (impact_.regime != Regime::kLocked) Record(EventKind::kRestitutionEnds);
  const bool sticks = impact_.regime == Regime::kStickInCompression || impact_.regime == Regime::kStickInRestitution ||
                      impact_.regime == Regime::kLocked;
  const bool frictionless = mu_ == T{0} || (w_.w11 == T{0} && w_.w22 == T{0});
  if (!sticks && frictionless) impact_.regime = Regime::kFrictionless;
  if (impact_.regime == Regime::kUnspecified) impact_.regime = Regime::kSliding;
  estimate_ = Estimate(slopes);
  done_ = true;
}

template <typename T>
void Solver<T>::Record(EventKind kind) {
  impact_.events[static_cast<size_t>(impact_.event_count++)] = {
      .kind = kind,
      .tau = Impulse(compression_end_.tau + state_.tau),
      .f = {Impulse(compression_end_.f1 + state_.f1), Impulse(compression_end_.f2 + state_.f2)},
      .u = {Velocity(state_.u1), Velocity(state_.u2)},
      .v = Velocity(state_.v)};
}

template <typename T>
void Solver<T>::SetRegime(Regime in_compression, Regime in_restitution) {
  impact_.regime = restitution_ ? in_restitution : in_compression;
}

// How late an event of v may be, in tau: where v hardly changes, as for a v that is quadratic.
template <typename T>
T Solver<T>::Late(const Slopes& slopes) const {
  const T error = normal_root_ * error_ + rounding_;
  return error == T{0} ? T{0} : error / std::max(slopes.v, std::sqrt(error));
}

template <typename T>
T Solver<T>::Estimate(const Slopes& slopes) const {
  T late{0};
  if (coefficient_ == T{0}) {
    late = compression_error_;
  } else if (goal_.quantity == Quantity::kVelocity) {
    late = Late(slopes);
  } else if (goal_.quantity == Quantity::kImpulse) {
    late = (T{1} + coefficient_) * compression_error_;
  } else {
    const T work = coefficient_ * coefficient_ * compression_work_error_ + work_error_ + WorkRounding();
    late = state_.v > T{0} ? (work + landed_v_ * landed_v_ / std::max(slopes.v, kEpsilon)) / state_.v : T{0};
  }
  late += landing_;
  const auto size = [](const Slopes& of) { return std::sqrt(of.u1 * of.u1 + of.u2 * of.u2); };
  T u_slope = size(slopes);
  T v_slope = std::fabs(slopes.v);
  if (state_.tau - stop_tau_ <= T{2} * late) {  // The event may be before the stop.
    u_slope = std::max(u_slope, size(slopes_before_stop_));
    v_slope = std::max(v_slope, std::fabs(slopes_before_stop_.v));
  }
  const T u_error = largest_root_ * error_ + slip_rounding_ + late * u_slope;
  // A v that ends the impact is what was asked for.
  const bool v_is_goal = coefficient_ == T{0} || goal_.quantity == Quantity::kVelocity;
  const T v_error = v_is_goal ? landing_ * v_slope : normal_root_ * error_ + late * v_slope;
  constexpr T kOutput = T{4} * kEpsilon;
  return (std::max(u_error, v_error) + T{2} * rounding_) / scale_ + kOutput;
}

template <typename T>
void Solver<T>::Report() {
  const T work_restitution = restitution_ ? PhaseWork(state_) : T{0};
  const T tau_c = compression_end_.tau;
  const T tau = tau_c + state_.tau;
  const T f1 = compression_end_.f1 + state_.f1;
  const T f2 = compression_end_.f2 + state_.f2;
  const T friction_compression = restitution_ ? compression_end_.friction_work : state_.friction_work;
  const auto of_compression = [](T value, T whole) { return whole == T{0} ? 0.0 : static_cast<double>(value / whole); };
  impact_.u1 = {Velocity(state_.u1), Velocity(state_.u2)};
  impact_.v1 = Velocity(state_.v);
  impact_.tau_compression = Impulse(tau_c);
  impact_.tau1 = Impulse(tau);
  impact_.f1 = {Impulse(f1), Impulse(f2)};
  impact_.work_normal_compression = Work(work_compression_);
  impact_.work_normal_restitution = Work(work_restitution);
  impact_.work_tangential_compression = Work(friction_compression);
  impact_.work_tangential_restitution = Work(restitution_ ? state_.friction_work : T{0});
  const T change = T{0.5} * (f1 * (state_.u1 + start_.u1) + f2 * (state_.u2 + start_.u2) + tau * (state_.v + start_.v));
  impact_.energy_change = Work(change);
  impact_.error_estimate = impact_.converged ? static_cast<double>(estimate_) : std::numeric_limits<double>::infinity();
  impact_.newton = of_compression(-state_.v, start_.v);
  impact_.poisson = of_compression(state_.tau, tau_c);
  impact_.energetic = std::sqrt(std::max(0.0, of_compression(-work_restitution, work_compression_)));
  impact_.energetic_excess =
      of_compression(-(work_restitution + work_compression_), work_compression_) / (1.0 + impact_.energetic);
  impact_.tangential = of_compression(std::sqrt(f1 * f1 + f2 * f2), tau);
  const T error = estimate_ * scale_ * (tau + std::fabs(f1) + std::fabs(f2));
  impact_.energy_limit_broken = change > error;
  impact_.sharp_limit_broken = work_restitution + work_compression_ > error;
  EchoCoefficient();
}

// The coefficient asked for is the coefficient, to the last bit.
template <typename T>
void Solver<T>::EchoCoefficient() {
  if (impact_.regime == Regime::kLocked) return;
  switch (problem_.law) {
    case RestitutionLaw::kNewton:
      impact_.newton = problem_.coefficient;
      break;
    case RestitutionLaw::kPoisson:
      if (goal_.quantity == Quantity::kImpulse) impact_.poisson = problem_.coefficient;
      break;
    case RestitutionLaw::kEnergetic:
      impact_.energetic = problem_.coefficient;
      impact_.energetic_excess = problem_.coefficient - 1.0;
      impact_.sharp_limit_broken = problem_.coefficient > 1.0;
      break;
  }
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
