#include "core/answer/rates_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "core/answer/impulse_changes.h"
#include "core/contact/mechanism.h"
#include "core/contact/reduction.h"
#include "core/models/restitution_law.h"

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-53;

// Returns by how much the coefficients at the exact approach speed may differ from those used for the impact.
EffectiveCoefficients CoefficientErrors(const Scene& scene, double speed, double speed_error) {
  EffectiveCoefficients errors;
  if (!DependsOnSpeed(scene)) return errors;
  const double step = 2.0 * (speed_error + kUnit * speed);
  const EffectiveCoefficients here = CoefficientsAtSpeed(scene, speed);
  for (const double other : {std::fmax(speed - step, 0.0), speed + step}) {
    const EffectiveCoefficients there = CoefficientsAtSpeed(scene, other);
    const auto widen = [](double from, double to, double& error) { error = std::fmax(error, std::fabs(to - from)); };
    widen(here.kinetic_friction, there.kinetic_friction, errors.kinetic_friction);
    widen(here.static_friction, there.static_friction, errors.static_friction);
    errors.restitution = errors.restitution.value_or(0.0);
    widen(here.restitution.value_or(0.0), there.restitution.value_or(0.0), *errors.restitution);
  }
  return errors;
}

// Returns the errors of W and of the contact velocity: those of their sums, and the later corrections of the sums.
template <size_t kTangential>
ContactErrors<kTangential> ErrorsOf(const Scene& scene, const Reduction<kTangential>& reduction,
                                    const MechanismErrors& errors) {
  const auto index = [](size_t i) { return static_cast<Eigen::Index>(i); };
  ContactErrors<kTangential> of;
  size_t k = 0;
  for (size_t i = 0; i <= kTangential; ++i) {
    for (size_t j = i; j <= kTangential; ++j, ++k) {
      const double settled = std::fabs(errors.solved.w(index(i), index(j)) - reduction.w[k]);
      of.w[i][j] = of.w[j][i] = errors.w(index(i), index(j)) + settled;
    }
  }
  for (size_t i = 0; i <= kTangential; ++i) {
    const double velocity = i == kTangential ? reduction.v0 : reduction.u0[std::min(i, kTangential - 1)];
    double surface = 0.0;
    if (scene.surface_velocity.has_value()) {
      const SurfaceVelocity& moves = *scene.surface_velocity;
      surface = i == kTangential ? moves.normal_m_s : moves.tangential_m_s.empty() ? 0.0 : moves.tangential_m_s[i];
    }
    const double relative = errors.motion.velocity[i] - surface;
    const bool rounds = surface != 0.0 && errors.motion.velocity[i] != 0.0;
    of.velocity[i] =
        errors.velocity(index(i)) + std::fabs(relative - velocity) + (rounds ? kUnit * std::fabs(relative) : 0.0);
  }
  of.coefficients = CoefficientErrors(scene, std::fmax(-reduction.v0, 0.0), of.velocity[kTangential]);
  return of;
}

// Returns what moves the contact, which does not depend on the numbers of M and J.
Freedom FreedomOf(const Scene& scene, const Mechanism& mechanism, const std::vector<bool>& is_free) {
  const auto count = std::count(is_free.begin(), is_free.end(), true);
  bool is_alone = !scene.surface_velocity.has_value();
  for (size_t i = 0; i < is_free.size(); ++i) is_alone = is_alone && (is_free[i] || mechanism.rates[i] == 0.0);
  if (count == 1) return is_alone ? Freedom::kOneAlone : Freedom::kOneBesideOthers;
  return count == 2 && is_alone ? Freedom::kTwoAlone : Freedom::kMany;
}

// Returns the errors of the impulses, of the model and by its contact; nothing if all free coordinates surely stop.
template <size_t kTangential>
std::optional<Impulses<kTangential>> TotalErrors(const Scene& scene, const Reduction<kTangential>& reduction,
                                                 const MechanismErrors& errors, Freedom freedom,
                                                 const Outcome& outcome) {
  std::optional<Impulses<kTangential>> sum = ImpulseChanges(reduction, LawAndCoefficientOf(scene.restitution).law,
                                                            ErrorsOf(scene, reduction, errors), freedom, outcome);
  if (outcome.regime == Regime::kSeparating || !sum.has_value()) return sum;
  for (size_t i = 0; i < kTangential; ++i) (*sum)[i] += outcome.errors.tangential_n_s.value_or(kInfinity);
  (*sum)[kTangential] += outcome.errors.normal_total_n_s.value_or(kInfinity);
  return sum;
}

// Returns |x y|, where 0 times infinity counts as 0.
double Product(double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : std::fabs(x) * std::fabs(y); }

// A mechanism whose free coordinates all stop is at rest, whatever errors its impulses have.
void SetErrorsAtRest(const Mechanism& mechanism, Outcome& outcome) {
  const size_t n = mechanism.rates.size();
  for (size_t i = 0; i < n; ++i) {
    double lost = 0.0, size = 0.0;
    for (size_t k = 0; k < n; ++k) {
      const double part = mechanism.mass_matrix[i * n + k] * mechanism.rates[k];
      lost += part;
      size += std::fabs(part);
    }
    outcome.errors.rates_after[i] = std::fabs(outcome.rates_after[i]);
    outcome.errors.momentum_change[i] =
        std::fabs(outcome.momentum_change[i] + lost) + static_cast<double>(n + 2) * kUnit * size;
  }
}

template <size_t kTangential>
void Set(const Scene& scene, const Reduction<kTangential>& reduction, Outcome& outcome) {
  const auto& mechanism = std::get<Mechanism>(scene.system);
  const size_t n = mechanism.rates.size();
  constexpr size_t kDirections = kTangential + 1;
  const MechanismErrors errors(mechanism);
  std::vector<bool> is_free(n);
  for (const Eigen::Index i : FreeCoordinates(mechanism)) is_free[static_cast<size_t>(i)] = true;
  const auto total = TotalErrors(scene, reduction, errors, FreedomOf(scene, mechanism, is_free), outcome);
  if (!total.has_value()) return SetErrorsAtRest(mechanism, outcome);
  const Impulses<kTangential>& of_impulse = *total;
  Impulses<kTangential> impulse;
  std::copy_n(outcome.impulse.tangential_n_s.begin(), kTangential, impulse.begin());
  impulse[kTangential] = outcome.impulse.normal_total_n_s;
  const bool is_still = impulse == Impulses<kTangential>{} && of_impulse == Impulses<kTangential>{};
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
        is_free[i] && !is_still ? 1.01 * rate + kRoundings * (size + std::fabs(mechanism.rates[i])) : 0.0;
    outcome.errors.momentum_change[i] = 1.01 * momentum + kRoundings * momentum_size;
  }
}

}  // namespace

void SetRatesErrors(const Scene& scene, const SceneContact& contact, Outcome& outcome) {
  if (!std::holds_alternative<Mechanism>(scene.system)) return;
  std::visit([&](const auto& reduction) { Set(scene, reduction, outcome); }, contact.reduction);
}

}  // namespace ricochet
