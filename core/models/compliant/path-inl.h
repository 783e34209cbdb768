// The path of a compliant impact (core/models/compliant/compliant.h) from event to event, in units of its own: k = 1, |v0| and
// Wnn of everyday size.
//
//   n = N, p = -F (so p is what the deflection makes of the tangential spring), kn the slope of the normal spring
//   v' = Wnn n - Wtn p,   u' = Wtn n - Wtt p,   n' = -kn v,   and while the particle sticks   p' = u/ratio^2
//
// Slide towards s: p = s mu n. With the normal impulse in place of time nothing but a square root is left, whatever
// the sign of B, so the cosine, the straight line and the cosh of time are one formula:
//   v = v0 + B dtau,   B = Wnn - s mu Wtn
//   S = S0 + A dtau,   A = s Wtn - mu Wtt + mu ratio^2 kn B,   S = s u + mu ratio^2 kn v, the particle's speed along s
//   n^2 = n0^2 - kn dtau (v0 + v)
//
// Stick: y = (ratio p, n/sqrt(kn)) has y'' = -K y, K = [Wtt/ratio^2, -c; -c, kn Wnn], c = Wtn sqrt(kn)/ratio, with
// det K = kn det W/ratio^2: two oscillations, K's eigenvectors. It ends where g = mu n - s p vanishes, s = 1 or -1; as
// g' = -S/ratio^2, a stick that began where slip stopped has g = g' = 0 there and g'' = -A n/ratio^2 > 0. It cannot end
// on that side while n cos(w_0 t) + n' sin(w_0 t)/w_0 > 0, with the fast frequency w_0 and n, n' of its start. For
// there p' = mu s n' too, so g''' = -A n'/ratio^2, and g'' + w_1^2 g, which is a multiple of the fast sinusoid, is that
// expression times -A/ratio^2 > 0: Polya's factors (core/models/compliant/vibration-inl.h) keep g/h rising from 0. No
// search in rounded numbers could tell, g grows as t^2. And so no chain of sections stays at one time.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_PATH_INL_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_PATH_INL_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "core/models/compliant/compliant.h"
#include "core/models/compliant/vibration-inl.h"
#include "core/numerics/products.h"

namespace ricochet::compliant::internal {

inline constexpr double kEps = 0x1p-52;

// A relative error put on purpose on whatever is computed: its sign at random, its size 0 or that given.
class Noise {
 public:
  Noise(uint64_t seed, double size) : bits_(seed), size_(size) {}

  double Next() {
    bits_ ^= bits_ << 13;
    bits_ ^= bits_ >> 7;
    bits_ ^= bits_ << 17;
    return (bits_ >> 63) == 0 ? size_ : -size_;
  }
  double On(double value) { return value + value * Next(); }

  // x + y, as wrong as rounding the terms can make it.
  double Sum(double x, double y) { return x + y + (std::fabs(x) + std::fabs(y)) * Next(); }

 private:
  uint64_t bits_;
  double size_;
};

// W, det W = 0 exactly if its rank is one; then u = v Wtn/Wnn all along, but where Wtt = 0.
struct Inertia {
  double wtt = 0.0, wtn = 0.0, wnn = 0.0;
  double det = 0.0;
  bool rank_one = false;
  bool in_range = false;  // Rank one, and u = v Wtn/Wnn.
};

inline Inertia MakeInertia(double wtt, double wtn, double wnn) {
  Inertia w = {.wtt = wtt, .wtn = wtn, .wnn = wnn, .det = DifferenceOfProducts(wtt, wnn, wtn, wtn)};
  w.rank_one = std::fabs(w.det) <= 4.0 * kEps * wtt * wnn;
  w.in_range = w.rank_one && wtt > 0.0;
  if (w.rank_one) w.det = 0.0;
  if (w.in_range) w.wtt = wtn / wnn * wtn;
  return w;
}

struct Body {
  double n = 0.0, p = 0.0;
  double u = 0.0, v = 0.0;
  double tau = 0.0, f = 0.0;
  double dissipation = 0.0;
};

// What ends a section; several may coincide.
struct Ending {
  bool turns = false;        // v = 0.
  bool stops = false;        // The particle.
  int breaks_away = 0;       // The particle, towards this side.
  bool passes_max = false;   // d = d_max on the way in.
  bool parts = false;        // N = 0.
  bool never_comes = false;  // The section has no end.
};

class Path {
 public:
  Path(const Inertia& w, const Problem& problem, Noise noise, std::vector<Section>* sections)
      : w_(w),
        mu_(problem.mu),
        r2_(problem.ratio_squared),
        eta_(problem.energetic < kLeastEnergetic ? 0.0 : problem.energetic),
        noise_(noise),
        sections_(sections) {
    at_.u = w.in_range ? problem.v0 * (w.wtn / w.wnn) : problem.u0;
    at_.v = problem.v0;
    Start();
  }

