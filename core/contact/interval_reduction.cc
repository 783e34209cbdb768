#include "core/contact/interval_reduction.h"

#include <cstddef>
#include <vector>

#include "core/contact/mechanism.h"
#include "core/numerics/interval_elementary.h"

namespace ricochet {
namespace {

const Interval kNone = {rounding::kInfinity, -rounding::kInfinity};

// Makes a parameter of each number that lies between those of two structs of one kind.
template <typename T>
auto ParametersBetween(const T& low, const T& high, SlopeParameters& parameters) {
  return [&](double T::*number) { return AffineInterval::Parameter({low.*number, high.*number}, parameters); };
}

// --- Free bodies ---

struct AffineBody {
  AffineInterval mass, inertia, t, n, velocity_t, velocity_n, rate;
};

AffineBody Between(const PlanarBody& low, const PlanarBody& high, SlopeParameters& parameters) {
  const auto between = ParametersBetween(low, high, parameters);
  return {.mass = between(&PlanarBody::mass_kg),
          .inertia = between(&PlanarBody::inertia_com_kg_m2),
          .t = between(&PlanarBody::offset_t_m),
          .n = between(&PlanarBody::offset_n_m),
          .velocity_t = between(&PlanarBody::velocity_t_m_s),
          .velocity_n = between(&PlanarBody::velocity_n_m_s),
          .rate = between(&PlanarBody::rate_rad_s)};
}

AffineInterval SlipOf(const AffineBody& body) { return body.velocity_t - body.rate * body.n; }
AffineInterval SpeedOf(const AffineBody& body) { return body.velocity_n + body.rate * body.t; }

AffineContact Contact(const AffineBody& body) {
  const AffineInterval inverse_mass = AffineInterval(1.0) / body.mass;
  const AffineInterval t2 = Square(body.t);
  const AffineInterval n2 = Square(body.n);
  return {.wtt = inverse_mass + n2 / body.inertia,
          .wtn = -(body.t * body.n / body.inertia),
          .wnn = inverse_mass + t2 / body.inertia,
          .stick_slope = inverse_mass + t2 / (body.inertia + body.mass * n2),
          .u0 = SlipOf(body),
          .v0 = SpeedOf(body)};
}

AffineContact Contact(const AffineBody& one, const AffineBody& two) {
  const AffineInterval inverse_mass = AffineInterval(1.0) / one.mass + AffineInterval(1.0) / two.mass;
  const AffineInterval tt = Square(one.n) / one.inertia + Square(two.n) / two.inertia;
  const AffineInterval nn = Square(one.t) / one.inertia + Square(two.t) / two.inertia;
  const AffineInterval cross = Square(one.n * two.t - one.t * two.n) / (one.inertia * two.inertia);
  return {.wtt = inverse_mass + tt,
          .wtn = -(one.t * one.n / one.inertia + two.t * two.n / two.inertia),
          .wnn = inverse_mass + nn,
          .stick_slope = inverse_mass + nn / (AffineInterval(1.0) + tt / inverse_mass) + cross / (inverse_mass + tt),
          .u0 = SlipOf(one) - SlipOf(two),
          .v0 = SpeedOf(one) - SpeedOf(two)};
}

// --- Linkages and mechanisms ---

struct AffineLink {
  AffineInterval length, mass, com, inertia, theta, rate;
};

std::vector<AffineLink> Between(const Linkage& low, const Linkage& high, SlopeParameters& parameters) {
  std::vector<AffineLink> links;
  for (size_t i = 0; i < low.links.size(); ++i) {
    const auto between = ParametersBetween(low.links[i], high.links[i], parameters);
    links.push_back({.length = between(&Link::length_m),
                     .mass = between(&Link::mass_kg),
                     .com = between(&Link::com_m),
                     .inertia = between(&Link::inertia_com_kg_m2),
                     .theta = between(&Link::theta_rad),
                     .rate = between(&Link::rate_rad_s)});
  }
  return links;
}

using Row = std::vector<AffineInterval>;

// Returns the lower triangle; MassMatrix in core/contact/linkage_matrices.h has the formula.
std::vector<Row> MassMatrix(const std::vector<AffineLink>& links) {
  std::vector<Row> mass(links.size());
  AffineInterval outer_mass(0.0);
  for (size_t k = links.size(); k-- > 0;) {
    const AffineLink& link = links[k];
    const AffineInterval moment = link.mass * link.com + outer_mass * link.length;
    for (size_t i = 0; i < k; ++i) {
      mass[k].push_back(moment * links[i].length * Cos(links[i].theta - link.theta));
    }
    mass[k].push_back(link.inertia + link.mass * Square(link.com) + outer_mass * Square(link.length));
    outer_mass = outer_mass + link.mass;
  }
  return mass;
}

// The lower triangle of M, the rows of J^T and the contact velocity.
struct AffineMechanism {
  std::vector<Row> mass;
  Row t, n;
  AffineInterval u0 = AffineInterval(0.0), v0 = AffineInterval(0.0);
};

AffineMechanism AffineMechanismOf(const std::vector<AffineLink>& links) {
  AffineMechanism chain = {.mass = MassMatrix(links)};
  for (const AffineLink& link : links) {
    chain.t.push_back(link.length * Cos(link.theta));
    chain.n.push_back(link.length * Sin(link.theta));
    chain.u0 = chain.u0 + chain.t.back() * link.rate;
    chain.v0 = chain.v0 + chain.n.back() * link.rate;
  }
  return chain;
}

// The free coordinates of a mechanism. Those that are held move the contact by their rates alone.
AffineMechanism Between(const Mechanism& low, const Mechanism& high, SlopeParameters& parameters) {
  const size_t size = low.rates.size();
  const auto between = [&](std::vector<double> Mechanism::*list, size_t i) {
    return AffineInterval::Parameter({(low.*list)[i], (high.*list)[i]}, parameters);
  };
  const std::vector<Eigen::Index> free = FreeCoordinates(low);
  AffineMechanism chain;
  Row t, n;
  for (size_t i = 0; i < size; ++i) {
    const AffineInterval rate = between(&Mechanism::rates, i);
    t.push_back(between(&Mechanism::jacobian, i));
    n.push_back(between(&Mechanism::jacobian, size + i));
    chain.u0 = chain.u0 + t.back() * rate;
    chain.v0 = chain.v0 + n.back() * rate;
  }
  for (const Eigen::Index row : free) {
    Row& lower = chain.mass.emplace_back();
    for (size_t k = 0; k < chain.mass.size(); ++k) {
      lower.push_back(between(&Mechanism::mass_matrix, static_cast<size_t>(row) * size + static_cast<size_t>(free[k])));
    }
    chain.t.push_back(t[static_cast<size_t>(row)]);
    chain.n.push_back(n[static_cast<size_t>(row)]);
  }
  return chain;
}

// W = sum_i (t_i, n_i)^T (t_i, n_i)/d_i
struct Gram {
  Row d, t, n;
};

// Eliminates row by row. Once `stopped`, the lists are filled with numbers that mean nothing.
Gram Eliminate(const AffineMechanism& chain, absl::FunctionRef<bool()> stopped) {
  const std::vector<Row>& mass = chain.mass;
  Gram gram;
  std::vector<Row> scaled(mass.size());  // L D
  for (size_t i = 0; i < mass.size(); ++i) {
    const bool is_stopped = stopped();
    AffineInterval d = mass[i][i];
    AffineInterval t = chain.t[i];
    AffineInterval n = chain.n[i];
    for (size_t j = 0; j < i; ++j) {
      AffineInterval entry = mass[i][j];
      for (size_t k = 0; k < j && !is_stopped; ++k) entry = entry - scaled[i][k] * scaled[j][k] / gram.d[k];
      d = d - Square(entry) / gram.d[j];
      t = t - entry / gram.d[j] * gram.t[j];
      n = n - entry / gram.d[j] * gram.n[j];
      scaled[i].push_back(entry);
    }
    gram.d.push_back(d);
    gram.t.push_back(t);
    gram.n.push_back(n);
  }
  return gram;
}

AffineContact Contact(const AffineMechanism& chain, absl::FunctionRef<bool()> stopped) {
  const Gram gram = Eliminate(chain, stopped);
  AffineInterval wtt(0.0), wtn(0.0), wnn(0.0), determinant(0.0);
  for (size_t i = 0; i < gram.d.size(); ++i) {
    wtt = wtt + Square(gram.t[i]) / gram.d[i];
    wtn = wtn + gram.t[i] * gram.n[i] / gram.d[i];
    wnn = wnn + Square(gram.n[i]) / gram.d[i];
    for (size_t j = 0; j < i; ++j) {
      determinant = determinant + Square(gram.t[i] * gram.n[j] - gram.t[j] * gram.n[i]) / (gram.d[i] * gram.d[j]);
    }
  }
  return {.wtt = wtt, .wtn = wtn, .wnn = wnn, .stick_slope = determinant / wtt, .u0 = chain.u0, .v0 = chain.v0};
}

// Returns cos/sin, which falls between its poles, over the angles whose sine lies in `sine`.
Interval Cotangent(const Interval& radians, const Interval& sine) {
  const Interval plain = Cos(radians) / sine;
  if (Contains(Sin(radians), 0.0)) return plain;
  const auto at = [](double end) { return Cos(Interval(end)) / Sin(Interval(end)); };
  return Intersect(plain, {at(radians.upper).lower, at(radians.lower).upper});
}

IntervalPendulum OneLink(const Link& low, const Link& high) {
  const Interval length(low.length_m, high.length_m);
  const Interval theta(low.theta_rad, high.theta_rad);
  const Interval mass(low.mass_kg, high.mass_kg);
  return {.inertia = Interval(low.inertia_com_kg_m2, high.inertia_com_kg_m2) + mass * Square({low.com_m, high.com_m}),
          .a = length * Sin(theta),
          .b = length * Cos(theta),
          .slope = Cotangent(theta, Sin(theta)),
          .omega_minus = {low.rate_rad_s, high.rate_rad_s}};
}

// --- Systems: those of both scenes are of the same kind ---

IntervalPendulum Between(const SceneBox& box, const Pendulum& low, const Pendulum& high) {
  IntervalPendulum pendulum = {.inertia = {low.inertia_kg_m2, high.inertia_kg_m2},
                               .a = {low.a_m, high.a_m},
                               .b = {low.b_m, high.b_m},
                               .slope = std::nullopt,
                               .omega_minus = {low.omega_minus_rad_s, high.omega_minus_rad_s}};
  if (!box.phi.has_value()) return pendulum;
  const Interval distance = Sqrt(Square(low.a_m) + Square(low.b_m));
  const Interval sine = AtLeast(Sin(*box.phi), 0.0);
  if (!(sine.upper > 0.0)) {
    pendulum.a = kNone;
    return pendulum;
  }
  pendulum.a = distance * sine;
  pendulum.b = distance * Cos(*box.phi);
  pendulum.slope = Cotangent(*box.phi, sine);
  return pendulum;
}

AffineContact Between(const PlanarContact& low, const PlanarContact& high, SlopeParameters& parameters) {
  const auto between = ParametersBetween(low, high, parameters);
  AffineContact contact = {.wtt = between(&PlanarContact::w_tt_per_kg),
                           .wtn = between(&PlanarContact::w_tn_per_kg),
                           .wnn = between(&PlanarContact::w_nn_per_kg),
                           .u0 = between(&PlanarContact::tangential_m_s),
                           .v0 = between(&PlanarContact::normal_m_s)};
  contact.stick_slope = contact.wnn - Square(contact.wtn) / contact.wtt;
  return contact;
}

AffineContact Contact(const SceneBox& box, SlopeParameters& parameters, absl::FunctionRef<bool()> stopped) {
  const System& high = box.high.system;
  if (const auto* low = std::get_if<PlanarContact>(&box.low.system)) {
    return Between(*low, std::get<PlanarContact>(high), parameters);
  }
  if (const auto* low = std::get_if<PlanarBody>(&box.low.system)) {
    return Contact(Between(*low, std::get<PlanarBody>(high), parameters));
  }
  if (const auto* low = std::get_if<Linkage>(&box.low.system)) {
    return Contact(AffineMechanismOf(Between(*low, std::get<Linkage>(high), parameters)), stopped);
  }
  if (const auto* low = std::get_if<Mechanism>(&box.low.system)) {
    return Contact(Between(*low, std::get<Mechanism>(high), parameters), stopped);
  }
  const auto& low_pair = std::get<PlanarPair>(std::get<BodyPair>(box.low.system).bodies);
  const auto& high_pair = std::get<PlanarPair>(std::get<BodyPair>(high).bodies);
  const AffineBody body_1 = Between(low_pair.body_1, high_pair.body_1, parameters);
  return Contact(body_1, Between(low_pair.body_2, high_pair.body_2, parameters));
}

}  // namespace

bool IsOfRankOne(const System& system) {
  const auto* const linkage = std::get_if<Linkage>(&system);
  return std::holds_alternative<Pendulum>(system) || (linkage != nullptr && linkage->links.size() == 1);
}

IntervalReduction Reduce(const SceneBox& box, SlopeParameters& parameters, absl::FunctionRef<bool()> stopped) {
  if (const auto* low = std::get_if<Pendulum>(&box.low.system)) {
    return Between(box, *low, std::get<Pendulum>(box.high.system));
  }
  if (IsOfRankOne(box.low.system)) {
    return OneLink(std::get<Linkage>(box.low.system).links[0], std::get<Linkage>(box.high.system).links[0]);
  }
  AffineContact contact = Contact(box, parameters, stopped);
  if (!box.low.surface_velocity.has_value()) return contact;
  const SurfaceVelocity& low = *box.low.surface_velocity;
  const SurfaceVelocity& high = *box.high.surface_velocity;
  if (!low.tangential_m_s.empty()) {
    contact.u0 = contact.u0 - AffineInterval::Parameter({low.tangential_m_s[0], high.tangential_m_s[0]}, parameters);
  }
  contact.v0 = contact.v0 - AffineInterval::Parameter({low.normal_m_s, high.normal_m_s}, parameters);
  return contact;
}

}  // namespace ricochet
