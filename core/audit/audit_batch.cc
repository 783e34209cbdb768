#include "core/audit/audit_batch.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/answer/scene_outcome.h"
#include "core/audit/audit_parts.h"
#include "core/audit/audit_scene.h"
#include "core/contact/moved_contact.h"
#include "core/contact/reduction.h"
#include "core/scene/check.h"
#include "core/scene/numbers.h"
#include "core/scene/system_velocities.h"
#include "ricochet/audit_columns.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

// Says of a column whether a request must have it, or where it must not.
struct ColumnRule {
  std::string name;
  const std::vector<double>& values;
  bool is_required = false;
  const char* refused_for = nullptr;  // Null if it may have the column.
};

// True if an input states friction, or something else.
bool HasInput(const AuditBatchRequest& request, bool of_friction) {
  return std::any_of(request.inputs.begin(), request.inputs.end(), [of_friction](const InputColumn& input) {
    return absl::StartsWith(input.path, "friction.") == of_friction;
  });
}

ColumnRule RuleOf(const NamedAuditColumn& column, const AuditBatchRequest& request, bool is_planar) {
  const AuditColumns& in = request.columns;
  ColumnRule rule = {absl::StrCat("columns.", column.name), in.*column.values};
  const bool has_rates = !in.rates_after.empty();
  if (column.is_spatial && is_planar) {
    rule.refused_for = "for a planar system";
  } else if (column.part == AuditColumnPart::kAfter) {
    rule.is_required = !has_rates;
    if (has_rates) rule.refused_for = "beside rates_after";
  } else if (column.part == AuditColumnPart::kBefore && has_rates) {
    // The velocities of the system after the impact follow from those before it, not from the contact's alone.
    rule.refused_for = "beside rates_after, the velocities before are those of the scene and its inputs";
  } else if (column.part == AuditColumnPart::kBefore && HasInput(request, /*of_friction=*/false)) {
    rule.refused_for = "beside inputs: give it as an input, too, by the path of its field in the scene";
  } else if (column.values == &AuditColumns::friction && HasInput(request, /*of_friction=*/true)) {
    rule.refused_for = "beside inputs of the scene's friction";
  }
  return rule;
}

std::vector<ColumnRule> Rules(const AuditBatchRequest& request, size_t directions) {
  const AuditColumns& in = request.columns;
  std::vector<ColumnRule> rules;
  for (const NamedAuditColumn& column : kAuditColumns) rules.push_back(RuleOf(column, request, directions == 1));
  for (size_t i = 0; i < request.inputs.size(); ++i) {
    rules.push_back(
        {.name = absl::StrCat("inputs[", i, "].values"), .values = request.inputs[i].values, .is_required = true});
  }
  for (size_t i = 0; i < in.rates_after.size(); ++i) {
    rules.push_back({.name = absl::StrCat("columns.rates_after[", i, "].values"),
                     .values = in.rates_after[i],
                     .is_required = true});
  }
  return rules;
}

void CheckRateColumns(const AuditColumns& columns, const System& system, std::vector<Violation>& violations) {
  const size_t found = columns.rates_after.size();
  if (found == 0) return;
  const size_t wanted = SystemVelocityPaths(system).size();
  if (wanted == 0) {
    violations.push_back(
        MakeViolation("columns.rates_after", "is set", "not be for a contact alone, give the contact's velocity"));
  } else if (found != wanted) {
    violations.push_back(CountViolation("columns.rates_after", found, wanted));
  }
}

size_t RowsOf(const std::vector<ColumnRule>& rules) {
  size_t rows = 0;
  for (const ColumnRule& rule : rules) rows = std::max(rows, rule.values.size());
  return rows;
}

std::vector<Violation> CheckColumns(const std::vector<ColumnRule>& rules, size_t rows) {
  std::vector<Violation> violations;
  if (rows > static_cast<size_t>(kMostAuditRows)) {
    return {MakeViolation("columns", absl::StrCat("has ", rows, " rows"),
                          absl::StrCat("have at most ", kMostAuditRows, " in one call"))};
  }
  for (const ColumnRule& rule : rules) {
    if (IsFull(violations)) break;
    const size_t length = rule.values.size();
    if (rule.refused_for != nullptr) {
      if (length > 0)
        violations.push_back(MakeViolation(rule.name, "is set", absl::StrCat("not be ", rule.refused_for)));
    } else if (length == 0) {
      if (rule.is_required) {
        violations.push_back(MakeViolation(rule.name, "is not set", "have a value a row, or one for all"));
      }
    } else if (length != 1 && length != rows) {
      violations.push_back(
          MakeViolation(rule.name, absl::StrCat("has ", length, " values"), absl::StrCat("have 1 or ", rows)));
    }
  }
  return violations;
}