  // To the end; false if there is none, or if it overflows on the way: u and v are NaN then.
  bool Run() {
    for (int i = 0; i < kMaxSections; ++i) {
      Record();
      const Ending ending = IsHeld() ? Ending{.never_comes = true} : side_ == 0 ? Stick() : Slide();
      if (!std::isfinite(at_.n + at_.p + at_.u + at_.v + at_.tau + at_.f)) return !Overflow().never_comes;
      if (ending.never_comes) return false;
      if (ending.parts || !GoOn(ending)) return true;
    }
    return false;
  }

  const Body& at() const { return at_; }
  // At the last d = d_max so far; the state reached, while that is still to come.
  const Body& compression() const { return first_loading_ ? at_ : compression_; }
  double n_max() const { return first_loading_ ? at_.n : n_max_; }
  double spring_energy(const Body& body) const { return 0.5 * r2_ * body.p * body.p; }
  bool sticks() const { return sticks_; }
  bool sticks_in_compression() const { return sticks_ && (first_loading_ || first_stick_ < turns_at_max_); }

 private:
  // The slope of the normal spring, and its root.
  double Kn() const { return first_loading_ ? 1.0 : 1.0 / (eta_ * eta_); }
  double RootKn() const { return first_loading_ ? 1.0 : 1.0 / eta_; }

  double B(int side) const { return std::fma(-side * mu_, w_.wtn, w_.wnn); }

  // 0 where it is no more than what rounding makes of its terms.
  double A(int side) const {
    const double compliance = mu_ * r2_ * Kn();
    const double b = B(side);
    if (w_.in_range) {
      const double slope = side * w_.wtn / w_.wnn;
      const double sum = slope + compliance;
      return std::fabs(sum) <= 4.0 * kEps * compliance ? 0.0 : b * sum;
    }
    const double sum = side * w_.wtn - mu_ * w_.wtt + compliance * b;
    const double size = std::fabs(w_.wtn) + mu_ * w_.wtt + compliance * std::fabs(b);
    return std::fabs(sum) <= 4.0 * kEps * size ? 0.0 : sum;
  }

  // The particle's speed towards `side`, if it slides.
  double Speed(int side) const {
    const double compliance = mu_ * r2_ * Kn();
    if (w_.in_range) return at_.v * (side * w_.wtn / w_.wnn + compliance);
    return side * at_.u + compliance * at_.v;
  }

  void Start() {
    if (mu_ == 0.0) {
      const double direction = at_.u != 0.0 ? at_.u : w_.wtn;
      side_ = direction < 0.0 ? -1 : 1;
      return;
    }
    const int side = at_.u < 0.0 ? -1 : 1;
    const double speed = SpeedAtStart(side);
    if (speed > 0.0 || (speed == 0.0 && A(side) >= 0.0)) side_ = side;
  }

  // With its sign down to 2^-104 of mu ratio^2 |v0|: where the two cancel their difference is exact, and what rounding
  // took from the product of three is added.
  double SpeedAtStart(int side) const {
    if (w_.in_range) return Speed(side);
    const double compliance = mu_ * r2_;
    const double product = compliance * at_.v;
    const double lost = std::fma(compliance, at_.v, -product) + std::fma(mu_, r2_, -compliance) * at_.v;
    return (side * at_.u + product) + lost;
  }

  void Record() {
    if (side_ == 0 && !sticks_) {
      sticks_ = true;
      first_stick_ = turns_at_max_;
    }
    if (sections_ == nullptr) return;
    sections_->push_back({.mode = side_ == 0  ? Mode::kStick
                                  : side_ > 0 ? Mode::kSlideForward
                                              : Mode::kSlideBackward,
                          .first_loading = first_loading_,
                          .indenting = indenting_,
                          .tau = at_.tau,
                          .f = at_.f,
                          .u = at_.u,
                          .v = at_.v});
  }

