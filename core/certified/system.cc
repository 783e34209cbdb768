#include "core/certified/system.h"

#include <arb_mat.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

#include "core/models/restitution_law.h"

namespace ricochet::certified {
namespace {

class Matrix {
 public:
  Matrix(slong rows, slong columns) { arb_mat_init(value_, rows, columns); }
  Matrix(const Matrix&) = delete;
  Matrix& operator=(const Matrix&) = delete;
  ~Matrix() { arb_mat_clear(value_); }
  arb_struct* at(slong row, slong column) { return arb_mat_entry(value_, row, column); }
  arb_mat_struct* get() { return value_; }

 private:
  arb_mat_t value_;
};

// `exactly(double)` makes an N.
template <typename N, typename Exactly>
void SetCoefficients(const Scene& scene, const EffectiveCoefficients& effective, const Exactly& exactly,
                     Contact<N>& contact) {
  contact.mu = exactly(effective.kinetic_friction);
  contact.mu_static = exactly(effective.static_friction);
  contact.law = StatedBy(scene.restitution).law;
  contact.coefficient = exactly(effective.restitution);
}

// --- Rational systems ---

void SetDeterminant(Contact<Surd>& contact) {
  contact.det = contact.wtt * contact.wnn - Square(contact.wtn);
  contact.rank_one = contact.det.Sign() == 0;
  if (contact.wnn.Sign() != 0) contact.rho = contact.wtn / contact.wnn;
}

SystemContact<Surd> Reduce(const Pendulum& pendulum) {
  return ReducePendulum<Surd>(pendulum.inertia_kg_m2, pendulum.a_m, pendulum.b_m, pendulum.omega_minus_rad_s);
}

SystemContact<Surd> Reduce(const PlanarContact& given) {
  SystemContact<Surd> system;
  system.contact.wtt = given.w_tt_per_kg;
  system.contact.wtn = given.w_tn_per_kg;
  system.contact.wnn = given.w_nn_per_kg;
  system.contact.u0 = given.tangential_m_s;
  system.contact.v0 = given.normal_m_s;
  SetDeterminant(system.contact);
  return system;
}

// `side` is 1 for the body that the impulses act on, -1 for the one that their opposites act on.
void AddBody(const PlanarBody& body, double side, SystemContact<Surd>& system) {
  const Surd t(body.offset_t_m), n(body.offset_n_m);
  const Surd u(body.velocity_t_m_s), v(body.velocity_n_m_s), rate(body.rate_rad_s);
  const Surd moves = Surd(1.0) / Surd(body.mass_kg);
  const Surd turns = Surd(1.0) / Surd(body.inertia_com_kg_m2);
  const Surd sign(side);
  Contact<Surd>& contact = system.contact;
  contact.wtt = contact.wtt + moves + n * n * turns;
  contact.wtn = contact.wtn - t * n * turns;
  contact.wnn = contact.wnn + moves + t * t * turns;
  contact.u0 = contact.u0 + sign * (u - rate * n);
  contact.v0 = contact.v0 + sign * (v + rate * t);
  const Surd zero;
  system.before.insert(system.before.end(), {u, v, rate});
  system.response.insert(system.response.end(),
                         {{sign * moves, zero}, {zero, sign * moves}, {-sign * n * turns, sign * t * turns}});
  system.velocities = Velocities::kBodies;
}

SystemContact<Surd> Reduce(const PlanarBody& body) {
  SystemContact<Surd> system;
  AddBody(body, 1.0, system);
  SetDeterminant(system.contact);
  return system;
}

SystemContact<Surd> Reduce(const BodyPair& pair) {
  SystemContact<Surd> system;
  if (const auto* const planar = std::get_if<PlanarPair>(&pair.bodies)) {
    AddBody(planar->body_1, 1.0, system);
    AddBody(planar->body_2, -1.0, system);
    SetDeterminant(system.contact);
  }
  return system;
}

// Linkages are intervals, spatial systems refused.
template <typename Other>
SystemContact<Surd> Reduce(const Other& /*other*/) {
  return {};
}

// --- Linkages ---

struct Turn {
  ArfInterval sine, cosine;
};

Turn TurnOf(const Arf& angle, slong bits) {
  arb_t x, sine, cosine;
  arb_init(x);
  arb_init(sine);
  arb_init(cosine);
  arb_set_arf(x, angle.get());
  arb_sin_cos(sine, cosine, x, bits);
  Turn turn = {ArfInterval(sine, bits), ArfInterval(cosine, bits)};
  arb_clear(cosine);
  arb_clear(sine);
  arb_clear(x);
  return turn;
}

ArfInterval CosineOfDifference(double x, double y, slong bits) {
  Arf difference;
  arf_sub(difference.get(), Arf(x).get(), Arf(y).get(), ARF_PREC_EXACT, ARF_RND_NEAR);
  return TurnOf(difference, bits).cosine;
}

// An exact double, with which products and sums are rounded to `bits`.
ArfInterval Exactly(double x, slong bits) { return {Arf(x), Arf(x), bits}; }

void Set(Matrix& matrix, size_t row, size_t column, const ArfInterval& value, slong bits) {
  arb_set_interval_arf(matrix.at(static_cast<slong>(row), static_cast<slong>(column)), value.lower().get(),
                       value.upper().get(), bits);
}

ArfInterval Get(Matrix& matrix, size_t row, size_t column, slong bits) {
  return {matrix.at(static_cast<slong>(row), static_cast<slong>(column)), bits};
}

// M with the links' angles from the vertical as coordinates: off its diagonal l_i cos(theta_i - theta_k) times the
// moment about joint k, i < k, of link k and of all that hangs on it.
void SetMassMatrix(const std::vector<Link>& links, slong bits, Matrix& mass) {
  ArfInterval beyond = Exactly(0.0, bits);  // Mass of the links after k, from the tip on.
  for (size_t k = links.size(); k-- > 0;) {
    const Link& link = links[k];
    const ArfInterval own = Exactly(link.mass_kg, bits);
    const ArfInterval com = Exactly(link.com_m, bits);
    const ArfInterval length = Exactly(link.length_m, bits);
    const ArfInterval moment = own * com + beyond * length;
    const ArfInterval inertia = Exactly(link.inertia_com_kg_m2, bits);
    Set(mass, k, k, inertia + own * Square(com) + beyond * Square(length), bits);
    for (size_t i = 0; i < k; ++i) {
      const ArfInterval cosine = CosineOfDifference(links[i].theta_rad, link.theta_rad, bits);
      const ArfInterval entry = moment * Exactly(links[i].length_m, bits) * cosine;
      Set(mass, i, k, entry, bits);
      Set(mass, k, i, entry, bits);
    }
    beyond = beyond + own;
  }
}

// The rows of J^T: how the tip moves with each link's rate.
std::vector<std::array<ArfInterval, 2>> TransposedJacobian(const std::vector<Link>& links, slong bits) {
  std::vector<std::array<ArfInterval, 2>> rows;
  for (const Link& link : links) {
    const Turn turn = TurnOf(Arf(link.theta_rad), bits);
    const ArfInterval length = Exactly(link.length_m, bits);
    rows.push_back({length * turn.cosine, length * turn.sine});
  }
  return rows;
}

bool AreParallel(const std::vector<Link>& links) {
  return std::all_of(links.begin(), links.end(),
                     [&](const Link& link) { return link.theta_rad == links.front().theta_rad; });
}

}  // namespace

SystemContact<Surd> ReduceExactly(const Scene& scene, const EffectiveCoefficients& effective) {
  SystemContact<Surd> system = std::visit([](const auto& given) { return Reduce(given); }, scene.system);
  SetCoefficients(
      scene, effective, [](double x) { return Surd(x); }, system.contact);
  if (!scene.surface_velocity.has_value()) return system;
  system.contact.u0 = system.contact.u0 - Surd(scene.surface_velocity->tangential_m_s[0]);
  system.contact.v0 = system.contact.v0 - Surd(scene.surface_velocity->normal_m_s);
  system.lever.reset();
  system.is_pendulum = false;
  return system;
}

std::optional<SystemContact<ArfInterval>> ReduceLinkage(const Scene& scene, const EffectiveCoefficients& effective,
                                                        slong bits) {
  const std::vector<Link>& links = std::get<Linkage>(scene.system).links;
  const size_t n = links.size();
  Matrix mass(static_cast<slong>(n), static_cast<slong>(n));
  SetMassMatrix(links, bits, mass);
  const auto jt = TransposedJacobian(links, bits);
  Matrix right(static_cast<slong>(n), 2), solution(static_cast<slong>(n), 2);
  for (size_t i = 0; i < n; ++i) {
    Set(right, i, 0, jt[i][0], bits);
    Set(right, i, 1, jt[i][1], bits);
  }
  if (arb_mat_spd_solve(solution.get(), mass.get(), right.get(), bits) == 0) return std::nullopt;

  SystemContact<ArfInterval> system;
  system.velocities = Velocities::kRates;
  Contact<ArfInterval>& contact = system.contact;
  for (size_t i = 0; i < n; ++i) {
    const std::array<ArfInterval, 2> response = {Get(solution, i, 0, bits), Get(solution, i, 1, bits)};
    const ArfInterval rate = Exactly(links[i].rate_rad_s, bits);
    contact.wtt = contact.wtt + jt[i][0] * response[0];
    contact.wtn = contact.wtn + jt[i][0] * response[1];
    contact.wnn = contact.wnn + jt[i][1] * response[1];
    contact.u0 = contact.u0 + jt[i][0] * rate;
    contact.v0 = contact.v0 + jt[i][1] * rate;
    system.before.push_back(rate);
    system.response.push_back(response);
  }
  contact.rank_one = AreParallel(links);
  contact.det = contact.wtt * contact.wnn - Square(contact.wtn);
  contact.rho = jt[0][0] / jt[0][1];
  SetCoefficients(
      scene, effective, [bits](double x) { return Exactly(x, bits); }, contact);
  if (!scene.surface_velocity.has_value()) {
    if (n == 1) system.lever = jt[0][1];
    return system;
  }
  contact.u0 = contact.u0 - Exactly(scene.surface_velocity->tangential_m_s[0], bits);
  contact.v0 = contact.v0 - Exactly(scene.surface_velocity->normal_m_s, bits);
  return system;
}

}  // namespace ricochet::certified
