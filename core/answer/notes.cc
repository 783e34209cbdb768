#include "core/answer/notes.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/numerics/decimal.h"
#include "core/scene/numbers.h"
#include "ricochet/number_path.h"
#include "ricochet/plan.h"

namespace ricochet {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

Note DurationLeftOut() {
  return {.kind = NoteKind::kDurationLeftOut,
          .path = "contact",
          .text =
              "The duration and the forces were left out, because velocities and impulses do not depend on them; "
              "--require finite-duration, or EFFECT_FINITE_DURATION in `required`, asks for them."};
}

// Three digits tell radians from degrees.
std::string InRadians(double degrees) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), degrees * (std::numbers::pi / 180.0),
                                 std::chars_format::general, 3);
  return std::string(text.data(), end.ptr);
}

// It is kept out of the function that looks at every angle.
[[gnu::noinline]] Note LargeAngle(const NumberPath& path, double value) {
  const std::string number = ShortestDecimal(value);
  return {.kind = NoteKind::kLargeAngle,
          .path = path.Text(),
          .text = absl::StrCat(path.Text(), " = ", number, " rad lies beyond a full turn; write ", number, "deg or ",
                               InRadians(value), " if it is meant in degrees.")};
}

}  // namespace

void AddNotes(const Scene& scene, const PlannedScene& planned, Outcome& outcome) {
  const Decision duration = planned.choice.decisions[static_cast<size_t>(Effect::kFiniteDuration)];
  if (duration == Decision::kNegligible) outcome.notes.push_back(DurationLeftOut());
  VisitNumbers(scene, [&outcome](const NumberPath& path, double value, NumberRule rule) {
    if (rule == NumberRule::kAngle && std::abs(value) > kFullTurn) outcome.notes.push_back(LargeAngle(path, value));
  });
}

}  // namespace ricochet
