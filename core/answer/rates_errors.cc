#include "core/answer/rates_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "core/answer/scene_outcome.h"
#include "core/contact/mechanism.h"
#include "core/contact/reduction.h"

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-53;
constexpr double kMostStep = 0x1p-20;  // Of an input, relative to its scale.
// A step is so many times smaller than the least eigenvalue of W, scaled to a unit diagonal.
constexpr double kStepsToSingular = 64.0;
// Counts what is not linear in the errors.
constexpr double kSafety = 2.0;

template <size_t kTangential>
using Impulses = std::array<double, kTangential + 1>;  // Along t, or t1 and t2, then n.

// One number that the contact's W and velocity are made of: what moving it by one unit of `step` does, and its error.
template <size_t kTangential>
struct Input {
  Reduction<kTangential> step;  // Only W, u0 and v0.
  double length = 0.0;          // Of the step that is taken, in units.
  double error = 0.0;           // In units.
};

PlanarContact ContactOf(const PlanarReduction& reduction) {
  return {.w_tt_per_kg = reduction.w[0],
          .w_tn_per_kg = reduction.w[1],
          .w_nn_per_kg = reduction.w[2],
          .tangential_m_s = reduction.u0[0],
          .normal_m_s = reduction.v0};
}
SpatialContact ContactOf(const SpatialReduction& reduction) {
  return {.w_per_kg = {reduction.w.begin(), reduction.w.end()},
          .tangential_m_s = {reduction.u0.begin(), reduction.u0.end()},
          .normal_m_s = reduction.v0};
}

template <size_t kTangential>
Impulses<kTangential> ImpulsesOf(const Outcome& outcome) {
  Impulses<kTangential> impulses;
  std::copy_n(outcome.impulse.tangential_n_s.begin(), kTangential, impulses.begin());
  impulses[kTangential] = outcome.impulse.normal_total_n_s;
  return impulses;
}

template <size_t kTangential>
double Diagonal(const Reduction<kTangential>& reduction, size_t i) {
  size_t k = 0;
  for (size_t row = 0; row < i; ++row) k += kTangential + 1 - row;
  return reduction.w[k];
}

// The least eigenvalue of W without its rows that are 0, scaled to a unit diagonal.
template <size_t kTangential>
double LeastScaledEigenvalue(const Reduction<kTangential>& reduction) {
  std::vector<double> upper;
  if constexpr (kTangential == 1) {
    upper = {reduction.w[0], 0.0, reduction.w[1], 1.0, 0.0, reduction.w[2]};
  } else {
    upper.assign(reduction.w.begin(), reduction.w.end());
  }
  for (const size_t diagonal : {0, 3, 5}) {
    if (upper[diagonal] == 0.0) upper[diagonal] = 1.0;
  }
  return SmallestScaledEigenvalue(upper);
}

// Every entry of W and of the velocity that carries an error; nothing if a step would make W singular.
template <size_t kTangential>
std::optional<std::vector<Input<kTangential>>> InputsOf(const Reduction<kTangential>& reduction,
                                                        const MechanismErrors& errors) {
  const double share = std::min(kMostStep, LeastScaledEigenvalue(reduction) / kStepsToSingular);
  if (!(share > 0.0)) return std::nullopt;
  std::vector<Input<kTangential>> inputs;
  size_t k = 0;
  for (size_t i = 0; i <= kTangential; ++i) {
    for (size_t j = i; j <= kTangential; ++j, ++k) {
      const double scale = std::sqrt(Diagonal(reduction, i)) * std::sqrt(Diagonal(reduction, j));
      if (scale == 0.0) continue;  // A row of J that is 0 is exact.
      Input<kTangential> input = {.length = share * scale,
                                  .error = errors.w(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j))};
      input.step.w[k] = 1.0;
      inputs.push_back(input);
    }
  }
  double largest = std::fabs(reduction.v0);
  for (const double u : reduction.u0) largest = std::max(largest, std::fabs(u));
  for (size_t i = 0; i <= kTangential; ++i) {
    const double velocity = i == kTangential ? reduction.v0 : reduction.u0[i];
    // Subtracting the velocity of a surface rounds once more.
    const double error = errors.velocity(static_cast<Eigen::Index>(i)) + 2.0 * kUnit * std::fabs(velocity);
    if (velocity == 0.0 && errors.velocity(static_cast<Eigen::Index>(i)) == 0.0) continue;
    Input<kTangential> input = {.length = share * (velocity == 0.0 ? largest : std::fabs(velocity)), .error = error};
    (i == kTangential ? input.step.v0 : input.step.u0[std::min(i, kTangential - 1)]) = 1.0;
    inputs.push_back(input);
  }
  return inputs;
}

