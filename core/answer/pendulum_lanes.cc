#include "core/answer/pendulum_lanes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/container/inlined_vector.h"
#include "absl/memory/memory.h"
#include "core/answer/model_outcomes.h"
#include "core/models/pendulum/first_order.h"
#include "core/models/restitution_law.h"
#include "core/numerics/range.h"
#include "core/plan/choose.h"
#include "core/problem/scene_problem.h"

namespace ricochet {
namespace {

using pendulum::Output;
using pendulum::Problem;

constexpr const char* kPaths[] = {"pendulum.inertia_kg_m2",       "pendulum.a_m",
                                  "pendulum.b_m",                 "pendulum.omega_minus_rad_s",
                                  "friction.kinetic_coefficient", "friction.static_coefficient"};

std::optional<Output> OutputAt(const std::string& path) {
  for (int i = 0; i < pendulum::kOutputCount; ++i) {
    const auto output = static_cast<Output>(i);
    if (!path.empty() && pendulum::OutputPath(output) == path) return output;
  }
  return std::nullopt;
}

double MostCoefficient(RestitutionLaw law) {
  return law == RestitutionLaw::kEnergetic ? 1.0 : std::numeric_limits<double>::max();
}

// True if the number lies where no product of a few of them can overflow or vanish.
bool IsModerate(double number) {
  const double size = std::fabs(number);
  return size == 0.0 || (size > 0x1p-200 && size < 0x1p200);
}

// True if every rule of a scene holds for sure. Any other problem is left to the checks of a scene.
bool IsSurelyValid(const Problem& x) {
  for (const double number : {x.inertia, x.a, x.b, x.omega_minus, x.mu, x.mu_static, x.coefficient}) {
    if (!IsModerate(number)) return false;
  }
  return x.inertia > 0.0 && x.a > 0.0 && x.mu >= 0.0 && x.mu_static >= x.mu && x.coefficient >= 0.0 &&
         x.coefficient <= MostCoefficient(x.law);
}

enum class Way { kClosedForm, kFirstOrder, kLeft };

// The forms of first order are those without friction, too.
Way WayOf(Model model) {
  if (model == Model::kUnspecified) return Way::kLeft;
  return model == Model::kPendulum || model == Model::kNone ? Way::kClosedForm : Way::kFirstOrder;
}

}  // namespace

std::unique_ptr<SceneLanes> PendulumLanes::Make(const Scene& scene, absl::Span<const std::string> columns,
                                                const Demand& demand) {
  if (!HasClosedForm(scene) || scene.compliance.has_value()) return nullptr;
  auto lanes = absl::WrapUnique(new PendulumLanes(scene, demand));
  if (!lanes->SetColumns(columns)) return nullptr;
  return lanes;
}

PendulumLanes::PendulumLanes(const Scene& scene, const Demand& demand)
    : SceneLanes(kPaths),
      demand_(demand),
      takes_fields_(IsPlain(scene)),
      problems_(pendulum::MakeProblem(scene).law, kBlock) {}

// Returns false if the closed form does not give every column.
bool PendulumLanes::SetColumns(absl::Span<const std::string> paths) {
  for (size_t c = 0; c < paths.size(); ++c) {
    if (paths[c] == "work.friction_dissipation_j") {
      dissipation_ = c;
    } else if (paths[c] == "work.tangential_spring_j") {
      spring_ = c;
    } else if (const std::optional<Output> output = OutputAt(paths[c])) {
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

void PendulumLanes::TakeIn(const Columns& columns, size_t count) {
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

// True if every problem of the block is surely valid and calls for the closed form with friction, judged by the ends of
// the ranges of its numbers, which costs less than a look at each.
bool PendulumLanes::AllNeedClosedForm(const Columns& columns, size_t count) const {
  if (!demand_.required.IsEmpty() || !demand_.excluded.IsEmpty()) return false;
  const auto range = [&](Number n) {
    const double* const numbers = problems_.numbers(n);
    return columns.varies[n] ? RangeOf(numbers, count) : Range{numbers[0], numbers[0]};
  };
  const Range inertia = range(kInertia);
  const Range a = range(kA);
  const Range b = range(kB);
  const Range omega = range(kOmega);
  const Range mu = range(kMu);
  const bool is_same = columns.of[kMuStatic] == columns.of[kMu];
  const Range mu_static = is_same ? mu : range(kMuStatic);
  const Range coefficient = range(kCoefficient);
  // Static friction is not below kinetic friction if it is the same, or if their ranges do not overlap.
  const bool is_static = is_same || mu.most <= mu_static.least;
  const Problem least = {.inertia = inertia.least,
                         .a = a.least,
                         .b = b.least,
                         .omega_minus = omega.least,
                         .mu = mu.least,
                         .mu_static = is_static ? mu_static.least : std::numeric_limits<double>::quiet_NaN(),
                         .law = problems_.law(),
                         .coefficient = coefficient.least};
  const Problem most = {.inertia = inertia.most,
                        .a = a.most,
                        .b = b.most,
                        .omega_minus = omega.most,
                        .mu = mu.most,
                        .mu_static = mu_static.most,
                        .law = problems_.law(),
                        .coefficient = coefficient.most};
  if (!(IsSurelyValid(least) && IsSurelyValid(most) && omega.most < 0.0)) return false;
  // Of all problems in the ranges this one is the nearest to a simpler model.
  Problem nearest = least;
  nearest.a = a.most;
  nearest.b = b.least > 0.0 ? b.least : std::max(0.0, -b.most);
  return IsFarFromSimple(nearest, demand_.relative_tolerance);
}

// Chooses the model of a problem and leaves out what that neglects. A demand that is a tolerance alone, as most are, takes
// a plan that costs less than the solution.
Model PendulumLanes::Plan(size_t i) {
  const Problem problem = problems_[i];
  if (!IsSurelyValid(problem)) return Model::kUnspecified;
  Choice choice;
  if (demand_.required.IsEmpty() && demand_.excluded.IsEmpty()) {
    choice.model = ModelOfPendulum(problem, demand_.relative_tolerance);
    if (choice.model != Model::kFrictionless) return choice.model;
    choice.left_out = {Effect::kFriction};
  } else {
    choice = ChoosePendulum(problem, {}, demand_);
  }
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

// Solves each run of problems that go the same way.
void PendulumLanes::SolveRuns(size_t count, Block& block) {
  for (size_t i = 0; i < count; ++i) block.models[i] = Plan(i);
  for (size_t first = 0, end = 0; first < count; first = end) {
    const Way way = WayOf(block.models[first]);
    while (end < count && WayOf(block.models[end]) == way) ++end;
    if (way == Way::kClosedForm) SolveByClosedForm(first, end - first, block);
    if (way == Way::kFirstOrder) SolveToFirstOrder(first, end - first, block);
  }
}

void PendulumLanes::Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) {
  TakeIn(columns, count);
  for (size_t c = 0; c < outputs_.size(); ++c) {
    places_[c] = column_of_[c].has_value() ? places[*column_of_[c]] : friction_work_.data();
  }
  block.is_uniform = false;
  if (AllNeedClosedForm(columns, count)) {
    std::fill_n(block.models.begin(), count, Model::kPendulum);
    block.is_uniform = SolveByClosedForm(0, count, block);
  } else {
    SolveRuns(count, block);
  }
  if (dissipation_.has_value()) {
    const double* const work = places_[friction_];
    std::transform(work, work + count, places[*dissipation_], [](double lost) { return 0.0 - lost; });
  }
  if (spring_.has_value()) std::fill_n(places[*spring_], count, 0.0);
}

}  // namespace ricochet