double ValueAt(const std::vector<double>& column, size_t row) { return column.size() == 1 ? column[0] : column[row]; }

// A column that is left out leaves the number as it is.
void Set(const std::vector<double>& column, size_t row, double& number) {
  if (!column.empty()) number = ValueAt(column, row);
}

bool HasVelocityBefore(const AuditColumns& in) {
  return !in.tangential_m_s.empty() || !in.tangential_2_m_s.empty() || !in.normal_m_s.empty();
}

// Decide whether a row's velocity before the impact is one that its contact can have: the rule of
// audit::CheckScene.
bool HasValidVelocity(const pendulum::Problem& /*problem*/) { return true; }
bool HasValidVelocity(const planar::Problem& in) {
  if (!std::isfinite(in.u0) || !std::isfinite(in.v0)) return false;
  return in.v0 >= 0.0 ||
         VelocityIsInRange(PlanarReduction{.w = {in.w.tt, in.w.tn, in.w.nn}, .u0 = {in.u0}, .v0 = in.v0});
}
bool HasValidVelocity(const spatial::Problem& in) {
  if (!std::isfinite(in.u0[0]) || !std::isfinite(in.u0[1]) || !std::isfinite(in.v0)) return false;
  return in.v0 >= 0.0 || VelocityIsInRange(SpatialReduction{.w = in.Delassus().w, .u0 = in.u0, .v0 = in.v0});
}

// Decides whether a row keeps the rules of its numbers.
bool IsValid(const audit::AnyProblem& any, const audit::Observation& seen) {
  return std::isfinite(seen.u1[0]) && std::isfinite(seen.u1[1]) && std::isfinite(seen.v1) &&
         Holds(seen.uncertainty, NumberRule::kNotNegative) &&
         std::visit(
             [](const auto& problem) {
               return Holds(problem.mu, NumberRule::kNotNegative) &&
                      Holds(problem.mu_static, NumberRule::kNotNegative) && problem.mu_static >= problem.mu &&
                      HasValidVelocity(problem);
             },
             any);
}

void Count(int64_t row, Tally& tally) {
  if (tally.count == 0) tally.first_index = row;
  ++tally.count;
}

}  // namespace

absl::StatusOr<AuditRows> AuditRows::Make(const AuditBatchRequest& request) {
  std::optional<SceneContact> contact;
  std::vector<Violation> violations = request.inputs.empty()
                                          ? audit::CheckScene(request.scene, contact)
                                          : audit::InputScene(request.scene, request.inputs).Violations();
  if (std::holds_alternative<std::monostate>(request.scene.system)) return InvalidRequest(violations);
  const std::vector<ColumnRule> rules = Rules(request, TangentialDirections(request.scene.system));
  const size_t rows = RowsOf(rules);
  CheckRateColumns(request.columns, request.scene.system, violations);
  if (rows > 0) {
    for (Violation& violation : CheckColumns(rules, rows)) violations.push_back(std::move(violation));
  }
  if (!violations.empty()) return InvalidRequest(violations);
  AuditRows made(request, rows);
  if (!request.inputs.empty()) return made;
  if (!FitsDoubles(contact->reduction)) return ContactOverflow();
  made.shared_.emplace(request.scene, *contact, /*from_own_velocity=*/!HasVelocityBefore(request.columns));
  return made;
}

AuditRows::Impact::Impact(Scene its_scene, const SceneContact& contact, bool from_own_velocity)
    : scene(audit::WithoutRestitution(std::move(its_scene))),
      reduction(contact.reduction),
      problem(audit::MakeProblem(scene, contact, from_own_velocity)) {
  if (from_own_velocity) audit::AddTermsBefore(scene, reduction, terms);
}

std::optional<AuditRows::Impact> AuditRows::ImpactAt(size_t row, audit::InputScene& own) const {
  std::optional<SceneContact> contact;
  if (!own.SetRow(row, contact).empty() || !FitsDoubles(contact->reduction)) return std::nullopt;
  return Impact(own.scene(), *contact, /*from_own_velocity=*/!HasVelocityBefore(columns_));
}

