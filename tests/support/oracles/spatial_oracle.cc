#include "tests/support/oracles/spatial_oracle.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"

namespace ricochet::spatial {
namespace {

constexpr slong kBits = 256;
constexpr size_t kOrder = 36;
constexpr int kMostSteps = 400;

Ball Of(double x) { return Ball(x, kBits); }

using Series = std::vector<Ball>;

Ball At(const Series& series, const Ball& x) {
  Ball sum = Of(0.0);
  for (size_t k = series.size(); k-- > 0;) sum = Middle(sum * x + series[k]);
  return sum;
}

Ball SlopeAt(const Series& series, const Ball& x) {
  Ball sum = Of(0.0);
  for (size_t k = series.size(); k-- > 1;) sum = Middle(sum * x + series[k] * static_cast<double>(k));
  return sum;
}

// The coefficient k of a product.
Ball Product(const Series& x, const Series& y, size_t k) {
  Ball sum = Of(0.0);
  for (size_t i = 0; i <= k; ++i) sum = sum + x[i] * y[k - i];
  return Middle(sum);
}

// All quantities of the path. Impulses and works count from the start of the phase.
enum Quantity { kU1, kU2, kV, kTau, kF1, kF2, kNormalWork, kFrictionWork, kQuantities };
using State = std::array<Ball, kQuantities>;

class Path {
 public:
  Path(const Problem& p, const ExactContact& contact)
      : mu_(Of(p.mu)),
        w11_(contact.w[0]),
        w12_(contact.w[1]),
        w13_(contact.w[2]),
        w22_(contact.w[3]),
        w23_(contact.w[4]),
        w33_(contact.w[5]) {
    state_ = {contact.u0[0], contact.u0[1], contact.v0, Of(0.0), Of(0.0), Of(0.0), Of(0.0), Of(0.0)};
  }

  // Follows the path until the quantity, which grows on the last step, reaches the target.
  bool RunTo(Quantity quantity, const Ball& target) {
    for (int i = 0; i < kMostSteps; ++i) {
      Expand();
      const Ball end = Longest();
      if (At(series_[quantity], end) >= target) {
        MoveTo(Root(quantity, target, end));
        return true;
      }
      MoveTo(end);
    }
    return false;
  }

  State state_;

 private:
  void Expand() {
    for (auto& series : series_) series.assign(1, Of(0.0));
    for (int q = 0; q < kQuantities; ++q) series_[static_cast<size_t>(q)][0] = state_[static_cast<size_t>(q)];
    Series& u1 = series_[kU1];
    Series& u2 = series_[kU2];
    Series& v = series_[kV];
    Series s = {Middle(Sqrt(u1[0] * u1[0] + u2[0] * u2[0]))};
    for (size_t k = 0; k < kOrder; ++k) {
      const Ball next = Of(1.0) / Of(static_cast<double>(k + 1));
      const auto add = [&](Series& series, const Ball& slope) { series.push_back(Middle(slope * next)); };
      const Ball square = Product(s, s, k);
      const Ball normal = Product(v, s, k);
      const Ball slip1 = u1[k];
      const Ball slip2 = u2[k];
      add(series_[kTau], s[k]);
      add(series_[kF1], -(mu_ * slip1));
      add(series_[kF2], -(mu_ * slip2));
      add(series_[kNormalWork], normal);
      add(series_[kFrictionWork], -(mu_ * square));
      add(u1, w13_ * s[k] - mu_ * (w11_ * slip1 + w12_ * slip2));
      add(u2, w23_ * s[k] - mu_ * (w12_ * slip1 + w22_ * slip2));
      add(v, w33_ * s[k] - mu_ * (w13_ * slip1 + w23_ * slip2));
      // 2 s_0 s_(k+1) = (u.u)_(k+1) - the products of the s between.
      Ball rest = Product(u1, u1, k + 1) + Product(u2, u2, k + 1);
      for (size_t i = 1; i <= k; ++i) rest = rest - s[i] * s[k + 1 - i];
      s.push_back(Middle(rest / (2.0 * s[0])));
    }
  }

  // An xi at which the last terms of slip are below 2^-170 of it, less a margin.
  Ball Longest() const {
    double exponent = 1e9;
    const auto slip = static_cast<double>(std::max(series_[kU1][0].Exponent(), series_[kU2][0].Exponent()));
    for (const size_t k : {kOrder - 1, kOrder}) {
      for (const Quantity quantity : {kU1, kU2}) {
        const Ball& term = series_[quantity][k];
        if (term.ContainsZero()) continue;
        exponent = std::min(exponent, (slip - 172.0 - static_cast<double>(term.Exponent())) / static_cast<double>(k));
      }
    }
    return Ball::PowerOfTwo(static_cast<slong>(std::floor(std::min(exponent, 4.0))));
  }

