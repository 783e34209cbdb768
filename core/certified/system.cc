#include "core/certified/system.h"

#include <algorithm>
#include <cstddef>
#include <variant>

#include "core/certified/flint.h"
#include "core/models/restitution_law.h"

namespace ricochet::certified {
namespace {

using Stopped = absl::FunctionRef<bool()>;

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

// `exactly` makes an N of a double.
template <typename N, typename Exactly>
void SetCoefficients(const Scene& scene, const EffectiveCoefficients& effective, const Exactly& exactly,
                     Contact<N>& contact) {
  contact.mu = exactly(effective.kinetic_friction);
  contact.mu_static = exactly(effective.static_friction);
  contact.law = LawAndCoefficientOf(scene.restitution).law;
  contact.coefficient = exactly(effective.restitution.value_or(0.0));
}

// --- Rational systems ---

void SetDeterminant(Contact<Surd>& contact) {
  contact.det = contact.wtt * contact.wnn - Square(contact.wtn);
  contact.rank_one = contact.det.Sign() == 0;
  if (contact.wnn.Sign() != 0) contact.rho = contact.wtn / contact.wnn;
}

SystemContact<Surd> Reduce(const Pendulum& pendulum) {
  const Surd inertia(pendulum.inertia_kg_m2), a(pendulum.a_m), b(pendulum.b_m), omega(pendulum.omega_minus_rad_s);
  SystemContact<Surd> system;
  system.contact = {.wtt = b * b / inertia,
                    .wtn = a * b / inertia,
                    .wnn = a * a / inertia,
                    .det = Surd(),
                    .rank_one = true,
                    .rho = b / a,
                    .u0 = b * omega,
                    .v0 = a * omega};
  system.velocities = Velocities::kRates;
  system.before = {omega};
  system.response = {{b / inertia, a / inertia}};
  system.lever = a;
  system.is_pendulum = true;
  return system;
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

// `side` is 1 for the body that the impulses act on and -1 for the body that their opposites act on.
void AddBody(const PlanarBody& body, double side, SystemContact<Surd>& system) {
  const Surd t(body.offset_t_m), n(body.offset_n_m);
  const Surd u(body.velocity_t_m_s), v(body.velocity_n_m_s), rate(body.rate_rad_s);
  const Surd inverse_mass = Surd(1.0) / Surd(body.mass_kg);
  const Surd inverse_inertia = Surd(1.0) / Surd(body.inertia_com_kg_m2);
  const Surd sign(side);
  Contact<Surd>& contact = system.contact;
  contact.wtt = contact.wtt + inverse_mass + n * n * inverse_inertia;
  contact.wtn = contact.wtn - t * n * inverse_inertia;
  contact.wnn = contact.wnn + inverse_mass + t * t * inverse_inertia;
  contact.u0 = contact.u0 + sign * (u - rate * n);
  contact.v0 = contact.v0 + sign * (v + rate * t);
  const Surd zero;
  system.before.insert(system.before.end(), {u, v, rate});
  system.response.insert(system.response.end(), {{sign * inverse_mass, zero},
                                                 {zero, sign * inverse_mass},
                                                 {-sign * n * inverse_inertia, sign * t * inverse_inertia}});
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

// No other system gets here: linkages are made of intervals, and CheckCertifiable refuses systems in space.
template <typename Other>
SystemContact<Surd> Reduce(const Other& /*other*/) {
  return {};
}

// --- Linkages ---

struct SineCosine {
  ArfInterval sine, cosine;
};

SineCosine SineCosineOf(const Arf& angle, slong bits) {
  Ball x, sine, cosine;
  arb_set_arf(x.get(), angle.get());
  arb_sin_cos(sine.get(), cosine.get(), x.get(), bits);
  return {ArfInterval(sine.get(), bits), ArfInterval(cosine.get(), bits)};
}

ArfInterval CosineOfDifference(double x, double y, slong bits) {
  Arf difference;
  arf_sub(difference.get(), Arf(x).get(), Arf(y).get(), ARF_PREC_EXACT, ARF_RND_NEAR);
  return SineCosineOf(difference, bits).cosine;
}

// The double itself; what it is multiplied with or added to is rounded to `bits`.
ArfInterval Exactly(double x, slong bits) { return {Arf(x), Arf(x), bits}; }

void Set(Matrix& matrix, size_t row, size_t column, const ArfInterval& value, slong bits) {
  arb_set_interval_arf(matrix.at(static_cast<slong>(row), static_cast<slong>(column)), value.lower().get(),
                       value.upper().get(), bits);
}

ArfInterval Get(Matrix& matrix, size_t row, size_t column, slong bits) {
  return {matrix.at(static_cast<slong>(row), static_cast<slong>(column)), bits};
}

// Sets M, in which the coordinates are the links' angles from the vertical. For i < k the entry (i, k) is
// l_i cos(theta_i - theta_k) times the moment about joint k of link k and of all links that hang on it. Returns false
// once `stopped`.
bool SetMassMatrix(const std::vector<Link>& links, slong bits, Matrix& mass, Stopped stopped) {
  ArfInterval outer_mass = Exactly(0.0, bits);  // The mass of the links between k and the tip.
  for (size_t k = links.size(); k-- > 0;) {
    const Link& link = links[k];
    const ArfInterval own = Exactly(link.mass_kg, bits);
    const ArfInterval com = Exactly(link.com_m, bits);
    const ArfInterval length = Exactly(link.length_m, bits);
    const ArfInterval moment = own * com + outer_mass * length;
    const ArfInterval inertia = Exactly(link.inertia_com_kg_m2, bits);
    Set(mass, k, k, inertia + own * Square(com) + outer_mass * Square(length), bits);
    for (size_t i = 0; i < k; ++i) {
      if (stopped()) return false;
      const ArfInterval cosine = CosineOfDifference(links[i].theta_rad, link.theta_rad, bits);
      Set(mass, k, i, moment * Exactly(links[i].length_m, bits) * cosine, bits);
    }
    outer_mass = outer_mass + own;
  }
  return true;
}

// Replaces the lower triangle of M by its Cholesky factor, as arb_mat_cho does, but asks `stopped` before each entry.
// Returns false once `stopped`, or where a pivot cannot be proved positive.
bool Factorize(size_t size, slong bits, Matrix& mass, Stopped stopped) {
  const auto at = [&](size_t row, size_t column) {
    return mass.at(static_cast<slong>(row), static_cast<slong>(column));
  };
  for (size_t i = 0; i < size; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      if (stopped()) return false;
      arb_dot(at(i, j), at(i, j), 1, at(i, 0), 1, at(j, 0), 1, static_cast<slong>(j), bits);
      if (j < i) arb_div(at(i, j), at(i, j), at(j, j), bits);
    }
    if (arb_is_positive(at(i, i)) == 0) return false;
    arb_sqrt(at(i, i), at(i, i), bits);
  }
  return true;
}

// The rows of J^T: how the tip moves with each link's rate.
std::vector<std::array<ArfInterval, 2>> TransposedJacobian(const std::vector<Link>& links, slong bits) {
  std::vector<std::array<ArfInterval, 2>> rows;
  for (const Link& link : links) {
    const auto [sine, cosine] = SineCosineOf(Arf(link.theta_rad), bits);
    const ArfInterval length = Exactly(link.length_m, bits);
    rows.push_back({length * cosine, length * sine});
  }
  return rows;
}

}  // namespace

bool AreParallel(const std::vector<Link>& links) {
  return std::all_of(links.begin(), links.end(),
                     [&](const Link& link) { return link.theta_rad == links.front().theta_rad; });
}

SystemContact<Surd> ReduceExactly(const Scene& scene, const EffectiveCoefficients& effective) {
  SystemContact<Surd> system = std::visit([](const auto& given) { return Reduce(given); }, scene.system);
  SetCoefficients(
      scene, effective, [](double x) { return Surd(x); }, system.contact);
  if (!scene.surface_velocity.has_value()) return system;
  for (const double u : scene.surface_velocity->tangential_m_s) system.contact.u0 = system.contact.u0 - Surd(u);
  system.contact.v0 = system.contact.v0 - Surd(scene.surface_velocity->normal_m_s);
  system.lever.reset();
  system.is_pendulum = false;
  return system;
}

std::optional<SystemContact<ArfInterval>> ReduceLinkage(const Scene& scene, const EffectiveCoefficients& effective,
                                                        slong bits, Stopped stopped) {
  const std::vector<Link>& links = std::get<Linkage>(scene.system).links;
  const size_t n = links.size();
  Matrix mass(static_cast<slong>(n), static_cast<slong>(n));
  if (!SetMassMatrix(links, bits, mass, stopped) || !Factorize(n, bits, mass, stopped)) return std::nullopt;
  const auto jt = TransposedJacobian(links, bits);
  // One column at a time, as each takes milliseconds.
  Matrix solution_t(static_cast<slong>(n), 1), solution_n(static_cast<slong>(n), 1);
  for (const size_t column : {size_t{0}, size_t{1}}) {
    if (stopped()) return std::nullopt;
    Matrix right(static_cast<slong>(n), 1);
    for (size_t i = 0; i < n; ++i) Set(right, i, 0, jt[i][column], bits);
    arb_mat_solve_cho_precomp((column == 0 ? solution_t : solution_n).get(), mass.get(), right.get(), bits);
  }
  if (stopped()) return std::nullopt;

  SystemContact<ArfInterval> system;
  system.velocities = Velocities::kRates;
  Contact<ArfInterval>& contact = system.contact;
  for (size_t i = 0; i < n; ++i) {
    const std::array<ArfInterval, 2> response = {Get(solution_t, i, 0, bits), Get(solution_n, i, 0, bits)};
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
  for (const double u : scene.surface_velocity->tangential_m_s) contact.u0 = contact.u0 - Exactly(u, bits);
  contact.v0 = contact.v0 - Exactly(scene.surface_velocity->normal_m_s, bits);
  return system;
}

}  // namespace ricochet::certified
