// FindCriticalFriction: the coefficients of friction at which the impact of a planar contact changes its course.
//
// They follow from W (1/kg) and the approach velocity (u0, v0) alone, v0 < 0; docs/theory/bounds.md has the formulas
// and their meaning (Wang and Mason 1992). A coefficient is unset if no friction is critical in its way. The number
// type N is double or a number with proved signs, for which `is_positive` decides; differences are rounded as N rounds
// them, some 8 ulp of the largest term for doubles. Bad input: none gets here (core/scene/validate.h).

#ifndef RICOCHET_CORE_CONTACT_CRITICAL_FRICTION_H_
#define RICOCHET_CORE_CONTACT_CRITICAL_FRICTION_H_

#include <algorithm>
#include <cmath>
#include <optional>

namespace ricochet {
namespace critical_friction {

inline double Abs(double x) { return std::fabs(x); }
inline double Max(double x, double y) { return std::max(x, y); }

// Returns n/d as a least coefficient of friction, which is not below 0; nothing if d is not above 0.
template <typename N, typename IsPositive>
std::optional<N> Least(const N& n, const N& d, IsPositive is_positive) {
  if (!is_positive(d)) return std::nullopt;
  return Max(n / d, N(0.0));
}

}  // namespace critical_friction

// `Critical` has the members of CriticalFriction (ricochet/bounds.h), each a std::optional<N>. `stops_anywhere`
// is false where W has rank one and the velocity lies in its range: slip then stops exactly where compression ends, and
// stop_compression is unset.
template <typename Critical, typename N, typename IsPositive>
Critical FindCriticalFriction(const N& wtt, const N& wtn, const N& wnn, const N& u0, const N& v0, bool stops_anywhere,
                              IsPositive is_positive) {
  using critical_friction::Abs;
  using critical_friction::Least;
  Critical critical;
  if (!is_positive(wtt)) return critical;
  critical.stick = Abs(wtn) / wtt;
  const bool backwards = is_positive(-u0);
  if (!backwards && !is_positive(u0)) return critical;
  const N p = Abs(u0);
  const N w = -v0;
  const N q = backwards ? N(-wtn) : wtn;
  const N wnn_p = wnn * p;
  if (stops_anywhere) critical.stop_compression = Least<N>(wnn_p + w * q, w * wtt + q * p, is_positive);
  critical.stop = Least<N>(wnn_p + N(2.0) * w * q, N(2.0) * w * wtt + q * p, is_positive);
  const bool reverses = critical.stop.has_value() && is_positive(-q) && is_positive(*critical.stick - *critical.stop);
  if (reverses) critical.reversal = critical.stop;
  if (is_positive(q)) critical.jam = wnn / q;
  return critical;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_CRITICAL_FRICTION_H_
