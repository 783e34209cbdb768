// ContactPath: the path of a planar impact over a number type N that proves its branches. N is Surd, which decides
// every branch, or ArfInterval.
//
// core/models/planar/planar.h has the equations and regimes, and docs/theory/certified.md says why this path stands
// apart from the kernel of that model. A path has at most two pieces, on which u, v and f are linear in tau: the slip
// at the start, and what follows where slip stops. On a piece with slopes (f', u', v') the sums are
//   twice the work      step (v + v_new) for the normal and f' step (u + u_new) for the tangential impulse
//   v_new^2 - v^2       2 v' times the normal work, so energetic restitution ends at a square root
//   E_new - E           p step + P step^2/2 with p = f' u + v and P = f' u' + v'
// If W has rank one, u = rho v with rho = Wtn/Wnn all along the path, so slip stops exactly where v = 0.
// Units are those of core/models/planar/planar.h. Results are exact for Surd and enclosed for ArfInterval. An N that is
// not set is 0.

#ifndef RICOCHET_CORE_CERTIFIED_CONTACT_PATH_H_
#define RICOCHET_CORE_CERTIFIED_CONTACT_PATH_H_

#include "core/certified/branches.h"
#include "core/models/restitution_law.h"
#include "ricochet/regime.h"

namespace ricochet::certified {

template <typename N>
struct Contact {
  N wtt, wtn, wnn;
  N det;                  // det W, which is not below 0.
  bool rank_one = false;  // The system makes det W = 0, or it is so exactly.
  N rho;                  // Wtn/Wnn
  N u0, v0;               // They lie in the range of W.
  N mu, mu_static;
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  N coefficient;
};

// A number, or its square if the number is a root that N may not hold.
template <typename N>
struct Number {
  N value;
  bool is_square = false;
};

template <typename N>
struct Impact {
  Regime regime = Regime::kUnspecified;
  N newton, poisson, tangential;
  Number<N> energetic;
  N u1, v1;
  N tau_compression, tau1, f1;
  // Works, J.
  N normal_compression, normal_restitution, tangential_compression, tangential_restitution;
  N normal_total;
};

// The point of the path, beyond the end of the elastic impact, at which the kinetic energy is what it was before.
template <typename N>
struct EnergyEnd {
  N newton, poisson, tangential, tau;
  Number<N> energetic;
};

template <typename N>
class ContactPath {
 public:
  // The contact must approach: v0 < 0.
  ContactPath(const Contact<N>& contact, Branches& branches) : contact_(contact), branches_(branches) {
    if (contact.rank_one) {
      FollowRankOne();
    } else {
      FollowFullRank();
    }
    Compress();
  }

  bool locked() const { return locked_; }

  // Solves the whole impact, with restitution by `law`.
  Impact<N> Solve(RestitutionLaw law, const N& coefficient) {
    End end = {.at = compression_end_};
    const bool has_restitution = !locked_ && IsPositive(coefficient, branches_);
    if (has_restitution) {
      end = Restitute(law, coefficient);
    } else if (!locked_ && StopIsAhead()) {
      end.passes_stop = !IsPositive(v_stop_, branches_);
    }
    Impact<N> impact = Describe(end);
    if (has_restitution) SetCoefficients(law, coefficient, end, impact);
    return impact;
  }

  EnergyEnd<N> FindEnergyEnd() {
    const N half(0.5);
    Point at = compression_end_;
    N energy = half * (compression_normal_ + compression_tangential_);
    N work(0.0);
    Piece piece = Current();
    if (StopIsAhead()) {
      const N step = v_stop_ / piece.v;
      const N at_stop = energy + half * step * (piece.f * at.u + (at.v + v_stop_));
      if (IsNegative(at_stop, branches_)) {
        work = half * step * (at.v + v_stop_);
        energy = at_stop;
        at = {at.tau + step, at.f + piece.f * step, N(0.0), v_stop_};
        piece = second_;
      }
    }
    const N power = piece.f * at.u + at.v;
    const N slope = piece.f * piece.u + piece.v;
    const N step = (Sqrt(AtLeastZero(Square(power) - N(2.0) * slope * AtMostZero(energy))) - power) / slope;
    const N v = at.v + piece.v * step;
    work = work + half * step * (at.v + v);
    const N tau = at.tau + step;
    return {.newton = v / -contact_.v0,
            .poisson = (tau - compression_end_.tau) / compression_end_.tau,
            .tangential = (at.f + piece.f * step) / tau,
            .tau = tau,
            .energetic = {work / (-half * compression_normal_), true}};
  }

 private:
  struct Piece {
    N f, u, v;
  };
  struct Point {
    N tau, f, u, v;
  };
  struct End {
    Point at;
    N normal_twice, tangential_twice;  // Twice the works of restitution.
    bool passes_stop = false;
  };

