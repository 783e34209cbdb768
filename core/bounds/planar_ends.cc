#include "core/bounds/planar_ends.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/contact/delassus.h"

namespace ricochet {
namespace {

Interval Join(const Interval& x, const Interval& y) { return IsEmpty(x) ? y : IsEmpty(y) ? x : Hull(x, y); }

// Returns the hull of a function that is monotone in each argument, from its values at the ends of both.
template <typename Function>
Interval AtVertices(const Interval& x, const Interval& y, Function function) {
  Interval hull = function(Interval(x.lower), Interval(y.lower));
  if (!IsPoint(y)) hull = Hull(hull, function(Interval(x.lower), Interval(y.upper)));
  if (IsPoint(x)) return hull;
  hull = Hull(hull, function(Interval(x.upper), Interval(y.lower)));
  return IsPoint(y) ? hull : Hull(hull, function(Interval(x.upper), Interval(y.upper)));
}

// Returns e of the elastic impact, which grows with rho and is monotone in sigma^2.
Interval NewtonOf(const Interval& sigma_size, const Interval& rho) {
  const auto newton = [](const Interval& sigma, const Interval& r) {
    const Interval square = Square(sigma);
    return Sqrt(square + r * (Interval(1.0) - square));
  };
  if (!std::isinf(rho.upper)) return AtVertices(sigma_size, rho, newton);
  return {AtVertices(sigma_size, Interval(rho.lower), newton).lower, rounding::kInfinity};
}

// Returns k for slip that stops in restitution. k falls with rho, towards sigma, and is monotone in sigma.
Interval PoissonInRestitution(const Interval& sigma, const Interval& rho) {
  const auto poisson = [](const Interval& s, const Interval& r) {
    const Interval e = NewtonOf(s, r);
    return (Interval(1.0) + s * e) / (s + e);
  };
  if (!std::isinf(rho.upper)) return AtVertices(sigma, rho, poisson);
  return {sigma.lower, AtVertices(sigma, Interval(rho.lower), poisson).upper};
}

// Returns k for slip that stops in compression. k is monotone in m. In rho it grows up to rho = m/(1 + m), where it is
// (1 + m)/(2 sqrt(m)), and then falls towards 0.
Interval PoissonInCompression(const Interval& m, const Interval& rho) {
  const Interval one(1.0);
  const auto poisson = [&](const Interval& x, const Interval& r) { return NewtonOf(x, r) / (r * (one - x) + x); };
  Interval range = std::isinf(rho.upper) ? Hull(Interval(0.0), AtVertices(m, Interval(rho.lower), poisson))
                                         : AtVertices(m, rho, poisson);
  for (const double end : {m.lower, m.upper}) {
    const Interval peak = Interval(end) / (one + Interval(end));
    if (IsEmpty(Intersect(peak, rho))) continue;
    range.upper = std::max(range.upper, ((one + Interval(end)) / (Interval(2.0) * Sqrt(Interval(end)))).upper);
  }
  return range;
}

// Returns x/(x + y) for x, y >= 0.
Interval Share(const Interval& x, const Interval& y) {
  if (x.upper == 0.0 && y.lower > 0.0) return 0.0;
  return AtMost(AtLeast(Interval(1.0) / (Interval(1.0) + AtLeast(y / x, 0.0)), 0.0), 1.0);
}

// Returns tau_s/tau_e for slip that stops in restitution: (sigma + e)/(1 + e), which grows with sigma and with e.
Interval ShareInRestitution(const Interval& sigma, const Interval& rho) {
  const auto share = [](const Interval& s, const Interval& r) {
    const Interval e = NewtonOf(s, r);
    return (s + e) / (Interval(1.0) + e);
  };
  if (!std::isinf(rho.upper)) return AtMost(AtVertices(sigma, rho, share), 1.0);
  return {AtVertices(sigma, Interval(rho.lower), share).lower, 1.0};
}

// Returns e for slip that stops in compression: sqrt(h (1 + m) + m^2).
Interval NewtonInCompression(const Interval& h, const Interval& m) { return Sqrt(h * (Interval(1.0) + m) + Square(m)); }

// The scenes of a box whose slip starts in one direction, towards +t or, if `backwards`, towards -t. Tangential numbers
// are stated along that direction.
class OneSlipDirection {
 public:
  OneSlipDirection(const PlanarBox& box, bool backwards, PlanarEnds& ends)
      : backwards_(backwards),
        wtt_(AtLeast(box.wtt, 0.0)),
        wnn_(AtLeast(box.wnn, 0.0)),
        slip_(AtLeast(backwards ? -box.u0 : box.u0, 0.0)),
        speed_(AtLeast(-box.v0, 0.0)),
        mu_(box.mu),
        own_static_(box.mu_static.has_value()),
        mu_static_(AtLeast(box.mu_static.value_or(box.mu), box.mu.lower)),
        stick_slope_(box.stick_slope),
        ends_(ends) {}

