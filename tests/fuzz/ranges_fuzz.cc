// Fuzzes enclosures: bytes are a v1::BoundsRequest, enclosed if that takes no more than some thousand boxes.
//
// Checked: the status; whatever scene one picks from the box, its bounds lie in the enclosure's outer ranges, within
// 2^-30 (more where W is nearly singular) of 1 and of their size for what the bounds of that scene are rounded by, a
// separating one's impulse alone; what is attained lies in the outer ranges too.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "core/answer/scene_enclosure.h"
#include "core/contact/delassus.h"
#include "core/contact/reduction.h"
#include "core/scene/field.h"
#include "core/scene/validate.h"
#include "proto/wire/requests.h"
#include "ricochet/error.h"
#include "ricochet/solver.h"
#include "tests/fuzz/fail.h"
#include "tests/fuzz/mutate_message.h"
#include "tests/fuzz/outcome_claims.h"
#include "tests/fuzz/path_texts.h"

namespace ricochet {
namespace {

constexpr size_t kMostRanges = 8;
constexpr int kMostLooks = 2'000;  // So often EncloseScene asks whether to stop before the answer is yes.

// `least`: what counts as a size at least.
void CheckRange(const Range& inner, const Range& outer, double slack, double least, const char* what) {
  if (inner.lower > inner.upper) return;
  const double size = std::max({std::fabs(inner.lower), std::fabs(inner.upper), least});
  const double moved = std::isinf(size) ? 0.0 : slack * size;
  if (inner.lower >= outer.lower - moved && inner.upper <= outer.upper + moved) return;
  Fail(absl::StrCat(what, ": [", inner.lower, ", ", inner.upper, "] is not in [", outer.lower, ", ", outer.upper, "]"));
}

void CheckInside(const CoefficientBounds& inner, const CoefficientBounds& outer, double slack) {
  CheckRange(inner.newton, outer.newton, slack, 1.0, "Newton's coefficient");
  CheckRange(inner.poisson, outer.poisson, slack, 1.0, "Poisson's coefficient");
  CheckRange(inner.energetic, outer.energetic, slack, 1.0, "the energetic coefficient");
  CheckRange(inner.tangential, outer.tangential, slack, 1.0, "the tangential coefficient");
  CheckRange(inner.normal_total_n_s, outer.normal_total_n_s, slack, 0.0, "the normal impulse");
}

// The scene at one place of the box: a quarter's multiple of each range, told by `place`'s digits.
Scene SceneAt(const BoundsRequest& request, size_t place) {
  Scene scene = request.scene;
  for (const FieldRange& range : request.ranges) {
    const double part = 0.25 * static_cast<double>(place % 5);
    place /= 5;
    const double value = range.low * (1.0 - part) + range.high * part;
    ResolveField(range.path, scene)->Set(std::clamp(value, range.low, range.high));
  }
  return scene;
}

// The bounds of one scene may be wrong by this, relative to their size: the rounding of W moves det W/(Wtt Wnn), which
// the contact divides by where it sticks, by some 2^-48. Infinite if rounding alone may have given bodies or a linkage
// a W of rank one, which a pendulum has and which a contact states.
double RoundingOf(const Scene& scene) {
  constexpr double kLeast = 0x1p-30;
  constexpr double kOfDeterminant = 0x1p-48;
  const AnyReduction reduction = Reduce(scene);
  const auto& [tt, tn, nn] = std::get<PlanarReduction>(reduction).w;
  const double determinant = PlanarDelassus{tt, tn, nn}.RelativeDeterminant();
  if (determinant > kOfDeterminant) return std::max(kLeast, kOfDeterminant / determinant);
  const bool is_stated =
      std::holds_alternative<Pendulum>(scene.system) || std::holds_alternative<PlanarContact>(scene.system);
  return is_stated ? kLeast : std::numeric_limits<double>::infinity();
}

void CheckScenes(const BoundsRequest& request, const Enclosure& enclosure) {
  size_t places = 1;
  for (size_t i = 0; i < request.ranges.size(); ++i) places *= 5;
  const size_t step = places / 37 + 1;
  for (size_t place = 0; place < places; place += step) {
    const Scene scene = SceneAt(request, place);
    if (!Validate(scene, RestitutionIs::kOptional).empty()) continue;
    const absl::StatusOr<BoundsResponse> response = LocalSolver().Bounds({.scene = scene, .ranges = {}});
    if (!response.ok()) continue;
    const CoefficientBounds& sharp = response->bounds.sharp;
    const double rounding = RoundingOf(scene);
    if (std::isinf(rounding)) continue;
    if (response->bounds.regime != Regime::kSeparating) CheckInside(sharp, enclosure.outer, rounding);
    CheckRange(sharp.normal_total_n_s, enclosure.outer.normal_total_n_s, rounding, 0.0, "the normal impulse");
  }
}

void Run(const v1::BoundsRequest& proto) {
  const BoundsRequest request = FromProto(proto);
  if (request.ranges.empty() || request.ranges.size() > kMostRanges) return;
  if (!Validate(request.scene, RestitutionIs::kOptional).empty()) return;
  if (!CheckRanges(request.scene, request.ranges).empty()) return;
  int looks = 0;
  const auto stopped = [&looks] { return ++looks > kMostLooks; };
  const absl::StatusOr<Enclosure> enclosure = EncloseScene(request.scene, request.ranges, Limits().max_boxes, stopped);
  if (absl::IsCancelled(enclosure.status())) return;
  CheckStatus(enclosure.status(), true);
  if (!enclosure.ok()) return;
  CheckInside(enclosure->attained, enclosure->outer, 0.0);
  CheckScenes(request, *enclosure);
}

}  // namespace

std::unique_ptr<google::protobuf::Message> NewInput() { return std::make_unique<v1::BoundsRequest>(); }
std::vector<std::string> InputTexts() { return FieldTexts(); }

}  // namespace ricochet

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ricochet::v1::BoundsRequest request;
  if (request.ParseFromArray(data, static_cast<int>(size))) ricochet::Run(request);
  return 0;
}
