#include "tests/hard_cases/naive_planar.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet::planar {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

class Path {
 public:
  explicit Path(const Problem& problem) : p_(problem), u_(problem.u0), v_(problem.v0) {
    impact_.w_rank = p_.w.tt * p_.w.nn - p_.w.tn * p_.w.tn > 0.0 ? 2 : 1;
    Record(EventKind::kStart);
  }

  Impact Run() {
    constexpr int kEnough = 10;
    for (int i = 0; i < kEnough && !done_; ++i) Advance();
    return Report();
  }

 private:
  double Friction() {
    sticks_ = false;
    if (p_.w.tt == 0.0) return 0.0;
    double direction = u_;
    if (direction == 0.0) {
      sticks_ = std::fabs(p_.w.tn) <= p_.mu_static * p_.w.tt;
      if (sticks_) return -p_.w.tn / p_.w.tt;
      direction = p_.w.tn;
    }
    return -std::copysign(p_.mu, direction);
  }

  double UntilEnd(double rise) const {
    if (!restoring_) return rise > 0.0 ? -v_ / rise : kNever;
    switch (p_.law) {
      case RestitutionLaw::kNewton:
        return (-p_.coefficient * p_.v0 - v_) / rise;
      case RestitutionLaw::kPoisson:
        return (1.0 + p_.coefficient) * impact_.tau_compression - tau_;
      case RestitutionLaw::kEnergetic: {
        const double missing = -p_.coefficient * p_.coefficient * impact_.work_normal_compression - work_n_;
        return (std::sqrt(v_ * v_ + 2.0 * rise * missing) - v_) / rise;
      }
    }
    return kNever;
  }

  void Advance() {
    const double f = Friction();
    const double u_rise = sticks_ ? 0.0 : p_.w.tn + p_.w.tt * f;
    const double v_rise = p_.w.nn + p_.w.tn * f;
    if (sticks_ && v_rise <= 0.0) {
      impact_.regime = Regime::kLocked;
      done_ = true;
      return;
    }
    if (sticks_ && impact_.event_count == 1) impact_.regime = Regime::kStickInCompression;
    NoteStop();
    const double stop = u_ * u_rise < 0.0 ? -u_ / u_rise : kNever;
    const double end = UntilEnd(v_rise);
    const double step = std::min(stop, end);
    const double u = stop <= end ? 0.0 : u_ + u_rise * step;
    const double v = end <= stop && !restoring_ ? 0.0 : v_ + v_rise * step;
    work_n_ += 0.5 * step * (v_ + v);
    work_t_ += 0.5 * f * step * (u_ + u);
    tau_ += step;
    f_ += f * step;
    u_ = u;
    v_ = v;
    if (!(step < kNever)) done_ = true;
    if (stop <= end) Stop();
    if (end <= stop) End();
  }

  void Stop() {
    Record(EventKind::kSlipStops);
    stopped_ = true;
    in_compression_ = !restoring_ && v_ < 0.0;
  }

  void NoteStop() {
    if (!stopped_) return;
    stopped_ = false;
    impact_.regime = in_compression_ ? (sticks_ ? Regime::kStickInCompression : Regime::kReversalInCompression)
                                     : (sticks_ ? Regime::kStickInRestitution : Regime::kReversalInRestitution);
  }

  void End() {
    if (restoring_) {
      if (stopped_) (void)Friction();
      NoteStop();
      Record(EventKind::kRestitutionEnds);
      impact_.work_normal_restitution = work_n_;
      impact_.work_tangential_restitution = work_t_;
      done_ = true;
      return;
    }
    Record(EventKind::kCompressionEnds);
    restoring_ = true;
    impact_.tau_compression = tau_;
    impact_.f_compression = f_;
    impact_.work_normal_compression = work_n_;
    impact_.work_tangential_compression = work_t_;
    work_n_ = work_t_ = 0.0;
  }

  void Record(EventKind kind) {
    if (impact_.event_count == kMaxEvents) return;
    impact_.events[static_cast<size_t>(impact_.event_count++)] = {kind, tau_, f_, u_, v_};
  }

  Impact Report() {
    if (impact_.regime == Regime::kUnspecified) impact_.regime = Regime::kSliding;
    if (impact_.regime == Regime::kSliding && (p_.mu == 0.0 || p_.w.tt == 0.0)) impact_.regime = Regime::kFrictionless;
    if (p_.mu_static == 0.0) impact_.regime = Regime::kFrictionless;
    impact_.u1 = u_;
    impact_.v1 = v_;
    impact_.tau1 = tau_;
    impact_.f1 = f_;
    impact_.newton = -v_ / p_.v0;
    impact_.poisson = (tau_ - impact_.tau_compression) / impact_.tau_compression;
    impact_.energetic = std::sqrt(-impact_.work_normal_restitution / impact_.work_normal_compression);
    impact_.energetic_excess = impact_.energetic - 1.0;
    impact_.tangential = f_ / tau_;
    impact_.energy_change = impact_.work_normal_compression + impact_.work_normal_restitution +
                            impact_.work_tangential_compression + impact_.work_tangential_restitution;
    return impact_;
  }

  Problem p_;
  double tau_ = 0.0, f_ = 0.0, u_, v_;
  double work_n_ = 0.0, work_t_ = 0.0;  // Works of the current phase.
  bool restoring_ = false, sticks_ = false, stopped_ = false, in_compression_ = false, done_ = false;
  Impact impact_;
};

}  // namespace

Impact NaiveSolve(const Problem& problem) { return Path(problem).Run(); }

}  // namespace ricochet::planar