  // Changes line, direction and mode. False: the impact ends here.
  bool GoOn(const Ending& ending) {
    const int side_before = side_;
    leaves_cone_ = 0;
    has_turned_ = ending.turns;
    if (ending.passes_max) first_loading_ = true;
    if (ending.turns && !Turn()) return false;
    if (ending.breaks_away != 0) {
      const int side = ending.breaks_away;
      // Slip that rounding alone has started stops at once.
      const bool grazes = Speed(side) <= 0.0 && A(side) < 0.0;
      side_ = grazes ? 0 : side;
      if (grazes) leaves_cone_ = side;
    }
    if (!ending.stops) return true;
    if (mu_ == 0.0) {
      side_ = -side_before;
    } else if (A(side_before) < 0.0 && !ending.passes_max) {  // On the gentler line S is above 0 again.
      side_ = 0;
      leaves_cone_ = side_before;
    }
    return true;
  }

  bool Turn() {
    at_.v = 0.0;
    if (w_.in_range) at_.u = 0.0;
    indenting_ = !indenting_;
    if (!first_loading_) return true;
    n_max_ = at_.n;
    ++turns_at_max_;
    compression_ = at_;
    first_loading_ = false;
    return eta_ > 0.0;
  }

  // -- Slide --

  // The least of the normal impulses still to come at which one of the section's events happens.
  Ending Slide() {
    const double b = B(side_) + noise_.Next() * (w_.wnn + mu_ * std::fabs(w_.wtn));
    const double error = noise_.Next() * (std::fabs(w_.wtn) + mu_ * w_.wtt);
    const double a = A(side_) + error;
    const double slip = std::max(0.0, Speed(side_) + noise_.Next() * std::fabs(at_.u));
    const double to_turn = (indenting_ ? b > 0.0 : b < 0.0) ? -at_.v / b : kNever;
    const double to_stop = a < 0.0 ? slip / -a : kNever;
    const double to_line_end = indenting_ ? ToMax(b) : ToParting(b);
    if (std::isnan(to_line_end) || !std::isfinite(a + b + slip)) return Overflow();
    const double step = noise_.On(std::min({to_turn, to_stop, to_line_end}));
    if (step == kNever) return {.never_comes = true};
    const double latest = step * (1.0 + 4.0 * kEps);
    Ending ending;
    ending.stops = to_stop <= latest;
    if (to_line_end <= step) {
      (indenting_ ? ending.passes_max : ending.parts) = true;
    } else {
      ending.turns = to_turn <= latest;
    }
    const double slip_after = ending.stops ? 0.0 : std::max(0.0, slip + a * step);
    at_.dissipation += 0.5 * mu_ * step * (slip + slip_after);
    AdvanceSlide(step, b, w_.wtn - side_ * (mu_ * w_.wtt - error), ending);
    return ending;
  }

  // Not an end that never comes, for nothing is known of it.
  Ending Overflow() {
    at_.u = at_.v = std::numeric_limits<double>::quiet_NaN();
    return {.never_comes = true};
  }

  // n = 0 on the way out; NaN if it overflows, as ToMax.
  double ToParting(double b) const {
    const double energy = at_.n * at_.n / Kn();
    const double square = std::fma(at_.v, at_.v, b * energy);
    if (energy == 0.0) return 0.0;
    if (!std::isfinite(square)) return std::numeric_limits<double>::quiet_NaN();
    return square < 0.0 ? kNever : energy / (at_.v + std::sqrt(square));
  }

  // n = n_max on the way in.
  double ToMax(double b) const {
    if (first_loading_) return kNever;
    const double energy = (n_max_ - at_.n) * (n_max_ + at_.n) / Kn();
    const double square = std::fma(at_.v, at_.v, -b * energy);
    if (energy <= 0.0) return 0.0;
    if (!std::isfinite(square)) return std::numeric_limits<double>::quiet_NaN();
    return square < 0.0 ? kNever : energy / (std::sqrt(square) - at_.v);
  }

  void AdvanceSlide(double step, double b, double u_slope, const Ending& ending) {
    const double kn = Kn();
    const double v = ending.turns ? 0.0 : noise_.Sum(at_.v, b * step);
    const double square = std::max(0.0, noise_.Sum(at_.n * at_.n, -kn * step * (at_.v + v)));
    at_.n = ending.parts ? 0.0 : ending.passes_max ? n_max_ : std::sqrt(square);
    at_.p = side_ * mu_ * at_.n;
    at_.tau += step;
    at_.f -= side_ * mu_ * step;
    if (w_.in_range) {
      at_.u = v * (w_.wtn / w_.wnn);
    } else if (ending.stops) {
      at_.u = -side_ * mu_ * r2_ * kn * v;
    } else {
      at_.u = noise_.Sum(at_.u, u_slope * step);
    }
    at_.v = v;
  }

  // -- Stick --

  // y = first (c, s) + second (-s, c), and the rates.
  struct Modes {
    Frequencies w;
    double c = 1.0, s = 0.0;
    std::array<double, 2> y = {}, rate = {};
  };

