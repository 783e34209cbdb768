// PathError: how far rounding has taken a compliant path from the true one, to first order.
//
// The deviation (N, p, u, v) from the true path at equal time is a random vector: each section carries its covariance
// over by the section's own linear equations and adds the variances of what it rounds. Deviations pass an event as they
// are, because the forces are continuous there; only a spring that changes its stiffness under way turns them
// (docs/theory/compliant.md, "Accuracy"). Sizes are in units of 2^-53. What overflows is not finite.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_PATH_ERROR_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_PATH_ERROR_H_

#include <array>
#include <cstddef>

#include "core/models/compliant/normal_modes.h"
#include "core/models/compliant/section.h"

namespace ricochet::compliant {

// A deviation, or one column of a covariance.
struct Deviation {
  double normal_force = 0.0, spring_force = 0.0, u = 0.0, v = 0.0;
};

// The slopes of the velocities over the normal impulse, and of the particle's speed S.
struct SlideRates {
  double slip = 0.0;        // S >= 0
  double slip_slope = 0.0;  // A
  double v_slope = 0.0;     // B
  double u_slope = 0.0;
};

class PathError {
 public:
  // `contact` must outlive this. Nothing is in error at first touch.
  explicit PathError(const SpringContact& contact) : contact_(contact) {}

  // A slide from `before` to `after`, over the normal impulse `step`.
  void AddSlide(const SectionMode& mode, const SlideRates& rates, const ContactState& before, const ContactState& after,
                double step, const SectionEnd& end);
  // A stick from `before` to `after`, at the phase `phase` of its oscillations after `time`.
  void AddStick(const SectionMode& mode, const NormalModes& modes, const Phase& phase, double time,
                const ContactState& before, const ContactState& after, const SectionEnd& end);
  // Carries the deviations to the point where v = 0, because the true impact ends there, near `state`.
  void EndAtRest(const SectionMode& mode, const ContactState& state);

  // The sizes that the errors of u, v and N do not exceed; infinite if nothing is known of them.
  double OfU() const { return SafeSize(2); }
  double OfV() const { return SafeSize(3); }
  double OfNormalForce() const { return SafeSize(0); }
  // Sections so far.
  int sections() const { return sections_; }

 private:
  using Covariance = std::array<std::array<double, 4>, 4>;

  template <typename Map>
  void Transform(const Map& map);
  void AddVariances(const Deviation& errors);
  void EnterModes(const SectionMode& mode, const NormalModes& modes, const ContactState& before);
  void CarryModes(const NormalModes& modes, const Phase& phase, double time, const Oscillations& at_end);
  void LeaveModes(const SectionMode& mode, const NormalModes& modes, const Oscillations& at_end,
                  const ContactState& after, const SectionEnd& end);
  void LeaveSection(const SectionMode& mode, const ContactState& after, const SectionEnd& end);
  double Size(size_t i) const;
  double SafeSize(size_t i) const;

  const SpringContact& contact_;
  Covariance covariance_ = {};
  double variance_of_largest_ = 0.0;  // The variance of N at the largest indentation so far.
  int sections_ = 0;                  // So far.
  bool in_doubt_ = false;             // The true path may part where this one turns, or turn where this one parts.
};

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_PATH_ERROR_H_
