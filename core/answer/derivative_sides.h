// Says how the limits of a difference quotient from both sides make one derivative.

#ifndef RICOCHET_CORE_ANSWER_DERIVATIVE_SIDES_H_
#define RICOCHET_CORE_ANSWER_DERIVATIVE_SIDES_H_

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/strings/string_view.h"
#include "ricochet/derivatives.h"
#include "ricochet/scene.h"

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

// The numbers of a system that are linear in the impulse, `before` + `of_impulse` . (f, tau): its velocities, and then,
// of a mechanism, the momentum that each coordinate takes.
struct LinearNumber {
  double before = 0.0;
  const double* of_impulse = nullptr;
};
std::vector<std::string> LinearNumberPaths(const System& system);

// `rows` is a reduction, or the derivative of one.
template <size_t kDirections, typename Rows>
LinearNumber LinearNumberAt(size_t place, const Rows& rows) {
  const size_t velocities = rows.before.size();
  if (place < velocities) return {rows.before[place], &rows.response[kDirections * place]};
  return {0.0, &rows.momentum[kDirections * (place - velocities)]};
}

// Returns the size to which the rounding of the linear number at `place` is relative.
template <typename Reduction>
double LinearScaleOf(const Reduction& reduction, size_t place, double impulse) {
  const auto [before, of_impulse] = LinearNumberAt<Reduction::kDirections>(place, reduction);
  double sum = 0.0;
  for (size_t i = 0; i < Reduction::kDirections; ++i) sum += std::fabs(of_impulse[i]);
  return std::fabs(before) + impulse * sum;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_DERIVATIVE_SIDES_H_
