#include "tests/support/oracles/planar_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

namespace ricochet::planar {
namespace {

// The sign of a ball: -1, 0 or 1; a ball that contains 0 has the sign 0.
int SignOf(const Ball& x) { return x > Ball(0.0) ? 1 : x < Ball(0.0) ? -1 : 0; }
int Compare(const Ball& x, const Ball& y) { return SignOf(x - y); }
Ball RootOf(const Ball& x) { return SignOf(x) == 0 ? Ball(0.0) : Sqrt(x); }
Ball Larger(const Ball& x, const Ball& y) { return Compare(x, y) < 0 ? y : x; }

slong PrecisionFor(const Problem& problem) {
  int least = std::numeric_limits<int>::max();
  int most = std::numeric_limits<int>::min();
  for (const double value : {problem.w.tt, problem.w.tn, problem.w.nn, problem.u0, problem.v0, problem.mu,
                             problem.mu_static, problem.coefficient, 1.0}) {
    if (value == 0.0) continue;
    least = std::min(least, std::ilogb(value));
    most = std::max(most, std::ilogb(value));
  }
  return 1024 + 8 * (most - least);
}

class Simulation {
 public:
  Simulation(const Problem& problem, const ExactContact& contact)
      : problem_(problem),
        wtt_(contact.wtt),
        wtn_(contact.wtn),
        wnn_(contact.wnn),
        u0_(contact.u0),
        v0_(contact.v0),
        mu_(contact.mu.value_or(Ball(problem.mu, PrecisionFor(problem)))),
        mu_static_(contact.mu_static.value_or(Ball(problem.mu_static, PrecisionFor(problem)))),
        coefficient_(contact.coefficient.value_or(Ball(problem.coefficient, PrecisionFor(problem)))) {
    const Ball square = wtt_ * wnn_;
    rank_one_ = Compare(Abs(square - wtn_ * wtn_), Ball(0x1p-50) * square) <= 0;
    if (rank_one_ && problem.w.tt != 0.0) {
      wtt_ = wtn_ * wtn_ / wnn_;
      const Ball beside = u0_ * wnn_ - v0_ * wtn_;
      in_range_ = Compare(Abs(beside), Ball(0x1p-49) * (Abs(u0_) * wnn_ + Abs(v0_ * wtn_))) <= 0;
      if (in_range_) u0_ = v0_ * wtn_ / wnn_;
    }
    u_ = u0_;
    v_ = v0_;
  }

  ExactImpact Run() {
    impact_.w_rank = rank_one_ ? 1 : 2;
    Record(EventKind::kStart);
    while (Step()) {
    }
    Conclude();
    return impact_;
  }

 private:
  struct Candidate {
    EventKind kind;
    Ball wait;
  };

  void Record(EventKind kind) { impact_.events.push_back({kind, tau_, f_, u_, v_}); }

  // The current df/dtau.
  Ball FrictionNow() {
    sticks_ = false;
    int direction = SignOf(u_);
    if (SignOf(wtt_) == 0) return Ball(-direction) * mu_;
    if (direction == 0) {
      if (Compare(Abs(wtn_), mu_static_ * wtt_) <= 0) {
        sticks_ = true;
        return -wtn_ / wtt_;
      }
      direction = SignOf(wtn_);
    }
    return Ball(-direction) * mu_;
  }

  // Returns whether restitution can end although v stands still, as it does if W has rank one and the contact sticks.
  bool EndsAtRest() const { return problem_.law != RestitutionLaw::kNewton || Compare(-coefficient_ * v0_, v_) <= 0; }

