// Random scenes on which the model of finite duration is held to what it claims.
//
// Without finite forces and damping the impact is the rigid one, or that of the compliant contact, at any stiffness,
// and both are known to rounding. Under forces and damping the reference is the same model at its tightest tolerance.

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_FINITE_DURATION_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_FINITE_DURATION_CLAIMS_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/models/compliant/compliant.h"
#include "core/models/finite_duration/finite_duration.h"
#include "core/models/planar/planar.h"
#include "tests/support/claims/claims.h"
#include "tests/support/claims/number_claims.h"
#include "tests/support/scenes/compliant_hard_scenes.h"
#include "tests/support/scenes/compliant_scenes.h"
#include "tests/support/scenes/planar_scenes.h"

namespace ricochet::finite_duration {

inline constexpr double kClaimTolerances[] = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12};

// The kinds of contact whose errors can be held against a closed form.
enum class ClaimKind { kLinear, kHertz, kCompliant };

struct End {
  double u1 = 0.0, v1 = 0.0;
};

inline double ErrorOf(const Problem& problem, const Impact& impact, const End& exact) {
  const double speed = std::max(std::fabs(problem.contact.u0), std::fabs(problem.contact.v0));
  return std::max(std::fabs(impact.u1 - exact.u1), std::fabs(impact.v1 - exact.v1)) / speed;
}

class ClaimScenes {
 public:
  ClaimScenes(ClaimKind kind, bool hard, uint64_t seed) : kind_(kind), hard_(hard), planar_(seed), compliant_(seed) {}

  Problem Next() {
    Problem problem;
    if (kind_ == ClaimKind::kCompliant) {
      const compliant::Problem stated = hard_ ? HardCompliant() : compliant_.Everyday(0.02, 50.0);
      problem.contact = stated.contact;
      problem.contact.mu_static = problem.contact.mu;
      problem.ratio_squared = stated.ratio_squared;
    } else {
      problem.contact = hard_ ? planar_.Any() : planar_.Everyday();
      problem.contact.law = RestitutionLaw::kEnergetic;
      problem.contact.coefficient = planar_.UnitCoefficient();
    }
    const double stiffness = std::pow(10.0, planar_.Uniform(-3.0, 12.0));
    problem.spring =
        kind_ == ClaimKind::kHertz ? NormalSpring(HertzSpring{stiffness}) : NormalSpring(LinearSpring{stiffness});
    if (hard_ && planar_.Below(2) == 0) Scale(problem);
    return problem;
  }

 private:
  compliant::Problem HardCompliant() {
    return compliant_.Below(2) == 0 ? compliant::Everyday(compliant_) : compliant_.NearRankOne();
  }

  // Scales by powers of two up to 10^+-100. Stiffness stays as it is, because it changes neither velocity.
  void Scale(Problem& problem) {
    const double speed = std::exp2(std::floor(planar_.Uniform(-332.0, 332.0)));
    const double mobility = std::exp2(std::floor(planar_.Uniform(-332.0, 332.0)));
    PlanarProblem& contact = problem.contact;
    for (double* velocity : {&contact.u0, &contact.v0}) *velocity *= speed;
    for (double* entry : {&contact.w.tt, &contact.w.tn, &contact.w.nn}) *entry *= mobility;
  }

  ClaimKind kind_;
  bool hard_;
  planar::SceneSource planar_;
  compliant::SceneSource compliant_;
};

// The end by the model in closed form; nothing where that does not know it, or where the particle sticks and slides so
// often that the integration takes seconds.
inline std::optional<End> ClosedForm(const Problem& problem) {
  if (!problem.ratio_squared.has_value()) {
    const planar::Impact exact = planar::Solve(problem.contact);
    return End{exact.u1, exact.v1};
  }
  const compliant::Impact exact =
      compliant::Solve({.contact = problem.contact, .ratio_squared = *problem.ratio_squared});
  constexpr size_t kMostSections = 50;
  if (!exact.Converged() || exact.sections.size() > kMostSections) return std::nullopt;
  return End{exact.u1, exact.v1};
}

