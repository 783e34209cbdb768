#include "core/study/audit_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/answer/planar_outcome.h"
#include "core/answer/scene_outcome.h"
#include "core/answer/spatial_outcome.h"
#include "core/contact/effective.h"
#include "core/contact/reduction.h"
#include "core/numerics/decimal.h"
#include "core/plan/planned_scene.h"
#include "core/problem/scene_problem.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"
#include "core/study/audit.h"
#include "core/study/audit_columns.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

// The contact and its friction, all that an audit takes from a scene.
Scene ContactOf(Scene scene) {
  scene.restitution = std::monostate();
  scene.restitution_by_speed.reset();
  scene.impact_law = std::monostate();
  return scene;
}

std::vector<Violation> ValidateScene(const Scene& scene) {
  std::vector<Violation> violations = Validate(scene, RestitutionIs::kOptional);
  if (!violations.empty()) return violations;
  const AnyReduction any = Reduce(scene);
  if (std::visit([](const auto& reduction) { return reduction.w.back() == 0.0; }, any)) {
    violations.push_back({"system", "makes Wnn = 0: must be > 0 for an audit, no normal impulse moves the contact",
                          ViolationKind::kContact});
  }
  return violations;
}

// How many rates a pendulum or a linkage has.
std::optional<size_t> RateCount(const System& system) {
  if (const auto* linkage = std::get_if<Linkage>(&system); linkage != nullptr) return linkage->links.size();
  if (std::holds_alternative<Pendulum>(system)) return 1;
  return std::nullopt;
}

std::string CountText(size_t found, size_t wanted) {
  return absl::StrCat("has ", found, found == 1 ? " entry" : " entries", ": must have ", wanted);
}

void CheckVelocity(const ContactVelocity& velocity, size_t directions, std::vector<Violation>& violations) {
  const std::vector<double>& tangential = velocity.tangential_m_s;
  if (tangential.size() != directions) {
    violations.push_back({"contact_velocity.tangential_m_s", CountText(tangential.size(), directions)});
  }
  for (size_t i = 0; i < tangential.size(); ++i) {
    if (std::isfinite(tangential[i])) continue;
    violations.push_back(
        MakeViolation(absl::StrCat("contact_velocity.tangential_m_s[", i, "]"), tangential[i], "be finite"));
  }
  if (!std::isfinite(velocity.normal_m_s)) {
    violations.push_back(MakeViolation("contact_velocity.normal_m_s", velocity.normal_m_s, "be finite"));
  }
}

void CheckRates(const std::vector<double>& rates, const System& system, std::vector<Violation>& violations) {
  const std::optional<size_t> wanted = RateCount(system);
  if (!wanted.has_value()) {
    violations.push_back({"rates", "is set: must not be but for a pendulum or a linkage, give contact_velocity"});
    return;
  }
  if (rates.size() != *wanted) violations.push_back({"rates.rates_rad_s", CountText(rates.size(), *wanted)});
  for (size_t i = 0; i < rates.size(); ++i) {
    if (std::isfinite(rates[i])) continue;
    violations.push_back(MakeViolation(absl::StrCat("rates.rates_rad_s[", i, "]"), rates[i], "be finite"));
  }
}

std::vector<Violation> ValidateRequest(const AuditRequest& request) {
  std::vector<Violation> violations = ValidateScene(request.scene);
  const bool has_system = !std::holds_alternative<std::monostate>(request.scene.system);
  if (std::holds_alternative<std::monostate>(request.observed)) {
    violations.push_back({"observed", "is not set: must be one of contact_velocity, rates"});
  } else if (const auto* velocity = std::get_if<ContactVelocity>(&request.observed); velocity != nullptr) {
    if (has_system) CheckVelocity(*velocity, TangentialDirections(request.scene.system), violations);
  } else if (has_system) {
    CheckRates(std::get<ObservedRates>(request.observed).rates_rad_s, request.scene.system, violations);
  }
  const double uncertainty = request.velocity_uncertainty_m_s;
  if (!(uncertainty >= 0.0) || !std::isfinite(uncertainty)) {
    violations.push_back(MakeViolation("velocity_uncertainty_m_s", uncertainty, "be finite and >= 0"));
  }
  return violations;
}

