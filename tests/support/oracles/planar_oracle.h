// Planar oracle: simulates the events of a planar impact in ball arithmetic, to test core/models/planar.
//
// A state (tau, f, u, v) is advanced by the naive formulas to the first of these events: slip stops, v vanishes,
// restitution ends. Precision grows with the spread of the inputs' exponents, so that a difference of these inputs is
// either 0 or larger than a ball: a ball that contains 0 is 0, and two balls that overlap are equal. No code is shared
// with core/.

#ifndef RICOCHET_TESTS_SUPPORT_ORACLES_PLANAR_ORACLE_H_
#define RICOCHET_TESTS_SUPPORT_ORACLES_PLANAR_ORACLE_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/models/planar/planar.h"
#include "tests/support/oracles/arb.h"

namespace ricochet::planar {

struct ExactInstant {
  EventKind kind = EventKind::kUnspecified;
  Ball tau, f, u, v;
};

struct ExactImpact {
  Regime regime = Regime::kUnspecified;
  int w_rank = 0;
  std::vector<ExactInstant> events;
  Ball tau_compression, f_compression;
  Ball work_normal_compression, work_normal_restitution;
  Ball work_tangential_compression, work_tangential_restitution;
  Ball newton, poisson, energetic;
  Ball energy_change;      // Sum of the works.
  Ball steepest_friction;  // Largest |df/dtau| of the path.
  Ball conditioning;       // The c of ErrorsOf.

  const ExactInstant& end() const { return events.back(); }
};

// The problem must not be separating.
ExactImpact SolveExactly(const Problem& problem);

// A contact that is no double, in place of that of a problem, and coefficients, in place of its own where they are set.
struct ExactContact {
  Ball wtt, wtn, wnn, u0, v0;
  std::optional<Ball> mu = {}, mu_static = {}, coefficient = {};
};
ExactImpact SolveExactly(const Problem& problem, const ExactContact& contact);

// The outputs whose errors are reported. The last four are the largest errors at an event after the start.
inline constexpr std::array kOutputNames = {
    "u1",
    "v1",
    "tau_compression",
    "tau1",
    "f_compression",
    "f1",
    "work_n_compression",
    "work_n_restitution",
    "work_t_compression",
    "work_t_restitution",
    "energy_change",
    "newton",
    "poisson",
    "energetic",
    "energetic_excess",
    "tangential",
    "tau of events",
    "f of events",
    "u of events",
    "v of events",
};
using OutputErrors = std::array<double, kOutputNames.size()>;

// The error of each output in ulp of the exact value, beyond 2^-94 c of its scale, with
// c = (Wtt Wnn/det W) (1 + mu |Wtn|/Wnn), and c = 1 at rank one. The scale is max(|u0|, |v0|) for velocities, tau1 for
// normal impulses, the largest |f'| tau1 for tangential ones, the largest work for works, 1 for coefficients of
// restitution, and the largest |f'| for the tangential coefficient; it is the value itself if that is larger.
OutputErrors ErrorsOf(const Problem& problem, const Impact& impact, const ExactImpact& exact);

// A problem as hexadecimal floats, to be pasted into a test.
std::string ToString(const Problem& problem);

}  // namespace ricochet::planar

namespace ricochet {

// Lets templates find it for a PlanarProblem, which all planar models share.
using planar::ToString;

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_ORACLES_PLANAR_ORACLE_H_
