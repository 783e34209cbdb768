#include "core/models/compliant/path_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet::compliant {
namespace {

// Positions in a covariance.
constexpr size_t kNormalForce = 0, kSpringForce = 1, kU = 2, kV = 3;

// A velocity errs by no more than kSafety standard deviations, and kSafetyOfSection of one more for each section,
// because sections that repeat each other do not round independently.
constexpr double kSafety = 2.0;
constexpr double kSafetyOfSection = 0.02;
constexpr double kUnit = 0x1p-53;
// If a path misses an event by at most this many standard deviations, the true path may have the event.
constexpr double kDoubt = 8.0;

// SlideGrowth holds the factors by which the deviations of a slide grow: C and S, the solutions of x'' = -kn B x that
// begin as (1, 0) and (0, 1), and the integral of S over the normal impulse.
struct SlideGrowth {
  double c = 1.0, s = 0.0, s_integral = 0.0;
};

// The path itself follows the same equations, N' = C N - kn S v and v' = C v + B S N, so that both ends of it tell C
// and S.
SlideGrowth GrowthOf(double stiffness, double v_slope, const ContactState& before, const ContactState& after) {
  const double n2 = v_slope * before.normal_force * before.normal_force;
  const double v2 = stiffness * before.v * before.v;
  const double determinant = n2 + v2;
  SlideGrowth growth;
  if (std::fabs(determinant) > 0.1 * (std::fabs(n2) + v2)) {
    growth.c = (v_slope * before.normal_force * after.normal_force + stiffness * before.v * after.v) / determinant;
    growth.s = (before.normal_force * after.v - before.v * after.normal_force) / determinant;
  } else {
    // B < 0, and the path is one of two exponentials alone.
    const double shape = std::sqrt(stiffness / -v_slope);
    const auto rising = [shape](const ContactState& state) { return state.normal_force - shape * state.v; };
    const auto falling = [shape](const ContactState& state) { return state.normal_force + shape * state.v; };
    const bool rises = std::fabs(rising(before)) >= std::fabs(falling(before));
    const double factor = rises ? rising(after) / rising(before) : falling(before) / falling(after);
    growth.c = 0.5 * (factor + 1.0 / factor);
    growth.s = 0.5 * (factor - 1.0 / factor) / std::sqrt(stiffness * -v_slope);
  }
  growth.s_integral =
      growth.c > 0.0 ? growth.s * growth.s / (1.0 + growth.c) : (1.0 - growth.c) / (stiffness * v_slope);
  return growth;
}

double SumOfSizes(double x, double y) { return std::fabs(x) + std::fabs(y); }

}  // namespace

// Replaces the covariance C by L C L^T for the linear map L.
template <typename Map>
void PathError::Transform(const Map& map) {
  const auto apply = [&map](std::array<double, 4>& x) {
    const Deviation y = map(Deviation{x[kNormalForce], x[kSpringForce], x[kU], x[kV]});
    x = {y.normal_force, y.spring_force, y.u, y.v};
  };
  for (std::array<double, 4>& row : covariance_) apply(row);
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < i; ++j) std::swap(covariance_[i][j], covariance_[j][i]);
  }
  for (std::array<double, 4>& row : covariance_) apply(row);
}

void PathError::AddVariances(const Deviation& errors) {
  covariance_[kNormalForce][kNormalForce] += errors.normal_force * errors.normal_force;
  covariance_[kSpringForce][kSpringForce] += errors.spring_force * errors.spring_force;
  covariance_[kU][kU] += errors.u * errors.u;
  covariance_[kV][kV] += errors.v * errors.v;
}

double PathError::Size(size_t i) const { return std::sqrt(std::max(0.0, covariance_[i][i])); }

