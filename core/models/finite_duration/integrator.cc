#include "core/models/finite_duration/integrator.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>

namespace ricochet::finite_duration {
namespace {

// The first step of a mode is so small that a guard which falls from 0 at once is found before anything moves.
constexpr double kFirstSize = 0x1p-30;
constexpr double kMostGrowth = 64.0, kLeastGrowth = 0.125;
constexpr double kSafety = 0.9;
constexpr double kRounding = 0x1p-54;

// True if the guard `i` has a root between two values: those that end the mode fall, the others only change sign.
bool HasRoot(size_t i, double before, double after) {
  const bool falls = before > 0.0 && after <= 0.0;
  return falls || (i >= kModeGuards && before < 0.0 && after >= 0.0);
}

// A search for roots subtracts values and divides by the difference.
double InRange(double guard) { return std::clamp(guard, -0x1p1000, 0x1p1000); }

double EighthRoot(double x) { return std::sqrt(std::sqrt(std::sqrt(x))); }

// The growth by which a step has an error of about the tolerance, over which its error now is `size`.
double GrowthFor(double size) {
  return size < HUGE_VAL ? std::clamp(kSafety / EighthRoot(size), kLeastGrowth, kMostGrowth) : kLeastGrowth;
}

}  // namespace

void Integrator::Begin(const Mode& mode, const Motion& y, double tolerance) {
  mode_ = mode;
  before_ = y_ = y;
  tolerance_ = tolerance;
  absolute_.fill(1.0);
  const double slip = std::max(1.0, std::fabs(contact_.u0));
  absolute_[kU] = absolute_[kTangentWork] = absolute_[kFrictionLoss] = slip;
  absolute_[kV] = Pace(contact_, mode);
  for (const Part part : kForceParts) absolute_[part] *= contact_.stiffness;
  // A weak pull ends the contact where damping has left as little of N as the pull.
  constexpr double kWeakest = 0x1p-60;
  const double pull = std::clamp(std::max(std::fabs(contact_.an), std::fabs(contact_.at)), kWeakest, 1.0);
  absolute_[kStretch] = contact_.pulled ? pull : HUGE_VAL;
  s_ = previous_s_ = 0.0;
  next_size_ = kFirstSize;
  guards_before_ = GuardsAt(contact_, mode_, y_);
}

Integrator::End Integrator::After(double h) {
  right_hand_sides_ += static_cast<int64_t>(kStages - 1);
  const auto rates = [this](const Motion& y) { return RatesAt(contact_, mode_, y); };
  return RungeKuttaStep(rates, before_, rates_before_, h);
}

double Integrator::SizeOf(const End& end) const {
  double sum = 0.0;
  for (size_t i = 0; i < kParts; ++i) {
    const double most = tolerance_ * (std::fabs(before_[i]) + absolute_[i]);
    sum += Square(end.error[i] / std::max(most, std::numeric_limits<double>::min()));
  }
  return std::sqrt(sum / static_cast<double>(end.error.size()));
}

// The formula of order 8, which is followed, errs by less than that of order 7 by about the size of a step, which is
// the eighth root of the error. Powers of q that are not integers have no eighth derivative at q = 0, nor order there.
double Integrator::ShareOfOrder8(const End& end) const {
  const bool is_smooth = !contact_.rooted || 2.0 * contact_.exponent == std::round(2.0 * contact_.exponent);
  return is_smooth ? std::min(1.0, EighthRoot(tolerance_ * SizeOf(end))) : 1.0;
}

bool Integrator::TakeWholeStep(double& h, End& end) {
  h = next_size_;
  while (previous_s_ + h > previous_s_) {
    end = After(h);
    const double size = SizeOf(end);
    next_size_ = h * GrowthFor(size);
    if (size <= 1.0) return true;
    h = next_size_;
  }
  return false;
}

Guards Integrator::SlopesAt(const Motion& y, const Guards& guards, double h) const {
  const double ahead = 0x1p-20 * h;
  const Motion rates = RatesAt(contact_, mode_, y);
  Motion next;
  for (size_t i = 0; i < kParts; ++i) next[i] = y[i] + ahead * rates[i];
  Guards slopes = GuardsAt(contact_, mode_, next);
  for (size_t i = 0; i < kGuards; ++i) slopes[i] = (slopes[i] - guards[i]) / ahead;
  return slopes;
}

std::optional<double> Integrator::FindDip(size_t i, double h, double after, double slope_before, double slope_after) {
  const double before = guards_before_[i];
  const double side = before > 0.0 ? 1.0 : -1.0;
  if (!(side * slope_before < 0.0 && side * slope_after > 0.0)) return std::nullopt;
  // The tangents at the ends meet below a dip between them.
  const double meet = (after - slope_after * h - before) / (slope_before - slope_after);
  if (!(side * (before + slope_before * meet) < 0.0)) return std::nullopt;
  const auto guard = [&](double at) { return side * GuardsAt(contact_, mode_, After(at).y)[i]; };
  constexpr int kBits = 20;
  const auto [place, least] = boost::math::tools::brent_find_minima(guard, 0.0, h, kBits);
  return HasRoot(i, before, side * least) ? std::optional(place) : std::nullopt;
}

void Integrator::CutAtRoot(double& h, End& end) {
  const Guards slopes_before = SlopesAt(before_, guards_before_, h);
  for (size_t i = 0; i < kGuards; ++i) {
    Guards guards = GuardsAt(contact_, mode_, end.y);
    if (!HasRoot(i, guards_before_[i], guards[i])) {
      const Guards slopes = SlopesAt(end.y, guards, h);
      const std::optional<double> dip = FindDip(i, h, guards[i], slopes_before[i], slopes[i]);
      if (!dip.has_value()) continue;
      h = *dip;
      end = After(h);
      guards = GuardsAt(contact_, mode_, end.y);
    }
    const double after = guards[i];
    const auto guard = [&](double at) { return InRange(GuardsAt(contact_, mode_, After(at).y)[i]); };
    // A turning point to half of the digits has the value there to all of them.
    const boost::math::tools::eps_tolerance<double> closeness(i < kModeGuards ? 52 : 26);
    std::uintmax_t evaluations = 100;
    h = boost::math::tools::toms748_solve(guard, 0.0, h, InRange(guards_before_[i]), InRange(after), closeness,
                                          evaluations)
            .second;
    end = After(h);
  }
}

bool Integrator::Step(std::array<bool, kModeGuards>& fallen) {
  previous_s_ = s_;
  before_ = y_;
  rates_before_ = RatesAt(contact_, mode_, y_);
  ++right_hand_sides_;
  double h = 0.0;
  End end;
  if (!TakeWholeStep(h, end)) return false;
  CutAtRoot(h, end);
  ++steps_;
  s_ = previous_s_ + h;
  y_ = end.y;
  const double share = ShareOfOrder8(end);
  for (size_t i = 0; i < kParts; ++i) {
    local_errors_[i] += share * std::fabs(end.error[i]) + kRounding * std::fabs(y_[i]);
  }
  const Guards guards = GuardsAt(contact_, mode_, y_);
  for (size_t i = 0; i < kModeGuards; ++i) fallen[i] = HasRoot(i, guards_before_[i], guards[i]);
  guards_before_ = guards;
  return std::none_of(guards.begin(), guards.end(), [](double guard) { return std::isnan(guard); });
}

}  // namespace ricochet::finite_duration
