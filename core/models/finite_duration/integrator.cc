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
  largest_.fill(0.0);
  s_ = previous_s_ = 0.0;
  next_size_ = kFirstSize;
  rates_ = RatesAt(contact_, mode_, y_);
  guards_ = GuardsAt(contact_, mode_, y_);
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
// the eighth root of the error; where x^p is no polynomial of q, at least by the part of q that the step goes.
double Integrator::ShareOfOrder8(const End& end) const {
  const double share = EighthRoot(tolerance_ * SizeOf(end));
  const bool is_smooth = !contact_.rooted || 2.0 * contact_.exponent == std::round(2.0 * contact_.exponent);
  const double least = std::min(std::fabs(before_[kPlace]), std::fabs(end.y[kPlace]));
  const double moved = std::fabs(end.y[kPlace] - before_[kPlace]);
  if (is_smooth || share * least > moved) return std::min(1.0, share);
  return moved < least ? moved / least : 1.0;
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

Integrator::Watch Integrator::WatchAt(const Motion& y, const Motion& rates, double h) const {
  const double ahead = 0x1p-20 * h;
  Motion next;
  for (size_t i = 0; i < kParts; ++i) next[i] = y[i] + ahead * rates[i];
  Watch watch = {rates, GuardsAt(contact_, mode_, y), GuardsAt(contact_, mode_, next)};
  for (size_t i = 0; i < kGuards; ++i) watch.slope[i] = (watch.slope[i] - watch.value[i]) / ahead;
  return watch;
}

std::optional<double> Integrator::FindDip(size_t i, double h, const Watch& before, const Watch& after) {
  const double value = before.value[i], slope = before.slope[i];
  const double side = value > 0.0 ? 1.0 : -1.0;
  if (!(side * slope < 0.0 && side * after.slope[i] > 0.0)) return std::nullopt;
  // The tangents at the ends meet below a dip that is convex, and not far above any other.
  constexpr double kNear = 0.25;
  const double meet = (after.value[i] - after.slope[i] * h - value) / (slope - after.slope[i]);
  const double least_end = std::min(std::fabs(value), std::fabs(after.value[i]));
  if (!(side * (value + slope * meet) < kNear * least_end)) return std::nullopt;
  const auto guard = [&](double part) { return side * GuardsAt(contact_, mode_, After(part * h).y)[i]; };
  constexpr int kBits = 20;
  const auto [part, least] = boost::math::tools::brent_find_minima(guard, 0.0, 1.0, kBits);
  return HasRoot(i, value, side * least) ? std::optional(part * h) : std::nullopt;
}

// Where forces balance, rounding alone changes the sign of a turning point.
bool Integrator::IsNoise(size_t i, double before, double after) {
  constexpr double kSmall = 0x1p-30;
  largest_[i] = std::max({largest_[i], std::fabs(before), std::fabs(after)});
  return std::max(std::fabs(before), std::fabs(after)) <= kSmall * largest_[i];
}

Integrator::Watch Integrator::CutAtRoot(double& h, End& end) {
  const double size = h;
  const Watch before = WatchAt(before_, rates_before_, size);
  const auto watch_end = [&] { return WatchAt(end.y, RatesAt(contact_, mode_, end.y), size); };
  Watch after = watch_end();
  const auto cut = [&](double at) {
    h = at;
    end = After(h);
    after = watch_end();
  };
  for (size_t i = 0; i < kGuards; ++i) {
    if (i >= kModeGuards && IsNoise(i, before.value[i], after.value[i])) continue;
    if (!HasRoot(i, before.value[i], after.value[i])) {
      const std::optional<double> dip = FindDip(i, h, before, after);
      if (!dip.has_value()) continue;
      cut(*dip);
    }
    const auto guard = [&](double at) { return InRange(GuardsAt(contact_, mode_, After(at).y)[i]); };
    // A turning point to half of the digits has the value there to all of them.
    const boost::math::tools::eps_tolerance<double> closeness(i < kModeGuards ? 52 : 26);
    std::uintmax_t evaluations = 100;
    cut(boost::math::tools::toms748_solve(guard, 0.0, h, InRange(before.value[i]), InRange(after.value[i]), closeness,
                                          evaluations)
            .second);
  }
  return after;
}

bool Integrator::Step(std::array<bool, kModeGuards>& fallen) {
  previous_s_ = s_;
  before_ = y_;
  rates_before_ = rates_;
  ++right_hand_sides_;
  double h = 0.0;
  End end;
  if (!TakeWholeStep(h, end)) return false;
  const Guards guards_before = guards_;
  const Watch at_end = CutAtRoot(h, end);
  rates_ = at_end.rates;
  guards_ = at_end.value;
  ++steps_;
  s_ = previous_s_ + h;
  y_ = end.y;
  const double share = ShareOfOrder8(end);
  for (size_t i = 0; i < kParts; ++i) {
    local_errors_[i] += share * std::fabs(end.error[i]) + kRounding * std::fabs(y_[i]);
  }
  // A guard that starts at 0 and falls has no root; it is below 0 at the end of a step.
  for (size_t i = 0; i < kModeGuards; ++i) fallen[i] = guards_[i] < 0.0 || HasRoot(i, guards_before[i], guards_[i]);
  return std::none_of(guards_.begin(), guards_.end(), [](double guard) { return std::isnan(guard); });
}

}  // namespace ricochet::finite_duration
