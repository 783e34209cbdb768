// Fuzzes the door and all models without a duration: bytes are a v1::SolveRequest, which is solved, swept, bounded and
// audited.
//
// The target checks the claims of tests/fuzz/outcome_claims.h. In addition, bounds are intervals, and the one of the
// energetic coefficient is within [0, 1]; an impact under the energetic coefficient breaks no limit in its own audit;
// any velocity can be audited; a sweep has the bits of Solve; the numbers of a certificate have a decimal or two ends;
// and Newton's coefficient of a pendulum is that of its certificate to its stated error, or to 2^-45 of it or of
// 2^-700, below which plain arithmetic claims nothing (core/models/pendulum/pendulum.h).
//
// tests/fuzz/run.sh lists the code that it covers.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "core/certified/certified.h"
#include "core/scene/validate.h"
#include "proto/wire/requests.h"
#include "ricochet/solver.h"
#include "tests/fuzz/fail.h"
#include "tests/fuzz/mutate_message.h"
#include "tests/fuzz/outcome_claims.h"

namespace ricochet {
namespace {

void CheckInterval(const Range& range, const char* what) {
  if (!(range.lower <= range.upper)) Fail(what);
}

void CheckBounds(const Scene& scene) {
  const absl::StatusOr<BoundsResponse> response = LocalSolver().Bounds({.scene = scene, .ranges = {}});
  CheckStatus(response.status(), Validate(scene, RestitutionIs::kOptional).empty());
  if (!response.ok()) return;
  const CoefficientBounds& sharp = response->bounds.sharp;
  CheckInterval(sharp.newton, "bounds of Newton's coefficient");
  CheckInterval(sharp.poisson, "bounds of Poisson's coefficient");
  CheckInterval(sharp.energetic, "bounds of the energetic coefficient");
  CheckInterval(sharp.tangential, "bounds of the tangential coefficient");
  CheckInterval(sharp.normal_total_n_s, "bounds of the normal impulse");
  if (sharp.energetic.lower < 0.0 || sharp.energetic.upper > 1.0) Fail("an energetic bound is outside [0, 1]");
}

// An audit does not use the law of restitution.
bool CanBeAudited(Scene scene) {
  scene.restitution_by_speed.reset();
  return Validate(scene, RestitutionIs::kOptional).empty();
}

absl::StatusOr<AuditResponse> AuditAndCheck(const AuditRequest& request) {
  absl::StatusOr<AuditResponse> response = LocalSolver().Audit(request);
  CheckStatus(response.status(), CanBeAudited(request.scene));
  return response;
}

// The numbers of the history serve as the observed velocity.
void CheckAnyAudit(const SolveRequest& request) {
  const std::vector<double>& seen = request.history_at_n_s;
  if (seen.size() < 2) return;
  AuditRequest audit = {.scene = request.scene};
  if (seen.size() == 2) audit.observed = ContactVelocity{{seen[0]}, seen[1]};
  if (seen.size() == 3) audit.observed = ContactVelocity{{seen[0], seen[1]}, seen[2]};
  if (seen.size() > 3) {
    audit.observed = ObservedRates{{seen.begin() + 1, seen.end()}};
    audit.velocity_uncertainty_m_s = seen[0];
  }
  static_cast<void>(AuditAndCheck(audit));
}

bool IsRigidAndEnergetic(const Scene& scene) {
  return std::holds_alternative<EnergeticCoefficient>(scene.restitution) && !scene.compliance.has_value();
}

void CheckOwnAudit(const Scene& scene, const Outcome& outcome) {
  // Where the budget of steps ran out, it does so again for each of the hundred impacts that an audit in space solves.
  if (outcome.termination == Termination::kBudgetUsedUp) return;
  // Impulses follow from velocities only as well as these are stated: where W is tiny, one that is 0 because it fell
  // below the least double would break the cone of friction.
  const double error = std::max(outcome.errors.tangential_m_s.value_or(0.0), outcome.errors.normal_m_s.value_or(0.0));
  AuditRequest request = {
      .scene = scene, .observed = outcome.contact_velocity_after, .velocity_uncertainty_m_s = error};
  const absl::StatusOr<AuditResponse> response = AuditAndCheck(request);
  if (!response.ok() || !IsRigidAndEnergetic(scene)) return;
  const bool exact = outcome.plan.model == Model::kPendulum || outcome.plan.model == Model::kPlanar;
  if (!exact || outcome.accuracy.relative_error > 0x1p-40) return;
  for (const LimitCheck& limit : response->report.limits) {
    if (limit.verdict == Verdict::kBroken) Fail("the audit of an admissible impact finds a limit broken");
  }
}

// A point of a sweep has the bits of the same impact solved alone; for the other points only their number is checked.
void CheckSweep(const SolveRequest& request, const absl::StatusOr<SolveResponse>& alone) {
  const double mu = request.scene.friction.kinetic_coefficient;
  const SweepRequest sweep = {
      .grid = {.scene = request.scene, .axes = {{"friction.kinetic_coefficient", ListValues{{mu, 0.1, 0.5}}}}},
      .columns = {"coefficients.newton", "energy_change_j"},
      .with_regime = true,
      .demand = request.demand};
  // Points that take long leave in chunks of their own.
  std::vector<Regime> regimes;
  std::vector<double> newton;
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(sweep)) {
    if (!chunk.ok()) return CheckStatus(chunk.status(), Validate(request.scene).empty());
    const auto count = static_cast<size_t>(chunk->count);
    if (chunk->values.size() != 2 * count || chunk->regimes.size() != count) Fail("a chunk of another size");
    newton.insert(newton.end(), chunk->values.begin(), chunk->values.begin() + chunk->count);
    regimes.insert(regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
  }
  if (newton.size() != 3) Fail("a sweep of another size");
  if (!alone.ok() || regimes[0] == Regime::kInvalid) return;
  if (newton[0] != alone->outcome.coefficients.newton) Fail("a point of a sweep has other bits");
}

void CheckNumbers(const absl::StatusOr<Certificate>& certificate) {
  CheckStatus(certificate.status(), true);
  if (!certificate.ok()) return;
  for (const CertifiedNumber& number : certificate->numbers) {
    const bool is_open = number.decimal.empty();
    if (is_open != !number.lower.empty()) Fail(number.path + " has neither a decimal nor two ends");
    if (!is_open || std::isinf(number.value)) continue;
    if (!(std::strtod(number.lower.c_str(), nullptr) <= std::strtod(number.upper.c_str(), nullptr))) Fail(number.path);
  }
}

constexpr int kDigits = 20;

// The most by which a pendulum's coefficient may differ from the certified one, which is rounded once.
double ErrorOfNewton(const Outcome& outcome, double certified) {
  constexpr double kPlain = 0x1p-45;
  constexpr double kLeast = 0x1p-700;
  constexpr double kRounded = 0x1p-53;
  const std::optional<double> stated = outcome.errors.newton;
  return stated.has_value() ? *stated + kRounded * certified + 0x1p-1074 : kPlain * std::max(certified, kLeast);
}

// If numbers of the outcome overflow there is no response, but the numbers themselves can still be proved.
void CheckCertificates(SolveRequest request, const absl::StatusOr<SolveResponse>& response) {
  const Scene& scene = request.scene;
  if (!Validate(scene).empty() || !CheckCertifiable(scene, kDigits).empty()) return;
  const absl::StatusOr<BoundsResponse> bounds =
      LocalSolver().Bounds({.scene = scene, .ranges = {}, .certified_digits = kDigits});
  CheckStatus(bounds.status(), true);
  if (bounds.ok()) CheckNumbers(*bounds->certificate);
  request.certified_digits = kDigits;
  const absl::StatusOr<SolveResponse> certified = LocalSolver().Solve(request);
  CheckStatus(certified.status(), true, request.inadmissible_is_error);
  if (!certified.ok()) return CheckNumbers(CertifySolve(scene, {.digits = kDigits}, [] { return false; }));
  CheckNumbers(*certified->outcome.certificate);
  const bool left_out = !request.demand.excluded.empty() || !request.demand.required.empty();
  if (!response.ok() || left_out || response->outcome.plan.model != Model::kPendulum) return;
  for (const CertifiedNumber& number : certified->outcome.certificate->numbers) {
    if (number.path != "coefficients.newton" || !std::isfinite(number.value)) continue;
    const double computed = response->outcome.coefficients.newton;
    if (std::fabs(computed - number.value) > ErrorOfNewton(response->outcome, number.value)) {
      Fail(absl::StrCat("another Newton's coefficient: ", computed, " for ", number.value));
    }
  }
}

// The numbers of the history serve as two rows of velocities before and after, and as the coefficient of friction.
void CheckColumns(const SolveRequest& request) {
  const std::vector<double>& seen = request.history_at_n_s;
  AuditBatchRequest batch = {.scene = request.scene};
  batch.columns.tangential_after_m_s = {0.5, -0.1};
  batch.columns.normal_after_m_s = {0.5};
  if (seen.size() > 2) batch.columns.friction = {seen[2]};
  if (seen.size() > 1) {
    batch.columns.tangential_m_s = {seen[0]};
    batch.columns.normal_m_s = {-1.0, seen[1]};
  }
  if (seen.size() > 3) batch.columns.tangential_2_m_s = batch.columns.tangential_2_after_m_s = {seen[3]};
  const absl::StatusOr<AuditBatchResponse> response = LocalSolver().AuditBatch(batch);
  CheckStatus(response.status(), CanBeAudited(request.scene));
  if (response.ok() && response->reports.size() != 2) Fail("another number of audits than of rows");
}

void Run(const v1::SolveRequest& proto) {
  const SolveRequest request = FromProto(proto);
  if (TakesTime(request)) return;
  const absl::StatusOr<SolveResponse> response = SolveAndCheck(request);
  CheckBounds(request.scene);
  CheckAnyAudit(request);
  CheckColumns(request);
  CheckSweep(request, response);
  CheckCertificates(request, response);
  if (response.ok()) CheckOwnAudit(request.scene, response->outcome);
}

}  // namespace

std::unique_ptr<google::protobuf::Message> NewInput() { return std::make_unique<v1::SolveRequest>(); }
std::vector<std::string> InputTexts() { return {}; }

}  // namespace ricochet

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ricochet::v1::SolveRequest request;
  if (request.ParseFromArray(data, static_cast<int>(size))) ricochet::Run(request);
  return 0;
}