  // Adds scenes with q >= 0, in which Wtn drives slip on and the contact in.
  void AddDriving(const Interval& q) {
    if (wtt_.upper == 0.0) return AddSliding(wnn_);
    const Interval first = wnn_ - mu_ * q;
    // At rank one slip grows while v rises, and any other scene jams.
    if (MayHaveRankOne(q)) AddSliding(first);
    if (!MayHaveRankTwo(q) && wtt_.lower > 0.0) return;
    const Interval braking = mu_ * wtt_ - q;
    const Interval stuck = StuckSlope(q);
    if (IsEmpty(stuck)) return;
    // A scene with B <= 0 has A1 >= det W/Wtt.
    if (braking.lower <= 0.0) AddSliding(AtLeast(first, stuck.lower));
    if (braking.upper > 0.0) {
      AddStop({q, first, AtLeast(braking, 0.0), stuck, StuckRatio(q, first, braking), true}, slip_);
    }
    if (own_static_ && braking.lower <= 0.0) AddHeld(q, stuck);
  }

  // Adds scenes with q = -r <= 0, in which Wtn brakes slip.
  void AddOpposing(const Interval& r) {
    if (wtt_.upper == 0.0) return;
    if (MayHaveRankOne(r)) AddRankOne(r);
    if (MayHaveRankTwo(r)) AddStopAgainst(r);
  }

 private:
  struct Stop {
    Interval q;
    Interval first;    // A1
    Interval braking;  // B, >= 0
    Interval second;   // A2, >= 0
    Interval rho;      // A2/A1 for the scenes with A1 > 0
    bool sticks;
  };

  Interval RankTolerance() const { return Interval(kRankTolerance) * (wtt_ * wnn_); }

  Interval Determinant(const Interval& q) const {
    const Interval plain = wtt_ * wnn_ - Square(q);
    return stick_slope_ ? Both(plain, wtt_ * *stick_slope_) : plain;
  }

  bool MayHaveRankOne(const Interval& q) const {
    const Interval determinant = Determinant(q);
    const double tolerance = RankTolerance().upper;
    return determinant.lower <= tolerance && determinant.upper >= -tolerance;
  }
  bool MayHaveRankTwo(const Interval& q) const { return Determinant(q).upper > RankTolerance().lower; }

  // Returns C = Wnn - q^2/Wtt, the slope of v while the contact sticks.
  Interval StuckSlope(const Interval& q) const {
    const Interval plain = AtMost(AtLeast(wnn_ - Square(q) / wtt_, 0.0), wnn_.upper);
    return stick_slope_ ? Both(plain, AtLeast(*stick_slope_, 0.0)) : plain;
  }

  // Returns A1/B, which is monotone in each of its four parameters. It grows with Wnn and, if A1 > 0, falls with Wtt.
  Interval FirstOverBraking(const Stop& stop) const {
    const Interval plain = stop.first / stop.braking;
    if (stop.first.lower <= 0.0 || stop.braking.lower <= 0.0) return plain;
    const auto corner = [&](double wnn, double wtt) {
      return AtVertices(mu_, stop.q, [&](const Interval& mu, const Interval& q) {
        return (Interval(wnn) - mu * q) / (mu * Interval(wtt) - q);
      });
    };
    return Both(plain, {corner(wnn_.lower, wtt_.upper).lower, corner(wnn_.upper, wtt_.lower).upper});
  }