// The contact velocity that the rates make: that of the same scene with them.
ContactVelocity VelocityOf(const ObservedRates& observed, Scene scene) {
  if (auto* pendulum = std::get_if<Pendulum>(&scene.system); pendulum != nullptr) {
    pendulum->omega_minus_rad_s = observed.rates_rad_s[0];
  } else {
    std::vector<Link>& links = std::get<Linkage>(scene.system).links;
    for (size_t i = 0; i < links.size(); ++i) links[i].rate_rad_s = observed.rates_rad_s[i];
  }
  const auto reduction = std::get<PlanarReduction>(Reduce(scene));
  return {.tangential_m_s = {reduction.u0[0]}, .normal_m_s = reduction.v0};
}

ContactVelocity VelocityOf(const Observed& observed, const Scene& scene) {
  const auto* velocity = std::get_if<ContactVelocity>(&observed);
  return velocity != nullptr ? *velocity : VelocityOf(std::get<ObservedRates>(observed), scene);
}

AuditReport Audited(const PlanarReduction& reduction, const EffectiveCoefficients& effective,
                    const ContactVelocity& seen, double uncertainty) {
  return audit::Audit(planar::MakeProblem(reduction, EnergeticCoefficient(), effective),
                      audit::PlanarObservation{seen.tangential_m_s[0], seen.normal_m_s, uncertainty});
}

AuditReport Audited(const SpatialReduction& reduction, const EffectiveCoefficients& effective,
                    const ContactVelocity& seen, double uncertainty) {
  return audit::Audit(
      spatial::MakeProblem(reduction, EnergeticCoefficient(), effective, spatial::kStudyTolerance),
      audit::SpatialObservation{{seen.tangential_m_s[0], seen.tangential_m_s[1]}, seen.normal_m_s, uncertainty});
}

absl::StatusOr<AuditResponse> Checked(const AuditReport& report, const AnyReduction& any) {
  if (const char* path = audit::OverflowIn(report); path != nullptr) return OutputOverflow(path);
  return AuditResponse{.report = report, .contact_energy_j = ContactEnergy(any), .engine = {}};
}

