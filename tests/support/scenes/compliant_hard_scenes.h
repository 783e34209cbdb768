// Impacts with tangential compliance close to where their paths fork or degenerate.
//
// A function that takes a problem changes it.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_COMPLIANT_HARD_SCENES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_COMPLIANT_HARD_SCENES_H_

#include <algorithm>
#include <cmath>

#include "core/models/compliant/compliant.h"
#include "tests/support/scenes/compliant_scenes.h"

namespace ricochet::compliant {

inline constexpr double kDistance = 1e-15;

// The factor is 1, or lies 1e-15 to either side of it.
inline double Nearly(SceneSource& source, double value) { return value * (1.0 + kDistance * (source.Below(3) - 1)); }

// Friction that cannot hold the body, and enough of it to matter.
inline Problem Everyday(SceneSource& source) {
  Problem problem = source.Everyday(0.1, 4.0);
  problem.contact.mu =
      source.Uniform(0.1, std::min(1.5, 0.9 * problem.contact.w.nn / (std::fabs(problem.contact.w.tn) + 1e-3)));
  if (problem.contact.u0 == 0.0) problem.contact.u0 = 0.5 * problem.contact.v0;
  return problem;
}

inline double SideOf(const Problem& problem) { return problem.contact.u0 < 0.0 ? -1.0 : 1.0; }

inline double B(const Problem& p) { return p.contact.w.nn - SideOf(p) * p.contact.mu * p.contact.w.tn; }

// The slope of u towards the side on which it slides, per normal impulse.
inline double SlipSlope(const Problem& p) { return SideOf(p) * p.contact.w.tn - p.contact.mu * p.contact.w.tt; }

inline void StartOnTheCone(SceneSource& source, Problem& p) {
  p.contact.u0 = Nearly(source, SideOf(p) * p.contact.mu * p.ratio_squared * -p.contact.v0);
}

inline void StartOnTheConeWithoutGrowth(SceneSource& source, Problem& p) {
  while (SlipSlope(p) >= 0.0) p = Everyday(source);
  p.ratio_squared = Nearly(source, -SlipSlope(p) / (p.contact.mu * B(p)));
  StartOnTheCone(source, p);
}

inline void CriticalFriction(SceneSource& source, Problem& p) {
  while (p.contact.mu * p.contact.mu * p.contact.w.tt > 0.9 * p.contact.w.nn) p = Everyday(source);
  p.contact.w.tn = Nearly(source, p.contact.mu * p.contact.w.tt * (source.Below(2) == 0 ? 1.0 : -1.0));
}

// The contact slips to the side on which friction pushes the body in as much as the spring pushes it out.
inline void NoLift(SceneSource& source, Problem& p) {
  p.contact.w.tn = std::copysign(source.Uniform(0.3, 0.9) * std::sqrt(p.contact.w.tt * p.contact.w.nn), p.contact.u0);
  p.contact.mu = Nearly(source, p.contact.w.nn / std::fabs(p.contact.w.tn));
}

inline void StopAtTheEndOfCompression(SceneSource& source, Problem& p) {
  while (SlipSlope(p) >= 0.0 || p.contact.mu * p.ratio_squared * B(p) >= -SlipSlope(p)) p = Everyday(source);
  p.contact.u0 = Nearly(source, SideOf(p) * SlipSlope(p) * p.contact.v0 / B(p));
}

inline void StopAtTheEndOfContact(SceneSource& source, Problem& p) {
  const auto slip_left = [](const Problem& at) {
    const double eta = at.contact.coefficient;
    return SlipSlope(at) * (1.0 + eta) / B(at) + at.contact.mu * at.ratio_squared / eta;
  };
  while (slip_left(p) >= -0.1) {
    p = Everyday(source);
    p.contact.coefficient = std::max(p.contact.coefficient, 0.3);
    p.ratio_squared *= 0.1;
  }
  p.contact.u0 = Nearly(source, SideOf(p) * slip_left(p) * p.contact.v0);
}

inline void EqualFrequencies(SceneSource& source, Problem& p) {
  p.ratio_squared = Nearly(source, p.contact.w.tt / p.contact.w.nn);
  p.contact.w.tn = (source.Below(2) == 0 ? -1.0 : 1.0) * source.LogUniform(1e-20, 1e-8) * p.contact.w.nn;
}

// Halving finds a double on both sides of which the modes differ.
inline Problem Fork(SceneSource& source) {
  const auto paths_differ = [](const Problem& a, const Problem& b) {
    const Impact x = Solve(a);
    const Impact y = Solve(b);
    return !std::equal(
        x.sections.begin(), x.sections.end(), y.sections.begin(), y.sections.end(),
        [](const Section& s, const Section& t) { return s.friction == t.friction && s.indenting == t.indenting; });
  };
  for (;;) {
    Problem low = Everyday(source);
    low.ratio_squared = source.Uniform(0.1, 1.0);
    Problem high = low;
    high.contact.mu *= 1.5;
    if (!paths_differ(low, high)) continue;
    for (;;) {
      Problem half = low;
      half.contact.mu = 0.5 * (low.contact.mu + high.contact.mu);
      if (half.contact.mu <= low.contact.mu || half.contact.mu >= high.contact.mu)
        return source.Below(2) == 0 ? low : high;
      (paths_differ(low, half) ? high : low) = half;
    }
  }
}

inline Problem Rod(SceneSource& source) {
  Problem p = source.RankOne();
  p.contact.mu = source.Uniform(0.1, 0.9 * p.contact.w.nn / (std::fabs(p.contact.w.tn) + 0.1 * p.contact.w.nn));
  const double scale = source.Uniform(0.5, 2.0);
  for (double* w : {&p.contact.w.tt, &p.contact.w.tn, &p.contact.w.nn}) *w *= scale;
  return p;
}

inline void NearlyARod(SceneSource& source, Problem& p) {
  const double cosine = std::sqrt(1.0 - source.LogUniform(1e-14, 1e-6));
  p.contact.w.tn = std::copysign(cosine * std::sqrt(p.contact.w.tt * p.contact.w.nn), p.contact.w.tn);
  p.contact.mu = source.Uniform(0.1, 0.9) * p.contact.w.nn / std::fabs(p.contact.w.tn);
}

// Friction pushes the body in as much as the spring out: it comes back along the slow oscillation alone.
inline void HeldForLong(SceneSource& source, Problem& p) {
  const double cosine = std::sqrt(1.0 - source.LogUniform(1e-4, 1e-3));
  p.contact.w.tn = std::copysign(cosine * std::sqrt(p.contact.w.tt * p.contact.w.nn), p.contact.u0);
  p.contact.mu = source.Uniform(1.1, 1.5) * p.contact.w.nn / std::fabs(p.contact.w.tn);
  p.contact.coefficient = std::max(p.contact.coefficient, 0.2);
}

// The heavy body of a pair adds a trillionth of W.
inline void UnequalMasses(SceneSource& source, Problem& p) {
  const double offset = source.Uniform(-1.0, 1.0);
  p.contact.w.tt += 1e-12 * (1.0 + offset * offset);
  p.contact.w.tn += 1e-12 * offset;
  p.contact.w.nn += 1e-12;
}

inline void UnequalMobilities(SceneSource& source, Problem& p) {
  p.contact.w.tt *= 1e12;
  p.contact.w.tn *= 1e6;
  p.contact.mu *= 1e-6;
  p.contact.u0 *= 1e6;
  p.ratio_squared = 1e9 * source.Uniform(0.5, 1.0);
}

// Lengths, masses and times are in units 1e250 times too large or too small, as far as products stay in the range.
inline void OtherUnits(SceneSource& source, Problem& p) {
  const double speeds = source.Below(2) == 0 ? 1e250 : 1e-250;
  const double masses = source.Below(2) == 0 ? 1e250 : 1e-250;
  for (double* speed : {&p.contact.u0, &p.contact.v0}) *speed *= speeds;
  for (double* w : {&p.contact.w.tt, &p.contact.w.tn, &p.contact.w.nn}) *w *= masses;
}

}  // namespace ricochet::compliant

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_COMPLIANT_HARD_SCENES_H_