inline ClaimTally ClaimsOf(ClaimKind kind, bool hard, double tolerance, int count, uint64_t seed) {
  ClaimScenes scenes(kind, hard, seed);
  ClaimTally tally(tolerance);
  for (int i = 0; tally.count() < count; ++i) {
    Problem problem = scenes.Next();
    problem.tolerance = tolerance;
    const std::optional<End> exact = ClosedForm(problem);
    if (!exact.has_value()) continue;
    const Impact impact = Solve(problem);
    tally.Add(impact.error_estimate, ErrorOf(problem, impact, *exact), "scene " + std::to_string(i));
  }
  return tally;
}

// The impact by the model in closed form, which has the members of ImpactEnd.
inline std::optional<ImpactEnd<double>> ClosedFormOf(const Problem& problem) {
  if (!problem.ratio_squared.has_value()) return planar::Solve(problem.contact);
  const compliant::Impact exact =
      compliant::Solve({.contact = problem.contact, .ratio_squared = *problem.ratio_squared});
  constexpr size_t kMostSections = 50;
  if (!exact.Converged() || exact.sections.size() > kMostSections) return std::nullopt;
  return exact;
}

// Compares impacts number by number, and the works with the change of energy.
inline NumberClaims NumberClaimsOf(ClaimKind kind, bool hard, double tolerance, int count, uint64_t seed) {
  ClaimScenes scenes(kind, hard, seed);
  NumberClaims claims;
  for (int i = 0; claims.velocity.count() < 2 * count; ++i) {
    Problem problem = scenes.Next();
    problem.tolerance = tolerance;
    const std::optional<ImpactEnd<double>> closed = ClosedFormOf(problem);
    if (!closed.has_value()) continue;
    const Impact impact = Solve(problem);
    const auto compare = [](double computed, double exact) {
      return ComparedNumber(std::fabs(computed - exact), std::fabs(exact));
    };
    ComparedNumbers found;
    found.newton = compare(impact.newton, closed->newton);
    found.poisson = compare(impact.poisson, closed->poisson);
    found.energetic = compare(impact.energetic, closed->energetic);
    found.tangential = compare(impact.tangential, closed->tangential);
    found.u = compare(impact.u1, closed->u1);
    found.v = compare(impact.v1, closed->v1);
    found.tau_compression = compare(impact.tau_compression, closed->tau_compression);
    found.tau = compare(impact.tau1, closed->tau1);
    found.f = compare(impact.f1, closed->f1);
    found.work_normal_compression = compare(impact.work_normal_compression, closed->work_normal_compression);
    found.work_normal_restitution = compare(impact.work_normal_restitution, closed->work_normal_restitution);
    found.work_tangential_compression =
        compare(impact.work_tangential_compression, closed->work_tangential_compression);
    found.work_tangential_restitution =
        compare(impact.work_tangential_restitution, closed->work_tangential_restitution);
    found.energy_change = compare(impact.energy_change, closed->energy_change);
    ImpactErrors judged = impact.errors;
    if (kind == ClaimKind::kCompliant) {
      // Where v turns several times, the two models divide the tangential work in different ways.
      found.work_tangential_compression = {};
      found.work_tangential_restitution =
          compare(impact.work_tangential_compression + impact.work_tangential_restitution,
                  closed->work_tangential_compression + closed->work_tangential_restitution);
      judged.work_tangential_restitution += judged.work_tangential_compression;
    }
    const std::string scene = "scene " + std::to_string(i);
    claims.Add(judged, found, scene);
    const double open = impact.work_normal_compression + impact.work_normal_restitution +
                        impact.work_tangential_compression + impact.work_tangential_restitution - impact.energy_change;
    const ImpactErrors& errors = impact.errors;
    const double claimed = errors.work_normal_compression + errors.work_normal_restitution +
                           errors.work_tangential_compression + errors.work_tangential_restitution;
    claims.work.Add(std::isfinite(claimed) ? 1.0 : claimed, std::fabs(open) / claimed, "the ledger of " + scene);
  }
  return claims;
}

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_FINITE_DURATION_CLAIMS_H_
