// PendulumLanes: pendulums over a surface at rest, each by the closed form in SIMD lanes or to first order.

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/container/inlined_vector.h"
#include "absl/types/span.h"
#include "core/answer/model_outcomes.h"
#include "core/models/pendulum/columns.h"
#include "core/models/pendulum/first_order.h"
#include "core/models/pendulum/pendulum.h"
#include "core/numerics/moderate.h"
#include "core/plan/choose.h"
#include "core/plan/demand.h"
#include "core/plan/pendulum_models.h"
#include "core/plan/scene_problem.h"
#include "core/rows/scene_lanes.h"
#include "ricochet/scene.h"

namespace ricochet {
namespace {

using pendulum::Output;
using pendulum::Problem;

// True if every rule of a scene holds for sure. Any other problem is left to the checks of a scene.
bool IsSurelyValid(const Problem& x) {
  return AreModerate({x.inertia, x.a, x.b, x.omega_minus, x.mu, x.mu_static, x.coefficient}, kMostInLanes) &&
         x.inertia > 0.0 && x.a > 0.0 && KeepCoefficientRules(x.mu, x.mu_static, x.law, x.coefficient);
}

// Answer names the formula by which the lanes solve a problem; kNone leaves the problem to the caller.
enum class Answer { kClosedForm, kFirstOrder, kNone };

// The first-order forms also solve problems without friction.
Answer AnswerBy(Model model) {
  if (model == Model::kUnspecified) return Answer::kNone;
  return model == Model::kPendulum || model == Model::kNone ? Answer::kClosedForm : Answer::kFirstOrder;
}

class PendulumLanes : public SceneLanes {
 public:
  PendulumLanes(const Scene& scene, const Demand& demand);
  // Returns false if the closed form does not give every column.
  bool SetColumns(absl::Span<const std::string> paths);

  // Coefficients that depend on the speed are no fields.
  bool TakesFields() const override { return takes_fields_; }
  Numbers NumbersOf(const Scene& scene) const override;
  void Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) override;

 private:
  static constexpr size_t kNumberCount = pendulum::ProblemColumns::kNumbers;

  void SetProblems(const Columns& columns, size_t count);
  Model Plan(size_t i);
  bool PlanAll(size_t count, Block& block);
  bool SolveByClosedForm(size_t first, size_t count, Block& block);
  void SolveToFirstOrder(size_t first, size_t count, Block& block) const;
  bool SolveRuns(size_t count, Block& block);

  const Demand demand_;
  const bool takes_fields_;
  pendulum::ProblemColumns problems_;
  std::array<std::optional<double>, kNumberCount> held_;  // The number that all problems have, where that is known.

