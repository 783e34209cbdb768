#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/answer/scene_outcome.h"
#include "core/contact/coefficients_at_speed.h"
#include "core/contact/reduction.h"
#include "core/scene/numbers.h"
#include "core/study/audit.h"
#include "core/study/audit_parts.h"
#include "core/study/audit_scene.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

// Presence says whether a request must, may or must not have a column.
enum class Presence { kRequired, kOptional, kRefused };

struct ColumnRule {
  std::string name;
  const std::vector<double>& values;
  Presence presence;
  const char* refused_for = "";
};

std::vector<ColumnRule> Rules(const AuditColumns& in, size_t directions) {
  const bool before = !in.tangential_m_s.empty() || !in.tangential_2_m_s.empty() || !in.normal_m_s.empty();
  const Presence first = before ? Presence::kRequired : Presence::kOptional;
  const bool by_rates = !in.rates_after_rad_s.empty();
  const Presence after = by_rates ? Presence::kRefused : Presence::kRequired;
  const bool planar = directions == 1;
  const char* const for_planar = "for a planar system";
  const char* const beside_rates = "beside rates_after";
  std::vector<ColumnRule> rules = {
      {"columns.tangential_m_s", in.tangential_m_s, first},
      {"columns.tangential_2_m_s", in.tangential_2_m_s, planar ? Presence::kRefused : first, for_planar},
      {"columns.normal_m_s", in.normal_m_s, first},
      {"columns.tangential_after_m_s", in.tangential_after_m_s, after, beside_rates},
      {"columns.tangential_2_after_m_s", in.tangential_2_after_m_s, planar ? Presence::kRefused : after,
       planar ? for_planar : beside_rates},
      {"columns.normal_after_m_s", in.normal_after_m_s, after, beside_rates},
      {"columns.friction", in.friction, Presence::kOptional},
      {"columns.velocity_uncertainty_m_s", in.velocity_uncertainty_m_s, Presence::kOptional}};
  for (size_t i = 0; i < in.rates_after_rad_s.size(); ++i) {
    rules.push_back(
        {absl::StrCat("columns.rates_after[", i, "].rates_rad_s"), in.rates_after_rad_s[i], Presence::kRequired});
  }
  return rules;
}

void CheckRateColumns(const AuditColumns& columns, const System& system, std::vector<Violation>& violations) {
  const size_t found = columns.rates_after_rad_s.size();
  if (found == 0) return;
  const std::optional<size_t> wanted = audit::RateCount(system);
  if (!wanted.has_value()) {
    violations.push_back(
        {"columns.rates_after", "is set: must not be but for a pendulum or a linkage, give the contact's velocity"});
  } else if (found != *wanted) {
    violations.push_back({"columns.rates_after", audit::CountText(found, *wanted)});
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
    return {{"columns", absl::StrCat("has ", rows, " rows: must have at most ", kMostAuditRows, " in one call")}};
  }
  for (const ColumnRule& rule : rules) {
    if (IsFull(violations)) break;
    const size_t length = rule.values.size();
    if (rule.presence == Presence::kRefused) {
      if (length > 0) violations.push_back({rule.name, absl::StrCat("is set: must not be ", rule.refused_for)});
    } else if (length == 0) {
      if (rule.presence == Presence::kRequired) {
        violations.push_back({rule.name, "is not set: must have a value a row, or one for all"});
      }
    } else if (length != 1 && length != rows) {
      violations.push_back({rule.name, absl::StrCat("has ", length, " values: must have 1 or ", rows)});
    }
  }
  return violations;
}

double ValueAt(const std::vector<double>& column, size_t row) { return column.size() == 1 ? column[0] : column[row]; }

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

// Rows gives the problem and the observation of each row of a batch whose columns are valid.
class Rows {
 public:
  Rows(const AuditColumns& columns, Scene scene, const SceneContact& contact)
      : columns_(columns),
        scene_(std::move(scene)),
        scene_problem_(audit::MakeProblem(scene_, contact, /*from_own_velocity=*/columns.normal_m_s.empty())) {}

  // A row that breaks a rule or whose report overflows is reported as kInvalid.
  // Errors: CANCELLED once `stopped` returns true.
  absl::StatusOr<AuditReport> Audit(size_t row, absl::FunctionRef<bool()> stopped) const {
    const audit::AnyProblem problem = ProblemAt(row);
    const audit::Observation seen = ObservationAt(row);
    if (!IsValid(problem, seen)) return AuditReport{.regime = Regime::kInvalid};
    absl::StatusOr<AuditReport> report = audit::Audit(problem, seen, stopped);
    if (report.ok() && audit::OverflowIn(*report) != nullptr) return AuditReport{.regime = Regime::kInvalid};
    return report;
  }