void PathError::AddSlide(const SectionMode& mode, const SlideRates& rates, const ContactState& before,
                         const ContactState& after, double step, const SectionEnd& end) {
  const double stiffness = contact_.NormalStiffness(mode.branch);
  const double compliance = contact_.mu * contact_.ratio_squared * stiffness;
  const double cone = mode.slip_side * contact_.mu;
  const SlideGrowth growth = GrowthOf(stiffness, rates.v_slope, before, after);
  Transform([&](const Deviation& x) {
    const double impulse = growth.s * x.normal_force - stiffness * growth.s_integral * x.v;
    const double normal_force = growth.c * x.normal_force - stiffness * growth.s * x.v;
    const double v = x.v + rates.v_slope * impulse;
    const double u = contact_.u_follows_v ? v * (contact_.wtn / contact_.wnn) : x.u + rates.u_slope * impulse;
    return Deviation{normal_force, cone * normal_force, u, v};
  });
  const double u_terms = (std::fabs(contact_.wtn) + contact_.mu * contact_.wtt) * step;
  const double v_terms = std::fabs(rates.v_slope) * step;
  Deviation rounding;
  rounding.v = std::fabs(after.v) + 3.0 * v_terms;
  rounding.u = std::fabs(after.u) + 3.0 * std::fabs(rates.u_slope) * step + u_terms;
  if (end.stops) rounding.u += 3.0 * (compliance * (std::fabs(after.v) + v_terms) + u_terms);
  const double squares = before.normal_force * before.normal_force +
                         5.0 * stiffness * step * std::fabs(before.v + after.v) +
                         after.normal_force * after.normal_force;
  if (after.normal_force > 0.0) {
    rounding.normal_force = std::min(0.5 * squares / after.normal_force, std::sqrt(squares / kUnit));
  }
  rounding.spring_force = std::fabs(cone) * rounding.normal_force;
  AddVariances(rounding);
  LeaveSection(mode, after, end);
}

void PathError::AddStick(const SectionMode& mode, const NormalModes& modes, const Phase& phase, double time,
                         const ContactState& before, const ContactState& after, const SectionEnd& end) {
  EnterModes(mode, modes, before);
  const Oscillations at_end = modes.At(phase);
  CarryModes(modes, phase, time, at_end);
  LeaveModes(mode, modes, at_end, after, end);
  LeaveSection(mode, after, end);
}

// From here to LeaveModes the covariance is that of (y_1, y_0, y_0', y_1'), in the places of (N, p, u, v).
void PathError::EnterModes(const SectionMode& mode, const NormalModes& modes, const ContactState& before) {
  const double ratio = std::sqrt(contact_.ratio_squared);
  const double root = contact_.RootOfStiffness(mode.branch);
  Transform([&](const Deviation& x) {
    const double p = ratio * x.spring_force, n = x.normal_force / root;
    const double u = x.u / ratio, v = -x.v * root;
    return Deviation{modes.c * n - modes.s * p, modes.c * p + modes.s * n, modes.c * u + modes.s * v,
                     contact_.u_follows_v ? 0.0 : modes.c * v - modes.s * u};
  });
  const double p = ratio * before.spring_force, n = before.normal_force / root;
  const double u = before.u / ratio, v = before.v * root;
  AddVariances({.normal_force = 2.0 * SumOfSizes(modes.c * n, modes.s * p),
                .spring_force = 2.0 * SumOfSizes(modes.c * p, modes.s * n),
                .u = 2.0 * SumOfSizes(modes.c * u, modes.s * v),
                .v = contact_.u_follows_v ? 0.0 : 2.0 * SumOfSizes(modes.c * v, modes.s * u)});
}

void PathError::CarryModes(const NormalModes& modes, const Phase& phase, double time, const Oscillations& at_end) {
  const double fast2 = modes.w.fast * modes.w.fast;
  const double slow2 = modes.w.slow * modes.w.slow;
  Transform([&](const Deviation& x) {
    return Deviation{phase.c[1] * x.normal_force + phase.s[1] * x.v, phase.c[0] * x.spring_force + phase.s[0] * x.u,
                     phase.c[0] * x.u - fast2 * phase.s[0] * x.spring_force,
                     phase.c[1] * x.v - slow2 * phase.s[1] * x.normal_force};
  });
  const auto& [y, rate] = at_end;
  std::array<double, 2> y_error, rate_error;
  for (size_t i = 0; i < 2; ++i) {
    const double w2 = i == 0 ? fast2 : slow2;
    // Each frequency has a relative error of a few units, and so has each phase.
    y_error[i] =
        2.5 * SumOfSizes(modes.y[i] * phase.c[i], modes.rate[i] * phase.s[i]) + 4.0 * time * std::fabs(rate[i]);
    rate_error[i] =
        2.5 * SumOfSizes(modes.rate[i] * phase.c[i], w2 * modes.y[i] * phase.s[i]) + 4.0 * time * w2 * std::fabs(y[i]);
  }
  // Rounding errors of the eigenvectors mix the two oscillations, the more the further their phases have come apart.
  const double apart = modes.w.fast - modes.w.slow;
  const double longest = apart * time <= 2.0 ? time : 2.0 / apart;
  const double mixing = 4.0 * std::fabs(modes.c * modes.s) * fast2 / (modes.w.fast + modes.w.slow) * longest;
  AddVariances({.normal_force = y_error[1] + mixing * std::fabs(y[0]),
                .spring_force = y_error[0] + mixing * std::fabs(y[1]),
                .u = rate_error[0] + mixing * std::fabs(rate[1]),
                .v = contact_.u_follows_v ? 0.0 : rate_error[1] + mixing * std::fabs(rate[0])});
}

