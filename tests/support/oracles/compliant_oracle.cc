#include "tests/support/oracles/compliant_oracle.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "absl/strings/str_format.h"

namespace ricochet::compliant {
namespace {

// The variable is s = t/h, counted from the beginning of a step.
using Polynomial = std::vector<Ball>;

Ball At(const Polynomial& p, const Ball& s) {
  Ball value(0.0);
  for (size_t k = p.size(); k-- > 0;) value = value * s + p[k];
  return value;
}

Polynomial SlopeOf(const Polynomial& p) {
  Polynomial slope;
  for (size_t k = 1; k < p.size(); ++k) slope.push_back(p[k] * Ball(static_cast<double>(k)));
  return slope;
}

Polynomial Sum(const Ball& x, const Polynomial& p, const Ball& y, const Polynomial& q) {
  Polynomial sum;
  for (size_t k = 0; k < p.size(); ++k) sum.push_back(x * p[k] + y * q[k]);
  return sum;
}

// Roots of one polynomial in [0, 1].
class FirstRoot {
 public:
  FirstRoot(Polynomial p, slong bits) : p_(std::move(p)), bits_(bits) {
    Ball size(0.0);
    for (const Ball& c : p_) size = size + Abs(c);
    const Ball least = Middle(size) * Ball::PowerOfTwo(-bits / 2);
    size_t zeros = 0;
    while (zeros < p_.size() && Middle(Abs(p_[zeros])) <= least) ++zeros;
    p_.erase(p_.begin(), p_.begin() + static_cast<std::ptrdiff_t>(zeros));
    slope_ = SlopeOf(p_);
  }

  // Returns where p, positive at first, turns negative.
  std::optional<Ball> Find() const {
    if (p_.empty()) return std::nullopt;
    if (p_[0] < Ball(0.0)) return Ball(0.0, bits_);
    return Between(Ball(0.0, bits_), Ball(1.0, bits_));
  }

 private:
  std::optional<Ball> Between(const Ball& low, const Ball& high) const {
    const Ball all = Union(low, high);
    if (At(p_, all) > Ball(0.0)) return std::nullopt;
    const bool ends_below = Middle(At(p_, high)) < Ball(0.0);
    if (!At(slope_, all).ContainsZero() || high - low < Ball::PowerOfTwo(-bits_ / 2)) {
      return ends_below ? std::optional<Ball>(Narrowed(low, high)) : std::nullopt;
    }
    const Ball half = Middle((low + high) * Ball(0.5));
    const std::optional<Ball> first = Between(low, half);
    return first.has_value() ? first : Between(half, high);
  }

  // Newton's method, kept between low and high by halving.
  Ball Narrowed(Ball low, Ball high) const {
    Ball s = Middle((low + high) * Ball(0.5));
    for (slong i = 0; i < 2 * bits_; ++i) {
      const Ball value = Middle(At(p_, s));
      (value > Ball(0.0) ? low : high) = s;
      const Ball slope = Middle(At(slope_, s));
      Ball next = slope.ContainsZero() ? low : Middle(s - value / slope);
      if (!(next > low && next < high)) next = Middle((low + high) * Ball(0.5));
      const bool settled = Abs(next - s) <= Ball::PowerOfTwo(8 - bits_) || high - low <= Ball::PowerOfTwo(8 - bits_);
      s = next;
      if (settled) return s;
    }
    return s;
  }

  Polynomial p_, slope_;
  slong bits_;
};

// The first event of a section; several coincide where the other events are that near.
struct Event {
  bool turns = false, stops = false, line_ends = false;
  int breaks_away = 0;
};

struct Motion {
  Polynomial u, v, n, p, tau, f;
};

class Simulation {
 public:
  Simulation(const Problem& problem, slong bits)
      : problem_(problem),
        bits_(bits),
        wtt_(problem.contact.w.tt, bits),
        wtn_(problem.contact.w.tn, bits),
        wnn_(problem.contact.w.nn, bits),
        mu_(problem.contact.mu, bits),
        r2_(problem.ratio_squared, bits),
        eta2_(Ball(problem.contact.coefficient, bits) * Ball(problem.contact.coefficient, bits)),
        u_(problem.contact.u0, bits),
        v_(problem.contact.v0, bits) {
    const Ball exact(1.0, Ball::kExact);
    const Ball square = exact * wtt_ * wnn_;
    rank_one_ = Abs(square - exact * wtn_ * wtn_) <= exact * Ball(0x1p-50) * square;
    in_range_ = rank_one_ && problem.contact.w.tt > 0.0;
    if (in_range_) {
      wtt_ = Middle(wtn_ * wtn_ / wnn_);
      u_ = Middle(v_ * wtn_ / wnn_);
    }
    for (Ball* zero : {&n_, &p_, &tau_, &f_, &n_max_}) *zero = Ball(0.0, bits);
    side_ = problem.contact.u0 < 0.0 ||
                    (problem.contact.u0 == 0.0 && problem.contact.mu == 0.0 && problem.contact.w.tn < 0.0)
                ? -1
                : 1;
    Settle();
  }