  // The normal impulse up to the end of restitution if v goes on with slope `rise`.
  Ball WaitForEnd(const Ball& rise) const {
    if (SignOf(rise) == 0 && problem_.law == RestitutionLaw::kNewton) return Ball(0.0);
    if (SignOf(rise) == 0 && problem_.law == RestitutionLaw::kEnergetic) {
      return (-coefficient_ * coefficient_ * impact_.work_normal_compression - normal_work_) / v_;
    }
    switch (problem_.law) {
      case RestitutionLaw::kNewton:
        return (-coefficient_ * v0_ - v_) / rise;
      case RestitutionLaw::kPoisson:
        return (1.0 + coefficient_) * impact_.tau_compression - tau_;
      case RestitutionLaw::kEnergetic: {
        const Ball missing = -coefficient_ * coefficient_ * impact_.work_normal_compression - normal_work_;
        return (RootOf(v_ * v_ + 2.0 * rise * missing) - v_) / rise;
      }
    }
    std::abort();
  }

  // Follows one piece of the path; returns false at its end.
  bool Step() {
    const Ball friction = FrictionNow();
    const Ball u_rise = wtn_ + wtt_ * friction;
    const Ball v_rise = wnn_ + wtn_ * friction;
    if (sticks_ && in_range_) {
      locked_ = true;
      return false;
    }
    const bool stands = rank_one_ && (sticks_ || SignOf(v_rise) == 0);
    if (stands && (!restoring_ || !EndsAtRest())) {
      jammed_ = true;
      NoteMode();
      return false;
    }
    NoteMode();
    impact_.steepest_friction = Larger(impact_.steepest_friction, Abs(friction));
    std::vector<Candidate> candidates;
    if (!sticks_ && SignOf(u_) * SignOf(u_rise) < 0) candidates.push_back({EventKind::kSlipStops, -u_ / u_rise});
    if (restoring_) {
      candidates.push_back({EventKind::kRestitutionEnds, WaitForEnd(stands ? Ball(0.0) : v_rise)});
    } else if (SignOf(v_rise) > 0) {
      candidates.push_back({EventKind::kCompressionEnds, -v_ / v_rise});
    }
    if (candidates.empty()) std::abort();
    Ball wait = candidates.front().wait;
    for (const Candidate& candidate : candidates) {
      if (Compare(candidate.wait, wait) < 0) wait = candidate.wait;
    }
    Advance(friction, sticks_ ? Ball(0.0) : u_rise, stands ? Ball(0.0) : v_rise, wait);
    std::vector<EventKind> due;
    for (const Candidate& candidate : candidates) {
      if (Compare(candidate.wait, wait) == 0) due.push_back(candidate.kind);
    }
    return Handle(due);
  }

  // The mode that follows the last stop of slip.
  void NoteMode() {
    if (!stop_pending_) return;
    stop_pending_ = false;
    stopped_ = true;
    stopped_in_compression_ = !restoring_;
    stuck_ = sticks_;
  }

  void Advance(const Ball& friction, const Ball& u_rise, const Ball& v_rise, const Ball& wait) {
    const Ball u = u_ + u_rise * wait;
    const Ball v = v_ + v_rise * wait;
    normal_work_ = normal_work_ + 0.5 * wait * (v_ + v);
    tangential_work_ = tangential_work_ + 0.5 * friction * wait * (u_ + u);
    tau_ = tau_ + wait;
    f_ = f_ + friction * wait;
    u_ = u;
    v_ = v;
  }

  bool Handle(const std::vector<EventKind>& due) {
    const auto is_due = [&due](EventKind kind) { return std::find(due.begin(), due.end(), kind) != due.end(); };
    if (is_due(EventKind::kSlipStops)) u_ = Ball(0.0);
    if (is_due(EventKind::kCompressionEnds)) v_ = Ball(0.0);
    if (is_due(EventKind::kSlipStops)) {
      stop_pending_ = true;
      Record(EventKind::kSlipStops);
    }
    if (is_due(EventKind::kCompressionEnds)) {
      Record(EventKind::kCompressionEnds);
      restoring_ = true;
      impact_.tau_compression = tau_;
      impact_.f_compression = f_;
      impact_.work_normal_compression = normal_work_;
      impact_.work_tangential_compression = tangential_work_;
      normal_work_ = Ball(0.0);
      tangential_work_ = Ball(0.0);
    }
    if (!is_due(EventKind::kRestitutionEnds)) return true;
    if (stop_pending_) {
      (void)FrictionNow();
      NoteMode();
    }
    Record(EventKind::kRestitutionEnds);
    return false;
  }

