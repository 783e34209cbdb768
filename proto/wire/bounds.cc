#include "proto/wire/bounds.h"

#include "proto/wire/map.h"
#include "proto/wire/outcome.h"

namespace ricochet {

template <>
struct Map<Range> : Between<Range, v1::Range> {
  using Fields = Entries<Entry(&T::lower, &P::lower, &P::set_lower), Entry(&T::upper, &P::upper, &P::set_upper)>;
};

template <>
struct Map<CoefficientBounds> : Between<CoefficientBounds, v1::CoefficientBounds> {
  using Fields =
      Entries<Entry(&T::newton, &P::newton, &P::mutable_newton), Entry(&T::poisson, &P::poisson, &P::mutable_poisson),
              Entry(&T::energetic, &P::energetic, &P::mutable_energetic),
              Entry(&T::tangential, &P::tangential, &P::mutable_tangential),
              Entry(&T::normal_total_n_s, &P::normal_total_n_s, &P::mutable_normal_total_n_s)>;
};

// The errors of the coefficients are sent with the coefficients only.
struct CoefficientErrorsEntry {
  static void Write(const NearlyVertical& nearly, v1::NearlyVertical& proto) {
    if (nearly.coefficients.has_value()) ToProto(nearly.coefficient_errors, *proto.mutable_coefficient_errors());
  }
  static void Read(const v1::NearlyVertical& proto, NearlyVertical& nearly) {
    if (proto.has_coefficients()) FromProto(proto.coefficient_errors(), nearly.coefficient_errors);
  }
};

template <>
struct Map<NearlyVertical> : Between<NearlyVertical, v1::NearlyVertical> {
  using Fields = Entries<Entry(&T::bounds, &P::bounds, &P::mutable_bounds),
                         Entry(&T::newton_error, &P::newton_error, &P::set_newton_error),
                         Entry(&T::poisson_error, &P::poisson_error, &P::set_poisson_error),
                         Entry(&T::tangential_error, &P::tangential_error, &P::set_tangential_error),
                         Entry(&T::normal_total_error_n_s, &P::normal_total_error_n_s, &P::set_normal_total_error_n_s),
                         Entry(&T::coefficients, &P::has_coefficients, &P::coefficients, &P::mutable_coefficients),
                         CoefficientErrorsEntry{}>;
};

template <>
struct Map<CriticalFriction> : Between<CriticalFriction, v1::CriticalFriction> {
  using Fields =
      Entries<Entry(&T::stick, &P::has_stick, &P::stick, &P::set_stick),
              Entry(&T::stop_compression, &P::has_stop_compression, &P::stop_compression, &P::set_stop_compression),
              Entry(&T::stop, &P::has_stop, &P::stop, &P::set_stop),
              Entry(&T::reversal, &P::has_reversal, &P::reversal, &P::set_reversal),
              Entry(&T::jam, &P::has_jam, &P::jam, &P::set_jam)>;
};

template <>
struct Map<Bounds> : Between<Bounds, v1::Bounds> {
  using Fields = Entries<
      Entry(&T::regime, &P::regime, &P::set_regime),
      Entry(&T::friction_ratio, &P::friction_ratio, &P::set_friction_ratio),
      Entry(&T::slope_ratio, &P::slope_ratio, &P::set_slope_ratio), Entry(&T::sharp, &P::sharp, &P::mutable_sharp),
      Entry(&T::energy_only, &P::has_energy_only, &P::energy_only, &P::mutable_energy_only),
      Entry(&T::nearly_vertical, &P::has_nearly_vertical, &P::nearly_vertical, &P::mutable_nearly_vertical),
      Entry(&T::critical, &P::critical, &P::mutable_critical), Entry(&T::sampled, &P::sampled, &P::set_sampled)>;
};

template <>
struct Map<Enclosure> : Between<Enclosure, v1::Enclosure> {
  using Fields =
      Entries<Entry(&T::outer, &P::outer, &P::mutable_outer), Entry(&T::attained, &P::attained, &P::mutable_attained),
              Entry(&T::excess, &P::excess, &P::set_excess), Entry(&T::boxes, &P::boxes, &P::set_boxes)>;
};

void ToProto(const Bounds& bounds, v1::Bounds& proto) { Map<Bounds>::Fields::Write(bounds, proto); }
void FromProto(const v1::Bounds& proto, Bounds& bounds) { Map<Bounds>::Fields::Read(proto, bounds); }

void ToProto(const Enclosure& enclosure, v1::Enclosure& proto) { Map<Enclosure>::Fields::Write(enclosure, proto); }
void FromProto(const v1::Enclosure& proto, Enclosure& enclosure) { Map<Enclosure>::Fields::Read(proto, enclosure); }

}  // namespace ricochet