// One free coordinate: W = y y^T and (u, v) = y z, whose rank and range a step must keep.
std::optional<std::vector<Input<1>>> InputsOfOneCoordinate(const PlanarReduction& reduction,
                                                           const MechanismErrors& errors) {
  const double yt = std::sqrt(reduction.w[0]);
  const double yn = std::copysign(std::sqrt(reduction.w[2]), reduction.w[1]);
  if (yn == 0.0) return std::nullopt;
  const double z = reduction.v0 / yn;
  const double t_error = yt == 0.0 ? 0.0 : errors.w(0, 0) / yt + 2.0 * kUnit * yt;
  const double n_error = errors.w(1, 1) / std::fabs(yn) + 2.0 * kUnit * std::fabs(yn);
  const double z_error = errors.velocity(1) / std::fabs(yn) + std::fabs(z) * (n_error / std::fabs(yn) + 4.0 * kUnit);
  return std::vector<Input<1>>{
      {.step = {.w = {2.0 * yt, yn, 0.0}, .u0 = {z}}, .length = kMostStep * yt, .error = t_error},
      {.step = {.w = {0.0, yt, 2.0 * yn}, .v0 = z}, .length = kMostStep * std::fabs(yn), .error = n_error},
      {.step = {.u0 = {yt}, .v0 = yn}, .length = kMostStep * std::fabs(z), .error = z_error}};
}

template <size_t kTangential>
Reduction<kTangential> Moved(const Reduction<kTangential>& reduction, const Input<kTangential>& input, double by) {
  Reduction<kTangential> moved = {.w = reduction.w, .u0 = reduction.u0, .v0 = reduction.v0};
  for (size_t k = 0; k < moved.w.size(); ++k) moved.w[k] += by * input.step.w[k];
  for (size_t k = 0; k < kTangential; ++k) moved.u0[k] += by * input.step.u0[k];
  moved.v0 += by * input.step.v0;
  return moved;
}

// Moving both factors of a W of rank one moves it along its rank.
PlanarReduction MovedInRange(const PlanarReduction& reduction, const Input<1>& input, double by) {
  PlanarReduction moved = Moved(reduction, input, by);
  moved.w[1] = std::copysign(std::sqrt(moved.w[0]) * std::sqrt(moved.w[2]), reduction.w[1]);
  if (moved.w[2] > 0.0) moved.u0[0] = moved.v0 * (moved.w[1] / moved.w[2]);
  return moved;
}

bool HoldsNothingInMotion(const Scene& scene, const Mechanism& mechanism) {
  const bool holds = mechanism.composite || !mechanism.kept_coordinates.empty();
  return !holds && !scene.surface_velocity.has_value();
}