  Regime RegimeReached() const {
    if (locked_) return Regime::kLocked;
    if (jammed_) return Regime::kWedged;
    const bool started_stuck = problem_.u0 == 0.0 && !rank_one_ && Compare(Abs(wtn_), mu_static_ * wtt_) <= 0;
    const bool ever_stuck = started_stuck || (stopped_ && stuck_);
    if ((problem_.w.tt == 0.0 && problem_.u0 == 0.0) || problem_.mu_static == 0.0) return Regime::kFrictionless;
    if (problem_.mu == 0.0 && !ever_stuck) return Regime::kFrictionless;
    if (started_stuck) return Regime::kStickInCompression;
    if (!stopped_) return Regime::kSliding;
    if (stopped_in_compression_) return stuck_ ? Regime::kStickInCompression : Regime::kReversalInCompression;
    return stuck_ ? Regime::kStickInRestitution : Regime::kReversalInRestitution;
  }

  void Conclude() {
    impact_.regime = RegimeReached();
    if (jammed_) return ConcludeJam();
    impact_.work_normal_restitution = normal_work_;
    impact_.work_tangential_restitution = tangential_work_;
    impact_.newton = -v_ / v0_;
    impact_.poisson = (tau_ - impact_.tau_compression) / impact_.tau_compression;
    impact_.energetic = RootOf(-normal_work_ / impact_.work_normal_compression);
    impact_.conditioning = Ball(1.0);
    if (!rank_one_) {
      const Ball det = wtt_ * wnn_ - wtn_ * wtn_;
      impact_.conditioning = wtt_ * wnn_ / det * (1.0 + mu_ * Abs(wtn_) / wnn_);
    }
    impact_.energy_change = impact_.work_normal_compression + impact_.work_normal_restitution +
                            impact_.work_tangential_compression + impact_.work_tangential_restitution;
  }

  // A contact that jams has the state it has reached, and no coefficients.
  void ConcludeJam() {
    impact_.conditioning = Ball(1.0);
    if (restoring_) {
      impact_.work_normal_restitution = normal_work_;
      impact_.work_tangential_restitution = tangential_work_;
    } else {
      impact_.tau_compression = tau_;
      impact_.f_compression = f_;
      impact_.work_normal_compression = normal_work_;
      impact_.work_tangential_compression = tangential_work_;
    }
    impact_.energy_change = impact_.work_normal_compression + impact_.work_normal_restitution +
                            impact_.work_tangential_compression + impact_.work_tangential_restitution;
  }

  Problem problem_;
  Ball wtt_, wtn_, wnn_, u0_, v0_, mu_, mu_static_, coefficient_;
  bool rank_one_ = false;
  bool in_range_ = false;  // At rank one with Wtt > 0, (u0, v0) lies in the range of W.

  Ball tau_, f_, u_, v_;
  Ball normal_work_, tangential_work_;  // Works of the current phase.
  bool restoring_ = false;
  bool sticks_ = false;
  bool stop_pending_ = false;
  bool stopped_ = false, stopped_in_compression_ = false, stuck_ = false;
  bool locked_ = false;
  bool jammed_ = false;
  ExactImpact impact_;
};

// The error in ulp of the exact value, beyond `allowance`. An infinity stands for a value that rounds to 2^1024.
double Error(double computed, const Ball& exact, const Ball& allowance) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (std::isnan(computed)) return kNever;
  if (std::isinf(computed)) {
    const Ball reached = computed > 0.0 ? exact : -exact;
    return reached >= Ball::PowerOfTwo(1024) - Ball::PowerOfTwo(1024 - 53) ? 0.0 : kNever;
  }
  const Ball wide(0.0, 512);
  const slong exponent = exact.ContainsZero() ? -1074 : std::max<slong>(exact.Exponent() - 53, -1074);
  const Ball error = (Abs(wide + Ball(computed) - exact) - allowance) / Ball::PowerOfTwo(exponent);
  return std::max(0.0, error.UpperBound());
}

// The errors of values that share a scale.
class ErrorOnScale {
 public:
  ErrorOnScale(Ball scale, const Ball& conditioning)
      : scale_(std::move(scale)), allowance_(conditioning * Ball::PowerOfTwo(-94)) {}
  double operator()(double computed, const Ball& exact) const {
    return Error(computed, exact, Larger(Abs(exact), scale_) * allowance_);
  }

