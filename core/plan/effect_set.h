// EffectSet: a set of effects.

#ifndef RICOCHET_CORE_PLAN_EFFECT_SET_H_
#define RICOCHET_CORE_PLAN_EFFECT_SET_H_

#include <cstdint>
#include <initializer_list>

#include "ricochet/plan.h"

namespace ricochet {

class EffectSet {
 public:
  constexpr EffectSet() = default;
  constexpr EffectSet(std::initializer_list<Effect> effects) {
    for (const Effect effect : effects) Add(effect);
  }

  constexpr bool Has(Effect effect) const { return (bits_ & BitOf(effect)) != 0; }
  constexpr bool IsEmpty() const { return bits_ == 0; }
  constexpr bool Contains(EffectSet other) const { return (other.bits_ & ~bits_) == 0; }
  constexpr void Add(Effect effect) { bits_ |= BitOf(effect); }
  constexpr EffectSet operator|(EffectSet other) const { return EffectSet(bits_ | other.bits_); }
  constexpr EffectSet operator&(EffectSet other) const { return EffectSet(bits_ & other.bits_); }
  constexpr EffectSet Without(EffectSet other) const { return EffectSet(bits_ & ~other.bits_); }

  friend constexpr bool operator==(EffectSet, EffectSet) = default;

 private:
  constexpr explicit EffectSet(uint32_t bits) : bits_(bits) {}
  static constexpr uint32_t BitOf(Effect effect) { return uint32_t{1} << static_cast<int>(effect); }

  uint32_t bits_ = 0;
};

// All effects, in order of their numbers.
inline constexpr Effect kEffects[] = {
    Effect::kFriction,
    Effect::kSlipStop,
    Effect::kSlipTurn,
    Effect::kStaticFriction,
    Effect::kTangentialCompliance,
    Effect::kFiniteDuration,
    Effect::kFiniteForces,
    Effect::kHigherOrder,
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_EFFECT_SET_H_