// The errors of the impulses; infinite where none is known.
template <size_t kTangential>
Impulses<kTangential> ImpulseErrors(const Scene& scene, const Reduction<kTangential>& reduction,
                                    const MechanismErrors& errors, bool one_coordinate, const Demand& demand,
                                    absl::FunctionRef<bool()> stopped, const Outcome& outcome) {
  Impulses<kTangential> unknown;
  unknown.fill(kInfinity);
  std::optional<std::vector<Input<kTangential>>> inputs;
  if constexpr (kTangential == 1) {
    inputs = one_coordinate ? InputsOfOneCoordinate(reduction, errors) : InputsOf<1>(reduction, errors);
  } else {
    inputs = InputsOf<kTangential>(reduction, errors);
  }
  if (!inputs.has_value() || outcome.termination == Termination::kRefused ||
      outcome.termination == Termination::kBudgetUsedUp) {
    return unknown;
  }
  Impulses<kTangential> sum;
  sum.fill(outcome.errors.tangential_n_s.value_or(kInfinity));
  sum[kTangential] = outcome.errors.normal_total_n_s.value_or(kInfinity);
  const Impulses<kTangential> here = ImpulsesOf<kTangential>(outcome);
  Scene moved_scene = scene;
  moved_scene.surface_velocity.reset();
  for (const Input<kTangential>& input : *inputs) {
    if (!(input.error <= input.length)) return unknown;
    Impulses<kTangential> change = {};
    for (const double side : {-1.0, 1.0}) {
      if (stopped() || input.length == 0.0) continue;
      Reduction<kTangential> moved = Moved(reduction, input, side * input.length);
      if constexpr (kTangential == 1) {
        if (one_coordinate) moved = MovedInRange(reduction, input, side * input.length);
      }
      moved_scene.system = ContactOf(moved);
      std::optional<SceneContact> contact(std::in_place, moved_scene, moved);
      Outcome there;
      const absl::Status solved =
          SolveScene(moved_scene, contact, demand, {.detail = Detail::kNumbers}, stopped, there);
      if (!solved.ok() || there.termination != outcome.termination) return unknown;
      const Impulses<kTangential> to = ImpulsesOf<kTangential>(there);
      for (size_t i = 0; i <= kTangential; ++i) change[i] = std::max(change[i], std::fabs(to[i] - here[i]));
    }
    if (input.length == 0.0) continue;
    for (size_t i = 0; i <= kTangential; ++i) sum[i] += kSafety * change[i] * (input.error / input.length);
  }
  return sum;
}

// Infinite factors count as 0 where the other one is 0.
double Product(double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : std::fabs(x) * std::fabs(y); }

template <size_t kTangential>
void Set(const Scene& scene, const Reduction<kTangential>& reduction, const Demand& demand,
         absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  const auto& mechanism = std::get<Mechanism>(scene.system);
  const size_t n = mechanism.rates.size();
  constexpr size_t kDirections = kTangential + 1;
  const MechanismErrors errors(mechanism);
  const std::vector<Eigen::Index> free = FreeCoordinates(mechanism);
  const bool one_coordinate = kTangential == 1 && free.size() == 1 && HoldsNothingInMotion(scene, mechanism);
  const Impulses<kTangential> of_impulse =
      ImpulseErrors(scene, reduction, errors, one_coordinate, demand, stopped, outcome);
  const Impulses<kTangential> impulse = ImpulsesOf<kTangential>(outcome);
  std::vector<bool> is_free(n);
  for (const Eigen::Index i : free) is_free[static_cast<size_t>(i)] = true;
  for (size_t i = 0; i < n; ++i) {
    double rate = 0.0, size = 0.0, momentum = 0.0, momentum_size = 0.0;
    for (size_t j = 0; j < kDirections; ++j) {
      const auto error_at = [&](size_t row) {
        return errors.response(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(j));
      };
      const double most = std::fabs(impulse[j]) + of_impulse[j];
      rate += Product(reduction.response[i * kDirections + j], of_impulse[j]) + Product(error_at(i), most);
      size += Product(reduction.response[i * kDirections + j], impulse[j]);
      momentum += Product(reduction.momentum[i * kDirections + j], of_impulse[j]);
      momentum_size += Product(reduction.momentum[i * kDirections + j], impulse[j]);
      if (is_free[i]) continue;
      for (size_t k = 0; k < n; ++k) {
        const double mass = mechanism.mass_matrix[i * n + k];
        const double passed = Product(mass, reduction.response[k * kDirections + j]);
        momentum += Product(Product(mass, error_at(k)) + static_cast<double>(n) * kUnit * passed, most);
      }
    }
    constexpr double kRoundings = (kDirections + 2) * kUnit;
    outcome.errors.rates_after[i] =
        is_free[i] ? 1.01 * rate + kRoundings * (size + std::fabs(mechanism.rates[i])) : 0.0;
    outcome.errors.momentum_change[i] = 1.01 * momentum + kRoundings * momentum_size;
  }
}

}  // namespace

void SetRatesErrors(const Scene& scene, const SceneContact& contact, const Demand& demand,
                    absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  if (!std::holds_alternative<Mechanism>(scene.system)) return;
  std::visit([&](const auto& reduction) { Set(scene, reduction, demand, stopped, outcome); }, contact.reduction);
}

}  // namespace ricochet
