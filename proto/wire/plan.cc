#include "proto/wire/plan.h"

#include <utility>
#include <vector>

#include "proto/wire/map.h"

namespace ricochet {

template <>
struct Map<PlannedEffect> : Between<PlannedEffect, v1::PlannedEffect> {
  using Fields =
      Entries<Entry(&T::effect, &P::effect, &P::set_effect), Entry(&T::decision, &P::decision, &P::set_decision),
              Entry(&T::size, &P::size, &P::set_size), Entry(&T::reason, &P::reason, &P::mutable_reason)>;
};

template <>
struct Map<PlannedArithmetic> : Between<PlannedArithmetic, v1::PlannedArithmetic> {
  using Fields =
      Entries<Entry(&T::arithmetic, &P::arithmetic, &P::set_arithmetic), Entry(&T::reason, &P::reason, &P::set_reason),
              Entry(&T::rounding_error, &P::has_rounding_error, &P::rounding_error, &P::set_rounding_error)>;
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
  using Fields = Entries<Entry(&T::model, &P::model, &P::set_model),
                         Entry(&T::relative_tolerance, &P::relative_tolerance, &P::set_relative_tolerance),
                         Entry(&T::neglected, &P::neglected, &P::set_neglected),
                         Entry(&T::effects, &P::effects, &P::mutable_effects),
                         Entry(&T::arithmetic, &P::arithmetic, &P::mutable_arithmetic)>;
};

void ToProto(const Plan& plan, v1::Plan& proto) { Map<Plan>::Fields::Write(plan, proto); }
void FromProto(const v1::Plan& proto, Plan& plan) { Map<Plan>::Fields::Read(proto, plan); }

}  // namespace ricochet
