#include "tests/hard_cases/naive_compliant.h"

#include <array>
#include <cmath>
#include <limits>

namespace ricochet::compliant {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct State {
  double u = 0.0, v = 0.0, n = 0.0, p = 0.0;
};

class Path {
 public:
  explicit Path(const Problem& problem) : pr_(problem), x_({.u = problem.contact.u0, .v = problem.contact.v0}) {
    side_ = x_.u < 0.0 ? -1 : 1;
    if (std::fabs(x_.u) < pr_.contact.mu * pr_.ratio_squared * std::fabs(x_.v)) side_ = 0;
  }

  NaiveImpact Run() {
    constexpr int kEnough = kMaxSections;
    for (int i = 0; i < kEnough && !done_ && !lost_; ++i) {
      sticks_ |= side_ == 0;
      Section();
    }
    if (!done_) x_.u = x_.v = kNaN;
    const double compression = -0.5 * n_max_ * n_max_;
    const double restitution = 0.5 * pr_.contact.coefficient * pr_.contact.coefficient * n_max_ * n_max_;
    return {.regime = RegimeOf(), .u1 = x_.u, .v1 = x_.v, .work_normal = compression + restitution};
  }

 private:
  double Kn() const { return first_loading_ ? 1.0 : 1.0 / (pr_.contact.coefficient * pr_.contact.coefficient); }

  State At(double t) const { return side_ == 0 ? Stuck(t) : Slid(t); }

  State Slid(double t) const {
    const double b = pr_.contact.w.nn - side_ * pr_.contact.mu * pr_.contact.w.tn;
    const double u_slope = pr_.contact.w.tn - side_ * pr_.contact.mu * pr_.contact.w.tt;
    const double w = std::sqrt(Kn() * std::fabs(b));
    State x;
    if (b == 0.0) {
      x.v = x_.v;
      x.n = x_.n - Kn() * x_.v * t;
      x.u = x_.u + u_slope * 0.5 * t * (x_.n + x.n);
    } else {
      const double c = b > 0.0 ? std::cos(w * t) : std::cosh(w * t);
      const double s = (b > 0.0 ? std::sin(w * t) : std::sinh(w * t)) / w;
      x.v = x_.v * c + b * x_.n * s;
      x.n = x_.n * c - Kn() * x_.v * s;
      x.u = x_.u + u_slope / b * (x.v - x_.v);
    }
    x.p = side_ * pr_.contact.mu * x.n;
    return x;
  }

  // y = (ratio p, n/sqrt(kn)), y'' = -K y.
  State Stuck(double t) const {
    const double r = std::sqrt(pr_.ratio_squared);
    const double k11 = pr_.contact.w.tt / pr_.ratio_squared;
    const double k12 = -pr_.contact.w.tn * std::sqrt(Kn()) / r;
    const double k22 = Kn() * pr_.contact.w.nn;
    const double root = std::sqrt((k11 - k22) * (k11 - k22) + 4.0 * k12 * k12);
    const std::array<double, 2> values = {0.5 * (k11 + k22 + root), 0.5 * (k11 + k22 - root)};
    double c = k12, s = values[0] - k11;
    if (k12 == 0.0) {
      c = k11 >= k22 ? 1.0 : 0.0;
      s = 1.0 - c;
    }
    const double size = std::sqrt(c * c + s * s);
    c /= size;
    s /= size;
    const std::array<double, 2> y = {r * x_.p, x_.n / std::sqrt(Kn())};
    const std::array<double, 2> rate = {x_.u / r, -x_.v * std::sqrt(Kn())};
    const std::array<double, 2> along = {c * y[0] + s * y[1], c * y[1] - s * y[0]};
    const std::array<double, 2> moving = {c * rate[0] + s * rate[1], c * rate[1] - s * rate[0]};
    std::array<double, 2> z = {}, dz = {};
    for (size_t i = 0; i < 2; ++i) {
      const double w = std::sqrt(values[i]);
      z[i] = along[i] * std::cos(w * t) + moving[i] / w * std::sin(w * t);
      dz[i] = moving[i] * std::cos(w * t) - w * along[i] * std::sin(w * t);
    }
    return {.u = r * (c * dz[0] - s * dz[1]),
            .v = -(s * dz[0] + c * dz[1]) / std::sqrt(Kn()),
            .n = std::sqrt(Kn()) * (s * z[0] + c * z[1]),
            .p = (c * z[0] - s * z[1]) / r};
  }