  Modes MakeModes() {
    const double r = std::sqrt(r2_);
    const double root = RootKn();
    Modes modes;
    FindEigenvectors(w_.wtt / r2_, -w_.wtn * root / r, Kn() * w_.wnn, modes);
    const double y1 = r * at_.p;
    const double y2 = at_.n / root;
    const double rate1 = at_.u / r;
    const double rate2 = -at_.v * root;
    modes.y = Turned(modes, y1, y2);
    modes.rate = Turned(modes, rate1, rate2);
    if (w_.in_range) modes.rate[1] = 0.0;
    modes.w.fast = noise_.On(modes.w.fast);
    modes.w.slow = std::min(noise_.On(modes.w.slow), modes.w.fast);
    return modes;
  }

  // The components along the eigenvectors.
  std::array<double, 2> Turned(const Modes& modes, double first, double second) {
    return {noise_.Sum(modes.c * first, modes.s * second), noise_.Sum(modes.c * second, -modes.s * first)};
  }

  void FindEigenvectors(double k11, double k12, double k22, Modes& modes) {
    const double half = 0.5 * noise_.Sum(k11, -k22);
    const double large = std::max(std::fabs(half), std::fabs(k12));
    const double small = std::min(std::fabs(half), std::fabs(k12));
    if (large > 0.0) {
      const double radius = large * std::sqrt(1.0 + small / large * (small / large));
      const double major = std::sqrt(0.5 * (1.0 + std::fabs(half) / radius));
      const double minor = 0.5 * k12 / radius / major;
      modes.c = half >= 0.0 ? major : minor;
      modes.s = half >= 0.0 ? minor : major;
      modes.w.fast = std::sqrt(0.5 * (k11 + k22) + radius);
    } else {
      modes.w.fast = std::sqrt(k11);
    }
    modes.w.slow = RootKn() * std::sqrt(w_.det / r2_) / modes.w.fast;
  }

  static Signal Sum(const Modes& modes, double first, double second) {
    return {.a = {first * modes.y[0], second * modes.y[1]}, .b = {first * modes.rate[0], second * modes.rate[1]}};
  }

  Signal NormalForce(const Modes& modes) const { return Sum(modes, RootKn() * modes.s, RootKn() * modes.c); }

  // mu n - side p.
  Signal Margin(const Modes& modes, int side) const {
    const double n = mu_ * RootKn();
    const double p = side / std::sqrt(r2_);
    return Sum(modes, n * modes.s - p * modes.c, n * modes.c + p * modes.s);
  }

  // v on the way out, -v on the way in.
  Signal Departure(const Modes& modes) const {
    const double sign = (indenting_ ? 1.0 : -1.0) / RootKn();
    const double first = sign * modes.s;
    const double second = sign * modes.c;
    const double fast2 = modes.w.fast * modes.w.fast;
    const double slow2 = modes.w.slow * modes.w.slow;
    return {.a = {first * modes.rate[0], second * modes.rate[1]},
            .b = {-first * fast2 * modes.y[0], -second * slow2 * modes.y[1]}};
  }

  // Rank one, and the one oscillation that there is stays inside the cone and below n_max for ever.
  bool IsHeld() {
    if (!w_.in_range || side_ != 0 || first_loading_ || !(mu_ * std::fabs(w_.wtn) >= w_.wnn)) return false;
    const Modes modes = MakeModes();
    const auto amplitude = [&modes](const Signal& signal) {
      const double sine = signal.b[0] / modes.w.fast;
      return std::sqrt(signal.a[0] * signal.a[0] + sine * sine);
    };
    const double rounding = 16.0 * kEps * n_max_;
    const Signal n = NormalForce(modes);
    if (!(n.a[1] + amplitude(n) <= n_max_ + rounding)) return false;
    for (const int side : {-1, 1}) {
      const Signal margin = Margin(modes, side);
      if (!(margin.a[1] - amplitude(margin) >= -mu_ * rounding)) return false;
    }
    return true;
  }

