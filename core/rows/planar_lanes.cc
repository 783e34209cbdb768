// PlanarLanes: planar contacts that are rigid, with a W of full rank, each by its model in SIMD lanes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/container/inlined_vector.h"
#include "absl/types/span.h"
#include "core/models/impact_end.h"
#include "core/models/planar/columns.h"
#include "core/models/planar_outputs.h"
#include "core/models/sliding/columns.h"
#include "core/numerics/moderate.h"
#include "core/plan/arithmetic.h"
#include "core/plan/choose.h"
#include "core/plan/demand.h"
#include "core/plan/planar_models.h"
#include "core/rows/scene_lanes.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {
namespace {

// True if every rule of the scene holds for sure and W has full rank. Any other problem is left to the checks of a
// scene.
bool IsSurelyValid(const planar::Problem& problem) {
  const auto& [tt, tn, nn] = problem.w;
  return AreModerate({tt, tn, nn, problem.u0, problem.v0, problem.mu, problem.mu_static, problem.coefficient},
                     kMostInLanes) &&
         tt > 0.0 && nn > 0.0 && tn * tn < 0.999 * (tt * nn) &&
         KeepCoefficientRules(problem.mu, problem.mu_static, problem.law, problem.coefficient);
}

class PlanarLanes : public SceneLanes {
 public:
  // The numbers of a contact, in the order of their columns (SceneLanes::Numbers).
  enum Number { kWtt, kWtn, kWnn, kU0, kV0, kMu, kMuStatic, kCoefficient, kNumberCount };

  // The law of restitution is that of the scene.
  PlanarLanes(const Scene& scene, std::vector<PlanarOutput> outputs, double tolerance);

  void Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) override;

 private:
  using Column = std::array<double, kBlock>;

  PlanarProblemColumns ProblemsIn(const Columns& columns, size_t count) const;
  void SolveBy(Model model, const Columns& columns, size_t count, const PlanarSolvedColumns& solved) const;
  Columns Gather(const Columns& columns, absl::Span<const uint16_t> some);
  void SolveTogether(const Columns& columns, absl::Span<const uint16_t> some, size_t count, Model model,
                     absl::Span<double* const> places, Block& block);
  void Separate(const Columns& columns, size_t i, absl::Span<double* const> places, Block& block) const;
  Model ModelAlone(const PlanarProblem& problem) const;

  RestitutionLaw law_;
  double tolerance_;
  std::vector<PlanarOutput> outputs_;

  // Contacts of the block that one model solves: their numbers and outputs.
  std::array<Column, kNumberCount> gathered_;
  std::vector<Column> answers_;
};

PlanarLanes::PlanarLanes(const Scene& scene, std::vector<PlanarOutput> outputs, double tolerance)
    : law_(LawAndCoefficientOf(scene.restitution).law),
      tolerance_(tolerance),
      outputs_(std::move(outputs)),
      answers_(outputs_.size()) {}

