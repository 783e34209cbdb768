#include "core/engine/info.h"

#include <iterator>
#include <variant>

#include "core/certified/certified.h"
#include "ricochet/engine_info.h"
#include "ricochet/system.h"

namespace ricochet {
namespace {

// The names are in the order of System, whose first alternative stands for no system.
constexpr const char* kSystems[] = {"pendulum", "planar_body",    "spatial_body",    "body_pair",
                                    "linkage",  "planar_contact", "spatial_contact", "mechanism"};
static_assert(std::size(kSystems) + 1 == std::variant_size_v<System>);

}  // namespace

InfoResponse InfoOf(const Limits& limits) {
  InfoResponse info = {.engine = ThisEngine(),
                       .limits = limits,
                       .certified = certified::IsAvailable(),
                       .systems = {std::begin(kSystems), std::end(kSystems)}};
  for (int number = 1; number < kModelCount; ++number) {
    info.models.push_back(static_cast<Model>(number));
  }
  return info;
}

}  // namespace ricochet
