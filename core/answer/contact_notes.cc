#include "core/answer/contact_notes.h"

#include <cmath>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/contact/delassus.h"
#include "core/numerics/decimal.h"

namespace ricochet {
namespace {

void AddUndetermined(const char* path, std::string text, Outcome& outcome) {
  outcome.notes.push_back({.kind = NoteKind::kUndetermined, .path = path, .text = std::move(text)});
}

// `full_rank` is the rank that no joint takes anything from.
void AddJamNote(int full_rank, Outcome& outcome) {
  const bool is_rigid = outcome.plan.model == Model::kPlanar || outcome.plan.model == Model::kSpatial;
  if (!is_rigid || outcome.termination != Termination::kRefused || outcome.w_rank >= full_rank) return;
  const double v = outcome.contact_velocity_after.normal_m_s;
  const std::string speed = ShortestDecimal(std::fabs(v));
  AddUndetermined("contact_velocity_after.normal_m_s",
                  v < 0.0 ? absl::StrCat("Friction and the joints hold the contact while it approaches at ", speed,
                                         " m/s: no impulse ends the impact. It has an end with less friction.")
                          : absl::StrCat("Friction and the joints hold the contact while it parts at ", speed,
                                         " m/s: no impulse gives it the speed that Newton's coefficient asks for. "
                                         "State a smaller one, or Poisson's or the energetic coefficient."),
                  outcome);
}

bool IsAtRest(const Components& tangential) {
  for (const double u : tangential) {
    if (u != 0.0) return false;
  }
  return true;
}

}  // namespace

void AddIdleFrictionNote(Outcome& outcome) {
  AddUndetermined("impulse.tangential_n_s",
                  "No tangential impulse moves the contact, and it does not slip: any impulse of friction up to the "
                  "static coefficient times the normal impulse is possible, and 0 is answered.",
                  outcome);
}

void AddContactNotes(const PlanarReduction& reduction, const EffectiveCoefficients& effective, Outcome& outcome) {
  if (reduction.v0 >= 0.0) return;
  AddJamNote(2, outcome);
  if (reduction.w[0] == 0.0 && reduction.u0[0] == 0.0 && effective.static_friction > 0.0) AddIdleFrictionNote(outcome);
}

void AddContactNotes(const SpatialReduction& reduction, const EffectiveCoefficients& effective, Outcome& outcome) {
  if (reduction.v0 >= 0.0) return;
  AddJamNote(3, outcome);
  const auto& w = reduction.w;
  if (!(effective.static_friction > 0.0) || !IsAtRest(outcome.contact_velocity_after.tangential_m_s)) return;
  if (w[0] == 0.0 && w[3] == 0.0) return AddIdleFrictionNote(outcome);
  if (PlanarDelassus{.tt = w[0], .tn = w[1], .nn = w[3]}.Rank() == 2) return;
  AddUndetermined(
      "impulse.tangential_n_s",
      "Wtt is singular: part of the impulse of friction on the contact that sticks changes no velocity. The "
      "smallest impulse is answered.",
      outcome);
}

}  // namespace ricochet