void PathError::LeaveModes(const SectionMode& mode, const NormalModes& modes, const Oscillations& at_end,
                           const ContactState& after, const SectionEnd& end) {
  const double ratio = std::sqrt(contact_.ratio_squared);
  const double root = contact_.RootOfStiffness(mode.branch);
  const double cone = end.breaks_away * contact_.mu;
  Transform([&](const Deviation& x) {
    const double n = root * (modes.s * x.spring_force + modes.c * x.normal_force);
    const double p = (modes.c * x.spring_force - modes.s * x.normal_force) / ratio;
    const double v = -(modes.s * x.u + modes.c * x.v) / root;
    const double u = contact_.u_follows_v ? v * (contact_.wtn / contact_.wnn) : ratio * (modes.c * x.u - modes.s * x.v);
    return Deviation{n, end.breaks_away != 0 ? cone * n : p, u, v};
  });
  const auto& [y, rate] = at_end;
  Deviation rounding = {.normal_force = 2.5 * root * SumOfSizes(modes.s * y[0], modes.c * y[1]),
                        .spring_force = 2.5 * SumOfSizes(modes.c * y[0], modes.s * y[1]) / ratio,
                        .u = 2.5 * ratio * SumOfSizes(modes.c * rate[0], modes.s * rate[1]),
                        .v = 2.5 * SumOfSizes(modes.s * rate[0], modes.c * rate[1]) / root};
  // The time of an event is rounded. A number that was set to its value at the event had missed it by this much.
  if (end.turns) {
    rounding.v += std::fabs(modes.s * rate[0] + modes.c * rate[1]) / root / kUnit;
  } else if (end.passes_largest || contact_.mu > 1.0) {
    if (!end.passes_largest) rounding.normal_force = rounding.spring_force / contact_.mu;  // N is |p|/mu.
    rounding.normal_force += std::fabs(root * (modes.s * y[0] + modes.c * y[1]) - after.normal_force) / kUnit;
  }
  AddVariances(rounding);
}

void PathError::LeaveSection(const SectionMode& mode, const ContactState& after, const SectionEnd& end) {
  ++sections_;
  const bool hardly_parts = end.parts && after.v <= kDoubt * kUnit * Size(kV);
  const bool hardly_turns = end.turns && !mode.indenting && after.normal_force <= kDoubt * kUnit * Size(kNormalForce);
  in_doubt_ = in_doubt_ || hardly_parts || hardly_turns;
  if (end.turns && mode.IsFirstLoading()) variance_of_largest_ = covariance_[kNormalForce][kNormalForce];
  if (end.passes_largest) {
    // N' jumps from -v/eta^2 to -v there.
    const double share = contact_.eta * contact_.eta;
    Transform([share](Deviation x) {
      x.normal_force *= share;
      return x;
    });
    covariance_[kNormalForce][kNormalForce] += (1.0 - share) * (1.0 - share) * variance_of_largest_;
  }
}

void PathError::EndAtRest(const SectionMode& mode, const ContactState& state) {
  const double cone = mode.Sticks() ? state.spring_force : mode.slip_side * contact_.mu * state.normal_force;
  const double u_rate = contact_.wtn * state.normal_force - contact_.wtt * cone;
  const double v_rate = contact_.wnn * state.normal_force - contact_.wtn * cone;
  Transform([&](Deviation x) {
    x.u -= u_rate / v_rate * x.v;
    x.v = 0.0;
    return x;
  });
}

double PathError::SafeSize(size_t i) const {
  if (in_doubt_) return std::numeric_limits<double>::infinity();
  const double safety = kSafety + kSafetyOfSection * sections_;
  const double size = kUnit * safety * Size(i);
  return std::isfinite(size) ? size : std::numeric_limits<double>::infinity();
}

}  // namespace ricochet::compliant