  // Returns C/A1 = 1 + (q/Wtt)(B/A1).
  Interval StuckRatio(const Interval& q, const Interval& first, const Interval& braking) const {
    const Interval slope = AtLeast(first, 0.0);
    if (IsEmpty(slope)) return {0.0, rounding::kInfinity};
    const Interval plain = AtLeast(StuckSlope(q) / slope, 0.0);
    const Interval other = Interval(1.0) + q / wtt_ * (AtLeast(braking, 0.0) / slope);
    return Both(plain, AtLeast(other, 0.0));
  }

  // Returns (1 - c)/(1 + c) with c = mu r/Wnn < 1.
  Interval ReversedRatio(const Interval& r) const {
    const Interval c = AtMost(mu_ * r / wnn_, 1.0);
    const auto ratio = [](double end) { return (Interval(1.0) - Interval(end)) / (Interval(1.0) + Interval(end)); };
    return AtLeast(Hull(ratio(c.upper), ratio(c.lower)), 0.0);
  }

  Interval Along(const Interval& x) const { return backwards_ ? -x : x; }

  void Add(const Interval& newton, const Interval& poisson, double energetic, const Interval& tangential_plastic,
           const Interval& tangential_elastic, const Interval& normal_plastic, const Interval& normal_elastic) {
    ends_.newton = Join(ends_.newton, newton);
    ends_.poisson = Join(ends_.poisson, poisson);
    ends_.energetic = Join(ends_.energetic, energetic);
    ends_.tangential_plastic = Join(ends_.tangential_plastic, Along(tangential_plastic));
    ends_.tangential_elastic = Join(ends_.tangential_elastic, Along(tangential_elastic));
    ends_.normal_plastic = Join(ends_.normal_plastic, normal_plastic);
    ends_.normal_elastic = Join(ends_.normal_elastic, normal_elastic);
  }

  // Adds scenes with q = -r <= 0 in which slip stops, unless restitution ends before.
  void AddStopAgainst(const Interval& r) {
    const Interval first = wnn_ + mu_ * r;
    const Interval braking = mu_ * wtt_ + r;
    const Interval stuck = StuckSlope(r);
    if (IsEmpty(stuck)) return;
    const Interval hold = mu_static_ * wtt_ - r;
    if (braking.lower <= 0.0) AddSliding(first);
    if (hold.upper >= 0.0) AddStop({-r, first, braking, stuck, StuckRatio(-r, first, braking), true}, slip_);
    if (hold.lower < 0.0) {
      // Slip reverses only if mu r < r^2/Wtt.
      const Interval second = AtLeast(wnn_ - mu_ * r, stuck.lower);
      if (!IsEmpty(second)) AddStop({-r, first, braking, second, ReversedRatio(r), false}, slip_);
    }
  }

  // Adds scenes with u0 = 0 in which static friction holds a slip that kinetic friction could not stop:
  // mu Wtt <= q <= mu_s Wtt.
  void AddHeld(const Interval& q, const Interval& stuck) {
    if (slip_.lower > 0.0 || (mu_static_ * wtt_ - q).upper < 0.0) return;
    const Interval unknown(0.0, rounding::kInfinity);
    AddStop({q, unknown, unknown, stuck, unknown, true}, 0.0);
  }

  // Adds scenes in which slip does not stop.
  void AddSliding(const Interval& slope) {
    if (IsEmpty(slope) || slope.upper <= 0.0) return;
    const Interval compression = speed_ / AtLeast(slope, 0.0);
    // A contact that rests along t and that no impulse moves there needs no friction.
    const bool may_idle = wtt_.lower == 0.0 && slip_.lower == 0.0;
    const bool idles = wtt_.upper == 0.0 && slip_.upper == 0.0;
    Interval friction = -mu_;
    if (may_idle) friction = Hull(friction, 0.0);
    if (idles) friction = 0.0;
    Add(1.0, 1.0, 1.0, friction, friction, compression, Interval(2.0) * compression);
  }

