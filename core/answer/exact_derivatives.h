// ExactDerivatives: the derivatives of planar rigid impacts, for scenes of one form.
//
// For each number of the scene the contact is differentiated along it (core/contact/contact_tangent.h) and the impact
// along that (core/models/planar/tangent.h), once for either side. Where the two sides agree, so do their bits but at a
// threshold, and the derivative is two-sided. A number that is 0 is replaced by +-2^-300 for its sides, which changes
// no digit of them and separates the cases that meet at 0. A side does not exist where the scene would break a rule,
// where the outcome jumps, or where it changes infinitely fast. The sides of all numbers go in SIMD lanes together.

#ifndef RICOCHET_CORE_ANSWER_EXACT_DERIVATIVES_H_
#define RICOCHET_CORE_ANSWER_EXACT_DERIVATIVES_H_

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/answer/derivative_sides.h"
#include "core/contact/contact_tangent.h"
#include "core/contact/scene_contact.h"
#include "core/models/planar/tangent.h"
#include "core/scene/field.h"
#include "ricochet/derivatives.h"
#include "ricochet/scene.h"

namespace ricochet {

class ExactDerivatives {
 public:
  // CheckDerivatives finds nothing wrong with `paths` for `form`, a valid scene of which WhyNotExact says nothing.
  ExactDerivatives(const Scene& form, const DerivativePaths& paths);

  // Computes the derivatives of a valid scene that differs from the form in its numbers only.
  void Compute(const Scene& scene);

  // The derivative of paths.of[of] by paths.by[by] at the last scene, without their names and its error.
  Derivative At(size_t of, size_t by) const;
  // The error of that derivative; set if W is so nearly singular that its rounding takes more than six digits.
  std::optional<double> ErrorOf(size_t of, size_t by) const;

 private:
  struct Side {
    bool exists = false;  // The scene keeps its rules on this side.
    double step = 0.0;    // The derivative by the number is that along the direction over this.
    ContactTangent contact_tangent;
    std::optional<SceneContact> own_contact;  // Unset where the contact is that of the scene itself.
    size_t impact = 0;                        // The place of its impact in impacts_.
  };
  // A number by which there are derivatives.
  struct Number {
    Number(const Scene& form, std::string path);
    Number(const Number&) = delete;
    Number& operator=(const Number&) = delete;

    std::string path;
    bool is_stated;  // False if the form leaves the number out.
    Scene scene;     // The scene beside the number, and the field that moves it.
    Field field;
    Scene direction;  // All numbers are 0 but those that follow the number.
    Field along;
    Side below, above;
  };

  // The tangents are those of the contact here.
  void SetSide(Number& number, const ContactTangents& tangents_here, double sign, Side& side);
  void AddImpact(const Number& number, const ContactTangents& tangents_here, Side& side);
  const SceneContact& ContactOf(const Side& side) const;
  const PlanarReduction& ReductionOf(const Side& side) const;
  bool StaysInDomain(const Side& side) const;
  bool LosesRank(const Side& side) const;
  double RateOf(const Side& side, size_t place) const;
  double SizeOf(size_t place) const;
  // Returns the larger rate of both sides; without `place` the largest of any number of the outcome, over its size.
  double LargestRate(const Number& number, size_t place) const;
  // True if the number at `place`, which is `value` on the side, has jumped from its value in the scene itself.
  bool Jumps(const Side& side, size_t place, double value, double rate) const;
  // True if the linear number at `place` is a small rest of large parts of the impulses that cancel.
  bool HidesInItsImpulse(const Side& side, size_t place, double value) const;
  double LargestRate(const Number& number) const;
  static bool IsMoved(const Side& side);
  OneSided LimitOf(const Side& side, size_t place) const;
  Threshold ThresholdOf(const Number& number) const;

  // The i-th entry is the place of paths.of[i] among the numbers of the impact, which the linear ones follow.
  std::vector<size_t> places_;
  std::deque<Number> numbers_;  // A deque leaves its elements where they are.
  // These belong to the last scene itself.
  std::optional<SceneContact> here_;
  std::array<double, kPlanarOutputCount> values_here_ = {};
  double speed_here_ = 0.0;
  bool has_end_ = true;
  std::vector<planar::Along> impacts_;
};

// Returns the derivatives of a scene as the form, with their names.
std::vector<Derivative> ExactDerivativesOf(const Scene& scene, const DerivativePaths& paths);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_EXACT_DERIVATIVES_H_
