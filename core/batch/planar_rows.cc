#include "core/batch/planar_rows.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "core/contact/scene_contact.h"
#include "core/models/impact_end.h"
#include "core/models/planar/columns.h"
#include "core/models/sliding/columns.h"
#include "core/plan/arithmetic.h"
#include "core/plan/choose.h"
#include "core/plan/planar_models.h"
#include "core/problem/scene_problem.h"
#include "core/scene/numbers.h"

namespace ricochet {
namespace {

constexpr std::pair<const char*, PlanarOutput> kOutputs[] = {
    {"coefficients.newton", PlanarOutput::kNewton},
    {"coefficients.poisson", PlanarOutput::kPoisson},
    {"coefficients.energetic", PlanarOutput::kEnergetic},
    {"coefficients.tangential", PlanarOutput::kTangentialCoefficient},
    {"contact_velocity_after.tangential_m_s[0]", PlanarOutput::kTangentialVelocityAfter},
    {"contact_velocity_after.normal_m_s", PlanarOutput::kNormalVelocityAfter},
    {"impulse.normal_compression_n_s", PlanarOutput::kNormalImpulseCompression},
    {"impulse.normal_total_n_s", PlanarOutput::kNormalImpulse},
    {"impulse.tangential_n_s[0]", PlanarOutput::kTangentialImpulse},
    {"work.normal_compression_j", PlanarOutput::kWorkNormalCompression},
    {"work.normal_restitution_j", PlanarOutput::kWorkNormalRestitution},
    {"work.tangential_compression_j", PlanarOutput::kWorkTangentialCompression},
    {"work.tangential_restitution_j", PlanarOutput::kWorkTangentialRestitution},
    {"work.normal_total_j", PlanarOutput::kWorkNormal},
    {"work.tangential_total_j", PlanarOutput::kWorkTangential},
    {"work.friction_dissipation_j", PlanarOutput::kFrictionDissipation},
    {"energy_change_j", PlanarOutput::kEnergyChange},
};

std::optional<PlanarOutput> OutputAt(const std::string& path) {
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

// The numbers of a contact that separates. The rank of W is not an output.
ImpactEnd<double> Separated(double u0, double v0) { return Separating<ImpactEnd<double>>(2, u0, v0); }

}  // namespace

std::optional<PlanarRows> PlanarRows::Make(const Scene& scene, const BatchSetup& setup, const Demand& demand) {
  if (!IsPlain(scene) || !demand.required.IsEmpty() || !demand.excluded.IsEmpty()) return std::nullopt;
  PlanarRows rows(demand);
  for (const std::string& column : setup.columns) {
    const std::optional<PlanarOutput> output = OutputAt(column);
    if (!output.has_value()) return std::nullopt;
    rows.outputs_.push_back(*output);
  }
  const planar::Problem base =
      planar::MakeProblem(std::get<PlanarReduction>(Reduce(scene)), scene.restitution, CoefficientsAtSpeed(scene, 0.0));
  rows.law_ = base.law;
  const std::array<double, kNumberCount> numbers = {base.w.tt, base.w.tn, base.w.nn,      base.u0,
                                                    base.v0,   base.mu,   base.mu_static, base.coefficient};
  for (size_t n = 0; n < kNumberCount; ++n) rows.base_[n].fill(numbers[n]);
  rows.static_is_kinetic_ = !scene.friction.static_coefficient.has_value();
  for (size_t k = 0; k < setup.fields.size(); ++k) rows.column_of_[NumberAt(setup.fields[k])] = k;
  rows.places_.resize(rows.outputs_.size());
  rows.answer_places_.resize(rows.outputs_.size());
  rows.answers_.resize(rows.outputs_.size());
  return rows;
}

PlanarRows::Columns PlanarRows::ColumnsOf(const BatchRows& rows, size_t first) const {
  Columns columns;
  for (size_t n = 0; n < kNumberCount; ++n) {
    columns[n] = column_of_[n].has_value() ? rows.inputs[*column_of_[n]].data() + first : base_[n].data();
  }
  if (static_is_kinetic_ && !column_of_[kMuStatic].has_value()) columns[kMuStatic] = columns[kMu];
  return columns;
}

PlanarProblemColumns PlanarRows::ProblemsIn(const Columns& columns, size_t count) const {
  const auto column = [&](Number n) { return absl::MakeConstSpan(columns[n], count); };
  return {.law = law_,
          .wtt = column(kWtt),
          .wtn = column(kWtn),
          .wnn = column(kWnn),
          .u0 = column(kU0),
          .v0 = column(kV0),
          .mu = column(kMu),
          .mu_static = column(kMuStatic),
          .coefficient = column(kCoefficient)};
}

void PlanarRows::SolveBy(Model model, const Columns& columns, size_t count, const PlanarSolvedColumns& solved) const {
  const PlanarProblemColumns problems = ProblemsIn(columns, count);
  if (model == Model::kFrictionless) {
    sliding::SolveFrictionlessColumns(problems, solved);
  } else if (model == Model::kSliding) {
    sliding::SolveColumns(problems, solved);
  } else {
    planar::SolveColumns(problems, ToleranceLeft(demand_.relative_tolerance, 0.0), solved);
  }
}

// Puts the numbers of some rows side by side.
PlanarRows::Columns PlanarRows::Gather(const Columns& columns, absl::Span<const uint16_t> some) {
  Columns gathered = columns;
  for (size_t n = 0; n < kNumberCount; ++n) {
    if (!column_of_[n].has_value()) continue;
    const double* const from = columns[n];
    double* const to = gathered_[n].data();
    for (size_t k = 0; k < some.size(); ++k) to[k] = from[some[k]];
    gathered[n] = to;
  }
  if (columns[kMuStatic] == columns[kMu]) gathered[kMuStatic] = gathered[kMu];
  return gathered;
}

// Solves some rows of the block by one model, in columns of their own unless they are the whole block.
void PlanarRows::SolveTogether(const Columns& columns, absl::Span<const uint16_t> some, size_t count, Model model,
                               Block& block) {
  if (some.size() == count) {
    return SolveBy(model, columns, count,
                   {.outputs = outputs_,
                    .columns = places_,
                    .regimes = absl::MakeSpan(block.regimes).first(count),
                    .inadmissible = absl::MakeSpan(block.inadmissible).first(count)});
  }
  std::array<Regime, kBlock> regimes;
  std::array<bool, kBlock> inadmissible;
  SolveBy(model, Gather(columns, some), some.size(),
          {.outputs = outputs_,
           .columns = answer_places_,
           .regimes = absl::MakeSpan(regimes).first(some.size()),
           .inadmissible = absl::MakeSpan(inadmissible).first(some.size())});
  for (size_t c = 0; c < outputs_.size(); ++c) {
    const double* const from = answers_[c].data();
    double* const to = places_[c];
    for (size_t k = 0; k < some.size(); ++k) to[some[k]] = from[k];
  }
  for (size_t k = 0; k < some.size(); ++k) {
    block.regimes[some[k]] = regimes[k];
    block.inadmissible[some[k]] = inadmissible[k];
  }
}

void PlanarRows::Separate(const Columns& columns, size_t i, Block& block) const {
  const auto numbers = planar::NumbersOf(Separated(columns[kU0][i], columns[kV0][i]), 0.0);
  for (size_t c = 0; c < outputs_.size(); ++c) places_[c][i] = numbers[static_cast<size_t>(outputs_[c])];
  block.regimes[i] = Regime::kSeparating;
  block.inadmissible[i] = false;
}

// The model of a row that the lanes leave open.
Model PlanarRows::ModelAlone(const planar::Problem& problem) const {
  if (!IsSurelyValid(problem)) return Model::kUnspecified;
  return ChoosePlanar(problem, {}, demand_).model;
}

void PlanarRows::Solve(const BatchRows& rows, size_t first, size_t count, Block& block) {
  const Columns columns = ColumnsOf(rows, first);
  const PlanarProblemColumns problems = ProblemsIn(columns, count);
  for (size_t c = 0; c < outputs_.size(); ++c) {
    places_[c] = rows.outputs[c].data() + first;
    answer_places_[c] = answers_[c].data();
  }
  ModelsOfPlanar(problems, demand_.relative_tolerance, absl::MakeSpan(block.models).first(count));
  // The rows of each model.
  std::array<std::array<uint16_t, kBlock>, kModelCount> lists;
  std::array<size_t, kModelCount> sizes = {};
  for (size_t i = 0; i < count; ++i) {
    Model& model = block.models[i];
    if (model == Model::kUnspecified) model = ModelAlone(problems[i]);
    const auto number = static_cast<size_t>(model);
    lists[number][sizes[number]++] = static_cast<uint16_t>(i);
  }
  const auto rows_of = [&](Model model) {
    const auto number = static_cast<size_t>(model);
    return absl::MakeConstSpan(lists[number].data(), sizes[number]);
  };
  for (const size_t i : rows_of(Model::kNone)) Separate(columns, i, block);
  for (const Model model : {Model::kFrictionless, Model::kSliding, Model::kPlanar}) {
    if (!rows_of(model).empty()) SolveTogether(columns, rows_of(model), count, model, block);
  }
}

bool PlanarRows::HasAllNumbers(size_t count, const Block& block) const {
  bool is_solved = true;
  for (size_t i = 0; i < count; ++i) is_solved &= block.models[i] != Model::kUnspecified;
  if (!is_solved) return false;
  // Added to a magnitude, the least exponent carries into the sign if the number is infinite or NaN.
  constexpr uint64_t kSign = uint64_t{1} << 63;
  constexpr uint64_t kLeastExponent = uint64_t{1} << 52;
  uint64_t carry = 0;
  for (const double* const column : places_) {
    for (size_t i = 0; i < count; ++i) carry |= (std::bit_cast<uint64_t>(column[i]) & ~kSign) + kLeastExponent;
  }
  return (carry & kSign) == 0;
}

}  // namespace ricochet