 private:
  static bool IsValid(const audit::AnyProblem& any, const audit::Observation& seen) {
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

  audit::AnyProblem ProblemAt(size_t row) const {
    audit::AnyProblem any = scene_problem_;
    std::visit(
        [&](auto& problem) {
          if (!columns_.normal_m_s.empty()) SetVelocity(row, problem);
          SetFriction(row, problem.mu, problem.mu_static);
        },
        any);
    return any;
  }

  // A pendulum's closed form is of the scene's own velocity.
  void SetVelocity(size_t /*row*/, pendulum::Problem& /*problem*/) const {}
  void SetVelocity(size_t row, planar::Problem& problem) const {
    problem.u0 = ValueAt(columns_.tangential_m_s, row);
    problem.v0 = ValueAt(columns_.normal_m_s, row);
  }
  void SetVelocity(size_t row, spatial::Problem& problem) const {
    problem.u0 = {ValueAt(columns_.tangential_m_s, row), ValueAt(columns_.tangential_2_m_s, row)};
    problem.v0 = ValueAt(columns_.normal_m_s, row);
  }

  void SetFriction(size_t row, double& mu, double& mu_static) const {
    if (!columns_.friction.empty()) {
      mu = mu_static = ValueAt(columns_.friction, row);
    } else if (scene_.friction.by_speed.has_value() && !columns_.normal_m_s.empty()) {
      const EffectiveCoefficients effective =
          CoefficientsAtSpeed(scene_, std::max(0.0, -ValueAt(columns_.normal_m_s, row)));
      mu = effective.kinetic_friction;
      mu_static = effective.static_friction;
    }
  }

  audit::Observation ObservationAt(size_t row) const {
    audit::Observation seen;
    if (!columns_.rates_after_rad_s.empty()) {
      ObservedRates rates;
      for (const std::vector<double>& column : columns_.rates_after_rad_s) {
        rates.rates_rad_s.push_back(ValueAt(column, row));
      }
      const ContactVelocity velocity = audit::VelocityOf(rates, scene_);
      seen.u1[0] = velocity.tangential_m_s[0];
      seen.v1 = velocity.normal_m_s;
    } else {
      seen.u1[0] = ValueAt(columns_.tangential_after_m_s, row);
      if (!columns_.tangential_2_after_m_s.empty()) seen.u1[1] = ValueAt(columns_.tangential_2_after_m_s, row);
      seen.v1 = ValueAt(columns_.normal_after_m_s, row);
    }
    if (!columns_.velocity_uncertainty_m_s.empty()) seen.uncertainty = ValueAt(columns_.velocity_uncertainty_m_s, row);
    return seen;
  }

  const AuditColumns& columns_;
  Scene scene_;
  audit::AnyProblem scene_problem_;  // From the scene's own velocity.
};

void Count(int64_t row, Tally& tally) {
  if (tally.count == 0) tally.first_index = row;
  ++tally.count;
}

}  // namespace

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

absl::StatusOr<AuditBatchResponse> AuditScene(const AuditBatchRequest& request, absl::FunctionRef<bool()> stopped) {
  std::optional<SceneContact> contact;
  std::vector<Violation> violations = audit::CheckScene(request.scene, contact);
  if (std::holds_alternative<std::monostate>(request.scene.system)) return InvalidRequest(violations);
  const std::vector<ColumnRule> rules = Rules(request.columns, TangentialDirections(request.scene.system));
  const size_t rows = RowsOf(rules);
  CheckRateColumns(request.columns, request.scene.system, violations);
  if (rows > 0) {
    for (Violation& violation : CheckColumns(rules, rows)) violations.push_back(std::move(violation));
  }
  if (!violations.empty()) return InvalidRequest(violations);
  Scene scene = audit::WithoutRestitution(request.scene);
  if (!FitsDoubles(contact->reduction)) return ContactOverflow();
  const Rows batch(request.columns, std::move(scene), *contact);
  AuditBatchResponse response;
  response.reports.reserve(rows);
  for (size_t row = 0; row < rows; ++row) {
    if (stopped()) return absl::CancelledError("the audit was stopped by its caller");
    const absl::StatusOr<AuditReport> report = batch.Audit(row, stopped);
    if (!report.ok()) return report.status();
    audit::Add(static_cast<int64_t>(row), *report, response.summary);
    response.reports.push_back(*report);
  }
  return response;
}

}  // namespace ricochet