  static N Signed(const N& x, bool negative) { return negative ? -x : x; }

  Piece Slip(const N& f) const { return {f, contact_.wtn + f * contact_.wtt, contact_.wnn + f * contact_.wtn}; }

  void FollowFullRank() {
    const N& wtn = contact_.wtn;
    v_stop_ = contact_.v0;
    const bool backwards = IsNegative(contact_.u0, branches_);
    slips_first_ = backwards || IsPositive(contact_.u0, branches_);
    stops_ = true;
    if (slips_first_) {
      contact_.u0 = backwards ? N(AtMostZero(contact_.u0)) : N(AtLeastZero(contact_.u0));
      first_ = Slip(Signed(contact_.mu, !backwards));
      stops_ = IsNegative(Signed(first_.u, backwards), branches_);
      if (stops_) {
        first_.u = Signed(N(AtMostZero(Signed(first_.u, backwards))), backwards);
        v_stop_ = contact_.v0 - contact_.u0 * first_.v / first_.u;
      }
    }
    if (!stops_) return;
    sticks_ = !IsNegative(contact_.mu_static * contact_.wtt - Abs(wtn), branches_);
    if (sticks_) {
      second_ = {-wtn / contact_.wtt, N(0.0), AtLeastZero(contact_.det) / contact_.wtt};
    } else {
      second_ = Slip(Signed(contact_.mu, !IsNegative(wtn, branches_)));
    }
  }

  void FollowRankOne() {
    const N& rho = contact_.rho;
    slips_first_ = true;
    const bool backwards = IsPositive(rho, branches_);
    stops_ = backwards || IsNegative(rho, branches_);
    if (!stops_) {
      first_ = {N(0.0), N(0.0), contact_.wnn};
      return;
    }
    const auto slope = [&](bool slips_back) {
      const N f = Signed(contact_.mu, !slips_back);
      const N v = contact_.wnn * (N(1.0) + f * rho);
      return Piece{f, rho * v, v};
    };
    v_stop_ = N(0.0);
    first_ = slope(backwards);
    second_ = slope(!backwards);
    sticks_ = locked_ = !IsNegative(contact_.mu_static * Abs(rho) - N(1.0), branches_);
  }

  void Advance(const Piece& piece, const N& step, const N& u, const N& v, Point& at, N& normal, N& tangential) const {
    const N f_step = piece.f * step;
    normal = normal + step * (at.v + v);
    tangential = tangential + f_step * (at.u + u);
    at = {at.tau + step, at.f + f_step, u, v};
  }

  void Compress() {
    const N zero(0.0);
    Point at = {zero, zero, contact_.u0, contact_.v0};
    compression_normal_ = compression_tangential_ = zero;
    stops_in_compression_ = stops_ && IsNegative(v_stop_, branches_);
    if (stops_in_compression_) {
      if (slips_first_) {
        v_stop_ = AtMostZero(v_stop_);
        Advance(first_, -contact_.u0 / first_.u, zero, v_stop_, at, compression_normal_, compression_tangential_);
      }
      const N step = -v_stop_ / second_.v;
      Advance(second_, step, second_.u * step, zero, at, compression_normal_, compression_tangential_);
    } else {
      const N step = -contact_.v0 / first_.v;
      // If W has rank one, slip stops together with v.
      const N u = stops_ && contact_.rank_one ? zero : contact_.u0 + first_.u * step;
      Advance(first_, step, u, zero, at, compression_normal_, compression_tangential_);
    }
    compression_end_ = at;
  }

  bool StopIsAhead() const { return stops_ && !stops_in_compression_; }
  const Piece& Current() const { return stops_in_compression_ ? second_ : first_; }

  // Steps holds the impulses of restitution before and after the stop of slip, and the v at the end.
  struct Steps {
    bool passes_stop;
    N before, after, v1;
  };

  Steps OnOnePiece(const N& step, const N& v1) const { return {false, step, N(0.0), v1}; }

  Steps ByNewton(const N& e) {
    const N& slope = Current().v;
    const N v1 = e * -contact_.v0;
    if (!StopIsAhead() || IsNegative(v1 - v_stop_, branches_)) return OnOnePiece(v1 / slope, v1);
    return {true, v_stop_ / slope, AtLeastZero(v1 - v_stop_) / second_.v, v1};
  }

  Steps ByPoisson(const N& kappa) {
    const N& slope = Current().v;
    const N step = kappa * compression_end_.tau;
    if (!StopIsAhead()) return OnOnePiece(step, slope * step);
    const N before = v_stop_ / slope;
    const N after = step - before;
    if (IsNegative(after, branches_)) return OnOnePiece(step, slope * step);
    return {true, before, AtLeastZero(after), v_stop_ + second_.v * AtLeastZero(after)};
  }