  // One of these turns negative at the section's end: v = 0, the line's end, slip or one side of the cone.
  std::array<double, 4> Margins(const State& x) const {
    const double turn = indenting_ ? -x.v : x.v;
    const double line = !indenting_ ? x.n : first_loading_ ? 1.0 : n_max_ - x.n;
    if (side_ == 0) return {turn, line, pr_.contact.mu * x.n - x.p, pr_.contact.mu * x.n + x.p};
    return {turn, line, pr_.contact.mu == 0.0 ? 1.0 : side_ * x.u + pr_.contact.mu * pr_.ratio_squared * Kn() * x.v,
            1.0};
  }

  static int Below(const std::array<double, 4>& margins) {
    for (size_t i = 0; i < margins.size(); ++i) {
      if (!(margins[i] >= 0.0)) return static_cast<int>(i);
    }
    return -1;
  }

  void Section() {
    const double fastest = std::sqrt(pr_.contact.w.tt / pr_.ratio_squared + Kn() * pr_.contact.w.nn +
                                     pr_.contact.mu * std::fabs(pr_.contact.w.tn) * Kn());
    const double step = 0.02 / fastest;
    constexpr int kMostSteps = 100'000;
    int event = -1;
    double high = 0.0;
    for (int i = 0; i < kMostSteps && event < 0; ++i) {
      high += step;
      event = Below(Margins(At(high)));
    }
    double low = high - step;
    for (int i = 0; i < 60; ++i) {
      const double half = 0.5 * (low + high);
      const int now = Below(Margins(At(half)));
      (now < 0 ? low : high) = half;
      if (now >= 0) event = now;
    }
    x_ = At(high);
    lost_ = event < 0 || std::isnan(x_.u + x_.v + x_.n + x_.p);
    if (!lost_) Happen(event);
  }

  void Happen(int event) {
    if (event == 0) return Turn();
    if (event == 1) {
      done_ = !indenting_;
      first_loading_ = true;
      return;
    }
    side_ = side_ != 0 ? 0 : event == 2 ? 1 : -1;
  }

  void Turn() {
    x_.v = 0.0;
    indenting_ = !indenting_;
    if (!first_loading_) return;
    first_loading_ = false;
    n_max_ = x_.n;
    sticks_before_turn_ = sticks_;
    done_ = pr_.contact.coefficient == 0.0;
  }

  Regime RegimeOf() const {
    if (!done_) return Regime::kUnspecified;
    if (pr_.contact.mu == 0.0) return Regime::kFrictionless;
    if (!sticks_) return Regime::kSliding;
    const bool stays = std::fabs(pr_.contact.w.tn) <= pr_.contact.mu * pr_.contact.w.tt;
    if (sticks_before_turn_) return stays ? Regime::kStickInCompression : Regime::kReversalInCompression;
    return stays ? Regime::kStickInRestitution : Regime::kReversalInRestitution;
  }

  Problem pr_;
  State x_;
  int side_ = 0;
  bool first_loading_ = true, indenting_ = true;
  bool sticks_ = false, sticks_before_turn_ = false;
  bool done_ = false, lost_ = false;
  double n_max_ = 0.0;
};

}  // namespace

NaiveImpact NaiveSolve(const Problem& problem) { return Path(problem).Run(); }

}  // namespace ricochet::compliant
