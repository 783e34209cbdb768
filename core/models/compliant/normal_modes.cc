#include "core/models/compliant/normal_modes.h"

#include <algorithm>
#include <cmath>

namespace ricochet::compliant {
namespace {

// Writes the eigenvectors of K = [k11, k12; k12, k22] and the larger frequency.
void FindEigenvectors(double k11, double k12, double k22, NormalModes& modes) {
  const double half = 0.5 * (k11 - k22);
  const double large = std::max(std::fabs(half), std::fabs(k12));
  const double small = std::min(std::fabs(half), std::fabs(k12));
  if (!(large > 0.0)) {
    modes.w.fast = std::sqrt(k11);
    return;
  }
  const double radius = large * std::sqrt(1.0 + small / large * (small / large));
  const double major = std::sqrt(0.5 * (1.0 + std::fabs(half) / radius));
  const double minor = 0.5 * k12 / radius / major;
  modes.c = half >= 0.0 ? major : minor;
  modes.s = half >= 0.0 ? minor : major;
  modes.w.fast = std::sqrt(0.5 * (k11 + k22) + radius);
}

std::array<double, 2> AlongEigenvectors(const NormalModes& modes, double first, double second) {
  return {modes.c * first + modes.s * second, modes.c * second - modes.s * first};
}

}  // namespace

NormalModes MakeNormalModes(const SpringContact& contact, const SectionMode& mode, const ContactState& state) {
  const double ratio = std::sqrt(contact.ratio_squared);
  const double root = contact.RootOfStiffness(mode.branch);
  NormalModes modes;
  FindEigenvectors(contact.wtt / contact.ratio_squared, -contact.wtn * root / ratio,
                   contact.NormalStiffness(mode.branch) * contact.wnn, modes);
  // The product of the frequencies is sqrt(det K), which does not cancel.
  modes.w.slow = root * std::sqrt(contact.determinant / contact.ratio_squared) / modes.w.fast;
  modes.y = AlongEigenvectors(modes, ratio * state.spring_force, state.normal_force / root);
  modes.rate = AlongEigenvectors(modes, state.u / ratio, -state.v * root);
  if (contact.u_follows_v) modes.rate[1] = 0.0;
  modes.w.slow = std::min(modes.w.slow, modes.w.fast);
  return modes;
}

Oscillations NormalModes::At(const Phase& phase) const {
  Oscillations at;
  for (size_t i = 0; i < 2; ++i) {
    at.y[i] = y[i] * phase.c[i] + rate[i] * phase.s[i];
    at.rate[i] = rate[i] * phase.c[i] - w[i] * w[i] * y[i] * phase.s[i];
  }
  return at;
}

Signal NormalModes::Combination(double first, double second) const {
  return {.a = {first * y[0], second * y[1]}, .b = {first * rate[0], second * rate[1]}};
}

Signal NormalForce(const SpringContact& contact, const SectionMode& mode, const NormalModes& modes) {
  const double root = contact.RootOfStiffness(mode.branch);
  return modes.Combination(root * modes.s, root * modes.c);
}

Signal ConeMargin(const SpringContact& contact, const SectionMode& mode, const NormalModes& modes, int side) {
  const double normal = contact.mu * contact.RootOfStiffness(mode.branch);
  const double tangential = side / std::sqrt(contact.ratio_squared);
  return modes.Combination(normal * modes.s - tangential * modes.c, normal * modes.c + tangential * modes.s);
}

Signal NormalSpeed(const SpringContact& contact, const SectionMode& mode, const NormalModes& modes) {
  const double sign = (mode.indenting ? 1.0 : -1.0) / contact.RootOfStiffness(mode.branch);
  const double first = sign * modes.s;
  const double second = sign * modes.c;
  const double fast2 = modes.w.fast * modes.w.fast;
  const double slow2 = modes.w.slow * modes.w.slow;
  return {.a = {first * modes.rate[0], second * modes.rate[1]},
          .b = {-first * fast2 * modes.y[0], -second * slow2 * modes.y[1]}};
}

}  // namespace ricochet::compliant