  Steps ByEnergy(const N& eta) {
    const N& slope = Current().v;
    const N work = Square(eta) * -compression_normal_;
    if (StopIsAhead()) {
      const N before = v_stop_ / slope;
      const N beyond = work - v_stop_ * before;
      if (!IsNegative(beyond, branches_)) {
        const N v1 = Sqrt(Square(v_stop_) + second_.v * AtLeastZero(beyond));
        return {true, before, (v1 - v_stop_) / second_.v, v1};
      }
    }
    const N v1 = Sqrt(slope * work);
    return OnOnePiece(v1 / slope, v1);
  }

  Steps FindSteps(RestitutionLaw law, const N& coefficient) {
    switch (law) {
      case RestitutionLaw::kNewton:
        return ByNewton(coefficient);
      case RestitutionLaw::kPoisson:
        return ByPoisson(coefficient);
      case RestitutionLaw::kEnergetic:
        break;
    }
    return ByEnergy(coefficient);
  }

  End Restitute(RestitutionLaw law, const N& coefficient) {
    const Steps steps = FindSteps(law, coefficient);
    End end = {.at = compression_end_, .passes_stop = steps.passes_stop};
    const auto advance = [&](const Piece& piece, const N& step, const N& u, const N& v) {
      Advance(piece, step, u, v, end.at, end.normal_twice, end.tangential_twice);
    };
    if (steps.passes_stop) {
      advance(Current(), steps.before, N(0.0), v_stop_);
      advance(second_, steps.after, second_.u * steps.after, steps.v1);
    } else {
      advance(Current(), steps.before, compression_end_.u + Current().u * steps.before, steps.v1);
    }
    return end;
  }

  Regime RegimeOf(bool stops_in_restitution) {
    if (locked_) return Regime::kLocked;
    const bool stopped = stops_in_compression_ || stops_in_restitution;
    const bool smooth = !IsPositive(contact_.mu_static, branches_) || !IsPositive(contact_.wtt, branches_);
    if (smooth || (!(stopped && sticks_) && !IsPositive(contact_.mu, branches_))) return Regime::kFrictionless;
    if (!stopped || !(slips_first_ || sticks_)) return Regime::kSliding;
    if (stops_in_compression_) return sticks_ ? Regime::kStickInCompression : Regime::kReversalInCompression;
    return sticks_ ? Regime::kStickInRestitution : Regime::kReversalInRestitution;
  }

  // Gives all numbers but the coefficients of restitution, which are 0.
  Impact<N> Describe(const End& end) {
    const N half(0.5);
    return {.regime = RegimeOf(end.passes_stop),
            .tangential = end.at.f / end.at.tau,
            .u1 = end.at.u,
            .v1 = end.at.v,
            .tau_compression = compression_end_.tau,
            .tau1 = end.at.tau,
            .f1 = end.at.f,
            .normal_compression = half * compression_normal_,
            .normal_restitution = half * end.normal_twice,
            .tangential_compression = half * compression_tangential_,
            .tangential_restitution = half * end.tangential_twice,
            .normal_total = half * (compression_normal_ + end.normal_twice)};
  }

  // A coefficient that the law states is copied, because an interval would only blur it. If v' is the same throughout,
  // all laws agree.
  void SetCoefficients(RestitutionLaw law, const N& coefficient, const End& end, Impact<N>& impact) const {
    const bool one_piece =
        impact.regime == Regime::kFrictionless || (!end.passes_stop && !(stops_in_compression_ && slips_first_));
    impact.newton = one_piece || law == RestitutionLaw::kNewton ? coefficient : end.at.v / -contact_.v0;
    impact.poisson = one_piece || law == RestitutionLaw::kPoisson
                         ? coefficient
                         : (end.at.tau - compression_end_.tau) / compression_end_.tau;
    if (one_piece || law == RestitutionLaw::kEnergetic) {
      const N square = Square(coefficient);
      impact.energetic = {coefficient, false};
      impact.normal_restitution = -square * impact.normal_compression;
      impact.normal_total = impact.normal_compression * (N(1.0) - square);
    } else {
      impact.energetic = {end.normal_twice / -compression_normal_, true};
    }
  }

  Contact<N> contact_;
  Branches& branches_;
  Piece first_;   // The slip at the start; not set if u0 = 0.
  Piece second_;  // The piece after slip has stopped; not set if it never does.
  bool slips_first_ = false;
  bool stops_ = false;  // Slip comes to a stop if the impact lasts long enough; true if u0 = 0.
  bool sticks_ = false;
  bool locked_ = false;
  bool stops_in_compression_ = false;
  N v_stop_;  // v at the point where slip stops.
  Point compression_end_;
  N compression_normal_, compression_tangential_;  // Twice the works.
};

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_CONTACT_PATH_H_
