#include "core/plan/perturbed_path.h"

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

// The differences e_f, e_v and e_u of two paths, and the shift of the end of compression.
class Comparison {
 public:
  Comparison(const Mobility& mobility, const ReferencePath& reference, const Perturbation& change)
      : mobility_(mobility), reference_(reference), change_(change) {
    jump_ = change.v + mobility.coupling * change.f_jump;
    slope_ = mobility.coupling * change.f_slope;
    const bool known = change.slope_low > 0.0;
    growth_ = known ? std::min(reference.slope_low, change.slope_low) : reference.slope_low - slope_;
    slack_ = known ? 0.0 : 2.0 * jump_;
    latest_compression_end_ = 1.0 / reference.slope_low;
    compression_end_shift_ = OfV(latest_compression_end_) / growth_;
  }

  double OfF(double tau) const { return change_.f_jump + change_.f_slope * Past(tau); }
  double OfV(double tau) const { return jump_ + slope_ * Past(tau); }
  double OfU(double tau) const { return mobility_.tangential * OfF(tau) + change_.u; }

  // Integral of e_v.
  double Area(double begin, double end) const {
    const double before = Past(begin);
    const double after = Past(end);
    return jump_ * (end - begin) + 0.5 * slope_ * (after - before) * (after + before);
  }

  double growth() const { return growth_; }                                  // L
  double slack() const { return slack_; }                                    // z
  double latest_compression_end() const { return latest_compression_end_; }  // 1/lo
  double compression_end_shift() const { return compression_end_shift_; }    // Dc
  const ReferencePath& reference() const { return reference_; }

 private:
  double Past(double tau) const { return std::max(tau - change_.from, 0.0); }

  const Mobility& mobility_;
  const ReferencePath& reference_;
  const Perturbation& change_;
  double jump_, slope_, growth_, slack_, latest_compression_end_, compression_end_shift_;
};

struct EndShift {
  double v1 = 0.0;
  double tau1 = 0.0;
  double last = 0.0;  // An upper bound on tau1_B.
};

EndShift NewtonShift(const Comparison& by, double e) {
  const double tau1 = (1.0 + e) * by.latest_compression_end();
  const double shift = by.OfV(tau1) / by.growth();
  return {.v1 = 0.0, .tau1 = shift, .last = tau1 + shift};
}

EndShift PoissonShift(const Comparison& by, double k) {
  const double shift = (1.0 + k) * by.compression_end_shift();
  const double last = (1.0 + k) * by.latest_compression_end() + shift;
  return {.v1 = by.OfV(last) + by.reference().slope_high * shift, .tau1 = shift, .last = last};
}

EndShift EnergeticShift(const Comparison& by, double eta) {
  const double compression_end = by.latest_compression_end() + by.compression_end_shift();
  if (eta == 0.0) return {.v1 = 0.0, .tau1 = by.compression_end_shift(), .last = compression_end};
  const double low = by.reference().slope_low;
  const double high = by.reference().slope_high;
  const double square = eta * eta;
  const double stored = by.Area(0.0, compression_end);
  const double returned = square * (0.5 * by.latest_compression_end() + stored);
  const double z = by.slack();
  const double last = compression_end + (z + std::sqrt(z * z + 2.0 * by.growth() * returned)) / by.growth();
  const double difference = square * stored + by.Area(std::max(1.0 / high - by.compression_end_shift(), 0.0), last);
  const double of_square = 2.0 * high * difference * (1.0 + 0x1p-30);
  const double least_square = square * low / high;
  const double along = least_square > of_square
                           ? of_square / (std::sqrt(least_square) + std::sqrt(least_square - of_square))
                           : std::sqrt(of_square) + high * by.compression_end_shift();
  return {.v1 = along + by.OfV(last), .tau1 = along / low, .last = last};
}

EndShift ShiftOf(const Comparison& by, const Restoring& restoring) {
  switch (restoring.law) {
    case RestitutionLaw::kNewton:
      return NewtonShift(by, restoring.coefficient);
    case RestitutionLaw::kPoisson:
      return PoissonShift(by, restoring.coefficient);
    case RestitutionLaw::kEnergetic:
      break;
  }
  return EnergeticShift(by, restoring.coefficient);
}

struct EndRange {
  double v_low, v_high;
  double tau_low, tau_high;
};

// The ranges of v1 and tau1 if v' lies in [low, high].
EndRange EndsBySlopes(const Restoring& restoring, double low, double high) {
  const double c = restoring.coefficient;
  const double ratio = high / low;
  switch (restoring.law) {
    case RestitutionLaw::kNewton:
      return {c, c, (1.0 + c) / high, (1.0 + c) / low};
    case RestitutionLaw::kPoisson:
      return {c / ratio, c * ratio, (1.0 + c) / high, (1.0 + c) / low};
    case RestitutionLaw::kEnergetic:
      break;
  }
  const double root = std::sqrt(ratio);
  return {c / root, c * root, (1.0 + c / root) / high, (1.0 + c * root) / low};
}

EndShift ShiftBySlopes(const Restoring& restoring, const ReferencePath& reference, const Perturbation& change) {
  constexpr double kRounding = 0x1p-48;
  // A slope near 0 is a difference of terms near 1, with their rounding.
  const double most = std::max(change.slope_high, reference.slope_high);
  const double low = std::min(change.slope_low, reference.slope_low) - kRounding * (1.0 + most);
  const double high = most + kRounding * (1.0 + most);
  const EndRange a = EndsBySlopes(restoring, reference.slope_low, reference.slope_high);
  const EndRange b = EndsBySlopes(restoring, low, high);
  const double v1 = restoring.law == RestitutionLaw::kNewton
                        ? 0.0
                        : std::max(b.v_high - a.v_low, a.v_high - b.v_low) + kRounding * (a.v_high + b.v_high);
  return {.v1 = v1,
          .tau1 = std::max(b.tau_high - a.tau_low, a.tau_high - b.tau_low) + kRounding * (a.tau_high + b.tau_high),
          .last = b.tau_high};
}

}  // namespace

double WithRoundingMargin(double bound) {
  if (bound == 0.0) return 0.0;
  const double padded = bound * (1.0 + 0x1p-20) + std::numeric_limits<double>::min();
  return padded >= 0.0 ? padded : kUnbounded;
}

double LargestChange(const Mobility& mobility, const Restoring& restoring, const ReferencePath& reference,
                     const Perturbation& change) {
  const Comparison by(mobility, reference, change);
  if (!(reference.slope_low >= kLeastSlope) || !(by.growth() >= kLeastSlope)) return kUnbounded;
  EndShift shift = ShiftOf(by, restoring);
  if (change.slope_low > 0.0) {
    const EndShift other = ShiftBySlopes(restoring, reference, change);
    shift = {.v1 = std::min(shift.v1, other.v1),
             .tau1 = std::min(shift.tau1, other.tau1),
             .last = std::min(shift.last, other.last)};
  }
  const double u1 = by.OfU(shift.last) + reference.u_slope * shift.tau1;
  const double f1 = mobility.tangential * (by.OfF(shift.last) + reference.f_slope * shift.tau1);
  const bool bounded = shift.v1 + shift.tau1 + u1 + f1 < kUnbounded;  // A NaN makes this false, too.
  return bounded ? WithRoundingMargin(std::max({shift.v1, shift.tau1, u1, f1})) : kUnbounded;
}

}  // namespace ricochet
