#include "tests/fuzz/outcome_claims.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "core/contact/reduction.h"
#include "core/scene/validate.h"
#include "ricochet/error.h"
#include "ricochet/outcome_numbers.h"
#include "ricochet/solver.h"
#include "tests/fuzz/fail.h"

namespace ricochet {
namespace {

void Require(bool kept, const char* claim, double value, double limit) {
  if (!kept) Fail(absl::StrCat(claim, ": ", value, " against ", limit));
}

double Length(absl::Span<const double> numbers) {
  double length = 0.0;
  for (const double number : numbers) length = std::hypot(length, number);
  return length;
}

// The sum of the stated errors of the works and of the change of energy; nothing if one of them has none.
std::optional<double> StatedErrorOfWorks(const Outcome& outcome) {
  const NumberErrors& errors = outcome.errors;
  double sum = 0.0;
  for (const std::optional<double>& error :
       {errors.normal_compression_j, errors.normal_restitution_j, errors.tangential_compression_j,
        errors.tangential_restitution_j, errors.energy_change_j}) {
    if (!error.has_value()) return std::nullopt;
    sum += *error;
  }
  return sum;
}

double ErrorOfWorks(const Outcome& outcome) {
  if (const std::optional<double> stated = StatedErrorOfWorks(outcome)) return *stated;
  if (outcome.plan.model != Model::kFiniteDuration) return 0.0;
  constexpr double kIntegrated = 0x1p-30;
  const WorkLedger& work = outcome.work;
  return kIntegrated * (std::fabs(work.normal_compression_j.value_or(0.0)) + std::fabs(work.normal_total_j) +
                        std::fabs(work.tangential_total_j) + std::fabs(outcome.energy_change_j));
}

// Bounds on the changes of works and impulses by rounding and by the model's own error.
struct Slack {
  double work = 0.0;
  double impulse = 0.0;
};

Slack SlackOf(const Scene& scene, const Outcome& outcome) {
  const ContactVelocity& after = outcome.contact_velocity_after;
  const double impulse = outcome.impulse.normal_total_n_s + Length(outcome.impulse.tangential_n_s);
  double speed = std::max(Length(after.tangential_m_s), std::fabs(after.normal_m_s));
  double mobility = 0.0;
  double normal_mobility = 0.0;
  std::visit(
      [&](const auto& reduction) {
        for (const double entry : reduction.w) mobility += std::fabs(entry);
        for (const double u : reduction.u0) speed = std::max(speed, std::fabs(u));
        speed = std::max(speed, std::fabs(reduction.v0));
        normal_mobility = reduction.w.back();
      },
      Reduce(scene));
  constexpr double kRounding = 0x1p-40;
  constexpr double kSmallest = 0x1p-1060;
  const double error = outcome.accuracy.relative_error + kRounding;
  const double changed = speed + mobility * impulse;
  const double unseen = error * speed / normal_mobility;
  return {.work = error * changed * impulse + unseen * speed + ErrorOfWorks(outcome) + kSmallest,
          .impulse = error * (2.0 * impulse) + unseen + kSmallest};
}

bool IsCoulomb(const Scene& scene) { return std::holds_alternative<std::monostate>(scene.impact_law); }
// True if the caller excludes that slip stops or turns, or higher orders: friction may then not oppose slip.
bool ForcesSlip(const Outcome& outcome) {
  const std::vector<PlannedEffect> effects = outcome.plan.effects.List();
  return std::any_of(effects.begin(), effects.end(), [](const PlannedEffect& planned) {
    const bool is_of_slip = planned.effect == Effect::kSlipStop || planned.effect == Effect::kSlipTurn ||
                            planned.effect == Effect::kHigherOrder;
    return is_of_slip && planned.decision == Decision::kExcluded;
  });
}
bool HasForces(const Scene& scene) { return !std::holds_alternative<std::monostate>(scene.finite_forces); }

void CheckNumbers(const Outcome& outcome) {
  VisitOutcomeNumbers(outcome, [](const NumberPath& path, double number) {
    if (!std::isfinite(number) && !MayBeInfinite(path)) {
      Fail(absl::StrCat(path.prefix, ".", path.name, " = ", number));
    }
  });
  if (outcome.admissible != outcome.broken_limits.empty()) Fail("admissible against broken_limits");
}

// The ledger may be open by this: the stated errors, if there are such, and the rounding of its own sum.
double LedgerSlack(const Outcome& outcome, double slack) {
  const std::optional<double> stated = StatedErrorOfWorks(outcome);
  if (!stated.has_value()) return slack;
  constexpr double kRounding = 0x1p-50;
  constexpr double kSmallest = 0x1p-1060;
  const WorkLedger& work = outcome.work;
  const double largest = std::fabs(work.normal_compression_j.value_or(0.0)) + std::fabs(work.normal_total_j) +
                         std::fabs(work.tangential_compression_j.value_or(0.0)) + std::fabs(work.tangential_total_j);
  return *stated + kRounding * largest + kSmallest;
}

void CheckWorks(const Scene& scene, const Outcome& outcome, double slack) {
  const WorkLedger& work = outcome.work;
  const bool has_phases = work.normal_compression_j.has_value() && work.normal_restitution_j.has_value() &&
                          work.tangential_compression_j.has_value() && work.tangential_restitution_j.has_value();
  if (has_phases != IsCoulomb(scene)) Fail("the works of the phases are unset without an impact law, or set with one");
  const double sum = has_phases ? *work.normal_compression_j + *work.normal_restitution_j +
                                      *work.tangential_compression_j + *work.tangential_restitution_j
                                : work.normal_total_j + work.tangential_total_j;
  const double open = std::fabs(sum - outcome.energy_change_j);
  Require(open <= LedgerSlack(outcome, slack), "the ledger is open", sum, outcome.energy_change_j);
  if (!IsCoulomb(scene)) return;
  Require(work.normal_compression_j <= slack, "compression gives work", *work.normal_compression_j, slack);
  Require(work.normal_restitution_j >= -slack, "restitution takes work", *work.normal_restitution_j, slack);
  if (ForcesSlip(outcome)) return;
  Require(work.friction_dissipation_j >= -slack, "friction gives work", work.friction_dissipation_j, slack);
  Require(work.tangential_spring_j >= -slack, "the spring's rest is negative", work.tangential_spring_j, slack);
}

void CheckEnergy(const Scene& scene, const Outcome& outcome, double slack) {
  const bool energetic = std::holds_alternative<EnergeticCoefficient>(scene.restitution);
  const bool flagged = !outcome.admissible;
  Require(flagged || outcome.energy_change_j <= slack, "a gain is not flagged", outcome.energy_change_j, slack);
  if (!energetic || ForcesSlip(outcome)) return;
  Require(outcome.energy_change_j <= slack, "energy rises", outcome.energy_change_j, slack);
  if (flagged) Fail("an energetic coefficient is inadmissible");
}

void CheckCone(const Outcome& outcome, double slack) {
  const double limit = outcome.effective.static_friction * outcome.impulse.normal_total_n_s;
  const double friction = Length(outcome.impulse.tangential_n_s);
  Require(friction <= limit + slack * (1.0 + outcome.effective.static_friction), "friction leaves its cone", friction,
          limit);
}

void CheckTimeline(const Outcome& outcome, double slack) {
  double before = 0.0;
  for (const Event& event : outcome.timeline) {
    const double tau = event.state.normal_impulse_n_s;
    Require(tau >= before - slack, "the timeline runs back", tau, before);
    before = tau;
  }
  if (outcome.timeline.empty()) return;
  Require(std::fabs(before - outcome.impulse.normal_total_n_s) <= slack, "the timeline ends elsewhere", before,
          outcome.impulse.normal_total_n_s);
}

}  // namespace

void CheckStatus(const absl::Status& status, bool valid_scene, bool inadmissible_is_error) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
      if (!valid_scene) Fail("an invalid scene is answered");
      return;
    case absl::StatusCode::kInvalidArgument:
      if (ViolationsOf(status).empty()) Fail("INVALID_ARGUMENT without violations");
      return;
    case absl::StatusCode::kOutOfRange:
      if (valid_scene && ReasonOf(status) == ErrorReason::kOutputOverflow) return;
      if (valid_scene && ReasonOf(status) == ErrorReason::kNotEnded) return;
      break;
    case absl::StatusCode::kFailedPrecondition:
      if (valid_scene && inadmissible_is_error) return;
      break;
    default:
      break;
  }
  Fail(absl::StrCat("status ", status.ToString()));
}

