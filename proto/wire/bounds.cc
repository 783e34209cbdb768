#include "proto/wire/bounds.h"

#include "proto/wire/outcome.h"

namespace ricochet {

static v1::Range ToProto(const Range& range) {
  v1::Range proto;
  proto.set_lower(range.lower);
  proto.set_upper(range.upper);
  return proto;
}

static Range FromProto(const v1::Range& proto) { return {proto.lower(), proto.upper()}; }

static v1::CoefficientBounds ToProto(const CoefficientBounds& bounds) {
  v1::CoefficientBounds proto;
  *proto.mutable_newton() = ToProto(bounds.newton);
  *proto.mutable_poisson() = ToProto(bounds.poisson);
  *proto.mutable_energetic() = ToProto(bounds.energetic);
  *proto.mutable_tangential() = ToProto(bounds.tangential);
  *proto.mutable_normal_total_n_s() = ToProto(bounds.normal_total_n_s);
  return proto;
}

static CoefficientBounds FromProto(const v1::CoefficientBounds& proto) {
  return {.newton = FromProto(proto.newton()),
          .poisson = FromProto(proto.poisson()),
          .energetic = FromProto(proto.energetic()),
          .tangential = FromProto(proto.tangential()),
          .normal_total_n_s = FromProto(proto.normal_total_n_s())};
}

static v1::NearlyVertical ToProto(const NearlyVertical& nearly) {
  v1::NearlyVertical proto;
  *proto.mutable_bounds() = ToProto(nearly.bounds);
  proto.set_newton_error(nearly.newton_error);
  proto.set_poisson_error(nearly.poisson_error);
  proto.set_tangential_error(nearly.tangential_error);
  proto.set_normal_total_error_n_s(nearly.normal_total_error_n_s);
  if (nearly.coefficients.has_value()) {
    *proto.mutable_coefficients() = ToProto(*nearly.coefficients);
    *proto.mutable_coefficient_errors() = ToProto(nearly.coefficient_errors);
  }
  return proto;
}

static NearlyVertical FromProto(const v1::NearlyVertical& proto) {
  NearlyVertical nearly;
  nearly.bounds = FromProto(proto.bounds());
  nearly.newton_error = proto.newton_error();
  nearly.poisson_error = proto.poisson_error();
  nearly.tangential_error = proto.tangential_error();
  nearly.normal_total_error_n_s = proto.normal_total_error_n_s();
  if (proto.has_coefficients()) {
    nearly.coefficients = FromProto(proto.coefficients());
    nearly.coefficient_errors = FromProto(proto.coefficient_errors());
  }
  return nearly;
}

static v1::CriticalFriction ToProto(const CriticalFriction& critical) {
  v1::CriticalFriction proto;
  if (critical.stick.has_value()) proto.set_stick(*critical.stick);
  if (critical.stop_compression.has_value()) proto.set_stop_compression(*critical.stop_compression);
  if (critical.stop.has_value()) proto.set_stop(*critical.stop);
  if (critical.reversal.has_value()) proto.set_reversal(*critical.reversal);
  if (critical.jam.has_value()) proto.set_jam(*critical.jam);
  return proto;
}

static CriticalFriction FromProto(const v1::CriticalFriction& proto) {
  CriticalFriction critical;
  if (proto.has_stick()) critical.stick = proto.stick();
  if (proto.has_stop_compression()) critical.stop_compression = proto.stop_compression();
  if (proto.has_stop()) critical.stop = proto.stop();
  if (proto.has_reversal()) critical.reversal = proto.reversal();
  if (proto.has_jam()) critical.jam = proto.jam();
  return critical;
}

v1::Bounds ToProto(const Bounds& bounds) {
  v1::Bounds proto;
  proto.set_regime(ToProto(bounds.regime));
  proto.set_friction_ratio(bounds.friction_ratio);
  proto.set_slope_ratio(bounds.slope_ratio);
  *proto.mutable_sharp() = ToProto(bounds.sharp);
  if (bounds.energy_only.has_value()) *proto.mutable_energy_only() = ToProto(*bounds.energy_only);
  if (bounds.nearly_vertical.has_value()) {
    *proto.mutable_nearly_vertical() = ToProto(*bounds.nearly_vertical);
  }
  *proto.mutable_critical() = ToProto(bounds.critical);
  proto.set_sampled(bounds.sampled);
  return proto;
}

Bounds FromProto(const v1::Bounds& proto) {
  Bounds bounds;
  bounds.regime = FromProto(proto.regime());
  bounds.friction_ratio = proto.friction_ratio();
  bounds.slope_ratio = proto.slope_ratio();
  bounds.sharp = FromProto(proto.sharp());
  if (proto.has_energy_only()) bounds.energy_only = FromProto(proto.energy_only());
  if (proto.has_nearly_vertical()) bounds.nearly_vertical = FromProto(proto.nearly_vertical());
  bounds.critical = FromProto(proto.critical());
  bounds.sampled = proto.sampled();
  return bounds;
}

v1::Enclosure ToProto(const Enclosure& enclosure) {
  v1::Enclosure proto;
  *proto.mutable_outer() = ToProto(enclosure.outer);
  *proto.mutable_attained() = ToProto(enclosure.attained);
  proto.set_excess(enclosure.excess);
  proto.set_boxes(enclosure.boxes);
  return proto;
}

Enclosure FromProto(const v1::Enclosure& proto) {
  return {.outer = FromProto(proto.outer()),
          .attained = FromProto(proto.attained()),
          .excess = proto.excess(),
          .boxes = proto.boxes()};
}

}  // namespace ricochet
