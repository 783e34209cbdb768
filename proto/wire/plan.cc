#include "proto/wire/plan.h"

#include <utility>
#include <vector>

#include "proto/wire/map.h"

namespace ricochet {

RICOCHET_MAP(PlannedEffect, effect, decision, size, reason);
RICOCHET_MAP(PlannedArithmetic, arithmetic, reason, rounding_error);

// The effects of a plan write their reasons only when they are listed.
static void ToProto(const PlannedEffects& effects, google::protobuf::RepeatedPtrField<v1::PlannedEffect>& proto) {
  ToProto(effects.List(), proto);
}
static void FromProto(const google::protobuf::RepeatedPtrField<v1::PlannedEffect>& proto, PlannedEffects& effects) {
  std::vector<PlannedEffect> list;
  FromProto(proto, list);
  effects = PlannedEffects(std::move(list));
}

RICOCHET_MAP(Plan, model, relative_tolerance, neglected, effects, arithmetic);

RICOCHET_CONVERT_IN_PLACE(Plan);

}  // namespace ricochet