  // Adds scenes with q = -r <= 0 whose W has rank one. W then counts as Wnn (g, 1)(g, 1)^T whatever Wtt says.
  void AddRankOne(const Interval& r) {
    const Interval tangential = slip_ * wnn_;
    const Interval normal = speed_ * r;
    const Interval off = tangential - normal;
    const Interval tolerance = Interval(kRangeTolerance) * (tangential + normal);
    if (off.lower <= tolerance.upper && off.upper >= -tolerance.upper) AddInRange(r);
    if (off.lower < -tolerance.lower || off.upper > tolerance.lower) AddBesideRange(r);
  }

  // Adds scenes of rank one whose (u0, v0) lies in the range of W, where slip stops as compression ends.
  void AddInRange(const Interval& r) {
    const Interval first = wnn_ + mu_ * r;
    const Interval compression = speed_ / first;
    const Interval held = mu_static_ * r - wnn_;
    if (held.upper >= 0.0) Add(0.0, 0.0, 0.0, -mu_, -mu_, compression, compression);
    if (held.lower >= 0.0) return;
    const Interval newton = Sqrt(ReversedRatio(r));
    const Interval poisson = Interval(1.0) / newton;
    const Interval total = compression + speed_ / Sqrt(first * AtLeast(wnn_ - mu_ * r, 0.0));
    const Interval elastic = mu_ * (Interval(1.0) - Interval(2.0) / (Interval(1.0) + poisson));
    Add(newton, poisson, 1.0, -mu_, elastic, compression, total);
  }

  // Adds scenes of rank one whose (u0, v0) lies beside the range of W: those of rank two with Wtt = r^2/Wnn and C = 0.
  void AddBesideRange(const Interval& r) {
    OneSlipDirection beside = *this;
    beside.wtt_ = AtLeast(Square(r) / wnn_, 0.0);
    beside.stick_slope_ = Interval(0.0);
    beside.AddStopAgainst(r);
  }

  void AddStop(const Stop& stop, const Interval& slip) {
    const Interval ratio = AtLeast(slip / speed_, 0.0);
    const Interval over = FirstOverBraking(stop);
    const Interval stop_ratio = over * ratio;  // 1 + sigma
    // Slip that stops in restitution has 1 + sigma = (A1/B)(p/w) >= 1, so A1 >= B w/p.
    const Interval least = AtLeast(stop.braking / ratio, 0.0);
    if (stop_ratio.upper >= 2.0) AddSliding(AtLeast(stop.first, (Interval(2.0) * least).lower));
    if (stop_ratio.upper >= 1.0 && stop_ratio.lower <= 2.0) {
      Stop in_restitution = stop;
      in_restitution.first = AtLeast(stop.first, least.lower);
      in_restitution.rho = Both(stop.rho, AtLeast(in_restitution.second / in_restitution.first, 0.0));
      if (!IsEmpty(in_restitution.first)) AddStopInRestitution(in_restitution, Intersect(stop_ratio, {1.0, 2.0}));
    }
    // A contact that sticks in compression and whose v does not rise then jams.
    if (stop_ratio.lower < 1.0 && stop.second.upper > 0.0)
      AddStopInCompression(stop, slip, ratio, AtMost(stop_ratio, 1.0));
  }

  void AddStopInRestitution(const Stop& stop, const Interval& stop_ratio) {
    const Interval one(1.0);
    const Interval sigma = AtMost(AtLeast(stop_ratio - one, 0.0), 1.0);
    const Interval compression = speed_ / stop.first;
    const Interval newton = NewtonOf(sigma, stop.rho);
    const Interval poisson = PoissonInRestitution(sigma, stop.rho);
    const Interval share = ShareInRestitution(sigma, stop.rho);
    Add(newton, poisson, 1.0, -mu_, Blend(stop, share), compression, (one + poisson) * compression);
  }

