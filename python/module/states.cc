#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <future>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/floating_point_mode.h"
#include "core/contact/mechanism_lanes.h"
#include "core/contact/reduction.h"
#include "core/scene/check.h"
#include "python/module/rows.h"
#include "ricochet/helpers.h"
#include "ricochet/system.h"

namespace ricochet::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style>;
using Vector = std::array<double, 3>;

// States of `n` coordinates that a thread reduces between two looks at the signals of Python: some 10 ms of work.
int64_t PieceOf(size_t n) {
  const auto work = static_cast<int64_t>(n * n * n);
  return std::clamp<int64_t>((int64_t{1} << 20) / std::max<int64_t>(work, 1), 1, 2048);
}

double Dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The vector times a power of two, so that the square of its length is neither 0 nor infinite.
Vector Scaled(Vector vector) {
  const double largest = std::max({std::fabs(vector[0]), std::fabs(vector[1]), std::fabs(vector[2])});
  if (!(largest > 0.0) || !std::isfinite(largest)) return vector;
  for (double& component : vector) component = std::scalbn(component, -std::ilogb(largest));
  return vector;
}

// The unit vector along the part of `vector` that is perpendicular to `normal`, if there is such a part. It is made
// twice, because the first difference may cancel. Where it leaves rounding alone, the second takes away most of that.
std::optional<Vector> UnitAcross(Vector vector, const Vector& normal) {
  double length = 0.0;
  for (int i = 0; i < 2; ++i) {
    vector = Scaled(vector);
    const double along = Dot(vector, normal);
    for (size_t k = 0; k < 3; ++k) vector[k] -= along * normal[k];
    length = std::sqrt(Dot(vector, vector));
    if (!(length > 0.0)) return std::nullopt;
    for (double& component : vector) component /= length;
  }
  if (!(length > 0.25)) return std::nullopt;
  return vector;
}

Vector Cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The velocities of a contact in world axes, one for each of `n` rates of 1.
struct Velocities {
  size_t n;
  const double* jacobian;

  Vector Of(size_t k) const { return {jacobian[k], jacobian[n + k], jacobian[2 * n + k]}; }
};

// The only direction across `normal` in which the contact of a planar mechanism can move, if there is only one. What
// rounding leaves beside it is no second direction, however the plane stands in the world.
std::optional<Vector> OnlySlip(const Velocities& velocities, const Vector& normal) {
  const auto across = [&normal](const Vector& velocity) { return Cross(normal, velocity); };
  size_t largest = 0;
  double square = 0.0;
  for (size_t k = 0; k < velocities.n; ++k) {
    const Vector part = across(velocities.Of(k));
    if (Dot(part, part) > square) largest = k;
    square = std::max(square, Dot(part, part));
  }
  if (!(square > 0.0) || !std::isfinite(square)) return std::nullopt;
  const std::optional<Vector> direction = UnitAcross(velocities.Of(largest), normal);
  if (!direction.has_value()) return std::nullopt;
  const Vector side = Cross(normal, *direction);
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
  for (size_t k = 0; k < velocities.n; ++k) {
    const Vector velocity = velocities.Of(k);
    if (std::fabs(Dot(side, velocity)) > kRounding * std::sqrt(Dot(velocity, velocity))) return std::nullopt;
  }
  return direction;
}

// The vector over its length.
Vector Unit(const Vector& vector) {
  const Vector scaled = Scaled(vector);
  const double length = std::sqrt(Dot(scaled, scaled));
  return {scaled[0] / length, scaled[1] / length, scaled[2] / length};
}

// The axes t1, t2 and n of a contact.
struct Axes {
  std::array<Vector, 3> of;
  bool is_planar;  // The contact cannot move along t2.
};

// Returns n along `normal` and t1 along the slip, or along any tangent if nothing slips.
Axes AxesOf(const Velocities& velocities, const Vector& velocity, const Vector& normal) {
  const std::optional<Vector> only = OnlySlip(velocities, normal);
  const double sign = only.has_value() && Dot(*only, velocity) < 0.0 ? -1.0 : 1.0;
  std::optional<Vector> t1 = UnitAcross(only.value_or(velocity), normal);
  if (!t1.has_value()) {
    Vector any = {};
    const auto smaller = [](double a, double b) { return std::fabs(a) < std::fabs(b); };
    any[static_cast<size_t>(std::min_element(normal.begin(), normal.end(), smaller) - normal.begin())] = 1.0;
    t1 = UnitAcross(any, normal);
  }
  // A normal without a direction, such as a zero vector, gives NaN for the tangential axes.
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const Vector slip = t1.value_or(Vector{kNone, kNone, kNone});
  const Vector along = {sign * slip[0], sign * slip[1], sign * slip[2]};
  return {.of = {along, Cross(normal, along), normal}, .is_planar = only.has_value()};
}

// The arrays of a call: those of the caller, and those of the answer.
struct States {
  size_t coordinates;
  const double *mass, *jacobian, *rates, *normal;
  std::array<double*, 9> contact;  // W by its upper triangle, then the contact velocity.
  double *axes, *turned, *response;
  Mechanism form;  // It says how many coordinates there are, and which are held.
};

