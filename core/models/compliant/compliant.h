// Compliant: an impact in a plane whose contact gives way along the surface as well as into it.
//
// A massless particle between the body and the rough surface, held to the body by two springs (W. J. Stronge's lumped
// contact, Impact Mechanics, 2000, chapter 5); W = [Wtt, Wtn; Wtn, Wnn] and (u0, v0), v0 < 0, as in
// core/models/planar/planar.h. d is the indentation, d' = -v; F and N are the forces on the body:
//
//   (u, v)' = W (F, N)
//   normal       first loading N = k d; from the largest indentation so far, d_max, both ways
//                N = k d_max - (k/eta^2)(d_max - d), until d passes d_max again or N = 0, the end
//   tangential   stiffness k/ratio^2; |F| <= mu N on the particle, which sticks (its speed is 0) or slides
//
// kn = k on first loading, k/eta^2 on the line of unloading. While the particle slides towards s, F = -s mu N; its
// speed along s, S = s u + mu ratio^2 (kn/k) v, has the slope A in the normal impulse:
//
//   B = Wnn - s mu Wtn = dv/dtau,   A = s Wtn - mu Wtt + mu ratio^2 (kn/k) B
//
// Slip ends at S = 0 in a stick: it never turns round without. A stick ends at |F| = mu N, towards the side of the
// deflection. The impact starts in a stick if |u0| < mu ratio^2 |v0|. Where both are possible (S = 0 at |F| = mu N,
// also at the start and where the line changes) the particle slides if A >= 0 and sticks if A < 0. mu = 0: no
// tangential force. Friction can push the body back in: v changes its sign more than once only if mu |Wtn| > Wnn.
//
// The net normal work that is not first loading's is -eta^2 times that of first loading, for any W: the energetic
// coefficient is met exactly. k drops out of impulses and velocities and is not asked for. eta = 0: the impact ends at
// v = 0, and what the tangential spring holds is lost.
//
// Works: compression is what comes before the last d = d_max. All four add up to the change of energy, and the
// tangential two to -(friction_dissipation + spring_energy). A change of energy above 0 can only be rounding: it is 0.
//
// Regimes, the first that applies:
//   separating    v0 >= 0: nothing changes
//   wedged        the impact has no end, see below
//   frictionless  mu = 0
//   sliding       the particle never sticks
//   stick / reversal in compression   the particle first sticks before the last d = d_max
//   stick / reversal in restitution   it first sticks later
// of which stick: a rigid contact could stay stuck, |Wtn| <= mu Wtt, and reversal: not. So for ratio -> 0 the regimes
// become those of core/models/planar/planar.h. A particle that has stuck mostly slides again before the impact ends.
//
// At full rank the start is decided by the exact sign of S, down to 2^-104 of its terms. What comes later lies on the
// side of a threshold where inputs within 16 eps of those given lie.
//
// Wedged: where det W vanishes and mu |Wtn| >= Wnn, friction can hold the body against the surface for ever, or let it
// rattle. Known by proof (W of rank one, and what oscillation is left stays inside |F| <= mu N and below d_max; or slip
// without end against a force that only grows), or because kMaxSections sections have not been enough. The state
// reached is then reported: velocities, impulses, works; newton and poisson are 0, the error estimate is infinite. Near
// det W = 0 the number of sections grows like (det W)^(-1/2); where the particle sticks, like 1/ratio for any W; and
// with mu |Wtn| >= Wnn like 1/eta. Random everyday contacts have a few hundred at most. Below kLeastRatioSquared the
// budget, or a double's resolution of the oscillation along the surface, may be used up by an impact that does end.
//
// Rank one: |det W| <= 4 eps Wtt Wnn, as in core/models/planar/planar.h; Wtt is then Wtn^2/Wnn and u = v Wtn/Wnn. Wtt = 0
// (then Wtn = 0): u = u0, though the spring is strained and its force does work.
//
// Method: slides are algebra in the normal impulse and sticks two sinusoids in time, no step size: the -inl.h files.
// Accuracy: error_estimate, 1e-14 to 1e-12 for everyday contacts. It compares the impact with two more that are
// computed with relative errors of 2^-44, of random signs, put on the state and on the constants of each section, 256
// times of what rounding leaves there: so it grows as the path amplifies errors, near grazing events too. Half the
// least double is added, which the rounding of a subnormal velocity may take.
// mu, |u0|/|v0| and ratios of W's entries or ratio^2 beyond 1e100 either way may overflow: what is not finite then is
// not known, and where the path itself overflows u1 and v1 are NaN and the regime, wedged, means nothing.
// Same bits everywhere as long as Sin and Cos have them.
// Bad input: none gets here (core/scene/validate.h): IsAdmissible says which coefficients a contact can have.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_COMPLIANT_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_COMPLIANT_H_

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/models/impact_end.h"

namespace ricochet::compliant {

struct Problem {
  double wtt = 0.0;  // 1/kg, >= 0
  double wtn = 0.0;
  double wnn = 0.0;            // > 0
  double u0 = 0.0;             // m/s
  double v0 = 0.0;             // m/s; >= 0 is separating
  double mu = 0.0;             // >= 0; static friction is the same
  double energetic = 0.0;      // eta in [0, 1]; 0 needs mu |Wtn| < Wnn
  double ratio_squared = 0.0;  // Tangential over normal compliance, > 0
};

// Smaller coefficients of restitution are computed as 0, which no velocity can tell.
inline constexpr double kLeastEnergetic = 0x1p-200;

// False where eta = 0 has no simple limit: mu |Wtn| >= Wnn, and the contact chatters as eta -> 0. The sign is that of
// the exact difference.
inline bool IsAdmissible(double wtn, double wnn, double mu, double energetic) {
  return energetic >= kLeastEnergetic || std::fma(mu, std::fabs(wtn), -wnn) < 0.0;
}

// What the particle does.
enum class Mode { kStick, kSlideForward, kSlideBackward };

// A stretch of one mode, on one line of the normal spring, in one direction of v.
struct Section {
  Mode mode = Mode::kStick;
  bool first_loading = true;                    // Else the line of unloading.
  bool indenting = true;                        // v < 0; true on first loading.
  double tau = 0.0, f = 0.0, u = 0.0, v = 0.0;  // Where it starts.
};

// An impact that has not ended by then is wedged.
inline constexpr int kMaxSections = 100'000;

// At this one random everyday contacts have 73,000 sections at most.
inline constexpr double kLeastRatioSquared = 1e-9;

// No limit is ever broken. Compression ends at the last d = d_max. The change of energy is P . (v- + v+)/2, never
// through an inverse of W.
struct Impact : ImpactEnd<double> {
  double f_compression = 0.0;
  double work_normal = 0.0;           // What deformation takes, <= 0: to its own last digits for any eta.
  double friction_dissipation = 0.0;  // >= 0
  double spring_energy = 0.0;         // Left in the tangential spring, and lost, >= 0.
  double error_estimate = 0.0;        // Of the velocities over max(|u0|, |v0|).
  std::vector<Section> sections;      // Empty where separating.
};

Impact Solve(const Problem& problem);

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_COMPLIANT_H_
