#include "core/batch/planar_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "core/contact/scene_contact.h"
#include "core/models/sliding/sliding.h"
#include "core/plan/arithmetic.h"
#include "core/plan/straight_problem.h"
#include "core/problem/scene_problem.h"
#include "core/scene/numbers.h"

namespace ricochet {
namespace {

constexpr std::pair<const char*, planar::Output> kOutputs[] = {
    {"coefficients.newton", planar::Output::kNewton},
    {"coefficients.poisson", planar::Output::kPoisson},
    {"coefficients.energetic", planar::Output::kEnergetic},
    {"coefficients.tangential", planar::Output::kTangentialCoefficient},
    {"contact_velocity_after.tangential_m_s[0]", planar::Output::kTangentialVelocityAfter},
    {"contact_velocity_after.normal_m_s", planar::Output::kNormalVelocityAfter},
    {"impulse.normal_compression_n_s", planar::Output::kNormalImpulseCompression},
    {"impulse.normal_total_n_s", planar::Output::kNormalImpulse},
    {"impulse.tangential_n_s[0]", planar::Output::kTangentialImpulse},
    {"work.normal_compression_j", planar::Output::kWorkNormalCompression},
    {"work.normal_restitution_j", planar::Output::kWorkNormalRestitution},
    {"work.tangential_compression_j", planar::Output::kWorkTangentialCompression},
    {"work.tangential_restitution_j", planar::Output::kWorkTangentialRestitution},
    {"work.normal_total_j", planar::Output::kWorkNormal},
    {"work.tangential_total_j", planar::Output::kWorkTangential},
    {"work.friction_dissipation_j", planar::Output::kFrictionDissipation},
    {"energy_change_j", planar::Output::kEnergyChange},
};

std::optional<planar::Output> OutputAt(const std::string& path) {
  for (const auto& [name, output] : kOutputs) {
    if (path == name) return output;
  }
  return std::nullopt;
}

// In the order of PlanarRows::Number, but for the coefficient of restitution, whose path depends on the law.
constexpr const char* kPaths[] = {"planar_contact.w_tt_per_kg", "planar_contact.w_tn_per_kg",
                                  "planar_contact.w_nn_per_kg", "planar_contact.tangential_m_s",
                                  "planar_contact.normal_m_s",  "friction.kinetic_coefficient",
                                  "friction.static_coefficient"};

size_t NumberAt(const std::string& path) {
  const auto* const found = std::find(std::begin(kPaths), std::end(kPaths), path);
  return static_cast<size_t>(found - std::begin(kPaths));
}

// True if the scene has a planar contact, friction and restitution, and nothing else.
bool IsPlain(const Scene& scene) {
  Scene plain;
  plain.system = scene.system;
  plain.friction.kinetic_coefficient = scene.friction.kinetic_coefficient;
  plain.friction.static_coefficient = scene.friction.static_coefficient;
  plain.restitution = scene.restitution;
  return std::holds_alternative<PlanarContact>(scene.system) && scene == plain;
}

// True if a number keeps its rule and lies where no product of a few of them can overflow or vanish.
bool IsModerate(double number) {
  const double size = std::fabs(number);
  return size == 0.0 || (size > 0x1p-200 && size < 0x1p200);
}

// True if every rule of the scene holds for sure and W has full rank. Any other problem is left to the checks of a scene.
bool IsSurelyValid(const planar::Problem& problem) {
  const auto& [tt, tn, nn] = problem.w;
  for (const double number : {tt, tn, nn, problem.u0, problem.v0, problem.mu, problem.mu_static, problem.coefficient}) {
    if (!IsModerate(number)) return false;
  }
  const double most = problem.law == RestitutionLaw::kEnergetic ? 1.0 : std::numeric_limits<double>::max();
  return tt > 0.0 && nn > 0.0 && tn * tn < 0.999 * (tt * nn) && problem.mu >= 0.0 && problem.mu_static >= problem.mu &&
         problem.coefficient >= 0.0 && problem.coefficient <= most;
}

// The same numbers with a scalar for each list of one direction.
ImpactEnd<double> WithScalars(const sliding::Impact<1>& impact) {
  return {.regime = impact.regime,
          .termination = impact.termination,
          .w_rank = impact.w_rank,
          .sharp_limit_broken = impact.sharp_limit_broken,
          .energy_limit_broken = impact.energy_limit_broken,
          .newton = impact.newton,
          .poisson = impact.poisson,
          .energetic = impact.energetic,
          .tangential = impact.tangential,
          .energetic_excess = impact.energetic_excess,
          .u1 = impact.u1[0],
          .v1 = impact.v1,
          .tau_compression = impact.tau_compression,
          .tau1 = impact.tau1,
          .f1 = impact.f1[0],
          .work_normal_compression = impact.work_normal_compression,
          .work_normal_restitution = impact.work_normal_restitution,
          .work_tangential_compression = impact.work_tangential_compression,
          .work_tangential_restitution = impact.work_tangential_restitution,
          .energy_change = impact.energy_change};
}

}  // namespace

std::optional<PlanarRows> PlanarRows::Make(const Scene& scene, const BatchSetup& setup, const Demand& demand) {
  if (!IsPlain(scene) || !demand.required.IsEmpty() || !demand.excluded.IsEmpty()) return std::nullopt;
  PlanarRows rows(demand);
  rows.numbers_ = {};
  for (const std::string& column : setup.columns) {
    const std::optional<planar::Output> output = OutputAt(column);
    if (!output.has_value()) return std::nullopt;
    rows.outputs_.push_back(*output);
  }
  const planar::Problem base =
      planar::MakeProblem(std::get<PlanarReduction>(Reduce(scene)), scene.restitution, CoefficientsAtSpeed(scene, 0.0));
  rows.law_ = base.law;
  rows.base_ = {base.w.tt, base.w.tn, base.w.nn, base.u0, base.v0, base.mu, base.mu_static, base.coefficient};
  rows.static_is_kinetic_ = !scene.friction.static_coefficient.has_value();
  for (size_t k = 0; k < setup.fields.size(); ++k) rows.column_of_[NumberAt(setup.fields[k])] = k;
  return rows;
}

void PlanarRows::Load(const BatchRows& rows, size_t first, size_t count) {
  for (size_t n = 0; n < kNumberCount; ++n) {
    if (column_of_[n].has_value()) {
      std::copy_n(rows.inputs[*column_of_[n]].begin() + static_cast<ptrdiff_t>(first), count, numbers_[n].begin());
    } else if (n == kMuStatic && static_is_kinetic_) {
      std::copy_n(numbers_[kMu].begin(), count, numbers_[n].begin());
    } else {
      std::fill_n(numbers_[n].begin(), count, base_[n]);
    }
  }
}

planar::Problem PlanarRows::ProblemAt(size_t i) const {
  return {.w = {numbers_[kWtt][i], numbers_[kWtn][i], numbers_[kWnn][i]},
          .u0 = numbers_[kU0][i],
          .v0 = numbers_[kV0][i],
          .mu = numbers_[kMu][i],
          .mu_static = numbers_[kMuStatic][i],
          .law = law_,
          .coefficient = numbers_[kCoefficient][i]};
}

// Solves the row by a straight model, or prepares it for the lanes, or leaves it to its scene.
void PlanarRows::Plan(size_t i, Verdict& verdict) {
  const planar::Problem problem = ProblemAt(i);
  verdict = {};
  if (IsSurelyValid(problem)) {
    const Choice choice = ChoosePlanar(problem, {}, demand_);
    verdict.model = choice.model;
    const planar::Problem kept = Without(choice, problem);
    if (choice.model == Model::kSliding || choice.model == Model::kFrictionless) return SolveStraight(i, kept, verdict);
    verdict.is_solved = (choice.model == Model::kPlanar && choice.negligible == 0.0) || choice.model == Model::kNone;
    numbers_[kMu][i] = kept.mu;
    numbers_[kMuStatic][i] = kept.mu_static;
  }
  if (verdict.is_solved) return;
  // A contact that separates costs the lanes least.
  numbers_[kV0][i] = 0.0;
  numbers_[kWnn][i] = 1.0;
}

void PlanarRows::SolveStraight(size_t i, const planar::Problem& problem, Verdict& verdict) {
  const sliding::Problem<1> straight = SlidingProblemOf(problem);
  const ImpactEnd<double> impact = WithScalars(
      verdict.model == Model::kFrictionless ? sliding::SolveFrictionless(straight) : sliding::Solve(straight));
  straight_.push_back(i);
  answers_.push_back(planar::NumbersOf(impact, 0.0));
  verdict.is_solved = true;
  verdict.regime = impact.regime;
  verdict.inadmissible = impact.sharp_limit_broken || impact.energy_limit_broken;
  numbers_[kV0][i] = 0.0;
}

void PlanarRows::Solve(const BatchRows& rows, size_t first, size_t count, absl::Span<Verdict> verdicts) {
  Load(rows, first, count);
  straight_.clear();
  answers_.clear();
  for (size_t i = 0; i < count; ++i) Plan(i, verdicts[i]);
  std::array<Regime, kBlock> regimes;
  std::array<bool, kBlock> inadmissible;
  std::vector<double*>& places = places_;
  places.clear();
  for (const absl::Span<double> column : rows.outputs) places.push_back(column.data() + first);
  const auto numbers = [&](Number n) { return absl::MakeConstSpan(numbers_[n].data(), count); };
  planar::SolveColumns({.law = law_,
                        .wtt = numbers(kWtt),
                        .wtn = numbers(kWtn),
                        .wnn = numbers(kWnn),
                        .u0 = numbers(kU0),
                        .v0 = numbers(kV0),
                        .mu = numbers(kMu),
                        .mu_static = numbers(kMuStatic),
                        .coefficient = numbers(kCoefficient)},
                       ToleranceLeft(demand_.relative_tolerance, 0.0),
                       {.outputs = outputs_,
                        .columns = places,
                        .regimes = absl::MakeSpan(regimes.data(), count),
                        .inadmissible = absl::MakeSpan(inadmissible.data(), count)});
  for (size_t k = 0; k < straight_.size(); ++k) {
    for (size_t c = 0; c < outputs_.size(); ++c)
      places[c][straight_[k]] = answers_[k][static_cast<size_t>(outputs_[c])];
  }
  for (size_t i = 0; i < count; ++i) {
    if (verdicts[i].model != Model::kPlanar && verdicts[i].model != Model::kNone) continue;
    verdicts[i].regime = regimes[i];
    verdicts[i].inadmissible = inadmissible[i];
  }
}

}  // namespace ricochet