// Sets the axes of a state, and J in them.
void Turn(const States& states, size_t state) {
  const size_t n = states.coordinates;
  const double* const jacobian = states.jacobian + state * 3 * n;
  const double* const rates = states.rates + state * n;
  const double* const normal = states.normal + state * 3;
  Vector velocity = {};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < n; ++k) velocity[i] += jacobian[i * n + k] * rates[k];
  }
  const Velocities velocities = {n, jacobian};
  const Axes axes = AxesOf(velocities, velocity, Unit({normal[0], normal[1], normal[2]}));
  for (size_t i = 0; i < 3; ++i) {
    std::copy(axes.of[i].begin(), axes.of[i].end(), states.axes + (state * 3 + i) * 3);
    double* const row = states.turned + (state * 3 + i) * n;
    for (size_t k = 0; k < n; ++k) row[k] = axes.is_planar && i == 1 ? 0.0 : Dot(axes.of[i], velocities.Of(k));
  }
}

// Reduces one state that lanes cannot. The W of one that breaks a rule is NaN, which the batch refuses.
void ReduceAlone(const Mechanism& form, MechanismState& state) {
  const size_t n = form.rates.size();
  Scene scene;
  auto& mechanism = scene.system.emplace<Mechanism>(form);
  mechanism.mass_matrix.assign(state.mass, state.mass + n * n);
  mechanism.jacobian.assign(state.jacobian, state.jacobian + 3 * n);
  mechanism.rates.assign(state.rates, state.rates + n);
  SpatialReduction reduction;
  reduction.w.fill(std::numeric_limits<double>::quiet_NaN());
  Check check(Check::Mode::kVerdict);
  CheckMechanism(mechanism, 1, check);
  if (!check.failed()) reduction = std::get<SpatialReduction>(Reduce(scene));
  state.w = reduction.w;
  state.velocity = {reduction.u0[0], reduction.u0[1], reduction.v0};
  reduction.response.resize(3 * n, std::numeric_limits<double>::quiet_NaN());
  std::copy(reduction.response.begin(), reduction.response.end(), state.response);
}

void ReducePart(const States& states, int64_t first, int64_t end) {
  const DefaultFloatingPoint mode;
  const size_t n = states.coordinates;
  std::vector<MechanismState> part;
  for (auto at = static_cast<size_t>(first); at < static_cast<size_t>(end); ++at) {
    Turn(states, at);
    part.push_back({.mass = states.mass + at * n * n,
                    .jacobian = states.turned + at * 3 * n,
                    .rates = states.rates + at * n,
                    .response = states.response + at * 3 * n});
    std::fill_n(part.back().response, 3 * n, 0.0);
  }
  ReduceInLanes(states.form, absl::MakeSpan(part));
  for (size_t i = 0; i < part.size(); ++i) {
    MechanismState& state = part[i];
    if (!state.is_reduced) ReduceAlone(states.form, state);
    for (size_t k = 0; k < 6; ++k) states.contact[k][static_cast<size_t>(first) + i] = state.w[k];
    for (size_t k = 0; k < 3; ++k) states.contact[6 + k][static_cast<size_t>(first) + i] = state.velocity[k];
  }
}

// Reduces the states on all cores and lets Python handle its signals meanwhile.
void ReduceAll(const States& states, int64_t count) {
  const int64_t cores = AvailableCores();
  const int64_t step = PieceOf(states.coordinates) * cores;
  for (int64_t first = 0; first < count; first += step) {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const WithoutLock without_lock;
    const int64_t end = std::min(count, first + step);
    const int64_t piece = (end - first + cores - 1) / cores;
    std::vector<std::future<void>> others;
    for (int64_t at = first + piece; at < end; at += piece) {
      others.push_back(std::async(std::launch::async, ReducePart, std::cref(states), at, std::min(end, at + piece)));
    }
    ReducePart(states, first, std::min(end, first + piece));
    for (std::future<void>& other : others) other.get();
  }
}

// Returns the columns of the contacts (W by its upper triangle, then the contact velocity), the axes t1, t2, n of each
// (B x 3 x 3), J in them (B x 3 x n), and M^-1 J^T (B x n x 3). M is B x n x n, J is B x 3 x n, q' B x n, and the
// normals are B x 3.
py::tuple ReduceStates(const Numbers& mass, const Numbers& jacobian, const Numbers& rates, const Numbers& normal,
                       const std::vector<int32_t>& held) {
  const py::ssize_t count = rates.shape(0);
  const py::ssize_t n = rates.shape(1);
  Numbers axes({count, py::ssize_t{3}, py::ssize_t{3}});
  Numbers turned({count, py::ssize_t{3}, n});
  Numbers response({count, n, py::ssize_t{3}});
  States states = {.coordinates = static_cast<size_t>(n),
                   .mass = mass.data(),
                   .jacobian = jacobian.data(),
                   .rates = rates.data(),
                   .normal = normal.data(),
                   .contact = {},
                   .axes = axes.mutable_data(),
                   .turned = turned.mutable_data(),
                   .response = response.mutable_data(),
                   .form = {.rates = std::vector<double>(static_cast<size_t>(n)), .kept_coordinates = held}};
  py::list columns;
  for (double*& column : states.contact) {
    Numbers made(count);
    column = made.mutable_data();
    columns.append(std::move(made));
  }
  ReduceAll(states, count);
  return py::make_tuple(columns, axes, turned, response);
}

}  // namespace

void AddStates(py::module_& module) { module.def("reduce_states", &ReduceStates); }

}  // namespace ricochet::python