PlanarProblemColumns PlanarLanes::ProblemsIn(const Columns& columns, size_t count) const {
  const auto column = [&](Number n) { return absl::MakeConstSpan(columns.of[n], count); };
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

void PlanarLanes::SolveBy(Model model, const Columns& columns, size_t count, const PlanarSolvedColumns& solved) const {
  const PlanarProblemColumns problems = ProblemsIn(columns, count);
  if (model == Model::kFrictionless) {
    sliding::SolveFrictionlessColumns(problems, solved);
  } else if (model == Model::kSliding) {
    sliding::SolveColumns(problems, solved);
  } else {
    planar::SolveColumns(problems, ToleranceLeft(tolerance_, 0.0), solved);
  }
}

// Puts the numbers of some contacts side by side.
SceneLanes::Columns PlanarLanes::Gather(const Columns& columns, absl::Span<const uint16_t> some) {
  Columns gathered = columns;
  for (size_t n = 0; n < kNumberCount; ++n) {
    const double* const from = columns.of[n];
    if (!columns.varies[n] || (n == kMuStatic && from == columns.of[kMu])) continue;
    double* const to = gathered_[n].data();
    for (size_t k = 0; k < some.size(); ++k) to[k] = from[some[k]];
    gathered.of[n] = to;
  }
  if (columns.of[kMuStatic] == columns.of[kMu]) gathered.of[kMuStatic] = gathered.of[kMu];
  return gathered;
}

// Solves some contacts of the block by one model, in columns of their own unless they are the whole block.
void PlanarLanes::SolveTogether(const Columns& columns, absl::Span<const uint16_t> some, size_t count, Model model,
                                absl::Span<double* const> places, Block& block) {
  if (some.size() == count) {
    return SolveBy(model, columns, count,
                   {.outputs = outputs_,
                    .columns = places,
                    .regimes = absl::MakeSpan(block.regimes).first(count),
                    .inadmissible = absl::MakeSpan(block.inadmissible).first(count)});
  }
  std::array<Regime, kBlock> regimes;
  std::array<bool, kBlock> inadmissible;
  absl::InlinedVector<double*, kPlanarOutputCount> answers;
  for (Column& answer : answers_) answers.push_back(answer.data());
  SolveBy(model, Gather(columns, some), some.size(),
          {.outputs = outputs_,
           .columns = answers,
           .regimes = absl::MakeSpan(regimes).first(some.size()),
           .inadmissible = absl::MakeSpan(inadmissible).first(some.size())});
  for (size_t c = 0; c < outputs_.size(); ++c) {
    const double* const from = answers_[c].data();
    double* const to = places[c];
    for (size_t k = 0; k < some.size(); ++k) to[some[k]] = from[k];
  }
  for (size_t k = 0; k < some.size(); ++k) {
    block.regimes[some[k]] = regimes[k];
    block.inadmissible[some[k]] = inadmissible[k];
  }
}

void PlanarLanes::Separate(const Columns& columns, size_t i, absl::Span<double* const> places, Block& block) const {
  // The rank of W is not an output.
  const auto separated = Separating<ImpactEnd<double>>(2, columns.of[kU0][i], columns.of[kV0][i]);
  const auto numbers = planar::NumbersOf(separated, 0.0);
  for (size_t c = 0; c < outputs_.size(); ++c) places[c][i] = numbers[static_cast<size_t>(outputs_[c])];
  block.regimes[i] = Regime::kSeparating;
  block.inadmissible[i] = false;
}

// The model of a contact that the lanes leave open.
Model PlanarLanes::ModelAlone(const planar::Problem& problem) const {
  if (!IsSurelyValid(problem)) return Model::kUnspecified;
  return ChoosePlanar(problem, {}, {.relative_tolerance = tolerance_}).model;
}

void PlanarLanes::Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) {
  block.is_uniform = false;
  const PlanarProblemColumns problems = ProblemsIn(columns, count);
  ModelsOfPlanar(problems, tolerance_, absl::MakeSpan(block.models).first(count));
  // The contacts of each model.
  std::array<std::array<uint16_t, kBlock>, kModelCount> lists;
  std::array<size_t, kModelCount> sizes = {};
  for (size_t i = 0; i < count; ++i) {
    Model& model = block.models[i];
    if (model == Model::kUnspecified) model = ModelAlone(problems[i]);
    const auto number = static_cast<size_t>(model);
    lists[number][sizes[number]++] = static_cast<uint16_t>(i);
  }
  const auto contacts_of = [&](Model model) {
    const auto number = static_cast<size_t>(model);
    return absl::MakeConstSpan(lists[number].data(), sizes[number]);
  };
  for (const size_t i : contacts_of(Model::kNone)) Separate(columns, i, places, block);
  for (const Model model : {Model::kFrictionless, Model::kSliding, Model::kPlanar}) {
    if (!contacts_of(model).empty()) SolveTogether(columns, contacts_of(model), count, model, places, block);
  }
  block.is_complete = contacts_of(Model::kUnspecified).empty() && AreFinite(places, 0, count);
}

}  // namespace

std::unique_ptr<SceneLanes> MakePlanarLanes(const Scene& scene, absl::Span<const std::string> columns,
                                            const Demand& demand) {
  if (!std::holds_alternative<PlanarContact>(scene.system) || !IsPlain(scene)) return nullptr;
  if (!demand.IsToleranceAlone()) return nullptr;
  std::vector<PlanarOutput> outputs;
  for (const std::string& column : columns) {
    const auto output = OutputAt<PlanarOutput>(kPlanarOutputPaths, column);
    if (!output.has_value()) return nullptr;
    outputs.push_back(*output);
  }
  return std::make_unique<PlanarLanes>(scene, std::move(outputs), demand.relative_tolerance);
}

}  // namespace ricochet