  ExactImpact Run() {
    // Near rank one a path may last a million radians of its fastest oscillation.
    constexpr int kMostSteps = 1'000'000;
    Record();
    for (int i = 0; i < kMostSteps && !done_; ++i) Step();
    impact_.ends = done_;
    if (done_) Conclude();
    return impact_;
  }

 private:
  Ball Kn() const { return first_loading_ ? Ball(1.0, bits_) : Middle(Ball(1.0, bits_) / eta2_); }
  Ball B(int side) const { return Middle(wnn_ - side * mu_ * wtn_); }
  Ball A(int side) const { return Middle(side * wtn_ - mu_ * wtt_ + mu_ * r2_ * Kn() * B(side)); }

  // Returns -1, 0 or 1; a value that is a tiny part of its terms counts as 0.
  int SignOf(const Ball& x, const Ball& terms) const {
    if (Middle(Abs(x)) <= Middle(terms) * Ball::PowerOfTwo(-bits_ / 2)) return 0;
    return x > Ball(0.0) ? 1 : -1;
  }

  int SlipSign(int side) const {
    const Ball change = mu_ * r2_ * Kn() * v_;
    return SignOf(side * u_ + change, Abs(u_) + Abs(change));
  }

  int GrowthSign(int side) const {
    return SignOf(A(side), Abs(wtn_) + mu_ * wtt_ + mu_ * r2_ * Kn() * (wnn_ + mu_ * Abs(wtn_)));
  }

  // Lets the particle, which is on the edge of the cone at side_, stick unless it slides there.
  void Settle() {
    if (problem_.contact.mu == 0.0) return;
    const int slip = SlipSign(side_);
    if (slip > 0 || (slip == 0 && GrowthSign(side_) >= 0)) return;
    side_ = 0;
  }

  // Returns a step, a power of two, of at most one radian of the fastest oscillation.
  Ball StepLength() const {
    const Ball squared = side_ == 0 ? wtt_ / r2_ + Kn() * wnn_ : Kn() * (wnn_ + mu_ * Abs(wtn_));
    const slong exponent = squared.Exponent();
    return Ball::PowerOfTwo(exponent >= 0 ? -(exponent + 1) / 2 : -exponent / 2);
  }

  Motion Expand(const Ball& h) const {
    Motion m = {{u_}, {v_}, {n_}, {p_}, {tau_}, {f_}};
    const Ball friction = side_ * mu_;
    const Ball kn = Kn();
    const slong terms = bits_ / 4 + 8;
    for (slong k = 0; k < terms; ++k) {
      const auto i = static_cast<size_t>(k);
      const Ball step = h / Ball(static_cast<double>(k + 1), bits_);
      const Ball n = step * m.n[i];
      const Ball p = step * m.p[i];
      m.u.push_back(Middle(wtn_ * n - wtt_ * p));
      m.v.push_back(Middle(wnn_ * n - wtn_ * p));
      m.n.push_back(Middle(-(step * kn * m.v[i])));
      m.p.push_back(Middle(side_ == 0 ? step * m.u[i] / r2_ : friction * m.n.back()));
      m.tau.push_back(Middle(n));
      m.f.push_back(Middle(-p));
    }
    return m;
  }

  void Step() {
    const Motion m = Expand(StepLength());
    const Ball one(1.0, bits_), zero(0.0, bits_);
    std::vector<std::pair<Ball, Event>> events;
    const auto look = [&](const Polynomial& p, const Event& event) {
      const std::optional<Ball> root = FirstRoot(p, bits_).Find();
      if (root.has_value()) events.emplace_back(*root, event);
    };
    look(Sum(indenting_ ? -one : one, m.v, zero, m.v), {.turns = true});
    if (!indenting_) look(m.n, {.line_ends = true});
    if (indenting_ && !first_loading_) {
      Polynomial room = Sum(-one, m.n, zero, m.n);
      room[0] = room[0] + n_max_;
      look(room, {.line_ends = true});
    }
    if (side_ != 0) {
      look(Sum(Ball(side_), m.u, mu_ * r2_ * Kn(), m.v), {.stops = true});
    } else {
      for (const int side : {-1, 1}) look(Sum(mu_, m.n, Ball(-side), m.p), {.breaks_away = side});
    }
    if (events.empty()) return Move(m, one);
    Happen(m, events);
  }

  void Move(const Motion& m, const Ball& s) {
    u_ = Middle(At(m.u, s));
    v_ = Middle(At(m.v, s));
    n_ = Middle(At(m.n, s));
    p_ = Middle(At(m.p, s));
    tau_ = Middle(At(m.tau, s));
    f_ = Middle(At(m.f, s));
  }

  void Happen(const Motion& m, const std::vector<std::pair<Ball, Event>>& events) {
    Ball first(1.0, bits_);
    for (const auto& [s, event] : events) first = s < first ? s : first;
    Event all;
    for (const auto& [s, event] : events) {
      if (s - first > Ball::PowerOfTwo(-bits_ / 3)) continue;
      all.turns |= event.turns;
      all.stops |= event.stops;
      all.line_ends |= event.line_ends;
      if (event.breaks_away != 0) all.breaks_away = event.breaks_away;
    }
    Move(m, first);
    if (all.line_ends && !indenting_) {
      n_ = p_ = Ball(0.0, bits_);
      done_ = true;
      return;
    }
    GoOn(all);
  }

