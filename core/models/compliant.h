// Compliant: an impact in a plane whose contact gives way along the surface as well as into it.
//
// A massless particle between the body and the rough surface, held to the body by two springs (Stronge's lumped
// contact); W = [Wtt, Wtn; Wtn, Wnn] and (u0, v0), v0 < 0, as in core/models/planar.h. d is the indentation, d' = -v.
//
//   normal       first loading N = k d; from the largest indentation so far, d_max, both ways
//                N = k d_max - (k/eta^2)(d_max - d), until d passes d_max again or N = 0, the end
//   tangential   stiffness k/ratio^2; |F| <= mu N on the particle, which sticks (its speed is 0) or slides
//
// The net normal work that is not first loading's is -eta^2 times that of first loading, for any W: the energetic
// coefficient is met exactly. k drops out of impulses and velocities and is not asked for.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_H_

#include <cstdint>
#include <vector>

#include "core/outcome.h"

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

// What the particle does.
enum class Mode { kStick, kSlideForward, kSlideBackward };

// A stretch of one mode on one line of the normal spring.
struct Section {
  Mode mode = Mode::kStick;
  bool first_loading = true;                    // Else the line of unloading.
  double tau = 0.0, f = 0.0, u = 0.0, v = 0.0;  // Where it starts.
};

struct Impact {
  Regime regime = Regime::kUnspecified;
  int w_rank = 0;
  bool sharp_limit_broken = false;
  bool energy_limit_broken = false;
  double newton = 0.0, poisson = 0.0, energetic = 0.0;
  double tangential = 0.0;  // f1/tau1
  double energetic_excess = 0.0;
  double u1 = 0.0, v1 = 0.0;
  double tau_compression = 0.0, tau1 = 0.0;  // Compression ends at the last d = d_max.
  double f_compression = 0.0, f1 = 0.0;
  double work_normal_compression = 0.0, work_normal_restitution = 0.0;
  double work_tangential_compression = 0.0, work_tangential_restitution = 0.0;
  double energy_change = 0.0;
  double friction_dissipation = 0.0;  // >= 0
  double spring_energy = 0.0;         // Left in the tangential spring, and lost, >= 0.
  double error_estimate = 0.0;        // Of the velocities over max(|u0|, |v0|).
  std::vector<Section> sections;
};

Impact Solve(const Problem& problem);

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_H_
