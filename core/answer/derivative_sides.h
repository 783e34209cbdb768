// The two sides of a derivative, and how they make one.

#ifndef RICOCHET_CORE_ANSWER_DERIVATIVE_SIDES_H_
#define RICOCHET_CORE_ANSWER_DERIVATIVE_SIDES_H_

#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include "absl/strings/string_view.h"
#include "ricochet/derivatives.h"

namespace ricochet {

// The limit of a difference quotient from one side.
struct OneSided {
  std::optional<double> rate;
  const char* why_none = "";    // A clause that says why there is no rate; else empty.
  std::optional<double> error;  // An estimated rate has one.
};

// `agree` says that both rates exist and differ by no more than their errors. The paths and the error are left unset.
Derivative Join(const OneSided& below, const OneSided& above, bool agree, Threshold threshold);

// Returns a path without its last index.
inline absl::string_view HeadOf(absl::string_view path) { return path.substr(0, path.rfind('[')); }

// Returns the size to which the rounding of the outcome's number at `path` is relative, for a contact that moves at
// `speed` before the impact and takes the normal impulse `impulse`; 0 for a number of another kind.
double ScaleOf(std::string_view path, double speed, double impulse);

// Returns the same for the velocity of the system at `place` of Reduction::before.
template <typename Reduction>
double VelocityScaleOf(const Reduction& reduction, size_t place, double impulse) {
  double response = 0.0;
  for (size_t i = 0; i < Reduction::kDirections; ++i) {
    response += std::fabs(reduction.response[place * Reduction::kDirections + i]);
  }
  return std::fabs(reduction.before[place]) + impulse * response;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_DERIVATIVE_SIDES_H_