  // Adds scenes in which slip stops in compression. With h = A2 tau_s/w and m = -sigma, A2 tau_c/w = h + m and
  // e^2 = h (1 + m) + m^2, whatever the sign of A1.
  void AddStopInCompression(const Stop& stop, const Interval& slip, const Interval& ratio, const Interval& stop_ratio) {
    const Interval one(1.0);
    const Interval m = AtLeast(one - stop_ratio, 0.0);
    const bool never_jams = stop.first.lower > 0.0;
    Interval stop_impulse = AtLeast(ratio / stop.braking, 0.0);  // tau_s/w
    if (never_jams) stop_impulse = Both(stop_impulse, AtLeast(stop_ratio, 0.0) / stop.first);
    Interval h = stop.second * stop_impulse;
    if (never_jams) h = Both(h, stop.rho * AtLeast(one - m, 0.0));
    Interval compression_end = h + m;  // A2 tau_c/w
    // If compression ends in stick, u = v = 0 there, and W^-1 gives the impulse.
    if (stop.sticks) compression_end = Both(compression_end, AtLeast(one + stop.q / wtt_ * ratio, 0.0));
    Interval newton = AtVertices(h, m, NewtonInCompression);
    Interval poisson = newton / compression_end;
    Interval compression = AtLeast(speed_ * compression_end / stop.second, 0.0);
    if (stop.sticks) compression = Both(compression, AtLeast((speed_ + stop.q / wtt_ * slip) / stop.second, 0.0));
    // Both shares fall with m and grow with h.
    Interval plastic_share = AtVertices(h, m, Share);
    const auto share = [](const Interval& x, const Interval& y) { return Share(x, y + NewtonInCompression(x, y)); };
    Interval elastic_share = AtVertices(h, m, share);
    if (never_jams) {
      newton = Both(newton, NewtonOf(m, stop.rho));
      poisson = Both(poisson, PoissonInCompression(m, stop.rho));
      compression = Both(compression, speed_ / stop.first * (one + m * (one / stop.rho - one)));
      if (!std::isinf(stop.rho.upper)) {
        plastic_share = Both(plastic_share, AtVertices(stop.rho, m, [&](const Interval& r, const Interval& x) {
                               return Share(r * (one - x), x);
                             }));
        elastic_share = Both(elastic_share, AtVertices(stop.rho, m, [&](const Interval& r, const Interval& x) {
                               return share(r * (one - x), x);
                             }));
      }
    }
    const Interval total = Both(compression * (one + poisson), compression + speed_ * newton / stop.second);
    Interval plastic = Blend(stop, plastic_share);
    Interval elastic = Blend(stop, elastic_share);
    if (stop.sticks) {
      plastic = Both(plastic, -((stop.q + slip / compression) / wtt_));
      elastic = Both(elastic, -((stop.q + slip / total) / wtt_));
    }
    Add(newton, poisson, 1.0, plastic, elastic, compression, total);
  }

  // Returns f/tau if slip has taken the share `share` of tau.
  Interval Blend(const Stop& stop, const Interval& share) const {
    if (!stop.sticks) return mu_ * (Interval(1.0) - Interval(2.0) * share);
    const Interval hold = Intersect(stop.q / wtt_, {-mu_static_.upper, mu_static_.upper});
    return -AtVertices(share, mu_, [&](const Interval& part, const Interval& mu) {
      return hold * (Interval(1.0) - part) + mu * part;
    });
  }

  bool backwards_;
  Interval wtt_, wnn_, slip_, speed_, mu_;
  bool own_static_;
  Interval mu_static_;
  std::optional<Interval> stick_slope_;
  PlanarEnds& ends_;
};

}  // namespace

PlanarEnds EncloseEnds(const PlanarBox& box) {
  PlanarEnds ends;
  if (IsEmpty(box.mu) || (box.mu_static && box.mu_static->upper < box.mu.lower)) return ends;
  if (box.v0.upper >= 0.0) ends.normal_plastic = ends.normal_elastic = 0.0;
  if (box.v0.lower >= 0.0) return ends;
  for (const bool backwards : {false, true}) {
    // u0 = 0 goes with the slip towards +t, because both directions have the same limit.
    const bool occurs = backwards ? box.u0.lower < 0.0 : box.u0.upper >= 0.0;
    if (!occurs) continue;
    const Interval q = backwards ? -box.wtn : box.wtn;
    OneSlipDirection direction(box, backwards, ends);
    if (q.upper >= 0.0) direction.AddDriving(AtLeast(q, 0.0));
    if (q.lower < 0.0) direction.AddOpposing(AtLeast(-q, 0.0));
  }
  return ends;
}

}  // namespace ricochet
