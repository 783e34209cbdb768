// FollowPath: the path of a compliant impact (core/models/compliant/compliant.h), section by section to its end.
//
// Units are chosen so that the stiffness of first loading is k = 1; |v0| and Wnn must be of everyday size.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_PATH_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_PATH_H_

#include <vector>

#include "core/models/compliant/spring_contact.h"
#include "ricochet/outcome.h"

namespace ricochet::compliant {

enum class FirstStick { kNever, kInCompression, kInRestitution };

// If the impact has no end, `end` is the state reached. If that overflows, its u and v are NaN.
struct PathResult {
  Termination termination = Termination::kRefused;
  ContactState end;
  ContactState compression_end;       // The last time that the indentation is the largest so far.
  double largest_normal_force = 0.0;  // N at `compression_end`.
  FirstStick first_stick = FirstStick::kNever;
  // Errors by rounding, infinite if nothing is known of them: of u and v at the end, and, at `compression_end`, of N
  // and of u where v = 0.
  double u_error = 0.0, v_error = 0.0;
  double compression_force_error = 0.0, compression_u_error = 0.0;
  int sections = 0;

  bool Ends() const { return termination == Termination::kConverged; }
};

// Appends to `sections` each section's start.
PathResult FollowPath(const SpringContact& contact, double u0, double v0, std::vector<Section>& sections);

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_PATH_H_