  Ending Stick() {
    const Modes modes = MakeModes();
    const int likelier = LikelierSide();
    const RootSearch departure(Departure(modes), modes.w);
    const std::array<RootSearch, 2> margins = {RootSearch(Margin(modes, likelier), modes.w),
                                               RootSearch(Margin(modes, -likelier), modes.w)};
    if (departure.overflows() || margins[0].overflows() || margins[1].overflows()) return Overflow();
    double t = departure.First({.at_zero = has_turned_}, kNever);
    if (std::isnan(t)) return {.never_comes = true};
    Ending ending = {.turns = t < kNever};
    for (const int side : {likelier, -likelier}) {
      const double root = margins[side == likelier ? 0 : 1].First(OutsetOf(side, modes.w), t);
      if (std::isnan(root)) return {.never_comes = true};
      if (root >= t) continue;
      t = root;
      ending = {.breaks_away = side};
    }
    if (t == kNever) return {.never_comes = true};
    if (indenting_ && !first_loading_) PassMax(modes, t, ending);
    AdvanceStick(modes, t, ending);
    // At the tip of a steep cone both sides break at once, as far as doubles can tell; p says which it is.
    if (ending.breaks_away * at_.p < 0.0) ending.breaks_away = -ending.breaks_away;
    // The tip of the cone.
    ending.parts = ending.breaks_away != 0 && !indenting_ && at_.n <= 8.0 * kEps * n_max_;
    if (ending.parts) at_.n = 0.0;
    return ending;
  }

  // From where a break away to `side` is possible. The impact starts at the tip of the cone.
  Outset OutsetOf(int side, const Frequencies& w) const {
    if (side != leaves_cone_) return {.at_zero = at_.n == 0.0};
    const double n_rate = -Kn() * at_.v;
    return {.time = (Angle(at_.n, n_rate / w.fast) + std::numbers::pi / 2.0) / w.fast};
  }

  // Where a stick is to break is searched for on this side first, the other one then only up to there.
  int LikelierSide() const {
    const double leaning = at_.p != 0.0 ? at_.p : at_.u != 0.0 ? at_.u : w_.wtn;
    return leaning < 0.0 ? -1 : 1;
  }

  // On the way in n rises to the event at `t`; if it passes n_max, that comes first.
  void PassMax(const Modes& modes, double& t, Ending& ending) const {
    const Signal n = NormalForce(modes);
    if (!(n.At(modes.w, t).f > n_max_)) return;
    t = RootBetween(0.0, t, 0.0, [&](double time) {
      const Value value = n.At(modes.w, time);
      return Value{.f = n_max_ - value.f, .slope = -value.slope};
    });
    ending = {.passes_max = true};
  }

  void AdvanceStick(const Modes& modes, double t, const Ending& ending) {
    const double r = std::sqrt(r2_);
    const double root = RootKn();
    const Phase phase = modes.w.At(t);
    std::array<double, 2> y = {}, rate = {}, integral = {};
    for (size_t i = 0; i < 2; ++i) {
      const double w = modes.w[i];
      y[i] = noise_.Sum(modes.y[i] * phase.c[i], modes.rate[i] * phase.s[i]);
      rate[i] = noise_.Sum(modes.rate[i] * phase.c[i], -w * w * modes.y[i] * phase.s[i]);
      integral[i] = modes.y[i] * phase.c_integral[i] + modes.rate[i] * phase.s_integral[i];
    }
    at_.n = ending.passes_max ? n_max_ : root * noise_.Sum(modes.s * y[0], modes.c * y[1]);
    at_.p = noise_.Sum(modes.c * y[0], -modes.s * y[1]) / r;
    if (ending.breaks_away != 0) PutOnCone(ending.breaks_away);
    at_.v = ending.turns ? 0.0 : -noise_.Sum(modes.s * rate[0], modes.c * rate[1]) / root;
    at_.u = w_.in_range ? at_.v * (w_.wtn / w_.wnn) : r * noise_.Sum(modes.c * rate[0], -modes.s * rate[1]);
    at_.tau += root * (modes.s * integral[0] + modes.c * integral[1]);
    at_.f -= (modes.c * integral[0] - modes.s * integral[1]) / r;
  }

  // |p| = mu n, by the one of the two that mu does not magnify the rounding of.
  void PutOnCone(int side) {
    if (mu_ > 1.0) {
      at_.n = std::fabs(at_.p) / mu_;
    } else {
      at_.p = side * mu_ * at_.n;
    }
  }

  Inertia w_;
  double mu_;
  double r2_;
  double eta_;
  Noise noise_;
  std::vector<Section>* sections_;

  Body at_;
  Body compression_;
  int side_ = 0;             // 0: sticks.
  int leaves_cone_ = 0;      // The side, if the stick begins with g = 0 there, S <= 0 and A < 0.
  bool has_turned_ = false;  // The section begins with v = 0 for that; else v = 0 is the turn still to come.
  bool first_loading_ = true;
  bool indenting_ = true;
  double n_max_ = 0.0;
  bool sticks_ = false;
  int turns_at_max_ = 0;
  int first_stick_ = 0;
};

}  // namespace ricochet::compliant::internal

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_PATH_INL_H_