 private:
  Ball scale_;
  Ball allowance_;
};

}  // namespace

ExactImpact SolveExactly(const Problem& problem, const ExactContact& contact) {
  return Simulation(problem, contact).Run();
}

ExactImpact SolveExactly(const Problem& problem) {
  const auto ball = [bits = PrecisionFor(problem)](double x) { return Ball(x, bits); };
  return SolveExactly(problem, {.wtt = ball(problem.w.tt),
                                .wtn = ball(problem.w.tn),
                                .wnn = ball(problem.w.nn),
                                .u0 = ball(problem.u0),
                                .v0 = ball(problem.v0)});
}

OutputErrors ErrorsOf(const Problem& problem, const Impact& impact, const ExactImpact& exact) {
  const Ball work_scale = Larger(Larger(-exact.work_normal_compression, exact.work_normal_restitution),
                                 -(exact.work_tangential_compression + exact.work_tangential_restitution));
  const ErrorOnScale velocity(Larger(Abs(Ball(problem.u0)), Abs(Ball(problem.v0))), exact.conditioning);
  const ErrorOnScale normal(exact.end().tau, exact.conditioning);
  const ErrorOnScale friction(exact.steepest_friction * exact.end().tau, exact.conditioning);
  const ErrorOnScale tangential(exact.steepest_friction, exact.conditioning);
  const ErrorOnScale work(work_scale, exact.conditioning);
  const ErrorOnScale coefficient(Ball(1.0), exact.conditioning);
  double tau = 0.0, f = 0.0, u = 0.0, v = 0.0;
  for (size_t i = 1; i < exact.events.size(); ++i) {  // The start is the input.
    const ExactInstant& expected = exact.events[i];
    tau = std::max(tau, normal(impact.events[i].tau, expected.tau));
    f = std::max(f, friction(impact.events[i].f, expected.f));
    u = std::max(u, velocity(impact.events[i].u, expected.u));
    v = std::max(v, velocity(impact.events[i].v, expected.v));
  }
  return {velocity(impact.u1, exact.end().u),
          velocity(impact.v1, exact.end().v),
          normal(impact.tau_compression, exact.tau_compression),
          normal(impact.tau1, exact.end().tau),
          friction(impact.f_compression, exact.f_compression),
          friction(impact.f1, exact.end().f),
          work(impact.work_normal_compression, exact.work_normal_compression),
          work(impact.work_normal_restitution, exact.work_normal_restitution),
          work(impact.work_tangential_compression, exact.work_tangential_compression),
          work(impact.work_tangential_restitution, exact.work_tangential_restitution),
          work(impact.energy_change, exact.energy_change),
          coefficient(impact.newton, exact.newton),
          coefficient(impact.poisson, exact.poisson),
          coefficient(impact.energetic, exact.energetic),
          coefficient(impact.energetic_excess, exact.energetic - 1.0),
          tangential(impact.tangential, SignOf(exact.end().tau) == 0 ? Ball(0.0) : exact.end().f / exact.end().tau),
          tau,
          f,
          u,
          v};
}

std::string ToString(const Problem& problem) {
  std::ostringstream text;
  text << std::hexfloat << "W " << problem.w.tt << " " << problem.w.tn << " " << problem.w.nn << " u0 " << problem.u0
       << " v0 " << problem.v0 << " mu " << problem.mu << " mu_s " << problem.mu_static << " law "
       << static_cast<int>(problem.law) << " c " << problem.coefficient;
  return text.str();
}

}  // namespace ricochet::planar
