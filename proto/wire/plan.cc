#include "proto/wire/plan.h"

#include <utility>
#include <vector>

#include "proto/wire/map.h"

namespace ricochet {

template <>
struct Map<PlannedEffect> : Between<PlannedEffect, v1::PlannedEffect> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(effect), RICOCHET_FIELD(decision), RICOCHET_FIELD(size), RICOCHET_FIELD(reason));
};

template <>
struct Map<PlannedArithmetic> : Between<PlannedArithmetic, v1::PlannedArithmetic> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(arithmetic), RICOCHET_FIELD(reason), RICOCHET_FIELD(rounding_error));
};

// The effects of a plan write their reasons only when they are listed.
static void ToProto(const PlannedEffects& effects, google::protobuf::RepeatedPtrField<v1::PlannedEffect>& proto) {
  ToProto(effects.List(), proto);
}
static void FromProto(const google::protobuf::RepeatedPtrField<v1::PlannedEffect>& proto, PlannedEffects& effects) {
  std::vector<PlannedEffect> list;
  FromProto(proto, list);
  effects = PlannedEffects(std::move(list));
}

template <>
struct Map<Plan> : Between<Plan, v1::Plan> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(model), RICOCHET_FIELD(relative_tolerance), RICOCHET_FIELD(neglected),
              RICOCHET_FIELD(effects), RICOCHET_FIELD(arithmetic));
};

void ToProto(const Plan& plan, v1::Plan& proto) { Map<Plan>::kFields.Write(plan, proto); }
void FromProto(const v1::Plan& proto, Plan& plan) { Map<Plan>::kFields.Read(proto, plan); }

}  // namespace ricochet