  std::vector<pendulum::Output> outputs_;         // The kernel computes these, each once.
  std::vector<std::optional<size_t>> column_of_;  // The column of each output; unset for an output that is no column.
  std::vector<double*> places_;                   // The places of the outputs in the current block.
  std::optional<size_t> dissipation_;             // The column of minus the work of friction.
  std::optional<size_t> spring_;                  // The column of the tangential spring energy, which is 0 here.
  size_t friction_ = 0;                           // Which output the work of friction is, if it is needed.
  std::array<double, kBlock> friction_work_;      // Its place if it is no column.
};

PendulumLanes::PendulumLanes(const Scene& scene, const Demand& demand)
    : demand_(demand), takes_fields_(IsPlain(scene)), problems_(pendulum::MakeProblem(scene).law, kBlock) {}

bool PendulumLanes::SetColumns(absl::Span<const std::string> paths) {
  for (size_t c = 0; c < paths.size(); ++c) {
    if (paths[c] == "work.friction_dissipation_j") {
      dissipation_ = c;
    } else if (paths[c] == "work.tangential_spring_j") {
      spring_ = c;
    } else if (const auto output = OutputAt<Output>(pendulum::kOutputPaths, paths[c])) {
      outputs_.push_back(*output);
      column_of_.emplace_back(c);
    } else {
      return false;
    }
  }
  if (dissipation_.has_value()) {
    const auto found = std::find(outputs_.begin(), outputs_.end(), Output::kWorkTangential);
    friction_ = static_cast<size_t>(found - outputs_.begin());
    if (found == outputs_.end()) {
      outputs_.push_back(Output::kWorkTangential);
      column_of_.emplace_back();
    }
  }
  places_.resize(outputs_.size());
  return true;
}

SceneLanes::Numbers PendulumLanes::NumbersOf(const Scene& scene) const {
  const Problem problem = ClosedFormProblem(scene);
  return {problem.inertia, problem.a,         problem.b,          problem.omega_minus,
          problem.mu,      problem.mu_static, problem.coefficient};
}

void PendulumLanes::SetProblems(const Columns& columns, size_t count) {
  for (size_t n = 0; n < kNumberCount; ++n) {
    double* const to = problems_.numbers(n);
    if (columns.varies[n]) {
      std::copy_n(columns.of[n], count, to);
      held_[n].reset();
    } else if (held_[n] != columns.of[n][0]) {
      std::fill_n(to, kBlock, columns.of[n][0]);
      held_[n] = columns.of[n][0];
    }
  }
}

// Chooses the model of a problem and leaves out what that neglects. A demand that is a tolerance alone, as most are,
// takes a plan that costs less than the solution.
Model PendulumLanes::Plan(size_t i) {
  const Problem problem = problems_[i];
  if (!IsSurelyValid(problem)) return Model::kUnspecified;
  if (demand_.IsToleranceAlone()) return ModelOfPendulum(problem, demand_.relative_tolerance);
  const Choice choice = ChoosePendulum(problem, {}, demand_);
  problems_.Set(i, Without(choice, problem));
  held_ = {};
  return choice.model;
}

// Returns true if the model, the regime and the admissibility of all problems are the same, and all numbers are finite.
bool PendulumLanes::SolveByClosedForm(size_t first, size_t count, Block& block) {
  absl::InlinedVector<double*, pendulum::kOutputCount> places;
  for (double* const place : places_) places.push_back(place + first);
  // The closed form neglects nothing, so that the whole tolerance is left for rounding.
  return pendulum::SolveColumns(problems_, first, count, demand_.relative_tolerance,
                                {.outputs = outputs_,
                                 .columns = places,
                                 .regimes = absl::MakeSpan(block.regimes).subspan(first, count),
                                 .inadmissible = absl::MakeSpan(block.inadmissible).subspan(first, count)});
}

void PendulumLanes::SolveToFirstOrder(size_t first, size_t count, Block& block) const {
  for (size_t i = first; i < first + count; ++i) {
    const Problem problem = problems_[i];
    const first_order::Approximation approximation = first_order::Approximate(problem);
    for (size_t c = 0; c < outputs_.size(); ++c) {
      places_[c][i] = first_order::Value(problem, approximation, outputs_[c]);
    }
    block.regimes[i] = first_order::RegimeOf(problem);
    block.inadmissible[i] = false;
  }
}

// Chooses the models of a block. Returns true if all problems call for the closed form with friction.
bool PendulumLanes::PlanAll(size_t count, Block& block) {
  const absl::Span<Model> models = absl::MakeSpan(block.models).first(count);
  if (!demand_.IsToleranceAlone()) {
    std::fill(models.begin(), models.end(), Model::kUnspecified);
  } else if (ModelsOfPendulum(problems_, models)) {
    return true;
  }
  bool all = true;
  for (size_t i = 0; i < count; ++i) {
    if (models[i] == Model::kUnspecified) models[i] = Plan(i);
    all &= models[i] == Model::kPendulum;
  }
  return all;
}

// Solves each run of problems that are answered alike. Returns true if none is left and all numbers are finite.
bool PendulumLanes::SolveRuns(size_t count, Block& block) {
  bool is_complete = true;
  for (size_t first = 0, end = 0; first < count; first = end) {
    const Answer answer = AnswerBy(block.models[first]);
    while (end < count && AnswerBy(block.models[end]) == answer) ++end;
    const bool has_numbers = answer == Answer::kClosedForm && SolveByClosedForm(first, end - first, block);
    if (answer == Answer::kFirstOrder) SolveToFirstOrder(first, end - first, block);
    is_complete = is_complete && answer != Answer::kNone && (has_numbers || AreFinite(places_, first, end - first));
  }
  return is_complete;
}

void PendulumLanes::Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) {
  SetProblems(columns, count);
  for (size_t c = 0; c < outputs_.size(); ++c) {
    places_[c] = column_of_[c].has_value() ? places[*column_of_[c]] : friction_work_.data();
  }
  const bool is_alike = PlanAll(count, block);
  block.is_uniform = is_alike && SolveByClosedForm(0, count, block);
  block.is_complete = block.is_uniform || (is_alike ? AreFinite(places_, 0, count) : SolveRuns(count, block));
  if (dissipation_.has_value()) {
    const double* const work = places_[friction_];
    std::transform(work, work + count, places[*dissipation_], [](double lost) { return 0.0 - lost; });
  }
  if (spring_.has_value()) std::fill_n(places[*spring_], count, 0.0);
}

}  // namespace

std::unique_ptr<SceneLanes> MakePendulumLanes(const Scene& scene, absl::Span<const std::string> columns,
                                              const Demand& demand) {
  if (!HasClosedForm(scene) || scene.compliance.has_value()) return nullptr;
  auto lanes = std::make_unique<PendulumLanes>(scene, demand);
  if (!lanes->SetColumns(columns)) return nullptr;
  return lanes;
}

}  // namespace ricochet