// What a column must be.
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
  const char* const kPlanar = "for a planar system";
  const char* const kByRates = "beside rates_after";
  std::vector<ColumnRule> rules = {
      {"columns.tangential_m_s", in.tangential_m_s, first},
      {"columns.tangential_2_m_s", in.tangential_2_m_s, planar ? Presence::kRefused : first, kPlanar},
      {"columns.normal_m_s", in.normal_m_s, first},
      {"columns.tangential_after_m_s", in.tangential_after_m_s, after, kByRates},
      {"columns.tangential_2_after_m_s", in.tangential_2_after_m_s, planar ? Presence::kRefused : after,
       planar ? kPlanar : kByRates},
      {"columns.normal_after_m_s", in.normal_after_m_s, after, kByRates},
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
  const std::optional<size_t> wanted = RateCount(system);
  if (!wanted.has_value()) {
    violations.push_back(
        {"columns.rates_after", "is set: must not be but for a pendulum or a linkage, give the contact's velocity"});
  } else if (found != *wanted) {
    violations.push_back({"columns.rates_after", CountText(found, *wanted)});
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

// The coefficients that the rows have, one for all unless they depend on the speed.
struct FrictionColumns {
  std::vector<double> kinetic, static_;
};

FrictionColumns FrictionOf(const AuditBatchRequest& request, double scene_speed, size_t rows) {
  const AuditColumns& columns = request.columns;
  if (!columns.friction.empty()) return {columns.friction, {}};
  const bool by_row = request.scene.friction.by_speed.has_value() && !columns.normal_m_s.empty();
  FrictionColumns friction;
  for (size_t row = 0; row < (by_row ? rows : 1); ++row) {
    const double speed = by_row ? std::max(0.0, -ValueAt(columns.normal_m_s, row)) : scene_speed;
    const EffectiveCoefficients effective = EffectiveAt(request.scene, speed);
    friction.kinetic.push_back(effective.kinetic_friction);
    friction.static_.push_back(effective.static_friction);
  }
  return friction;
}

// With the contact velocities that rates make in place of them.
AuditColumns WithVelocities(AuditColumns columns, const Scene& scene, size_t rows) {
  if (columns.rates_after_rad_s.empty()) return columns;
  for (size_t row = 0; row < rows; ++row) {
    ObservedRates seen;
    for (const std::vector<double>& rates : columns.rates_after_rad_s) seen.rates_rad_s.push_back(ValueAt(rates, row));
    const ContactVelocity velocity = VelocityOf(seen, scene);
    columns.tangential_after_m_s.push_back(velocity.tangential_m_s[0]);
    columns.normal_after_m_s.push_back(velocity.normal_m_s);
  }
  return columns;
}

// The column, or the scene's own value where the request has none.
absl::Span<const double> Or(const std::vector<double>& column, const double& own) {
  return column.empty() ? absl::Span<const double>(&own, 1) : absl::Span<const double>(column);
}

using Receiver = absl::FunctionRef<void(int64_t row, const AuditReport& report)>;

absl::StatusOr<AuditSummary> Audited(const PlanarReduction& reduction, const AuditColumns& in,
                                     const FrictionColumns& friction, int64_t rows, Receiver receive) {
  const auto& [tt, tn, nn] = reduction.w;
  return audit::AuditColumns(audit::PlanarColumns{.rows = rows,
                                                  .wtt = {&tt, 1},
                                                  .wtn = {&tn, 1},
                                                  .wnn = {&nn, 1},
                                                  .mu = friction.kinetic,
                                                  .mu_static = friction.static_,
                                                  .u0 = Or(in.tangential_m_s, reduction.u0[0]),
                                                  .v0 = Or(in.normal_m_s, reduction.v0),
                                                  .u1 = in.tangential_after_m_s,
                                                  .v1 = in.normal_after_m_s,
                                                  .uncertainty = in.velocity_uncertainty_m_s},
                             receive);
}

absl::StatusOr<AuditSummary> Audited(const SpatialReduction& reduction, const AuditColumns& in,
                                     const FrictionColumns& friction, int64_t rows, Receiver receive) {
  const auto& [w11, w12, w13, w22, w23, w33] = reduction.w;
  return audit::AuditColumns(
      audit::SpatialColumns{.rows = rows,
                            .w11 = {&w11, 1},
                            .w12 = {&w12, 1},
                            .w13 = {&w13, 1},
                            .w22 = {&w22, 1},
                            .w23 = {&w23, 1},
                            .w33 = {&w33, 1},
                            .mu = friction.kinetic,
                            .mu_static = friction.static_,
                            .u0 = {Or(in.tangential_m_s, reduction.u0[0]), Or(in.tangential_2_m_s, reduction.u0[1])},
                            .u1 = {in.tangential_after_m_s, in.tangential_2_after_m_s},
                            .v0 = Or(in.normal_m_s, reduction.v0),
                            .v1 = in.normal_after_m_s,
                            .uncertainty = in.velocity_uncertainty_m_s,
                            .tolerance = spatial::kStudyTolerance},
      receive);
}

// A pendulum from its own state, in closed form as a single audit has it.
AuditSummary AuditedPendulum(const Scene& scene, const AuditColumns& in, const FrictionColumns& friction, size_t rows,
                             Receiver receive) {
  AuditSummary summary;
  pendulum::Problem problem = ClosedFormProblem(scene);
  for (size_t row = 0; row < rows; ++row) {
    problem.mu = ValueAt(friction.kinetic, row);
    problem.mu_static = friction.static_.empty() ? problem.mu : ValueAt(friction.static_, row);
    const audit::PlanarObservation seen = {
        .u1 = ValueAt(in.tangential_after_m_s, row),
        .v1 = ValueAt(in.normal_after_m_s, row),
        .uncertainty = in.velocity_uncertainty_m_s.empty() ? 0.0 : ValueAt(in.velocity_uncertainty_m_s, row)};
    const bool is_valid = std::isfinite(seen.u1) && std::isfinite(seen.v1) &&
                          Holds(seen.uncertainty, NumberRule::kNotNegative) &&
                          Holds(problem.mu, NumberRule::kNotNegative) &&
                          Holds(problem.mu_static, NumberRule::kNotNegative) && problem.mu_static >= problem.mu;
    AuditReport report = {.regime = Regime::kInvalid};
    if (is_valid) report = audit::Audit(problem, seen);
    if (audit::OverflowIn(report) != nullptr) report = {.regime = Regime::kInvalid};
    audit::Add(static_cast<int64_t>(row), report, summary);
    receive(static_cast<int64_t>(row), report);
  }
  return summary;
}

}  // namespace

absl::StatusOr<AuditResponse> AuditScene(const AuditRequest& request) {
  const std::vector<Violation> violations = ValidateRequest(request);
  if (!violations.empty()) return InvalidRequest(violations);
  const Scene scene = ContactOf(request.scene);
  const AnyReduction any = Reduce(scene);
  const ContactVelocity seen = VelocityOf(request.observed, scene);
  if (!FitsDoubles(any) || !std::isfinite(seen.normal_m_s) || !std::isfinite(seen.tangential_m_s[0]))
    return ContactOverflow();
  const double uncertainty = request.velocity_uncertainty_m_s;
  if (HasClosedForm(scene)) {
    const audit::PlanarObservation observation{seen.tangential_m_s[0], seen.normal_m_s, uncertainty};
    return Checked(audit::Audit(ClosedFormProblem(scene), observation), any);
  }
  const EffectiveCoefficients effective = EffectiveAt(scene, ApproachSpeed(any));
  return Checked(
      std::visit([&](const auto& reduction) { return Audited(reduction, effective, seen, uncertainty); }, any), any);
}

absl::StatusOr<AuditBatchResponse> AuditScene(const AuditBatchRequest& request) {
  std::vector<Violation> violations = ValidateScene(request.scene);
  if (std::holds_alternative<std::monostate>(request.scene.system)) return InvalidRequest(violations);
  const std::vector<ColumnRule> rules = Rules(request.columns, TangentialDirections(request.scene.system));
  const size_t rows = RowsOf(rules);
  CheckRateColumns(request.columns, request.scene.system, violations);
  if (rows > 0) {
    for (Violation& violation : CheckColumns(rules, rows)) violations.push_back(std::move(violation));
  }
  if (!violations.empty()) return InvalidRequest(violations);
  const Scene scene = ContactOf(request.scene);
  const AnyReduction any = Reduce(scene);
  if (!FitsDoubles(any)) return ContactOverflow();
  const AuditColumns columns = WithVelocities(request.columns, scene, rows);
  const FrictionColumns friction = FrictionOf(request, ApproachSpeed(any), rows);
  AuditBatchResponse response;
  response.reports.reserve(rows);
  const auto keep = [&response](int64_t /*row*/, const AuditReport& report) { response.reports.push_back(report); };
  if (HasClosedForm(scene) && columns.normal_m_s.empty()) {
    response.summary = AuditedPendulum(scene, columns, friction, rows, keep);
    return response;
  }
  absl::StatusOr<AuditSummary> summary = std::visit(
      [&](const auto& reduction) { return Audited(reduction, columns, friction, static_cast<int64_t>(rows), keep); },
      any);
  if (!summary.ok()) return summary.status();
  response.summary = *summary;
  return response;
}

}  // namespace ricochet