void CheckOutcome(const Scene& scene, const Outcome& outcome) {
  CheckNumbers(outcome);
  const Slack slack = SlackOf(scene, outcome);
  if (!std::isfinite(slack.work))
    return;  // The answer says that it has not converged, or doubles cannot represent the limits.
  const double normal = outcome.impulse.normal_total_n_s;
  Require(normal >= -slack.impulse, "the surface pulls", normal, slack.impulse);
  CheckWorks(scene, outcome, slack.work);
  CheckTimeline(outcome, slack.impulse);
  if (!IsCoulomb(scene)) return;
  CheckCone(outcome, slack.impulse);
  if (!HasForces(scene)) CheckEnergy(scene, outcome, slack.work);
}

absl::StatusOr<SolveResponse> SolveAndCheck(const SolveRequest& request) {
  const bool valid = Validate(request.scene).empty();
  absl::StatusOr<SolveResponse> response = LocalSolver().Solve(request);
  CheckStatus(response.status(), valid, request.inadmissible_is_error);
  if (response.ok()) CheckOutcome(request.scene, response->outcome);
  return response;
}

bool TakesTime(const SolveRequest& request) {
  PlanRequest plan = {.scene = request.scene, .demand = request.demand};
  if (request.force_intervals > 0) plan.demand.required.push_back(Effect::kFiniteDuration);
  const absl::StatusOr<PlanResponse> response = LocalSolver().Plan(plan);
  return response.ok() && response->plan.model == Model::kFiniteDuration;
}

}  // namespace ricochet