  Ball Root(Quantity quantity, const Ball& target, const Ball& end) const {
    const Series& series = series_[quantity];
    Ball low = Of(0.0);
    Ball high = Of(0.0) + end;
    Ball x = high;
    for (int i = 0; i < 2200; ++i) {
      const Ball value = Middle(At(series, x) - target);
      (value >= Of(0.0) ? high : low) = x;
      const Ball slope = SlopeAt(series, x);
      Ball next = slope.ContainsZero() ? low : Middle(x - value / slope);
      if (!(next > low) || !(next < high)) next = Middle((low + high) * 0.5);
      const Ball change = Abs(Middle(next - x));
      x = next;
      if (change.ContainsZero() || change.Exponent() < x.Exponent() - 230) break;
    }
    return x;
  }

  void MoveTo(const Ball& xi) {
    for (int q = 0; q < kQuantities; ++q) {
      state_[static_cast<size_t>(q)] = At(series_[static_cast<size_t>(q)], xi);
    }
  }

  Ball mu_, w11_, w12_, w13_, w22_, w23_, w33_;
  std::array<Series, kQuantities> series_;
};

}  // namespace

std::optional<ExactImpact> SolveExactly(const Problem& problem) {
  return SolveExactly(problem, {.w = {Of(problem.w11), Of(problem.w12), Of(problem.w13), Of(problem.w22),
                                      Of(problem.w23), Of(problem.w33)},
                                .u0 = {Of(problem.u0[0]), Of(problem.u0[1])},
                                .v0 = Of(problem.v0)});
}

std::optional<ExactImpact> SolveExactly(const Problem& problem, const ExactContact& contact) {
  Path path(problem, contact);
  if (!path.RunTo(kV, Of(0.0))) return std::nullopt;
  const State compression = path.state_;
  for (const Quantity q : {kTau, kF1, kF2, kNormalWork, kFrictionWork}) path.state_[q] = Of(0.0);
  const Ball coefficient = Of(problem.coefficient);
  if (problem.coefficient > 0.0) {
    bool ends = false;
    switch (problem.law) {
      case RestitutionLaw::kNewton:
        ends = path.RunTo(kV, -(coefficient * contact.v0));
        break;
      case RestitutionLaw::kPoisson:
        ends = path.RunTo(kTau, coefficient * compression[kTau]);
        break;
      case RestitutionLaw::kEnergetic:
        ends = path.RunTo(kNormalWork, -(coefficient * coefficient * compression[kNormalWork]));
        break;
    }
    if (!ends || !(path.state_[kV] > Of(0.0))) return std::nullopt;
  }
  const State& end = path.state_;
  ExactImpact exact;
  exact.u1 = {end[kU1], end[kU2]};
  // Where friction jams the contact, v grows so far beyond |v0| that the path ends below its own digits of v.
  const bool newton = problem.law == RestitutionLaw::kNewton;
  exact.v1 = newton ? -(coefficient * contact.v0) : problem.coefficient > 0.0 ? end[kV] : Of(0.0);
  exact.tau_compression = compression[kTau];
  exact.tau1 = compression[kTau] + end[kTau];
  exact.f1 = {compression[kF1] + end[kF1], compression[kF2] + end[kF2]};
  exact.work_normal_compression = compression[kNormalWork];
  exact.work_normal_restitution = end[kNormalWork];
  exact.work_tangential_compression = compression[kFrictionWork];
  exact.work_tangential_restitution = end[kFrictionWork];
  exact.energy_change = compression[kNormalWork] + end[kNormalWork] + compression[kFrictionWork] + end[kFrictionWork];
  exact.newton = -(exact.v1 / contact.v0);
  exact.poisson = end[kTau] / compression[kTau];
  exact.energetic = Sqrt(Abs(Middle(end[kNormalWork] / compression[kNormalWork])));
  if (problem.coefficient > 0.0) {
    Ball& stated = problem.law == RestitutionLaw::kNewton    ? exact.newton
                   : problem.law == RestitutionLaw::kPoisson ? exact.poisson
                                                             : exact.energetic;
    stated = coefficient;
  }
  exact.tangential = Sqrt(exact.f1[0] * exact.f1[0] + exact.f1[1] * exact.f1[1]) / exact.tau1;
  return exact;
}

std::string ToString(const Problem& p) {
  return absl::StrFormat("{%a, %a, %a, %a, %a, %a, {%a, %a}, %a, %a, %a, law %d, %a, tolerance %g}", p.w11, p.w12,
                         p.w13, p.w22, p.w23, p.w33, p.u0[0], p.u0[1], p.v0, p.mu, p.mu_static, static_cast<int>(p.law),
                         p.coefficient, p.tolerance);
}

}  // namespace ricochet::spatial
