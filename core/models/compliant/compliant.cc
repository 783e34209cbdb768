#include "core/models/compliant/compliant.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/models/compliant/path-inl.h"

namespace ricochet::compliant {
namespace {

using internal::Body;
using internal::Inertia;
using internal::Noise;
using internal::Path;

// Powers of two that bring |v0| and Wnn to everyday size: v0 2^-speed, W 2^(-2 inertia). Then tau, in units of
// k = 1, is one of 2^(speed - 2 inertia).
struct Units {
  int speed = 0;
  int inertia = 0;

  double Speed(double value) const { return std::scalbn(value, speed); }
  double Impulse(double value) const { return std::scalbn(value, speed - 2 * inertia); }
  double Work(double value) const { return std::scalbn(value, 2 * (speed - inertia)); }
};

Units UnitsOf(const Problem& problem) {
  return {.speed = std::ilogb(problem.v0), .inertia = static_cast<int>(std::floor(0.5 * std::ilogb(problem.wnn)))};
}

Problem InUnits(const Problem& problem, const Units& units) {
  Problem scaled = problem;
  for (double* w : {&scaled.wtt, &scaled.wtn, &scaled.wnn}) *w = std::scalbn(*w, -2 * units.inertia);
  for (double* speed : {&scaled.u0, &scaled.v0}) *speed = std::scalbn(*speed, -units.speed);
  return scaled;
}

Regime RegimeOf(const Problem& problem, const Inertia& w, const Path& path, bool ends) {
  if (!ends) return Regime::kWedged;
  if (problem.mu == 0.0) return Regime::kFrictionless;
  if (!path.sticks()) return Regime::kSliding;
  // At rank one Wtt = Wtn^2/Wnn, not to be rounded on the way.
  const bool stays = w.in_range ? std::fma(problem.mu, std::fabs(w.wtn), -w.wnn) >= 0.0
                                : std::fma(problem.mu, w.wtt, -std::fabs(w.wtn)) >= 0.0;
  if (path.sticks_in_compression()) return stays ? Regime::kStickInCompression : Regime::kReversalInCompression;
  return stays ? Regime::kStickInRestitution : Regime::kReversalInRestitution;
}

// 2^-44 for the relative errors put on, see the header.
constexpr double kNoise = 0x1p-44;

double ErrorEstimate(const Problem& problem, const Units& units, const Inertia& w, const Path& path) {
  const double speed = std::max(std::fabs(problem.u0), std::fabs(problem.v0));
  const auto size = [](double u, double v) { return std::max(std::fabs(u), std::fabs(v)); };
  // In units of speed the least double is 2^-1074/2^units.speed, and half of it what rounding to it takes.
  const double rounding = std::scalbn(1.0, -1075 - units.speed);
  const double error = 16.0 * internal::kEps * std::max(speed, size(path.at().u, path.at().v)) + rounding;
  double spread = 0.0;
  for (const uint64_t seed : {0x9e3779b97f4a7c15U, 0xd1b54a32d192ed03U}) {
    Path noisy(w, problem, Noise(seed, kNoise), nullptr);
    if (!noisy.Run()) return std::numeric_limits<double>::infinity();
    spread = std::max(spread, size(noisy.at().u - path.at().u, noisy.at().v - path.at().v));
  }
  return (error + spread) / speed;
}

void WriteMotion(const Problem& problem, const Units& units, const Path& path, Impact& impact) {
  const Body& end = path.at();
  impact.u1 = units.Speed(end.u) + 0.0;
  impact.v1 = units.Speed(end.v) + 0.0;
  impact.tau_compression = units.Impulse(path.compression().tau);
  impact.tau1 = units.Impulse(end.tau);
  impact.f_compression = units.Impulse(path.compression().f) + 0.0;
  impact.f1 = units.Impulse(end.f) + 0.0;
  impact.tangential = end.f / end.tau + 0.0;
  impact.energetic_excess = -1.0;
  if (impact.regime == Regime::kWedged || problem.energetic == 0.0) return;
  impact.newton = -end.v / problem.v0;
  impact.poisson = (end.tau - path.compression().tau) / path.compression().tau;
  impact.energetic = problem.energetic;
  impact.energetic_excess = problem.energetic - 1.0;
}

void WriteWorks(const Problem& problem, const Units& units, const Path& path, Impact& impact) {
  const Body& rest = path.compression();
  const Body& end = path.at();
  const double eta2 = problem.energetic * problem.energetic;
  // What the line of unloading gives back between d_max and d; all of it at N = 0. At eta = 0 there is no line.
  const double top = path.n_max();
  const bool all = end.n == 0.0 || problem.energetic < kLeastEnergetic;
  const double left = all ? top * top : (top - end.n) * (top + end.n);
  const double spring = path.spring_energy(end);
  const double spring_at_rest = path.spring_energy(rest);
  impact.work_normal_compression = units.Work(-0.5 * top * top);
  impact.work_normal_restitution = units.Work(0.5 * eta2 * left);
  // Not the difference of the two, which hardly knows 1 - eta^2 for eta near 1.
  const double lost = (1.0 - problem.energetic) * (1.0 + problem.energetic);
  impact.work_normal =
      all ? units.Work(-0.5 * lost * left) : impact.work_normal_compression + impact.work_normal_restitution;
  impact.work_tangential_compression = units.Work(-(spring_at_rest + rest.dissipation)) + 0.0;
  impact.work_tangential_restitution =
      units.Work((spring_at_rest - spring) - (end.dissipation - rest.dissipation)) + 0.0;
  impact.friction_dissipation = units.Work(end.dissipation);
  impact.spring_energy = units.Work(spring);
  const double twice_change = std::fma(end.f, problem.u0 + end.u, end.tau * (problem.v0 + end.v));
  impact.energy_change = std::min(0.0, units.Work(0.5 * twice_change)) + 0.0;
}

Impact SolveSeparating(const Problem& problem) {
  const bool rank_one = internal::MakeInertia(problem.wtt, problem.wtn, problem.wnn).rank_one;
  return Separating<Impact>(rank_one ? 1 : 2, problem.u0, problem.v0);
}

}  // namespace

Impact Solve(const Problem& problem) {
  if (problem.v0 >= 0.0) return SolveSeparating(problem);
  const Units units = UnitsOf(problem);
  const Problem scaled = InUnits(problem, units);
  const Inertia w = internal::MakeInertia(scaled.wtt, scaled.wtn, scaled.wnn);
  Impact impact;
  Path path(w, scaled, Noise(1, 0.0), &impact.sections);
  const bool ends = path.Run();
  impact.regime = RegimeOf(scaled, w, path, ends);
  impact.w_rank = w.rank_one ? 1 : 2;
  WriteMotion(scaled, units, path, impact);
  WriteWorks(scaled, units, path, impact);
  impact.error_estimate = ends ? ErrorEstimate(scaled, units, w, path) : std::numeric_limits<double>::infinity();
  for (Section& section : impact.sections) {
    section.tau = units.Impulse(section.tau);
    section.f = units.Impulse(section.f);
    section.u = units.Speed(section.u);
    section.v = units.Speed(section.v);
  }
  return impact;
}

}  // namespace ricochet::compliant