absl::StatusOr<AuditReport> AuditRows::Audit(size_t row, audit::InputScene& own,
                                             absl::FunctionRef<bool()> stopped) const {
  std::optional<Impact> of_row;
  if (!shared_.has_value()) {
    of_row = ImpactAt(row, own);
    if (!of_row.has_value()) return AuditReport{.regime = Regime::kInvalid};
  }
  const Impact& impact = of_row.has_value() ? *of_row : *shared_;
  const audit::AnyProblem problem = ProblemAt(row, impact);
  const std::vector<double> rates = RatesAt(row);
  const audit::Observation seen = ObservationAt(row, rates, impact);
  if (!IsValid(problem, seen)) return AuditReport{.regime = Regime::kInvalid};
  absl::StatusOr<AuditReport> report = audit::Audit(problem, seen, stopped);
  if (absl::IsOutOfRange(report.status())) return AuditReport{.regime = Regime::kInvalid};
  if (report.ok() && !columns_.rates_after.empty()) {
    audit::CheckRates(impact.reduction, rates, seen, *report);
  }
  if (report.ok() && audit::OverflowIn(*report) != nullptr) return AuditReport{.regime = Regime::kInvalid};
  return report;
}

audit::AnyProblem AuditRows::ProblemAt(size_t row, const Impact& impact) const {
  audit::AnyProblem any = impact.problem;
  std::visit(
      [&](auto& problem) {
        SetVelocity(row, problem);
        SetFriction(row, impact.scene, problem.mu, problem.mu_static);
      },
      any);
  return any;
}

// A pendulum's closed form is of the scene's own velocity.
void AuditRows::SetVelocity(size_t /*row*/, pendulum::Problem& /*problem*/) const {}

void AuditRows::SetVelocity(size_t row, planar::Problem& problem) const {
  Set(columns_.tangential_m_s, row, problem.u0);
  Set(columns_.normal_m_s, row, problem.v0);
}

void AuditRows::SetVelocity(size_t row, spatial::Problem& problem) const {
  Set(columns_.tangential_m_s, row, problem.u0[0]);
  Set(columns_.tangential_2_m_s, row, problem.u0[1]);
  Set(columns_.normal_m_s, row, problem.v0);
}

void AuditRows::SetFriction(size_t row, const Scene& scene, double& mu, double& mu_static) const {
  if (!columns_.friction.empty()) {
    mu = mu_static = ValueAt(columns_.friction, row);
  } else if (scene.friction.by_speed.has_value() && !columns_.normal_m_s.empty()) {
    const EffectiveCoefficients effective =
        CoefficientsAtSpeed(scene, std::max(0.0, -ValueAt(columns_.normal_m_s, row)));
    mu = effective.kinetic_friction;
    mu_static = effective.static_friction;
  }
}

std::vector<double> AuditRows::RatesAt(size_t row) const {
  std::vector<double> rates;
  for (const std::vector<double>& column : columns_.rates_after) rates.push_back(ValueAt(column, row));
  return rates;
}

audit::Observation AuditRows::ObservationAt(size_t row, absl::Span<const double> rates, const Impact& impact) const {
  audit::Observation seen = impact.terms;
  if (!columns_.rates_after.empty()) {
    const ContactVelocity velocity = ContactVelocityAt(impact.scene, rates);
    audit::AddTerms(impact.scene, rates, seen);
    std::copy(velocity.tangential_m_s.begin(), velocity.tangential_m_s.end(), seen.u1.begin());
    seen.v1 = velocity.normal_m_s;
  } else {
    seen.u1[0] = ValueAt(columns_.tangential_after_m_s, row);
    if (!columns_.tangential_2_after_m_s.empty()) seen.u1[1] = ValueAt(columns_.tangential_2_after_m_s, row);
    seen.v1 = ValueAt(columns_.normal_after_m_s, row);
  }
  if (!columns_.velocity_uncertainty_m_s.empty()) seen.uncertainty = ValueAt(columns_.velocity_uncertainty_m_s, row);
  return seen;
}

namespace audit {

void Add(int64_t row, const AuditReport& report, AuditSummary& summary) {
  ++summary.rows;
  if (report.regime == Regime::kInvalid) return Count(row, summary.invalid);
  if (report.admissible) ++summary.admissible;
  if (report.unexplained) Count(row, summary.unexplained);
  for (size_t i = 0; i < report.limits.size(); ++i) {
    const LimitCheck& check = report.limits[i];
    if (check.verdict == Verdict::kWithinUncertainty) Count(row, summary.within_uncertainty[i]);
    if (check.verdict != Verdict::kBroken) continue;
    Count(row, summary.broken[i]);
    summary.largest_excess[i] = std::max(summary.largest_excess[i], check.excess);
  }
}

}  // namespace audit

AuditSummary Summarize(const std::vector<AuditReport>& reports) {
  AuditSummary summary;
  for (size_t row = 0; row < reports.size(); ++row) audit::Add(static_cast<int64_t>(row), reports[row], summary);
  return summary;
}

}  // namespace ricochet