  void GoOn(const Event& event) {
    if (event.line_ends) {
      n_ = n_max_;
      first_loading_ = true;
    }
    if (event.turns) Turn();
    if (done_) return;
    if (event.breaks_away != 0) {
      side_ = event.breaks_away;
      p_ = Middle(side_ * mu_ * n_);
    } else if (event.stops) {
      StopSlip(event);
    }
    Record();
  }

  void StopSlip(const Event& event) {
    if (problem_.contact.mu == 0.0) {
      side_ = -side_;
      return;
    }
    // This uses the line before: a change of line keeps S where v = 0, and makes it positive where n = n_max.
    if (!event.line_ends) u_ = Middle(-(side_ * mu_ * r2_ * Kn() * v_));
    Settle();
  }

  void Turn() {
    v_ = Ball(0.0, bits_);
    if (in_range_) u_ = v_;
    indenting_ = !indenting_;
    if (!first_loading_) return;
    first_loading_ = false;
    n_max_ = n_;
    impact_.tau_compression = tau_;
    impact_.f_compression = f_;
    sticks_before_turn_ = sticks_;
    done_ = problem_.contact.coefficient == 0.0;
  }

  void Record() {
    sticks_ |= side_ == 0;
    impact_.sections.push_back({.friction = side_ == 0  ? FrictionState::kStick
                                            : side_ > 0 ? FrictionState::kSlideForward
                                                        : FrictionState::kSlideBackward,
                                .first_loading = first_loading_,
                                .indenting = indenting_,
                                .tau = tau_.Nearest(),
                                .f = f_.Nearest(),
                                .u = u_.Nearest(),
                                .v = v_.Nearest()});
  }

  Regime RegimeOf() const {
    if (problem_.contact.mu == 0.0) return Regime::kFrictionless;
    if (!sticks_) return Regime::kSliding;
    const Ball exact(1.0, Ball::kExact);
    const bool stays = in_range_ ? exact * mu_ * Abs(wtn_) >= wnn_ : exact * mu_ * wtt_ >= Abs(wtn_);
    if (sticks_before_turn_) return stays ? Regime::kStickInCompression : Regime::kReversalInCompression;
    return stays ? Regime::kStickInRestitution : Regime::kReversalInRestitution;
  }

  void Conclude() {
    impact_.regime = RegimeOf();
    impact_.u1 = u_;
    impact_.v1 = v_;
    impact_.tau1 = tau_;
    impact_.f1 = f_;
    const Ball half(0.5);
    impact_.work_normal_compression = -(half * n_max_ * n_max_);
    impact_.work_normal_restitution = half * eta2_ * n_max_ * n_max_;
    impact_.work_normal = impact_.work_normal_compression + impact_.work_normal_restitution;
    const Ball u0 = in_range_ ? Ball(problem_.contact.v0) * wtn_ / wnn_ : Ball(problem_.contact.u0, bits_);
    impact_.energy_change = half * (f_ * (u0 + u_) + tau_ * (Ball(problem_.contact.v0, bits_) + v_));
    impact_.spring_energy = half * r2_ * p_ * p_;
    impact_.friction_dissipation = impact_.work_normal - impact_.energy_change - impact_.spring_energy;
  }

  Problem problem_;
  slong bits_;
  Ball wtt_, wtn_, wnn_, mu_, r2_, eta2_;
  bool rank_one_ = false, in_range_ = false;

  Ball u_, v_, n_, p_, tau_, f_, n_max_;
  int side_ = 0;  // 0: sticks.
  bool first_loading_ = true, indenting_ = true;
  bool sticks_ = false, sticks_before_turn_ = false;
  bool done_ = false;
  ExactImpact impact_;
};

}  // namespace

ExactImpact SolveExactly(const Problem& problem, slong bits) { return Simulation(problem, bits).Run(); }

double VelocityError(const Problem& problem, double u1, double v1, const ExactImpact& exact) {
  if (!std::isfinite(u1) || !std::isfinite(v1)) return std::nan("");
  const Ball speed(std::max(std::fabs(problem.contact.u0), std::fabs(problem.contact.v0)), 192);
  const Ball u = Abs(Ball(u1, 192) - exact.u1) / speed;
  const Ball v = Abs(Ball(v1, 192) - exact.v1) / speed;
  return std::max(u.UpperBound(), v.UpperBound());
}

std::string ToString(const Problem& p) {
  return absl::StrFormat(
      "{.contact = {.w = {%a, %a, %a}, .u0 = %a, .v0 = %a, .mu = %a, .coefficient = %a}, .ratio_squared = %a}",
      p.contact.w.tt, p.contact.w.tn, p.contact.w.nn, p.contact.u0, p.contact.v0, p.contact.mu, p.contact.coefficient,
      p.ratio_squared);
}

}  // namespace ricochet::compliant
